"""Edgesplat for Python: renders volumes to pictures with sharp edges.

>>> import edgesplat
>>> edgesplat.render("builtin:sphere", camera={"view": "oblique"}).save("sphere.png")

Lengths are in mm, angles in degrees, colours in linear light from 0 to 1. Volume arrays are indexed [z, y, x], pictures
[row, column, channel]. Positions and spacings are x, y, z and sizes are width, height, as on the command line.
"""

from ._core import DeviceLost, Error, Interrupted, SceneError, __version__, builtin_names
from ._renderer import Device, Movie, Picture, Renderer, Statistics, accuracy, list_devices, movie, render
from ._scene import Camera, Key, Scene, scene_keys
from ._view import View
from ._volume import Extents, Label, Quantity, Volume

__all__ = [
    "Camera",
    "Device",
    "DeviceLost",
    "Error",
    "Extents",
    "Interrupted",
    "Key",
    "Label",
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
