"""Renderers and their pictures."""

from __future__ import annotations

import atexit
import json
import os
import threading
import warnings
from dataclasses import dataclass, field, fields
from typing import Any, Callable, Iterator, Mapping, Sequence

import numpy as np

from . import _core
from ._core import Error
from ._scene import Camera, Scene
from ._volume import PathLike, Volume


@dataclass(frozen=True)
class Device:
    """A Vulkan device of this machine. It is usable if `rejections` is empty."""

    index: int
    name: str
    type: str
    driver: str
    driver_version: str
    api_version: str
    rejections: tuple[str, ...] = ()


def list_devices() -> list[Device]:
    """All Vulkan devices, the best one first."""
    return [Device(**device) for device in _core.list_devices()]


@dataclass(frozen=True)
class Statistics:
    """Counts and times of a picture. None: not measured by this renderer. `everything`: the content of ``--json``."""

    setup_ms: float | None = None
    frame_ms: float | None = None
    passes_ms: dict[str, float] | None = None
    voxels: int | None = None
    level: int | None = None
    splats_collected: int | None = None
    splats_culled: int | None = None
    splats_drawn: int | None = None
    edge_splats: int | None = None
    splats_read: bool | None = None
    sheets: int | None = None
    device_bytes: int | None = None
    validation_messages: int | None = None
    settings: dict[str, Any] | None = None
    everything: dict[str, Any] = field(default_factory=dict, repr=False)

    @classmethod
    def _of(cls, everything: dict[str, Any]) -> Statistics:
        frame = everything["frames"][-1]
        known = {f.name: frame[f.name] for f in fields(cls) if f.name in frame}
        return cls(**known, everything=everything)


class Picture:
    """A picture with its arrays and statistics; notebooks display it. Arrays are read-only and share the picture's
    memory; row 0 is the top row."""

    def __init__(self, held: _core.Picture, time: float = 0.0) -> None:
        self._core = held
        self.time = time
        """Time since the start of the movie, s; 0 for single pictures."""

    @property
    def color(self) -> np.ndarray:
        """float32, H x W x 4: red, green, blue in linear light, blended with the background, and the volume's
        opacity."""
        return self._core.color

    @property
    def plain(self) -> np.ndarray | None:
        """The same by conventional splatting; None unless ``output.compare_plain`` is set."""
        return self._core.plain

    @property
    def tau(self) -> np.ndarray | None:
        """float32, H x W: optical depth along the pixel's ray."""
        return self._core.tau

    @property
    def depth(self) -> np.ndarray | None:
        """float32, H x W: mean depth along the view axis, mm; 0 in empty pixels."""
        return self._core.depth

    @property
    def normal(self) -> np.ndarray | None:
        """float32, H x W x 3: mean world normal of the visible splats, of unit length or 0."""
        return self._core.normal

    @property
    def distance(self) -> np.ndarray | None:
        """float32, H x W: mean signed distance of the visible voxels to their edge, voxels."""
        return self._core.distance

    @property
    def camera(self) -> Camera:
        """The camera of the picture: eye, direction, up and fov."""
        eye, direction, up, fov = self._core.camera
        return Camera(eye=tuple(eye), direction=tuple(direction), up=tuple(up), fov=fov)

    @property
    def iso_values(self) -> list[float]:
        """The iso-values of the drawn surfaces."""
        return self._core.iso_values

    @property
    def scene(self) -> Scene:
        """The scene with nothing left open; it reproduces the picture."""
        return Scene(self._core.scene_text)

    @property
    def volume(self) -> Volume:
        """The drawn volume."""
        return Volume._of(self._core.volume)

    @property
    def statistics(self) -> Statistics:
        """Counts and times of the picture."""
        return Statistics._of(json.loads(self._core.statistics()))

    def save(self, path: str | os.PathLike) -> None:
        """Writes the files of ``edgesplat render -o``: ``.png`` (8-bit sRGB over the background; extra outputs beside
        it as ``.tau.exr`` and so on) or ``.exr`` (float32, linear; extra outputs inside)."""
        self._core.save(os.fspath(path))

    def png(self, left: Picture | None = None, wipe: float = 0.5) -> bytes:
        """A PNG file: 8-bit sRGB over the background. With `left`, a picture of the same size, it shows `left` on the
        left of a white line at `wipe`, 0 to 1 of the width."""
        if left is None:
            return self._core.png()
        if left.color.shape != self.color.shape:
            raise Error(f"left: {left.color.shape[1]} x {left.color.shape[0]}: expected the picture's own size")
        if not 0 <= wipe <= 1:
            raise Error(f"wipe: {wipe}: expected 0 to 1")
        return self._core.wiped_png(left._core, wipe)

    def _repr_png_(self) -> bytes:
        return self.png()

    def __repr__(self) -> str:
        height, width = self.color.shape[:2]
        return f"<Picture {width} x {height} of {self.volume.name}>"


class Movie:
    """The frames of a movie, each drawn on request: iterate over the movie, or index it."""

    def __init__(self, renderer: Renderer, held: _core.Movie) -> None:
        self._renderer = renderer
        self._core = held

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self._core.fps

    def __len__(self) -> int:
        return self._core.count

    def __getitem__(self, frame: int) -> Picture:
        index = frame + len(self) if frame < 0 else frame
        if not 0 <= index < len(self):
            raise IndexError(f"frame {frame}: the movie has {len(self)}")
        return Picture(self._renderer._core.frame_of(self._core, index), index / self.fps)

    def __iter__(self) -> Iterator[Picture]:
        for frame in range(len(self)):
            yield self[frame]


class Renderer:
    """Owns a Vulkan device and all its data. Threads may share a renderer: they draw one after another, while other
    Python threads continue. Ctrl-C stops a picture.

    device: part of the device's name, or its number in `list_devices()`; empty: the best one.
    memory_budget: limit of device memory, MiB; 0: all memory of the device.
    validation: checks every Vulkan call (`validation_messages` counts the messages).
    check_numbers: raises Error for a number that is not finite, naming the pass.
    keep_splats: keeps found surfaces on disk and uses those of earlier runs, like ``--keep-splats``.
    """

    def __init__(
        self,
        device: str | int = "",
        *,
        memory_budget: float = 0,
        validation: bool = False,
        check_numbers: bool = False,
        keep_splats: bool = False,
    ) -> None:
        if not 0 <= memory_budget <= 1e9:
            raise Error(f"memory_budget: {memory_budget}: expected MiB from 0 to 1e9")
        self._core = _core.Renderer(str(device), memory_budget, validation, check_numbers, keep_splats)

    @property
    def device(self) -> Device:
        """The device in use."""
        return Device(**self._core.device())

    @property
    def held_bytes(self) -> int:
        """Device memory in use, bytes."""
        return self._core.held_bytes()

    @property
    def validation_messages(self) -> int:
        """Number of validation messages so far; 0 without validation."""
        return self._core.validation_messages()

    def interrupt(self) -> None:
        """Call it from another thread: the picture that is being drawn raises `Interrupted`. Otherwise does nothing."""
        self._core.interrupt()

    def close(self) -> None:
        """Releases the device. The renderer cannot be used afterwards."""
        self._core.close()

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def render(
        self,
        source: Any = None,
        scene: Scene | Mapping[str, Any] | str | os.PathLike | None = None,
        *,
        camera: Camera | Mapping[str, Any] | None = None,
        size: Sequence[int] | None = None,
        aovs: Sequence[str] | None = None,
        max_error: float | None = None,
        progress: Callable[[float], None] | None = None,
        **keys: Any,
    ) -> Picture:
        """Renders `source`: a Volume, anything that Volume accepts, a scene file, or a Scene with a volume.

        scene: a Scene, or anything that Scene accepts.
        camera: replaces the scene's camera.
        size: width and height, pixels, 1 to 16384 each (default 512 x 512).
        aovs: extra outputs: tau, depth, normal, distance.
        max_error: RMS error, share of full scale, (0, 1): chooses the fastest method within it, as ``--max-error``.
        progress: called with the share of the surfaces found, 0 to 1, while the picture waits for them; an exception of
            its own ends the picture.
        keys: other keys of scenes, such as ``iso_values=[300]`` or ``effects={"fog": {"density": 0.01}}``.
        """
        volume, document = _volume_and_scene(source, scene, camera, size, aovs, max_error, keys)
        picture = Picture(self._core.draw(document, document.prepared(volume), progress))
        frame = picture.statistics.everything["frames"][-1]
        if frame.get("level", 0) > frame.get("wanted_level", 0):
            warnings.warn(
                f"{picture.volume.name}: drawn at level {frame['level']}: "
                "the splats of a finer level do not fit into memory",
                stacklevel=2,
            )
        return picture

    def movie(
        self,
        source: Any = None,
        scene: Scene | Mapping[str, Any] | str | os.PathLike | None = None,
        *,
        seconds: float | None = None,
        camera: Camera | Mapping[str, Any] | None = None,
        size: Sequence[int] | None = None,
        max_error: float | None = None,
        **keys: Any,
    ) -> Movie:
        """The frames of ``edgesplat movie``, each drawn on request.

        seconds: duration; None: until the camera path and all animations end.
        keys: as for `render`. The camera path is a key, such as ``movie={"orbit": {"degrees": 360, "seconds": 6}}``.
        """
        volume, document = _volume_and_scene(source, scene, camera, size, None, max_error, keys)
        return Movie(self, self._core.movie(document, document.prepared(volume), seconds))


    def accuracy(
        self,
        source: Any = None,
        scene: Scene | Mapping[str, Any] | str | os.PathLike | None = None,
        *,
        report: str | os.PathLike,
        size: Sequence[int] = (192, 192),
        knobs: Sequence[str] = (),
        cameras: Sequence[str] = (),
        tolerance: float = 3e-5,
        repeats: int = 5,
        orbit: int = 36,
        **keys: Any,
    ) -> dict[str, Any]:
        """Measures error and time of each accuracy setting, as ``edgesplat accuracy`` does, writes its report, and
        returns the content of report.json. After Ctrl-C, the same call continues from the measurements in the folder.

        report: folder for index.html, report.json and steps.csv.
        size: size of the measured pictures, pixels.
        knobs: names of the settings to measure, without combinations; empty: all.
        cameras: some of far, near, grazing, inside; empty: all.
        tolerance: largest error of a pixel of the reference pictures, [1e-7, .01]; full scale is 1.
        repeats: number of timing rounds, [1, 1000].
        orbit: number of frame pairs, one degree apart, that measure popping, [0, 3600]; 0: none.
        keys: as for `render`; keys of ``quality`` are the base from which each setting is varied.
        """
        volume, document = _volume_and_scene(source, scene, None, None, None, None, keys)
        if len(size) != 2 or not all(1 <= n <= 16384 for n in size):
            raise Error(f"size: {tuple(size)}: expected width and height, 1 to 16384 pixels each")
        for name, number, low, high in (
            ("tolerance", tolerance, 1e-7, 0.01),
            ("repeats", repeats, 1, 1000),
            ("orbit", orbit, 0, 3600),
        ):
            if not low <= number <= high:
                raise Error(f"{name}: {number}: expected {low} to {high}")
        prepared = document.prepared(volume)
        text = self._core.accuracy(
            document, prepared, os.fspath(report), list(size), tolerance, repeats, orbit, list(knobs), list(cameras)
        )
        return json.loads(text)


def _volume_and_scene(
    source: Any,
    scene: Any,
    camera: Any,
    size: Any,
    aovs: Any,
    max_error: Any,
    keys: Mapping[str, Any],
) -> tuple[_core.Volume, _core.Document]:
    """The volume and the scene of a call."""
    if isinstance(source, Mapping) or isinstance(source, PathLike) and os.fspath(source).endswith(".toml"):
        source = Scene(source)
    if isinstance(source, Scene):
        if scene is not None:
            raise Error("scene: is given twice; expected a volume and a scene, or one scene with a volume")
        source, scene = None, source
    document = Scene(scene, **keys)
    if camera is not None:
        document._core.clear_camera()
        document.update(camera=camera)
    if size is not None:
        document.update({"output.size": size})
    if aovs is not None:
        document.update({"output.aovs": [aovs] if isinstance(aovs, str) else list(aovs)})
    if max_error is not None:
        document.update({"quality.max_error": max_error})
    if source is None:
        if not document["volume.path"]:
            raise Error("volume.path: is missing; expected a file, a folder, a pattern of slices or builtin:NAME")
        source = document.load_volume()
    elif not isinstance(source, Volume):
        source = Volume(source)
    return source._core, document._core


_default: Renderer | None = None
_default_lock = threading.Lock()


def _default_renderer() -> Renderer:
    global _default
    with _default_lock:
        if _default is None:
            _default = Renderer()
            atexit.register(_default.close)
        return _default


def render(source: Any = None, scene: Any = None, **options: Any) -> Picture:
    """`Renderer.render` on the best device of this machine. Later calls use the same renderer."""
    return _default_renderer().render(source, scene, **options)


def movie(source: Any = None, scene: Any = None, **options: Any) -> Movie:
    """`Renderer.movie` on the best device of this machine. Later calls use the same renderer."""
    return _default_renderer().movie(source, scene, **options)


def accuracy(source: Any = None, scene: Any = None, **options: Any) -> dict[str, Any]:
    """`Renderer.accuracy` on the best device of this machine. Later calls use the same renderer."""
    return _default_renderer().accuracy(source, scene, **options)
