"""Fixtures shared by the tests: one renderer, because opening a device is slow, and small volumes."""

import os
import subprocess
import sys

import numpy as np
import pytest

import edgesplat

SIZE = (64, 48)


@pytest.fixture(scope="session")
def renderer():
    with edgesplat.Renderer() as one:
        yield one


@pytest.fixture(scope="session")
def ball():
    """A ball of radius 8 in 24 x 22 x 20 voxels, [z, y, x]: 100 at the surface, falling by 10 per voxel outward."""
    z, y, x = np.mgrid[0:20, 0:22, 0:24]
    radius = np.sqrt((x - 11.5) ** 2 + (y - 10.5) ** 2 + (z - 9.5) ** 2)
    return np.rint(180 - 10 * radius).clip(0).astype(np.int16)


@pytest.fixture(scope="session")
def program():
    """A function that runs the program as python3 -m edgesplat."""

    def run(*arguments, check=True):
        return subprocess.run(
            [sys.executable, "-m", "edgesplat", *map(str, arguments)],
            check=check,
            capture_output=True,
            text=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        )

    return run


def write_nrrd(path, array, spacing=(1.0, 1.0, 1.0)):
    """Writes the array to a NRRD file and returns its path."""
    names = {"int16": "int16", "uint8": "uint8", "float32": "float", "float64": "double"}
    sizes = " ".join(str(n) for n in array.shape[::-1])
    directions = " ".join(
        "(" + ",".join(repr(float(s)) if i == j else "0" for j in range(3)) + ")" for i, s in enumerate(spacing)
    )
    header = (
        f"NRRD0004\ntype: {names[array.dtype.name]}\ndimension: 3\nspace dimension: 3\nsizes: {sizes}\n"
        f"space directions: {directions}\nspace origin: (0,0,0)\nencoding: raw\nendian: little\n\n"
    )
    path.write_bytes(header.encode() + np.ascontiguousarray(array).astype(array.dtype.newbyteorder("<")).tobytes())
    return path
