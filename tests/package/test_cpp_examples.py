"""examples/cpp built and run against the installed library."""
import subprocess

import numpy as np
import pytest

import easypbr
from test_package import ROOT, run

EXAMPLE = ROOT / "examples/cpp"


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("examples")
    run("cmake", "--install", ROOT / "build", "--prefix", folder / "prefix", cwd=folder)
    run("cmake", "-S", EXAMPLE, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={folder / 'prefix'}",
        "-DCMAKE_DISABLE_FIND_PACKAGE_libigl=ON", cwd=folder)
    run("cmake", "--build", folder / "build", cwd=folder)
    return folder / "build"


def test_first_picture(programs, tmp_path):
    run(programs / "first_picture", cwd=tmp_path)
    assert np.ptp(easypbr.load_image(tmp_path / "first_picture.png")[:, :, :3]) > 100


def test_a_pass_of_ones_own_draws_outlines(programs, tmp_path):
    """The outline is dark, closed around the teapot, and of the given width."""
    assert len((EXAMPLE / "outline.cpp").read_text().splitlines()) < 80
    run(programs / "outline", EXAMPLE / "outline.frag", cwd=tmp_path)
    outlined = easypbr.load_image(tmp_path / "outline.png")[:, :, :3].astype(int)
    view = easypbr.Viewer((800, 600), scene=easypbr.Scene())
    teapot = easypbr.shapes.teapot()
    teapot.material.base_color = "#c8b89a"
    view.scene.show(teapot, "teapot")
    plain = view.render()[:, :, :3].astype(int)
    inside = view.layers("depth")["depth"] > 0
    inside = inside.reshape(inside.shape[:2])
    # 2 pixels wide: one to each side of the border, so that the pixels of the border itself are dark...
    border = inside[1:-1, 1:-1] & ~(inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:])
    # 0.02 linear is 38 of 255; half of it may be covered by what lies before the line in some of the samples.
    assert np.percentile(outlined[1:-1, 1:-1][border].max(axis=1), 90) < 100
    # ... and three pixels from any edge nothing has changed.
    near = np.zeros_like(inside)
    for dy in range(-3, 4):
        for dx in range(-3, 4):
            near |= np.roll(inside, (dy, dx), (0, 1)) != inside
    far = ~near & ~inside
    assert np.array_equal(outlined[far], plain[far])
    changed = np.any(outlined != plain, axis=2)
    assert 0.01 < changed.mean() < 0.1


def test_mistakes_in_the_shader_name_the_line(programs, tmp_path):
    text = (EXAMPLE / "outline.frag").read_text().replace("bool edge = false;", "bool edge = nothing;")
    (tmp_path / "wrong.frag").write_text(text)
    line = 1 + text[: text.index("= nothing")].count("\n")
    done = subprocess.run([programs / "outline", tmp_path / "wrong.frag"], cwd=tmp_path, capture_output=True, text=True,
                          timeout=120)
    assert done.returncode == 1
    assert f"wrong.frag:{line}" in done.stderr and "nothing" in done.stderr
