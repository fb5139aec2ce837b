"""Images of other libraries, recognised by their attributes. Stand-ins replace the libraries; installed libraries are
tested, too."""

import sys
import types

import numpy as np
import pytest

from edgesplat import Error, Volume

ARRAY = np.arange(24.0).reshape(2, 3, 4)
TURNED = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])


class SimpleITKImage:
    """Stand-in with the used interface of SimpleITK.Image."""

    __module__ = "stand_in_itk.image"
    components, dimension = 1, 3

    def GetSpacing(self):
        return (0.5, 1.0, 2.0)

    def GetOrigin(self):
        return (1.0, 2.0, 3.0)

    def GetDirection(self):
        return tuple(TURNED.flatten())

    def GetNumberOfComponentsPerPixel(self):
        return self.components

    def GetDimension(self):
        return self.dimension


@pytest.fixture
def itk_library(monkeypatch):
    library = types.ModuleType("stand_in_itk")
    library.GetArrayViewFromImage = lambda image: ARRAY
    monkeypatch.setitem(sys.modules, "stand_in_itk", library)


def check_turned(volume):
    assert np.array_equal(volume.array, ARRAY)
    assert volume.spacing == (0.5, 1, 2)
    assert volume.origin == (1, 2, 3)
    assert np.allclose(volume.direction, TURNED)


def test_simple_itk(itk_library):
    volume = Volume(SimpleITKImage())
    check_turned(volume)
    assert volume.patient
    assert not Volume(SimpleITKImage(), patient=False).patient


def test_simple_itk_with_colours(itk_library):
    image = SimpleITKImage()
    image.components = 3
    with pytest.raises(Error, match="3 components per voxel: expected 1"):
        Volume(image)
    image.components, image.dimension = 1, 2
    with pytest.raises(Error, match="2 dimensions: expected 3"):
        Volume(image)


def nibabel_image(array, affine):
    return types.SimpleNamespace(dataobj=array, affine=affine, get_filename=lambda: "head.nii")


def test_nibabel():
    # i, j, k point right, forward and up; patient axes x and y point left and backward, against i and j.
    volume = Volume(nibabel_image(ARRAY.T, np.array([[2, 0, 0, 5], [0, 3, 0, 7], [0, 0, 4, 9], [0, 0, 0, 1.0]])))
    assert np.array_equal(volume.array, ARRAY)
    assert volume.spacing == (2, 3, 4)
    assert volume.origin == (-5, -7, 9)
    assert np.array_equal(volume.direction, np.diag([-1, -1, 1]))
    assert volume.patient and volume.name == "head.nii"


def test_nibabel_in_time():
    many = np.stack([ARRAY.T, ARRAY.T + 100], axis=3)
    with pytest.raises(Error, match=r"4-D data with 2 frames; choose one with frame=0..1"):
        Volume(nibabel_image(many, np.eye(4)))
    assert Volume(nibabel_image(many, np.eye(4)), frame=1).min == 100
    with pytest.raises(Error, match="frame 2: expected 0 to 1"):
        Volume(nibabel_image(many, np.eye(4)), frame=2)


def xarray_data(array, dims, **coords):
    coords = {k: types.SimpleNamespace(values=np.asarray(v)) for k, v in coords.items()}
    return types.SimpleNamespace(dims=dims, coords=coords, values=array, name="density")


def test_xarray():
    coords = {"z": [10, 12], "y": [0, 0.5, 1], "x": [3, 2, 1, 0]}
    volume = Volume(xarray_data(ARRAY, ("z", "y", "x"), **coords))
    assert np.array_equal(volume.array, ARRAY)
    assert volume.spacing == (1, 0.5, 2)
    assert volume.origin == (3, 0, 10)
    assert np.array_equal(volume.direction, np.diag([-1, 1, 1]))
    turned = Volume(xarray_data(ARRAY.transpose(2, 0, 1), ("x", "z", "y"), **coords))
    assert turned.checksum == volume.checksum


def test_xarray_without_coordinates():
    volume = Volume(xarray_data(ARRAY, ("depth", "row", "column")))
    assert volume.spacing == (1, 1, 1) and np.array_equal(volume.array, ARRAY)


def test_uneven_xarray():
    with pytest.raises(Error, match="coordinate x: expected even steps"):
        Volume(xarray_data(ARRAY, ("z", "y", "x"), x=[0, 1, 2, 4]))
    with pytest.raises(Error, match="expected three"):
        Volume(xarray_data(ARRAY[0], ("y", "x")))


def test_real_simple_itk():
    sitk = pytest.importorskip("SimpleITK")
    image = sitk.GetImageFromArray(ARRAY)
    image.SetSpacing((0.5, 1, 2))
    image.SetOrigin((1, 2, 3))
    image.SetDirection(tuple(TURNED.flatten()))
    check_turned(Volume(image))


def test_real_nibabel():
    nibabel = pytest.importorskip("nibabel")
    volume = Volume(nibabel.Nifti1Image(ARRAY.T.astype(np.float32), np.diag([2, 3, 4, 1.0])))
    assert np.array_equal(volume.array, ARRAY) and volume.spacing == (2, 3, 4)


def test_real_vtk():
    vtk = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    support = pytest.importorskip("vtkmodules.util.numpy_support")
    image = vtk.vtkImageData()
    image.SetExtent(2, 5, 0, 2, 0, 1)
    image.SetSpacing(0.5, 1, 2)
    image.SetOrigin(1, 2, 3)
    with pytest.raises(Error, match="has no point scalars"):
        Volume(image)
    scalars = support.numpy_to_vtk(ARRAY.ravel(), deep=True)
    image.GetPointData().SetScalars(scalars)
    volume = Volume(image)
    assert np.array_equal(volume.array, ARRAY)
    assert volume.spacing == (0.5, 1, 2) and volume.origin == (2, 2, 3)


def test_real_xarray():
    xarray = pytest.importorskip("xarray")
    data = xarray.DataArray(ARRAY, dims=("z", "y", "x"), coords={"x": [0, 2, 4, 6]}, name="density")
    volume = Volume(data)
    assert np.array_equal(volume.array, ARRAY) and volume.spacing == (2, 1, 1) and volume.name == "density"
