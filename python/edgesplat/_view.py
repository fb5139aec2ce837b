"""Interactive views of a volume: a picture with a movable camera."""

from __future__ import annotations

import math
import os
from typing import Any, Mapping, Sequence

import numpy as np

from ._core import Error
from ._renderer import Picture, Renderer, _volume_and_scene, _default_renderer
from ._scene import Camera, Scene
from ._volume import Volume

_AGAINST = {
    "plain": {"quality.edges": "off"},
    "raycast": {"output.renderer": "raycast"},
}


class View:
    """A picture with a movable eye, iso-values and a divider. As a notebook's last expression it shows controls if
    ipywidgets is installed, otherwise the picture. Scripts change its attributes.

    source, scene, camera, size, keys: as for `Renderer.render`.
    against: the picture left of the divider: ``"plain"`` (conventional splatting) or ``"raycast"``.
    renderer: a Renderer; None: the one that `render` uses.

    A changed view is drawn only when `picture` or `png` is used, and only once.
    """

    def __init__(
        self,
        source: Any = None,
        scene: Scene | Mapping[str, Any] | str | os.PathLike | None = None,
        *,
        camera: Camera | Mapping[str, Any] | None = None,
        size: Sequence[int] = (480, 360),
        against: str = "plain",
        renderer: Renderer | None = None,
        **keys: Any,
    ) -> None:
        self._renderer = renderer or _default_renderer()
        volume, document = _volume_and_scene(source, scene, camera, size, None, None, keys)
        self._volume = Volume._of(volume)
        wanted = Scene()
        wanted._core = document
        self._picture: Picture | None = self._renderer.render(self._volume, wanted)
        # Nothing is left open in this scene, so pictures differ only by the changes made here.
        self._scene = self._picture.scene
        self._wipe = 0.0
        self.flying = False
        """True: `turn` and `tilt` turn the eye in place. False: they carry it around `target`."""
        self.against = against
        self._set_first_view(self._picture.camera)

    def _set_first_view(self, camera: Camera) -> None:
        """Makes `camera`, in which nothing is left open, the first view, where `turn` and `tilt` are 0."""
        self._fov = camera.fov
        self._eye = np.asarray(camera.eye, dtype=float)
        self._front = _unit(np.asarray(camera.direction, dtype=float))
        up = np.asarray(camera.up, dtype=float)
        self._pole = _unit(up - (up @ self._front) * self._front)
        self._right = np.cross(self._front, self._pole)
        self._turn = self._tilt = 0.0
        middle = np.asarray(self._volume.origin) + (np.array(self._volume.shape[::-1]) - 1) / 2 @ self._steps()
        # The target relative to the eye: right, up, ahead, mm.
        self._offset = np.array([self._right, self._pole, self._front]) @ (middle - self._eye)
        if self._offset[2] <= 0:
            self._offset = np.array([0, 0, self.diagonal / 10])

    def _steps(self) -> np.ndarray:
        """The steps of a voxel along x, y and z, as rows, mm."""
        return self._volume.direction.T * np.asarray(self._volume.spacing)[:, None]

    @property
    def diagonal(self) -> float:
        """Length of the volume's diagonal, mm."""
        return float(np.linalg.norm(np.array(self._volume.shape[::-1]) @ self._steps()))

    @property
    def volume(self) -> Volume:
        """The volume."""
        return self._volume

    @property
    def turn(self) -> float:
        """Angle by which the view is turned to the right from the first view, degrees."""
        return self._turn

    @turn.setter
    def turn(self, degrees: float) -> None:
        self._set_angles(_number(degrees, "turn"), self._tilt)

    @property
    def tilt(self) -> float:
        """Angle by which the view is tilted up from the first view, degrees, -90 to 90."""
        return self._tilt

    @tilt.setter
    def tilt(self, degrees: float) -> None:
        if not abs(_number(degrees, "tilt")) <= 90:
            raise Error(f"tilt: {degrees}: expected degrees from -90 to 90")
        self._set_angles(self._turn, degrees)

    @property
    def distance(self) -> float:
        """Distance from the eye to `target`, mm, above 0. Setting it moves the eye."""
        return float(np.linalg.norm(self._offset))

    @distance.setter
    def distance(self, length: float) -> None:
        if not _number(length, "distance") > 0:
            raise Error(f"distance: {length}: expected mm above 0")
        target = self._target()
        self._offset = self._offset * (length / self.distance)
        self._place_eye_around(target)

    @property
    def eye(self) -> tuple[float, float, float]:
        """World position of the eye, mm."""
        x, y, z = (float(v) for v in self._eye)
        return x, y, z

    @property
    def target(self) -> tuple[float, float, float]:
        """World position that the eye is carried around, mm: at first the volume's centre, or a point in front of the
        eye if the centre is behind it."""
        x, y, z = (float(v) for v in self._target())
        return x, y, z

    def move(self, right: float = 0, up: float = 0, forward: float = 0) -> None:
        """Moves the eye and the target, mm."""
        by = {"right": right, "up": up, "forward": forward}
        self._eye = self._eye + np.array([_number(length, name) for name, length in by.items()]) @ self._axes()
        self._changed()

    @property
    def iso_values(self) -> list[float]:
        """The iso-values; their number does not change. Empty for a transfer function without iso-values."""
        return list(self._scene["iso_values"] or [])

    @iso_values.setter
    def iso_values(self, values: Sequence[float]) -> None:
        scene = Scene(self._scene)
        scene["iso_values"] = list(values)
        for problem in scene.problems():
            if not problem.partition(": ")[0].endswith("volume.path"):  # an array has no file
                raise Error(problem)
        self._scene = scene
        self._changed()

    @property
    def wipe(self) -> float:
        """Position of the divider, 0 (left border) to 1. `against` chooses the picture to its left."""
        return self._wipe

    @wipe.setter
    def wipe(self, place: float) -> None:
        if not 0 <= _number(place, "wipe") <= 1:
            raise Error(f"wipe: {place}: expected 0 to 1")
        self._wipe = float(place)

    @property
    def against(self) -> str:
        """The picture left of the divider: plain or raycast."""
        return self._against

    @against.setter
    def against(self, name: str) -> None:
        if name not in _AGAINST:
            raise Error(f"against: {name!r}: expected one of {', '.join(_AGAINST)}")
        self._against = name
        self._left = None

    @property
    def camera(self) -> Camera:
        """The current camera, for `render` and for scenes. Setting it makes it the first view, where `turn` and `tilt`
        are 0."""
        _, above, ahead = self._axes()
        return Camera(eye=self.eye, direction=ahead.tolist(), up=above.tolist(), fov=self._fov)

    @camera.setter
    def camera(self, camera: Camera | Mapping[str, Any]) -> None:
        picture = self._renderer.render(self._volume, self._scene, camera=camera)
        self._set_first_view(picture.camera)
        self._picture, self._left = picture, None

    @property
    def scene(self) -> Scene:
        """The current scene: `render(view.volume, view.scene)` draws the same picture."""
        scene = Scene(self._scene)
        scene._core.clear_camera()
        scene.update(camera=self.camera)
        return scene

    @property
    def picture(self) -> Picture:
        """The current picture."""
        if self._picture is None:
            self._picture = self._renderer.render(self._volume, self.scene)
        return self._picture

    def png(self) -> bytes:
        """The current picture as a PNG file, with the divider."""
        if self._wipe == 0:
            return self.picture.png()
        if self._left is None:
            self._left = self._renderer.render(self._volume, self.scene, **_AGAINST[self._against])
        return self.picture.png(self._left, self._wipe)

    def _ipython_display_(self) -> None:
        from IPython.display import display

        try:
            from ._controls import controls
        except ImportError:  # without ipywidgets
            display(self.picture)
        else:
            display(controls(self))

    def __repr__(self) -> str:
        width, height = self._scene["output.size"]
        return f"<View {width} x {height} of {self._volume.name} from {', '.join(f'{v:.6g}' for v in self._eye)}>"

    def _axes(self) -> np.ndarray:
        """The eye's axes right, up and ahead, as rows of length 1."""
        turn, tilt = math.radians(self._turn), math.radians(self._tilt)
        right = math.cos(turn) * self._right - math.sin(turn) * self._front
        level = math.cos(turn) * self._front + math.sin(turn) * self._right
        return np.array(
            [
                right,
                math.cos(tilt) * self._pole - math.sin(tilt) * level,
                math.cos(tilt) * level + math.sin(tilt) * self._pole,
            ]
        )

    def _target(self) -> np.ndarray:
        return self._eye + self._offset @ self._axes()

    def _place_eye_around(self, target: np.ndarray) -> None:
        self._eye = target - self._offset @ self._axes()
        self._changed()

    def _set_angles(self, turn: float, tilt: float) -> None:
        target = self._target()
        self._turn, self._tilt = float(turn), float(tilt)
        if self.flying:
            self._changed()
        else:
            self._place_eye_around(target)

    def _changed(self) -> None:
        self._picture = self._left = None


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def _number(value: float, name: str) -> float:
    if not math.isfinite(value):
        raise Error(f"{name}: {value}: expected a finite number")
    return float(value)
