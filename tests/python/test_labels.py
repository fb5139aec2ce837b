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


def test_labels_fade(renderer, atlas, names):
    how = dict(lights=[], camera={"direction": (0, 1, 0)}, size=(48, 32))
    for volume, keys in ((Volume(atlas, label_names=names), {}), (Volume(atlas), {"volume": {"label_names": names}})):
        whole = renderer.render(volume, **keys, **how)
        faded = renderer.render(volume, fade={"visual*": 0.5, 997: 1}, **keys, **how)
        assert 0.2 < faded.color[16, 24, 0] < 0.8 < whole.color[16, 24, 0]
        assert np.abs(faded.color[16, 14] - whole.color[16, 14]).max() < 0.02
        scene = edgesplat.Scene(fade={"visual*": 0.5}, **keys)
        assert scene["volume.hide"] == ["visual*"] and scene["volumes[0].volume.opacity"] == 0.5
        scene.update(fade={"visual*": 1})
        assert scene["volumes"] in (0, None) and not scene["volume.hide"]
        alike = renderer.render(volume, fade={"*": 0.5}, **keys, **how)
        assert alike.color[16, 24, 0] < 0.8
    for wrong in (0, 1.5, "half"):
        with pytest.raises(Error, match=r"fade: 'skin': .* expected an opacity"):
            edgesplat.Scene(fade={"skin": wrong})


def test_what_does_not_fit_is_refused(renderer, atlas):
    with pytest.raises(Error, match="has no label '5'"):
        renderer.render(Volume(atlas), volume={"only": [5]}, size=(16, 16))
    with pytest.raises(Error, match="expected a segmentation"):
        renderer.render("builtin:sphere", volume={"labels": True}, size=(16, 16))
    with pytest.raises(Error, match="chooses labels, but iso_values"):
        renderer.render(Volume(atlas), volume={"only": [997]}, iso_values=[3], size=(16, 16))


def test_iso_values_are_the_numbers_of_the_labels(renderer, atlas):
    assert renderer.render(Volume(atlas), iso_values=[500], size=(16, 16)).iso_values == [500]


@pytest.fixture
def scan():
    """A smooth ellipsoid whose surface lies in the boxes of the atlas."""
    z, y, x = np.meshgrid(*(np.arange(n) - (n - 1) / 2 for n in (12, 12, 18)), indexing="ij")
    return 100 / (1 + np.exp(2 * (np.sqrt(x**2 / 2 + y**2 + z**2) - 3.2)))


def test_labels_colour_a_scan(renderer, scan, atlas, names, tmp_path):
    volume = Volume(scan, spacing=(2, 2, 2), segmentation=atlas, label_names=names)
    assert [label.number for label in volume.labels] == IDS
    assert np.array_equal(volume.array, scan.astype(np.float32))
    values = volume.measure_values()
    for number in IDS:
        inside = scan[atlas == number]
        assert values[number] == pytest.approx((inside.mean(), inside.std()), rel=1e-5)
    assert volume.measure_labels()[IDS[0]].value == 144 * 8
    assert Volume(scan).measure_values() == {}
    how = dict(iso_values=[50], lights=[], camera={"direction": (0, 1, 0)}, size=(48, 32))
    picture = renderer.render(volume, **how)
    red = picture.color[16, 24]
    assert red[0] > 0.9 and red[1] < 0.05
    one = renderer.render(volume, volume={"only": ["visual*"]}, **how)
    assert one.color[..., 3].sum() < 0.7 * picture.color[..., 3].sum()
    assert np.abs(one.color[16, 24] - red).max() < 0.05
    # Another iso-value cuts other matter, also in a volume that was cut before. Without one, that of the whole scan is the
    # scene's.
    other = Volume(scan, spacing=(2, 2, 2), segmentation=atlas, label_names=names)
    only = {"volume": {"only": ["visual*"]}, **how, "iso_values": [90]}
    thin = renderer.render(volume, **only).color
    assert np.array_equal(thin, renderer.render(other, **only).color) and not np.array_equal(thin, one.color)
    del how["iso_values"]
    open_value = renderer.render(volume, volume={"only": ["visual*"]}, **how)
    assert open_value.scene["iso_values"] == pytest.approx([volume.suggest_iso_values(1)[0][0]])


def test_segmentations_may_be_files_and_volumes(renderer, scan, atlas, tmp_path):
    from conftest import write_nrrd

    path = write_nrrd(tmp_path / "seg.nrrd", (atlas > 0).astype(np.uint8), (2, 2, 2))
    array = scan.astype(np.float32)
    write_nrrd(tmp_path / "scan.nrrd", array, (2, 2, 2))
    pictures = []
    for source, segmentation in (
        (array, path),
        (array, Volume(path)),
        (tmp_path / "scan.nrrd", path),
    ):
        spacing = None if source is not array else (2, 2, 2)
        volume = Volume(source, spacing=spacing, segmentation=segmentation)
        pictures.append(renderer.render(volume, iso_values=[50], size=(32, 24), camera={"view": "front"}).color)
    scene = {"volume": {"path": str(tmp_path / "scan.nrrd"), "segmentation": str(path)}, "iso_values": [50]}
    pictures.append(renderer.render(scene=scene, size=(32, 24), camera={"view": "front"}).color)
    for other in pictures[1:]:
        assert np.array_equal(other, pictures[0])
    with pytest.raises(Error, match="expected a segmentation"):
        Volume(scan, segmentation=scan)
