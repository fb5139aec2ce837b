"""DICOM files against pydicom: place and values that the test computes from the data set's attributes."""

import shutil
import subprocess
import warnings

import numpy as np
import pytest

import edgesplat
from edgesplat import Error, Volume

pydicom = pytest.importorskip("pydicom", reason="pydicom (python3-pydicom) is not installed")
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset  # noqa: E402
from pydicom.sequence import Sequence  # noqa: E402
from pydicom.uid import (  # noqa: E402
    DeflatedExplicitVRLittleEndian,
    ExplicitVRBigEndian,
    ExplicitVRLittleEndian,
    ImplicitVRLittleEndian,
    RLELossless,
    generate_uid,
)

CT, ENHANCED_CT = "1.2.840.10008.5.1.4.1.1.2", "1.2.840.10008.5.1.4.1.1.2.1"
ENHANCED_MR, DOSE = "1.2.840.10008.5.1.4.1.1.4.1", "1.2.840.10008.5.1.4.1.1.481.2"
SEGMENTATION = "1.2.840.10008.5.1.4.1.1.66.4"
SYNTAXES = [
    ImplicitVRLittleEndian,
    ExplicitVRLittleEndian,
    ExplicitVRBigEndian,
    DeflatedExplicitVRLittleEndian,
    RLELossless,
]


def decimal(value, digits=12):
    """A number as decimal text of at most 16 characters, as DS wants it."""
    text = f"{value:.{digits}g}"
    return text if len(text) <= 16 else f"{value:.9g}"


def rotation(rng):
    matrix, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return matrix if np.linalg.det(matrix) > 0 else matrix[:, ::-1]


def new_dataset(sop_class, series="1.2.3.4.5", modality="CT"):
    ds = Dataset()
    ds.SOPClassUID, ds.SOPInstanceUID = sop_class, generate_uid()
    ds.StudyInstanceUID, ds.SeriesInstanceUID = "1.2.3.4", series
    ds.Modality, ds.PatientName, ds.PatientID = modality, "Made^Up", "none"
    ds.ImageType = ["ORIGINAL", "PRIMARY", "AXIAL"]
    return ds


def set_pixels(ds, stored, bits=16, allocated=16, high=None, garbage=None):
    """stored: integers [frame, row, column], within `bits`. `garbage`: bits above and below the stored ones."""
    high = bits - 1 if high is None else high
    raw = (stored.astype(np.int64) & ((1 << bits) - 1)) << (high + 1 - bits)
    if garbage is not None:
        mask = ((1 << bits) - 1) << (high + 1 - bits)
        raw |= garbage.integers(0, 1 << allocated, stored.shape) & ~mask & ((1 << allocated) - 1)
    ds.SamplesPerPixel, ds.PhotometricInterpretation = 1, "MONOCHROME2"
    ds.Rows, ds.Columns = stored.shape[1:]
    ds.BitsAllocated, ds.BitsStored, ds.HighBit = allocated, bits, high
    ds.PixelRepresentation = int(stored.dtype.kind == "i")
    ds["PixelData"] = pydicom.DataElement(
        0x7FE00010, "OB" if allocated == 8 else "OW", raw.astype(f"<u{allocated // 8}").tobytes()
    )


def run_length(frame, allocated):
    """A frame coded by literal runs only: pydicom 2 cannot code all types."""
    width = allocated // 8
    planes = [frame.astype(f">u{width}").reshape(-1).view(np.uint8).reshape(-1, width)[:, i] for i in range(width)]
    coded = []
    for plane in planes:
        data, out = plane.tobytes(), b""
        for at in range(0, len(data), 128):
            part = data[at : at + 128]
            same = len(part) > 1 and len(set(part)) == 1
            out += bytes([257 - len(part), part[0]]) if same else bytes([len(part) - 1]) + part
        coded.append(out + b"\0" * (len(out) % 2))
    offsets = np.cumsum([64] + [len(part) for part in coded[:-1]])
    head = np.zeros(16, "<u4")
    head[0], head[1 : 1 + width] = width, offsets
    return head.tobytes() + b"".join(coded)


def save(ds, path, syntax=ExplicitVRLittleEndian, preamble=True):
    ds = pydicom.dataset.Dataset(ds)
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = ds.SOPClassUID, ds.SOPInstanceUID
    meta.TransferSyntaxUID, meta.ImplementationClassUID = syntax, "1.2.3.4"
    if syntax == RLELossless:
        shape = (-1, ds.Rows, ds.Columns)
        frames = np.frombuffer(ds.PixelData, f"<u{ds.BitsAllocated // 8}").reshape(shape)
        ds["PixelData"] = pydicom.DataElement(
            0x7FE00010, "OB", pydicom.encaps.encapsulate([run_length(frame, ds.BitsAllocated) for frame in frames])
        )
        ds["PixelData"].is_undefined_length = True
    if syntax == ExplicitVRBigEndian and ds.BitsAllocated > 8:
        ds["PixelData"].value = np.frombuffer(ds.PixelData, "<u2").astype(">u2").tobytes()
    file = FileDataset(str(path), ds, file_meta=meta, preamble=b"\0" * 128 if preamble else None)
    file.is_little_endian = syntax != ExplicitVRBigEndian
    file.is_implicit_VR = syntax == ImplicitVRLittleEndian
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        file.save_as(str(path), write_like_original=not preamble)


def stored_samples(path):
    """pydicom's samples, [frame, row, column], from the stored bits alone."""
    ds = pydicom.dcmread(path, force=True)
    raw = ds.pixel_array.reshape((-1, ds.Rows, ds.Columns)).astype(np.int64)
    raw = raw >> (ds.HighBit + 1 - ds.BitsStored) & ((1 << ds.BitsStored) - 1)
    sign = 1 << (ds.BitsStored - 1)
    return np.where(raw & sign, raw - 2 * sign, raw) if ds.PixelRepresentation else raw


def check(volume, axes, origin, samples, padding=None):
    """axes: columns are steps along x, y, z."""
    found = volume.direction * np.array(volume.spacing)
    size = np.linalg.norm(axes, axis=0)
    assert np.allclose(found, axes, atol=2e-6 * size.max(), rtol=0), (found, axes)
    assert np.allclose(volume.origin, origin, atol=1e-5), (volume.origin, origin)
    assert volume.patient
    assert volume.shape == samples.shape
    expected = samples.astype(np.float32)
    if padding is not None and padding.any():
        kept = ~padding
        assert np.array_equal(volume.array[kept], expected[kept])
        assert volume._core.non_finite_count == padding.sum()
    else:
        assert np.array_equal(volume.array, expected)
        assert volume.max == expected.max() and volume.min == expected.min()


def load(path, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return Volume(path, **options)


# Syntax, signed, bits stored, bits allocated, MONOCHROME1, slopes per slice: all fields vary independently.
@pytest.mark.parametrize("seed", range(70))
def test_folders_of_single_slices(tmp_path, seed):
    rng = np.random.default_rng(seed)
    syntax = SYNTAXES[seed % len(SYNTAXES)]
    count, rows, columns = rng.integers(2, 7), rng.integers(2, 9), rng.integers(2, 9)
    axes = rotation(rng) if seed % 3 else np.eye(3)[:, rng.permutation(3)] * rng.choice([-1, 1], 3)
    row, column = axes[:, 0], axes[:, 1]
    normal = np.cross(row, column)
    spacing = rng.uniform(0.2, 3, 2)
    tilt = rng.uniform(-0.8, 0.8, 2) if seed % 4 == 1 else np.zeros(2)
    step = rng.uniform(0.3, 5) * normal + tilt[0] * row + tilt[1] * column
    origin = rng.uniform(-200, 200, 3)
    allocated = 8 if seed % 5 == 2 else 16
    bits = int(rng.integers(5, allocated + 1))
    high = int(rng.integers(bits - 1, allocated)) if seed % 2 and syntax != RLELossless else bits - 1
    signed = bool(rng.integers(2))
    low, most = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)
    stored = rng.integers(low, most + 1, (count, rows, columns)).astype(np.int32 if signed else np.uint32)
    slopes = rng.uniform(0.01, 3, count) if seed % 2 else np.ones(count)
    pad = int(stored[0, 0, 0]) if seed % 7 == 3 else None
    names = rng.permutation(count)
    for i in range(count):
        ds = new_dataset(CT, modality="PT" if seed % 2 else "CT")
        set_pixels(ds, stored[i : i + 1], bits, allocated, high, rng if seed % 3 == 1 else None)
        ds.PhotometricInterpretation = "MONOCHROME1" if seed % 11 == 5 else "MONOCHROME2"
        ds.InstanceNumber = int(rng.integers(1000))
        ds.PatientPosition = str(rng.choice(["HFS", "FFP", "HFDR"]))
        ds.ImageOrientationPatient = [decimal(v, 9) for v in np.concatenate([row, column])]
        ds.ImagePositionPatient = [decimal(v, 10) for v in origin + i * step]
        ds.PixelSpacing = [decimal(spacing[1]), decimal(spacing[0])]
        ds.SliceThickness = decimal(rng.uniform(0.5, 10))
        if seed % 3 != 2:
            ds.RescaleSlope, ds.RescaleIntercept = decimal(slopes[i]), decimal(-1024 + i)
        if pad is not None:
            ds.add_new(0x00280120, "SS" if signed else "US", pad)
        save(ds, tmp_path / f"{names[i]}{['', '.dcm'][seed % 2]}", syntax)
    values, padding, positions = [], [], []
    for i in range(count):
        path = tmp_path / f"{names[i]}{['', '.dcm'][seed % 2]}"
        ds = pydicom.dcmread(path)
        samples = stored_samples(path)[0]
        values.append(samples * float(ds.get("RescaleSlope", 1)) + float(ds.get("RescaleIntercept", 0)))
        padding.append(samples == pad if pad is not None else np.zeros(samples.shape, bool))
        positions.append(np.array(ds.ImagePositionPatient, float))
    order = np.argsort([p @ normal for p in positions])
    values, padding = np.array(values)[order], np.array(padding)[order]
    first, last = positions[order[0]], positions[order[-1]]
    expected = np.column_stack([row * spacing[0], column * spacing[1], (last - first) / (count - 1)])
    check(load(tmp_path), expected, first, values, padding)


def frame_groups(position=None, orientation=None, slope=None, temporal=None, echo=None, b_value=None, stack=None):
    groups = Dataset()
    content = Dataset()
    if temporal is not None:
        content.TemporalPositionIndex = temporal
    if stack is not None:
        content.StackID = stack
    groups.FrameContentSequence = Sequence([content])
    if position is not None:
        item = Dataset()
        item.ImagePositionPatient = [decimal(v, 10) for v in position]
        groups.PlanePositionSequence = Sequence([item])
    if orientation is not None:
        item = Dataset()
        item.ImageOrientationPatient = [decimal(v, 9) for v in orientation]
        groups.PlaneOrientationSequence = Sequence([item])
    if slope is not None:
        item = Dataset()
        item.RescaleSlope, item.RescaleIntercept, item.RescaleType = decimal(slope[0]), decimal(slope[1]), "US"
        groups.PixelValueTransformationSequence = Sequence([item])
    if echo is not None:
        item = Dataset()
        item.EffectiveEchoTime = echo
        groups.MREchoSequence = Sequence([item])
    if b_value is not None:
        item = Dataset()
        item.DiffusionBValue = b_value
        groups.MRDiffusionSequence = Sequence([item])
    return groups


@pytest.mark.parametrize("seed", range(50))
def test_enhanced_files(tmp_path, seed):
    rng = np.random.default_rng(1000 + seed)
    syntax = SYNTAXES[seed % len(SYNTAXES)]
    slices, rows, columns = rng.integers(2, 8), rng.integers(2, 9), rng.integers(2, 9)
    axes = rotation(rng) if seed % 3 else np.eye(3)
    row, column, normal = axes[:, 0], axes[:, 1], np.cross(axes[:, 0], axes[:, 1])
    spacing, gap, origin = rng.uniform(0.2, 3, 2), rng.uniform(0.3, 5), rng.uniform(-200, 200, 3)
    step = gap * normal + (rng.uniform(-0.5, 0.5) * column if seed % 5 == 1 else 0)
    kind = [None, "temporal", "echo", "b_value"][seed % 4]
    groups = 1 if kind is None else int(rng.integers(2, 4))
    tags = sorted(rng.choice(np.arange(1, 40), groups, replace=False).astype(float))
    frames = [(g, s) for g in range(groups) for s in range(slices)]
    order = rng.permutation(len(frames))
    signed = bool(seed % 2)
    stored = rng.integers(-1000 if signed else 0, 2000, (len(frames), rows, columns))
    stored = stored.astype(np.int32 if signed else np.uint32)
    ds = new_dataset(ENHANCED_MR if kind in ("echo", "b_value") else ENHANCED_CT)
    set_pixels(ds, stored[order], 13 if signed else 12)
    ds.NumberOfFrames = len(frames)
    shared = frame_groups(orientation=np.concatenate([row, column]) if seed % 2 else None)
    del shared.FrameContentSequence
    measures = Dataset()
    measures.PixelSpacing = [decimal(spacing[1]), decimal(spacing[0])]
    measures.SliceThickness, measures.SpacingBetweenSlices = decimal(gap), decimal(gap * (2 if seed % 7 == 0 else 1))
    shared.PixelMeasuresSequence = Sequence([measures])
    slopes = rng.uniform(0.1, 3, (len(frames), 2)) if seed % 3 else np.tile([1.0, -1024.0], (len(frames), 1))
    per_frame = []
    for i in order:
        group, at = frames[i]
        choice = {} if kind is None else {kind: int(tags[group]) if kind == "temporal" else tags[group]}
        per_frame.append(
            frame_groups(
                origin + at * step,
                None if seed % 2 else np.concatenate([row, column]),
                slopes[i],
                stack="1",
                **choice,
            )
        )
    ds.SharedFunctionalGroupsSequence = Sequence([shared])
    ds.PerFrameFunctionalGroupsSequence = Sequence(per_frame)
    path = tmp_path / "enhanced"
    save(ds, path, syntax)
    read, samples = pydicom.dcmread(path), stored_samples(path)
    found = []
    for i, item in enumerate(read.PerFrameFunctionalGroupsSequence):
        transform = item.PixelValueTransformationSequence[0]
        scaled = samples[i] * float(transform.RescaleSlope) + float(transform.RescaleIntercept)
        found.append((frames[order[i]], np.array(item.PlanePositionSequence[0].ImagePositionPatient, float), scaled))
    if groups > 1:
        with pytest.raises(Error, match=f"{groups} frames at the same position.*--frame 0..{groups - 1}"):
            load(path)
        with pytest.raises(Error, match="numbered from 0"):
            load(path, frame=groups)
    for group in range(groups):
        own = sorted((f for f in found if f[0][0] == group), key=lambda f: f[1] @ normal)
        axis = (own[-1][1] - own[0][1]) / (slices - 1)
        expected = np.column_stack([row * spacing[0], column * spacing[1], axis])
        volume = load(path, frame=None if groups == 1 else group)
        check(volume, expected, own[0][1], np.array([f[2] for f in own]))


@pytest.mark.parametrize("seed", range(24))
def test_doses(tmp_path, seed):
    rng = np.random.default_rng(2000 + seed)
    slices, rows, columns = rng.integers(2, 8), rng.integers(2, 9), rng.integers(2, 9)
    signs = [(1, 1), (-1, 1), (1, -1), (-1, -1)][seed % 4]
    row, column = np.array([signs[0], 0.0, 0.0]), np.array([0.0, signs[1], 0.0])
    if seed % 3 == 2:
        axes = rotation(rng)
        row, column = axes[:, 0], axes[:, 1]
    normal = np.cross(row, column)
    gap, origin = np.round(rng.uniform(0.5, 5), 2), np.round(rng.uniform(-100, 100, 3), 3)
    offsets = np.round(np.arange(slices) * gap * (1 if seed % 2 else -1), 6)
    absolute = seed % 3 == 1
    ds = new_dataset(DOSE, modality="RTDOSE")
    wide = bool(seed % 2)
    stored = rng.integers(0, (1 << 32 if wide else 1 << 16) - 1, (slices, rows, columns)).astype(np.uint32)
    set_pixels(ds, stored, 32 if wide else 16, 32 if wide else 16)
    ds.NumberOfFrames, ds.FrameIncrementPointer = int(slices), 0x3004000C
    ds.ImageOrientationPatient = [decimal(v, 9) for v in np.concatenate([row, column])]
    ds.ImagePositionPatient = [decimal(v) for v in origin]
    ds.PixelSpacing, ds.SliceThickness = [decimal(1.25), decimal(2.5)], ""
    scaling = rng.uniform(1e-9, 1e-6)
    ds.DoseUnits, ds.DoseGridScaling = "GY", decimal(scaling)
    ds.GridFrameOffsetVector = [decimal(v) for v in (origin[2] + offsets * normal[2] if absolute else offsets)]
    path = tmp_path / "dose.dcm"
    save(ds, path, SYNTAXES[seed % 2])
    read = pydicom.dcmread(path)
    values = stored_samples(path) * float(read.DoseGridScaling)
    positions = [origin + offset * normal for offset in offsets]
    if offsets[-1] < 0:
        values, positions = values[::-1], positions[::-1]
    expected = np.column_stack([row * 2.5, column * 1.25, normal * gap])
    volume = load(path)
    check(volume, expected, positions[0], values)
    assert any("dose in Gy" in note for note in volume.notes)


@pytest.mark.parametrize("seed", range(24))
def test_segmentations(tmp_path, seed):
    rng = np.random.default_rng(3000 + seed)
    slices, rows, columns, count = rng.integers(3, 8), rng.integers(3, 9), rng.integers(3, 9), rng.integers(1, 4)
    axes = rotation(rng) if seed % 2 else np.eye(3)
    row, column, normal = axes[:, 0], axes[:, 1], np.cross(axes[:, 0], axes[:, 1])
    gap, origin = rng.uniform(0.5, 5), rng.uniform(-100, 100, 3)
    labels = rng.integers(0, count + 1, (slices, rows, columns))
    labels[0, 0, 0] = labels[-1, 0, 0] = labels[1, 0, 0] = 1
    labels[slices // 2 + 1 : slices - 1] = 0  # planes without frames
    fractional = seed % 3 == 1
    ds = new_dataset(SEGMENTATION, modality="SEG")
    ds.SegmentationType = "FRACTIONAL" if fractional else "BINARY"
    if fractional:
        ds.SegmentationFractionalType, ds.MaximumFractionalValue = "PROBABILITY", 200
    segments = []
    for number in range(1, count + 1):
        item = Dataset()
        item.SegmentNumber, item.SegmentLabel, item.SegmentAlgorithmType = number, f"part {number}", "MANUAL"
        item.RecommendedDisplayCIELabValue = [30000, 40000, 20000 + number]
        segments.append(item)
    ds.SegmentSequence = Sequence(segments)
    planes, per_frame = [], []
    for number, at in rng.permutation([(n, s) for n in range(1, count + 1) for s in range(slices)]):
        mask = labels[at] == number
        if not mask.any():
            continue
        groups = frame_groups(origin + at * gap * normal)
        identified = Dataset()
        identified.ReferencedSegmentNumber = int(number)
        groups.SegmentIdentificationSequence = Sequence([identified])
        per_frame.append(groups)
        planes.append(mask)
    planes = np.array(planes)
    ds.NumberOfFrames = len(planes)
    if fractional:
        set_pixels(ds, (planes * np.uint32(150)), 8, 8)
    else:
        set_pixels(ds, planes.astype(np.uint32), 8, 8)
        ds.BitsAllocated = ds.BitsStored = 1
        ds.HighBit = 0
        packed = np.packbits(planes.ravel(), bitorder="little").tobytes()
        ds["PixelData"] = pydicom.DataElement(0x7FE00010, "OB", packed + b"\0" * (len(packed) % 2))
    shared = frame_groups(orientation=np.concatenate([row, column]))
    measures = Dataset()
    measures.PixelSpacing, measures.SliceThickness = [decimal(0.8), decimal(1.5)], decimal(gap)
    if seed % 2:
        measures.SpacingBetweenSlices = decimal(gap)
    shared.PixelMeasuresSequence = Sequence([measures])
    ds.SharedFunctionalGroupsSequence, ds.PerFrameFunctionalGroupsSequence = Sequence([shared]), Sequence(per_frame)
    path = tmp_path / "seg.dcm"
    save(ds, path, SYNTAXES[seed % 2])
    assert np.array_equal(pydicom.dcmread(path).pixel_array.reshape(planes.shape) > 0, planes)
    expected = np.column_stack([row * 1.5, column * 0.8, normal * gap])
    check(load(path), expected, origin, labels)
    if fractional:
        assert np.allclose(load(path, component=0).array, (labels == 1) * 0.75)
    else:
        assert np.array_equal(load(path, component=0).array, labels == 1)


@pytest.mark.parametrize("spacing, digits", [(1 / 3, 1), (0.7083, 1), (0.25, 1), (2.4999, 2), (0.0666, 2), (2.5, 0)])
def test_rounded_positions(tmp_path, spacing, digits):
    count = 23
    for i in range(count):
        ds = new_dataset(CT)
        set_pixels(ds, np.full((1, 2, 3), i, np.uint32))
        ds.ImageOrientationPatient, ds.PixelSpacing = [1, 0, 0, 0, 1, 0], ["0.5", "0.5"]
        ds.ImagePositionPatient = ["-10.5", "20.25", f"{np.round(i * spacing, digits):g}"]
        save(ds, tmp_path / f"{i:02}")
    volume = load(tmp_path)
    assert np.array_equal(volume.array[:, 0, 0], np.arange(count))
    assert abs(volume.spacing[2] - spacing) < 10**-digits / (count - 1)


@pytest.mark.skipif(shutil.which("gdcmconv") is None, reason="gdcmconv (libgdcm-tools) is not installed")
@pytest.mark.parametrize("coding", ["--jpeg", "--j2k", "--jpegls", "--rle"])
@pytest.mark.parametrize("bits, allocated, signed", [(8, 8, False), (12, 16, False), (16, 16, False), (16, 16, True)])
@pytest.mark.parametrize("frames", [1, 4])
def test_compressed(tmp_path, coding, bits, allocated, signed, frames):
    if coding == "--jpegls" and signed:
        pytest.skip("gdcmconv does not write signed JPEG-LS")
    rng = np.random.default_rng(bits)
    low = -(1 << (bits - 1)) if signed else 0
    y, x = np.mgrid[0:24, 0:20]
    stored = low + (np.arange(frames)[:, None, None] * 7 + x * 3 + y * 2 + rng.integers(0, 100, (frames, 24, 20)))
    ds = new_dataset(CT if frames == 1 else "1.2.840.10008.5.1.4.1.1.7.3")
    set_pixels(ds, stored.astype(np.int32 if signed else np.uint32), bits, allocated)
    ds.ImageOrientationPatient, ds.PixelSpacing = [1, 0, 0, 0, 1, 0], ["0.5", "0.5"]
    ds.ImagePositionPatient, ds.SpacingBetweenSlices = [0, 0, 0], 2
    if frames > 1:
        ds.NumberOfFrames = frames
    save(ds, tmp_path / "native.dcm")
    packed = tmp_path / "packed.dcm"
    done = subprocess.run(["gdcmconv", coding, tmp_path / "native.dcm", packed], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert pydicom.dcmread(packed).file_meta.TransferSyntaxUID.is_compressed
    options = {"spacing": (0.5, 0.5, 2)} if frames > 1 else {}
    assert np.array_equal(load(packed, **options).array, stored[: max(frames, 1)].astype(np.float32))


def test_without_preamble(tmp_path):
    for i in range(3):
        ds = new_dataset(CT)
        set_pixels(ds, np.full((1, 2, 3), i, np.uint32))
        ds.ImageOrientationPatient, ds.PixelSpacing = [1, 0, 0, 0, 1, 0], ["0.5", "0.5"]
        ds.ImagePositionPatient = [0, 0, 2 * i]
        save(ds, tmp_path / "whole", ImplicitVRLittleEndian)
        data = (tmp_path / "whole").read_bytes()
        meta = 144 + int.from_bytes(data[140:144], "little")
        (tmp_path / "series").mkdir(exist_ok=True)
        (tmp_path / "series" / str(i)).write_bytes(data[132:] if i == 1 else data[meta:])
    (tmp_path / "whole").unlink()
    assert np.array_equal(load(tmp_path).array[:, 0, 0], [0, 1, 2])  # the folder has a folder


@pytest.mark.parametrize("photometric", ["RGB", "YBR_FULL", "PALETTE COLOR"])
@pytest.mark.parametrize("planar", [0, 1])
def test_colours(tmp_path, photometric, planar):
    rng = np.random.default_rng(5)
    palette = photometric == "PALETTE COLOR"
    pixels = rng.integers(0, 256, (3, 4) if palette else (3, 4, 3)).astype(np.uint8)
    ds = new_dataset("1.2.840.10008.5.1.4.1.1.7", modality="OT")
    set_pixels(ds, np.zeros((1, 3, 4), np.uint32), 8, 8)
    ds.PhotometricInterpretation = photometric
    if not palette:
        ds.SamplesPerPixel, ds.PlanarConfiguration = 3, planar
    stored = pixels.transpose(2, 0, 1) if planar and not palette else pixels
    ds["PixelData"] = pydicom.DataElement(0x7FE00010, "OB", np.ascontiguousarray(stored).tobytes())
    path = tmp_path / "a.dcm"
    save(ds, path)
    if palette:
        assert np.array_equal(load(path).array[0], pixels)
        return
    with pytest.raises(Error, match="--component 0..2"):
        load(path)
    colours = pixels.astype(float)
    if photometric == "YBR_FULL":
        colours = pydicom.pixel_data_handlers.util.convert_color_space(pixels, "YBR_FULL", "RGB").astype(float)
    for component in range(3):
        found = load(path, component=component).array[0]
        assert np.abs(found - colours[..., component]).max() <= (0 if photometric == "RGB" else 1)


def test_float_pixels(tmp_path):
    rng = np.random.default_rng(6)
    for name, tag, vr, bits in (("f", 0x7FE00008, "OF", 32), ("d", 0x7FE00009, "OD", 64)):
        values = rng.normal(size=(3, 4)).astype(f"<f{bits // 8}")
        ds = new_dataset("1.2.840.10008.5.1.4.1.1.30", modality="OT")
        set_pixels(ds, np.zeros((1, 3, 4), np.uint32))
        del ds.PixelData, ds.BitsStored, ds.HighBit, ds.PixelRepresentation
        ds.BitsAllocated = bits
        ds[tag] = pydicom.DataElement(tag, vr, values.tobytes())
        save(ds, tmp_path / name)
        volume = load(tmp_path / name)
        assert np.array_equal(volume.array[0], values.astype(np.float32))
        assert volume.stored_type == f"float{bits}"


def test_series_are_listed(tmp_path):
    for series in range(3):
        (tmp_path / f"S{series}").mkdir()
        for i in range(2 + series):
            ds = new_dataset(CT, f"1.2.3.{series}")
            ds.SeriesDescription = f"description {series}"
            set_pixels(ds, np.full((1, 2, 3), 10 * series + i, np.uint32))
            ds.ImageOrientationPatient, ds.PixelSpacing = [1, 0, 0, 0, 1, 0], ["0.5", "0.5"]
            ds.ImagePositionPatient = [0, 0, 2 * i]
            save(ds, tmp_path / f"S{series}" / f"{i}")
    with pytest.raises(Error, match=r"3 DICOM series.*--series:(.|\n)*1: 1\.2\.3\.1 \(3 files(.|\n)*S1\)"):
        load(tmp_path)
    assert np.array_equal(load(tmp_path, series=2).array[:, 0, 0], [20, 21, 22, 23])
    assert edgesplat.Volume(tmp_path, series="1.2.3.0").shape == (2, 2, 3)
