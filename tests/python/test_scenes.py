"""Scenes from dicts, keywords, texts and files, with the program's error messages."""

import numpy as np
import pytest

import edgesplat
from edgesplat import Camera, Error, Scene, SceneError

TEXT = """
iso_values = [100, 150]

[[materials]]
color = [1, 0.5, 0]

[[materials]]
preset = "ct-bone"

[effects.fog]
density = 0.02

[camera]
view = "oblique"
"""


def test_all_forms_of_a_scene_agree(tmp_path):
    nested = {
        "iso_values": [100, 150],
        "materials": [{"color": [1, 0.5, 0]}, {"preset": "ct-bone"}],
        "effects": {"fog": {"density": 0.02}},
        "camera": {"view": "oblique"},
    }
    text = Scene(TEXT)
    assert Scene(nested) == text
    assert Scene(**nested) == text
    assert Scene(text.text()) == text
    assert Scene({"effects.fog.density": 0.02, "camera.view": "oblique"}, **nested) == text
    assert Scene(text) == text and Scene(text) is not text
    assert Scene(text, camera=Camera(view="oblique")) == text
    path = tmp_path / "scene.toml"
    path.write_text("iso_values = [3]\n[volume]\npath = 'builtin:sphere'\n")
    assert Scene(path) == Scene(str(path)) == Scene(iso_values=[3], volume={"path": "builtin:sphere"})
    assert text != Scene() and text != 3


@pytest.mark.parametrize(
    "key, value",
    [
        ("iso_values", [1.5, 2.5]),
        ("ambient", 0.25),
        ("about", 'a "quoted" text\nof two lines \\ and ü'),
        ("camera.eye", [1.0, 2.0, 3.0]),
        ("camera.voxel", True),
        ("output.size", [320.0, 200.0]),
        ("output.aovs", ["tau", "depth"]),
        ("effects.samples", 3),
        ("effects.fog.density", 0.125),
        ("lights[0].color", [1.0, 0.0, 0.5]),
        ("quality.max_error", 0.01),
        ("volume.crop_low", [1.0, 2.0, 3.0]),
        ("movie.orbit.degrees", 90.0),
        ("movie.flight.points", [0.0, 0.0, 0.0, 1.0, 2.0, 3.0]),
    ],
)
def test_keys_are_read_back(key, value):
    scene = Scene()
    given = np.reshape(value, (-1, 3)).tolist() if key.endswith("points") else value
    scene[key] = given
    assert scene[key] == value
    assert Scene(scene.text())[key] == value


def test_numpy_values():
    scene = Scene(iso_values=np.array([1, 2], np.float32), ambient=np.float64(0.5), camera={"voxel": np.bool_(True)})
    scene["camera.eye"] = np.arange(3)
    assert scene["iso_values"] == [1, 2] and scene["ambient"] == 0.5
    assert scene["camera.voxel"] is True and scene["camera.eye"] == [0, 1, 2]


def test_every_key_is_known():
    keys = edgesplat.scene_keys()
    assert len(keys) > 60 and len({key.path for key in keys}) == len(keys)
    assert all(key.help and key.expected for key in keys)
    scene = Scene()
    for key in keys:
        scene[key.path.replace("[]", "[0]")]


def test_tables_can_be_added_and_removed():
    scene = Scene()
    assert scene["effects.fog"] is False and scene["effects.fog.density"] is None
    scene["effects.fog"] = True
    assert scene["effects.fog"] is True and scene["effects.fog.density"] > 0
    scene["effects.fog"] = False
    assert scene["effects.fog"] is False
    scene["effects"] = {"fog": {}}
    assert scene["effects.fog"] is True
    assert scene["lights"] == 1
    scene["lights"] = []
    assert scene["lights"] == 0
    scene["lights"] = [{"kind": "directional", "direction": [0, 0, 1]}, {"kind": "headlight"}]
    assert scene["lights"] == 2 and scene["lights[0].kind"] == "directional"


def test_none_keeps_a_key():
    scene = Scene(ambient=0.5)
    scene.update(ambient=None, camera=Camera(view="back"))
    assert scene["ambient"] == 0.5 and scene["camera.fov"] == 45


def test_keys_override_the_preset():
    for preset in ("draft", "accurate"):
        one = Scene({"quality.sheet_spacing": 0.75, "quality.preset": preset})
        other = Scene({"quality.preset": preset, "quality.sheet_spacing": 0.75})
        assert one == other and one["quality.sheet_spacing"] == 0.75


@pytest.mark.parametrize(
    "content, words",
    [
        ({"effects": {"fog": {"densty": 1}}}, "effects.fog.densty: unknown key; did you mean effects.fog.density?"),
        ({"colour": 1}, "colour: unknown key"),
        ({"ambient": -1}, "ambient: -1.*: expected a number of at least 0"),
        ({"ambient": "much"}, "ambient: 'much': expected a number"),
        ({"ambient": float("nan")}, "ambient: .*: expected a number"),
        ({"camera": {"view": "sideways"}}, "camera.view: .*sideways.*expected one of"),
        ({"camera": {"eye": [1, 2]}}, "camera.eye: .*expected a list of 3 numbers"),
        ({"camera": 3}, "camera: unknown key"),
        ({"output": {"size": [0, 10]}}, "output.size: .*expected a list of 2 whole numbers"),
        ({"lights": [{"kind": "candle"}]}, r"lights\[0\].kind: .*expected one of"),
        ({"lights": {"kind": "headlight"}}, "lights: a table: expected a list of tables"),
        ({"lights[9].intensity": 1}, "expected an index from 0 to"),
        ({"about": object()}, "about: a object: expected a number, a text"),
        ({"iso_values": [1, "two"]}, "iso_values: .*expected a list of numbers"),
        ({"": 1}, "KEY=VALUE"),
    ],
)
def test_wrong_keys(content, words):
    with pytest.raises(Error, match=words):
        Scene(content)


def test_all_or_nothing():
    scene = Scene(ambient=0.5)
    before = scene.text()
    with pytest.raises(Error):
        scene.update({"ambient": 0.75, "background": [1, 2]})
    assert scene.text() == before


def test_errors_name_their_lines():
    with pytest.raises(SceneError) as raised:
        Scene("ambient = -1\n\n[effects.fog]\ndensty = 1\n")
    assert len(raised.value.problems) == 2
    assert raised.value.problems[0].startswith("scene:1: ambient: -1")
    assert raised.value.problems[1].startswith("scene:4: effects.fog.densty: unknown key")
    assert isinstance(raised.value, Error) and isinstance(raised.value, RuntimeError)
    with pytest.raises(SceneError, match="scene:1: no valid TOML"):
        Scene("ambient = = 1")


def test_missing_files(tmp_path):
    with pytest.raises(SceneError, match="nothing.toml"):
        Scene(tmp_path / "nothing.toml")
    with pytest.raises(Error, match="scene: a int: expected"):
        Scene(3)


def test_problems():
    assert Scene(volume={"path": "builtin:sphere"}).problems() == []
    problems = Scene(camera={"view": "back", "eye": [0, 0, 0]}).problems()
    assert any(line.startswith("volume.path: is missing") for line in problems)
    assert any(line.startswith("camera.eye: is given together with view") for line in problems)


def test_commented_text():
    text = Scene(iso_values=[1]).text(comments=True)
    assert "iso_values = [1.0]" in text and "# " in text
    assert Scene(text) == Scene(iso_values=[1])


def test_unknown_keys_cannot_be_read():
    with pytest.raises(Error, match="did you mean effects.fog.density"):
        Scene()["effects.fog.densty"]


def test_the_volume_beside_a_scene_file(tmp_path, ball, monkeypatch):
    from conftest import write_nrrd

    write_nrrd(tmp_path / "ball.nrrd", ball)
    (tmp_path / "scene.toml").write_text('[volume]\npath = "ball.nrrd"\n')
    monkeypatch.chdir("/")
    assert np.array_equal(Scene(tmp_path / "scene.toml").load_volume().array, ball)


def test_several_volumes(tmp_path, ball):
    from conftest import write_nrrd

    write_nrrd(tmp_path / "ball.nrrd", ball)
    moved = np.eye(4)
    moved[0, 3] = 8.5
    scene = Scene(
        volumes=[
            {"volume.path": tmp_path / "ball.nrrd", "color": "tomato", "volume.transform": moved.ravel()},
            tmp_path / "ball.nrrd",
        ],
        size=(40, 30),
    )
    assert scene["volumes"] == 2
    assert scene["volumes[0].volume.transform"][3] == 8.5
    assert scene["volumes[1].volume.path"] == str(tmp_path / "ball.nrrd")
    assert scene["volumes[7].volume.path"] is None
    assert Scene(scene.text()) == scene
    both = edgesplat.render(ball, scene, view="front")
    scene["volumes[0].volume.visible"] = False
    scene["volumes[1].volume.visible"] = False
    one = edgesplat.render(ball, scene, view="front")
    assert np.array_equal(one.color, edgesplat.render(ball, size=(40, 30), view="front").color)
    assert not np.array_equal(one.color, both.color)
    scene["volumes[0].volume.visible"] = True
    again = edgesplat.render(ball, scene, camera=edgesplat.Camera(eye=(4, -60, 5), target=(9, 0, 5)))
    red = again.color[..., 0] > 2 * again.color[..., 2]
    assert red[:, 20:].sum() > 20 > red[:, :12].sum()
    scene["volumes[0].volume.rule"] = "cut"
    cut = edgesplat.render(ball, scene, view="front")
    assert not np.array_equal(one.color, cut.color)
    assert np.array_equal(cut.color, edgesplat.render(ball, scene, view="front").color)
    assert np.array_equal(cut.color, edgesplat.render(ball, cut.scene).color)
    with pytest.raises(Error, match=r"volumes: a int: expected a path or a dict"):
        Scene(volumes=[3])
    with pytest.raises(Error, match=r"volumes\[0\].camera"):
        Scene(volumes=[{"camera.view": "top"}])
    with pytest.raises(Error, match=r"volumes\[0\]: nowhere.nrrd: no such file"):
        edgesplat.render(ball, volumes=["nowhere.nrrd"])
