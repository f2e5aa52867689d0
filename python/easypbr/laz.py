"""Decompresses the points of LAZ files with lazrs (pip install lazrs)."""

import importlib
from typing import Any


def decompress(laszip: bytes, points: bytes, place: int, size: int) -> bytes:
    """`size` bytes of point records, from LASzip's record and what begins where the points do, at a place of the file."""
    try:
        lazrs: Any = importlib.import_module("lazrs")  # It has no types.
    except ImportError:
        raise ImportError("compressed points (LAZ) are read with lazrs: pip install lazrs") from None
    # First comes the place of the table of chunks in the file (or -1); lazrs looks for it in the bytes that it is given.
    table = int.from_bytes(points[:8], "little", signed=True)
    if table >= place:
        points = (table - place).to_bytes(8, "little") + points[8:]
    records = bytearray(size)
    try:
        lazrs.decompress_points(points, laszip, records, False)
    except (lazrs.LazrsError, OverflowError) as error:
        raise ValueError(f"the compressed points are damaged: {error}") from None
    return bytes(records)
