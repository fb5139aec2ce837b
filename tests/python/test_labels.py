"""Labels of segmentations: the same as in the program."""

import json

import edgesplat
import numpy as np
import pytest
from edgesplat import Error, Label, Volume

IDS = [997, 312782546, 2**63 + 1]


@pytest.fixture
def atlas():
    """Three boxes beside each other."""
    ids = np.zeros((12, 12, 18), np.uint64)
    for box, number in enumerate(IDS):
        ids[3:9, 3:9, 3 + 4 * box : 7 + 4 * box] = number
    return ids


@pytest.fixture
def names(tmp_path):
    path = tmp_path / "names.txt"
    path.write_text("997 root 0 255 0 255\n312782546 visual area 255 0 0 255\n")
    return path


def test_labels_have_their_own_numbers(atlas, names):
    volume = Volume(atlas, spacing=(2, 2, 2), label_names=names)
    assert [label.number for label in volume.labels] == [0] + IDS
    assert volume.labels[2] == Label(312782546, "visual area", (1, 0, 0))
    assert volume.labels[3].name == ""
    found = volume.measure_labels()
    assert {number: quantity.value for number, quantity in found.items()} == {
        0: (18 * 12 * 12 - 3 * 144) * 8,
        **{number: 144 * 8 for number in IDS},
    }
    assert Volume(np.random.default_rng(1).normal(size=(8, 8, 8))).labels == []


def test_each_label_is_drawn_in_its_colour(renderer, atlas, names):
    volume = Volume(atlas, label_names=names)
    how = dict(lights=[], camera={"direction": (0, 1, 0)}, size=(48, 32))
    picture = renderer.render(volume, **how)
    left = picture.color[16, 8:20].max(axis=0)
    middle = picture.color[16, 24]
    assert middle[0] > 0.9 and middle[1] < 0.05
    assert left[1] > 0.9
    one = renderer.render(volume, volume={"only": ["visual*"]}, **how)
    assert one.color[..., 1].max() == 0 and one.color[16, 24, 0] > 0.9
    assert renderer.render(volume, volume={"hide": [312782546]}, **how).color[16, 24, 0] < 0.3
    rays = renderer.render(volume, output={"renderer": "raycast"}, **how)
    assert np.abs(rays.color[16, 24] - middle).max() < 0.05
    assert '"visual*"' in one.scene.text()


def test_what_does_not_fit_is_refused(renderer, atlas):
    with pytest.raises(Error, match="has no label '5'"):
        renderer.render(Volume(atlas), volume={"only": [5]}, size=(16, 16))
    with pytest.raises(Error, match="expected a segmentation"):
        renderer.render("builtin:sphere", volume={"labels": True}, size=(16, 16))
    with pytest.raises(Error, match="chooses labels, but iso_values"):
        renderer.render(Volume(atlas), volume={"only": [997]}, iso_values=[3], size=(16, 16))


def test_iso_values_are_the_numbers_of_the_labels(renderer, atlas):
    assert renderer.render(Volume(atlas), iso_values=[500], size=(16, 16)).iso_values == [500]
