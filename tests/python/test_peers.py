"""`./dev bench peers` on a small suite: every program draws the same object from the same camera."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

Image = pytest.importorskip("PIL.Image", reason="PIL is not installed: its package is python3-pil")

PEERS = pathlib.Path(__file__).parents[2] / "benchmarks" / "peers"
SUITE = """
[[cases]]
name = "ball"
sizes = [[64, 48]]
scene = { volume = { path = "builtin:sphere:32" }, camera = { view = "oblique" } }
[[cases]]
name = "cloud"
sizes = [[32, 32]]
[cases.scene]
volume = { path = "builtin:phantom:24" }
camera = { view = "front" }
below = { extinction = 0.002 }
materials = [{ extinction = 0.01 }, { extinction = 0.03 }]
[[cases]]
name = "gone"
scene = { volume = { path = "gone.nrrd" } }
"""


def peers(folder, *arguments, display=()):
    suite = folder / "suite.toml"
    suite.write_text(SUITE)
    return subprocess.run(
        [*display, sys.executable, PEERS, "--suite", suite, "-o", folder, "--turns", "1", *arguments],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "DISPLAY": ""},
    )


def rows(folder):
    """The cells of each row of the table, by view and program."""
    found, view = {}, ""
    for line in (folder / "peers.md").read_text().splitlines()[4:]:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        view = cells[0] or view
        found[view, cells[1]] = cells[2:]
    return found


def test_programs_agree(tmp_path):
    if importlib.util.find_spec("vtkmodules") is None:
        pytest.skip("VTK is not installed: its package is python3-vtk9")
    if shutil.which("xvfb-run") is None:
        pytest.skip("xvfb-run is not installed: its package is xvfb")
    run = peers(tmp_path, display=("xvfb-run", "-a"))
    assert run.returncode == 0, run.stderr
    assert "skipped gone: gone.nrrd: no such file" in run.stdout
    errors = {key: (float(cells[-2]), float(cells[-1])) for key, cells in rows(tmp_path).items()}
    worst = {  # RMS of opacity; decibels of colour
        ("ball-64x48", "Edgesplat"): (0.06, 31),
        ("ball-64x48", "Edgesplat, plain"): (0.35, 15),
        ("ball-64x48", "Edgesplat, ray caster"): (0.07, 28),
        ("ball-64x48", "VTK fixed-point rays"): (0.13, 24),
        ("ball-64x48", "VTK GPU rays"): (0.07, 28),
        ("ball-64x48", "VTK polygons"): (0.07, 28),
        ("cloud-32x32", "Edgesplat"): (0.03, 31),
        ("cloud-32x32", "Edgesplat, plain"): (0.04, 29),
        ("cloud-32x32", "Edgesplat, ray caster"): (0.03, 30),
        ("cloud-32x32", "VTK fixed-point rays"): (0.05, 26),
        ("cloud-32x32", "VTK GPU rays"): (0.05, 29),
    }
    assert errors.keys() == worst.keys()
    for key, (opacity, decibels) in errors.items():
        assert opacity < worst[key][0] and decibels > worst[key][1], (key, opacity, decibels)
    assert Image.open(tmp_path / "ball-64x48.png").size == (7 * 64, 48 + 16)
    assert Image.open(tmp_path / "cloud-32x32.png").size == (6 * 32, 32 + 16)
    assert not list(tmp_path.glob("*.new"))


def test_without_a_display(tmp_path):
    run = peers(tmp_path, "ball")
    assert run.returncode == 0, run.stderr
    assert "VTK was not measured: " in run.stderr
    assert "xvfb" in run.stderr or "python3-vtk9" in run.stderr
    assert [program for _, program in rows(tmp_path)] == ["Edgesplat", "Edgesplat, plain", "Edgesplat, ray caster"]


def test_refuses(tmp_path):
    assert "no such case; expected ball, cloud, gone" in peers(tmp_path, "cube").stderr
    assert "--turns 0: expected at least 1" in peers(tmp_path, "--turns", "0").stderr
    assert "no such file" in peers(tmp_path, "--suite", tmp_path / "none.toml").stderr
