"""Memory that path traced images take."""

import os
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench"))
import path_memory  # noqa: E402

# Each thread has a stack, and room for a block of paths.
MB_OF_A_THREAD = 4


@pytest.mark.parametrize("denoise", path_memory.DENOISERS)
def test_an_image_takes_200_mb_beside_its_scene(denoise: str) -> None:
    threads = max(0, (os.cpu_count() or 1) - 2)
    beside = path_memory.peak_mb(1920, 1080, denoise) - path_memory.peak_mb(64, 36, denoise)
    assert 0 < beside <= 200 + MB_OF_A_THREAD * threads
