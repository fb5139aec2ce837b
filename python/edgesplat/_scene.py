"""Scenes, with the keys of scene files, and cameras."""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass
from typing import Any, Iterator, Mapping, Sequence

import numpy as np

from . import _core
from ._colors import linear_color, transfer_points
from ._core import Error
from ._volume import Volume


@dataclass(frozen=True)
class Camera:
    """A camera: the table ``camera`` of a scene. None leaves a value open.

    Give a named view (``view="oblique"``), an eye with a target or a direction, or a direction alone, which frames the
    volume. Positions are world mm, or voxel indices x, y, z with ``voxel=True``. `fov` is the full vertical field of
    view, degrees.
    """

    view: str | None = None
    eye: Sequence[float] | None = None
    target: Sequence[float] | None = None
    direction: Sequence[float] | None = None
    up: Sequence[float] | None = None
    fov: float | None = None
    voxel: bool | None = None


@dataclass(frozen=True)
class Key:
    """A key of scenes: its meaning, the expected values, and the default."""

    path: str
    help: str
    expected: str
    default: str


def scene_keys() -> list[Key]:
    """All keys of scenes, as ``edgesplat scene keys`` prints them."""
    return [Key(**key) for key in _core.scene_keys()]


def _toml(value: Any, path: str) -> str:
    """A value as TOML text."""
    if isinstance(value, np.generic) or isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Camera):
        value = asdict(value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{k} = {_toml(v, path)}" for k, v in value.items() if v is not None) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(v, path) for v in value) + "]"
    raise Error(f"{path}: a {type(value).__name__}: expected a number, a text, a flag, a list or a dict")


def _assignments(content: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Pairs of key path and value. A dict is expanded if its path is a group of keys or a table."""
    for name, value in content.items():
        path = f"{before}{name}"
        if value is None:
            continue
        if isinstance(value, Camera):
            value = asdict(value)
        if isinstance(value, Mapping) and _core.kind_of(path) in ("group", "table"):
            if _core.kind_of(path) == "table":
                yield path, True
            yield from _assignments(value, path + ".")
        else:
            yield path, value


# Names of the command line's options, and the keys that they set.
_OPTIONS = {
    "iso": "iso_values",
    "transfer": "transfer",
    "labels": "volume.labels",
    "threshold": "volume.threshold",
    "box_filter": "volume.box_filter",
    "view": "camera.view",
    "preset": "quality.preset",
    "renderer": "output.renderer",
    "size": "output.size",
}


def _with_names(content: Mapping[str, Any]) -> dict[str, Any]:
    """The content with keys for option names, numbers for names of colours, and points for colour maps."""
    found: dict[str, Any] = {}
    for name, value in content.items():
        if name in ("color", "extinction", "material") and value is not None:
            _per_material(found, "preset" if name == "material" else name, value)
        elif name == "transfer" and isinstance(value, str):
            found["transfer_preset"] = value
        elif name == "transfer" and isinstance(value, Mapping) and "map" in value:
            found["transfer"] = transfer_points(value)
        elif name == "iso" and value is not None:
            found["iso_values"] = np.atleast_1d(np.asarray(value, dtype=float)).tolist()
        elif name == "volumes" and value is not None:
            found["volumes"] = [_added_volume(entry) for entry in value]
        elif name in found or name not in _OPTIONS:
            found[name] = value
        else:
            found[_OPTIONS[name]] = value
    return {name: _with_colors(name, value) for name, value in found.items()}


def _added_volume(entry: Any) -> dict[str, Any]:
    """The keys of a volume beside the first one."""
    if isinstance(entry, (str, os.PathLike)):
        return {"volume": {"path": entry}}
    if not isinstance(entry, Mapping):
        raise Error(f"volumes: a {type(entry).__name__}: expected a path or a dict of keys")
    return _with_names(entry)


def _per_material(found: dict[str, Any], key: str, value: Any) -> None:
    """Adds a value, or one for each material, to the list of materials."""
    several = isinstance(value, (list, tuple, np.ndarray)) and (
        key != "color" or any(isinstance(v, (str, list, tuple, np.ndarray)) for v in value)
    )
    values = list(value) if several else [value]
    materials = found.setdefault("materials", [{} for _ in values])
    if len(materials) != len(values):
        raise Error(f"{key}: {len(values)} values: expected {len(materials)}, as many as of the others")
    for material, one in zip(materials, values):
        material[key] = one


def _with_colors(path: str, value: Any) -> Any:
    """The value with [red, green, blue] for each name of a colour."""
    leaf = path.rpartition(".")[2]
    if isinstance(value, str) and (leaf == "color" or leaf.startswith("background")):
        return linear_color(value, path)
    if isinstance(value, Mapping):
        return {k: _with_colors(f"{path}.{k}", v) for k, v in value.items()}
    if isinstance(value, (list, tuple)) and any(isinstance(v, Mapping) for v in value):
        return [_with_colors(path, v) for v in value]
    return value


class Scene:
    """A scene: surfaces, camera, effects, accuracy and outputs, with the same keys as a scene file.

    source: a dict of keys (nested, or with dots: ``{"effects.fog.density": 0.01}``), the path of a scene file (a text
        that ends in ``.toml``, or a Path), TOML text, or another Scene, which is copied.
    keys: keys as keywords, which override `source`: ``Scene(iso_values=[300], camera={"view": "back"})``. None leaves a
        key unchanged. Names of command-line options work too: ``iso=300``, ``look="ct-bone"``, ``labels=False``,
        ``view="back"``, ``color="tomato"``, ``extinction=8``, ``transfer="ct-muscle-bone"``.

    ``volumes`` lists volumes beside the first one, each a path or a dict of its own keys:
    ``Scene(volumes=[{"volume.path": "tumour.nii.gz", "color": "tomato"}])``. One without a path is of the first one's file or
    array.

    ``fade`` draws labels translucent, by number or name: ``fade={"skin": 0.3, 7: 0.5}``, as ``--fade``.

    A colour is three numbers in linear light, a name of CSS or ``"#rrggbb"``. A transfer function is a list of points, a
    preset's name, or a colour map: ``transfer={"map": "viridis", "range": (0, 500), "extinction": (0, 2)}``, where the map is
    one of Matplotlib's, by name or as an object; colours and extinctions run evenly over the range.

    `scene_keys()` lists the keys with units. Values that are left open are chosen from the volume when a picture is
    drawn. Raises Error (SceneError for files and texts) naming the key, the value and the expected form.
    """

    def __init__(self, source: Mapping[str, Any] | str | os.PathLike | Scene | None = None, /, **keys: Any) -> None:
        if source is None or isinstance(source, Mapping):
            self._core = _core.Document()
            self.update(source or {})
        elif isinstance(source, Scene):
            self._core = source._core.copy()
        elif isinstance(source, os.PathLike) or isinstance(source, str) and source.endswith(".toml"):
            self._core = _core.Document.read(os.fspath(source))
        elif isinstance(source, str):
            self._core = _core.Document.parse(source, "scene")
        else:
            raise Error(f"scene: a {type(source).__name__}: expected a dict, TOML text, a .toml file or a Scene")
        self.update(keys)

    def update(self, content: Mapping[str, Any] | None = None, /, **keys: Any) -> None:
        """Sets keys. If one of them is invalid, none is set."""
        changed = self._core.copy()
        everything = {**(content or {}), **keys}
        # The look and the preset come first, because the other keys override them.
        look, faded = everything.pop("look", None), everything.pop("fade", None)
        if look is not None:
            changed.apply_look(look)
        wanted = sorted(_assignments(_with_names(everything)), key=lambda one: one[0] != "quality.preset")
        for path, value in wanted:
            changed.set(f"{path}={_toml(value, path)}")
        for labels, opacity in dict(faded or {}).items():
            if not isinstance(opacity, (int, float)) or not 0 < opacity <= 1:
                raise Error(f"fade: {labels!r}: {opacity!r}: expected an opacity above 0 up to 1")
            changed.fade(str(labels), float(opacity))
        self._core = changed

    def __getitem__(self, key: str) -> Any:
        """The value of a key such as ``"effects.fog.density"`` or ``"lights[0].color"``; None: left open. For an
        effect's table: whether it exists. For a list of tables: their number."""
        return self._core.get(key)

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def text(self, comments: bool = False) -> str:
        """The scene as TOML; with `comments` every key, explained."""
        return self._core.text(comments)

    def problems(self) -> list[str]:
        """Errors that concern several keys, one line each, as far as they show without reading the volume."""
        return [f"{path}: {text}" for path, text in self._core.problems()]

    def load_volume(self) -> Volume:
        """Reads the volume ``volume.path``, searched beside the scene file and in EDGESPLAT_VOLUMES."""
        volume = Volume._of(self._core.load())
        volume._warn()
        return volume

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self._core == other._core

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"Scene({self.text()!r})"
