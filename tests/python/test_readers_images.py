"""Pictures as volumes: palettes give indices and no depth is scaled. All files are written here."""

import struct
import zlib

import numpy as np
import pytest

from edgesplat import Error, Volume


def check(path, array, **choice):
    volume = Volume(path, **choice)
    assert volume.shape == (1, *array.shape)
    assert np.array_equal(volume.array[0], array.astype(np.float32))
    assert volume.spacing == (1, 1, 1)
    return volume


def packed_rows(values, bits):
    rows = []
    for row in values:
        text = "".join(format(int(value), f"0{bits}b") for value in np.ravel(row))
        text += "0" * (-len(text) % 8)
        rows.append(bytes(int(text[i : i + 8], 2) for i in range(0, len(text), 8)))
    return rows


def png(values, bits, colour, palette=None):
    """values: (rows, columns) or (rows, columns, channels)."""

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    height, width = values.shape[:2]
    data = b"".join(b"\0" + row for row in packed_rows(values, bits))
    head = struct.pack(">2I5B", width, height, bits, colour, 0, 0, 0)
    extra = chunk(b"PLTE", palette) + chunk(b"tRNS", b"\0\x80") if palette else b""
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + extra + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b"")


@pytest.mark.parametrize("bits", [1, 2, 4, 8, 16])
def test_grey_png(tmp_path, bits):
    values = np.random.default_rng(bits).integers(0, 2**bits, (5, 7))
    path = tmp_path / "a.png"
    path.write_bytes(png(values, bits, 0))
    check(path, values)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) - 20])
    with pytest.raises(Error, match="truncated or damaged"):
        Volume(path)


@pytest.mark.parametrize("bits", [1, 2, 4, 8])
def test_palette_png(tmp_path, bits):
    values = np.random.default_rng(bits).integers(0, 2**bits, (5, 7))
    path = tmp_path / "a.png"
    path.write_bytes(png(values, bits, 3, bytes(np.random.default_rng(0).integers(0, 256, 3 * 2**bits, dtype=np.uint8))))
    assert any("palette" in note for note in check(path, values).notes)


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("colour, channels", [(4, 2), (2, 3), (6, 4)])
def test_png_with_components(tmp_path, bits, colour, channels):
    values = np.random.default_rng(bits).integers(0, 2**bits, (5, 7, channels))
    path = tmp_path / "a.png"
    path.write_bytes(png(values, bits, colour))
    for channel in range(channels):
        check(path, values[..., channel], component=channel)
    with pytest.raises(Error, match=f"with {channels} components; choose one with --component 0..{channels - 1}"):
        Volume(path)


@pytest.mark.parametrize("kind", ["P2", "P5"])
@pytest.mark.parametrize("largest", [1, 9, 100, 255, 256, 4095, 65535])
def test_grey_maps(tmp_path, kind, largest):
    values = np.random.default_rng(largest).integers(0, largest + 1, (4, 6))
    head = f"{kind}\n# a comment\n6 4\n{largest}\n".encode()
    text = " ".join(map(str, values.flat)).encode()
    path = tmp_path / "a.pgm"
    path.write_bytes(head + (text if kind == "P2" else values.astype(">u2" if largest > 255 else "u1").tobytes()))
    check(path, values)
    if kind == "P5":
        path.write_bytes(path.read_bytes()[:-1])
        with pytest.raises(Error, match="truncated"):
            Volume(path)


def test_colour_map(tmp_path):
    values = np.random.default_rng(1).integers(0, 1001, (4, 6, 3))
    path = tmp_path / "a.ppm"
    path.write_bytes(b"P6 6 4 1000 " + values.astype(">u2").tobytes())
    for channel in range(3):
        check(path, values[..., channel], component=channel)


@pytest.mark.parametrize("bits", [1, 4, 8])
@pytest.mark.parametrize("top_down", [False, True])
def test_palette_bmp(tmp_path, bits, top_down):
    values = np.random.default_rng(bits).integers(0, 2**bits, (5, 7))
    rows = [row.ljust((7 * bits + 31) // 32 * 4, b"\0") for row in packed_rows(values, bits)]
    palette = bytes(np.random.default_rng(0).integers(0, 256, 4 * 2**bits, dtype=np.uint8))
    pixels = b"".join(rows if top_down else rows[::-1])
    head = struct.pack("<IiiHHIIiiII", 40, 7, -5 if top_down else 5, 1, bits, 0, len(pixels), 0, 0, 2**bits, 0)
    start = 14 + len(head) + len(palette)
    path = tmp_path / "a.bmp"
    path.write_bytes(b"BM" + struct.pack("<IHHI", start + len(pixels), 0, 0, start) + head + palette + pixels)
    check(path, values)


def lzw(values, bits):
    """GIF's LZW in its simplest form: codes of one length, cleared before they grow."""
    text, clear, length = "", 2**bits, bits + 1
    for i, value in enumerate(values):
        if i % (2**bits - 2) == 0:
            text = format(clear, f"0{length}b") + text
        text = format(int(value), f"0{length}b") + text
    text = format(clear + 1, f"0{length}b") + text
    text = "0" * (-len(text) % 8) + text
    data = int(text, 2).to_bytes(len(text) // 8, "little")
    blocks = b"".join(bytes([len(data[i : i + 255])]) + data[i : i + 255] for i in range(0, len(data), 255))
    return bytes([bits]) + blocks + b"\0"


def gif(pages, bits, interlaced=False):
    height, width = pages[0].shape
    data = b"GIF89a" + struct.pack("<HHBBB", width, height, 0x80 | (bits - 1), 0, 0) + bytes(range(3 * 2**bits))[: 3 * 2**bits]
    for page in pages:
        rows = [*range(0, height, 8), *range(4, height, 8), *range(2, height, 4), *range(1, height, 2)]
        stored = page[rows] if interlaced else page
        data += b"\x21\xf9\x04\0\0\0\0\0" + b"\x2c" + struct.pack("<4HB", 0, 0, width, height, 0x40 if interlaced else 0)
        data += lzw(stored.ravel(), bits)
    return data + b"\x3b"


@pytest.mark.parametrize("interlaced", [False, True])
@pytest.mark.parametrize("bits", [2, 4, 6])
def test_gif(tmp_path, bits, interlaced):
    pages = np.random.default_rng(bits).integers(0, 2**bits, (3, 11, 9))
    path = tmp_path / "a.gif"
    path.write_bytes(gif(pages, bits, interlaced))
    assert np.array_equal(Volume(path).array, pages.astype(np.float32))
    whole = path.read_bytes()
    for size in range(13, len(whole) - 1, 5):
        path.write_bytes(whole[:size])
        with pytest.raises(Error, match="a.gif"):
            Volume(path)


def test_sequence_of_palette_pictures(tmp_path):
    values = np.random.default_rng(1).integers(0, 16, (3, 5, 7))
    for i, page in enumerate(values):
        (tmp_path / f"s{i}.png").write_bytes(png(page, 4, 3, bytes(range(48))))
    assert np.array_equal(Volume(tmp_path).array, values.astype(np.float32))
