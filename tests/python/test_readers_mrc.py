"""MRC and CCP4 maps: samples against mrcfile; place against a second reading of the header, written here from the
definition of MRC2014 (https://www.ccpem.ac.uk/mrc_format/mrc2014.php), because mrcfile computes none.

mrcfile ignores the flags of IMOD and reads mode 0 as signed always; here IMOD's flag decides.
"""

import gzip
import struct
import warnings

import numpy as np
import pytest

from edgesplat import Error, Volume

mrcfile = pytest.importorskip("mrcfile", reason="python3-mrcfile is the reader to compare with")

ANGSTROM = 1e-7  # mm
TYPES = {0: "i1", 1: "i2", 2: "f4", 6: "u2", 12: "f2"}
BASE = {
    "n": (5, 4, 3), "mode": 1, "start": (0, 0, 0), "m": None, "cell": None, "angles": (90, 90, 90), "map": (1, 2, 3),
    "dmin": 0.0, "dmax": 0.0, "ispg": 1, "extended": b"", "imod": None, "origin": (0, 0, 0), "order": "<",
    "signature": b"MAP ", "stamp": None,
}


def mrc(values, **fields):
    """The file's bytes. values: section, row, column. m and cell: along the cell's x, y, z."""
    f = {**BASE, **fields}
    o = f["order"]
    along = [0, 0, 0]
    for n, axis in zip(f["n"], f["map"]):
        along[(axis - 1) % 3] = n
    m = f["m"] or along
    cell = f["cell"] if f["cell"] is not None else [1.5 * k for k in m]
    head = struct.pack(o + "10i6f3i3f2i", *f["n"], f["mode"], *f["start"], *m, *cell, *f["angles"], *f["map"],
                       f["dmin"], f["dmax"], 0, f["ispg"], len(f["extended"]))
    head = head.ljust(152, b"\0")
    if f["imod"] is not None:
        head += struct.pack(o + "2i", 1146047817, f["imod"])
    head = head.ljust(196, b"\0") + struct.pack(o + "3f", *f["origin"]) + f["signature"]
    head += f["stamp"] or {"<": b"\x44\x44\0\0", ">": b"\x11\x11\0\0"}[o]
    data = values if isinstance(values, bytes) else values.astype(values.dtype.newbyteorder(o)).tobytes()
    return head.ljust(1024, b"\0") + f["extended"] + data


def expected_affine(n, m, cell, angles, order, start, origin):
    """Column, row, section -> Angstrom."""
    alpha, beta, gamma = np.radians(angles)
    a = np.array([1, 0, 0])
    b = np.array([np.cos(gamma), np.sin(gamma), 0])
    x = np.cos(beta)
    y = (np.cos(alpha) - np.cos(beta) * np.cos(gamma)) / np.sin(gamma)
    c = np.array([x, y, np.sqrt(1 - x * x - y * y)])
    steps = np.array([a, b, c]) * (np.array(cell, float) / m)[:, None]
    affine = np.eye(4)
    for k, axis in enumerate(order):
        affine[:3, k] = steps[axis - 1]
    affine[:3, 3] = origin if any(origin) else affine[:3, :3] @ np.array(start, float)
    return affine


def affine_of(volume):
    """In Angstrom."""
    affine = np.eye(4)
    affine[:3, :3] = volume.direction * np.array(volume.spacing) / ANGSTROM
    affine[:3, 3] = np.array(volume.origin) / ANGSTROM
    return affine


def of_mode(rng, mode, shape):
    if mode in (2, 12):
        return rng.normal(0, 50, shape).astype(TYPES[mode])
    info = np.iinfo(TYPES[mode])
    return rng.integers(info.min, info.max + 1, shape).astype(TYPES[mode])


@pytest.mark.parametrize("seed", range(80))
def test_generated(seed, tmp_path):
    rng = np.random.default_rng(seed)
    n = [int(k) for k in rng.integers(1, 8, 3)]
    mode = [0, 1, 2, 6, 12][seed % 5]
    values = of_mode(rng, mode, n[::-1])
    order = [int(k) for k in rng.permutation([1, 2, 3])]
    m = [int(k) for k in rng.integers(1, 60, 3)]
    cell = [float(np.float32(k)) for k in rng.uniform(5, 300, 3)]
    angles = [90.0] * 3 if seed % 2 else [float(np.float32(k)) for k in rng.uniform(70, 110, 3)]
    start = [int(k) for k in rng.integers(-40, 40, 3)] if seed % 3 else [0, 0, 0]
    origin = [float(np.float32(k)) for k in rng.uniform(-90, 90, 3)] if seed % 4 == 0 else [0.0, 0.0, 0.0]
    extended = rng.bytes(int(rng.choice([0, 80, 1024])))
    content = mrc(values, n=n, mode=mode, start=start, m=m, cell=cell, angles=angles, map=order, origin=origin,
                  extended=extended, order="<>"[seed % 7 % 2])
    name = ["a.mrc", "a.map", "a.ccp4", "a.rec", "named_otherwise", "a.mrc.gz"][seed % 6]
    path = tmp_path / name
    path.write_bytes(gzip.compress(content) if name.endswith("gz") else content)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with mrcfile.open(path, permissive=True) as file:
            data = np.array(file.data)
            header_n = [int(file.header[k]) for k in ("nx", "ny", "nz")]
            header_cell = [float(file.header.cella[k]) for k in "xyz"]
    assert header_n == n and header_cell == cell
    volume = Volume(path)
    assert np.array_equal(volume.array, data.reshape(n[::-1]).astype(np.float32))
    assert (volume.min, volume.max) == (data.astype(np.float32).min(), data.astype(np.float32).max())
    expected = expected_affine(n, m, cell, angles, order, start, origin)
    assert np.allclose(affine_of(volume), expected, rtol=1e-6, atol=1e-5)
    assert not volume.patient


@pytest.mark.parametrize("order", [(1, 2, 3), (1, 3, 2), (2, 1, 3), (2, 3, 1), (3, 1, 2), (3, 2, 1)])
def test_order_of_axes(order, tmp_path):
    """A mark at x = 2, y = 1, z = 3 voxels is found there whatever the order in the file."""
    sizes = {1: 5, 2: 4, 3: 6}
    mark = {1: 2, 2: 1, 3: 3}
    values = np.zeros([sizes[a] for a in order][::-1], np.float32)
    values[tuple(mark[a] for a in order[::-1])] = 7
    path = tmp_path / "a.mrc"
    path.write_bytes(mrc(values, n=[sizes[a] for a in order], mode=2, map=order, m=[5, 4, 6], cell=[5, 8, 18]))
    volume = Volume(path)
    z, y, x = np.argwhere(volume.array == 7)[0]
    assert np.allclose((affine_of(volume) @ [x, y, z, 1])[:3], [2 * 1, 1 * 2, 3 * 3])


@pytest.mark.parametrize("mode", [1, 2, 6])
def test_stack_of_volumes(mode, tmp_path):
    values = of_mode(np.random.default_rng(mode), mode, (6, 4, 5))
    path = tmp_path / "a.mrcs"
    path.write_bytes(mrc(values, n=(5, 4, 6), mode=mode, ispg=401, m=(5, 4, 3), cell=(5, 4, 3)))
    with mrcfile.open(path) as file:
        assert file.is_volume_stack()
        data = np.array(file.data)
    with pytest.raises(Error, match="--frame 0..1"):
        Volume(path)
    for frame in (0, 1):
        volume = Volume(path, frame=frame)
        assert np.array_equal(volume.array, data[frame].astype(np.float32))
        assert np.allclose(np.array(volume.spacing) / ANGSTROM, 1)


@pytest.mark.parametrize("columns", [4, 5])
def test_four_bits(columns, tmp_path):
    """Mode 101: the first of two samples in the low half of a byte; a row begins with a new byte."""
    values = np.random.default_rng(columns).integers(0, 16, (3, 4, columns)).astype(np.uint8)
    padded = np.pad(values, ((0, 0), (0, 0), (0, columns % 2)))
    packed = (padded[..., ::2] | padded[..., 1::2] << 4).tobytes()
    path = tmp_path / "a.mrc"
    path.write_bytes(mrc(packed, n=(columns, 4, 3), mode=101))
    assert np.array_equal(Volume(path).array, values)


@pytest.mark.parametrize(
    "fields, unsigned",
    [({}, False), ({"imod": 0}, True), ({"imod": 1}, False), ({"dmax": 255.0}, True), ({"dmin": -128.0}, False)],
)
def test_signs_of_bytes(fields, unsigned, tmp_path):
    values = np.arange(60, dtype=np.uint8).reshape(3, 4, 5) * 4
    path = tmp_path / "a.mrc"
    path.write_bytes(mrc(values, mode=0, **fields))
    assert np.array_equal(Volume(path).array, values if unsigned else values.view(np.int8))


def test_colours(tmp_path):
    values = np.arange(180, dtype=np.uint8).reshape(3, 4, 5, 3)
    path = tmp_path / "a.mrc"
    path.write_bytes(mrc(values, mode=16))
    assert np.array_equal(Volume(path, component=2).array, values[..., 2])


@pytest.mark.parametrize(
    "fields, origin",
    [
        ({"origin": (3, 4, 5)}, (3, 4, 5)),
        ({"origin": (3, 4, 5), "imod": 0}, (-3, -4, -5)),
        ({"origin": (3, 4, 5), "imod": 4}, (3, 4, 5)),
        ({"start": (2, 0, -4)}, (3, 0, -6)),
        ({"origin": (3, 4, 5), "start": (2, 0, -4)}, (3, 4, 5)),
        ({"origin": (3, 4, 5), "start": (2, 0, -4), "signature": b"\0\0\0\0"}, (3, 0, -6)),
    ],
)
def test_origin(fields, origin, tmp_path):
    path = tmp_path / "a.mrc"
    path.write_bytes(mrc(np.zeros((3, 4, 5), "i2"), **fields))
    volume = Volume(path)
    assert np.allclose(np.array(volume.origin) / ANGSTROM, origin, atol=1e-5)
    if len(fields) == 2 and "start" in fields:
        assert any("two places" in note for note in volume.notes)


def test_without_cell(tmp_path):
    path = tmp_path / "a.mrc"
    path.write_bytes(mrc(np.zeros((3, 4, 5), "i2"), cell=(0, 0, 0)))
    assert np.allclose(np.array(Volume(path).spacing) / ANGSTROM, 1)
    assert Volume(path, spacing=(1, 2, 3)).spacing == (1, 2, 3)
    path.write_bytes(mrc(np.zeros((1, 4, 5), "i2"), n=(5, 4, 1), cell=(10, 8, 0)))  # one slice
    assert np.allclose(np.array(Volume(path).spacing) / ANGSTROM, 2)


@pytest.mark.parametrize("stamp", [b"\0\0\0\0", b"\x11\x11\0\0"])
def test_wrong_machine_stamp(stamp, tmp_path):
    values = np.arange(60, dtype="i2").reshape(3, 4, 5)
    path = tmp_path / "a.mrc"
    path.write_bytes(mrc(values, stamp=stamp))
    volume = Volume(path)
    assert np.array_equal(volume.array, values)
    assert any("machine stamp" in note for note in volume.notes) == (stamp[0] == 0x11)


WHOLE = np.zeros((3, 4, 5), "i2")


@pytest.mark.parametrize(
    "content, reason",
    [
        (mrc(WHOLE)[:-1], "truncated"),
        (mrc(WHOLE)[:1000], "1024 bytes"),
        (gzip.compress(mrc(WHOLE))[:-9], "truncated"),
        (mrc(WHOLE, mode=4), "Fourier"),
        (mrc(WHOLE, mode=7), "mode 7"),
        (mrc(WHOLE, n=(0, 4, 5)), "not an MRC"),
        (mrc(WHOLE, n=(60000, 60000, 9)), "at most"),
        (mrc(WHOLE, map=(1, 1, 3)), "mapc, mapr, maps"),
        (mrc(WHOLE, cell=(1, np.nan, 1)), "cella.y"),
        (mrc(WHOLE, cell=(1, -5, 1)), "cella.y"),
        (mrc(WHOLE, cell=(1, 0, 1)), "without length"),
        (mrc(WHOLE, angles=(90, 90, 190)), "cellb.gamma"),
        (mrc(WHOLE, angles=(10, 90, 10)), "make no cell"),
        (mrc(WHOLE, origin=(0, 0, np.inf)), "origin.z"),
        (mrc(WHOLE, ispg=401, m=(5, 4, 2)), "multiple of mz"),
        (mrc(WHOLE)[:92] + struct.pack("<i", -1) + mrc(WHOLE)[96:], "nsymbt"),
        (mrc(WHOLE)[:92] + struct.pack("<i", 2**31 - 1) + mrc(WHOLE)[96:], "truncated"),
        (mrc(WHOLE, mode=0, imod=16), "imodFlags 16"),
    ],
)
def test_refused(content, reason, tmp_path):
    path = tmp_path / "a.mrc"
    path.write_bytes(content)
    with pytest.raises(Error, match=reason) as error:
        Volume(path)
    assert "a.mrc" in str(error.value) and "\n" not in str(error.value)
