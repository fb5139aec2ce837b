"""NIfTI and Analyze against nibabel: place, spacing, range and all samples of generated files.

Differences to nibabel that are meant:
- nibabel leaves lengths in the header's unit; here they are in mm.
- nibabel gives a file without sform and qform code a place of its own (centred, x mirrored); here its axes are used as
  stored, because NIfTI defines no orientation for it.
- nibabel adds scl_inter to the real part of complex numbers alone; nifti1.h scales both parts.
- nibabel reads vox_offset 0 of a single file as byte 0; here the voxels begin after the header, or the file is refused.
"""

import gzip
import struct

import numpy as np
import pytest

from edgesplat import Error, Volume

nibabel = pytest.importorskip("nibabel", reason="python3-nibabel is the reader to compare with")

TYPES = {2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 256: "i1", 512: "u2", 768: "u4", 1024: "i8", 1280: "u8"}
COMPOSED = {32: ("f4", 2), 1792: ("f8", 2), 128: ("u1", 3), 2304: ("u1", 4)}  # datatype: type, components
LPS = np.diag([-1.0, -1.0, 1.0, 1.0])
MILLIMETRES = {0: 1.0, 1: 1e3, 2: 1.0, 3: 1e-3}
UNIT_LENGTH = {0: 1.0, 1: 1e-3, 2: 1.0, 3: 1e3}  # about 1 mm


def affine_of(volume):
    """Voxel x, y, z -> world, 4 x 4, mm."""
    affine = np.eye(4)
    affine[:3, :3] = volume.direction * np.array(volume.spacing)
    affine[:3, 3] = volume.origin
    return affine


def expect_same_place(volume, affine, tolerance=1e-6):
    ours = affine_of(volume)
    reach = np.abs(affine[:3, :3]).max() * max(volume.shape) + np.abs(affine[:3, 3]).max()
    assert np.allclose(ours[:3, :3], affine[:3, :3], rtol=0, atol=tolerance * np.abs(affine[:3, :3]).max())
    assert np.allclose(ours, affine, rtol=0, atol=tolerance * reach)


def expect_same_samples(volume, data):
    """data: x, y, z, as nibabel has it."""
    expected = np.asarray(data).T.astype(np.float64)
    scale = np.abs(expected[np.isfinite(expected)]).max(initial=1e-30)
    assert volume.array.shape == expected.shape
    assert np.allclose(volume.array, expected, rtol=1e-6, atol=1e-6 * scale)
    assert np.isclose(volume.min, expected.min(), rtol=1e-6, atol=1e-6 * scale)
    assert np.isclose(volume.max, expected.max(), rtol=1e-6, atol=1e-6 * scale)


class Header:
    """A NIfTI-1 or NIfTI-2 header, written byte by byte from nifti1.h and nifti2.h."""

    def __init__(self, version=1, order="<", single=True):
        self.version, self.order, self.single = version, order, single
        self.dim = [3, 4, 3, 2, 1, 1, 1, 1]
        self.pixdim = [1.0] * 8
        self.datatype, self.bitpix = 4, 16
        self.vox_offset = {1: 352, 2: 544}[version] if single else 0
        self.slope, self.inter = 1.0, 0.0
        self.qform_code, self.sform_code = 0, 1
        self.quatern, self.qoffset = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        self.srow = np.eye(4)[:3]
        self.units = 2
        self.intent = 0
        self.extension = b"\0\0\0\0"

    def bytes(self):
        o = self.order
        place = [*self.quatern, *self.qoffset, *np.asarray(self.srow, float).ravel()]
        if self.version == 1:
            magic = b"n+1\0" if self.single else b"ni1\0"
            head = struct.pack(o + "i35xB8h3f", 348, 0, *self.dim, 0, 0, 0)
            head += struct.pack(o + "4h", self.intent, self.datatype, self.bitpix, 0)
            head += struct.pack(o + "8f3fh2B4f2i", *self.pixdim, self.vox_offset, self.slope, self.inter, 0, 0,
                                self.units, 0, 0, 0, 0, 0, 0)
            head += bytes(104) + struct.pack(o + "2h18f", self.qform_code, self.sform_code, *place) + bytes(16) + magic
        else:
            magic = (b"n+2\0" if self.single else b"ni2\0") + b"\r\n\x1a\n"
            head = struct.pack(o + "i8s2h8q3d8dq4d", 540, magic, self.datatype, self.bitpix, *self.dim, 0, 0, 0,
                               *self.pixdim, self.vox_offset, self.slope, self.inter, 0, 0)
            head = head.ljust(344, b"\0")
            head += struct.pack(o + "2i18d", self.qform_code, self.sform_code, *place)
            head = head.ljust(500, b"\0") + struct.pack(o + "2i", self.units, self.intent)
            head = head.ljust(540, b"\0")
        assert len(head) == {1: 348, 2: 540}[self.version]
        return head

    def write(self, folder, data, name="a.nii"):
        """data: the voxels' bytes. Returns the path to open."""
        path = folder / name
        pack = gzip.compress if name.endswith(".gz") else bytes
        if self.single:
            head = self.bytes() + self.extension
            path.write_bytes(pack(head.ljust(int(self.vox_offset), b"\0") + data))
        else:
            path.write_bytes(pack(self.bytes() + self.extension))
            other = folder / name.replace(".hdr", ".img")
            other.write_bytes(pack(bytes(int(self.vox_offset)) + data))
        return path


def voxels(rng, dtype, count):
    kind, size = np.dtype(dtype).kind, np.dtype(dtype).itemsize
    if kind == "f":
        return rng.normal(0, 100, count).astype(dtype)
    bits = min(8 * size, 22) - (kind == "i")
    return rng.integers(-(2**bits) if kind == "i" else 0, 2**bits, count).astype(dtype)


def random_header(rng):
    header = Header(int(rng.integers(1, 3)), "<>"[rng.integers(2)], bool(rng.integers(4)))
    axes = int(rng.choice([2, 3, 3, 3, 4, 5]))
    header.dim = [axes, *(int(n) for n in rng.integers(2, 7, axes)), *[1] * (7 - axes)]
    if axes == 5:
        header.dim[4] = int(rng.choice([1, 3]))
    header.datatype = int(rng.choice([*TYPES, *TYPES, *COMPOSED]))
    dtype, parts = COMPOSED.get(header.datatype, (TYPES.get(header.datatype), 1))
    header.bitpix = 8 * np.dtype(dtype).itemsize * parts
    header.units = int(rng.integers(4)) | int(rng.choice([0, 8, 16]))
    length = UNIT_LENGTH[header.units & 7]
    header.pixdim = [float(rng.choice([-1, 0, 1])), *(rng.uniform(0.3, 4, 3) * length), *rng.uniform(0.5, 3, 4)]
    header.qform_code, header.sform_code = (int(c) for c in rng.choice([0, 1, 2, 4], 2))
    rotation = rng.normal(size=4)
    rotation /= np.linalg.norm(rotation) * (1 if rotation[0] > 0 else -1)
    if rng.integers(4) == 0:  # by 180 degrees: the square sum may exceed 1 after rounding
        rotation = np.array([0, *(rotation[1:] / np.linalg.norm(rotation[1:]))])
    header.quatern, header.qoffset = list(rotation[1:]), list(rng.uniform(-90, 90, 3) * length)
    while True:
        matrix = rng.normal(size=(3, 3)) * rng.uniform(0.5, 3, 3)  # sheared, of either hand
        if abs(np.linalg.det(matrix)) > 0.1:
            break
    header.srow = np.column_stack([matrix, rng.uniform(-90, 90, 3)]) * length
    header.slope, header.inter = [(1, 0), (0, 7), (np.nan, 3), (2.5, -7), (-0.01, 100), (np.inf, 0)][rng.integers(6)]
    if rng.integers(3) == 0 and header.single:
        header.extension = b"\1\0\0\0" + struct.pack(header.order + "2i", 32, 6) + b"a comment".ljust(24, b"\0")
        header.vox_offset += 32
    if not header.single:
        header.vox_offset = int(rng.choice([0, 16]))
    return header, dtype, parts


@pytest.mark.parametrize("seed", range(160))
def test_as_nibabel(seed, tmp_path):
    rng = np.random.default_rng(seed)
    header, dtype, parts = random_header(rng)
    values = voxels(rng, dtype, int(np.prod(header.dim[1 : header.dim[0] + 1])) * parts)
    name = ("a.nii" if header.single else "a.hdr") + (".gz" if rng.integers(2) else "")
    path = header.write(tmp_path, values.astype(values.dtype.newbyteorder(header.order)).tobytes(), name)

    image = nibabel.load(path)
    # nibabel fails on colours with a scale, which NIfTI does not define.
    data = image.dataobj.get_unscaled() if header.datatype in (128, 2304) else np.asanyarray(image.dataobj)
    chosen = {}
    if parts > 1 or header.dim[5] > 1:
        chosen["component"] = int(rng.integers(parts * header.dim[5]))
    if header.dim[4] > 1:
        chosen["frame"] = int(rng.integers(header.dim[4]))
    data = data.reshape(data.shape + (1,) * (5 - data.ndim))
    component = chosen.get("component", 0)
    data = data[:, :, :, chosen.get("frame", 0), component // parts]
    if header.datatype in (32, 1792):
        scaled = np.isfinite(header.slope) and header.slope != 0
        data = (data.real, data.imag + (header.inter if scaled else 0))[component % 2]
    elif parts > 1:
        data = data["RGBA"[component % parts]]
    volume = Volume(path, **chosen)
    expect_same_samples(volume, data)

    millimetres = MILLIMETRES[header.units & 7]
    if header.sform_code == 0 and header.qform_code == 0:
        expected = np.diag([*header.pixdim[1:4], 1.0])
        expect_same_place(volume, np.diag([millimetres] * 3 + [1.0]) @ expected)
        assert not volume.patient
    else:
        expect_same_place(volume, np.diag([millimetres] * 3 + [1.0]) @ LPS @ image.affine)
        assert volume.patient
    if chosen:
        with pytest.raises(Error, match="--frame|--component"):
            Volume(path)


@pytest.mark.parametrize("version", [1, 2])
@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("dtype", [8, 768, 1024, 1280])
def test_numbers_of_labels(version, order, dtype, tmp_path):
    """Ids beyond 2^24 keep their identity."""
    header = Header(version, order)
    header.datatype, header.bitpix, header.intent = dtype, 8 * np.dtype(TYPES[dtype]).itemsize, 1002
    ids = np.array([0, 8, 997, 312782546, 312782550, 312782554], TYPES[dtype])
    values = ids[np.arange(24) % 6]
    path = header.write(tmp_path, values.astype(values.dtype.newbyteorder(order)).tobytes())
    assert np.array_equal(np.asanyarray(nibabel.load(path).dataobj).T.ravel(), values)
    array = Volume(path).array.ravel()
    assert [len(set(array[values == i])) for i in ids] == [1] * 6
    assert len(set(array)) == 6


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("dtype", [2, 4, 8, 16, 64])
@pytest.mark.parametrize("origin", [(0, 0, 0), (2, 3, 1)])
def test_analyze(order, dtype, origin, tmp_path):
    """Analyze as SPM writes it: nibabel mirrors x, which here is left to the reader of the picture."""
    rng = np.random.default_rng(dtype)
    values = voxels(rng, TYPES[dtype], 60).astype(order + TYPES[dtype])
    head = bytearray(348)
    struct.pack_into(order + "i", head, 0, 348)
    struct.pack_into(order + "8h", head, 40, 4, 5, 4, 3, 1, 0, 0, 0)
    struct.pack_into(order + "2h", head, 70, dtype, 8 * values.itemsize)
    struct.pack_into(order + "4f", head, 76, 0, 1.5, 2, 2.5)
    struct.pack_into(order + "f", head, 112, 0.5)
    struct.pack_into(order + "3h", head, 253, *origin)
    (tmp_path / "a.hdr").write_bytes(head)
    (tmp_path / "a.img").write_bytes(values.tobytes())
    image = nibabel.Spm2AnalyzeImage.from_filename(str(tmp_path / "a.hdr"))
    for name in ("a.hdr", "a.img"):
        volume = Volume(tmp_path / name)
        expect_same_samples(volume, np.asanyarray(image.dataobj)[..., 0])
        assert np.allclose(volume.spacing, image.header.get_zooms()[:3])
        assert not volume.patient and np.array_equal(volume.direction, np.eye(3))
        assert any("which side is left" in note for note in volume.notes)
        if any(origin):
            assert np.allclose(volume.origin[1:], image.affine[1:3, 3])
        else:
            assert volume.origin == (0, 0, 0)


def changed(**fields):
    header = Header()
    for name, value in fields.items():
        setattr(header, name, value)
    return header


NAN_ROW = np.where(np.eye(4)[:3] == 1, np.nan, 0)
REFUSED = {
    "srow_x": changed(srow=NAN_ROW),
    "one plane": changed(srow=np.zeros((3, 4))),
    r"pixdim\[2\]": changed(sform_code=0, qform_code=1, pixdim=[1, 1, 0, 1, 1, 1, 1, 1]),
    r"pixdim\[3\]": changed(sform_code=0, pixdim=[1, 1, 1, np.nan, 1, 1, 1, 1]),
    r"\(qfac\)": changed(sform_code=0, qform_code=1, pixdim=[np.nan, 1, 1, 1, 1, 1, 1, 1]),
    "squares of at most 1": changed(sform_code=0, qform_code=1, quatern=[1, 1, 1]),
    "qoffset_y": changed(sform_code=0, qform_code=1, qoffset=[0, np.inf, 0]),
    "quatern_b": changed(sform_code=0, qform_code=1, quatern=[np.nan, 0, 0]),
    "scl_inter": changed(slope=2.0, inter=np.nan),
    "vox_offset -8": changed(vox_offset=-8),
    "vox_offset 100": changed(vox_offset=100),
    "vox_offset 352.5": changed(vox_offset=352.5),
    "0 axes": changed(dim=[0, 4, 3, 2, 1, 1, 1, 1]),
    "8 axes": changed(dim=[8, 4, 3, 2, 1, 1, 1, 1]),
    "1 axis": changed(dim=[1, 24, 1, 1, 1, 1, 1, 1]),
    "surface": changed(dim=[3, -1, 1, 1, 1, 1, 1, 1]),
    r"dim\[2\] = 0": changed(dim=[3, 4, 0, 2, 1, 1, 1, 1]),
    "truncated": changed(dim=[3, 4, 3, 3, 1, 1, 1, 1]),
    "1 bit": changed(datatype=1, bitpix=1),
    "16 bytes per number": changed(datatype=1536, bitpix=128),
    "datatype 999": changed(datatype=999),
    "CIFTI": changed(intent=3002),
}


@pytest.mark.parametrize("reason", REFUSED)
def test_refused(reason, tmp_path):
    with pytest.raises(Error, match=reason) as error:
        Volume(REFUSED[reason].write(tmp_path, bytes(48)))
    assert "a.nii" in str(error.value) and "\n" not in str(error.value)


ACCEPTED = {
    "NaN in the form that is not used": (changed(srow=NAN_ROW, sform_code=0, qform_code=1), ""),
    "NaN in the qform that is not used": (changed(quatern=[np.nan] * 3), ""),
    "NaN in the qform beside the sform": (changed(quatern=[np.nan] * 3, qform_code=1), "qform is not valid"),
    "zero pixdim beside the sform": (changed(pixdim=[0.0] * 8), ""),
    "negative pixdim": (changed(sform_code=0, qform_code=1, pixdim=[1, -1, 1, 1, 1, 1, 1, 1]), "no sign"),
    "quaternion slightly too long": (changed(sform_code=0, qform_code=1, quatern=[0, 0, 1.00001]), ""),
    "unknown unit": (changed(units=5), "xyzt_units 5"),
    "wrong bitpix": (changed(bitpix=8), "bitpix 8"),
    "vox_offset 0": (changed(vox_offset=0), "begin at byte 352"),
    "forms that disagree": (changed(qform_code=1, qoffset=[3, 4, 0]), "5 mm elsewhere"),
}


@pytest.mark.parametrize("what", ACCEPTED)
def test_accepted(what, tmp_path):
    header, note = ACCEPTED[what]
    values = np.arange(24, dtype="<i2")
    volume = Volume(header.write(tmp_path, values.tobytes()))
    assert np.array_equal(volume.array.ravel(), values)
    assert np.allclose(volume.spacing, 1)
    assert note in " ".join(volume.notes + getattr(volume, "warnings", [note]))
