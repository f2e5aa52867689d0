"""Reads PNG files (8 and 16 bits, not interlaced) independently of the library under test.

PNG specification, third edition: https://www.w3.org/TR/png-3/
"""
import struct
import zlib

import numpy as np

CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}


def chunks(data: bytes):
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG file"
    at = 8
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        yield kind, data[at + 8 : at + 8 + length]
        at += 12 + length


def paeth(a: int, b: int, c: int) -> int:
    p = a + b - c
    distances = abs(p - a), abs(p - b), abs(p - c)
    return (a, b, c)[distances.index(min(distances))]


def unfilter(kind: int, row: np.ndarray, above: np.ndarray, step: int) -> np.ndarray:
    if kind == 0:
        return row
    if kind == 2:
        return row + above
    out = [0] * step + row.tolist()
    up = [0] * step + above.tolist()
    for i in range(step, len(out)):
        a, b, c = out[i - step], up[i], up[i - step]
        out[i] = (out[i] + (a if kind == 1 else (a + b) // 2 if kind == 3 else paeth(a, b, c))) & 255
    return np.array(out[step:], np.uint8)


def decode(data: bytes) -> np.ndarray:
    """Height x width x channels, uint8 or uint16."""
    packed = b""
    for kind, body in chunks(data):
        if kind == b"IHDR":
            width, height, bits, color, _, _, interlace = struct.unpack(">IIBBBBB", body)
            assert bits in (8, 16) and color in CHANNELS and not interlace
        if kind == b"IDAT":
            packed += body
    step = CHANNELS[color] * bits // 8
    raw = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * step)
    above = np.zeros(width * step, np.uint8)
    rows = []
    for line in raw:
        above = unfilter(int(line[0]), line[1:], above, step)
        rows.append(above)
    values = np.stack(rows).view(np.uint8 if bits == 8 else ">u2")
    return values.reshape(height, width, CHANNELS[color])


def read(path) -> np.ndarray:
    return decode(path.read_bytes())
