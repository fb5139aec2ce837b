"""MGH and MGZ against nibabel: place, range and all samples of generated files.

One difference to nibabel is meant: of a file with goodRASFlag 0, nibabel transposes FreeSurfer's default axes
(setDirectionCosine in mriio.cpp: x left, y down, z forward).
"""

import gzip
import struct

import numpy as np
import pytest

from edgesplat import Error, Volume

nibabel = pytest.importorskip("nibabel", reason="python3-nibabel is the reader to compare with")

TYPES = {0: ">u1", 1: ">i4", 3: ">f4", 4: ">i2"}
LPS = np.diag([-1.0, -1.0, 1.0, 1.0])


def mgh(dims, kind, values, good=1, spacing=(1, 1, 1), axes=np.eye(3), center=(0, 0, 0), version=1):
    """The file's bytes, written from FreeSurfer's description. axes: columns are directions (RAS)."""
    head = struct.pack(">7ih", version, *dims, kind, 0, good)
    head += struct.pack(">15f", *spacing, *np.asarray(axes, float).T.ravel(), *center)
    return head.ljust(284, b"\0") + values.tobytes()


def affine_of(volume):
    affine = np.eye(4)
    affine[:3, :3] = volume.direction * np.array(volume.spacing)
    affine[:3, 3] = volume.origin
    return affine


@pytest.mark.parametrize("seed", range(48))
def test_as_nibabel(seed, tmp_path):
    rng = np.random.default_rng(seed)
    dims = [*(int(n) for n in rng.integers(1, 8, 3)), int(rng.choice([1, 1, 3]))]
    kind = [0, 1, 3, 4][seed % 4]
    dtype = np.dtype(TYPES[kind])
    if kind == 3:
        values = rng.normal(0, 1e3, np.prod(dims)).astype(dtype)
    else:
        values = rng.integers(-5000 * (kind != 0), 5000 if kind else 256, np.prod(dims)).astype(dtype)
    axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    if seed % 3 == 0:
        axes = axes[:, rng.permutation(3)] + 0.05 * rng.normal(size=(3, 3))  # not quite orthogonal
    good = int(seed % 8 != 7)
    content = mgh(dims, kind, values, good, rng.uniform(0.3, 4, 3), axes, rng.uniform(-90, 90, 3))
    if seed % 5 == 0:
        content += struct.pack(">4f", 2000, 0.1, 3, 4)  # times and angle of the scan
    name = ["a.mgh", "a.mgz"][seed % 2]
    path = tmp_path / name
    path.write_bytes(gzip.compress(content) if name == "a.mgz" else content)

    image = nibabel.load(path)
    data = np.asanyarray(image.dataobj).reshape(dims)
    frame = int(rng.integers(dims[3]))
    volume = Volume(path, frame=frame)
    assert np.array_equal(volume.array, data[..., frame].T.astype(np.float32))
    affine = image.affine
    if not good:
        affine = np.array([[-1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
        affine[:3, 3] = -affine[:3, :3] @ dims[:3] / 2
    assert np.allclose(affine_of(volume), LPS @ affine, rtol=1e-6, atol=1e-4)
    assert np.allclose(volume.spacing, image.header.get_zooms()[:3] * np.linalg.norm(axes, axis=0) if good else 1)
    assert volume.patient == bool(good)
    if dims[3] > 1:
        with pytest.raises(Error, match="--frame 0..2"):
            Volume(path)


def test_center_of_odd_and_even_dims(tmp_path):
    """c_ras is the place of voxel dims / 2."""
    for side in (4, 5):
        path = tmp_path / "a.mgh"
        path.write_bytes(mgh([side] * 3 + [1], 0, np.zeros(side**3, ">u1"), center=(10, 20, 30)))
        volume = Volume(path)
        assert np.allclose(volume.origin, (-10 + side / 2, -20 + side / 2, 30 - side / 2))


def test_ushort_and_labels(tmp_path):
    path = tmp_path / "named_otherwise"  # found by its content
    path.write_bytes(mgh([3, 2, 1, 1], 10, np.array([0, 1, 2, 3, 40000, 65535], ">u2"), version=0x0301))
    assert np.array_equal(Volume(path).array.ravel(), [0, 1, 2, 3, 40000, 65535])
    ids = np.array([0, 0, 312782546, 312782547, 312782550, 0], ">i4")
    path.write_bytes(mgh([3, 2, 1, 1], 1, ids))
    assert len(set(Volume(path).array.ravel())) == 4


PLAIN = mgh([2, 2, 2, 1], 0, np.zeros(8, ">u1"))


@pytest.mark.parametrize(
    "content, reason",
    [
        (PLAIN[:-1], "truncated"),
        (PLAIN[:200], "too few"),
        (gzip.compress(PLAIN)[:-9], "truncated|too few"),
        (b"\0\0\0\7" + PLAIN[4:], "version 7"),
        (mgh([0, 2, 2, 1], 0, np.zeros(8, ">u1")), "width 0"),
        (mgh([2, 2, 2, -1], 0, np.zeros(8, ">u1")), "nframes -1"),
        (mgh([70000, 1, 1, 1], 0, np.zeros(70000, ">u1")), "65535"),
        (mgh([60000, 60000, 9, 1], 3, np.zeros(8, ">u1")), "at most"),
        (mgh([2, 2, 2, 1], 6, np.zeros(8, ">u1")), "type 6"),
        (mgh([2, 2, 2, 1], 0, np.zeros(8, ">u1"), spacing=(1, 0, 1)), "spacing 0 of axis 1"),
        (mgh([2, 2, 2, 1], 0, np.zeros(8, ">u1"), spacing=(1, -2, 1)), "spacing -2 of axis 1"),
        (mgh([2, 2, 2, 1], 0, np.zeros(8, ">u1"), center=(0, np.nan, 1)), "expected a number"),
        (mgh([2, 2, 2, 1], 0, np.zeros(8, ">u1"), axes=np.ones((3, 3))), "one plane"),
    ],
)
def test_refused(content, reason, tmp_path):
    path = tmp_path / "a.mgh"
    path.write_bytes(content)
    with pytest.raises(Error, match=reason) as error:
        Volume(path)
    assert "a.mgh" in str(error.value) and "\n" not in str(error.value)
