""".npy and .npz files as NumPy writes them, and as it does not."""

import struct
import zipfile

import numpy as np
import pytest
from numpy.lib import format as npy_format

from edgesplat import Error, Volume

TYPES = ["?", "i1", "u1", "<i2", ">i2", "<u2", ">u2", "<i4", ">i4", "<u4", ">u4", "<i8", ">i8", "<u8", ">u8"]
TYPES += ["<f2", ">f2", "<f4", ">f4", "<f8", ">f8"]


def saved(path, array, version=None):
    with open(path, "wb") as file:
        npy_format.write_array(file, array, version)
    return path


def raw(path, header, data=b"", version=1):
    text = header.encode()
    size = struct.pack("<H" if version == 1 else "<I", len(text))
    path.write_bytes(b"\x93NUMPY" + bytes([version, 0]) + size + text + data)
    return path


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("fortran", [False, True])
def test_types(dtype, fortran, tmp_path):
    rng = np.random.default_rng(len(dtype))
    array = (rng.normal(0, 50, (3, 4, 5)) if "f" in dtype else rng.integers(0, 2 if dtype == "?" else 127, (3, 4, 5)))
    array = np.array(array.astype(dtype), order="F" if fortran else "C")
    path = saved(tmp_path / "a.npy", array)
    assert npy_format.open_memmap(path, mode="r").flags.f_contiguous == fortran
    volume = Volume(path)
    assert np.array_equal(volume.array, np.load(path).astype(np.float32))
    assert volume.checksum == Volume(np.load(path)).checksum  # the same place, too
    assert volume.spacing == (1, 1, 1) and not volume.patient
    assert volume.stored_type == {"?": "bool"}.get(dtype, np.dtype(dtype).name)
    assert Volume(path, spacing=(1, 2, 3)).spacing == (1, 2, 3)


@pytest.mark.parametrize("version", [(1, 0), (2, 0), (3, 0)])
def test_versions(version, tmp_path):
    array = np.arange(24, dtype="<i2").reshape(2, 3, 4)
    assert np.array_equal(Volume(saved(tmp_path / "a.npy", array, version)).array, array)


@pytest.mark.parametrize("fortran", [False, True])
@pytest.mark.parametrize("shape", [(2, 3, 4, 5), (1, 3, 4, 5), (3, 4, 5, 1), (2, 3, 4, 5, 3), (1, 1, 3, 4, 5)])
def test_more_axes(shape, fortran, tmp_path):
    array = np.array(np.arange(np.prod(shape), dtype="<f4").reshape(shape), order="F" if fortran else "C")
    path = saved(tmp_path / "a.npy", array)
    if shape == (2, 3, 4, 5):
        with pytest.raises(Error, match=r"--frame 0..1 .*--component 0..4"):
            Volume(path)
        assert np.array_equal(Volume(path, frame=1).array, array[1])
        assert np.array_equal(Volume(path, component=3).array, array[..., 3])
        with pytest.raises(Error, match="--frame 2"):
            Volume(path, frame=2)
    elif len(shape) == 5 and shape[0] == 2:
        with pytest.raises(Error, match=r"--frame 0..1 .*--component 0..2"):
            Volume(path)
        assert np.array_equal(Volume(path, frame=1, component=2).array, array[1, ..., 2])
    else:
        assert np.array_equal(Volume(path).array, array.reshape(3, 4, 5))


@pytest.mark.parametrize("dtype", ["<c8", ">c8", "<c16", ">c16"])
def test_complex(dtype, tmp_path):
    array = (np.arange(24) + 1j * np.arange(24)[::-1]).reshape(2, 3, 4).astype(dtype)
    path = saved(tmp_path / "a.npy", array)
    with pytest.raises(Error, match="--component 0..1"):
        Volume(path)
    assert np.array_equal(Volume(path, component=0).array, array.real)
    assert np.array_equal(Volume(path, component=1).array, array.imag)


def test_image_and_labels(tmp_path):
    assert Volume(saved(tmp_path / "a.npy", np.ones((3, 4)))).shape == (1, 3, 4)
    ids = np.array([0, 8, 997, 312782546, 312782550, 312782554], np.int64)[np.arange(60) % 6].reshape(3, 4, 5)
    assert len(set(Volume(saved(tmp_path / "b.npy", ids)).array.ravel())) == 6
    half = np.array([np.inf, -np.inf, np.nan, 6e-8, 65504, -0.0, 1, 6.1e-5], np.float16).reshape(2, 2, 2)
    with pytest.warns(UserWarning, match="3 samples contain no data"):
        found = Volume(saved(tmp_path / "c.npy", half)).array
    finite = np.isfinite(half)
    assert np.array_equal(found[finite], half[finite].astype(np.float32))


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_archives(save, tmp_path):
    array = np.arange(24, dtype="<i2").reshape(2, 3, 4)
    save(tmp_path / "one.npz", array)
    assert np.array_equal(Volume(tmp_path / "one.npz").array, array)
    save(tmp_path / "two.npz", image=array, mask=array > 5, affine=np.eye(4))
    with pytest.raises(Error, match=r"image \(2, 3, 4\).*mask.*two.npz:NAME"):
        Volume(tmp_path / "two.npz")
    volume = Volume(f"{tmp_path}/two.npz:mask")
    assert np.array_equal(volume.array, array > 5) and volume.name.endswith("two.npz:mask")
    with pytest.raises(Error, match="no array 'none'; it contains image"):
        Volume(f"{tmp_path}/two.npz:none")
    content = (tmp_path / "two.npz").read_bytes()
    (tmp_path / "cut.npz").write_bytes(content[:-300])
    (tmp_path / "cut.npz").write_bytes(content[: len(content) // 3])
    with pytest.raises(Error, match="cut.npz"):
        Volume(tmp_path / "cut.npz")
    with zipfile.ZipFile(tmp_path / "none.npz", "w") as file:
        file.writestr("a.txt", "hello")
    with pytest.raises(Error, match="without arrays"):
        Volume(tmp_path / "none.npz")


HEADER = "{'descr': '<i2', 'fortran_order': False, 'shape': (2, 2, 2), }"


@pytest.mark.parametrize("header", [
    HEADER,
    HEADER + " " * 40 + "\n",
    '{"shape": (2, 2, 2), "fortran_order": False, "descr": "<i2"}',
    "{'descr': '<i2', 'fortran_order': False, 'shape': (2L, 2L, 2L)}",
    "{ 'descr' :'<i2','fortran_order':False,'shape':(2,2,2,)}",
])
def test_headers(header, tmp_path):
    for version in (1, 2, 3):
        path = raw(tmp_path / "a.npy", header, np.arange(8, dtype="<i2").tobytes(), version)
        assert np.array_equal(Volume(path).array.ravel(), np.arange(8))


@pytest.mark.parametrize(
    "header, reason",
    [
        (HEADER.replace("'<i2'", "[('a', '<i2')]"), "structured"),
        (HEADER.replace("<i2", "|O"), "Python objects"),
        (HEADER.replace("<i2", "<U3"), "'<U3'"),
        (HEADER.replace("<i2", "|V2"), "expected numbers"),
        (HEADER.replace("<i2", "<M8[s]"), "expected numbers"),
        (HEADER.replace("<i2", "<f16"), "expected numbers"),
        (HEADER.replace("<i2", "i2"), "expected numbers"),
        (HEADER.replace("<i2", ""), "expected numbers"),
        (HEADER.replace("False", "0"), "True or False"),
        (HEADER.replace("(2, 2, 2)", "(2, 2, 3)"), "truncated"),
        (HEADER.replace("(2, 2, 2)", "(2, 0, 2)"), "no entries"),
        (HEADER.replace("(2, 2, 2)", "(2, -2, 2)"), "length of the shape"),
        (HEADER.replace("(2, 2, 2)", "()"), "0 axes"),
        (HEADER.replace("(2, 2, 2)", "(8,)"), "1 axis"),
        (HEADER.replace("(2, 2, 2)", "(99999999999, 99999999999, 99999999999)"), r"2\^40"),
        (HEADER.replace("(2, 2, 2)", "(60000, 60000, 9)"), "at most"),
        (HEADER.replace("(2, 2, 2)", "(2, 2, 2, 2, 2, 2)"), "6 axes"),
        (HEADER.replace("(2, 2, 2)", "(99999999999999999999999,)"), "length of the shape"),
        (HEADER.replace("'shape'", "'size'"), "key 'size'"),
        ("{'descr': '<i2', 'fortran_order': False}", "missing"),
        (HEADER[:-1], "expected a string|expected"),
        (HEADER + "x", "end of the header"),
        ("", "expected"),
    ],
)
def test_refused(header, reason, tmp_path):
    path = raw(tmp_path / "a.npy", header, bytes(16))
    with pytest.raises(Error, match=reason) as error:
        Volume(path)
    assert "a.npy" in str(error.value) and "\n" not in str(error.value)
