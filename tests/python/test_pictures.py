"""Pictures as arrays; they equal the program's pictures bit for bit."""

import json

import numpy as np
import pytest
from conftest import SIZE, write_nrrd

import edgesplat
from edgesplat import Camera, Error, Scene, Volume


def same(program, one, other):
    """Whether two picture files are equal bit for bit."""
    return program("compare", one, other, "--max-diff", "0", check=False)


def test_shapes_and_types(renderer, ball):
    picture = renderer.render(ball, size=SIZE, iso_values=[100], aovs=["tau", "depth", "normal", "distance"])
    assert picture.color.shape == (48, 64, 4) and picture.color.dtype == np.float32
    for name, shape in (("tau", (48, 64)), ("depth", (48, 64)), ("normal", (48, 64, 3)), ("distance", (48, 64))):
        array = getattr(picture, name)
        assert array.shape == shape and array.dtype == np.float32
        assert not array.flags.writeable and array.flags.c_contiguous
    middle = (24, 32)
    assert picture.color[middle][3] > 0.9 and picture.color[0, 0][3] == 0
    assert picture.depth[middle] > 0 and picture.depth[0, 0] == 0
    assert np.linalg.norm(picture.normal[middle]) == pytest.approx(1, abs=1e-3)
    assert picture.plain is None and picture.iso_values == [100]
    assert picture.time == 0


def test_only_requested_outputs(renderer, ball):
    picture = renderer.render(ball, size=SIZE, aovs="tau")
    assert picture.tau is not None and picture.depth is None and picture.normal is None and picture.distance is None


def test_arrays_outlive_the_picture(renderer, ball):
    color = renderer.render(ball, size=SIZE).color
    copy = color.copy()
    renderer.render(ball, size=SIZE, camera={"view": "top"})
    assert np.array_equal(color, copy)


def test_statistics(renderer, ball):
    statistics = renderer.render(Volume(ball), size=SIZE).statistics
    assert all(getattr(statistics, name) is not None for name in statistics.__dataclass_fields__)
    assert statistics.voxels == ball.size and 0 < statistics.splats_drawn <= ball.size
    assert statistics.frame_ms > 0 and sum(statistics.passes_ms.values()) > 0
    assert statistics.everything["volume"]["dims"] == [24, 22, 20]
    assert json.dumps(statistics.everything)


def test_camera(renderer, ball):
    picture = renderer.render(ball, size=SIZE, camera=Camera(view="front"))
    assert picture.camera.fov == 45 and picture.camera.direction == pytest.approx((0, 1, 0))
    again = renderer.render(ball, size=SIZE, camera=picture.camera)
    assert np.array_equal(again.color, picture.color)
    voxel = renderer.render(ball, size=SIZE, camera=Camera(eye=(11.5, -40, 9.5), direction=(0, 1, 0), voxel=True))
    assert voxel.camera.eye == (11.5, -40, 9.5)


def test_scene_reproduces_the_picture(renderer, ball):
    volume = Volume(ball)
    picture = renderer.render(volume, size=SIZE, effects={"fog": {"density": 0.01}}, camera={"view": "oblique"})
    scene = picture.scene
    assert scene["volume.checksum"] == volume.checksum
    assert np.array_equal(renderer.render(volume, scene).color, picture.color)
    with pytest.raises(Error, match="the scene was made for"):
        renderer.render(ball + 1, scene)


def test_memory_orders_make_the_same_picture(renderer, ball):
    pictures = [
        renderer.render(array, size=SIZE, iso_values=[100]).color
        for array in (ball, np.asfortranarray(ball), ball.astype(">f8"), ball[::-1][::-1])
    ]
    assert all(np.array_equal(picture, pictures[0]) for picture in pictures)


CASES = {
    "plain": ([], {}),
    "view": (["--view", "oblique", "--fov", "30"], {"camera": {"view": "oblique", "fov": 30}}),
    "eye": (["--eye", "11,-30,9", "--target", "11,10,9"], {"camera": {"eye": [11, -30, 9], "target": [11, 10, 9]}}),
    "materials": (
        ["--iso=60,120", "--color", "1,0,0", "--color", "0,1,0", "--extinction", "0.1", "--extinction", "4"],
        {
            "iso_values": [60, 120],
            "materials": [{"color": [1, 0, 0], "extinction": 0.1}, {"color": [0, 1, 0], "extinction": 4}],
        },
    ),
    "no edges": (["--edges", "off"], {"quality": {"edges": "off"}}),
    "draft": (["--preset", "draft"], {"quality": {"preset": "draft"}}),
    "fog": (["--fog", "0.02", "--background", "0,0,0.2"], {"effects": {"fog": {"density": 0.02}}, "background": [0, 0, 0.2]}),
    "threshold": (["--threshold", "100"], {"volume": {"threshold": 100}}),
    "box filter": (["--box-filter", "--iso", "90"], {"volume": {"box_filter": True}, "iso_values": [90]}),
    "crop": (["--set", "volume.crop_low=0,0,0", "--set", "volume.crop_high=12,21,19"],
             {"volume": {"crop_low": [0, 0, 0], "crop_high": [12, 21, 19]}}),
    "raycast": (["--renderer", "raycast"], {"output": {"renderer": "raycast"}}),
    "reference": (["--renderer", "reference", "--tolerance", "0.05"],
                  {"output": {"renderer": "reference", "tolerance": 0.05}}),
    "clip": (["--set", "effects.clip.keep[0].point=0,9,0", "--set", "effects.clip.keep[0].normal=0,-1,0"],
             {"effects": {"clip": {"keep": [{"point": [0, 9, 0], "normal": [0, -1, 0]}]}}}),
}


@pytest.mark.parametrize("name", CASES)
def test_equal_to_the_program(renderer, program, tmp_path, ball, name):
    options, keys = CASES[name]
    size = (24, 16) if name == "reference" else SIZE
    file = write_nrrd(tmp_path / "ball.nrrd", ball)
    theirs = tmp_path / "theirs.exr"
    program("render", file, "-o", theirs, "--size", f"{size[0]}x{size[1]}", *options)
    for source in (ball, Volume(file), Scene(volume={"path": str(file)})):
        ours = tmp_path / "ours.exr"
        renderer.render(source, size=size, **keys).save(ours)
        compared = same(program, ours, theirs)
        assert compared.returncode == 0, compared.stdout + compared.stderr


def test_saved_files(renderer, program, tmp_path, ball):
    file = write_nrrd(tmp_path / "ball.nrrd", ball)
    program("render", file, "-o", tmp_path / "theirs.png", "--size", "64x48", "--aov", "tau,normal")
    picture = renderer.render(file, size=SIZE, aovs=["tau", "normal"])
    picture.save(tmp_path / "ours.png")
    for ending in ("png", "tau.exr", "normal.exr"):
        assert same(program, tmp_path / f"ours.{ending}", tmp_path / f"theirs.{ending}").returncode == 0
    assert program("rerun", tmp_path / "ours.png", "--check").returncode == 0
    assert picture.png() == picture._repr_png_() and picture.png().startswith(b"\x89PNG")
    with pytest.raises(Error, match="its name must end in .png or .exr"):
        picture.save(tmp_path / "ours.jpg")
    with pytest.raises(Error, match="folder"):
        picture.save(tmp_path / "nowhere" / "ours.png")


def test_comparison_with_plain_splatting(renderer, program, tmp_path, ball):
    file = write_nrrd(tmp_path / "ball.nrrd", ball)
    program("render", file, "-o", tmp_path / "theirs.png", "--size", "64x48", "--compare", "plain")
    picture = renderer.render(file, size=SIZE, output={"compare_plain": True})
    assert picture.plain.shape == picture.color.shape and not np.array_equal(picture.plain, picture.color)
    picture.save(tmp_path / "ours.png")
    assert same(program, tmp_path / "ours.png", tmp_path / "theirs.png").returncode == 0


def test_the_exact_scene(renderer):
    truth = renderer.render("builtin:sphere:24", size=(16, 16), output={"renderer": "truth", "tolerance": 0.05})
    assert truth.color.shape == (16, 16, 4) and truth.color[8, 8, 3] > 0.9
    assert truth.statistics.splats_drawn is None and truth.statistics.device_bytes is None
    with pytest.raises(Error, match="exact scene, which only builtin:NAME volumes have"):
        renderer.render(np.ones((3, 3, 3)), output={"renderer": "truth"})


def test_max_error(renderer, ball):
    picture = renderer.render(ball, size=SIZE, max_error=0.05)
    assert picture.statistics.everything["error"]["expected_rms"] <= 0.05
    with pytest.raises(Error, match="quality.max_error"):
        renderer.render(ball, max_error=2)


@pytest.mark.parametrize(
    "options, words",
    [
        ({"size": (0, 10)}, "output.size"),
        ({"size": (20000, 10)}, "output.size"),
        ({"size": 10}, "output.size"),
        ({"aovs": ["dept"]}, "output.aovs: .*did you mean \"depth\""),
        ({"iso_values": [1e9]}, "no surface has this value"),
        ({"iso_values": [150, 100]}, "iso_values: .*expected ascending values"),
        ({"aovs": ["depth"], "output": {"renderer": "raycast"}}, "no extra outputs"),
        ({"camera": {"eye": [0, 0, 0], "direction": [0, 0, 0]}}, "camera.direction"),
        ({"camera": {"view": "back", "direction": [0, 0, 1]}}, "is given together with view"),
        ({"isovalue": 3}, "isovalue: unknown key"),
        ({"materials": [{}, {}, {}], "iso_values": [100]}, "expected one per iso-value"),
        ({"movie": {"orbit": {}, "path": [{"eye": [0, 0, 0], "target": [1, 1, 1]}]}}, "more than one of path"),
    ],
)
def test_wrong_requests(renderer, ball, options, words):
    with pytest.raises(Error, match=words):
        renderer.render(ball, **options)


def test_a_constant_volume(renderer):
    with pytest.raises(Error, match="array: every voxel has the value 3, so there is no surface to show"):
        renderer.render(np.full((4, 4, 4), 3))


def test_errors_are_those_of_the_program(renderer, program, tmp_path, ball):
    file = write_nrrd(tmp_path / "ball.nrrd", ball)
    for options, keys in (
        (["--iso", "1e9"], {"iso_values": [1e9]}),
        (["--set", "effects.fog.densty=1"], {"effects": {"fog": {"densty": 1}}}),
        (["--renderer", "truth"], {"output": {"renderer": "truth"}}),
    ):
        said = program("render", file, "-o", tmp_path / "no.png", *options, check=False)
        assert said.returncode == 1
        with pytest.raises(Error) as raised:
            renderer.render(file, **keys)
        assert str(raised.value).split(": ", 1)[1] in said.stderr


def test_missing_arguments(renderer):
    with pytest.raises(Error, match="volume.path: is missing"):
        renderer.render(Scene())
    with pytest.raises(Error, match="scene: is given twice"):
        renderer.render(Scene(volume={"path": "builtin:sphere"}), Scene())
    with pytest.raises(Error, match="no such file"):
        renderer.render("nothing.nrrd")


def test_the_default_renderer(ball):
    picture = edgesplat.render(ball, size=SIZE)
    assert np.array_equal(edgesplat.render(Volume(ball), size=SIZE).color, picture.color)
    assert "64 x 48 of array" in repr(picture)
