"""Renderers, and the pictures they make."""

from __future__ import annotations

import atexit
import json
import os
import threading
import warnings
from dataclasses import dataclass, field, fields
from typing import Any, Iterator, Mapping, Sequence

import numpy as np

from . import _core
from ._core import Error
from ._scene import Camera, Scene
from ._volume import PathLike, Volume


@dataclass(frozen=True)
class Device:
    """A Vulkan device of this machine; it can be used where `rejections` is empty."""

    index: int
    name: str
    type: str
    driver: str
    driver_version: str
    api_version: str
    rejections: tuple[str, ...] = ()


def list_devices() -> list[Device]:
    """Every Vulkan device, best first."""
    return [Device(**device) for device in _core.list_devices()]


@dataclass(frozen=True)
class Statistics:
    """What a picture did and cost. None: the renderer has no such figure. `everything` is what ``--json`` writes."""

    setup_ms: float | None = None
    frame_ms: float | None = None
    passes_ms: dict[str, float] | None = None
    voxels: int | None = None
    level: int | None = None
    splats_collected: int | None = None
    splats_culled: int | None = None
    splats_drawn: int | None = None
    edge_splats: int | None = None
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
    """A picture: arrays, statistics, and a figure in notebooks. Arrays are read-only and share the picture's memory;
    rows run from the top."""

    def __init__(self, held: _core.Picture, time: float = 0.0) -> None:
        self._core = held
        self.time = time
        """Seconds from the movie's beginning; 0 for single pictures."""

    @property
    def color(self) -> np.ndarray:
        """float32, H x W x 4: red, green, blue in linear light with the background blended in, and the volume's own
        opacity."""
        return self._core.color

    @property
    def plain(self) -> np.ndarray | None:
        """The same by conventional splatting, where ``output.compare_plain`` asked for it."""
        return self._core.plain

    @property
    def tau(self) -> np.ndarray | None:
        """float32, H x W: optical depth along the pixel's ray."""
        return self._core.tau

    @property
    def depth(self) -> np.ndarray | None:
        """float32, H x W: mean distance along the view axis, mm; 0 where nothing is hit."""
        return self._core.depth

    @property
    def normal(self) -> np.ndarray | None:
        """float32, H x W x 3: mean world normal of what is seen, of unit length or 0."""
        return self._core.normal

    @property
    def distance(self) -> np.ndarray | None:
        """float32, H x W: mean signed distance of the seen voxels to their edge, voxels."""
        return self._core.distance

    @property
    def camera(self) -> Camera:
        """The camera that was used: eye, direction, up and fov."""
        eye, direction, up, fov = self._core.camera
        return Camera(eye=tuple(eye), direction=tuple(direction), up=tuple(up), fov=fov)

    @property
    def iso_values(self) -> list[float]:
        """The surfaces that were drawn."""
        return self._core.iso_values

    @property
    def scene(self) -> Scene:
        """The scene with nothing left open, from which the same picture is made again."""
        return Scene(self._core.scene_text)

    @property
    def volume(self) -> Volume:
        """The volume that was drawn."""
        return Volume._of(self._core.volume)

    @property
    def statistics(self) -> Statistics:
        """What it did and cost."""
        return Statistics._of(json.loads(self._core.statistics()))

    def save(self, path: str | os.PathLike) -> None:
        """Writes what ``edgesplat render -o`` writes: ``.png`` (8-bit sRGB over the background, extra outputs beside
        it as ``.tau.exr`` and so on) or ``.exr`` (float32, linear, everything in it)."""
        self._core.save(os.fspath(path))

    def png(self, left: Picture | None = None, wipe: float = 0.5) -> bytes:
        """A PNG file: 8-bit sRGB over the background. Left of `wipe`, from 0 to 1 of the width, and of a white line
        there, it shows the picture `left`, of the same size."""
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
    """A movie's frames, drawn one by one as they are asked for: iterate over it, or index it."""

    def __init__(self, renderer: Renderer, held: _core.Movie) -> None:
        self._renderer = renderer
        self._core = held

    @property
    def fps(self) -> float:
        """Frames a second."""
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
    """Holds a Vulkan device and everything on it. Threads may share one: they draw one after another, and other Python
    threads go on meanwhile. Ctrl-C stops a picture.

    device: a part of its name, or its number in `list_devices()`; empty: the best one.
    memory_budget: MiB of device memory that may be held; 0: what the device has.
    validation: every Vulkan call is checked (`validation_messages` counts).
    check_numbers: Error where a number is not finite, naming the pass.
    """

    def __init__(
        self,
        device: str | int = "",
        *,
        memory_budget: float = 0,
        validation: bool = False,
        check_numbers: bool = False,
    ) -> None:
        if not 0 <= memory_budget <= 1e9:
            raise Error(f"memory_budget: {memory_budget}: expected MiB from 0 to 1e9")
        self._core = _core.Renderer(str(device), memory_budget, validation, check_numbers)

    @property
    def device(self) -> Device:
        """The device in use."""
        return Device(**self._core.device())

    @property
    def held_bytes(self) -> int:
        """Device memory held now."""
        return self._core.held_bytes()

    @property
    def validation_messages(self) -> int:
        """So far; 0 without validation."""
        return self._core.validation_messages()

    def interrupt(self) -> None:
        """From another thread: the picture that is being drawn ends with `Interrupted`. Does nothing else."""
        self._core.interrupt()

    def close(self) -> None:
        """Gives the device back; the renderer is of no use then."""
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
        **keys: Any,
    ) -> Picture:
        """A picture of `source`: a Volume, anything that Volume takes, a scene file, or a Scene that names its volume.

        scene: a Scene, or anything that Scene takes.
        camera: in place of the scene's.
        size: width and height, pixels, 1 to 16384 each (512 x 512).
        aovs: extra outputs: tau, depth, normal, distance.
        max_error: RMS of full scale, (0, 1): the cheapest method that keeps it is chosen, as by ``--max-error``.
        keys: any other keys of scenes, such as ``iso_values=[300]`` or ``effects={"fog": {"density": 0.01}}``.
        """
        volume, document = _asked(source, scene, camera, size, aovs, max_error, keys)
        picture = Picture(self._core.draw(document, document.prepared(volume)))
        frame = picture.statistics.everything["frames"][-1]
        if frame.get("level", 0) > frame.get("wanted_level", 0):
            warnings.warn(
                f"{picture.volume.name}: drawn at level {frame['level']}: the splats of a finer one do not fit",
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
        """The frames that ``edgesplat movie`` would make, drawn as they are asked for.

        seconds: how long; None: until the camera's way and all animated numbers end.
        keys: as for `render`; the way is ``movie={"orbit": {"degrees": 360, "seconds": 6}}`` or another of a scene's.
        """
        volume, document = _asked(source, scene, camera, size, None, max_error, keys)
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
        """Measures what each step of accuracy costs, as ``edgesplat accuracy`` does, writes its report, and gives what is in
        report.json. Stopped by Ctrl-C, the same call goes on from the measurements that are in the folder.

        report: the folder of index.html, report.json and steps.csv.
        size: pixels of the pictures that are measured.
        knobs: only the steps of these, and no combinations; empty: all.
        cameras: of far, near, grazing, inside; empty: all there are.
        tolerance: largest error of a pixel of the references, [1e-7, .01].
        repeats: rounds in which times are taken.
        orbit: frame pairs, one degree apart, for popping; 0: none.
        keys: as for `render`; of ``quality`` the steps are taken from there.
        """
        volume, document = _asked(source, scene, None, None, None, None, keys)
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


def _asked(
    source: Any,
    scene: Any,
    camera: Any,
    size: Any,
    aovs: Any,
    max_error: Any,
    keys: Mapping[str, Any],
) -> tuple[_core.Volume, _core.Document]:
    """The volume and the scene that a call means."""
    if isinstance(source, Mapping) or isinstance(source, PathLike) and os.fspath(source).endswith(".toml"):
        source = Scene(source)
    if isinstance(source, Scene):
        if scene is not None:
            raise Error("scene: is given twice; expected a volume before it, or one scene that names its volume")
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
    """`Renderer.render` on the best device of this machine, which is kept for the calls to come."""
    return _default_renderer().render(source, scene, **options)


def movie(source: Any = None, scene: Any = None, **options: Any) -> Movie:
    """`Renderer.movie` on the best device of this machine, which is kept for the calls to come."""
    return _default_renderer().movie(source, scene, **options)


def accuracy(source: Any = None, scene: Any = None, **options: Any) -> dict[str, Any]:
    """`Renderer.accuracy` on the best device of this machine, which is kept for the calls to come."""
    return _default_renderer().accuracy(source, scene, **options)
