"""Shared by all tests: a small picture, a cache folder of their own, meshes whose values are known."""

import os
import signal
import tempfile

import pytest

# Who starts tests in the background may ignore it, and programs that tests start and interrupt would too.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

_cache = tempfile.TemporaryDirectory(prefix="easypbr-test-cache-")
os.environ["EASYPBR_CACHE_DIR"] = _cache.name
os.environ["EASYPBR_LEAK_WARNINGS"] = "1"  # of this process and of those that tests start

import numpy as np  # noqa: E402

import easypbr  # noqa: E402


@pytest.fixture(autouse=True)
def empty_default_scene():
    easypbr.Scene.clear()
    yield
    easypbr.Scene.clear()


@pytest.fixture
def size():
    """Width and height differ, so that a swap shows."""
    return (64, 48)


@pytest.fixture
def square():
    """Vertices and faces of the unit square in the xy plane, facing +z."""
    V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float64)
    F = np.array([[0, 1, 2], [0, 2, 3]])
    return V, F
