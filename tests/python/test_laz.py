"""Compressed LAS, which lazrs decompresses."""
import struct
import subprocess
import sys

import numpy as np
import pytest

import easypbr
from easypbr import Mesh

lazrs = pytest.importorskip("lazrs", reason="lazrs is not installed: `scripts/setup.sh tests` does")

POINT_FORMAT, RECORD = 2, np.dtype([("xyz", "<i4", 3), ("intensity", "<u2"), ("returns", "u1"), ("label", "u1"),
                                    ("angle", "i1"), ("user", "u1"), ("source", "<u2"), ("rgb", "<u2", 3)])


def header(points: int, body: int, records: int, point_format: int) -> bytes:
    """Of LAS 1.2; a tenth of a millimetre, far from zero."""
    text = struct.pack("<4sHH16sBB32s32sHHHIIBHI20x", b"LASF", 0, 0, b"", 1, 2, b"", b"", 1, 2026, 227, body, records,
                       point_format, RECORD.itemsize, points)
    return text + struct.pack("<12d", *[1e-4] * 3, 691_000, 5_335_000, 520, *[0] * 6)


@pytest.fixture
def files(tmp_path):
    """The same points as LAS and as LAZ."""
    random = np.random.default_rng(1)
    table = np.zeros(5000, RECORD)
    table["xyz"] = random.integers(-10**6, 10**6, (5000, 3))
    table["rgb"] = random.integers(0, 65536, (5000, 3))
    table["intensity"], table["label"], table["returns"] = random.integers(0, 1000, 5000), random.integers(0, 10, 5000), 9
    las, laz = tmp_path / "a.las", tmp_path / "a.laz"
    las.write_bytes(header(5000, 227, 0, POINT_FORMAT) + table.tobytes())
    record = lazrs.LazVlr.new_for_compression(POINT_FORMAT, 0).record_data()
    vlr = struct.pack("<H16sHH32s", 0, b"laszip encoded", 22204, len(record), b"") + record
    with open(laz, "wb") as out:
        out.write(header(5000, 227 + len(vlr), 1, POINT_FORMAT | 0x80) + vlr)
        compressor = lazrs.LasZipCompressor(out, lazrs.LazVlr(record))
        compressor.compress_many(table.tobytes())
        compressor.done()
    assert laz.stat().st_size < las.stat().st_size
    return las, laz


def test_laz_holds_what_las_holds(files):
    plain, compressed = map(Mesh, files)
    np.testing.assert_array_equal(compressed.V, plain.V)
    np.testing.assert_array_equal(compressed.offset, plain.offset)
    np.testing.assert_array_equal(compressed.C, plain.C)
    np.testing.assert_array_equal(compressed.L, plain.L)
    np.testing.assert_array_equal(compressed.I, plain.I)
    assert compressed.name == "a"


def test_the_command_line_reads_it_too(files, tmp_path):
    command = [sys.executable, "-m", "easypbr", "render", files[1], "-o", "a.png", "--size", "40x30"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("keep", [230, 300, 0.3, 0.9])
def test_damaged_files_are_refused(files, keep):
    content = files[1].read_bytes()
    files[1].write_bytes(content[:keep if isinstance(keep, int) else int(keep * len(content))])
    with pytest.raises(easypbr.FormatError, match="a.laz"):
        Mesh(files[1])


def test_without_lazrs_the_message_names_it(files, monkeypatch):
    monkeypatch.setitem(sys.modules, "lazrs", None)
    with pytest.raises(easypbr.FormatError, match=r"a\.laz: .*pip install lazrs"):
        Mesh(files[1])


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError])
def test_what_does_not_tell_of_the_file_passes(files, monkeypatch, error):
    """lazrs works with Python's lock held, so that Ctrl-C is raised within it."""

    def decompress(*_):
        raise error

    monkeypatch.setattr(lazrs, "decompress_points", decompress)
    with pytest.raises(error):
        Mesh(files[1])
