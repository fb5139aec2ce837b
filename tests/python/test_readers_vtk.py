"""VTK, Voreen and Inviwo files, compared with other readers.

VTK's own writers make legacy and XML files of every kind that bears on place or value, and VTK's own readers say what is
in them. Headers of Voreen and Inviwo are read a second time here, from the formats' definitions.

One known difference to VTK's readers, on purpose: samples that vtkGhostType or vtkValidPointMask hide are no data.
"""

import gzip
import random
import tarfile
import zipfile

import numpy as np
import pytest

from edgesplat import Error, Volume

vtk = pytest.importorskip("vtk", reason="python3-vtk9 is not installed")
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy  # noqa: E402

TYPES = ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"]
ENCODINGS = ["ascii", "binary", "appended-raw", "appended-base64"]
COMPRESSORS = [None, vtk.vtkZLibDataCompressor, vtk.vtkLZ4DataCompressor, vtk.vtkLZMADataCompressor]


def samples(rng, dtype, count, components):
    if dtype[0] == "f":
        values = rng.normal(0, 1000, (count, components))
        values.flat[0] = 0.1
    else:
        info = np.iinfo(dtype)
        low, high = max(info.min, -(2**23)), min(info.max, 2**23)  # exact as float32
        values = rng.integers(low, high, (count, components), endpoint=True)
    return values.astype(dtype)


def rotation(rng):
    matrix, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return matrix  # left-handed ones, too


def add(data, array, name, scalars):
    values = numpy_to_vtk(array, deep=True)
    values.SetName(name)
    if scalars:
        data.SetScalars(values)
    else:
        data.AddArray(values)


def grid_of(rng, dtype, cells, components, arrays, scalars, rectilinear=False, start=True, direction=True):
    """Data with arrays a0, a1, ... whose extent may begin anywhere."""
    points = rng.integers(2, 7, 3)
    first = rng.integers(-5, 6, 3) if start else np.zeros(3, int)
    extent = [int(v) for low, n in zip(first, points) for v in (low, low + n - 1)]
    grid = vtk.vtkRectilinearGrid() if rectilinear else vtk.vtkImageData()
    grid.SetExtent(extent)
    spacing, origin = rng.uniform(0.1, 4, 3), rng.uniform(-100, 100, 3)
    if rectilinear:
        for axis, name in enumerate("XYZ"):
            coordinates = origin[axis] + spacing[axis] * np.arange(points[axis])
            getattr(grid, f"Set{name}Coordinates")(numpy_to_vtk(coordinates.astype(rng.choice(["f4", "f8"])), deep=True))
    else:
        grid.SetSpacing(spacing)
        grid.SetOrigin(origin)
        if direction:
            grid.SetDirectionMatrix(rotation(rng).flatten())
    count = grid.GetNumberOfCells() if cells else grid.GetNumberOfPoints()
    data = grid.GetCellData() if cells else grid.GetPointData()
    for number in range(arrays):
        add(data, samples(rng, dtype, count, components), f"a{number}", scalars and number == 0)
    return grid


def affine_of(grid, cells):
    extent = np.array(grid.GetExtent()).reshape(3, 2)
    points = extent[:, 1] - extent[:, 0] + 1
    first = extent[:, 0] + np.where(cells & (points > 1), 0.5, 0)
    if isinstance(grid, vtk.vtkRectilinearGrid):
        coordinates = [vtk_to_numpy(getattr(grid, f"Get{n}Coordinates")()).astype(float) for n in "XYZ"]
        spacing = np.array([(c[-1] - c[0]) / (len(c) - 1) for c in coordinates])
        corner = np.array([c[0] for c in coordinates]) + np.where(cells, spacing / 2, 0)
        return np.diag(spacing), corner, np.where(cells, np.maximum(points - 1, 1), points)
    matrix = grid.GetDirectionMatrix()
    axes = np.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)]) * np.array(grid.GetSpacing())
    dims = np.where(cells, np.maximum(points - 1, 1), points)
    return axes, np.array(grid.GetOrigin()) + axes @ first, dims


def compare(path, grid, cells, name, component=None):
    """The file as read here against VTK's grid."""
    axes, origin, dims = affine_of(grid, cells)
    volume = Volume(path, component=component)
    array = vtk_to_numpy((grid.GetCellData() if cells else grid.GetPointData()).GetArray(name))
    expected = array if array.ndim == 1 else array[:, component or 0]
    assert volume.shape == tuple(dims[::-1])
    assert np.allclose(volume.direction * np.array(volume.spacing), axes, rtol=1e-6, atol=1e-6)
    assert np.allclose(volume.origin, origin, rtol=1e-6, atol=1e-5)
    assert np.array_equal(volume.array.ravel(), expected.astype(np.float32))
    assert (volume.min, volume.max) == (np.float32(expected.min()), np.float32(expected.max()))


def read_by_vtk(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


@pytest.mark.parametrize("number", range(48))
def test_legacy(tmp_path, number):
    rng = np.random.default_rng(100 + number)
    cells, binary, scalars = bool(number & 1), bool(number & 2), bool(number & 4)
    dtype = TYPES[number % len(TYPES)]
    components = 1 if number % 3 else int(rng.integers(2, 5))
    rectilinear = number % 5 == 4
    grid = grid_of(rng, dtype, cells, components, 1 + number % 2 if scalars else 1, scalars, rectilinear,
                   start=False, direction=False)
    path = tmp_path / "a.vtk"
    writer = vtk.vtkDataSetWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(path))
    writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
    writer.SetFileVersion(51 if number % 7 else 42)
    writer.Write()
    reader = vtk.vtkDataSetReader()
    reader.ReadAllScalarsOn()
    reader.ReadAllFieldsOn()
    same = read_by_vtk(reader, path)
    compare(path, same, cells, "a0", component=int(rng.integers(components)) if components > 1 else None)


@pytest.mark.parametrize("number", range(96))
def test_xml(tmp_path, number):
    rng = np.random.default_rng(200 + number)
    encoding, compressor = ENCODINGS[number % 4], COMPRESSORS[number // 4 % 4]
    cells, scalars, rectilinear = bool(number & 1), bool(rng.integers(2)), number % 6 == 5
    components = 1 if number % 3 else int(rng.integers(2, 5))
    grid = grid_of(rng, TYPES[number % len(TYPES)], cells, components, 1 + int(scalars), scalars, rectilinear)
    path = tmp_path / ("a.vtr" if rectilinear else "a.vti")
    writer = vtk.vtkXMLRectilinearGridWriter() if rectilinear else vtk.vtkXMLImageDataWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(path))
    if encoding == "ascii":
        writer.SetDataModeToAscii()
    elif encoding == "binary":
        writer.SetDataModeToBinary()
    else:
        writer.SetDataModeToAppended()
        writer.SetEncodeAppendedData(encoding.endswith("base64"))
    writer.SetCompressor(None if compressor is None else compressor())
    if compressor is not None:
        writer.SetBlockSize(int(rng.choice([64, 128, 32768])))
    writer.SetHeaderTypeToUInt64() if rng.integers(2) else writer.SetHeaderTypeToUInt32()
    writer.SetByteOrderToBigEndian() if rng.integers(2) else writer.SetByteOrderToLittleEndian()
    writer.Write()
    reader = vtk.vtkXMLRectilinearGridReader() if rectilinear else vtk.vtkXMLImageDataReader()
    same = read_by_vtk(reader, path)
    compare(path, same, cells, "a0", component=int(rng.integers(components)) if components > 1 else None)
    for suffix, pack in ((".gz", gzip.compress), (".tar", None)) if number % 8 == 0 else ():
        packed = tmp_path / (path.name + suffix)
        if pack:
            packed.write_bytes(pack(path.read_bytes()))
        else:
            with tarfile.open(packed, "w") as tar:
                tar.add(path, "inside/" + path.name)
        compare(packed, same, cells, "a0", component=0 if components > 1 else None)


@pytest.mark.parametrize("number", range(16))
def test_parallel(tmp_path, number):
    rng = np.random.default_rng(300 + number)
    cells, rectilinear = bool(number & 1), number % 4 == 3
    grid = grid_of(rng, TYPES[number % len(TYPES)], cells, 1, 1, bool(number & 2), rectilinear)
    path = tmp_path / ("a.pvtr" if rectilinear else "a.pvti")
    writer = vtk.vtkXMLPRectilinearGridWriter() if rectilinear else vtk.vtkXMLPImageDataWriter()
    pieces = int(rng.integers(1, 6))
    writer.SetInputData(grid)
    writer.SetFileName(str(path))
    writer.SetNumberOfPieces(pieces)
    writer.SetStartPiece(0)
    writer.SetEndPiece(pieces - 1)
    writer.SetGhostLevel(int(rng.integers(2)))
    writer.Write()
    compare(path, grid, cells, "a0")
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as out:
        for part in sorted(tmp_path.glob("a*.*v*")) + sorted(tmp_path.glob("a/*")):
            if part.is_file():
                out.write(part, f"study/{part.relative_to(tmp_path)}")
    compare(tmp_path / "a.zip", grid, cells, "a0")


@pytest.mark.parametrize("cells", [False, True])
def test_pieces_in_one_file(tmp_path, cells):
    """Several pieces in a .vti, which VTK's reader puts together."""
    rng = np.random.default_rng(5)
    low, cut, high = -2, 1, 4
    whole = rng.integers(0, 250, (2 + (not cells), 2 + (not cells), high - low + (not cells)))
    text = '<VTKFile type="ImageData" version="1.0"><ImageData WholeExtent="-2 4 0 2 3 5" Origin="1 2 3" Spacing="1 2 3">'
    for first, last in ((low, cut), (cut, high)):
        part = whole[:, :, first - low : last - low + (not cells)]
        numbers = " ".join(str(v) for v in part.ravel())
        array = f'<DataArray type="UInt8" Name="a" format="ascii">{numbers}</DataArray>'
        kind = "CellData" if cells else "PointData"
        text += f'<Piece Extent="{first} {last} 0 2 3 5"><{kind} Scalars="a">{array}</{kind}></Piece>'
    path = tmp_path / "a.vti"
    path.write_text(text + "</ImageData></VTKFile>")
    same = read_by_vtk(vtk.vtkXMLImageDataReader(), path)
    compare(path, same, cells, "a")
    assert np.array_equal(Volume(path).array, whole)


def test_choice_of_arrays(tmp_path):
    rng = np.random.default_rng(6)
    grid = grid_of(rng, "i2", False, 1, 3, False)
    add(grid.GetCellData(), samples(rng, "f4", grid.GetNumberOfCells(), 1), "a0", False)
    path = tmp_path / "a.vti"
    writer = vtk.vtkXMLImageDataWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(path))
    writer.Write()
    compare(path, grid, False, "a0")  # the first, with a warning that names the others
    with pytest.raises(Error, match="PointData/a0 or .*CellData/a0"):
        Volume(f"{path}:a0")
    for name, array, cells in (("a1", "a1", False), ("PointData/a0", "a0", False), ("CellData/a0", "a0", True)):
        compare(f"{path}:{name}", grid, cells, array)


@pytest.mark.parametrize("cells_first", [False, True])
def test_points_go_before_cells(tmp_path, cells_first):
    parts = ["POINT_DATA 8\nSCALARS p short\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8\n"]
    parts.insert(0 if cells_first else 1, "CELL_DATA 1\nSCALARS c short\nLOOKUP_TABLE default\n9\n")
    path = tmp_path / "a.vtk"
    head = "# vtk DataFile Version 3.0\n\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n"
    path.write_text(head + "".join(parts))
    volume = Volume(path)
    assert volume.array.ravel().tolist() == [1, 2, 3, 4, 5, 6, 7, 8]
    assert any("'p' is shown" in note for note in volume.notes)


def test_masks_are_no_data(tmp_path):
    rng = np.random.default_rng(7)
    grid = grid_of(rng, "f4", False, 1, 1, True)
    ghosts = grid.AllocatePointGhostArray()
    for point in (0, 3, 5):
        ghosts.SetValue(point, vtk.vtkDataSetAttributes.HIDDENPOINT)
    path = tmp_path / "a.vti"
    writer = vtk.vtkXMLImageDataWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(path))
    writer.Write()
    with pytest.warns(UserWarning, match="3 samples"):
        Volume(path)


@pytest.mark.parametrize("fault", ["uneven", "nan", "zero", "polygons"])
def test_refused(tmp_path, fault):
    path = tmp_path / "a.vtk"
    if fault == "polygons":
        writer = vtk.vtkPolyDataWriter()
        writer.SetInputData(vtk.vtkPolyData())
    else:
        rectilinear = fault == "uneven"
        grid = grid_of(np.random.default_rng(8), "u1", False, 1, 1, True, rectilinear, start=False, direction=False)
        if rectilinear:
            x = np.arange(grid.GetDimensions()[0], dtype=float)
            x[1] += 0.1 if len(x) > 2 else 0
            grid.SetXCoordinates(numpy_to_vtk(x, deep=True))
        else:
            grid.SetSpacing(float("nan") if fault == "nan" else 0, 1, 1)
        writer = vtk.vtkDataSetWriter()
        writer.SetInputData(grid)
    writer.SetFileName(str(path))
    writer.Write()
    words = {"uneven": "uneven coordinates", "nan": "nan", "zero": "above 0", "polygons": "not image data"}
    with pytest.raises(Error, match=words[fault]):
        Volume(path)


FORMATS = {
    "UCHAR": "u1",
    "CHAR": "i1",
    "USHORT": "u2",
    "USHORT_12": "u2",
    "SHORT": "i2",
    "FLOAT": "f4",
    "DOUBLE": "f8",
    "UINT8": "u1",
    "INT16": "i2",
    "UINT32": "u4",
    "FLOAT32": "f4",
    "FLOAT64": "f8",
}


@pytest.mark.parametrize("number", range(60))
def test_voreen_and_inviwo(tmp_path, number):
    """The second reading: both programs centre the grid, a voxel is a cell of it, and Inviwo's BasisVector lines are the
    rows of the basis matrix."""
    choose = random.Random(number)
    rng = np.random.default_rng(400 + number)
    dims = rng.integers(1, 6, 3)
    name = choose.choice(list(FORMATS))
    vector = choose.choice([1, 1, 2, 3, 4])
    big = choose.random() < 0.4
    skip = choose.choice([0, 0, 7])
    dtype = np.dtype(FORMATS[name]).newbyteorder(">" if big else "<")
    values = samples(rng, FORMATS[name], int(dims.prod()), vector).astype(dtype)
    (tmp_path / "a.raw").write_bytes(b"x" * skip + values.tobytes())
    inviwo = choose.random() < 0.5
    lines = [f"{'RawFile' if inviwo else 'ObjectFileName'}: a.raw", "Resolution: {} {} {}".format(*dims)]
    base = name if vector == 1 or not inviwo else f"Vec{vector}{name}"
    lines += [f"Format: {base}"]
    if vector > 1 and not inviwo:
        model = {2: "LA", 3: "RGB", 4: "RGBA"}[vector]
        lines += [f"ObjectModel: {model}"]
    if skip:
        lines += [f"ByteOffset: {skip}"]
    if big:
        lines += ["ByteOrder: BigEndian"]
    spacing = rng.uniform(0.2, 3, 3)
    basis = np.diag(spacing * dims)
    kind = choose.choice(["none", "spacing", "basis"]) if inviwo else choose.choice(["none", "thickness"])
    if kind == "none":
        basis = np.diag(dims.astype(float))
    elif kind == "basis":
        basis = rotation(rng) @ np.diag(spacing * dims) + rng.uniform(-0.1, 0.1, (3, 3))
        for row in range(3):
            lines += [f"BasisVector{row + 1}: " + " ".join(repr(float(v)) for v in basis[row])]
    else:
        key = "SliceThickness" if kind == "thickness" else "Spacing"
        lines += [f"{key}: " + " ".join(repr(float(v)) for v in spacing)]
    offset = -basis.sum(axis=1) / 2
    if inviwo and choose.random() < 0.5:
        offset = rng.uniform(-50, 50, 3)
        lines += ["Offset: " + " ".join(repr(float(v)) for v in offset)]
    world = np.eye(4)
    if choose.random() < 0.4:
        world[:3] = rng.uniform(-2, 2, (3, 4))
        for row in range(4):
            key = f"WorldVector{row + 1}:" if inviwo else f"TransformMatrix: row{row}"
            lines += [f"{key} " + " ".join(repr(float(v)) for v in world[row])]
    unit = 1.0
    if inviwo and choose.random() < 0.4:
        unit_name, unit = choose.choice([("cm", 10.0), ("um", 0.001), ("m", 1000.0)])
        lines += [f"Axis{axis}Unit: {unit_name}" for axis in (1, 2, 3)]
    slope, intercept = 1.0, 0.0
    if inviwo and choose.random() < 0.4:
        lines += ["DataRange: 0 100", "ValueRange: -1024 3071"]
        slope, intercept = 4095 / 100, -1024.0
    choose.shuffle(lines)
    path = tmp_path / "a.dat"
    path.write_text("\n".join(lines) + "\n")
    component = choose.randrange(vector)
    volume = Volume(path, component=component if vector > 1 else None)
    axes = world[:3, :3] @ basis / dims
    origin = world[:3, :3] @ offset + world[:3, 3] + axes.sum(axis=1) / 2
    assert volume.shape == tuple(dims[::-1])
    assert np.allclose(volume.direction * np.array(volume.spacing), axes * unit, rtol=1e-9, atol=1e-12)
    assert np.allclose(volume.origin, origin * unit, rtol=1e-9, atol=1e-9)
    expected = values[:, component].astype(float)
    expected = (expected if slope == 1 else expected * slope + intercept).astype(np.float32)
    assert np.allclose(volume.array.ravel(), expected, rtol=1e-6, atol=1e-4)
