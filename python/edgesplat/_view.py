"""A volume to walk around and into: the picture, and where it is seen from."""

from __future__ import annotations

import math
import os
from typing import Any, Mapping, Sequence

import numpy as np

from ._core import Error
from ._renderer import Picture, Renderer, _asked, _default_renderer
from ._scene import Camera, Scene
from ._volume import Volume

_AGAINST = {
    "plain": {"quality.edges": "off"},
    "raycast": {"output.renderer": "raycast"},
}


class View:
    """A picture whose eye, surfaces and divider can be moved. As a notebook's last expression it shows itself with
    controls where ipywidgets is there, and its picture where not; scripts turn it by its attributes.

    source, scene, camera, size, keys: as for `Renderer.render`.
    against: what is seen left of the divider: ``"plain"`` (conventional splatting) or ``"raycast"``.
    renderer: a Renderer; None: the one that `render` uses.

    Nothing is drawn before `picture` is asked for, and nothing twice.
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
        volume, document = _asked(source, scene, camera, size, None, None, keys)
        self._volume = Volume._of(volume)
        wanted = Scene()
        wanted._core = document
        self._picture: Picture | None = self._renderer.render(self._volume, wanted)
        # Nothing in it is left open, so nothing but what is moved here changes from picture to picture.
        self._scene = self._picture.scene
        self._wipe = 0.0
        self.flying = False
        """Whether `turn` and `tilt` turn the eye where it is, rather than carry it around `target`."""
        self.against = against
        self._start(self._picture.camera)

    def _start(self, camera: Camera) -> None:
        """From here on `turn` and `tilt` count. The camera is a picture's, with nothing left open."""
        self._fov = camera.fov
        self._eye = np.asarray(camera.eye, dtype=float)
        self._front = _unit(np.asarray(camera.direction, dtype=float))
        up = np.asarray(camera.up, dtype=float)
        self._pole = _unit(up - (up @ self._front) * self._front)
        self._right = np.cross(self._front, self._pole)
        self._turn = self._tilt = 0.0
        middle = np.asarray(self._volume.origin) + (np.array(self._volume.shape[::-1]) - 1) / 2 @ self._steps()
        # The target as the eye sees it: to the right, up, ahead, mm.
        self._offset = np.array([self._right, self._pole, self._front]) @ (middle - self._eye)
        if self._offset[2] <= 0:
            self._offset = np.array([0, 0, self.diagonal / 10])

    def _steps(self) -> np.ndarray:
        """A voxel's steps along x, y, z as rows, mm."""
        return self._volume.direction.T * np.asarray(self._volume.spacing)[:, None]

    @property
    def diagonal(self) -> float:
        """Of the volume, mm."""
        return float(np.linalg.norm(np.array(self._volume.shape[::-1]) @ self._steps()))

    @property
    def volume(self) -> Volume:
        """What is looked at."""
        return self._volume

    @property
    def turn(self) -> float:
        """Degrees that the eye looks further to the right than at first."""
        return self._turn

    @turn.setter
    def turn(self, degrees: float) -> None:
        self._look(_number(degrees, "turn"), self._tilt)

    @property
    def tilt(self) -> float:
        """Degrees that the eye looks further up than at first, -90 to 90."""
        return self._tilt

    @tilt.setter
    def tilt(self, degrees: float) -> None:
        if not abs(_number(degrees, "tilt")) <= 90:
            raise Error(f"tilt: {degrees}: expected degrees from -90 to 90")
        self._look(self._turn, degrees)

    @property
    def distance(self) -> float:
        """From the eye to `target`, mm, above 0. Set, it moves the eye."""
        return float(np.linalg.norm(self._offset))

    @distance.setter
    def distance(self, length: float) -> None:
        if not _number(length, "distance") > 0:
            raise Error(f"distance: {length}: expected mm above 0")
        target = self._target()
        self._offset = self._offset * (length / self.distance)
        self._stand_back_from(target)

    @property
    def eye(self) -> tuple[float, float, float]:
        """World position, mm."""
        x, y, z = (float(v) for v in self._eye)
        return x, y, z

    @property
    def target(self) -> tuple[float, float, float]:
        """What the eye is carried around: at first the volume's middle, or, where that is behind the eye, a place
        before it. World, mm."""
        x, y, z = (float(v) for v in self._target())
        return x, y, z

    def move(self, right: float = 0, up: float = 0, forward: float = 0) -> None:
        """Moves the eye, and with it the target, mm."""
        by = {"right": right, "up": up, "forward": forward}
        self._eye = self._eye + np.array([_number(length, name) for name, length in by.items()]) @ self._axes()
        self._changed()

    @property
    def iso_values(self) -> list[float]:
        """The surfaces, as many as at first; none where a transfer function alone says what is seen."""
        return list(self._scene["iso_values"] or [])

    @iso_values.setter
    def iso_values(self, values: Sequence[float]) -> None:
        scene = Scene(self._scene)
        scene["iso_values"] = list(values)
        for problem in scene.problems():
            if not problem.startswith("volume.path: "):  # of an array there is no file
                raise Error(problem)
        self._scene = scene
        self._changed()

    @property
    def wipe(self) -> float:
        """The divider's place, from 0, the picture's left border, to 1. What is left of it is drawn otherwise."""
        return self._wipe

    @wipe.setter
    def wipe(self, place: float) -> None:
        if not 0 <= _number(place, "wipe") <= 1:
            raise Error(f"wipe: {place}: expected 0 to 1")
        self._wipe = float(place)

    @property
    def against(self) -> str:
        """What is left of the divider: plain or raycast."""
        return self._against

    @against.setter
    def against(self, name: str) -> None:
        if name not in _AGAINST:
            raise Error(f"against: {name!r}: expected one of {', '.join(_AGAINST)}")
        self._against = name
        self._left = None

    @property
    def camera(self) -> Camera:
        """From where it is seen, for `render` and for scenes. Set to any camera, it is a new first view, from which
        `turn` and `tilt` count."""
        _, above, ahead = self._axes()
        return Camera(eye=self.eye, direction=ahead.tolist(), up=above.tolist(), fov=self._fov)

    @camera.setter
    def camera(self, camera: Camera | Mapping[str, Any]) -> None:
        picture = self._renderer.render(self._volume, self._scene, camera=camera)
        self._start(picture.camera)
        self._picture, self._left = picture, None

    @property
    def scene(self) -> Scene:
        """From which `render(view.volume, view.scene)` makes the same picture."""
        scene = Scene(self._scene)
        scene._core.clear_camera()
        scene.update(camera=self.camera)
        return scene

    @property
    def picture(self) -> Picture:
        """As it is seen now."""
        if self._picture is None:
            self._picture = self._renderer.render(self._volume, self.scene)
        return self._picture

    def png(self) -> bytes:
        """A PNG file of what is shown, the divider included."""
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
        """What is to the right of the eye, what is up there, and where it looks: rows of length 1."""
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

    def _stand_back_from(self, target: np.ndarray) -> None:
        self._eye = target - self._offset @ self._axes()
        self._changed()

    def _look(self, turn: float, tilt: float) -> None:
        target = self._target()
        self._turn, self._tilt = float(turn), float(tilt)
        if self.flying:
            self._changed()
        else:
            self._stand_back_from(target)

    def _changed(self) -> None:
        self._picture = self._left = None


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def _number(value: float, name: str) -> float:
    if not math.isfinite(value):
        raise Error(f"{name}: {value}: expected a finite number")
    return float(value)
