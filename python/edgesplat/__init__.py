"""Edgesplat from Python: volumes in, pictures out, edges sharp.

>>> import edgesplat
>>> edgesplat.render("builtin:sphere", camera={"view": "oblique"}).save("sphere.png")

Lengths are mm, angles degrees, colours linear light from 0 to 1. Arrays of volumes are indexed [z, y, x], pictures
[row, column, channel]; positions, spacings and sizes are x, y, z and width, height, as on the command line.
"""

from ._core import DeviceLost, Error, Interrupted, SceneError, __version__, builtin_names
from ._renderer import Device, Movie, Picture, Renderer, Statistics, accuracy, list_devices, movie, render
from ._scene import Camera, Key, Scene, scene_keys
from ._view import View
from ._volume import Extents, Quantity, Volume

__all__ = [
    "Camera",
    "Device",
    "DeviceLost",
    "Error",
    "Extents",
    "Interrupted",
    "Key",
    "Movie",
    "Picture",
    "Quantity",
    "Renderer",
    "Scene",
    "SceneError",
    "Statistics",
    "View",
    "Volume",
    "__version__",
    "accuracy",
    "builtin_names",
    "list_devices",
    "movie",
    "render",
    "scene_keys",
]
