"""MetaImage headers at random, read by edgesplat and by a second reading written here from MetaIO's documentation; where
VTK is there, its vtkMetaImageReader reads them, too."""

import random
import zlib

import numpy as np
import pytest

from edgesplat import Error, Volume

TYPES = {
    "MET_CHAR": "i1",
    "MET_UCHAR": "u1",
    "MET_SHORT": "i2",
    "MET_USHORT": "u2",
    "MET_INT": "i4",
    "MET_UINT": "u4",
    "MET_LONG": "i4",
    "MET_ULONG": "u4",
    "MET_LONG_LONG": "i8",
    "MET_ULONG_LONG": "u8",
    "MET_FLOAT": "f4",
    "MET_DOUBLE": "f8",
}
UNITS = {"mm": 1, "um": 1e-3, "cm": 10, "?": 1}


# The second reading


def reference(path, component=0, frame=0):
    """Samples [z, y, x] as float64, affine (3, 4) in mm."""
    content = path.read_bytes()
    keys, at = {}, 0
    while "ElementDataFile" not in keys:
        end = content.index(b"\n", at)
        key, value = content[at:end].decode().split("=", 1)
        keys[key.strip()] = value.strip()
        at = end + 1
    count = int(keys["NDims"])
    dims = [int(n) for n in keys["DimSize"].split()]
    channels = int(keys.get("ElementNumberOfChannels", 1))
    msb = keys.get("ElementByteOrderMSB", keys.get("BinaryDataByteOrderMSB", "False")) == "True"
    dtype = np.dtype(TYPES[keys["ElementType"].removesuffix("_ARRAY")]).newbyteorder(">" if msb else "<")
    name = keys["ElementDataFile"]
    needed = int(np.prod(dims)) * channels * dtype.itemsize
    if name == "LOCAL":
        parts = [content[at:]]
    elif name.startswith("LIST"):
        parts = [(path.parent / n).read_bytes() for n in content[at:].decode().split()]
    elif "%" in name:
        pattern, first, last, step = name.split()
        parts = [(path.parent / (pattern % i)).read_bytes() for i in range(int(first), int(last) + 1, int(step))]
    else:
        parts = [(path.parent / name).read_bytes()]
    data = b""
    for part in parts:
        skip = int(keys.get("HeaderSize", 0))
        if keys.get("CompressedData") == "True":
            part = zlib.decompress(part)
        elif skip == -1:
            part = part[len(part) - needed // len(parts) :]
        elif skip > 0 and name != "LOCAL":
            part = part[skip:]
        elif skip > 0:
            part = content[skip:]
        data += part
    if keys.get("BinaryData", "True") == "False":
        data = b" ".join(parts)
        flat = np.array([dtype.type(w) for w in data.split()])
    else:
        flat = np.frombuffer(data[:needed], dtype)
    array = flat.reshape([*dims[::-1], channels])[..., component].astype(np.float64)
    array = array * float(keys.get("ElementToIntensityFunctionSlope", 1)) + float(
        keys.get("ElementToIntensityFunctionOffset", 0)
    )
    if count == 4:
        array = array[frame]
    spacing = [float(s) for s in keys.get("ElementSpacing", keys.get("ElementSize", "1 1 1 1")).split()]
    offset = next((keys[k] for k in ("Offset", "Position", "Origin") if k in keys), "0 0 0 0").split()
    matrix = next((keys[k] for k in ("TransformMatrix", "Rotation", "Orientation") if k in keys), None)
    matrix = np.eye(count) if matrix is None else np.array([float(n) for n in matrix.split()]).reshape(count, count)
    unit = UNITS[keys.get("DistanceUnits", "mm")]
    affine = np.zeros((3, 4))
    for axis in range(min(count, 3)):
        affine[: min(count, 3), axis] = matrix[axis, :3] * spacing[axis] * unit
        affine[axis, 3] = float(offset[axis]) * unit
    if count == 2:
        array = array[None]
        affine[:, 2] = [0, 0, np.sign(np.linalg.det(matrix))]
    return array, affine


# Files at random


def letters_of(directions):
    """AnatomicalOrientation as ITK writes it: the sides from which the axes come."""
    return "".join("RAI"[i] if d[i] > 0 else "LPS"[i] for d in directions for i in [int(np.abs(d).argmax())])


def write_random(folder, seed, for_vtk=False):
    """for_vtk: only what VTK reads as MetaIO defines it."""
    rng, pick = np.random.default_rng(seed), random.Random(seed)
    count = 3 if for_vtk else pick.choice([3, 3, 3, 3, 2, 4])
    dims = [int(n) for n in rng.integers(2, 8, count)]
    channels = pick.choice([1, 1, 1, 2, 3])
    kind = pick.choice([t for t in TYPES if not (for_vtk and "LONG" in t)])
    dtype = np.dtype(TYPES[kind])
    samples = int(np.prod(dims)) * channels
    if dtype.kind == "f":
        data = (rng.standard_normal(samples) * 100).astype(dtype)
    else:
        info = np.iinfo(dtype)
        data = rng.integers(max(info.min, -30000), min(info.max, 60000), samples, dtype=dtype)

    keys = [("ObjectType", "Image"), ("NDims", str(count))]
    rest = [("Modality", "MET_MOD_CT"), ("TransformType", "Rigid"), ("Comment", "a = b: c")][: pick.randrange(4)]
    big = pick.random() < 0.5
    binary = for_vtk or pick.random() < 0.8
    compressed = binary and not for_vtk and pick.random() < 0.4
    rest.append((pick.choice(["ElementByteOrderMSB", "BinaryDataByteOrderMSB"]), str(big)))
    if not binary or pick.random() < 0.5:
        rest.append(("BinaryData", str(binary)))
    if compressed or pick.random() < 0.5:
        rest.append(("CompressedData", str(compressed)))
    if compressed and pick.random() < 0.5:
        rest.append(("CompressedDataSize", "40"))  # wrong sizes are common
    spacing = [f"{s:.5g}" for s in rng.uniform(0.1, 5, count)]
    which = pick.choice(["ElementSpacing", "both"] if for_vtk else ["ElementSpacing", "ElementSize", "both", None])
    if which == "both":
        rest += [("ElementSpacing", " ".join(spacing)), ("ElementSize", "9 " * count)]
    elif which:
        rest.append((which, " ".join(spacing)))
    if pick.random() < 0.8:
        rest.append((pick.choice(["Offset", "Position", "Origin"]), " ".join(f"{v:.6g}" for v in rng.uniform(-99, 99, count))))
    directions = np.eye(count)
    small = min(count, 3)
    if pick.random() < 0.6:
        turned, _ = np.linalg.qr(rng.standard_normal((small, small)))
        if pick.random() < 0.4:
            turned = np.eye(small)[rng.permutation(small)] * rng.choice([-1, 1], small)
        elif pick.random() < 0.3:
            turned = turned @ (np.eye(small) + np.tril(rng.uniform(-0.3, 0.3, (small, small)), -1))
        directions[:small, :small] = turned
        name = pick.choice(["TransformMatrix", "TransformMatrix", "Rotation", "Orientation"])
        rest.append((name, " ".join(repr(float(v)) for v in directions.ravel())))
        if pick.random() < 0.5:
            rest.append(("CenterOfRotation", " ".join(["0"] * count)))
    patient = False
    orientation = pick.choice([None, "???", "RAI", "matching"])
    if orientation == "matching" and count >= 3 and len({int(np.abs(d).argmax()) for d in directions[:3, :3]}) == 3:
        orientation = letters_of(directions[:3, :3])
    elif orientation == "matching":
        orientation = "???"
    if orientation:
        rest.append(("AnatomicalOrientation", orientation))
        patient = orientation != "???"
    if not for_vtk and pick.random() < 0.4:
        rest.append(("DistanceUnits", pick.choice(list(UNITS))))
    if channels > 1:
        rest.append(("ElementNumberOfChannels", str(channels)))
    if not for_vtk and pick.random() < 0.3:
        rest.append(("ElementToIntensityFunctionSlope", "0.5"))
    if not for_vtk and pick.random() < 0.3:
        rest.append(("ElementToIntensityFunctionOffset", "-1024"))
    if pick.random() < 0.2:
        rest += [("ElementMin", "0"), ("ElementMax", "3"), ("ID", "4")]

    stored = data.astype(dtype.newbyteorder(">" if big else "<"))
    form = pick.choice(["LOCAL", "file"] if for_vtk else ["LOCAL", "file", "LIST", "pattern"])
    skip = pick.choice([0, 0, 7, -1]) if binary and not compressed and not for_vtk else 0
    if form == "LOCAL" and skip > 0:
        skip = 0
    if skip:
        rest.append(("HeaderSize", str(skip)))

    def packed(part):
        if not binary:
            return pick.choice([" ", "\n"]).join(repr(v.item()) for v in part).encode()
        if compressed:
            return zlib.compress(part.tobytes())
        return (b"x" * 7 if skip else b"") + part.tobytes()

    pick.shuffle(rest)
    keys += rest + [("DimSize", " ".join(map(str, dims))), ("ElementType", kind + pick.choice(["", "_ARRAY"][: 1 if for_vtk else channels]))]
    path = folder / ("a.mha" if form == "LOCAL" else "a.mhd")
    tail = b""
    if form == "LOCAL":
        keys.append(("ElementDataFile", "LOCAL"))
        tail = packed(stored)
    elif form == "file":
        keys.append(("ElementDataFile", "voxels of a.raw"))
        (folder / "voxels of a.raw").write_bytes(packed(stored))
    else:
        for i, part in enumerate(np.split(stored, dims[-1])):
            (folder / f"s{i + 1:02d}").write_bytes(packed(part))
        keys.append(("ElementDataFile", "LIST" if form == "LIST" else f"s%02d 1 {dims[-1]} 1"))
        tail = "".join(f"s{i + 1:02d}\n" for i in range(dims[-1])).encode() if form == "LIST" else b""
    path.write_bytes("".join(f"{k} = {v}\n" for k, v in keys).encode() + tail)
    component = int(rng.integers(0, channels)) if channels > 1 else None
    return path, component, int(rng.integers(0, dims[3])) if count == 4 else None, patient


@pytest.mark.parametrize("seed", range(120))
def test_header_at_random(tmp_path, seed):
    path, component, frame, patient = write_random(tmp_path, seed)
    voxels, affine = reference(path, component or 0, frame or 0)
    volume = Volume(str(path), component=component, frame=frame)
    header = path.read_bytes()[:1500]
    assert volume.shape == voxels.shape, header
    assert np.allclose(volume.direction * np.array(volume.spacing), affine[:, :3], rtol=1e-9, atol=1e-12), header
    assert np.allclose(volume.origin, affine[:, 3], rtol=1e-12, atol=1e-12), header
    assert np.array_equal(volume.array, voxels.astype(np.float32)), header
    assert volume.patient == patient, header


# VTK's reader: MetaIO itself for keys and samples. Left out, because it differs from MetaIO's definition: DistanceUnits,
# ElementSize alone, the slope of intensities, HeaderSize, files in several parts, text, compressed data (garbage
# without a right CompressedDataSize), MET_LONG (4 bytes in MetaIO, 8 in VTK), MET_LONG_LONG (VTK
# aborts), rows of a sheared matrix, which are no unit vectors.
@pytest.mark.parametrize("seed", range(60))
def test_agrees_with_vtk(tmp_path, seed):
    vtk = pytest.importorskip("vtkmodules.vtkIOImage", reason="VTK's reader is not installed")
    numpy_support = pytest.importorskip("vtkmodules.util.numpy_support")
    path, component, frame, _ = write_random(tmp_path, seed, for_vtk=True)
    header = path.read_bytes()[:1500]
    reader = vtk.vtkMetaImageReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    volume = Volume(str(path), component=component, frame=frame)
    assert image.GetDimensions() == volume.shape[::-1]
    array = numpy_support.vtk_to_numpy(image.GetPointData().GetScalars())
    array = array.reshape([*volume.shape, -1])[..., component or 0]
    assert np.array_equal(volume.array, array.astype(np.float32)), header
    assert np.allclose(volume.origin, image.GetOrigin(), rtol=1e-6), header
    if abs(abs(np.linalg.det(volume.direction)) - 1) < 1e-6:  # not sheared
        assert np.allclose(volume.spacing, image.GetSpacing(), rtol=1e-6), header
        matrix = image.GetDirectionMatrix()
        directions = [[matrix.GetElement(i, j) for j in range(3)] for i in range(3)]
        if not np.allclose(directions, np.eye(3)):  # VTK before 9.3 has no directions
            assert np.allclose(volume.direction, directions, atol=1e-6), header


def write(folder, text, data=b""):
    path = folder / "a.mha"
    path.write_bytes(text.encode() + data)
    return path


HEAD = "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"


@pytest.mark.parametrize(
    "line, reason",
    [
        ("ElementSpacing = 1 0 1", "elementspacing: 0, expected a length above 0"),
        ("ElementSpacing = 1 -1 1", "elementspacing: -1"),
        ("ElementSpacing = 1 nan 1", "'nan' is not a number"),
        ("ElementSpacing = 1 1", "2 numbers, expected 3"),
        ("TransformMatrix = 1 0 0 0 1 0", "6 numbers, expected 9"),
        ("TransformMatrix = 1 0 0 1 0 0 0 0 1", "lie in one plane"),
        ("HeaderSize = 20", "points into the header"),
        ("HeaderSize = -2", "expected -1 or a count"),
        ("ElementToIntensityFunctionSlope = 0", "expected another number"),
        ("ElementNBits = 12", "contradicts"),
        ("Offset = 1 2 3\nPosition = 3 2 1", "contradicts"),
        ("ElementNumberOfChannels = 0", "expected 1 to"),
    ],
)
def test_refuses(tmp_path, line, reason):
    with pytest.raises(Error, match=reason) as error:
        Volume(str(write(tmp_path, HEAD + line + "\nElementDataFile = LOCAL\n", bytes(8))))
    assert "\n" not in str(error.value) and "a.mha" in str(error.value)


def test_refuses_a_header_as_its_own_data(tmp_path):
    with pytest.raises(Error, match="its data file is the header itself"):
        Volume(str(write(tmp_path, HEAD + "ElementDataFile = a.mha\n")))


def test_anatomical_orientation_that_contradicts_the_axes(tmp_path):
    path = write(tmp_path, HEAD + "AnatomicalOrientation = LPS\nElementDataFile = LOCAL\n", bytes(range(8)))
    volume = Volume(str(path))
    assert not volume.patient
    assert any("not certain" in w for w in volume.warnings) if hasattr(volume, "warnings") else True
