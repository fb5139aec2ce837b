"""TIFF stacks against tifffile: ImageJ, OME, tifffile's own description and plain pages; and files written here byte by
byte, whose right values follow from TIFF's definition."""

import random
import struct
import warnings

import numpy as np
import pytest

from edgesplat import Error, Volume

tifffile = pytest.importorskip("tifffile", reason="the reader to compare with: python3-tifffile")

#: Millimetres in the units of ImageJ and OME.
UNITS = {"um": 1e-3, "micron": 1e-3, "\\u00B5m": 1e-3, "nm": 1e-6, "mm": 1, "cm": 10, "inch": 25.4}
OME_UNITS = {"µm": 1e-3, "nm": 1e-6, "mm": 1, "cm": 10, "Å": 1e-7, "in": 25.4, "m": 1e3}


def numbers(rng, shape, dtype):
    """Random samples of all magnitudes that a float represents exactly."""
    dtype = np.dtype(dtype)
    if dtype.kind == "f":
        return rng.normal(0, 100, shape).astype(dtype)
    low, high = max(np.iinfo(dtype).min, -(2**24)), min(np.iinfo(dtype).max, 2**24)
    return rng.integers(low, high, shape, dtype=dtype, endpoint=True)


def check(volume, array, spacing, origin=(0, 0, 0), tolerance=1e-6):
    assert volume.shape == array.shape
    assert np.array_equal(volume.array, array.astype(np.float32))
    assert volume.spacing == pytest.approx(spacing, rel=tolerance)
    assert volume.origin == pytest.approx(origin, rel=tolerance, abs=1e-12)
    assert np.array_equal(volume.direction, np.eye(3))
    assert (volume.min, volume.max) == (np.float32(array.min()), np.float32(array.max()))


def choices(channels, frames, channel, frame):
    return {"component": channel if channels > 1 else None, "frame": frame if frames > 1 else None}


@pytest.mark.parametrize("seed", range(45))
def test_imagej(tmp_path, seed):
    rng, pick = np.random.default_rng(seed), random.Random(seed)
    frames, slices, channels = pick.choice([1, 1, 2]), pick.randint(1, 5), pick.choice([1, 1, 3])
    height, width = pick.randint(2, 9), pick.randint(2, 9)
    array = numbers(rng, (frames, slices, channels, height, width), pick.choice(["u1", "u2", "f4"]))
    unit = pick.choice([*UNITS, "pixel", None])
    step = [round(pick.uniform(0.1, 5), 3) for _ in range(3)]
    metadata = {"axes": "TZCYX", "spacing": step[2]}
    if unit:
        metadata["unit"] = unit
    path = tmp_path / "a.tif"
    tifffile.imwrite(path, array, imagej=True, byteorder=pick.choice("<>"), metadata=metadata,
                     resolution=(1 / step[0], 1 / step[1]), compression=pick.choice([None, "zlib"]))
    for frame in range(frames):
        for channel in range(channels):
            volume = Volume(path, **choices(channels, frames, channel, frame))
            with tifffile.TiffFile(path) as file:
                assert file.is_imagej
                theirs = file.asarray().reshape(array.shape)[frame, :, channel]
                resolution = [file.pages[0].tags[name].value for name in ("XResolution", "YResolution")]
            lengths = [below / above for above, below in resolution] + [step[2]]
            check(volume, theirs, [length * UNITS.get(unit, 1) for length in lengths])
    for name, count in (("component", channels), ("frame", frames)):
        if count > 1:
            with pytest.raises(Error, match=rf"with {count} {name}s; choose one with --{name} 0..{count - 1}"):
                Volume(path, **choices(channels, frames, 0, 0) | {name: None})


@pytest.mark.parametrize("seed", range(45))
def test_plain(tmp_path, seed):
    rng, pick = np.random.default_rng(seed), random.Random(seed)
    pages, height, width, samples = pick.randint(1, 5), pick.randint(1, 40), pick.randint(1, 40), pick.choice([1, 1, 3, 4])
    dtype = pick.choice(["u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "f2", "f4", "f8"])
    planar = pick.choice(["contig", "separate"])
    array = numbers(rng, (pages, height, width, samples), dtype)
    stored = array if planar == "contig" else array.transpose(0, 3, 1, 2)
    tile = pick.choice([None, None, (16, 16), (32, 16)])
    unit, per_unit = pick.choice([("NONE", 3.0), ("INCH", 72.0), ("INCH", 1234.5), ("CENTIMETER", 12345.0), ("CENTIMETER", 118.11)])
    white = samples == 1 and np.dtype(dtype).kind == "u" and pick.random() < 0.4
    path = tmp_path / "a.tif"
    compression = pick.choice([None, None, "zlib"])
    predictor = bool(compression) and np.dtype(dtype).kind != "f" and np.dtype(dtype).itemsize < 8 and pick.random() < 0.5
    with tifffile.TiffWriter(path, bigtiff=pick.random() < 0.3, byteorder=pick.choice("<>")) as writer:
        for page in stored:
            writer.write(page[..., 0] if samples == 1 and planar == "contig" else page[0] if samples == 1 else page,
                         photometric="miniswhite" if white else "rgb" if samples > 2 else "minisblack",
                         planarconfig=planar if samples > 1 else None, tile=tile, compression=compression,
                         predictor=predictor, metadata=None, contiguous=False,
                         rowsperstrip=pick.choice([None, 1, 7]) if tile is None else None,
                         resolution=(per_unit, per_unit), resolutionunit=unit)
    theirs = np.stack([page.asarray() for page in tifffile.TiffFile(path).pages]).reshape(stored.shape)
    assert np.array_equal(theirs, stored)
    if white:  # difference to tifffile, which shows what is stored: MinIsWhite is undone here
        array = ~array
    length = {("INCH", 1234.5): 25.4 / 1234.5, ("CENTIMETER", 12345.0): 10 / 12345}.get((unit, per_unit), 1)
    for sample in range(samples):
        volume = Volume(path, component=sample if samples > 1 else None)
        if np.dtype(dtype).itemsize >= 4 and np.abs(array[..., sample].astype(float)).max() > 2**24:
            # Few distinct integers: they are labels, numbered by rank.
            ranks = np.unique(array[..., sample], return_inverse=True)[1].reshape(array.shape[:3])
            assert np.array_equal(volume.array, ranks)
            continue
        check(volume, array[..., sample], [length, length, length], tolerance=1e-5)
    if length == 1:
        assert any("1 x 1 x 1 mm is assumed" in note for note in volume.notes)


@pytest.mark.parametrize("seed", range(40))
def test_ome(tmp_path, seed):
    rng, pick = np.random.default_rng(seed), random.Random(seed)
    sizes = {"T": pick.choice([1, 1, 2]), "C": pick.choice([1, 1, 2]), "Z": pick.randint(1, 5)}
    order = pick.sample("TCZ", 3)
    height, width = pick.randint(2, 20), pick.randint(2, 20)
    array = numbers(rng, [sizes[axis] for axis in order] + [height, width], pick.choice(["u1", "u2", "i2", "i4", "f4", "f8"]))
    lengths = [round(pick.uniform(0.01, 10), 4) for _ in range(3)]
    units = [pick.choice([*OME_UNITS, None]) for _ in range(3)]
    metadata = {"axes": "".join(order) + "YX"}
    for axis, length, unit in zip("XYZ", lengths, units):
        metadata[f"PhysicalSize{axis}"] = length
        if unit:
            metadata[f"PhysicalSize{axis}Unit"] = unit
    if sizes["C"] > 1:
        metadata["Channel"] = {"Name": ["DAPI", "GFP"]}
    path = tmp_path / "a.ome.tif"
    tifffile.imwrite(path, array, ome=True, photometric="minisblack", metadata=metadata, bigtiff=pick.random() < 0.3,
                     byteorder=pick.choice("<>"), compression=pick.choice([None, "zlib"]))
    by_axis = tifffile.imread(path).reshape(array.shape).transpose([order.index(axis) for axis in "TCZ"] + [3, 4])
    for frame in range(sizes["T"]):
        for channel in range(sizes["C"]):
            volume = Volume(path, **choices(sizes["C"], sizes["T"], channel, frame))
            check(volume, by_axis[frame, channel], [l * OME_UNITS[u or "µm"] for l, u in zip(lengths, units)])
    if sizes["C"] > 1:
        with pytest.raises(Error, match=r"choose one with --component 0..1 \(0: DAPI, 1: GFP\)"):
            Volume(path, frame=0)


@pytest.mark.parametrize("samples", [3, 4])
@pytest.mark.parametrize("planar", ["contig", "separate"])
def test_ome_with_colours(tmp_path, samples, planar):
    array = numbers(np.random.default_rng(1), (4, 6, 5, samples), "u1")
    stored, axes = (array, "ZYXS") if planar == "contig" else (array.transpose(0, 3, 1, 2), "ZSYX")
    path = tmp_path / "a.ome.tif"
    tifffile.imwrite(path, stored, ome=True, photometric="rgb", planarconfig=planar, metadata={"axes": axes})
    for sample in range(samples):
        volume = Volume(path, component=sample)
        check(volume, array[..., sample], [1, 1, 1])


def test_ome_pyramid_and_series(tmp_path):
    rng = np.random.default_rng(2)
    first, second = numbers(rng, (3, 8, 6), "u2"), numbers(rng, (4, 4, 4), "u1")
    path = tmp_path / "a.ome.tif"
    with tifffile.TiffWriter(path, ome=True) as writer:
        writer.write(first, subifds=1, photometric="minisblack",
                     metadata={"axes": "ZYX", "Name": "head", "PhysicalSizeX": 2, "PhysicalSizeY": 3, "PhysicalSizeZ": 4})
        writer.write(first[:, ::2, ::2], subfiletype=1, photometric="minisblack")
        writer.write(second, photometric="minisblack", metadata={"axes": "ZYX", "Name": "tail"})
    with pytest.raises(Error, match=r"2 images; choose one with --series 0..1 \(0: head 6 x 8 x 3, 1: tail 4 x 4 x 4\)"):
        Volume(path)
    check(Volume(path, series=0), first, [2e-3, 3e-3, 4e-3])
    check(Volume(path, series="tail"), second, [1, 1, 1])
    with pytest.raises(Error, match="--series 2: expected 0..1"):
        Volume(path, series=2)


OME = """<?xml version="1.0" encoding="UTF-8"?><{p}OME xmlns{q}="http://www.openmicroscopy.org/Schemas/OME/2016-06"
UUID="urn:uuid:{uuid}"><{p}Image ID="Image:0"><{p}Pixels ID="Pixels:0" DimensionOrder="{order}" Type="uint16" SizeX="5"
SizeY="4" SizeZ="{z}" SizeC="{c}" SizeT="1" PhysicalSizeX="2" PhysicalSizeY="2" PhysicalSizeZ="{pz}">{data}</{p}Pixels>
</{p}Image></{p}OME>"""


def ome(data, order="XYZCT", z=3, c=1, pz=5, uuid="a", prefix=""):
    return OME.format(data=data, order=order, z=z, c=c, pz=pz, uuid=uuid, p=prefix,
                      q=":" + prefix[:-1] if prefix else "").encode()


def write_pages(path, array, description=None, **options):
    with tifffile.TiffWriter(path, **options) as writer:
        for i, page in enumerate(array):
            writer.write(page, photometric="minisblack", metadata=None, contiguous=False,
                         description=description if i == 0 else None)
    return path


STACK = numbers(np.random.default_rng(3), (3, 4, 5), "u2")


@pytest.mark.parametrize(
    "data, order",
    [
        ("<TiffData/>", (0, 1, 2)),
        ('<TiffData IFD="0" PlaneCount="3"/>', (0, 1, 2)),
        ('<TiffData IFD="2" FirstZ="0"/><TiffData IFD="0" FirstZ="1"/><TiffData IFD="1" FirstZ="2"/>', (2, 0, 1)),
        ('<TiffData IFD="1" FirstZ="0" PlaneCount="2"/><TiffData IFD="0" FirstZ="2"/>', (1, 2, 0)),
        ("", (0, 1, 2)),
    ],
)
@pytest.mark.parametrize("prefix", ["", "ome:"])
def test_ome_order_of_planes(tmp_path, data, order, prefix):
    data = data.replace("<TiffData", f"<{prefix}TiffData")
    path = write_pages(tmp_path / "a.ome.tif", STACK, ome(data, prefix=prefix))
    check(Volume(path), STACK[list(order)], [2e-3, 2e-3, 5e-3])


def test_ome_in_several_files(tmp_path):
    data = "".join(f'<TiffData IFD="0" FirstZ="{z}"><UUID FileName="{name}">urn:uuid:{name[0]}</UUID></TiffData>'
                   for z, name in enumerate(("a.tif", "b.tif", "c.tif")))
    for name, page in zip("abc", STACK):
        write_pages(tmp_path / f"{name}.tif", page[None], ome(data, uuid=name))
    for name in "abc":
        check(Volume(tmp_path / f"{name}.tif"), STACK, [2e-3, 2e-3, 5e-3])
    (tmp_path / "b.tif").unlink()
    with pytest.raises(Error, match="in the file b.tif, which is not in the same folder"):
        Volume(tmp_path / "a.tif")


def test_ome_companion(tmp_path):
    (tmp_path / "a.companion.ome").write_bytes(
        ome('<TiffData PlaneCount="3"><UUID FileName="a.tif">urn:uuid:x</UUID></TiffData>', uuid="companion"))
    xml = (b'<OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06" UUID="urn:uuid:x">'
           b'<BinaryOnly MetadataFile="a.companion.ome" UUID="urn:uuid:companion"/></OME>')
    check(Volume(write_pages(tmp_path / "a.tif", STACK, xml)), STACK, [2e-3, 2e-3, 5e-3])
    (tmp_path / "a.companion.ome").unlink()
    with pytest.raises(Error, match="a.companion.ome, which is not in the same folder"):
        Volume(tmp_path / "a.tif")


def test_ome_pixels_beside_lengths(tmp_path):
    """Axes in pixels cannot be drawn beside axes in a unit of length."""
    path = tmp_path / "a.ome.tif"

    def write(**units):
        sizes = {f"PhysicalSize{axis}": size for axis, size in zip("XYZ", (2, 3, 4))}
        tifffile.imwrite(path, STACK, ome=True, photometric="minisblack",
                         metadata={"axes": "ZYX", **sizes, **{f"PhysicalSize{axis}Unit": unit for axis, unit in units.items()}})

    for axis, unit in (("Z", "reference frame"), ("Z", "pixel"), ("Y", "pixel")):
        write(**{axis: unit})
        with pytest.raises(Error, match=f"PhysicalSize{axis}Unit='{unit}', but PhysicalSize.Unit='µm'.*--spacing X Y Z"):
            Volume(path)
        check(Volume(path, spacing=(1, 2, 3)), STACK, (1, 2, 3))
    write(X="pixel", Y="pixel", Z="pixel")
    check(Volume(path), STACK, (2, 3, 4))


def test_ome_pages_beyond_its_planes(tmp_path):
    path = write_pages(tmp_path / "a.tif", np.concatenate([STACK, STACK[:1]]), ome("<TiffData/>"))
    with pytest.warns(UserWarning, match="OME-XML describes 3 planes, but the file has 4 pages"):
        assert Volume(path).shape == STACK.shape


def test_ome_with_missing_planes(tmp_path):
    path = write_pages(tmp_path / "a.tif", STACK[:2], ome('<TiffData IFD="0" FirstZ="0"/><TiffData IFD="1" FirstZ="2"/>'))
    with pytest.warns(UserWarning, match="20 samples contain no data"):
        volume = Volume(path)
    assert np.array_equal(volume.array[[0, 2]], STACK[:2].astype(np.float32))
    assert np.all(volume.array[1] == STACK[:2].min())


@pytest.mark.parametrize(
    "data, changes, message",
    [
        ('<TiffData IFD="7"/>', {}, "IFD='7', but .* has 3 pages"),
        ('<TiffData IFD="1" PlaneCount="9"/>', {}, "IFD='1' with 9 planes, but .* has 3 pages"),
        ('<TiffData IFD="0" FirstZ="3"/>', {}, "FirstZ='3' .* lies outside"),
        ('<TiffData IFD="x"/>', {}, "IFD='x': expected a whole number"),
        ('<TiffData IFD="0"/><TiffData IFD="1"/>', {}, "two TiffData hold the same plane"),
        ("<TiffData/>", {"order": "XZYCT"}, "DimensionOrder='XZYCT'"),
        ("<TiffData/>", {"pz": 0}, "PhysicalSizeZ: 0: expected a length above 0"),
        ("<TiffData/>", {"pz": "nan"}, "PhysicalSizeZ: nan: expected a length above 0"),
        ("<TiffData/>", {"pz": "five"}, "PhysicalSizeZ=five: expected a number"),
        ("<TiffData/>", {"z": 0}, "SizeZ='0': expected a whole number of at least 1"),
        ("<TiffData>", {}, "OME-XML is broken"),
    ],
)
def test_ome_refusals(tmp_path, data, changes, message):
    path = write_pages(tmp_path / "a.tif", STACK, ome(data, **changes))
    with pytest.raises(Error, match=message):
        Volume(path)


@pytest.mark.parametrize(
    "shape, axes, choice",
    [
        ((3, 4, 5), None, {}),
        ((3, 4, 5), "ZYX", {}),
        ((2, 3, 4, 5), None, {"frame": 1}),
        ((2, 3, 4, 5), "TZYX", {"frame": 1}),
        ((3, 2, 4, 5), "ZCYX", {"component": 1}),
        ((2, 3, 4, 5), "CZYX", {"component": 0}),
        ((2, 3, 2, 4, 5), "TZCYX", {"component": 1, "frame": 0}),
    ],
)
def test_tifffile_description(tmp_path, shape, axes, choice):
    array = numbers(np.random.default_rng(4), shape, "u2")
    path = tmp_path / "a.tif"
    tifffile.imwrite(path, array, photometric="minisblack", metadata={"axes": axes} if axes else {})
    named = axes or "TTTZYX"[6 - len(shape):]
    index = tuple(choice["frame"] if axis == "T" else choice["component"] if axis == "C" else slice(None) for axis in named)
    check(Volume(path, **choice), array[index], [1, 1, 1])
    tifffile.imwrite(path, array, photometric="minisblack", truncate=True, metadata={"axes": axes} if axes else {})
    assert len(tifffile.TiffFile(path).pages) == 1
    check(Volume(path, **choice), array[index], [1, 1, 1])


@pytest.mark.parametrize("byteorder", "<>")
@pytest.mark.parametrize("dtype", ["u1", "u2", "f4"])
def test_imagej_after_one_directory(tmp_path, byteorder, dtype):
    """ImageJ's form of stacks above 4 GB: one directory, the slices follow each other."""
    array = numbers(np.random.default_rng(5), (6, 4, 5), dtype)
    path = tmp_path / "a.tif"
    text = b"ImageJ=1.53t\nimages=6\nslices=6\nunit=micron\nspacing=2.5\nloop=false\n"
    path.write_bytes(own_tiff(array[0].astype(byteorder + dtype).tobytes(), 5, 4, np.dtype(dtype).itemsize * 8,
                              byteorder=byteorder, text=text, kind=3 if dtype == "f4" else 1,
                              resolution=(2, 1), after=array[1:].astype(byteorder + dtype).tobytes()))
    check(Volume(path), array, [0.5e-3, 0.5e-3, 2.5e-3])
    whole = path.read_bytes()
    path.write_bytes(whole[:-1])
    with pytest.raises(Error, match="truncated: its header promises 6 images"):
        Volume(path)


def own_tiff(pixels, width, height, bits, *, byteorder="<", text=b"", kind=1, photometric=1, samples=1, resolution=None,
             unit=1, after=b"", extra=(), fill_order=1, compression=1):
    """A TIFF of one strip. extra: (tag, type, values) with values as bytes or a list of whole numbers."""
    entries = {256: (4, [width]), 257: (4, [height]), 258: (3, [bits] * samples), 259: (3, [compression]),
               262: (3, [photometric]), 266: (3, [fill_order]), 273: (4, [0]), 277: (3, [samples]), 278: (4, [height]),
               279: (4, [len(pixels)]), 339: (3, [kind] * samples), 296: (3, [unit])}
    if text:
        entries[270] = (2, text + b"\0")
    if resolution:
        entries[282] = entries[283] = (5, resolution)
    for tag, type_, values in extra:
        entries[tag] = (type_, values)
    start = 8 + 2 + 12 * len(entries) + 4
    aside = b""
    directory = struct.pack(byteorder + "H", len(entries))
    bodies = {}
    for tag, (type_, values) in entries.items():
        code = {1: "B", 3: "H", 4: "I", 5: "I", 12: "d"}.get(type_)
        bodies[tag] = values if isinstance(values, bytes) else struct.pack(f"{byteorder}{len(values)}{code}", *values)
    long_ones = [body for tag, body in bodies.items() if len(body) > 4]
    pixels_at = start + sum(len(body) + len(body) % 2 for body in long_ones)
    bodies[273] = struct.pack(byteorder + "I", pixels_at)
    for tag in sorted(entries):
        type_, body = entries[tag][0], bodies[tag]
        count = len(body) // {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 7: 1, 12: 8}[type_]
        directory += struct.pack(byteorder + "HHI", tag, type_, count)
        if len(body) <= 4:
            directory += body.ljust(4, b"\0")
        else:
            directory += struct.pack(byteorder + "I", start + len(aside))
            aside += body + b"\0" * (len(body) % 2)
    head = b"II*\0" if byteorder == "<" else b"MM\0*"
    return head + struct.pack(byteorder + "I", 8) + directory + b"\0\0\0\0" + aside + pixels + after


def packed(values, bits):
    """Rows of unsigned numbers, most significant bit first, each row padded to a byte."""
    rows = []
    for row in values:
        text = "".join(format(int(value), f"0{bits}b") for value in row)
        text += "0" * (-len(text) % 8)
        rows.append(bytes(int(text[i:i + 8], 2) for i in range(0, len(text), 8)))
    return b"".join(rows)


@pytest.mark.parametrize("byteorder", "<>")
@pytest.mark.parametrize("bits", [1, 2, 3, 4, 6, 7, 10, 12, 14, 20, 31])
@pytest.mark.parametrize("photometric", [0, 1, 3])
def test_bits(tmp_path, bits, byteorder, photometric):
    values = np.random.default_rng(bits).integers(0, 2 ** min(bits, 24), (5, 7))
    path = tmp_path / "a.tif"
    palette = [(320, 3, list(range(3 * 2**bits)))] if photometric == 3 and bits <= 8 else []
    path.write_bytes(own_tiff(packed(values, bits), 7, 5, bits, byteorder=byteorder, photometric=photometric, extra=palette))
    shown = 2**bits - 1 - values if photometric == 0 else values
    volume = Volume(path)
    if shown.max() <= 2**24:
        check(volume, shown[None], [1, 1, 1])
    assert (photometric == 3) == any("palette" in note for note in volume.notes)


@pytest.mark.parametrize("byteorder", "<>")
def test_24_bits(tmp_path, byteorder):
    values = np.random.default_rng(9).integers(0, 2**24, (5, 7))
    order = {"<": "little", ">": "big"}[byteorder]
    path = tmp_path / "a.tif"
    path.write_bytes(own_tiff(b"".join(int(v).to_bytes(3, order) for v in values.flat), 7, 5, 24, byteorder=byteorder))
    check(Volume(path), values[None], [1, 1, 1])


def test_signed_bits_and_fill_order(tmp_path):
    values = np.random.default_rng(10).integers(-2048, 2048, (4, 6))
    path = tmp_path / "a.tif"
    path.write_bytes(own_tiff(packed(values & 4095, 12), 6, 4, 12, kind=2))
    check(Volume(path), values[None], [1, 1, 1])
    mirrored = bytes(int(f"{byte:08b}"[::-1], 2) for byte in packed(values & 4095, 12))
    path.write_bytes(own_tiff(mirrored, 6, 4, 12, kind=2, fill_order=2))
    check(Volume(path), values[None], [1, 1, 1])


IMAGEJ_PLACES = [
    # text, resolution, unit, spacing in mm of a stack of 2
    (b"unit=um\nspacing=3\n", (1, 2), 1, (2e-3, 2e-3, 3e-3)),
    (b"unit=um\nspacing=-3\n", (1, 2), 1, (2e-3, 2e-3, 3e-3)),
    (b"unit=um\n", (1, 2), 1, (2e-3, 2e-3, 1e-3)),  # ImageJ leaves a spacing of 1 out
    (b"unit=um\nspacing=3\n", None, 1, (1e-3, 1e-3, 3e-3)),
    (b"unit=cm\nspacing=3\n", (10, 1), 3, (1, 1, 30)),
    (b"unit=inch\nspacing=3\n", (10, 1), 2, (2.54, 2.54, 76.2)),
    (b"unit=mm\nspacing=3\n", (10, 1), 2, (0.1, 0.1, 3)),  # the description's unit overrides the field's
    (b"spacing=3\n", (10, 1), 2, (2.54, 2.54, 76.2)),
    (b"spacing=3\n", (10, 1), 3, (1, 1, 30)),
    (b"spacing=3\n", (72, 1), 2, (1, 1, 3)),  # as ImageJ reads it
    (b"unit=\xb5m\nspacing=3\n", (1, 2), 1, (2e-3, 2e-3, 3e-3)),
    (b"unit=um\nzunit=mm\nspacing=3\n", (1, 2), 1, (2e-3, 2e-3, 3)),
    (b"unit=pixel\nspacing=3\n", None, 1, (1, 1, 3)),
    (b"", None, 1, (1, 1, 1)),
]


@pytest.mark.parametrize("text, resolution, unit, spacing", IMAGEJ_PLACES)
def test_imagej_units(tmp_path, text, resolution, unit, spacing):
    values = np.arange(12, dtype="<u2").reshape(2, 2, 3)
    path = tmp_path / "a.tif"
    path.write_bytes(own_tiff(values[0].tobytes(), 3, 2, 16, text=b"ImageJ=1.53t\nimages=2\nslices=2\n" + text,
                              resolution=resolution, unit=unit, after=values[1].tobytes()))
    check(Volume(path), values, spacing)


def test_imagej_origin(tmp_path):
    values = np.arange(12, dtype="<u2").reshape(2, 2, 3)
    path = tmp_path / "a.tif"
    text = b"ImageJ=1.53t\nimages=2\nslices=2\nunit=mm\nspacing=3\nxorigin=2\nyorigin=-1\nzorigin=0.5\n"
    path.write_bytes(own_tiff(values[0].tobytes(), 3, 2, 16, text=text, resolution=(1, 2), after=values[1].tobytes()))
    check(Volume(path), values, (2, 2, 3), (-4, 2, -1.5))


CALIBRATIONS = [
    # coefficients, kind of samples, values of the stored 0, 1, 1000
    (b"cf=0\nc0=-32768\nc1=1\nvunit=gray value\n", 1, (-32768, -32767, -31768)),
    (b"cf=0\nc0=10\nc1=0.5\n", 1, (10, 10.5, 510)),
    (b"cf=0\nc0=-32768\nc1=1\n", 2, (0, 1, 1000)),  # ImageJ holds signed samples with an offset of 32768
    (b"cf=1\nc0=1\nc1=2\nc2=0.25\n", 1, (1, 3.25, 252001)),
    (b"cf=4\nc0=1\nc1=2\n", 1, (0, 1, 1000)),  # not a polynomial: a warning
    (b"cf=21\nvunit=Uncalibrated OD\n", 1, (0, 1, 1000)),  # a function without coefficients: a warning
    (b"cf=20\n", 1, (0, 1, 1000)),  # none
]


@pytest.mark.parametrize("text, kind, right", CALIBRATIONS)
def test_imagej_calibration(tmp_path, text, kind, right):
    path = tmp_path / "a.tif"
    pixels = np.array([[0, 1, 1000]], "<u2").tobytes()
    path.write_bytes(own_tiff(pixels, 3, 1, 16, text=b"ImageJ=1.53t\nimages=1\n" + text, kind=kind))
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        assert list(Volume(path).array.flat) == list(right)
    is_applicable = not text.startswith((b"cf=4\n", b"cf=21\n"))
    assert any("is not a polynomial and not applied" in str(one.message) for one in given) != is_applicable


@pytest.mark.parametrize(
    "text, message",
    [
        (b"images=3\nslices=2\n", "images=3, but channels=1, slices=2, frames=1"),
        (b"images=2\nslices=2\nspacing=nan\n", "spacing: nan: expected a length above 0"),
        (b"images=2\nslices=2\nspacing=inf\n", "spacing: inf: expected a length above 0"),
        (b"images=2\nslices=2\nspacing=2,8\n", "spacing=2,8: expected a number"),
        (b"images=2\nslices=2\nunit=furlong\n", "unit=furlong: expected a unit of length"),
        (b"images=2\nslices=2\nunit=um\nzunit=pixel\nspacing=2\n", "zunit=pixel, but unit=um: expected units of length"),
        (b"images=2\nslices=2\nunit=pixel\nzunit=um\nspacing=2\n", "zunit=um, but unit=pixel: expected units of length"),
        (b"images=0\n", "images=0: expected a whole number of at least 1"),
        (b"images=9\nslices=9\n", "truncated: its header promises 9 images"),
        (b"images=99999999\n", "99999999"),
    ],
)
def test_imagej_refusals(tmp_path, text, message):
    path = tmp_path / "a.tif"
    path.write_bytes(own_tiff(bytes(12), 3, 2, 16, text=b"ImageJ=1.53t\n" + text, after=bytes(12)))
    with pytest.raises(Error, match=message):
        Volume(path)


def test_no_data(tmp_path):
    path = tmp_path / "a.tif"
    values = np.array([[1, -9999, 5]], "<i2")
    path.write_bytes(own_tiff(values.tobytes(), 3, 1, 16, kind=2, extra=[(42113, 2, b"-9999\0")]))
    with pytest.warns(UserWarning, match="1 samples contain no data"):
        volume = Volume(path)
    assert (volume.min, volume.max) == (1, 5)


def test_gdal_scale(tmp_path):
    path = tmp_path / "a.tif"
    xml = (b'<GDALMetadata><Item name="OFFSET" sample="0" role="offset">-10</Item>'
           b'<Item name="SCALE" sample="0" role="scale">0.5</Item></GDALMetadata>\0')
    path.write_bytes(own_tiff(np.array([[0, 1, 30]], "<u2").tobytes(), 3, 1, 16, extra=[(42112, 2, xml)]))
    assert list(Volume(path).array.flat) == [-10, -9.5, 5]


def lsm_info(slices, frames, sizes, kind=0):
    info = struct.pack("<Ii5i3i", 0x0400494C, 512, 3, 2, slices, 1, frames, 1, 0, 0)
    info += struct.pack("<6d", *sizes, 0, 0, 0) + struct.pack("<H", kind)
    return info.ljust(512, b"\0")


def test_lsm(tmp_path):
    """Zeiss LSM: voxel sizes in m; thumbnails between the slices."""
    values = np.arange(12, dtype=np.uint8).reshape(2, 2, 3)
    path = tmp_path / "a.lsm"
    with tifffile.TiffWriter(path, byteorder="<") as writer:
        for i, page in enumerate(values):
            writer.write(page, photometric="minisblack", metadata=None, contiguous=False,
                         extratags=[(34412, 1, 512, lsm_info(2, 1, (2e-7, 3e-7, 5e-7)), True)] if i == 0 else [])
            writer.write(page[:1, :1], photometric="minisblack", metadata=None, contiguous=False, subfiletype=1)
    check(Volume(path), values, (2e-4, 3e-4, 5e-4))


def test_pages_that_differ(tmp_path):
    path = tmp_path / "a.tif"
    with tifffile.TiffWriter(path) as writer:
        for shape in ((4, 5), (4, 5), (2, 2)):
            writer.write(np.ones(shape, "u1"), photometric="minisblack", metadata=None, contiguous=False)
    with pytest.raises(Error, match=r"its pages differ, page 2 from page 0; choose one kind with --series 0..1"):
        Volume(path)
    assert Volume(path, series=0).shape == (2, 4, 5)
    assert Volume(path, series=1).shape == (1, 2, 2)


#: World axes of columns and rows: x to the right, y down.
ORIENTATIONS = {1: ("+x", "+y"), 2: ("-x", "+y"), 3: ("-x", "-y"), 4: ("+x", "-y"),
                5: ("+y", "+x"), 6: ("+y", "-x"), 7: ("-y", "-x"), 8: ("-y", "+x")}


@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_orientation(tmp_path, orientation):
    path = tmp_path / "a.tif"
    with tifffile.TiffWriter(path) as writer:
        for page in STACK:
            writer.write(page, photometric="minisblack", metadata=None, contiguous=False, resolution=(5000, 2500),
                         resolutionunit="CENTIMETER", extratags=[(274, "H", 1, orientation, True)])
    volume = Volume(path)
    assert np.array_equal(volume.array, STACK.astype(np.float32))
    assert volume.spacing == pytest.approx((2e-3, 4e-3, 2e-3))
    directions = [(1 if name[0] == "+" else -1) * np.eye(3)["xyz".index(name[1])] for name in ORIENTATIONS[orientation]]
    assert np.allclose(volume.direction, np.transpose([*directions, [0, 0, 1]]))
    # The first voxel is in the corner that the field names.
    corner = [np.minimum(d, 0) * step * (n - 1) for d, step, n in zip(directions, (2e-3, 4e-3), STACK.shape[:0:-1])]
    assert volume.origin == pytest.approx(tuple(-sum(corner)), abs=1e-9)


def test_orientations_and_resolutions_that_differ(tmp_path):
    path = tmp_path / "a.tif"
    for field, options, message in (
        ("Orientation", [{"extratags": [(274, "H", 1, o, True)]} for o in (1, 1, 3)], r"Orientation \(274\) 3"),
        ("XResolution", [{"resolution": (r, r), "resolutionunit": "CENTIMETER"} for r in (50, 50, 20)],
         r"XResolution 20 and YResolution 20 \(ResolutionUnit 3\), the slices before it 50 and 50.*--spacing"),
    ):
        with tifffile.TiffWriter(path) as writer:
            for page, own in zip(STACK, options):
                writer.write(page, photometric="minisblack", metadata=None, contiguous=False, **own)
        with pytest.raises(Error, match=f"page 2 .*{message}"):
            Volume(path)
    check(Volume(path, spacing=(1, 2, 3)), STACK, (1, 2, 3))


def test_reduced_pages_are_left_out(tmp_path):
    path = tmp_path / "a.tif"
    with tifffile.TiffWriter(path) as writer:
        for page in STACK:
            writer.write(page, photometric="minisblack", metadata=None, contiguous=False)
            writer.write(page[::2, ::2], photometric="minisblack", metadata=None, contiguous=False, subfiletype=1)
    volume = Volume(path)
    check(volume, STACK, (1, 1, 1))
    assert any("3 of its 6 pages are reduced copies" in note for note in volume.notes)


def test_sequence(tmp_path):
    for i, page in enumerate(STACK):
        tifffile.imwrite(tmp_path / f"s{i}.tif", page, photometric="minisblack", metadata=None,
                         resolution=(5000, 2500), resolutionunit="CENTIMETER")
    check(Volume(tmp_path / "s%d.tif"), STACK, (2e-3, 4e-3, 2e-3))
    check(Volume(tmp_path, spacing=(1, 2, 3)), STACK, (1, 2, 3))


def test_imagej_sequence(tmp_path):
    for i, page in enumerate(STACK):
        tifffile.imwrite(tmp_path / f"s{i}.tif", page, imagej=True, resolution=(0.5, 0.5),
                         metadata={"unit": "um", "spacing": 3.0})
    check(Volume(tmp_path), STACK, (2e-3, 2e-3, 3e-3))


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"bits": 40}, "samples of 40 bits"),
        ({"kind": 5}, "SampleFormat 5"),
        ({"compression": 33003}, "compression, number 33003"),
        ({"extra": [(32997, 4, [3])]}, "tiled 3-D image of depth 3"),
        ({"extra": [(256, 4, [0])]}, "0 x 2 pixels"),
        ({"extra": [(256, 4, [2**31])]}, "an axis may have at most 65535 voxels"),
        ({"extra": [(257, 4, [60000])]}, "truncated"),
        ({"extra": [(278, 4, [0])]}, "blocks of 3 x 0 pixels"),
        ({"extra": [(284, 3, [7])]}, "PlanarConfiguration 7"),
        ({"extra": [(258, 3, [8, 16])]}, "differ in BitsPerSample"),
        ({"extra": [(33629, 5, [1, 1, 2, 2])]}, "MetaMorph"),
        ({"photometric": 32845}, "logarithmic"),
        ({"extra": [(42113, 2, b"none\0")]}, "GDAL_NODATA=none: expected a number"),
    ],
)
def test_refusals(tmp_path, changes, message):
    path = tmp_path / "a.tif"
    path.write_bytes(own_tiff(bytes(12), 3, 2, **{"bits": 16} | changes))
    with pytest.raises(Error, match=message):
        Volume(path)


def test_truncated(tmp_path):
    path = write_pages(tmp_path / "a.tif", STACK)
    whole = path.read_bytes()
    for size in range(8, len(whole) - 1, 7):
        path.write_bytes(whole[:size])
        with pytest.raises(Error, match="a.tif"):
            Volume(path)


def test_endless_chain(tmp_path):
    whole = bytearray(own_tiff(bytes(12), 3, 2, 16))
    count = struct.unpack_from("<H", whole, 8)[0]
    struct.pack_into("<I", whole, 10 + 12 * count, 8)
    path = tmp_path / "a.tif"
    path.write_bytes(whole)
    with pytest.raises(Error, match="the chain of pages has no end"):
        Volume(path)
