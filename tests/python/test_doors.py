"""Three doors, one behaviour: options of the program, keys of scene files, keywords of Python."""

import re
import tomllib
import warnings

import numpy as np
import pytest

import edgesplat
from edgesplat import Error, Scene


# Values of every type of key, as TOML text.
CANDIDATES = ["0.5", "1", "2", "[1.0, 1.0, 1.0]", "[1, 2, 3]", "[0.25]", "[20, 10]", "true", '"word"', '["word"]', '["tau"]']
CANDIDATES += ['"back"', '"draft"', "[[0, 0, 0], [1, 2, 3]]", "[0.0, 1.0]"]
CANDIDATES += ["[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]"]


def sample(key):
    """A value that the key accepts, as TOML text: one of its choices, its default, or any of its type."""
    choices = [f'"{word}"' for word in re.findall(r'"([^"]+)"', key.expected)]
    for text in [*choices, key.default, *CANDIDATES]:
        try:
            tomllib.loads(f"value = {text}")
            Scene()._core.set(f"{concrete(key.path)}={text}")
        except (tomllib.TOMLDecodeError, Error):
            continue
        return text
    return None


def concrete(path):
    return path.replace("[]", "[0]")


def test_every_key_through_three_doors(program, tmp_path):
    """What a file says, the program and Python read alike, and write again alike."""
    values = {concrete(key.path): sample(key) for key in edgesplat.scene_keys()}
    assert not [path for path, text in values.items() if text is None]
    for path, text in values.items():
        scene = Scene()
        scene._core.set(f"{path}={text}")
        assert Scene(scene.text()) == scene, path
        assert scene[path] == Scene({path: tomllib.loads(f"value = {text}")["value"]})[path], path
    options = []
    for path, text in values.items():
        # What depends on the volume, and what excludes another key.
        if re.match(r"volume|camera|iso|transfer|materials|movie|quality\.max_error|effects\.clip|output\.(file|aovs|comp)", path):
            continue
        options += ["--set", f"{path}={text}"]
    assert len(options) >= 80
    again = tmp_path / "a.toml"
    program("scene", "new", "builtin:sphere:16", "-o", again, *options)
    assert program("scene", "check", again).returncode == 0
    written = Scene(again)
    for option in options[1::2]:
        path, _, text = option.partition("=")
        scene = Scene()
        scene._core.set(option)
        assert written[path] == scene[path], path


def test_option_names():
    scene = Scene(iso=[1, 2], look="ct-bone", labels=False, view="back", size=(20, 10))
    assert scene["iso_values"] == [1, 2]
    assert (scene["volume.labels"], scene["camera.view"]) == (False, "back")
    assert scene["output.size"] == [20, 10]
    assert Scene(iso=300)["iso_values"] == [300]
    assert Scene(transfer="mri-brain")["transfer_preset"] == "mri-brain"
    with pytest.raises(Error, match="did you mean iso_values"):
        Scene(iso_value=[300])


def test_colors():
    scene = Scene(iso=[1, 2], color=["tomato", "#00ff00"], extinction=[1, 8], background="navy")
    np.testing.assert_allclose(scene["materials[0].color"], [1, 0.1247718, 0.0630100], atol=1e-6)
    assert scene["materials[1].color"] == [0, 1, 0]
    assert scene["materials[1].extinction"] == 8
    assert scene["background"][2] == pytest.approx(0.2158605)
    assert Scene(iso=1, color=(0.5, 0.25, 1))["materials[0].color"] == [0.5, 0.25, 1]
    with pytest.raises(Error, match="did you mean 'tomato'"):
        Scene(iso=1, color="tomatoe")
    with pytest.raises(Error, match="expected 2, as many"):
        Scene(iso=[1, 2], color=["red", "blue"], extinction=[1, 2, 3])


def test_color_maps():
    def ramp(share):
        return share, 0.5, 1 - share, 1

    scene = Scene(transfer={"map": ramp, "range": (100, 200), "extinction": (0, 2)})
    assert scene["transfer"] == 64
    assert scene["transfer[0].value"] == 100 and scene["transfer[63].value"] == 200
    assert scene["transfer[63].extinction"] == 2
    assert scene["transfer[63].color"] == pytest.approx([1, 0.2140411, 0], abs=1e-6)
    for wrong, message in (
        ({"map": ramp}, "range: expected two values"),
        ({"map": 3, "range": (0, 1)}, "expected a colour map"),
        ({"map": ramp, "range": (1, 0)}, "expected the lower value first"),
        ({"map": ramp, "range": (0, 1), "width": 2}, "'width'"),
    ):
        with pytest.raises(Error, match=message):
            Scene(transfer=wrong)


def test_matplotlib():
    pytest.importorskip("matplotlib", reason="python3-matplotlib is missing")
    assert Scene(transfer={"map": "viridis", "range": (0, 1)})["transfer"] == 64
    with pytest.raises(Error, match="did you mean 'viridis'"):
        Scene(transfer={"map": "viridi", "range": (0, 1)})


def test_same_picture(program, renderer, tmp_path):
    file = tmp_path / "a.toml"
    options = ["--iso", "0.5", "--view", "oblique", "--size", "24x20", "--color", "1,0.2,0.1"]
    program("scene", "new", "builtin:sphere:16", "-o", file, *options)
    program("render", "builtin:sphere:16", "-o", tmp_path / "a.exr", *options)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        of_file = renderer.render(file)
    of_keys = renderer.render("builtin:sphere:16", iso=0.5, view="oblique", size=(24, 20), color=(1, 0.2, 0.1))
    assert np.array_equal(of_file.color, of_keys.color)
    assert of_file.color[..., 0].max() > 0.1
