"""HDF5 and netCDF files against h5py and netCDF4: samples, places and values of generated files."""

import warnings

import numpy as np
import pytest

from edgesplat import Error, Volume

MILLIMETRES = {"mm": 1.0, "um": 1e-3, "micron": 1e-3, "nm": 1e-6, "cm": 10.0, "m": 1000.0, "inch": 25.4}


def read(path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # samples without data
        return Volume(path)


def affine(volume):
    """4 x 4, from (x, y, z, 1) of a voxel to mm."""
    matrix = np.eye(4)
    matrix[:3, :3] = volume.direction * np.array(volume.spacing)
    matrix[:3, 3] = volume.origin
    return matrix


def numbers(rng, dtype, shape):
    dtype = np.dtype(dtype)
    if dtype.kind == "b":
        return rng.integers(0, 2, shape).astype(bool)
    if dtype.kind in "iu":
        limits = np.iinfo(dtype)
        return rng.integers(max(limits.min, -(2**23)), min(limits.max, 2**23), shape).astype(dtype)
    return rng.normal(0, 100, shape).astype(dtype)


HDF5_TYPES = ["i1", "u1", "<i2", ">i2", "<u2", ">u2", "<i4", ">u4", "<i8", ">i8", "<f2", "<f4", ">f4", "<f8", ">f8", "?"]


@pytest.mark.parametrize("seed", range(48))
def test_hdf5(tmp_path, seed):
    h5py = pytest.importorskip("h5py", reason="python3-h5py is missing")
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(2, 7, 3))
    array = numbers(rng, HDF5_TYPES[seed % len(HDF5_TYPES)], shape)
    spacing = rng.uniform(0.1, 5, 3)  # z, y, x
    kind = ["none", "attribute", "group", "itk", "vtk", "imaris"][seed % 6]
    expected = np.eye(4)
    path, name = str(tmp_path / "a.h5"), "/some/group/data"
    storage = [{}, {"compression": "gzip", "shuffle": True}, {"chunks": (1, 2, 2)}][int(rng.integers(3))]
    with h5py.File(path, "w") as file:
        if kind == "itk":
            name = "/ITKImage/0/VoxelData"
            axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
            origin = rng.normal(0, 50, 3)
            group = file.create_group("ITKImage/0")
            group["Directions"], group["Origin"], group["Spacing"] = axes, origin, spacing
            group["Dimension"] = np.array(shape[::-1], "u8")
            expected[:3, :3], expected[:3, 3] = axes * spacing, origin
        elif kind == "vtk":
            name = "/VTKHDF/PointData/values"
            axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
            origin, first = rng.normal(0, 50, 3), rng.integers(-5, 5, 3)
            group = file.create_group("VTKHDF")
            group.attrs["Type"] = np.bytes_("ImageData")
            group.attrs["Spacing"], group.attrs["Origin"], group.attrs["Direction"] = spacing, origin, axes.ravel()
            group.attrs["WholeExtent"] = np.ravel([(f, f + n - 1) for f, n in zip(first, shape[::-1])])
            expected[:3, :3] = axes * spacing
            expected[:3, 3] = origin + expected[:3, :3] @ first
        elif kind == "imaris":
            name = "/DataSet/ResolutionLevel 0/TimePoint 0/Channel 0/Data"
            image = file.create_group("DataSetInfo/Image")
            for axis in range(3):
                low, high = 10.0 * axis, 10.0 * axis + spacing[2 - axis] * shape[2 - axis]
                image.attrs[f"ExtMin{axis}"] = np.array(list(f"{low:.12g}"), "S1")
                image.attrs[f"ExtMax{axis}"] = np.array(list(f"{high:.12g}"), "S1")
                expected[axis, axis] = spacing[2 - axis] * 1e-3
                expected[axis, 3] = (low + spacing[2 - axis] / 2) * 1e-3
            image.attrs["Unit"] = np.array(list("um"), "S1")
        file.create_dataset(name, data=array, **storage)
        if kind in ("attribute", "group"):
            holder = file[name] if kind == "attribute" else file["/some"]
            unit = list(MILLIMETRES)[int(rng.integers(len(MILLIMETRES)))]
            if rng.integers(2):
                holder.attrs["element_size_um"], unit = spacing, "um"
            else:
                holder.attrs["voxel_size"], holder.attrs["unit"] = spacing, unit
            expected[:3, :3] = np.diag(spacing[::-1]) * MILLIMETRES[unit]
    volume = read(path)
    with h5py.File(path) as file:
        assert np.array_equal(volume.array, file[name][...].astype(np.float32))
    np.testing.assert_allclose(affine(volume), expected, rtol=1e-9, atol=1e-9)
    assert np.array_equal(read(f"{path}:{name}").array, volume.array)


@pytest.mark.parametrize("sized_by", ["channel", "image"])
def test_imaris_padding_is_left_out(tmp_path, sized_by):
    h5py = pytest.importorskip("h5py", reason="python3-h5py is missing")
    path = str(tmp_path / "a.ims")
    array = np.zeros((4, 8, 8), "u2")
    array[:3, :5, :6] = np.arange(1, 91).reshape(3, 5, 6)
    with h5py.File(path, "w") as file:
        channel = file.create_group("DataSet/ResolutionLevel 0/TimePoint 0/Channel 0")
        channel["Data"] = array
        image = file.create_group("DataSetInfo/Image")
        holder, prefix = (channel, "ImageSize") if sized_by == "channel" else (image, "")
        for axis, (letter, size) in enumerate(zip("XYZ", (6, 5, 3))):
            holder.attrs[prefix + letter] = np.array(list(str(size)), "S1")
            image.attrs[f"ExtMin{axis}"] = np.array(list("0"), "S1")
            image.attrs[f"ExtMax{axis}"] = np.array(list(str(size * (axis + 1))), "S1")
        image.attrs["Unit"] = np.array(list("um"), "S1")
    volume = read(path)
    assert np.array_equal(volume.array, array[:3, :5, :6])
    np.testing.assert_allclose(volume.spacing, (0.001, 0.002, 0.003))
    with h5py.File(path, "a") as file:
        group = "DataSet/ResolutionLevel 0/TimePoint 0/Channel 0" if sized_by == "channel" else "DataSetInfo/Image"
        file[group].attrs[prefix + "X"] = np.bytes_("9")
    with pytest.raises(Error, match=f"a.ims: attribute {prefix}X of .* is '9', expected a whole number from 1 to 8"):
        Volume(path)


def test_hdf5_lists_what_there_is(tmp_path):
    h5py = pytest.importorskip("h5py", reason="python3-h5py is missing")
    path = str(tmp_path / "a.h5")
    with h5py.File(path, "w") as file:
        file["a"], file["b/c"] = np.zeros((2, 3, 4)), np.ones((3, 3, 3), "u1")
    with pytest.raises(Error, match=r"2 arrays; name one(.|\n)*a\.h5:/a  \(4 x 3 x 2, float64\)(.|\n)*:/b/c"):
        Volume(path)
    assert Volume(f"{path}:b/c").max == 1
    with pytest.raises(Error, match="no array 'd'"):
        Volume(f"{path}:d")


def test_hdf5_messages_name_the_file(tmp_path, program):
    h5py = pytest.importorskip("h5py", reason="python3-h5py is missing")
    path = str(tmp_path / "a.h5")
    array = np.arange(27, dtype="u1").reshape(3, 3, 3)
    with h5py.File(path, "w") as file:
        file["a"] = array
        file["a"].attrs["element_size_um"] = [1, -2, 3]
    with pytest.raises(Error, match="a.h5: /a: attribute element_size_um: -2, expected lengths above 0"):
        Volume(path)
    with h5py.File(path, "w") as file:
        file["VTKHDF/PointData/s"] = array
        file["VTKHDF"].attrs["Type"] = np.bytes_("UnstructuredGrid")
    with pytest.raises(Error, match="a.h5: /VTKHDF/PointData/s: .* 'UnstructuredGrid', expected ImageData"):
        Volume(path)
    with h5py.File(path, "w") as file:
        file.create_dataset("a", data=np.zeros((16, 16, 16), "i4"), compression="lzf")
    # In a program of its own: h5py brings the filter into this one.
    told = program("info", path, check=False)
    assert told.returncode != 0
    assert "a.h5: /a: compressed by the filter lzf (32000), which is not available" in told.stderr
    with h5py.File(path, "w") as file:
        file["link"] = h5py.ExternalLink("other.h5", "/data")
    with pytest.raises(Error, match="a.h5: contains no array of numbers, but /link leads to /data in the file other.h5"):
        Volume(path)


def test_hdf5_short_axes_may_be_colours(tmp_path):
    h5py = pytest.importorskip("h5py", reason="python3-h5py is missing")
    path = str(tmp_path / "a.h5")
    with h5py.File(path, "w") as file:
        file["a"] = np.arange(5 * 6 * 3, dtype="u1").reshape(5, 6, 3)
    with pytest.warns(UserWarning, match=r"The last axis of shape \(5, 6, 3\) has 3 entries: it is read as x, although"):
        assert Volume(path).shape == (5, 6, 3)
    with h5py.File(path, "a") as file:
        for axis, letter in enumerate("zyx"):
            file["a"].dims[axis].label = letter
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Volume(path)


def test_hdf5_components_and_frames(tmp_path):
    h5py = pytest.importorskip("h5py", reason="python3-h5py is missing")
    path = str(tmp_path / "a.h5")
    array = np.arange(2 * 5 * 6 * 7 * 3, dtype="f4").reshape(2, 5, 6, 7, 3)
    with h5py.File(path, "w") as file:
        file["a"] = array
    with pytest.raises(Error, match="--component 0..2"):
        Volume(path)
    assert np.array_equal(Volume(path, component=1, frame=1).array, array[1, ..., 1])
    with h5py.File(path, "w") as file:
        file["a"] = array[0, ..., 0]
        for axis, letter in enumerate("xyz"):
            file["a"].dims[axis].label = letter
    volume = Volume(path)  # z is the fastest axis
    assert np.array_equal(volume.array, array[0, ..., 0])
    np.testing.assert_allclose(volume.direction, np.eye(3)[:, ::-1])


NETCDF_FORMATS = ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA", "NETCDF4", "NETCDF4_CLASSIC"]


@pytest.mark.parametrize("seed", range(60))
def test_netcdf(tmp_path, seed):
    netCDF4 = pytest.importorskip("netCDF4", reason="python3-netcdf4 is missing")
    rng = np.random.default_rng(seed)
    kind = NETCDF_FORMATS[seed % len(NETCDF_FORMATS)]
    types = ["i1", "i2", "i4", "f4", "f8"] + (["u1", "u2", "u4", "i8"] if kind in ("NETCDF4", "NETCDF3_64BIT_DATA") else [])
    dtype = types[int(rng.integers(len(types)))]
    shape = tuple(rng.integers(2, 7, 3))
    order = ["zyx", "xyz", "yxz", "zxy"][int(rng.integers(4))]
    named = rng.integers(2)  # by name, or by the attribute axis of another name
    unit = list(MILLIMETRES)[int(rng.integers(len(MILLIMETRES)))]
    step, first = rng.uniform(0.1, 3, 3) * rng.choice([-1, 1], 3), rng.normal(0, 20, 3)
    time = int(rng.integers(3))  # frames; 0: no such axis
    expected = np.zeros((4, 4))
    expected[3, 3] = 1
    path = str(tmp_path / "a.nc")
    with netCDF4.Dataset(path, "w", format=kind) as file:
        dims = []
        if time:
            file.createDimension("time", None if rng.integers(2) else time)
            file.createVariable("time", "f8", ("time",)).units = "days since 2000-01-01"
            dims.append("time")
        for place, letter in enumerate(order):
            dim = letter if named else f"axis_{letter}"
            dims.append(dim)
            file.createDimension(dim, shape[place])
            axis = file.createVariable(dim, "f8", (dim,))
            axis.units = unit
            if not named:
                axis.axis = letter.upper()
            row = "xyz".index(letter)
            axis[:] = first[row] + step[row] * np.arange(shape[place])
            expected[row, 2 - place] = step[row] * MILLIMETRES[unit]
            expected[row, 3] = first[row] * MILLIMETRES[unit]
        fill = 7 if rng.integers(2) else None
        value = file.createVariable("value", dtype, dims, fill_value=fill)
        value.set_auto_maskandscale(False)
        array = numbers(rng, dtype, ((time,) if time else ()) + shape)
        array.flat[3] = 7
        value[...] = array
        if rng.integers(2):
            value.scale_factor, value.add_offset = float(rng.uniform(0.1, 2)), float(rng.normal())
        if time:
            file["time"][:] = np.arange(time)
    frame = int(rng.integers(time)) if time > 1 else None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        volume = Volume(path, frame=frame)
    with netCDF4.Dataset(path) as file:
        masked = file["value"][...]
        if time:
            masked = masked[frame or 0]
    data = np.ma.getdata(masked).astype(np.float64)
    valid = ~np.broadcast_to(np.ma.getmaskarray(masked), data.shape)
    np.testing.assert_allclose(volume.array[valid], data[valid].astype(np.float32), rtol=3e-7)
    assert np.all(volume.array[~valid] == volume.min)
    np.testing.assert_allclose(affine(volume), expected, rtol=1e-9, atol=1e-9)


def test_netcdf_uneven_and_unitless(tmp_path):
    netCDF4 = pytest.importorskip("netCDF4", reason="python3-netcdf4 is missing")
    path = str(tmp_path / "a.nc")
    with netCDF4.Dataset(path, "w") as file:
        for name, units, values in [
            ("lev", "hPa", [1000, 850, 700]),
            ("lat", "degrees_north", [10, 20, 30]),
            ("lon", "degrees_east", [0, 10, 20, 30]),
        ]:
            file.createDimension(name, len(values))
            axis = file.createVariable(name, "f8", (name,))
            axis.units, axis[:] = units, values
        file.createVariable("t", "f4", ("lev", "lat", "lon"))[...] = np.arange(36).reshape(3, 3, 4)
    volume = Volume(path)
    assert volume.spacing == (1, 1, 1)
    assert any("no common unit of length" in note for note in volume.notes)
    with netCDF4.Dataset(path, "a") as file:
        file["lev"][:] = [1000, 850, 500]
    with pytest.raises(Error, match="lev: uneven coordinates"):
        Volume(path)


def grid_file(path, axes, array, kind="NETCDF4", **variable):
    """Variable v with coordinate variables: name -> (attributes, values), slowest first."""
    netCDF4 = pytest.importorskip("netCDF4", reason="python3-netcdf4 is missing")
    with netCDF4.Dataset(path, "w", format=kind) as file:
        for name, (attributes, values) in axes.items():
            file.createDimension(name, len(values))
            axis = file.createVariable(name, "f8", (name,))
            axis.setncatts(attributes)
            axis[:] = values
        value = file.createVariable("v", array.dtype, tuple(axes), **variable)
        value.set_auto_maskandscale(False)
        value[...] = array


@pytest.mark.parametrize(
    "lev, y, signs",
    [
        (({"units": "m"}, [1, 2, 3]), ({"units": "degrees_north"}, [10, 0, -10, -20]), (1, -1, 1)),
        (({"units": "hPa"}, [1000, 850, 700]), ({"units": "m"}, [9, 6, 3, 0]), (1, -1, 1)),
        (({"units": "hPa"}, [700, 850, 1000]), ({"units": "m"}, [0, 3, 6, 9]), (1, 1, -1)),
        (({"units": "1", "positive": "down"}, [1, 2, 3]), ({"units": "m"}, [0, 3, 6, 9]), (1, 1, -1)),
    ],
)
def test_netcdf_axes_of_unlike_units_keep_their_directions(tmp_path, lev, y, signs):
    path = str(tmp_path / "a.nc")
    x = ({"units": y[0]["units"].replace("north", "east")}, [0, 1, 2])
    grid_file(path, {"lev": lev, "y": y, "x": x}, np.arange(36, dtype="f4").reshape(3, 4, 3))
    volume = read(path)
    np.testing.assert_allclose(affine(volume)[:3, :3], np.diag(signs))


def test_netcdf_depths_point_down(tmp_path):
    path = str(tmp_path / "a.nc")
    depth = ({"units": "m", "positive": "down"}, [1, 4, 7])
    axis = ({"units": "m"}, [0, 1, 2, 3])
    grid_file(path, {"depth": depth, "y": axis, "x": axis}, np.arange(48, dtype="f4").reshape(3, 4, 4))
    matrix = affine(read(path))
    np.testing.assert_allclose(matrix[:3, :3], np.diag([1000, 1000, -3000]))
    np.testing.assert_allclose(matrix[:3, 3], [0, 0, -1000])


@pytest.mark.parametrize("kind", NETCDF_FORMATS[:1] + NETCDF_FORMATS[-2:])
@pytest.mark.parametrize("dtype, fill", [("i2", -32767), ("i4", -2147483647), ("f4", 9.969209968386869e36), ("i1", -127)])
def test_netcdf_default_fill_values(tmp_path, kind, dtype, fill):
    path = str(tmp_path / "a.nc")
    array = np.arange(27).reshape(3, 3, 3).astype(dtype)
    array[1, 1, 1] = fill
    axes = {name: ({}, [0, 1, 2]) for name in "zyx"}
    grid_file(path, axes, array, kind)
    volume = read(path)
    is_byte = dtype == "i1"
    assert (volume.min, volume.max) == (-127 if is_byte else 0, 26)
    assert any("1 of 27 samples contain no data" in note for note in volume.notes) != is_byte
    if dtype != "i4":  # that number would make the samples labels
        # A variable's own value is in place of it.
        grid_file(path, axes, array, kind, fill_value=5)
        assert read(path).array[1, 1, 1] == np.float32(fill)


def test_netcdf_labels_keep_their_numbers_beside_fill_values(tmp_path):
    path = str(tmp_path / "a.nc")
    array = np.repeat(np.array([2**24 + 1, 2**24 + 3, 2**24 + 5], "i4"), 16).reshape(3, 4, 4)
    array[2, 3, 3] = -2147483647
    grid_file(path, {name: ({}, list(range(n))) for name, n in zip("zyx", array.shape)}, array)
    volume = read(path)
    assert [label.number for label in volume.labels] == [2**24 + 1, 2**24 + 3, 2**24 + 5]
