"""Shaders of one's own from the command line: --shader and --pass."""
import numpy as np
import pytest

import exr
import png

GREEN = "void surface(inout Surface s) {\n    s.base_color = vec3(0.25, 1.0, 0.5);\n}\n"
HALF = "layout(location = 0) out vec4 o_color;\nvoid main() { o_color = vec4(0.5, 0.0, 0.0, 1.0); }\n"


def test_a_shader_changes_the_base_colour(render, sphere, tmp_path):
    (tmp_path / "green.glsl").write_text(GREEN)
    render(sphere, "--shader", "green.glsl", "--layers", "albedo", "-o", "out.png")
    planes = exr.read(tmp_path / "out_albedo.exr")
    # The layer is of 16 bits: half a step.
    assert np.allclose([planes[c][24, 32] for c in "RGB"], (0.25, 1.0, 0.5), atol=0.5 / 65535)


def test_a_mistake_is_told_with_its_line(render, sphere, tmp_path):
    (tmp_path / "wrong.glsl").write_text(GREEN.replace("vec3", "colour"))
    told = render(sphere, "--shader", "wrong.glsl", "-o", "out.png", code=1).stderr
    assert "wrong.glsl:2" in told and "colour" in told
    assert not (tmp_path / "out.png").exists()
    assert "there.glsl" in render(sphere, "--shader", "there.glsl", "-o", "out.png", code=1).stderr


# The overlay is display light: 0.5 linear is 188 of 255 in sRGB, whatever the tone curve. In a finished picture it is 128.
@pytest.mark.parametrize("given, red", [("half.frag", 188), ("overlay=half.frag", 188), ("picture=half.frag", 128)])
def test_a_pass_draws_over_the_picture(render, sphere, tmp_path, given, red):
    (tmp_path / "half.frag").write_text(HALF)
    render(sphere, "--pass", given, "--samples", "2", "-o", "out.png")
    assert np.all(png.read(tmp_path / "out.png")[:, :, 0] == red)


def test_bad_passes_are_refused(render, sphere, tmp_path):
    (tmp_path / "half.frag").write_text(HALF)
    assert "no stage 'ligth'" in render(sphere, "--pass", "ligth=half.frag", "-o", "out.png", code=2).stderr
    assert "no.frag" in render(sphere, "--pass", "no.frag", "-o", "out.png", code=1).stderr
    (tmp_path / "half.frag").write_text(HALF.replace("0.5", "half"))
    told = render(sphere, "--pass", "half.frag", "-o", "out.png", code=1).stderr
    assert "pass 'half.frag'" in told and "half.frag:2" in told
