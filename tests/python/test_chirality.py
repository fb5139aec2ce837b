"""An object with marks at its left, front and top, written in every orientation of every format that defines a patient,
comes out with its marks in the right places: in the samples, in a picture from the front, and where that is measured."""

import itertools
import json
import warnings

import numpy as np
import pytest

import edgesplat

MARKS = {"left": (400, (6, 0, 0)), "front": (600, (0, -6, 0)), "top": (800, (0, 0, 6))}  # value, LPS mm
SPACING = np.array([0.9, 1.0, 1.2])
ORIENTATIONS = [(order, signs) for order in itertools.permutations(range(3)) for signs in itertools.product((1, -1), repeat=3)]


def affine_of(order, signs):
    """4 x 4 from voxel x, y, z to LPS mm: voxel axis i runs along world axis order[i]; the centre is at the origin."""
    dims = (20, 21, 22)
    matrix = np.eye(4)
    matrix[:3, :3] = 0
    for axis in range(3):
        matrix[order[axis], axis] = signs[axis] * SPACING[axis]
    matrix[:3, 3] = -matrix[:3, :3] @ ((np.array(dims) - 1) / 2)
    return matrix, dims


def marked(affine, dims):
    """Samples, [z, y, x], int16."""
    x, y, z = np.meshgrid(*(np.arange(n) for n in dims), indexing="ij")
    world = np.einsum("ij,jxyz->ixyz", affine[:3, :3], np.array([x, y, z])) + affine[:3, 3].reshape(3, 1, 1, 1)
    values = np.where(np.linalg.norm(world, axis=0) < 5, 200, 0)
    for value, place in MARKS.values():
        values[np.linalg.norm(world - np.reshape(place, (3, 1, 1, 1)), axis=0) < 2.5] = value
    return values.astype(np.int16).transpose(2, 1, 0)


def ras(affine):
    return np.diag([-1, -1, 1, 1]) @ affine


def write_nifti(folder, affine, array):
    nibabel = pytest.importorskip("nibabel", reason="python3-nibabel is missing")
    image = nibabel.Nifti1Image(array.transpose(2, 1, 0), ras(affine))
    image.set_sform(ras(affine), 1)
    image.set_qform(None, 0)
    nibabel.save(image, str(folder / "a.nii.gz"))
    return folder / "a.nii.gz"


def write_nifti_qform(folder, affine, array):
    nibabel = pytest.importorskip("nibabel", reason="python3-nibabel is missing")
    image = nibabel.Nifti1Image(array.transpose(2, 1, 0), ras(affine))
    image.set_qform(ras(affine), 1)
    image.set_sform(None, 0)
    nibabel.save(image, str(folder / "a.nii"))
    return folder / "a.nii"


def write_nifti_2(folder, affine, array):
    nibabel = pytest.importorskip("nibabel", reason="python3-nibabel is missing")
    image = nibabel.Nifti2Image(array.transpose(2, 1, 0), ras(affine))
    image.set_sform(ras(affine), 2)
    nibabel.save(image, str(folder / "a.nii"))
    return folder / "a.nii"


def write_mgh(folder, affine, array):
    nibabel = pytest.importorskip("nibabel", reason="python3-nibabel is missing")
    nibabel.save(nibabel.MGHImage(array.transpose(2, 1, 0).astype(np.float32), ras(affine)), str(folder / "a.mgz"))
    return folder / "a.mgz"


def triple(vector):
    return "(" + ",".join(repr(float(v)) for v in vector) + ")"


def nrrd(folder, name, flip, affine, array):
    to_space = np.diag(flip)
    directions = " ".join(triple(to_space @ affine[:3, axis]) for axis in range(3))
    head = (
        f"NRRD0005\ntype: int16\ndimension: 3\nspace: {name}\nsizes: {' '.join(str(n) for n in array.shape[::-1])}\n"
        f"space directions: {directions}\nspace origin: {triple(to_space @ affine[:3, 3])}\nendian: little\n"
        "encoding: raw\n\n"
    )
    path = folder / "a.nrrd"
    path.write_bytes(head.encode() + array.astype("<i2").tobytes())
    return path


def write_nrrd_lps(folder, affine, array):
    return nrrd(folder, "left-posterior-superior", (1, 1, 1), affine, array)


def write_nrrd_ras(folder, affine, array):
    return nrrd(folder, "RAS", (-1, -1, 1), affine, array)


def write_nrrd_las(folder, affine, array):
    return nrrd(folder, "left-anterior-superior", (1, -1, 1), affine, array)


def write_meta(folder, affine, array):
    matrix = " ".join(repr(float(v)) for axis in range(3) for v in affine[:3, axis] / SPACING[axis])
    head = (
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
        f"TransformMatrix = {matrix}\nOffset = {' '.join(repr(float(v)) for v in affine[:3, 3])}\n"
        f"AnatomicalOrientation = RAI\nElementSpacing = {' '.join(str(s) for s in SPACING)}\n"
        f"DimSize = {' '.join(str(n) for n in array.shape[::-1])}\nElementType = MET_SHORT\nElementDataFile = LOCAL\n"
    )
    path = folder / "a.mha"
    path.write_bytes(head.encode() + array.astype("<i2").tobytes())
    return path


def write_dicom(folder, affine, array):
    pydicom = pytest.importorskip("pydicom", reason="python3-pydicom is missing")
    from pydicom.dataset import FileDataset, FileMetaDataset
    from pydicom.uid import CTImageStorage, ExplicitVRLittleEndian, generate_uid

    series = generate_uid()
    for k, slice_ in enumerate(array):
        meta = FileMetaDataset()
        meta.MediaStorageSOPClassUID = CTImageStorage
        meta.MediaStorageSOPInstanceUID = generate_uid()
        meta.TransferSyntaxUID = ExplicitVRLittleEndian
        data = FileDataset("", {}, file_meta=meta, preamble=b"\0" * 128)
        data.SOPClassUID, data.SOPInstanceUID = CTImageStorage, meta.MediaStorageSOPInstanceUID
        data.Modality, data.SeriesInstanceUID, data.InstanceNumber = "CT", series, k + 1
        data.ImageOrientationPatient = [float(v) for axis in (0, 1) for v in affine[:3, axis] / SPACING[axis]]
        data.ImagePositionPatient = [round(float(v), 6) for v in affine[:3, 3] + k * affine[:3, 2]]
        data.PixelSpacing = [float(SPACING[1]), float(SPACING[0])]
        data.SliceThickness = float(SPACING[2])
        data.Rows, data.Columns = slice_.shape
        data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
        data.BitsAllocated = data.BitsStored = 16
        data.HighBit, data.PixelRepresentation = 15, 1
        data.PixelData = slice_.astype("<i2").tobytes()
        data.is_little_endian, data.is_implicit_VR = True, False
        # The names do not tell the order.
        data.save_as(str(folder / f"{(7 * k) % 22:02d}.dcm"), write_like_original=False)
    return folder


def write_enhanced_dicom(folder, affine, array):
    """One file, whose frames are in no order."""
    pydicom = pytest.importorskip("pydicom", reason="python3-pydicom is missing")
    from test_readers_dicom import ENHANCED_CT, frame_groups, new_dataset, save, set_pixels

    data = new_dataset(ENHANCED_CT)
    order = [(7 * k) % 22 for k in range(22) if (7 * k) % 22 < len(array)]
    set_pixels(data, array[order])
    data.NumberOfFrames = len(array)
    shared = frame_groups(orientation=np.concatenate([affine[:3, 0] / SPACING[0], affine[:3, 1] / SPACING[1]]))
    measures = pydicom.dataset.Dataset()
    measures.PixelSpacing, measures.SliceThickness = [float(SPACING[1]), float(SPACING[0])], float(SPACING[2])
    shared.PixelMeasuresSequence = pydicom.sequence.Sequence([measures])
    data.SharedFunctionalGroupsSequence = pydicom.sequence.Sequence([shared])
    data.PerFrameFunctionalGroupsSequence = pydicom.sequence.Sequence(
        [frame_groups(position=affine[:3, 3] + k * affine[:3, 2]) for k in order]
    )
    save(data, folder / "a.dcm")
    return folder / "a.dcm"


def write_minc(folder, affine, array, version=2):
    from test_readers_minc import Minc

    world = np.argmax(np.abs(affine[:3, :3]), axis=0)[::-1]  # of each axis, slowest first
    minc = Minc(version, [f"{'xyz'[a]}space" for a in world], array)
    minc.low, minc.high = np.array(float(array.min())), np.array(float(array.max()))
    minc.valid_range = [array.min(), array.max()]
    for axis, a in zip((2, 1, 0), world):
        minc.dims[f"{'xyz'[a]}space"] = {"step": ras(affine)[a, axis], "start": ras(affine)[a, 3]}
    return minc.write(folder / "a.mnc")


def write_minc_1(folder, affine, array):
    return write_minc(folder, affine, array, 1)


WRITERS = [
    write_nifti,
    write_nifti_qform,
    write_nifti_2,
    write_mgh,
    write_nrrd_lps,
    write_nrrd_ras,
    write_nrrd_las,
    write_meta,
    write_dicom,
    write_enhanced_dicom,
    write_minc,
    write_minc_1,
]


@pytest.mark.parametrize("write", WRITERS, ids=lambda write: write.__name__[6:])
def test_marks_are_in_their_places(write, tmp_path):
    for number, (order, signs) in enumerate(ORIENTATIONS):
        affine, dims = affine_of(order, signs)
        folder = tmp_path / str(number)
        folder.mkdir()
        path = write(folder, affine, marked(affine, dims))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            volume = edgesplat.Volume(path)
        assert volume.patient
        axes = volume.direction * np.array(volume.spacing)
        for name, (value, place) in MARKS.items():
            x, y, z = np.rint(np.linalg.solve(axes, np.array(place) - volume.origin)).astype(int)
            assert volume.array[z, y, x] == value, (order, signs, name)


@pytest.mark.parametrize("write", WRITERS, ids=lambda write: write.__name__[6:])
def test_marks_are_in_their_places_in_pictures(write, tmp_path, renderer, program):
    colors = {"left": (1, 0, 0), "front": (0, 1, 0), "top": (0, 0, 1)}
    scene = {
        "iso_values": [300, 500, 700],
        "materials": [{"color": list(c), "extinction": 20} for c in colors.values()],
        "lights": [],
        "volume": {"labels": False},
    }
    for number in (0, 13, 30, 47):
        affine, dims = affine_of(*ORIENTATIONS[number])
        folder = tmp_path / str(number)
        folder.mkdir()
        path = write(folder, affine, marked(affine, dims))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            color = renderer.render(path, scene, camera={"view": "front"}, size=(48, 48)).color[..., :3]
        rows, columns = np.mgrid[0:48, 0:48] - 23.5

        def excess(channel):
            return np.clip(color[..., channel] - color[..., [c for c in range(3) if c != channel]].max(-1), 0, None)

        def middle(channel):
            weight = excess(channel)
            assert weight.sum() > 3
            return (weight * columns).sum() / weight.sum(), (weight * rows).sum() / weight.sum()

        def pixel(channel):
            """Column, row: where the mark is seen farthest from its rim."""
            weight = excess(channel)
            least = np.min([np.roll(weight, (i, j), (0, 1)) for i in range(-2, 3) for j in range(-2, 3)], axis=0)
            row, column = np.unravel_index(least.argmax(), least.shape)
            return f"{column},{row}"

        # From the front: the patient's left is at the right of the front mark, the top above it. Rims of all marks have
        # the first colour.
        left, front, top = (np.array(middle(channel)) for channel in range(3))
        assert left[0] - front[0] > 8 and abs(left[1] - front[1]) < 4
        assert front[1] - top[1] > 8 and abs(front[0] - top[0]) < 4
        # What `measure` finds at the pixels of that picture lies on the marks' surfaces, whose centre is the mark's.
        asked = [f"--at={pixel(channel)}" for channel in range(3)]
        view = ["--iso=300,500,700", "--extinction=20,20,20", "--labels=off", "--view=front", "--size=48x48"]
        said = json.loads(program("measure", path, *view, *asked, "--json=-", "--quiet").stdout)
        for found, (_, place) in zip(said["places"], MARKS.values()):
            assert abs(np.linalg.norm(np.subtract(found["world_mm"], place)) - 2.5) < found["uncertainty_mm"]
