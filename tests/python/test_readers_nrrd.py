"""NRRD headers at random, read by edgesplat and by a second reading written here from the format's definition
(teem.sourceforge.net/nrrd/format.html). Debian has no Python package that reads NRRD."""

import bz2
import gzip
import random
import re

import numpy as np
import pytest

from edgesplat import Error, Volume

TYPES = {
    "i1": ["signed char", "int8", "int8_t"],
    "u1": ["uchar", "unsigned char", "uint8", "uint8_t"],
    "i2": ["short", "short int", "signed short", "int16", "int16_t"],
    "u2": ["ushort", "unsigned short", "uint16", "unsigned short int"],
    "i4": ["int", "signed int", "int32", "int32_t"],
    "u4": ["uint", "unsigned int", "uint32", "uint32_t"],
    "i8": ["longlong", "long long", "long long int", "int64"],
    "u8": ["ulonglong", "unsigned long long", "uint64", "uint64_t"],
    "f4": ["float"],
    "f8": ["double"],
}
# Name: dimension, signs of x, y, z that make the space LPS (None: no patient).
SPACES = {
    "right-anterior-superior": (3, (-1, -1, 1)),
    "left-anterior-superior": (3, (1, -1, 1)),
    "left-posterior-superior": (3, (1, 1, 1)),
    "right-anterior-superior-time": (4, (-1, -1, 1)),
    "left-anterior-superior-time": (4, (1, -1, 1)),
    "left-posterior-superior-time": (4, (1, 1, 1)),
    "ras": (3, (-1, -1, 1)),
    "las": (3, (1, -1, 1)),
    "lps": (3, (1, 1, 1)),
    "rast": (4, (-1, -1, 1)),
    "last": (4, (1, -1, 1)),
    "lpst": (4, (1, 1, 1)),
    "scanner-xyz": (3, None),
    "scanner-xyz-time": (4, None),
    "3d-right-handed": (3, None),
    "3d-left-handed": (3, None),
    "3d-right-handed-time": (4, None),
    "3d-left-handed-time": (4, None),
}
UNITS = {"mm": 1, "um": 1e-3, "cm": 10, "m": 1000, "microns": 1e-3, "millimeters": 1, "nm": 1e-6, "inch": 25.4}


# The second reading


def parse(path):
    content = path.read_bytes()
    fields, pairs, listed, at = {}, {}, [], 0
    while at < len(content):
        end = content.find(b"\n", at)
        end = len(content) if end < 0 else end
        line = content[at:end].decode("latin-1").rstrip("\r")
        at = min(end + 1, len(content))
        if not line:
            break
        if line.startswith("NRRD0") or line.startswith("#"):
            continue
        if "datafile" in fields and fields["datafile"].startswith("LIST"):
            listed.append(line)
        elif re.match(r"[^:]*:=", line):
            key, value = line.split(":=", 1)
            pairs[key] = value
        else:
            key, value = line.split(":", 1)
            key = key.lower().replace(" ", "")
            fields["centers" if key == "centerings" else key] = value.strip()
    return fields, pairs, listed, content[at:]


def vectors(text):
    out = []
    for vector in re.findall(r"\([^)]*\)|none", text):
        out.append(None if vector == "none" else np.array([float(c) for c in vector[1:-1].split(",")]))
    return out


def units_of(text):
    return [UNITS.get(u, 1) for u in re.findall(r'"([^"]*)"', text)]


def decode(data, fields, dtype, count):
    for _ in range(int(fields.get("lineskip", 0))):
        data = data[data.index(b"\n") + 1 :]
    encoding, skip = fields["encoding"].lower(), int(fields.get("byteskip", 0))
    if encoding in ("gzip", "gz"):
        data = gzip.decompress(data)
    elif encoding in ("bzip2", "bz2"):
        data = bz2.decompress(data)
    data = data[skip:] if skip >= 0 else data[len(data) - count * dtype.itemsize :]
    if encoding in ("txt", "text", "ascii"):
        words = data.replace(b",", b" ").split()[:count]
        return np.array([float(w) if dtype.kind == "f" else int(w) for w in words], dtype)
    if encoding == "hex":
        data = bytes.fromhex(data.decode())
    order = "<" if fields.get("endian", "little").lower() == "little" else ">"
    return np.frombuffer(data, dtype.newbyteorder(order), count)


def reference(path, component=0, frame=0):
    """Samples [z, y, x] before conversion to float, affine (3, 4) in mm, whether the axes are a patient's."""
    fields, pairs, listed, attached = parse(path)
    sizes = [int(n) for n in fields["sizes"].split()]
    dtype = np.dtype(next(d for d, names in TYPES.items() if fields["type"].lower() in names))
    count = int(np.prod(sizes))
    if "datafile" not in fields:
        flat = decode(attached, fields, dtype, count)
    else:
        words = fields["datafile"].split()
        if words[0] == "LIST":
            names = listed
        elif "%" in words[0]:
            first, last, step = map(int, words[1:4])
            names = [words[0] % i for i in range(first, last + (1 if step > 0 else -1), step)]
        else:
            names = [fields["datafile"]]
        share = count // len(names)
        flat = np.concatenate([decode((path.parent / n).read_bytes(), fields, dtype, share) for n in names])
    array = flat.reshape(sizes[::-1]).transpose()  # axis i of the file is axis i
    kinds = [k.lower() for k in fields.get("kinds", "").split()] or ["???"] * len(sizes)

    affine = np.zeros((3, 4))
    patient = False
    if "spacedirections" in fields:
        directions = vectors(fields["spacedirections"])
        name = fields.get("space", "").lower().replace(" ", "-")
        dimension, signs = SPACES.get(name, (int(fields.get("spacedimension", 3)), None))
        scale = np.ones(3)
        if "spaceunits" in fields:
            scale[: min(dimension, 3)] = units_of(fields["spaceunits"])[:3]
        patient = signs is not None
        scale = scale * (signs or (1, 1, 1))
        space = [i for i, d in enumerate(directions) if d is not None and not (len(d) == 4 and d[3] != 0)]
        for column, axis in enumerate(space):
            affine[: min(dimension, 3), column] = directions[axis][:3]
        if "spaceorigin" in fields:
            affine[: min(dimension, 3), 3] = vectors(fields["spaceorigin"])[0][:3]
        affine *= scale[:, None]
    else:
        numbers = {
            k: [float(x) for x in fields[k].split()] if k in fields else [np.nan] * len(sizes)
            for k in ("spacings", "axismins", "axismaxs")
        }
        other = [k in ("time", "list", "vector", "rgb-color", "complex", "3-vector") for k in kinds]
        space = [i for i in range(len(sizes)) if not other[i] and not (len(sizes) > 3 and np.isnan(numbers["spacings"][i]) and "spacings" in fields)][:3]
        units = units_of(fields["units"]) if "units" in fields else [1] * len(sizes)
        centers = fields.get("centers", "cell " * len(sizes)).lower().split()
        for column, axis in enumerate(space):
            low, high, spacing = (numbers[k][axis] for k in ("axismins", "axismaxs", "spacings"))
            node = centers[axis] == "node"
            if np.isnan(spacing):
                spacing = (high - low) / (sizes[axis] - node) if np.isfinite(high - low) else 1
            elif high < low:
                spacing = -spacing
            affine[column, column] = spacing * units[axis]
            if np.isfinite(low):
                affine[column, 3] = (low + (0 if node else spacing / 2)) * units[axis]
    rest = [i for i in range(len(sizes)) if i not in space]
    chosen = []
    for axis in rest:
        is_frame = kinds[axis] in ("???", "time", "domain", "space")
        chosen.append(0 if sizes[axis] == 1 else frame if is_frame else component)
    voxels = array.transpose(rest + space)[tuple(chosen)]
    if len(space) == 2:
        voxels = voxels[:, :, None]
        normal = np.cross(affine[:, 0], affine[:, 1])
        affine[:, 2] = normal / np.linalg.norm(normal)
    return voxels.transpose(), affine, patient


# Files at random


def samples(rng, dtype, count):
    dtype = np.dtype(dtype)
    if dtype.kind == "f":
        return (rng.standard_normal(count) * 100).astype(dtype)
    info = np.iinfo(dtype)
    low, high = max(info.min, -30000), min(info.max, 60000)
    return rng.integers(low, high, count, dtype=dtype)


def rotation(rng):
    q, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    return q


def number(value):
    return repr(float(value)) if value % 1 else random.choice([str(int(value)), repr(float(value))])


def vector(values, blank):
    return "(" + ("," + blank).join(number(v) for v in values) + ")"


def write_random(folder, seed):
    rng, pick = np.random.default_rng(seed), random.Random(seed)
    random.seed(seed)
    sizes = [int(n) for n in rng.integers(5, 9, 3)]
    extra = pick.choice([None, None, "vector first", "list first", "time last", "time first", "list middle", "complex", "stub"])
    kinds, spatial = ["domain" if pick.random() < 0.5 else "space"] * 3, [0, 1, 2]
    if extra:
        kind, place = {
            "vector first": ("vector", 0),
            "list first": ("list", 0),
            "time last": ("time", 3),
            "time first": ("time", 0),
            "list middle": ("list", 2),
            "complex": ("complex", 0),
            "stub": ("stub", 3),
        }[extra]
        size = {"complex": 2, "stub": 1}.get(kind, int(rng.integers(2, 6)))
        sizes.insert(place, size)
        kinds.insert(place, kind)
        spatial = [i for i in range(4) if i != place]
    component = frame = None
    if extra and kinds[next(i for i in range(4) if i not in spatial)] == "time":
        frame = int(rng.integers(0, size))
    elif extra and size > 1:
        component = int(rng.integers(0, size))
    dtype = pick.choice(list(TYPES))
    count = int(np.prod(sizes))
    data = samples(rng, dtype, count)

    fields = [("type", pick.choice(TYPES[dtype])), ("dimension", str(len(sizes))), ("sizes", " ".join(map(str, sizes)))]
    if extra or pick.random() < 0.6:
        fields.append(("kinds", " ".join(kinds)))
    if pick.random() < 0.65:
        name = pick.choice(list(SPACES) + [None])
        dimension = SPACES[name][0] if name else 3
        shown = pick.choice([str.upper, str.title, str.lower])(name) if name else ""
        fields.append(("space", shown) if name else ("space dimension", "3"))
        axes = rotation(rng) * rng.uniform(0.2, 3, 3)
        if pick.random() < 0.3:
            axes = axes @ (np.eye(3) + np.triu(rng.uniform(-0.4, 0.4, (3, 3)), 1))  # sheared
        if pick.random() < 0.3:
            axes = np.eye(3)[:, rng.permutation(3)] * rng.choice([-1.5, 0.75], 3)
        blank = pick.choice(["", " "])
        texts, others = [], 0
        for i in range(len(sizes)):
            if i in spatial:
                texts.append(vector([*axes[:, spatial.index(i)], *([0.0] * (dimension - 3))], blank))
            else:
                texts.append("none")
        fields.append(("space directions", " ".join(texts)))
        if pick.random() < 0.8:
            fields.append(("space origin", vector([*rng.uniform(-200, 200, 3), *([0.0] * (dimension - 3))], blank)))
        if pick.random() < 0.4:
            units = [pick.choice(list(UNITS))] * 3 if pick.random() < 0.7 else [pick.choice(["mm", "cm", "inch"]) for _ in "xyz"]
            fields.append(("space units", " ".join(f'"{u}"' for u in units + ["s"] * (dimension - 3))))
        if pick.random() < 0.2:
            frame_text = " ".join(vector([float(i == j) for i in range(dimension)], "") for j in range(dimension))
            fields.append(("measurement frame", frame_text))
    else:
        spacings = [f"{s:.4f}" if i in spatial else "nan" for i, s in enumerate(rng.uniform(0.1, 4, len(sizes)))]
        mode = pick.choice(["spacings", "limits", "both", "min only", "nothing"] if not extra else ["spacings", "nothing"])
        if mode in ("spacings", "both", "min only"):
            fields.append(("spacings", " ".join(spacings)))
        if mode in ("limits", "both", "min only"):
            centers = [pick.choice(["cell", "node"]) for _ in sizes]
            if pick.random() < 0.7:
                fields.append((pick.choice(["centers", "centerings"]), " ".join(centers)))
            else:
                centers = ["cell"] * 3
            low = rng.uniform(-50, 50, 3)
            step = np.array([float(s) for s in spacings]) * pick.choice([1, 1, -1])
            steps = [n - (c == "node") for n, c in zip(sizes, centers)]
            fields.append(("axis mins", " ".join(repr(float(v)) for v in low)))
            if mode != "min only":
                fields.append(("axis maxs", " ".join(repr(float(v)) for v in low + step * steps)))
        if pick.random() < 0.4:
            fields.append(("units", " ".join(f'"{pick.choice(list(UNITS))}"' for _ in sizes)))
        if pick.random() < 0.2:
            fields.append(("thicknesses", " ".join(["nan"] * len(sizes))))
    if pick.random() < 0.2:
        fields += [("old min", "-1.5"), ("old max", "8")]
    if pick.random() < 0.3:
        fields += [("content", "a: thing"), ("labels", " ".join(['"a \\"b"'] * len(sizes)))]
    for field in ("min", "number", "sample units"):
        if pick.random() < 0.15:
            fields.append((field, "3"))

    encoding = pick.choice(["raw", "raw", "gzip", "gz", "bzip2", "bz2", "ascii", "txt", "text", "hex", "RAW"])
    order = pick.choice(["little", "big"])
    stored = data.astype(np.dtype(dtype).newbyteorder("<" if order == "little" else ">")).tobytes()
    text = encoding in ("ascii", "txt", "text")
    if not text:
        fields.append(("endian", pick.choice([order, order.title()])))
    fields.append(("encoding", encoding))
    skip, lines = 0, 0
    if pick.random() < 0.3 and not text and encoding != "hex":
        skip = pick.choice([3, 17, -1])
        fields.append((pick.choice(["byte skip", "byteskip"]), str(skip)))
    if pick.random() < 0.3:
        lines = 2
        fields.append((pick.choice(["line skip", "lineskip"]), str(lines)))
    detached = pick.random() < 0.4
    if skip < 0 and not detached and encoding.lower() == "raw":
        lines = 0
        fields = [f for f in fields if f[0] not in ("line skip", "lineskip")]

    def packed(part):
        if text:
            values = np.frombuffer(part, np.dtype(dtype).newbyteorder("<" if order == "little" else ">"))
            part = pick.choice([" ", "\n", ", "]).join(repr(v.item()) for v in values).encode()
        elif encoding == "hex":
            part = part.hex().encode()
        else:
            part = (bytes(range(skip)) if skip > 0 else b"head" if skip < 0 else b"") + part
        if encoding in ("gzip", "gz"):
            part = gzip.compress(part) if pick.random() < 0.8 else gzip.compress(part[:50]) + gzip.compress(part[50:])
        elif encoding in ("bzip2", "bz2"):
            part = bz2.compress(part)
        return b"a line\n" * lines + part

    head = [f"NRRD000{pick.choice([4, 5])}", "# a comment: with a colon"]
    order_of_fields = fields[:2] + pick.sample(fields[2:], len(fields) - 2)
    head += [f"{pick.choice([str, str.upper, str.capitalize])(k) if k != 'type' else k}: {v}" for k, v in order_of_fields]
    head += ["some key:=some: value", "Other:=a\\nb"][: pick.randrange(3)]
    newline = pick.choice(["\n", "\n", "\r\n"])
    path = folder / ("a.nhdr" if detached else "a.nrrd")
    if not detached:
        path.write_bytes((newline.join(head) + newline * 2).encode() + packed(stored))
        return path, component, frame
    form = pick.choice(["one", "list", "pattern", "backwards", "subdim"])
    if form == "one":
        (folder / "the data.raw").write_bytes(packed(stored))
        head.append("data file: the data.raw")
    else:
        pieces = sizes[-1] * (sizes[-2] if form == "subdim" else 1)
        share = len(stored) // pieces
        parts = [stored[i * share : (i + 1) * share] for i in range(pieces)]
        for i, part in enumerate(parts):
            n = i + 3 if form != "backwards" else pieces + 2 - i
            (folder / f"part{n:03d}.raw").write_bytes(packed(part))
        if form == "list":
            head += ["data file: LIST"] + [f"part{i + 3:03d}.raw" for i in range(pieces)]
        elif form == "subdim":
            head.append(f"data file: part%03d.raw 3 {pieces + 2} 1 {len(sizes) - 2}")
        elif form == "pattern":
            head.append(f"data file: part%03d.raw 3 {pieces + 2} 1")
        else:
            head.append(f"data file: part%03d.raw {pieces + 2} 3 -1")
    path.write_bytes((newline.join(head) + newline).encode())
    return path, component, frame


@pytest.mark.parametrize("seed", range(160))
def test_header_at_random(tmp_path, seed):
    path, component, frame = write_random(tmp_path, seed)
    voxels, affine, patient = reference(path, component or 0, frame or 0)
    volume = Volume(str(path), component=component, frame=frame)
    header = path.read_bytes()[:2000]
    scale = np.abs(affine[:, :3]).max()
    assert volume.shape == voxels.shape, header
    assert np.allclose(volume.direction * np.array(volume.spacing), affine[:, :3], rtol=1e-9, atol=1e-9 * scale), header
    assert np.allclose(volume.origin, affine[:, 3], rtol=1e-9, atol=1e-9), header
    assert volume.patient == patient, header
    assert np.array_equal(volume.array, voxels.astype(np.float32)), header
    if component is not None or frame is not None:
        with pytest.raises(Error, match="--component|--frame"):
            Volume(str(path))
