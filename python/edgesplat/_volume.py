"""Volumes: samples and their geometry."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from typing import Any, Sequence, Tuple

import numpy as np

from . import _core
from ._arrays import fitted, samples_of
from ._core import Error

PathLike = (str, os.PathLike)
Triple = Tuple[float, float, float]


def _vector(value: Any, name: str) -> np.ndarray:
    try:
        vector = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        vector = np.zeros(0)
    if vector.shape != (3,):
        raise Error(f"{name}: {value!r}: expected 3 numbers")
    return vector


def _triple(vector: Any) -> Triple:
    x, y, z = (float(v) for v in vector)
    return x, y, z


def _axes(axes: np.ndarray, direction: Any, lengths: np.ndarray | None) -> list[Triple]:
    """Steps of a voxel along x, y, z; `direction` and `lengths` replace their directions and lengths unless None."""
    if direction is not None:
        matrix = np.asarray(direction, dtype=float)
        if matrix.shape != (3, 3):
            raise Error(f"direction: shape {matrix.shape}: expected 3 x 3, columns for x, y, z")
        axes = matrix.T * np.linalg.norm(axes, axis=1)[:, None]
    if lengths is not None:
        with np.errstate(all="ignore"):  # an axis of length 0 is refused later, with the volume
            axes = axes / np.linalg.norm(axes, axis=1)[:, None] * lengths[:, None]
    return [_triple(axis) for axis in axes]


@dataclass(frozen=True)
class Quantity:
    """A measured value and its uncertainty (+-)."""

    value: float
    uncertainty: float

    def __str__(self) -> str:
        return f"{self.value:.6g} ± {self.uncertainty:.2g}"


@dataclass(frozen=True)
class Label:
    """A label of a segmentation."""

    number: int
    """The file's own number."""
    name: str
    """Empty if it has none."""
    color: Triple
    """The colour in which it is drawn, linear light."""


@dataclass(frozen=True)
class Extents:
    """Result of `Volume.measure`."""

    volumes: tuple[Quantity, ...]
    """Volume of each material, mm^3: below the first iso-value, ..., from the last iso-value up."""
    surfaces: tuple[Quantity, ...]
    """Area of each iso-surface, mm^2."""


class Volume:
    """A scalar volume. It is immutable.

    source: a file, folder, pattern of slices or ``"builtin:NAME"``, as the program reads them. Or samples: anything
        that NumPy accepts as an array with three axes **z, y, x** (any strides and byte order; integers, floats or
        bool; stored as float32). Or an image with its own geometry: SimpleITK, nibabel (its right-anterior axes are
        converted to left-posterior), VTK or PyVista, or an xarray.DataArray.
    spacing: three lengths above 0, mm, along **x, y, z**; replaces the source's.
    origin: world position of voxel x = y = z = 0, mm.
    direction: 3 x 3; its **columns** are the world directions of x, y and z, as in ITK.
    patient: whether the world axes are patient axes (+x left, +y back, +z up).
    name: name of an array in messages and pictures.
    component, frame, level, series, raw: choose data in a file, as ``--component`` and so on; `frame` also in a 4-D
        nibabel image.

    no_data: value of samples without data.
    segmentation: a segmentation of the same object, on any grid, whose labels colour the volume's matter: a Volume, or
        anything that Volume accepts. An array has the volume's own grid.
    label_names: file with names and colours of labels, as ``--label-names``.

    Samples that are NaN, infinite, masked, or `no_data` contain no data: they are transparent and count in no
    statistics (`Volume.no_data`), with a warning.
    Raises Error with the program's messages.
    """

    def __init__(
        self,
        source: Any,
        *,
        spacing: Sequence[float] | None = None,
        origin: Sequence[float] | None = None,
        direction: Any = None,
        patient: bool | None = None,
        name: str | None = None,
        component: int | None = None,
        frame: int | None = None,
        level: int | None = None,
        series: str | int = "",
        raw: str = "",
        no_data: float | None = None,
        segmentation: Any = None,
        label_names: str | os.PathLike = "",
    ) -> None:
        own_names = "" if segmentation is not None else os.fspath(label_names)
        lengths = None if spacing is None else _vector(spacing, "spacing")
        if lengths is not None and not np.all(lengths > 0):
            raise Error(f"spacing: {_triple(lengths)}: expected lengths above 0, mm, along x, y, z")
        of_arrays = {"origin": origin, "direction": direction, "patient": patient, "name": name}
        series_given = None if series == "" else series
        of_files = {"component": component, "level": level, "series": series_given, "raw": raw or None}
        if isinstance(source, PathLike):
            for key, value in of_arrays.items():
                if value is not None:
                    raise Error(f"{key}: only for arrays; a file defines it")
            given = None if lengths is None else _triple(lengths)
            self._core = _core.Volume.load(
                os.fspath(source),
                component,
                frame,
                level,
                str(series),
                raw,
                given,
                no_data,
                own_names,
            )
        else:
            for key, value in of_files.items():
                if value is not None:
                    raise Error(f"{key}: only for files, not for {type(source).__name__}")
            found = samples_of(source, name, frame)
            axes = _axes(found.axes, direction, lengths)
            at = _triple(found.origin if origin is None else _vector(origin, "origin"))
            in_patient = found.patient if patient is None else bool(patient)
            array, scale = fitted(found.array)
            with np.errstate(over="ignore", invalid="ignore"):  # larger values become infinite; a warning reports them
                self._core = _core.Volume.from_array(
                    array, axes, at, in_patient, found.name, scale, no_data, own_names
                )
        if segmentation is not None:
            labels = self._segmentation(segmentation)
            self._core = self._core.with_segmentation(labels._core, os.fspath(label_names))
        self._warn()

    def _segmentation(self, given: Any) -> Volume:
        if isinstance(given, Volume):
            return given
        if not isinstance(given, np.ndarray):
            return Volume(given)
        return Volume(
            given,
            spacing=self.spacing,
            origin=self.origin,
            direction=self.direction,
            patient=self.patient,
            name="segmentation",
        )

    def _warn(self) -> None:
        if self._core.non_finite_count:
            warnings.warn(
                f"{self.name}: {self._core.non_finite_count} samples contain no data; they are transparent",
                stacklevel=3,
            )
        for text in self._core.warnings:
            warnings.warn(f"{self.name}: {text}", stacklevel=3)

    @classmethod
    def _of(cls, held: _core.Volume) -> Volume:
        volume = cls.__new__(cls)
        volume._core = held
        return volume

    @property
    def array(self) -> np.ndarray:
        """The samples, float32, shape (z, y, x). Read-only; shares the volume's memory. A float64 copy if the values are
        too large or too small for float32. Where there are no data: the smallest sample. Labels with numbers above 2^24
        are stored as their places in `labels`, from 0."""
        scale = self._core.value_scale
        return self._core.array if scale == 1 else self._core.array.astype(np.float64) * scale

    @property
    def no_data(self) -> np.ndarray | None:
        """Which samples contain no data: bool, shape (z, y, x). None: all contain data."""
        return self._core.no_data

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of voxels along z, y, x."""
        z, y, x = self._core.shape
        return z, y, x

    @property
    def spacing(self) -> Triple:
        """Voxel spacing along x, y, z, mm."""
        return _triple(self._core.spacing)

    @property
    def origin(self) -> Triple:
        """World position of voxel 0, 0, 0, mm."""
        return _triple(self._core.origin)

    @property
    def direction(self) -> np.ndarray:
        """3 x 3; columns are the world directions of x, y and z."""
        axes = np.array(self._core.axes)
        return (axes / np.linalg.norm(axes, axis=1)[:, None]).T

    @property
    def patient(self) -> bool:
        """Whether the world axes are patient axes."""
        return self._core.patient

    @property
    def min(self) -> float:
        """The smallest sample with data."""
        return self._core.min

    @property
    def max(self) -> float:
        """The largest sample with data."""
        return self._core.max

    @property
    def name(self) -> str:
        """Path, ``builtin:NAME``, or the name of an array."""
        return self._core.name

    @property
    def stored_type(self) -> str:
        """Type of the samples in the file or the array."""
        return self._core.stored_type

    @property
    def checksum(self) -> str:
        """Checksum of dims, geometry and samples: 16 hexadecimal digits, as ``edgesplat info`` prints them."""
        return self._core.checksum

    @property
    def notes(self) -> list[str]:
        """Assumptions, choices and corrections made while reading."""
        return self._core.notes

    def suggest_iso_values(self, count: int = 4) -> list[tuple[float, float]]:
        """Likely iso-values with their strengths, relative to the strongest, which comes first."""
        return self._core.suggest_iso_values(count)

    def measure(self, iso_values: float | Sequence[float]) -> Extents:
        """The volume of each material and the area of each iso-surface, with uncertainties, as ``edgesplat measure``
        measures them. Materials are separated where the cubic B-spline through the samples crosses an iso-value. Ctrl-C
        stops the measurement."""
        values = np.atleast_1d(np.asarray(iso_values, dtype=float))
        if values.ndim != 1 or not np.all(np.isfinite(values)) or not np.all(np.diff(values) > 0) or not len(values):
            raise Error(f"iso_values: {iso_values}: expected finite numbers that ascend")
        volumes, surfaces = self._core.measure([float(value) for value in values])
        return Extents(tuple(Quantity(*v) for v in volumes), tuple(Quantity(*s) for s in surfaces))

    @property
    def labels(self) -> list[Label]:
        """The labels of a segmentation, by ascending number; empty for measured values."""
        return [Label(number, name, _triple(color)) for number, name, color in self._core.labels]

    def measure_labels(self) -> dict[int, Quantity]:
        """For a segmentation: the volume of each label by its number, mm^3; `labels` has the names. The uncertainty is
        half the volume of the label's voxels that have another label beside them. The values of another volume count
        as labels, too (then keys are float)."""
        return {number: Quantity(*volume) for number, _, _, volume, _ in self._core.measure_labels()}

    def measure_values(self) -> dict[int, tuple[float, float]]:
        """For a volume with a segmentation: mean and standard deviation of its values in each label, by number."""
        return {number: values for number, _, _, _, values in self._core.measure_labels() if values is not None}

    def __repr__(self) -> str:
        z, y, x = self.shape
        return f"<Volume {self.name}: {x} x {y} x {z} voxels, {self.min:g} to {self.max:g}>"
