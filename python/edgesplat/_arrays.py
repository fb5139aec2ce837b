"""Extracts samples and geometry from NumPy arrays and from images of SimpleITK, nibabel, VTK (PyVista) and xarray.
Images are recognised by their attributes, so that none of these libraries is required."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._core import Error

@dataclass
class Samples:
    """`array` is indexed [z, y, x]. The rows of `axes` are the steps of a voxel along x, y and z, mm."""

    array: np.ndarray
    axes: np.ndarray
    origin: np.ndarray
    patient: bool
    name: str


def samples_of(source: Any, name: str | None, frame: int | None) -> Samples:
    """Samples and geometry of `source`. Raises Error if it is not a scalar volume."""
    if _has(source, "affine", "dataobj"):
        found = _nibabel(source, frame)
    else:
        if frame is not None:
            raise Error(f"frame: {frame}: only for files and nibabel images; for an array expected array[{frame}]")
        if _has(source, "GetSpacing", "GetDirection", "GetNumberOfComponentsPerPixel"):
            found = _simple_itk(source)
        elif _has(source, "GetDimensions", "GetSpacing", "GetOrigin", "GetPointData"):
            found = _vtk(source)
        elif _has(source, "dims", "coords", "values"):
            found = _xarray(source)
        else:
            found = Samples(np.asanyarray(source), np.eye(3), np.zeros(3), False, "array")
    found.name = name if name is not None else found.name
    _check(found.array, found.name)
    if isinstance(found.array, np.ma.MaskedArray) and np.ma.is_masked(found.array):
        found.array = np.ma.filled(found.array.astype(np.float64), np.nan)
    return found


def fitted(array: np.ndarray) -> tuple[np.ndarray, float]:
    """The array divided by a power of two if float32 cannot hold its values, and that power; else the array and 1. Values
    above 1e100 are no measurements."""
    if array.dtype.kind != "f" or array.dtype.itemsize < 8 or array.size == 0:
        return array, 1.0
    size = np.abs(array)
    size = size[size <= 1e100]
    largest = float(size.max()) if size.size else 0.0
    if largest == 0 or 1e-30 <= largest <= 1e37:
        return array, 1.0
    scale = 2.0 ** int(np.floor(np.log2(largest)))
    return array / scale, scale


def _has(source: Any, *parts: str) -> bool:
    return all(hasattr(source, part) for part in parts)


def _check(array: np.ndarray, name: str) -> None:
    if name.startswith("builtin:"):
        raise Error(f"name: {name!r}: reserved for builtin volumes; expected another name")
    if array.dtype.kind not in "biuf":
        raise Error(f"{name}: dtype {array.dtype}: expected integers, floats or bool")
    if array.ndim != 3:
        raise Error(f"{name}: shape {array.shape}: expected three axes, z, y, x")


def _frame(array: np.ndarray, frame: int | None, name: str) -> np.ndarray:
    """One frame of an array. All axes after the third count frames."""
    if array.ndim <= 3:
        return array
    array = array.reshape(array.shape[:3] + (-1,), order="F")
    count = array.shape[3]
    if frame is None and count > 1:
        raise Error(f"{name}: 4-D data with {count} frames; choose one with frame=0..{count - 1}")
    if not 0 <= (frame or 0) < count:
        raise Error(f"{name}: frame {frame}: expected 0 to {count - 1}")
    return array[..., frame or 0]


def _simple_itk(image: Any) -> Samples:
    if image.GetNumberOfComponentsPerPixel() != 1:
        raise Error(f"SimpleITK image: {image.GetNumberOfComponentsPerPixel()} components per voxel: expected 1")
    if image.GetDimension() != 3:
        raise Error(f"SimpleITK image: {image.GetDimension()} dimensions: expected 3")
    library = sys.modules[type(image).__module__.partition(".")[0]]
    direction = np.reshape(image.GetDirection(), (3, 3))
    axes = (direction * np.asarray(image.GetSpacing())).T
    # The view is only valid while the image exists; the caller copies the samples before that.
    return Samples(library.GetArrayViewFromImage(image), axes, np.asarray(image.GetOrigin()), True, "SimpleITK image")


def _nibabel(image: Any, frame: int | None) -> Samples:
    name = image.get_filename() if hasattr(image, "get_filename") else None
    name = str(name or "nibabel image")
    array = _frame(np.asanyarray(image.dataobj), frame, name)
    # nibabel's x and y axes point right and forward; the patient axes here point left and backward.
    to_patient = np.diag([-1.0, -1.0, 1.0])
    affine = np.asarray(image.affine, dtype=float)
    return Samples(array.T, (to_patient @ affine[:3, :3]).T, to_patient @ affine[:3, 3], True, name)


def _vtk(image: Any) -> Samples:
    from importlib import import_module

    name = "VTK image"
    scalars = image.GetPointData().GetScalars()
    if scalars is None:
        raise Error(f"{name}: has no point scalars; expected one value per point (set the active scalars)")
    if scalars.GetNumberOfComponents() != 1:
        raise Error(f"{name}: {scalars.GetNumberOfComponents()} components per point: expected 1")
    to_numpy = import_module("vtkmodules.util.numpy_support").vtk_to_numpy
    array = to_numpy(scalars).reshape(tuple(image.GetDimensions())[::-1])
    direction = np.eye(3)
    if hasattr(image, "GetDirectionMatrix"):
        matrix = image.GetDirectionMatrix()
        direction = np.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)])
    axes = (direction * np.asarray(image.GetSpacing())).T
    first = np.asarray(image.GetExtent())[::2]
    return Samples(array, axes, np.asarray(image.GetOrigin()) + first @ axes, False, scalars.GetName() or name)


def _xarray(data: Any) -> Samples:
    name = str(data.name or "xarray")
    dims = [str(d) for d in data.dims]
    if len(dims) != 3:
        raise Error(f"{name}: dims {tuple(dims)}: expected three; choose others with .isel(...)")
    order = [dims.index(d) for d in "zyx"] if sorted(dims) == ["x", "y", "z"] else [0, 1, 2]
    array = np.transpose(np.asarray(data.values), order)
    spacing, origin = np.ones(3), np.zeros(3)
    for axis, place in enumerate(reversed(order)):  # x, y, z
        if data.dims[place] not in data.coords:
            continue
        at = np.asarray(data.coords[data.dims[place]].values, dtype=float)
        origin[axis] = at[0]
        if len(at) > 1:
            spacing[axis] = (at[-1] - at[0]) / (len(at) - 1)
            if not np.allclose(np.diff(at), spacing[axis], rtol=1e-3, atol=0):
                raise Error(f"{name}: coordinate {dims[place]}: expected even steps; interpolate to them with .interp")
    return Samples(array, np.diag(spacing), origin, False, name)
