"""Volumes from arrays and files."""

import warnings

import numpy as np
import pytest
from conftest import write_nrrd

import edgesplat
from edgesplat import Error, Volume

DTYPES = ["?", "i1", "u1", "<i2", ">i2", "<u2", ">u2", "<i4", ">i4", "<u4", ">u4", "<i8", ">i8", "<u8", ">u8"]
DTYPES += ["<f2", ">f2", "<f4", ">f4", "<f8", ">f8"]


@pytest.mark.parametrize("dtype", DTYPES)
def test_dtypes(dtype):
    array = (np.arange(60).reshape(3, 4, 5) % 2 if dtype == "?" else np.arange(60).reshape(3, 4, 5)).astype(dtype)
    volume = Volume(array)
    assert volume.shape == (3, 4, 5)
    assert volume.array.dtype == np.float32
    assert np.array_equal(volume.array, array.astype(np.float32))
    assert (volume.min, volume.max) == (array.min(), array.max())
    assert volume.stored_type == str(np.dtype(dtype))


@pytest.mark.parametrize("dtype", ["c8", "O", "U3", "M8[s]"])
def test_invalid_dtypes(dtype):
    with pytest.raises(Error, match="expected integers, floats or bool"):
        Volume(np.zeros((2, 2, 2), dtype=dtype))


def layouts(array):
    yield "C", np.ascontiguousarray(array)
    yield "Fortran", np.asfortranarray(array)
    wide = np.zeros([2 * n for n in array.shape], array.dtype)
    wide[::2, 1::2, ::2] = array
    yield "strided", wide[::2, 1::2, ::2]
    yield "reversed", np.ascontiguousarray(array[::-1, :, ::-1])[::-1, :, ::-1]
    yield "transposed", np.ascontiguousarray(array.transpose(2, 0, 1)).transpose(1, 2, 0)
    read_only = array.copy()
    read_only.setflags(write=False)
    yield "read-only", read_only
    offset = np.zeros(array.nbytes + 1, np.uint8)[1:].view(array.dtype).reshape(array.shape)
    offset[...] = array
    yield "unaligned", offset


@pytest.mark.parametrize("place", range(7))
def test_layouts(place):
    array = np.random.default_rng(1).integers(-500, 500, (5, 6, 7)).astype(np.int16)
    name, same = list(layouts(array))[place]
    assert np.array_equal(same, array), name
    volume = Volume(same)
    assert np.array_equal(volume.array, array.astype(np.float32))
    assert volume.checksum == Volume(array).checksum


def test_broadcast_and_lists():
    assert np.array_equal(Volume(np.broadcast_to(np.arange(4.0), (2, 3, 4))).array[1, 2], [0, 1, 2, 3])
    assert Volume([[[0, 1], [2, 3]], [[4, 5], [6, 7]]]).max == 7


def test_the_array_is_copied_once_and_never_changes():
    array = np.ones((3, 3, 3), np.float32)
    volume = Volume(array)
    array[:] = 5
    assert volume.max == 1 and np.all(volume.array == 1)
    assert not volume.array.flags.writeable
    assert volume.array.base is not None
    with pytest.raises(ValueError):
        volume.array[0, 0, 0] = 2


def test_memory_outlives_the_volume():
    array = Volume(np.full((4, 4, 4), 7.0)).array
    assert np.all(array == 7)


@pytest.mark.parametrize("shape", [(4,), (4, 4), (2, 3, 4, 5), ()])
def test_other_than_three_axes(shape):
    with pytest.raises(Error, match="expected three axes, z, y, x"):
        Volume(np.zeros(shape))


@pytest.mark.parametrize("shape", [(0, 3, 3), (3, 0, 3), (3, 3, 0)])
def test_empty_axes(shape):
    with pytest.raises(Error, match="is empty"):
        Volume(np.zeros(shape))


def test_an_axis_too_long():
    with pytest.raises(Error, match="at most 65535 voxels"):
        Volume(np.zeros((1, 1, 65536), np.uint8))


def test_not_finite():
    array = np.ones((3, 3, 3))
    array[0, 0, 0], array[1, 1, 1], array[2, 2, 2] = np.nan, np.inf, -np.inf
    with pytest.warns(UserWarning, match="3 samples contain no data; they are transparent"):
        volume = Volume(array)
    assert np.all(volume.array == 1)


def test_beyond_float32():
    array = np.ones((2, 2, 2))
    array[0, 0, 0] = 1e300
    with pytest.warns(UserWarning, match="1 samples contain no data"):
        Volume(array)


def test_masked():
    array = np.ma.masked_equal(np.arange(8).reshape(2, 2, 2), 3)
    with pytest.warns(UserWarning, match="1 samples contain no data"):
        volume = Volume(array)
    assert np.array_equal(volume.no_data, array.mask)
    assert Volume(array.filled(0)).max == 7


def test_geometry():
    direction = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    volume = Volume(np.zeros((2, 3, 4)), spacing=(0.5, 1, 2), origin=(1, 2, 3), direction=direction, name="odd")
    assert volume.spacing == (0.5, 1, 2)
    assert volume.origin == (1, 2, 3)
    assert np.array_equal(volume.direction, direction)
    assert not volume.patient
    assert "odd" in repr(volume) and "4 x 3 x 2" in repr(volume)


@pytest.mark.parametrize(
    "options, words",
    [
        ({"spacing": (1, 1)}, "spacing: .* expected 3 numbers"),
        ({"spacing": "abc"}, "spacing: 'abc': expected 3 numbers"),
        ({"spacing": (1, 0, 1)}, "spacing: .* expected lengths above 0"),
        ({"spacing": (1, float("nan"), 1)}, "spacing: .* expected lengths above 0"),
        ({"spacing": (1e-12, 1, 1)}, "expected 1e-9 to 1e9"),
        ({"origin": (0, 0)}, "origin: .* expected 3 numbers"),
        ({"origin": (0, 0, float("inf"))}, "not finite"),
        ({"direction": np.eye(2)}, "direction: shape .* expected 3 x 3"),
        ({"direction": np.ones((3, 3))}, "lie in one plane"),
        ({"direction": np.zeros((3, 3))}, "spacing of axis 0 is 0"),
        ({"name": "builtin:sphere"}, "expected another name"),
        ({"raw": "2x2x2:uint8:little"}, "raw: only for files"),
        ({"component": 0}, "component: only for files"),
        ({"frame": 1}, "frame: 1: only for files"),
    ],
)
def test_wrong_options(options, words):
    with pytest.raises(Error, match=words):
        Volume(np.zeros((2, 2, 2)), **options)


def test_files_and_arrays_agree(tmp_path, ball):
    file = Volume(write_nrrd(tmp_path / "ball.nrrd", ball, (0.5, 0.75, 1.25)))
    array = Volume(ball, spacing=(0.5, 0.75, 1.25))
    assert np.array_equal(file.array, array.array)
    assert file.checksum == array.checksum
    assert file.stored_type == array.stored_type == "int16"
    assert Volume(str(tmp_path / "ball.nrrd"), spacing=(1, 1, 1)).checksum == Volume(ball).checksum


def test_raw_files(tmp_path, ball):
    (tmp_path / "ball.raw").write_bytes(ball.astype(">i2").tobytes())
    volume = Volume(tmp_path / "ball.raw", raw="24x22x20:int16:big")
    assert np.array_equal(volume.array, ball)


def test_missing_files(tmp_path):
    with pytest.raises(Error, match="no such file or folder"):
        Volume(tmp_path / "nothing.nrrd")
    with pytest.raises(Error, match="did you mean|expected one of"):
        Volume("builtin:spere")
    with pytest.raises(Error, match="origin: only for arrays"):
        Volume("builtin:sphere", origin=(0, 0, 0))


def test_truncated_files(tmp_path, ball):
    path = write_nrrd(tmp_path / "ball.nrrd", ball)
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(Error, match="ball.nrrd"):
        Volume(path)


def test_builtin():
    assert "sphere" in edgesplat.builtin_names()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert Volume("builtin:sphere:16").shape == (16, 16, 16)


def test_suggestions(ball):
    found = Volume(ball).suggest_iso_values(2)
    assert 1 <= len(found) <= 2 and found[0][1] == 1
    assert Volume(np.zeros((3, 3, 3))).suggest_iso_values() == []
