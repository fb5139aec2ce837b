"""MINC1 and MINC2 against nibabel: place, range and all samples of generated files.

Differences to nibabel that are meant:
- nibabel leaves lengths in the file's unit, and directions as long as they are; here lengths are in mm and directions
  have the length 1, as MINC defines them.
- nibabel clips samples outside of valid_range; here they contain no data.
"""

import shutil
import warnings

import numpy as np
import pytest

from edgesplat import Error, Volume

nibabel = pytest.importorskip("nibabel", reason="python3-nibabel is the reader to compare with")
h5py = pytest.importorskip("h5py", reason="python3-h5py writes MINC2")
netCDF4 = pytest.importorskip("netCDF4", reason="python3-netcdf4 writes MINC1")

LPS = np.diag([-1.0, -1.0, 1.0, 1.0])
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3}
TYPES = {1: ["u1", "i1", "i2", "u2", "i4", "f4", "f8"], 2: ["u1", "i1", "i2", "u2", "i4", "u4", "f4", "f8"]}


class Minc:
    """A MINC file: dims, slowest first, with their attributes, and the image with its scale."""

    def __init__(self, version, names, values):
        self.version, self.names, self.values = version, list(names), values
        self.dims = {name: {"step": 1.0, "start": 0.0} for name in self.names if name.endswith("space")}
        self.valid_range = None
        self.low = self.high = None  # image-min, image-max
        self.units, self.spacing = "mm", "regular__"

    def write(self, path):
        (self.minc1 if self.version == 1 else self.minc2)(path)
        return path

    def attributes(self, name):
        found = dict(self.dims.get(name, {}))
        if found:
            found |= {"units": self.units, "spacing": self.spacing}
        return found

    def minc1(self, path):
        with netCDF4.Dataset(path, "w", format="NETCDF3_CLASSIC") as file:
            for name, length in zip(self.names, self.values.shape):
                file.createDimension(name, length)
                if self.attributes(name):
                    file.createVariable(name, "i4", ()).setncatts(self.attributes(name))
            dtype = self.values.dtype
            image = file.createVariable("image", f"i{dtype.itemsize}" if dtype.kind in "iu" else dtype.str, self.names)
            image.set_auto_maskandscale(False)
            image.setncattr("signtype", "unsigned" if dtype.kind == "u" else "signed__")
            if self.valid_range is not None:
                image.setncattr("valid_range", np.array(self.valid_range, "f8"))
            image[:] = self.values.view(f"i{dtype.itemsize}") if dtype.kind == "u" else self.values
            for name, ends in (("image-min", self.low), ("image-max", self.high)):
                if ends is not None:
                    variable = file.createVariable(name, "f8", self.names[: np.ndim(ends)])
                    variable[...] = ends

    def minc2(self, path):
        with h5py.File(path, "w") as file:
            dims = file.create_group("minc-2.0/dimensions")
            for name, length in zip(self.names, self.values.shape):
                dataset = dims.create_dataset(name, data=np.int32(0))
                dataset.attrs["length"] = np.int32(length)
                for key, value in self.attributes(name).items():
                    dataset.attrs[key] = np.bytes_(value) if isinstance(value, str) else value
            group = file.create_group("minc-2.0/image/0")
            image = group.create_dataset("image", data=self.values, compression="gzip")
            image.attrs["dimorder"] = np.bytes_(",".join(self.names))
            if self.valid_range is not None:
                image.attrs["valid_range"] = np.array(self.valid_range, "f8")
            for name, ends in (("image-min", self.low), ("image-max", self.high)):
                if ends is not None:
                    dataset = group.create_dataset(name, data=np.asarray(ends, "f8"))
                    dataset.attrs["dimorder"] = np.bytes_(",".join(self.names[: np.ndim(ends)]))


def random_values(rng, dtype, shape):
    if np.dtype(dtype).kind == "f":
        return rng.normal(0, 100, shape).astype(dtype)
    info = np.iinfo(dtype)
    return rng.integers(max(info.min, -(2**20)), min(info.max, 2**20), shape, endpoint=True).astype(dtype)


def affine_of(volume):
    affine = np.eye(4)
    affine[:3, :3] = volume.direction * np.array(volume.spacing)
    affine[:3, 3] = volume.origin
    return affine


@pytest.mark.parametrize("seed", range(60))
def test_as_nibabel(seed, tmp_path):
    rng = np.random.default_rng(seed)
    version = 1 + seed % 2
    dtype = rng.choice(TYPES[version])
    names = [f"{axis}space" for axis in rng.permutation(list("xyz"))]
    shape = [int(n) for n in rng.integers(2, 7, 3)]
    minc = Minc(version, names, random_values(rng, dtype, shape))
    directions, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    if seed % 3 == 0:
        directions = directions + 0.05 * rng.normal(size=(3, 3))
        directions /= np.linalg.norm(directions, axis=0)
    for k, name in enumerate(names):
        minc.dims[name] = {
            "step": float(rng.uniform(0.3, 4) * rng.choice([-1, 1])),
            "start": float(rng.uniform(-90, 90)),
            "direction_cosines": directions[:, k],
        }
    minc.units = str(rng.choice(list(UNITS)))
    if np.dtype(dtype).kind != "f" and rng.integers(2):
        minc.valid_range = [minc.values.min(), int(minc.values.max()) + 1]
    count = [(), shape[:1], shape[:2]][rng.integers(3)]
    minc.low = np.array(rng.uniform(-50, 0, count))
    minc.high = np.array(minc.low + rng.uniform(1, 500, count))
    path = minc.write(tmp_path / "a.mnc")
    shutil.copy(path, tmp_path / "named_otherwise")
    # Found by its content. Before nibabel, which leaves the file open: then HDF5 refuses to open it again.
    volume = Volume(tmp_path / "named_otherwise")
    assert Volume(path, spacing=(1, 2, 3)).spacing == pytest.approx((1, 2, 3))

    image = (nibabel.Minc1Image if version == 1 else nibabel.Minc2Image).from_filename(str(path))
    data = np.asanyarray(image.dataobj)
    scale = np.abs(data).max()
    assert volume.array.shape == data.shape
    assert np.allclose(volume.array, data, rtol=1e-6, atol=1e-6 * scale)
    assert np.isclose(volume.min, data.min(), atol=1e-6 * scale) and np.isclose(volume.max, data.max())
    expected = image.affine[:, [2, 1, 0, 3]]  # nibabel's first axis is the slowest
    expected[:3] *= UNITS[minc.units]
    expected = LPS @ expected
    reach = np.abs(expected).max()
    assert np.allclose(affine_of(volume), expected, rtol=1e-6, atol=1e-6 * reach)
    assert volume.patient


@pytest.mark.parametrize("version", [1, 2])
def test_time_and_vectors(version, tmp_path):
    values = np.arange(2 * 3 * 4 * 5 * 3, dtype="i2").reshape(2, 3, 4, 5, 3)
    minc = Minc(version, ["time", "zspace", "yspace", "xspace", "vector_dimension"], values)
    minc.valid_range, minc.low, minc.high = [0, 1000], np.float64(0), np.float64(1000)
    path = minc.write(tmp_path / "a.mnc")
    with pytest.raises(Error, match="--frame 0..1"):
        Volume(path)
    with pytest.raises(Error, match="--component 0..2"):
        Volume(path, frame=1)
    assert np.array_equal(Volume(path, frame=1, component=2).array, values[1, ..., 2])


@pytest.mark.parametrize("version", [1, 2])
def test_labels_and_missing_data(version, tmp_path):
    """A scale of 1 leaves numbers exact; samples outside of valid_range contain no data."""
    ids = np.array([0, 8, 997, 312782546, 312782550, 312782554], "i4")[np.arange(60) % 6].reshape(3, 4, 5)
    minc = Minc(version, ["zspace", "yspace", "xspace"], ids)
    minc.valid_range, minc.low, minc.high = [0, 2**30], np.float64(0), np.float64(2**30)
    assert len(set(Volume(minc.write(tmp_path / "a.mnc")).array.ravel())) == 6
    minc.values = np.arange(60, dtype="i2").reshape(3, 4, 5)
    minc.valid_range, minc.high = [10, 49], np.float64(39)
    with pytest.warns(UserWarning, match="20 samples"):
        volume = Volume(minc.write(tmp_path / "b.mnc"))
    assert (volume.min, volume.max) == (0, 39)


@pytest.mark.parametrize("version", [1, 2])
def test_without_attributes(version, tmp_path):
    minc = Minc(version, ["zspace", "yspace", "xspace"], np.arange(60, dtype="u1").reshape(3, 4, 5))
    minc.low, minc.high = np.float64(0), np.float64(1)
    for name in minc.dims:
        minc.dims[name] = {"comments": "nothing else"}
    path = minc.write(tmp_path / "a.mnc")
    volume = Volume(path)
    assert volume.spacing == (1, 1, 1) and np.allclose(affine_of(volume), LPS)
    image = (nibabel.Minc1Image if version == 1 else nibabel.Minc2Image).from_filename(str(path))
    assert np.allclose(volume.array, np.asanyarray(image.dataobj))


def changed(version, **fields):
    minc = Minc(version, ["zspace", "yspace", "xspace"], np.arange(60, dtype="i2").reshape(3, 4, 5))
    minc.low, minc.high = np.float64(0), np.float64(1)
    for name, value in fields.items():
        if name in minc.dims:
            minc.dims[name] |= value
        else:
            setattr(minc, name, value)
    return minc


@pytest.mark.parametrize("version", [1, 2])
@pytest.mark.parametrize(
    "fields, reason",
    [
        ({"xspace": {"step": 0.0}}, "xspace:step is 0"),
        ({"xspace": {"step": np.nan}}, "xspace:step: nan"),
        ({"yspace": {"start": np.inf}}, "yspace:start: inf"),
        ({"yspace": {"direction_cosines": np.zeros(3)}}, "yspace:direction_cosines"),
        ({"yspace": {"direction_cosines": np.array([1.0, 0, 0])}}, "one plane"),
        ({"spacing": "irregular"}, "irregular"),
        ({"valid_range": [5, 5]}, "valid_range"),
        ({"low": np.float64(np.nan)}, "image-min nan"),
        ({"low": np.zeros(3)}, "image-min, 1 of image-max"),
        ({"names": ["zspace", "yspace", "xfrequency"]}, "xfrequency"),
        ({"names": ["a", "b", "xspace"]}, "dimension b"),
    ],
)
def test_refused(version, fields, reason, tmp_path):
    with pytest.raises(Error, match=reason) as error:
        Volume(changed(version, **fields).write(tmp_path / "a.mnc"))
    assert "a.mnc" in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize("version", [1, 2])
def test_truncated(version, tmp_path):
    content = changed(version).write(tmp_path / "a.mnc").read_bytes()
    for size in (*range(40, len(content) - 8, 97), len(content) - 8):
        (tmp_path / "b.mnc").write_bytes(content[:size])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if version == 1 and size > content.find(b"image-max") + 60 and size >= len(content) - 8:
                continue  # only bytes after the last variable's data may be missing
            with pytest.raises(Error, match="b.mnc"):
                Volume(tmp_path / "b.mnc")
