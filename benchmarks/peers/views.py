"""The views of a suite of benchmarks, with every choice made."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import edgesplat

AMBIENT, DIFFUSE = 0.15, 0.85


@dataclass(frozen=True)
class View:
    """A picture that every program draws: one light along the view axis, or none if matter is translucent."""

    name: str
    source: str
    volume: edgesplat.Volume
    scene: dict[str, Any]  # keys of a scene file, none left open
    camera: edgesplat.Camera
    size: tuple[int, int]

    @property
    def lit(self) -> bool:
        return bool(self.scene["lights"])

    @property
    def samples(self) -> np.ndarray:
        """[z, y, x]: as 16-bit integers if that loses nothing."""
        values = self.volume.array
        small = values.astype(np.int16) if np.abs(values).max() < 32767 else values
        return small if np.array_equal(small, values) else values

    @property
    def materials(self) -> list[dict[str, Any]]:
        """Below the lowest iso-value, then above each."""
        return [self.scene["below"], *self.scene["materials"]]


def read_views(suite: Path, names: list[str]) -> list[View]:
    """The cases of a suite, or those with the given names; each size is one view. Says which are skipped."""
    cases = tomllib.loads(suite.read_text())["cases"]
    unknown = sorted(set(names) - {case["name"] for case in cases})
    if unknown:
        known = ", ".join(case["name"] for case in cases)
        raise SystemExit(f"peers: {unknown[0]}: {suite} has no such case; expected {known}")
    views = []
    for case in cases:
        if names and case["name"] not in names:
            continue
        if "camera" in case:
            raise SystemExit(f"peers: {case['name']}: camera = {case['camera']}: expected scene.camera")
        scene = dict(case["scene"])
        source = scene.pop("volume")["path"]
        try:
            volume = edgesplat.Volume(source)
        except edgesplat.Error as error:
            print(f"skipped {case['name']}: {error}")
            continue
        translucent = "below" in scene
        for width, height in case.get("sizes", [(512, 512)]):
            first = edgesplat.render(volume, scene, size=(width, height))
            whole = tomllib.loads(first.scene.text())
            kept = {key: whole[key] for key in ("iso_values", "ambient", "background", "materials", "below")}
            towards = [-x for x in first.camera.direction]
            light = {"kind": "directional", "direction": towards, "intensity": DIFFUSE}
            kept["lights"] = [] if translucent else [light]
            views.append(View(f"{case['name']}-{width}x{height}", source, volume, kept, first.camera, (width, height)))
    return views
