"""Scenes by the keys of scene files, and cameras."""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass
from typing import Any, Iterator, Mapping, Sequence

import numpy as np

from . import _core
from ._core import Error
from ._volume import Volume


@dataclass(frozen=True)
class Camera:
    """Where the picture is seen from: the table ``camera`` of a scene, with None for what is left open.

    A named view (``view="oblique"``), or an eye with a target or a direction, or a direction alone, which frames the
    volume. Positions are world mm, or voxel indices x, y, z with ``voxel=True``; `fov` is the full vertical angle in
    degrees.
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
    """A key of scenes: what it means, what is expected, and what holds where it is not given."""

    path: str
    help: str
    expected: str
    default: str


def scene_keys() -> list[Key]:
    """Everything that a scene can say, as ``edgesplat scene keys`` prints it."""
    return [Key(**key) for key in _core.scene_keys()]


def _toml(value: Any, path: str) -> str:
    """A value as TOML spells it."""
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
    """Keys with their values; dicts are opened as far as scenes have groups of keys."""
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


class Scene:
    """What is to be seen, from where, how accurately, and which outputs: everything that a scene file can say.

    source: a dict of keys (nested, or with dots: ``{"effects.fog.density": 0.01}``), a scene file's path (a text that
        ends in ``.toml``, or a Path), TOML text, or another Scene, which is copied.
    keys: the same as keywords, on top: ``Scene(iso_values=[300], camera={"view": "back"})``. None leaves a key as it is.

    `scene_keys()` lists the keys with units. What is left open is chosen from the volume when a picture is made.
    Raises Error (SceneError for files and texts) naming the key, the value and what was expected.
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
        """Sets keys, all of them or, where one is wrong, none."""
        changed = self._core.copy()
        # A row of the ladder first, whose single steps the other keys change.
        wanted = sorted(_assignments({**(content or {}), **keys}), key=lambda one: one[0] != "quality.preset")
        for path, value in wanted:
            changed.set(f"{path}={_toml(value, path)}")
        self._core = changed

    def __getitem__(self, key: str) -> Any:
        """What stands at a key such as ``"effects.fog.density"`` or ``"lights[0].color"``; None: it is left open. Of
        an effect's table whether it is there, of a list of tables how many there are."""
        return self._core.get(key)

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def text(self, comments: bool = False) -> str:
        """As TOML; with `comments` every key, explained."""
        return self._core.text(comments)

    def problems(self) -> list[str]:
        """What is wrong beyond single keys, one line each, as far as it can be told without reading the volume."""
        return [f"{path}: {text}" for path, text in self._core.problems()]

    def load_volume(self) -> Volume:
        """Reads the volume that ``volume.path`` names, looked for beside the scene file and in EDGESPLAT_VOLUMES."""
        volume = Volume._of(self._core.load())
        volume._warn()
        return volume

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self._core == other._core

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"Scene({self.text()!r})"
