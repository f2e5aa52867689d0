"""`easypbr render` as a job: files in and out, batches, settings files, failures."""
import re
import subprocess

import pytest

import png
from binary import BINARY


def one_error(done):
    """The only line on stderr, which must be an error."""
    lines = done.stderr.splitlines()
    assert len(lines) == 1 and lines[0].startswith("easypbr: error: "), done.stderr
    return lines[0]


def test_success_is_silent(render, sphere, tmp_path):
    done = render(sphere, "-o", "out.png")
    assert (done.stdout, done.stderr) == ("", "")
    assert png.read(tmp_path / "out.png").shape == (48, 64, 4)
    assert [p.name for p in tmp_path.iterdir()] == ["out.png"]


def test_standard_output_gets_the_same_bytes(render, sphere, tmp_path):
    render(sphere, "-o", "out.png")
    assert render(sphere, "-o", "-", text=False).stdout == (tmp_path / "out.png").read_bytes()


def test_several_files_make_one_picture(render, sphere, box, tmp_path):
    render(sphere, box, sphere, "-o", "all.png")
    render(sphere, "-o", "one.png")
    assert (png.read(tmp_path / "all.png") != png.read(tmp_path / "one.png")).any()


def test_batch_draws_each_file_as_if_alone(render, sphere, box, tmp_path):
    render(sphere, box, "--batch", "-o", "{name}.png")
    for mesh in (sphere, box):
        render(mesh, "-o", "alone.png")
        assert (tmp_path / f"{mesh.stem}.png").read_bytes() == (tmp_path / "alone.png").read_bytes()


def test_batch_goes_on_after_a_file_that_fails(render, sphere, box, tmp_path):
    (tmp_path / "broken.ply").write_text("ply\nnonsense")
    done = render(sphere, "broken.ply", box, "--batch", "-o", "{name}.png", code=1)
    assert "broken.ply" in one_error(done)
    assert sorted(p.name for p in tmp_path.glob("*.png")) == ["box.png", "sphere.png"]


def test_batch_needs_a_name_in_the_output(render, sphere, tmp_path):
    assert "{name}" in one_error(render(sphere, "--batch", "-o", "out.png", code=2))


def test_saved_settings_reproduce_the_picture(render, box, tmp_path):
    render(box, "-o", "a.png", "--roughness", "0.2", "--background", "#102030", "--set", "camera.azimuth_deg=70",
           "--save-settings", "look.json")
    render(box, "-o", "b.png", "--settings", "look.json")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_command_line_wins_over_the_settings_file(easypbr, render, sphere, tmp_path):
    render(sphere, "-o", "a.png", "--background", "#102030", "--save-settings", "look.json")
    easypbr("render", sphere, "-o", "b.png", "--settings", "look.json", "--background", "#405060", "--size", "20x10")
    pixels = png.read(tmp_path / "b.png")
    assert pixels.shape == (10, 20, 4) and pixels[0, 0].tolist() == [0x40, 0x50, 0x60, 255]


def test_settings_of_another_file_warn(render, sphere, tmp_path):
    (tmp_path / "copy.obj").write_bytes(sphere.read_bytes())
    render("copy.obj", "-o", "a.png", "--save-settings", "look.json")
    (tmp_path / "copy.obj").write_bytes(sphere.read_bytes() + b"# changed\n")
    done = render("copy.obj", "-o", "b.png", "--settings", "look.json")
    assert done.stderr.startswith("easypbr: warning: ") and "copy.obj is not the file" in done.stderr
    assert render("copy.obj", "-o", "b.png", "--settings", "look.json", "--quiet").stderr == ""


def test_timing_names_the_stages(render, sphere):
    line = render(sphere, "-o", "out.png", "--timing").stderr
    stages = dict(re.findall(r"(\w+) ([\d.]+) s", line))
    assert {"context", "load", "draw", "read", "write", "total"} <= stages.keys()
    assert 0 < float(stages["draw"]) <= float(stages["total"])


@pytest.mark.parametrize("options, message", [
    (("-o", "a.png", "--save-settings", "a.png"), "-o and --save-settings would both write a.png"),
    (("-o", "a.png", "--save-settings", "{folder}/./a.png"), "-o and --save-settings would both write"),
    (("-o", "a.png", "--save-settings", "here/a.png"), "-o and --save-settings would both write here/a.png"),
    (("-o", "a.exr", "--layers", "depth", "--save-settings", "a_depth.exr"), "--layers and --save-settings would both write"),
    (("-o", "a.png", "--layers", "depth,depth"), "--layers and --layers would both write"),
    (("-o", "{name}.exr", "--batch", "--layers", "depth"), "--layers and -o would both write"),
    (("-o", "f_%d.png", "--turntable", "2", "--save-settings", "f_0.png"), "-o and --save-settings would both write"),
    (("-o", "a.png", "--save-settings", "b.obj"), "--save-settings would write over b.obj, which FILE reads"),
    (("-o", "wood.png", "--texture", "base_color=wood.png"), "-o would write over wood.png, which a setting reads"),
])  # fmt: skip
def test_no_file_is_written_twice_and_none_that_is_read(render, box, tmp_path, options, message):
    for name in ("b.obj", "b_depth.obj"):
        (tmp_path / name).write_bytes(box.read_bytes())
    (tmp_path / "wood.png").touch()
    (tmp_path / "look.json").write_text('{"easypbr": 1, "settings": {}}')
    (tmp_path / "here").symlink_to(tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}
    options = [option.replace("{folder}", str(tmp_path)) for option in options]
    assert message in one_error(render("b.obj", "b_depth.obj", *options, code=2))
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()} == before


def test_settings_are_saved_where_they_were_read(render, box, tmp_path):
    render(box, "-o", "a.png", "--background", "#102030", "--save-settings", "look.json")
    render(box, "-o", "a.png", "--settings", "look.json", "--set", "tonemap.exposure=2", "--save-settings", "look.json")
    render(box, "-o", "b.png", "--settings", "look.json")
    assert png.read(tmp_path / "b.png")[0, 0].tolist() == [0x10, 0x20, 0x30, 255]
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


@pytest.mark.parametrize("output, code", [("missing/out.png", 1), ("out.xyz", 2), (".", 2)])
def test_output_is_checked_before_anything_is_read(render, tmp_path, output, code):
    message = one_error(render("not-there.obj", "-o", output, code=code))
    assert output in message and "not-there" not in message
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("size", ["0x600", "-4x3", "100000x100000", "99999999999999999999x3", "large", "800", "8.5x3",
                                  "800x600x3"])
def test_impossible_sizes_are_refused(render, sphere, tmp_path, size):
    assert size in one_error(render(sphere, "-o", "out.png", "--size", size, code=2))
    assert list(tmp_path.iterdir()) == []


def test_size_beyond_the_limit_is_refused(render, sphere, tmp_path):
    # Pictures are drawn in tiles up to the library's limit.
    assert "65536" in one_error(render(sphere, "-o", "out.png", "--size", "65537x16", code=2))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("option", [("--texture", "base_color=nowhere.png"), ("--env", "nowhere.png"),
                                    ("--background", "nowhere.png"), ("--settings", "nowhere.png"),
                                    ("--camera-pose", "nowhere.png")])
def test_missing_files_are_named(render, sphere, tmp_path, option):
    assert "nowhere.png" in one_error(render(sphere, "-o", "out.png", *option, code=1))
    assert list(tmp_path.iterdir()) == []


def test_pose_of_15_numbers_is_refused(render, sphere, tmp_path):
    (tmp_path / "pose.txt").write_text("1 " * 15)
    assert "16" in one_error(render(sphere, "-o", "out.png", "--camera-pose", "pose.txt", code=1))


def test_points_without_faces_are_drawn(render, tmp_path):
    (tmp_path / "cloud.ply").write_text("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                                        "property float z\nend_header\n0 0 0\n1 1 1\n")
    render("cloud.ply", "-o", "out.png")
    assert (tmp_path / "out.png").exists()


WRONG = [
    (("--sampels", "4"), "--samples"),
    (("--backgruond", "white"), "--background"),
    (("--set", "tonemap.exposur=1"), "tonemap.exposure"),
    (("--texture", "base_colour=x.png"), "base_color"),
    (("--layers", "albdo"), "albedo"),
    (("--tonemap", "acess"), "aces"),
]


@pytest.mark.parametrize("option, hint", WRONG)
def test_misspelt_names_get_a_hint(render, sphere, tmp_path, option, hint):
    assert f"did you mean '{hint}'" in one_error(render(sphere, "-o", "out.png", *option, code=2))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("options", [
    ("--roughness", "7"), ("--metallic", "shiny"), ("--color", "#12345"), ("--set", "nonsense"), ("--samples", "0"),
    ("--bit-depth", "12"), ("--flat", "--smooth"), ("--camera-axes", "blender"), ("--camera-axes", "opencv"),
    ("--size",), ("--background", "loud"),
    ("--camera-pose", "p.txt", "--camera-position", "1,2,3")])
def test_wrong_values_are_wrong_commands(render, sphere, tmp_path, options):
    one_error(render(sphere, "-o", "out.png", *options, code=2))
    assert list(tmp_path.iterdir()) == []


def test_files_and_output_are_required(easypbr, sphere):
    assert "FILE" in one_error(easypbr("render", "-o", "out.png", code=2))
    assert "-o" in one_error(easypbr("render", sphere, code=2))


def test_small_stacks_are_enough(environment, sphere, tmp_path):
    """A limit of 400 KiB, which is each thread's stack as well. What the library keeps for each thread is taken from there."""
    small = ["bash", "-c", 'ulimit -s 400; exec "$0" "$@"', BINARY, "render", sphere, "-o", "out.png", "--size", "64x48", "--samples", "1"]
    done = subprocess.run(small, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert png.read(tmp_path / "out.png").shape == (48, 64, 4)
