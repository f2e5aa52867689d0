"""Servers of small scenes, and clients that speak the protocol as the page does."""

import os
import tempfile

import pytest

_cache = tempfile.TemporaryDirectory(prefix="easypbr-test-cache-")
os.environ["EASYPBR_CACHE_DIR"] = _cache.name
os.environ["EASYPBR_LEAK_WARNINGS"] = "1"  # of this process and of those that tests start

import easypbr  # noqa: E402
from client import Client  # noqa: E402


@pytest.fixture
def view():
    scene = easypbr.Scene()
    ball = easypbr.shapes.sphere(1, 24)
    scene.show(ball, "ball")
    return easypbr.Viewer((160, 120), {"image": {"samples": 4}}, scene=scene)


@pytest.fixture
def server(view):
    with view.serve() as server:
        yield server


@pytest.fixture
def connect(server):
    """Connects clients, which end with the test; by default with the secret that controls."""
    clients = []

    def connect(url=None, **options):
        clients.append(Client(url or server.url, **options))
        return clients[-1]

    yield connect
    for client in clients:
        client.close()
