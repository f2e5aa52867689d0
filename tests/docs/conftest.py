"""A cache of our own, so that tests neither use nor fill the user's."""
import sys

import pytest


@pytest.fixture(autouse=True)
def own_cache(tmp_path_factory, monkeypatch):
    # Whose package the command `dataset` runs.
    monkeypatch.setenv("EASYPBR_PYTHON", sys.executable)
    monkeypatch.setenv("EASYPBR_CACHE_DIR", str(tmp_path_factory.getbasetemp() / "cache"))
