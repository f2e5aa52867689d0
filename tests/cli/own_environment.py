"""A cache and a configuration of the tests' own, so that runs neither use nor fill the user's."""
import os

import pytest


@pytest.fixture(scope="session")
def environment(tmp_path_factory):
    folders = {name: str(tmp_path_factory.mktemp(name)) for name in ("EASYPBR_CACHE_DIR", "XDG_CONFIG_HOME")}
    return {**os.environ, **folders}
