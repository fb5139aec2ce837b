"""Files of situations that users of other programs reported, with what is right (EDGESPLAT_DATA/odd/cases)."""

import json
import os
import warnings
from pathlib import Path

import numpy as np
import pytest

from edgesplat import Error, Volume

CASES = Path(os.environ.get("EDGESPLAT_DATA", "")) / "odd" / "cases"
pytestmark = pytest.mark.skipif(not (CASES / "README.md").exists(), reason="EDGESPLAT_DATA has no odd/cases")


def read(name, **choice):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return Volume(CASES / name, **choice)


def matter(volume, iso):
    """mm^3 above an iso-value."""
    return volume.measure([iso]).volumes[1].value


def test_spaces_of_nrrd():
    for name in ("las", "lps"):
        volume = read(f"nrrd/{name}.nrrd")
        assert np.allclose(volume.direction, np.eye(3)) and np.allclose(volume.origin, (-30.2, -32.4, -36.2))
        assert volume.patient


def test_nan_is_no_data(renderer):
    with_nan, with_zero = read("nrrd/nan.nrrd"), read("nrrd/zero.nrrd")
    assert with_nan._core.non_finite_count > 0 and np.isfinite([with_nan.min, with_nan.max]).all()
    assert np.nanmean(with_nan.array[~with_nan.no_data]) == pytest.approx(0, abs=0.05)
    # Transparent around 0, the value in place of NaN.
    blue, red = {"color": [0.1, 0.2, 1]}, {"color": [1, 0.1, 0.05]}
    transfer = [
        {"value": -6, "extinction": 1, **blue},
        {"value": -2, "extinction": 0, **blue},
        {"value": 2, "extinction": 0, **red},
        {"value": 6, "extinction": 1, **red},
    ]
    asked = dict(transfer=transfer, size=(64, 64), camera={"view": "front"})
    assert np.abs(renderer.render(with_nan, **asked).color - renderer.render(with_zero, **asked).color).max() < 0.02


@pytest.mark.parametrize(
    "name, volume, choice",
    [
        ("nifti/sheared_both.nii.gz", 57137, {}),
        ("nifti/affine_sform.nii.gz", 57183, {}),
        ("dicom/a_ordered.dcm", 57119, {}),
        ("dicom/c_random.dcm", 57119, {}),
        ("dicom/e_two_phases.dcm", 57119, {"frame": 0}),
    ],
)
def test_volumes(name, volume, choice):
    assert matter(read(name, **choice), 500) == pytest.approx(volume, rel=0.003)


def test_two_phases_are_to_be_chosen():
    with pytest.raises(Error, match="--frame 0"):
        read("dicom/e_two_phases.dcm")


@pytest.mark.parametrize("name, low, high", [("nifti/a_slope0_inter100.nii", 0, 1000), ("dicom/a_dose.dcm", 0, 3)])
def test_values(name, low, high):
    volume = read(name)
    assert (volume.min, volume.max) == pytest.approx((low, high), abs=1e-4 * high)


@pytest.mark.parametrize("name", ["a_stack.tif", "b_one_ifd.tif", "c_two_channels.tif", "d_ome.ome.tif"])
def test_stacks_of_imagej(name):
    volume = read(f"tiff/{name}", component=0) if name[0] in "cd" else read(f"tiff/{name}")
    assert volume.shape == (24, 44, 40) and volume.spacing == pytest.approx((1.6e-3, 1.6e-3, 2.8e-3))  # micrometres


def test_ids_of_an_atlas():
    volume = read("labels/annotation.nrrd")
    ids = [8, 997, 312782546, 312782550, 312782554, 312782558]
    assert [label.number for label in volume.labels if label.number > 0] == ids
    voxel = np.prod(volume.spacing)
    found = volume.measure_labels()
    for number in ids:
        assert found[number].value == pytest.approx(3112 * voxel)


def test_three_hundred_cells():
    volume = read("labels/cells300.nrrd")
    found = volume.measure_labels()
    assert len([number for number in found if number > 0]) == 300
    assert len({label.color for label in volume.labels if label.number > 0}) > 200


def test_labels_are_cut(program):
    said = program("measure", CASES / "labels/nested.nrrd", "--clip-plane=0,0,0,0,-1,0", "--json=-", "--quiet").stdout
    found = sorted(label["volume_mm3"]["value"] for label in json.loads(said)["labels"])
    assert found == pytest.approx([1376 / 2, 10272 / 2, 26960 / 2], rel=0.01)


@pytest.mark.parametrize("name", ["d_binary_field.vtk", "e_cell_scalars.vtk"])
def test_legacy_vtk(name):
    assert read(f"vtk/{name}").shape == (24, 44, 40)


def test_thin_grids(renderer):
    for name in ("one_slice", "two_slices"):
        picture = renderer.render(read(f"thin/{name}.nrrd"), iso_values=[500], size=(64, 64), camera={"view": "top"})
        covered = picture.color[..., 3] > 0.5
        assert covered.any(axis=0).sum() >= 56
    # Eight corners and the middle, up to the continuation of the field beyond the outermost samples.
    assert matter(read("thin/grid3.nrrd"), 0.7) == pytest.approx(4.98, rel=0.05)
