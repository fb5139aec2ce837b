"""Zarr v2 against zarr-python, OME-Zarr 0.1 to 0.5, and Zarr v3 written here from its specification."""

import itertools
import json
import random
import struct
import zipfile

import numpy as np
import pytest

from edgesplat import Error, Volume

zarr = pytest.importorskip("zarr", reason="the reader to compare with: python3-zarr")
numcodecs = pytest.importorskip("numcodecs", reason="compressors: python3-numcodecs")

UNITS = {"micrometer": 1e-3, "nanometer": 1e-6, "millimeter": 1, "centimeter": 10, "meter": 1e3, "angstrom": 1e-7,
         "picometer": 1e-9, "inch": 25.4, "yard": 914.4, "decimeter": 100}


def check(volume, array, spacing=(1, 1, 1), origin=(0, 0, 0)):
    assert volume.shape == array.shape
    assert np.array_equal(volume.array, array.astype(np.float32))
    assert volume.spacing == pytest.approx(spacing, rel=1e-9)
    assert volume.origin == pytest.approx(origin, rel=1e-9, abs=1e-15)


def numbers(rng, shape, dtype):
    dtype = np.dtype(dtype)
    if dtype.kind == "f":
        return rng.normal(0, 100, shape).astype(dtype)
    if dtype.kind == "b":
        return rng.random(shape) < 0.5
    low, high = max(np.iinfo(dtype).min, -(2**24)), min(np.iinfo(dtype).max, 2**24)
    return rng.integers(low, high, shape, endpoint=True).astype(dtype)


COMPRESSORS = [None, numcodecs.Blosc("lz4"), numcodecs.Blosc("zstd", shuffle=2), numcodecs.Blosc("zlib", shuffle=0),
               numcodecs.Blosc("blosclz"), numcodecs.Blosc("lz4hc"), numcodecs.Zstd(), numcodecs.Zlib(), numcodecs.GZip(),
               numcodecs.LZ4(), numcodecs.BZ2()]
DTYPES = ["<u2", ">u2", "|u1", "|i1", "<i2", ">i4", "<u4", "<f4", ">f4", "<f8", ">f8", "<f2", "|b1", "<i8", ">u8"]


@pytest.mark.parametrize("seed", range(60))
def test_v2_arrays(tmp_path, seed):
    rng, pick = np.random.default_rng(seed), random.Random(seed)
    shape = [pick.randint(1, 9) for _ in range(3)]
    array = numbers(rng, shape, pick.choice(DTYPES))
    path = tmp_path / "a.zarr"
    with_dots = pick.choice("./")
    stored = zarr.open_array(str(path), mode="w", shape=shape, dtype=array.dtype, order=pick.choice("CF"),
                             chunks=[pick.randint(1, size + 2) for size in shape], fill_value=pick.choice([0, 1]),
                             compressor=COMPRESSORS[seed % len(COMPRESSORS)], dimension_separator=with_dots)
    if pick.random() < 0.3:  # some chunks are missing
        array[:, :, : shape[2] // 2] = stored.fill_value
        low = -(-(shape[2] // 2) // stored.chunks[2]) * stored.chunks[2]
        array[:, :, :low] = stored.fill_value
        stored[:, :, low:] = array[:, :, low:]
    else:
        stored[...] = array
    theirs = zarr.open_array(str(path), mode="r")[...]
    assert np.array_equal(theirs, array)
    check(Volume(path), theirs)


@pytest.mark.parametrize("value, dtype", [(np.nan, "<f4"), (np.inf, "<f8"), (-np.inf, "<f4"), (2.5, ">f4"), (-3, "<i2"),
                                          (200, "|u1"), (np.nan, "<f2"), (0.1, "<f2"), (-6e-5, "<f2"), (True, "|b1")])
def test_v2_fill_values(tmp_path, value, dtype):
    path = tmp_path / "a.zarr"
    stored = zarr.open_array(str(path), mode="w", shape=(2, 2, 4), dtype=dtype, chunks=(2, 2, 2), fill_value=value)
    stored[:, :, :2] = 1
    if np.isfinite(value):
        check(Volume(path), stored[...])
    else:
        with pytest.warns(UserWarning, match="8 samples contain no data"):
            assert Volume(path).max == 1


def write_multiscale(path, arrays, axes, transformations, *, version="0.4", chunks=None, top=None, extra=None, store=None):
    """A v2 hierarchy by zarr-python. transformations: one list a level."""
    group = zarr.open_group(store if store is not None else str(path), mode="w")
    for level, array in enumerate(arrays):
        group.create_dataset(str(level), data=array, chunks=chunks or tuple(max(1, (n + 1) // 2) for n in array.shape),
                             dimension_separator="/")
    entry = {"version": version, "datasets": [{"path": str(level)} for level in range(len(arrays))]}
    if axes is not None:
        entry["axes"] = axes
    for dataset, one in zip(entry["datasets"], transformations):
        dataset["coordinateTransformations"] = one
    if top:
        entry["coordinateTransformations"] = top
    group.attrs.put({"multiscales": [entry], **(extra or {})})
    return path


AXIS_TYPES = {"t": "time", "c": "channel", "z": "space", "y": "space", "x": "space"}


@pytest.mark.parametrize("seed", range(50))
def test_ome_zarr_04(tmp_path, seed):
    rng, pick = np.random.default_rng(seed), random.Random(seed)
    names = pick.choice(["zyx", "czyx", "tzyx", "tczyx", "yx", "cyx"])
    sizes = {"t": pick.choice([1, 2]), "c": pick.choice([1, 3]), "z": pick.randint(1, 6), "y": pick.randint(1, 7),
             "x": pick.randint(1, 8)}
    array = numbers(rng, [sizes[n] for n in names], pick.choice(["<u2", "|u1", "<f4", ">i2"]))
    units = {n: pick.choice([*UNITS, None]) for n in "zyx"}
    axes = [{"name": n, "type": AXIS_TYPES[n]} | ({"unit": units[n]} if units.get(n) else {}) for n in names]
    scale = {n: round(pick.uniform(0.1, 5), 3) for n in names}
    shift = {n: round(pick.uniform(-5, 5), 3) for n in names}
    factor = {n: pick.choice([1, 2.0]) for n in names}
    steps = [{"type": "scale", "scale": [scale[n] for n in names]}]
    translated = pick.random() < 0.5
    if translated:
        steps.append({"type": "translation", "translation": [shift[n] for n in names]})
    top = [{"type": "scale", "scale": [factor[n] for n in names]}] if pick.random() < 0.5 else None
    if top is None:
        factor = dict.fromkeys(names, 1)
    path = write_multiscale(tmp_path / "a.ome.zarr", [array], axes, [steps], top=top)
    opened = zarr.open_group(str(path), mode="r")["0"][...]
    unit = {n: UNITS[units[n]] if units[n] else 1 for n in "zyx"}
    spacing = [scale[n] * factor[n] * unit[n] if n in names else scale["x"] * factor["x"] * unit["x"] for n in "xyz"]
    origin = [shift[n] * factor[n] * unit[n] if n in names and translated else 0 for n in "xyz"]
    for t, c in itertools.product(range(sizes["t"] if "t" in names else 1), range(sizes["c"] if "c" in names else 1)):
        index = tuple(t if n == "t" else c if n == "c" else slice(None) for n in names)
        theirs = opened[index]
        volume = Volume(path, component=c if "c" in names and sizes["c"] > 1 else None,
                        frame=t if "t" in names and sizes["t"] > 1 else None)
        check(volume, theirs if theirs.ndim == 3 else theirs[None], spacing, origin)
    if "c" in names and sizes["c"] == 3:
        with pytest.raises(Error, match="with 3 components; choose one with --component 0..2"):
            Volume(path, frame=0)
    if "t" in names and sizes["t"] == 2:
        with pytest.raises(Error, match="with 2 frames; choose one with --frame 0..1"):
            Volume(path, component=0)


STACK = numbers(np.random.default_rng(1), (6, 8, 10), "<u2")
ZYX = [{"name": n, "type": "space", "unit": "micrometer"} for n in "zyx"]


def scaled(*numbers_):
    return [{"type": "scale", "scale": list(numbers_)}]


def test_levels(tmp_path, monkeypatch):
    path = write_multiscale(tmp_path / "a.zarr", [STACK, STACK[::2, ::2, ::2]], ZYX, [scaled(4, 2, 2), scaled(8, 4, 4)])
    for level, array, factor in ((None, STACK, 1), (0, STACK, 1), (1, STACK[::2, ::2, ::2], 2)):
        check(Volume(path, level=level), array, [2e-3 * factor, 2e-3 * factor, 4e-3 * factor])
    check(Volume(path / "1"), STACK[::2, ::2, ::2], [4e-3, 4e-3, 8e-3])  # a level by its own path
    with pytest.raises(Error, match="--level 2: it has 2 levels"):
        Volume(path, level=2)
    with pytest.raises(Error, match="only OME-Zarr images have levels"):
        np.save(tmp_path / "a.npy", STACK)
        Volume(tmp_path, level=0)


def test_finest_level_that_fits(tmp_path):
    path = write_multiscale(tmp_path / "a.zarr", [STACK, STACK], ZYX, [scaled(1, 1, 1), scaled(2, 2, 2)])
    first = path / "0" / ".zarray"
    fields = json.loads(first.read_text())
    fields["shape"] = [100000, 8, 10]
    first.write_text(json.dumps(fields))
    volume = Volume(path)
    check(volume, STACK, [2e-3] * 3)
    assert any("Level 1 of 2 is read: the finer ones are too large" in note for note in volume.notes)
    with pytest.raises(Error, match="at most 65535 voxels"):
        Volume(path, level=0)


@pytest.mark.parametrize("axes", ["xyz", "zxy", "yxz"])
def test_axes_by_name(tmp_path, axes):
    array = STACK.transpose(["zyx".index(n) for n in axes])
    names = [{"name": n, "type": "space", "unit": "millimeter"} for n in axes]
    path = write_multiscale(tmp_path / "a.zarr", [array], names, [scaled(*[{"x": 1, "y": 2, "z": 3}[n] for n in axes])])
    check(Volume(path), STACK, (1, 2, 3))


@pytest.mark.parametrize("version, axes", [("0.1", None), ("0.2", None), ("0.3", list("tczyx"))])
def test_older_versions(tmp_path, version, axes):
    path = write_multiscale(tmp_path / "a.zarr", [STACK[None, None]], axes, [], version=version)
    volume = Volume(path)
    check(volume, STACK)
    assert any("1 x 1 x 1 mm is assumed" in note for note in volume.notes)


def test_channel_names(tmp_path):
    axes = [{"name": "c", "type": "channel"}, *ZYX]
    path = write_multiscale(tmp_path / "a.zarr", [np.stack([STACK, STACK + 1])], axes, [scaled(1, 1, 1, 1)],
                            extra={"omero": {"channels": [{"label": "DAPI"}, {"label": "GFP"}]}})
    with pytest.raises(Error, match=r"--component 0..1 \(0: DAPI, 1: GFP\)"):
        Volume(path)
    check(Volume(path, component=1), STACK + 1, [1e-3] * 3)


def test_labels(tmp_path):
    path = write_multiscale(tmp_path / "a.zarr", [STACK], ZYX, [scaled(1, 1, 1)])
    cells = (STACK > 8000).astype("<i4") * 7
    write_multiscale(tmp_path / "a.zarr" / "labels" / "cells", [cells], ZYX, [scaled(1, 1, 1)],
                     extra={"image-label": {"colors": [{"label-value": 7, "rgba": [255, 0, 0, 255]}]}})
    zarr.open_group(str(path / "labels")).attrs.put({"labels": ["cells"]})
    check(Volume(path / "labels" / "cells"), cells, [1e-3] * 3)
    with pytest.raises(Error, match="a group of labels: cells; open one"):
        Volume(path / "labels")
    assert any("It has labels" in note for note in Volume(path).notes)


@pytest.mark.parametrize("attributes, message", [
    ({"plate": {"wells": [{"path": "A/1"}, {"path": "B/2"}]}}, "a plate, whose wells hold the images: A/1/0, B/2/0"),
    ({"well": {"images": [{"path": "0"}, {"path": "1"}]}}, "a well of several images: 0, 1; open one"),
    ({"bioformats2raw.layout": 3}, "a group of several images .bioformats2raw.: 0, 1; open one"),
    ({}, "a Zarr group without 'multiscales', which holds: 0, 1"),
])
def test_groups(tmp_path, attributes, message):
    path = tmp_path / "a.zarr"
    zarr.open_group(str(path), mode="w").attrs.put(attributes)
    for name in "01":
        write_multiscale(path / name, [STACK], ZYX, [scaled(1, 1, 1)])
    with pytest.raises(Error, match=message):
        Volume(path)
    check(Volume(path, series=1), STACK, [1e-3] * 3)


@pytest.mark.parametrize("compression", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
@pytest.mark.parametrize("root", ["", "a.zarr/", "deep/er/a.zarr/"])
def test_zip(tmp_path, compression, root):
    path = write_multiscale(tmp_path / "a.zarr", [STACK, STACK[::2]], ZYX, [scaled(1, 2, 3), scaled(2, 2, 3)])
    zipped = tmp_path / "a.zarr.zip"
    with zipfile.ZipFile(zipped, "w", compression) as archive:
        for file in sorted(path.rglob("*")):
            if file.is_file():
                archive.write(file, root + str(file.relative_to(path)))
    check(Volume(zipped), STACK, (3e-3, 2e-3, 1e-3))
    check(Volume(zipped, level=1), STACK[::2], (3e-3, 2e-3, 2e-3))


def test_zip_of_zarr_python(tmp_path):
    path = tmp_path / "a.zip"
    with zarr.ZipStore(str(path), mode="w") as store:
        write_multiscale(None, [STACK], ZYX, [scaled(1, 1, 1)], store=store)
    check(Volume(path), STACK, [1e-3] * 3)


# --- v3, from its specification ---


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 if crc & 1 else 0)
    return struct.pack("<I", crc ^ 0xFFFFFFFF)


PACKERS = {
    "blosc": ({"cname": "zstd", "clevel": 5, "shuffle": "bitshuffle", "typesize": 2, "blocksize": 0},
              lambda data: numcodecs.Blosc("zstd", shuffle=2).encode(data)),
    "zstd": ({"level": 0, "checksum": False}, lambda data: numcodecs.Zstd().encode(data)),
    "gzip": ({"level": 5}, lambda data: numcodecs.GZip().encode(data)),
    "crc32c": ({}, lambda data: data + crc32c(data)),
}


def encoded(array, codecs):
    """A chunk's bytes by a list of codecs as in the metadata."""
    data = None
    for codec in codecs:
        settings = codec.get("configuration", {})
        if codec["name"] == "transpose":
            array = array.transpose(settings["order"])
        elif codec["name"] == "bytes":
            order = {"little": "<", "big": ">", None: "|"}[settings.get("endian")]
            data = np.ascontiguousarray(array).astype(array.dtype.newbyteorder(order)).tobytes()
        elif codec["name"] == "sharding_indexed":
            data = shard(array, settings)
        else:
            data = bytes(PACKERS[codec["name"]][1](data))
    return data


def shard(array, settings):
    inner = settings["chunk_shape"]
    grid = [n // i for n, i in zip(array.shape, inner)]
    at_start = settings.get("index_location") == "start"
    index_size = 16 * int(np.prod(grid)) + 4
    body, index = b"", []
    for at in np.ndindex(*grid):
        part = array[tuple(slice(a * i, (a + 1) * i) for a, i in zip(at, inner))]
        if not part.any():
            index += [2**64 - 1] * 2
            continue
        data = encoded(part, settings["codecs"])
        index += [len(body) + (index_size if at_start else 0), len(data)]
        body += data
    head = struct.pack(f"<{len(index)}Q", *index)
    head += crc32c(head)
    return head + body if at_start else body + head


def write_v3(path, array, chunk, codecs, *, fill=0, key={"name": "default", "configuration": {"separator": "/"}}, skip=(),
             names=None, attributes=None):
    path.mkdir(parents=True)
    dtype = {"b": "bool"}.get(array.dtype.kind, array.dtype.name)
    fields = {"zarr_format": 3, "node_type": "array", "shape": array.shape, "data_type": dtype,
              "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": chunk}}, "chunk_key_encoding": key,
              "fill_value": fill, "codecs": codecs, "attributes": attributes or {}, "storage_transformers": []}
    if names:
        fields["dimension_names"] = names
    (path / "zarr.json").write_text(json.dumps(fields))
    padded = np.zeros([-(-n // c) * c for n, c in zip(array.shape, chunk)], array.dtype)
    padded[tuple(slice(n) for n in array.shape)] = array
    separator = key.get("configuration", {}).get("separator", "/" if key["name"] == "default" else ".")
    for at in np.ndindex(*(n // c for n, c in zip(padded.shape, chunk))):
        if at in skip:
            continue
        name = separator.join([*("c" if key["name"] == "default" else ""), *map(str, at)])
        file = path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(encoded(padded[tuple(slice(a * c, (a + 1) * c) for a, c in zip(at, chunk))], codecs))
    return path


def of_bytes(endian="little"):
    return {"name": "bytes", "configuration": {"endian": endian}}


def packer(name):
    return {"name": name, "configuration": PACKERS[name][0]}


@pytest.mark.parametrize("seed", range(50))
def test_v3_arrays(tmp_path, seed):
    rng, pick = np.random.default_rng(seed), random.Random(seed)
    shape = [pick.randint(1, 9) for _ in range(3)]
    array = numbers(rng, shape, pick.choice(DTYPES).replace("8", "4") if seed % 3 else "<u2").astype(
        pick.choice(["u1", "i2", "u2", "f4", "f8", "f2", "?"]))
    inner = [pick.randint(1, 3) for _ in range(3)]
    chunk = [i * pick.randint(1, 3) for i in inner]
    codecs = [of_bytes(pick.choice(["little", "big"]))]
    if pick.random() < 0.4:
        codecs.insert(0, {"name": "transpose", "configuration": {"order": pick.sample(range(3), 3)}})
        inner_order = [inner[axis] for axis in codecs[0]["configuration"]["order"]]
    else:
        inner_order = inner
    codecs += [packer(pick.choice(["blosc", "zstd", "gzip"]))] if pick.random() < 0.7 else []
    codecs += [packer("crc32c")] if pick.random() < 0.4 else []
    if seed % 3 == 0:  # sharded; a transposition lies outside or inside of the shards
        outside = codecs[0]["name"] == "transpose" and pick.random() < 0.5
        sharding = {"name": "sharding_indexed", "configuration": {
            "chunk_shape": inner_order if outside else inner, "codecs": codecs[1:] if outside else codecs,
            "index_codecs": [of_bytes(), packer("crc32c")], "index_location": pick.choice(["start", "end"])}}
        codecs = [codecs[0], sharding] if outside else [sharding]
    key = pick.choice([{"name": "default", "configuration": {"separator": "/"}}, {"name": "default"},
                       {"name": "default", "configuration": {"separator": "."}}, {"name": "v2"},
                       {"name": "v2", "configuration": {"separator": "/"}}])
    check(Volume(write_v3(tmp_path / "a.zarr", array, chunk, codecs, key=key)), array)


@pytest.mark.parametrize("fill, dtype, value", [
    (5, "u2", 5), ("NaN", "f4", None), ("Infinity", "f4", None), ("0x7fc00000", "f4", None), ("0x40200000", "f4", 2.5),
    ("0x4100", "f2", 2.5), ("0x4004000000000000", "f8", 2.5), (-7, "i2", -7), (True, "?", 1), (1e3, "f4", 1000)])
def test_v3_fill_values(tmp_path, fill, dtype, value):
    array = np.ones((2, 2, 4), dtype)
    path = write_v3(tmp_path / "a.zarr", array, (2, 2, 2), [of_bytes()], fill=fill, skip=[(0, 0, 1)])
    if value is None:
        with pytest.warns(UserWarning, match="8 samples contain no data"):
            assert Volume(path).max == 1
    else:
        expected = array.astype(np.float32)
        expected[:, :, 2:] = value
        check(Volume(path), expected)


def write_ome_05(path, arrays, axes, scales, **attributes):
    path.mkdir()
    datasets = []
    for level, (array, scale) in enumerate(zip(arrays, scales)):
        write_v3(path / str(level), array, [max(1, n // 2) for n in array.shape], [of_bytes(), packer("zstd")])
        datasets.append({"path": str(level), "coordinateTransformations": [{"type": "scale", "scale": scale}]})
    ome = {"version": "0.5", "multiscales": [{"name": "image", "axes": axes, "datasets": datasets}], **attributes}
    (path / "zarr.json").write_text(json.dumps({"zarr_format": 3, "node_type": "group", "attributes": {"ome": ome}}))
    return path


def test_ome_zarr_05(tmp_path):
    path = write_ome_05(tmp_path / "a.zarr", [STACK, STACK[::2, ::2, ::2]], ZYX, [[4, 2, 2], [8, 4, 4]])
    check(Volume(path), STACK, (2e-3, 2e-3, 4e-3))
    check(Volume(path, level=1), STACK[::2, ::2, ::2], (4e-3, 4e-3, 8e-3))
    check(Volume(path / "1"), STACK[::2, ::2, ::2], (4e-3, 4e-3, 8e-3))


def test_plain_arrays_with_names(tmp_path):
    four = np.stack([STACK, STACK + 1])
    path = write_v3(tmp_path / "t.zarr", four, [1, 6, 8, 10], [of_bytes()], names=["t", "z", "y", "x"])
    check(Volume(path, frame=1), STACK + 1)
    path = write_v3(tmp_path / "c.zarr", np.moveaxis(four, 0, 3), [6, 8, 10, 2], [of_bytes()], names=["z", "y", "x", "c"])
    check(Volume(path, component=1), STACK + 1)
    path = write_v3(tmp_path / "n.zarr", four, [1, 6, 8, 10], [of_bytes()])
    with pytest.raises(Error, match="with 2 frames; choose one with --frame 0..1"):
        Volume(path)


def test_scale_of_values(tmp_path):
    attributes = {"scale_factor": 0.5, "add_offset": -10, "_FillValue": 3}
    array = np.array([[[0, 1], [3, 30]]], "i2")
    path = write_v3(tmp_path / "a.zarr", array, [1, 2, 2], [of_bytes()], attributes=attributes)
    with pytest.warns(UserWarning, match="1 samples contain no data"):
        volume = Volume(path)
    assert (volume.min, volume.max) == (-10, 5)


def changed(fields, key, value):
    *parents, last = key.split(".")
    for parent in parents:
        fields = fields[int(parent)] if parent.isdigit() else fields[parent]
    fields[last] = value


@pytest.mark.parametrize("key, value, message", [
    ("zarr_format", 4, "'zarr_format': 4: expected 3"),
    ("shape", [6, 8, 0], "'shape'"),
    ("shape", [6, 8, -1], "'shape'"),
    ("shape", [6, 8, 1.5], "'shape'"),
    ("shape", [6, 8], "2 axes, but chunks of 3"),
    ("shape", [10**6, 8, 10], "at most 65535 voxels"),
    ("shape", [60000, 60000, 60000], "at most"),
    ("data_type", "complex64", "samples of type complex64"),
    ("data_type", {"name": "r16"}, "samples of type r16"),
    ("chunk_grid.name", "rectangular", "'chunk_grid': 'rectangular'"),
    ("chunk_grid.configuration.chunk_shape", [0, 1, 1], "'chunk_shape'"),
    ("chunk_grid.configuration.chunk_shape", [3, 8, 10], "bytes, expected 480"),
    ("chunk_key_encoding.name", "mine", "'chunk_key_encoding': 'mine'"),
    ("fill_value", 70000, "'fill_value': 70000"),
    ("fill_value", "NaN", "'fill_value'"),
    ("codecs", [], "'codecs'"),
    ("codecs", [{"name": "zstd"}], "codec zstd: expected after the codec bytes"),
    ("codecs", [{"name": "bytes", "configuration": {"endian": "middle"}}], "endian 'middle'"),
    ("codecs", [{"name": "vlen-utf8"}], "codec 'vlen-utf8'"),
    ("codecs", [of_bytes(), {"name": "zstd"}], "truncated or damaged: zstd"),
    ("codecs", [of_bytes(), {"name": "gzip"}], "truncated or damaged"),
    ("codecs", [of_bytes(), {"name": "blosc"}], "not a whole blosc buffer"),
    ("codecs", [of_bytes(), {"name": "crc32c"}], "checksum is wrong"),
    ("storage_transformers", [{"name": "x"}], "'storage_transformers'"),
    ("node_type", "thing", "'node_type': 'thing'"),
])
def test_v3_refusals(tmp_path, key, value, message):
    path = write_v3(tmp_path / "a.zarr", STACK, [6, 8, 10], [of_bytes()])
    fields = json.loads((path / "zarr.json").read_text())
    changed(fields, key, value)
    (path / "zarr.json").write_text(json.dumps(fields))
    with pytest.raises(Error, match=message):
        Volume(path)


@pytest.mark.parametrize("key, value, message", [
    ("dtype", "<c8", "'dtype'"),
    ("dtype", [["a", "<i2"]], "'dtype'"),
    ("filters", [{"id": "delta", "dtype": "<u2"}], "filters are not read"),
    ("compressor", {"id": "lzma"}, "compressor 'lzma'"),
    ("order", "A", "'order': A"),
    ("chunks", [2, 2], "3 axes, but chunks of 2"),
    ("dimension_separator", "-", "'dimension_separator': '-'"),
])
def test_v2_refusals(tmp_path, key, value, message):
    path = tmp_path / "a.zarr"
    zarr.save_array(str(path), STACK)
    fields = json.loads((path / ".zarray").read_text())
    fields[key] = value
    (path / ".zarray").write_text(json.dumps(fields))
    with pytest.raises(Error, match=message):
        Volume(path)


@pytest.mark.parametrize("axes, steps, message", [
    (ZYX[:2], scaled(1, 1, 1), "'axes': 2 of them, but its array has 3"),
    (ZYX, scaled(1, 1), "'scale': expected a list of 3 numbers"),
    (ZYX, scaled(1, 0, 1), "'scale' of axis y is 0"),
    (ZYX, scaled(1, "a", 1), "'scale' of axis y"),
    (ZYX, [{"type": "affine", "affine": []}], "type 'affine': expected scale or translation"),
    ([{**axis, "unit": "furlong"} for axis in ZYX], scaled(1, 1, 1), "unit 'furlong': expected a unit of length"),
    ([{"name": "angle", "type": "angle"}, *ZYX[1:]], scaled(1, 1, 1), "its axis 'angle' of 6"),
])
def test_multiscale_refusals(tmp_path, axes, steps, message):
    path = write_multiscale(tmp_path / "a.zarr", [STACK], axes, [steps])
    with pytest.raises(Error, match=message):
        Volume(path)


def test_datasets_stay_inside(tmp_path):
    path = write_multiscale(tmp_path / "a.zarr", [STACK], ZYX, [scaled(1, 1, 1)])
    fields = json.loads((path / ".zattrs").read_text())
    fields["multiscales"][0]["datasets"][0]["path"] = "../b"
    (path / ".zattrs").write_text(json.dumps(fields))
    with pytest.raises(Error, match="a dataset with the path '../b'"):
        Volume(path)


def test_truncated_shard(tmp_path):
    sharding = {"name": "sharding_indexed", "configuration": {"chunk_shape": [3, 4, 5], "codecs": [of_bytes()],
                                                              "index_codecs": [of_bytes(), packer("crc32c")]}}
    path = write_v3(tmp_path / "a.zarr", STACK, [6, 8, 10], [sharding])
    chunk = path / "c" / "0" / "0" / "0"
    whole = chunk.read_bytes()
    for size in (0, 1, 100, len(whole) - 1):
        chunk.write_bytes(whole[:size])
        with pytest.raises(Error, match="truncated|damaged"):
            Volume(path)
