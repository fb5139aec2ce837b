"""Measured volumes and surfaces, and accuracy reports."""

import json
import math
import threading
import time

import numpy as np
import pytest
from conftest import write_nrrd

import edgesplat
from edgesplat import Error, Interrupted, Volume


def test_a_ball(ball):
    volume = Volume(ball.astype(np.float32), spacing=(0.5, 0.5, 0.5))
    extents = volume.measure(100)
    inside, surface = extents.volumes[1], extents.surfaces[0]
    assert abs(inside.value - 4 / 3 * math.pi * 4**3) <= inside.uncertainty < 0.05 * inside.value
    assert abs(surface.value - 4 * math.pi * 4**2) <= surface.uncertainty < 0.05 * surface.value
    whole = sum(v.value for v in extents.volumes)
    assert whole == pytest.approx(ball.size * 0.5**3, rel=1e-6)
    assert "±" in str(inside)


def test_several_surfaces_agree_with_the_program(ball, program, tmp_path):
    path = write_nrrd(tmp_path / "ball.nrrd", ball)
    extents = Volume(path).measure([60, 100])
    assert len(extents.volumes) == 3 and len(extents.surfaces) == 2
    said = json.loads(program("measure", path, "--iso=60,100", "--json", "-", "-q").stdout)
    materials = said["materials"]
    assert [m["volume_mm3"]["value"] for m in materials] == [v.value for v in extents.volumes]


@pytest.mark.parametrize("values", [[], [2, 1], [1, 1], [math.nan], [[1, 2]]])
def test_invalid_iso_values(ball, values):
    with pytest.raises(Error, match="iso_values"):
        Volume(ball).measure(values)


def test_labels():
    labels = np.zeros((8, 8, 8), np.uint8)
    labels[2:6, 2:6, 2:6] = 7
    found = Volume(labels, spacing=(2, 2, 2)).measure_labels()
    assert found[7].value == 64 * 8 and set(found) == {0, 7}


def test_a_report(renderer, ball, tmp_path):
    asked = dict(iso_values=[100], report=tmp_path / "report", size=(32, 32), cameras=["far"], orbit=0, repeats=1)
    report = renderer.accuracy(Volume(ball), knobs=["saturation"], **asked)
    assert (tmp_path / "report" / "index.html").exists()
    assert report["cameras"][0]["name"] == "far"
    again = renderer.accuracy(Volume(ball), knobs=["saturation"], **asked)
    assert [row["name"] for row in again["rows"]] == [row["name"] for row in report["rows"]]


@pytest.mark.parametrize(
    "wrong", [{"size": (0, 4)}, {"repeats": 0}, {"orbit": -1}, {"tolerance": 1}, {"knobs": ["none"]}, {"cameras": ["none"]}]
)
def test_an_invalid_report_request(renderer, ball, tmp_path, wrong):
    with pytest.raises(Error):
        renderer.accuracy(Volume(ball), iso_values=[100], report=tmp_path / "report", **wrong)


def test_a_report_is_interrupted(renderer, ball, tmp_path):
    def stop():
        time.sleep(0.5)
        renderer.interrupt()

    thread = threading.Thread(target=stop)
    thread.start()
    with pytest.raises(Interrupted):
        renderer.accuracy(Volume(ball), iso_values=[100], report=tmp_path / "report", size=(512, 512))
    thread.join()
    assert renderer.render(Volume(ball), iso_values=[100], size=(32, 32)).color.any()
