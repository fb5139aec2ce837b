"""Samples without data, and values of any size."""

import numpy as np
import pytest
from conftest import write_nrrd

import edgesplat
from edgesplat import Error, Volume


def ball(side=20):
    z, y, x = np.mgrid[:side, :side, :side] - (side - 1) / 2
    return np.exp(-0.02 * (x**2 + y**2 + z**2))


@pytest.mark.filterwarnings("ignore:.*contain no data")
def test_marks():
    array = ball().astype(np.float32)
    assert Volume(array).no_data is None
    array[:5] = np.nan
    volume = Volume(array)
    assert np.array_equal(volume.no_data, np.isnan(array))
    assert volume.no_data.dtype == bool
    assert volume.min == np.nanmin(array)
    assert np.all(volume.array[:5] == volume.min)


@pytest.mark.filterwarnings("ignore:.*contain no data")
def test_no_data_by_value(tmp_path):
    array = ball().astype(np.float32)
    array[:5] = -9999
    with pytest.warns(UserWarning, match="samples are -9999, far from the rest"):
        assert Volume(array).no_data is None
    volume = Volume(array, no_data=-9999)
    assert np.array_equal(volume.no_data, array == -9999)
    path = write_nrrd(tmp_path / "a.nrrd", array)
    assert np.array_equal(Volume(path, no_data=-9999).no_data, array == -9999)
    scene = edgesplat.Scene({"volume": {"path": str(path), "no_data": -9999.0}})
    assert np.array_equal(scene.load_volume().no_data, array == -9999)
    with pytest.raises(Error, match="no sample is 7"):
        Volume(array, no_data=7)


@pytest.mark.filterwarnings("ignore:.*contain no data")
def test_picture_is_transparent():
    array = ball().astype(np.float32)
    array[:, :, :10] = np.nan
    look = {"transfer": [{"value": 0.0, "color": [1, 1, 1], "extinction": 3.0}], "output": {"size": [48, 48]}}
    look["camera"] = {"view": "front"}
    whole = edgesplat.render(Volume(ball()), look).color[..., 3]
    part = edgesplat.render(Volume(array), look).color[..., 3]
    assert whole[24, 10] > 0.9 and whole[24, 38] > 0.9
    assert part[24, 10] < 0.01 or part[24, 38] < 0.01


@pytest.mark.parametrize("scale", [1e-60, 1e-30, 1e30, 1e60])
def test_any_size(scale):
    usual, volume = Volume(ball()), Volume(ball() * scale)
    assert volume.max == pytest.approx(usual.max * scale, rel=1e-6)
    np.testing.assert_allclose(volume.array, ball() * scale, rtol=1e-6)
    expected = [(value * scale, strength) for value, strength in usual.suggest_iso_values()]
    for found, wanted in zip(volume.suggest_iso_values(), expected):
        assert found[0] == pytest.approx(wanted[0], rel=1e-2)
    area, wanted = (v.measure(0.5 * s).surfaces[0].value for v, s in ((volume, scale), (usual, 1)))
    assert area == pytest.approx(wanted, rel=1e-4)
    pictures = [
        edgesplat.render(v, iso_values=[0.5 * s], camera={"view": "front"}, output={"size": [48, 48]}).color
        for v, s in ((volume, scale), (usual, 1))
    ]
    assert np.abs(pictures[0] - pictures[1]).max() < 0.02
