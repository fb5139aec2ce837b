"""Views: camera motion, the pictures drawn for it, and the controls of notebooks."""

import struct
import zlib

import numpy as np
import pytest

import edgesplat

from conftest import SIZE


class Counting:
    """A renderer that counts its pictures."""

    def __init__(self, renderer):
        self.renderer, self.count = renderer, 0

    def render(self, *arguments, **options):
        self.count += 1
        return self.renderer.render(*arguments, **options)


@pytest.fixture
def counting(renderer):
    return Counting(renderer)


@pytest.fixture
def view(counting, ball):
    volume = edgesplat.Volume(ball, spacing=(1.0, 1.25, 1.5), origin=(5, -3, 2), name="ball")
    return edgesplat.View(volume, iso_values=[100], camera={"view": "oblique"}, size=SIZE, renderer=counting)


def pixels(png):
    """RGB of an 8-bit PNG, (height, width, 3)."""
    place, header, data = 8, None, b""
    while place < len(png):
        length, kind = struct.unpack(">I4s", png[place : place + 8])
        body = png[place + 8 : place + 8 + length]
        header = struct.unpack(">IIBBBBB", body) if kind == b"IHDR" else header
        data += body if kind == b"IDAT" else b""
        place += 12 + length
    width, height, depth, colour = header[:4]
    assert (depth, colour) == (8, 2)
    lines = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + 3 * width)
    out = np.zeros((height, width, 3), np.uint8)
    for y in range(height):
        filtered = lines[y, 1:].reshape(width, 3).astype(int)
        above = out[y - 1].astype(int) if y else np.zeros((width, 3), int)
        row = np.zeros((width, 3), int)
        for x in range(width):
            left = row[x - 1] if x else np.zeros(3, int)
            corner = above[x - 1] if x else np.zeros(3, int)
            guess = left + above[x] - corner
            far = [abs(guess - one) for one in (left, above[x], corner)]
            paeth = np.where(far[1] <= far[2], above[x], corner)
            paeth = np.where((far[0] <= far[1]) & (far[0] <= far[2]), left, paeth)
            by = [0, left, above[x], (left + above[x]) // 2, paeth][lines[y, 0]]
            row[x] = (filtered[x] + by) % 256
        out[y] = row
    return out


def test_first_view_equals_render(view, renderer):
    same = renderer.render(view.volume, iso_values=[100], camera={"view": "oblique"}, size=SIZE)
    assert np.array_equal(view.picture.color, same.color)
    assert (view.turn, view.tilt, view.wipe, view.flying) == (0, 0, 0, False)
    assert np.allclose(view.target, np.array([5, -3, 2]) + np.array([11.5, 10.5, 9.5]) * [1.0, 1.25, 1.5])


def test_the_scene_makes_the_same_picture(view, renderer):
    view.turn, view.tilt, view.distance, view.iso_values = 35, -20, 50, [80]
    assert np.array_equal(renderer.render(view.volume, view.scene).color, view.picture.color)
    assert view.picture.iso_values == [80]


def test_orbit_keeps_the_target_and_its_place_in_the_picture(view):
    def seen():
        camera = view.camera
        right = np.cross(camera.direction, camera.up)
        return np.array([right, camera.up, camera.direction]) @ (np.array(view.target) - view.eye)

    target, place = np.array(view.target), seen()
    for turn, tilt in [(30, 0), (30, 60), (-170, -90), (400, 90)]:
        view.turn, view.tilt = turn, tilt
        assert np.allclose(view.target, target)
        assert np.allclose(seen(), place)
        assert np.isclose(np.dot(view.camera.direction, view.camera.up), 0)
    view.turn, view.tilt = 360, 0
    assert np.allclose(view.camera.direction, edgesplat.View(view.volume, view.scene, size=SIZE).camera.direction)


def test_flying_keeps_the_eye(view):
    view.flying = True
    eye, direction = view.eye, np.array(view.camera.direction)
    view.turn = 90
    assert view.eye == eye
    assert np.isclose(np.dot(view.camera.direction, direction), 0)
    before = np.array(view.eye)
    view.move(right=1, up=2, forward=3)
    camera = view.camera
    moved = np.array(view.eye) - before
    assert np.isclose(moved @ camera.direction, 3)
    assert np.isclose(moved @ camera.up, 2)
    assert np.isclose(moved @ np.cross(camera.direction, camera.up), 1)


def test_turning_right_moves_the_picture_to_the_left(view):
    view.flying = True
    shown = view.picture.color[..., 3].sum(axis=0)
    view.turn = 10
    turned = view.picture.color[..., 3].sum(axis=0)
    columns = np.arange(SIZE[0])
    assert (turned @ columns) / turned.sum() < (shown @ columns) / shown.sum() - 3


def test_distance_moves_the_eye_on_its_line(view):
    target, direction = np.array(view.target), np.array(view.target) - view.eye
    view.distance = view.distance / 2
    assert np.allclose(view.target, target)
    assert np.allclose(target - view.eye, direction / 2)


def test_only_requested_pictures_are_drawn(view, counting):
    assert counting.count == 1
    view.turn, view.tilt, view.distance = 10, 20, 40
    view.move(forward=1)
    assert counting.count == 1
    view.png(), view.png(), view.picture
    assert counting.count == 2
    view.wipe = 0.5
    view.png()
    assert counting.count == 3, "one more picture, for the left side of the divider"
    view.wipe = 0.7
    view.png()
    assert counting.count == 3, "the divider needs no new picture"
    view.turn = 11
    view.wipe = 0
    view.png()
    assert counting.count == 4


@pytest.mark.parametrize("against", ["plain", "raycast"])
def test_left_of_the_divider_is_the_other_picture(view, renderer, against):
    other = {"plain": {"quality": {"edges": "off"}}, "raycast": {"output": {"renderer": "raycast"}}}[against]
    view.against, view.wipe = against, 0.5
    shown = pixels(view.png())
    line = round(0.5 * (SIZE[0] - 1))
    left = pixels(renderer.render(view.volume, view.scene, **other).png())
    right = pixels(view.picture.png())
    assert np.array_equal(shown[:, :line], left[:, :line])
    assert np.all(shown[:, line] == 255)
    assert np.array_equal(shown[:, line + 1 :], right[:, line + 1 :])
    assert not np.array_equal(left, right)


def test_a_camera_is_a_new_first_view(view, renderer):
    view.turn = 50
    view.camera = edgesplat.Camera(view="front")
    assert (view.turn, view.tilt) == (0, 0)
    same = renderer.render(view.volume, iso_values=[100], camera={"view": "front"}, size=SIZE)
    assert np.array_equal(view.picture.color, same.color)


def test_an_eye_inside_has_a_target_ahead(view):
    middle = view.target
    view.camera = edgesplat.Camera(eye=middle, direction=(1, 0, 0), up=(0, 0, 1))
    view.turn = 45
    assert view.distance > 0
    assert np.all(np.isfinite(view.picture.color))


@pytest.mark.parametrize(
    "name, value, words",
    [
        ("tilt", 91, "tilt: 91: expected degrees from -90 to 90"),
        ("turn", float("nan"), "turn: nan: expected a finite number"),
        ("distance", 0, "distance: 0: expected mm above 0"),
        ("wipe", 1.5, "wipe: 1.5: expected 0 to 1"),
        ("against", "rays", "against: 'rays': expected one of plain, raycast"),
        ("iso_values", [100, 50], "iso_values"),
    ],
)
def test_an_invalid_value_raises_and_changes_nothing(view, name, value, words):
    before = (view.scene.text(), view.wipe, view.against)
    with pytest.raises(edgesplat.Error, match=words.replace("(", r"\(")):
        setattr(view, name, value)
    assert before == (view.scene.text(), view.wipe, view.against)


def test_pictures_of_other_sizes_are_refused(renderer, ball):
    one, two = (renderer.render(ball, iso_values=[100], size=size) for size in ((16, 16), (16, 17)))
    with pytest.raises(edgesplat.Error, match="left: 16 x 17: expected the picture's own size"):
        one.png(two)


class TestControls:
    """Sets the widgets' traits, as a front end does."""

    @staticmethod
    def panel_of(view):
        pytest.importorskip("ipywidgets")
        from edgesplat._controls import controls

        return controls(view)

    @staticmethod
    def named(panel, name):
        def below(widget):
            yield widget
            for child in getattr(widget, "children", ()):
                yield from below(child)

        return next(widget for widget in below(panel) if getattr(widget, "description", None) == name)

    def test_sliders_move_the_view_and_the_picture_follows(self, view):
        panel = self.panel_of(view)
        image = panel.children[0]
        for name, value in [("turn", 30), ("tilt", 15), ("distance", 44), ("iso 1", 90), ("wipe", 0.25)]:
            before = image.value
            self.named(panel, name).value = value
            assert image.value == view.png() != before, name
        held = [view.turn, view.tilt, view.distance, view.iso_values[0], view.wipe]
        assert np.allclose(held, [30, 15, 44, 90, 0.25])

    def test_buttons_move_the_eye_and_the_distance_follows(self, view):
        panel = self.panel_of(view)
        button, step = self.named(panel, "forward"), self.named(panel, "step, mm")
        step.value, before = 2, np.array(view.eye)
        button._click_handlers(button)
        assert np.allclose(view.eye, before + 2 * np.array(view.camera.direction))
        assert panel.children[0].value == view.png()
        home = self.named(panel, "first view")
        self.named(panel, "turn").value = 70
        home._click_handlers(home)
        assert np.allclose(view.eye, before)
        assert self.named(panel, "turn").value == 0

    def test_an_invalid_value_shows_a_message_and_keeps_the_picture(self, view, counting):
        view = edgesplat.View(view.volume, iso_values=[60, 100], size=SIZE, renderer=counting)
        panel = self.panel_of(view)
        image, said = panel.children[0], panel.children[1].children[-1]
        before = image.value
        self.named(panel, "iso 1").value = 120
        assert "iso_values" in said.value
        assert (view.iso_values, image.value) == ([60, 100], before)
        self.named(panel, "iso 1").value = 60
        assert " ms" in said.value
