"""Reads and writes single-part scan-line OpenEXR files independently of the library under test.

"OpenEXR File Layout": https://openexr.com/en/latest/OpenEXRFileLayout.html
"""
import struct
import zlib

import numpy as np

TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
ROWS_PER_BLOCK = {0: 1, 2: 1, 3: 16}  # none, ZIPS, ZIP


def write(path, pixels: np.ndarray) -> None:
    """Uncompressed float32 R, G, B from height x width x 3."""
    height, width, _ = pixels.shape
    channels = b"".join(name + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = [
        (b"channels", b"chlist", channels),
        (b"compression", b"compression", b"\0"),
        (b"dataWindow", b"box2i", window),
        (b"displayWindow", b"box2i", window),
        (b"lineOrder", b"lineOrder", b"\0"),
        (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
        (b"screenWindowWidth", b"float", struct.pack("<f", 1)),
    ]
    header = struct.pack("<II", 20000630, 2)
    header += b"".join(n + b"\0" + t + b"\0" + struct.pack("<I", len(v)) + v for n, t, v in attributes) + b"\0"
    rows = [np.ascontiguousarray(row[:, ::-1].T, "<f4").tobytes() for row in pixels]
    first = len(header) + 8 * height
    offsets = b"".join(struct.pack("<Q", first + y * (8 + len(rows[0]))) for y in range(height))
    blocks = b"".join(struct.pack("<ii", y, len(row)) + row for y, row in enumerate(rows))
    path.write_bytes(header + offsets + blocks)


def text(data: bytes, at: int):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def header(data: bytes):
    assert struct.unpack_from("<I", data)[0] == 20000630, "not an OpenEXR file"
    attributes, at = {}, 8
    while data[at]:
        name, at = text(data, at)
        _, at = text(data, at)
        (size,) = struct.unpack_from("<I", data, at)
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channel_list(data: bytes):
    channels, at = [], 0
    while data[at]:
        name, at = text(data, at)
        channels.append((name, TYPES[struct.unpack_from("<I", data, at)[0]]))
        at += 16
    return channels


def inflate(data: bytes, size: int) -> bytes:
    if len(data) == size:
        return data
    deltas = np.frombuffer(zlib.decompress(data), np.uint8).astype(np.int64)
    deltas[1:] -= 128
    halves = np.cumsum(deltas).astype(np.uint8)
    out = np.empty(size, np.uint8)
    out[0::2], out[1::2] = halves[: (size + 1) // 2], halves[(size + 1) // 2 :]
    return out.tobytes()


def read(path) -> dict:
    """Channel name -> height x width, uint32 or float32."""
    data = path.read_bytes()
    attributes, at = header(data)
    channels = channel_list(attributes["channels"])
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height, rows = x1 - x0 + 1, y1 - y0 + 1, ROWS_PER_BLOCK[attributes["compression"][0]]
    planes = {name: np.empty((height, width), np.uint32 if kind == TYPES[0] else np.float32) for name, kind in channels}
    for offset in struct.unpack_from(f"<{-(-height // rows)}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        count = min(rows, height - (y - y0))
        raw = inflate(data[offset + 8 : offset + 8 + size], count * width * sum(t.itemsize for _, t in channels))
        place = 0
        for row in range(y - y0, y - y0 + count):
            for name, kind in channels:
                planes[name][row] = np.frombuffer(raw, kind, width, place)
                place += width * kind.itemsize
    return planes
