"""The other commands, and the command line itself."""
import shapes
import json
import os
import re
import struct
import subprocess
import zlib

import numpy as np
import pytest

from binary import BINARY
import exr
import png


@pytest.mark.parametrize("command, message", [
    ("render a.obj -o a.png --size 0x0", "0x0"),
    ("render a.obj -o a.png --size 65536x65536", "65536x65536"),
    ("render a.obj -o a.png --turntable 3 --fps 0", "--fps: expected a number above 0, got 0"),
    ("render a.obj -o a.png --turntable 3 --fps nan", "--fps: expected a number above 0, got nan"),
    ("render a.obj -o a.html --orbit 0x0", "expected 1 to 360 columns, got 0"),
    ("render a.obj -o a.html --page-limit 0", "got a limit of 0"),
    ("render a.obj -o a.png --size 32x24 --focus 48,36", "expected a pixel of the picture of 32x24, got (48, 36)"),
    ("render a.obj -o a.png --preset darkk", "did you mean 'dark'"),
    ("render a.obj -o a.png --label-map foo", "there is no label map 'foo'"),
    ("render a.obj -o a.png --device foo", "there is no device 'foo'; expected auto, gl or cpu"),
    ("view a.obj --screenshot a.png --preset darkk", "did you mean 'dark'"),
    ("view a.obj --screenshot a.png --size 0x9", "0x9"),
    ("view a.obj --screenshot a.png --ui-scale 0", "scale"),
    ("demo -o a.png --samples 0", "image.samples"),
    ("demo -o a.png --size 0x0", "0x0"),
    ("serve a.obj --preset darkk", "did you mean 'dark'"),
    ("serve a.obj --port 65536", "expected 0 to 65535, got 65536"),
    ("serve a.obj --max-clients 0", "expected 1 to 1000, got 0"),
    ("serve a.obj --own-views 65", "expected 0 to 64, got 65"),
    ("serve a.obj --bind foo", "bind 'foo': expected an address"),
    ("serve a.obj --origin foo", "origin 'foo'"),
])  # fmt: skip
def test_values_that_options_alone_show_to_be_wrong_exit_with_2(easypbr, tmp_path, command, message):
    shapes.write_box(tmp_path / "a.obj")
    (line,) = easypbr(*command.split(), code=2).stderr.splitlines()
    assert line.startswith("easypbr: error: ") and message in line
    assert [path.name for path in tmp_path.iterdir()] == ["a.obj"]


@pytest.mark.parametrize("command, message", [
    ("cache --limit -1", "--limit: expected a number of 0 or more, got '-1'"),
    ("cache --limit nan", "--limit: expected a number of 0 or more, got 'nan'"),
    ("compare a.png b.png --max-difference -1", "--max-difference: expected a number of 0 or more, got '-1'"),
    ("compare a.png b.png --max-difference nan", "--max-difference: expected a number of 0 or more, got 'nan'"),
    ("render a.obj --bit-depth abc", "--bit-depth: expected 8 or 16, got 'abc'"),
    ("render a.obj --hidden-lines dash", "--hidden-lines: expected none, dashed or solid, got 'dash' (did you mean 'dashed'?)"),
    ("render a.obj --size 4x4 --size 5x5", "--size: expected it once, got it 2 times: 4x4, 5x5"),
    ("render a.obj --layers ,", "--layers: expected A,B, got nothing"),
    ("render a.obj --fps abc", "--fps: expected a number, got 'abc'"),
    ("render a.obj --turntable 1.5", "--turntable: expected a whole number, got '1.5'"),
    ("render a.obj --quiet=loud", "--quiet: expected no value, got 'loud'"),
    ("convert a.obj b.ply --crop-box 1,2,3", "--crop-box: expected 6 values, got 3"),
    ("convert a.obj b.ply --voxelize abc", "--voxelize: expected a number, got 'abc'"),
    ("render a.obj --device cpu --device gl", "--device: expected it once, got it 2 times: cpu, gl"),
])  # fmt: skip
def test_what_an_option_is_given_wrongly_is_told_in_words(easypbr, command, message):
    assert easypbr(*command.split(), code=2).stderr == f"easypbr: error: {message} (see 'easypbr --help')\n"


def test_version_and_help_go_to_standard_output(easypbr):
    assert easypbr("--version").stdout.startswith("easypbr 0.")
    assert "render" in easypbr("--help").stdout
    assert "--env-rotation" in easypbr("render", "--help").stdout


@pytest.mark.parametrize("arguments, hint", [((), "render"), (("rendr", "a.ply"), "did you mean 'render'"),
                                             (("info", "a", "b"), "'b'"), (("doctor", "--jsn"), "--jsn")])
def test_wrong_commands_exit_with_2(easypbr, arguments, hint):
    done = easypbr(*arguments, code=2)
    assert hint in done.stderr and done.stderr.count("\n") == 1 and done.stdout == ""


def test_options_end_at_two_dashes(easypbr, box, tmp_path):
    """Behind them a name may begin with a dash."""
    (tmp_path / "-dash.obj").write_bytes(box.read_bytes())
    easypbr("render", "-o", "out.png", "--size", "32x24", "--", "-dash.obj")
    assert png.read(tmp_path / "out.png").shape[:2] == (24, 32)
    assert json.loads(easypbr("info", "--json", "--", "-dash.obj").stdout)["faces"] == 12
    assert json.loads(easypbr("info", "--json", box, "--").stdout)["faces"] == 12
    easypbr("convert", "--", "-dash.obj", "-copy.ply")
    assert (tmp_path / "-copy.ply").exists()


def test_what_follows_two_dashes_is_no_option(easypbr, box):
    assert "doctor: unexpected argument 'now'" in easypbr("doctor", "--", "now", code=2).stderr
    assert "unknown option '--jsn'" in easypbr("info", "--jsn", "--", box, code=2).stderr


def test_info_counts_a_mesh(easypbr, box):
    info = json.loads(easypbr("info", "--json", box).stdout)
    assert info["faces"] == 12 and info["nodes"] == 1 and "uv" in info["attributes"]
    assert info["bounds"] == {"min": [-1, -1, -1], "max": [1, 1, 1]}
    assert "faces       12\n" in easypbr("info", box).stdout


def test_info_names_scalars(easypbr, tmp_path):
    """As --style scalar=NAME takes them; quarters are exact in float32 and in text."""
    (tmp_path / "a.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property float heat\nelement face 2\nproperty list uchar int vertex_indices\nproperty float area\nend_header\n"
        "0 0 0 -1.5\n1 0 0 nan\n1 1 0 2.25\n0 1 0 inf\n3 0 1 2 0.5\n3 0 2 3 nan\n"
    )
    info = json.loads(easypbr("info", "--json", "a.ply").stdout)
    assert info["scalars"] == [{"name": "area", "of": "faces", "min": 0.5, "max": 0.5},
                               {"name": "heat", "of": "vertices", "min": -1.5, "max": 2.25}]
    text = easypbr("info", "a.ply").stdout
    assert "scalar      'area' of faces: 0.5 to 0.5\n" in text and "scalar      'heat' of vertices: -1.5 to 2.25\n" in text
    (tmp_path / "b.ply").write_text((tmp_path / "a.ply").read_text().replace("0.5", "nan"))
    assert "scalar      'area' of faces: no values\n" in easypbr("info", "b.ply").stdout


def test_info_shows_places_far_from_zero(easypbr, tmp_path):
    (tmp_path / "far.xyz").write_text("691000.125 5335000.5 520.25\n691100.375 5335100.75 530.5\n")
    text = easypbr("info", "far.xyz").stdout
    assert "bounds      (691000.125, 5335000.5, 520.25) to (691100.375, 5335100.75, 530.5)\n" in text
    assert "attributes  none\n" in text


def test_info_describes_an_image(easypbr, tmp_path):
    exr.write(tmp_path / "a.exr", np.zeros((3, 5, 3), np.float32))
    info = json.loads(easypbr("info", "--json", "a.exr").stdout)
    assert info == {"width": 5, "height": 3, "channels": 3, "type": "f32"}


@pytest.mark.parametrize("extension", ["ply", "obj", "glb"])
def test_convert_keeps_a_mesh(easypbr, box, tmp_path, extension):
    easypbr("convert", box, f"copy.{extension}")
    info = json.loads(easypbr("info", "--json", f"copy.{extension}").stdout)
    assert info["faces"] == 12 and info["bounds"] == {"min": [-1, -1, -1], "max": [1, 1, 1]}


def test_convert_encodes_images(easypbr, tmp_path):
    exr.write(tmp_path / "a.exr", np.full((2, 2, 3), 0.2140411, np.float32))
    easypbr("convert", "a.exr", "a.png")
    # sRGB of 0.2140411 is 0.5, between codes 127 and 128.
    assert png.read(tmp_path / "a.png")[0, 0, 0] in (127, 128)


def test_an_unknown_extension_of_a_picture_is_a_wrong_command(easypbr, tmp_path):
    for out in ("x.foo", "missing/x"):
        message = easypbr("render", "no_file.obj", "-o", out, code=2).stderr
        assert f"cannot write {out}: unknown extension" in message and "expected one of png" in message
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("out, code", [("copy.step", 2), ("missing/copy.ply", 1)])
def test_convert_refuses_what_cannot_be_written(easypbr, box, tmp_path, out, code):
    assert out in easypbr("convert", box, out, code=code).stderr
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def two_images(easypbr, tmp_path):
    for name, value in (("a", 100), ("b", 103)):
        linear = ((value / 255 + 0.055) / 1.055) ** 2.4
        exr.write(tmp_path / f"{name}.exr", np.full((2, 2, 3), linear, np.float32))
        easypbr("convert", f"{name}.exr", f"{name}.png")


def test_help_names_layers_that_exist(easypbr, box):
    text = " ".join(easypbr("render", "--help").stdout.split())
    named = re.search(r"OUT_LAYER\.exr for each of ([\w, ]+), \.\.\.", text)[1].replace(" ", "")
    easypbr("render", box, "-o", "a.png", "--size", "8x8", "--samples", "1", "--layers", named)


def test_compare_equal_images(easypbr, two_images):
    assert easypbr("compare", "a.png", "a.png").stdout.startswith("max 0, mean 0, rmse 0, psnr inf dB")


def test_compare_different_images(easypbr, two_images):
    done = easypbr("compare", "a.png", "b.png", code=1)
    # Every channel differs by 3: psnr = 20 log10(255 / 3) = 38.59.
    assert done.stdout.startswith("max 3, mean 3, rmse 3, psnr 38.59 dB, 4 of 4 pixels")
    assert done.stderr.startswith("easypbr: error: ")
    easypbr("compare", "a.png", "b.png", "--max-difference", "3")
    easypbr("compare", "a.png", "b.png", "--max-difference", "2.9", code=1)


def write_pixel(path, kind, *codes):
    """A PNG of one pixel: colour type and codes of 8 bits."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", 1, 1, 8, kind, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(bytes((0, *codes)))) + chunk(b"IEND", b""))  # fmt: skip


# Colour types: 2 RGB, 4 grey with alpha.
def test_compare_sees_alpha_of_grey_pictures(easypbr, tmp_path):
    write_pixel(tmp_path / "rgb.png", 2, 100, 100, 100)
    for alpha in (255, 250):
        write_pixel(tmp_path / "grey.png", 4, 100, alpha)
        for pair in (("rgb.png", "grey.png"), ("grey.png", "rgb.png")):
            done = easypbr("compare", *pair, code=int(alpha != 255))
            assert done.stdout.startswith(f"max {255 - alpha},")


def test_compare_refuses_other_sizes(easypbr, two_images, tmp_path):
    exr.write(tmp_path / "c.exr", np.zeros((3, 2, 3), np.float32))
    easypbr("convert", "c.exr", "c.png")
    assert "2x3" in easypbr("compare", "a.png", "c.png", code=1).stderr
    easypbr("compare", "a.png", code=2)


def test_doctor_says_what_it_found(easypbr, environment):
    out = easypbr("doctor").stdout
    for part in ("easypbr", "works", "renderer", "OpenGL", environment["EASYPBR_CACHE_DIR"], "writable", "assimp", "Draco"):
        assert part in out


def test_without_a_driver_the_attempts_are_listed(environment, sphere, tmp_path):
    """An EGL without vendors stands for a machine without a driver."""
    bare = {**environment, "__EGL_VENDOR_LIBRARY_FILENAMES": "/dev/null", "EASYPBR_DEVICE": "gl"}
    for command in (["doctor"], ["render", str(sphere), "-o", "out.png"]):
        done = subprocess.run([str(BINARY), *command], capture_output=True, text=True, env=bare, cwd=tmp_path,
                              timeout=60)
        assert done.returncode == 1 and done.stderr.count("\n") == 1
        assert "easypbr: error: no OpenGL 4.5 context" in done.stderr and "Install" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def without_opengl(environment, tmp_path_factory):
    """Libraries that are no libraries stand for a machine without OpenGL."""
    folder = tmp_path_factory.mktemp("libraries")
    for name in ("libEGL.so.1", "libGL.so.1", "libOpenGL.so.0"):
        (folder / name).touch()
    environment = {**environment, "LD_LIBRARY_PATH": str(folder)}
    environment.pop("EASYPBR_DEVICE", None)

    def run(*command):
        return subprocess.run([str(BINARY), *map(str, command)], capture_output=True, text=True, env=environment,
                              timeout=300)

    return run


def test_without_opengl_the_cpu_draws(without_opengl, easypbr, sphere, box, tmp_path):
    """A picture with everything that is native is the one that is drawn beside OpenGL, byte for byte."""
    options = ("--size", "64x48", "--set", "ground.mode=shadow", "--set", "ssao.enabled=true", "--samples", 3)
    done = without_opengl("render", sphere, box, "-o", tmp_path / "without.png", *options)
    assert done.returncode == 0, done.stderr
    easypbr("render", sphere, box, "-o", "with.png", *options)
    assert (tmp_path / "without.png").read_bytes() == (tmp_path / "with.png").read_bytes()


def test_without_opengl_clouds_colour_bars_effects_and_lines_are_drawn(without_opengl, easypbr, sphere, tmp_path):
    cloud = tmp_path / "cloud.xyz"
    cloud.write_text("".join(f"{i % 20} {i // 20} {i % 7}\n" for i in range(400)))
    effects = [f"{name}.enabled=true" for name in ("bloom", "outline", "depth_of_field")]
    heights = ["style.color_by=height", "annotation.colorbar=true"]
    occlusion, lines = ["ssao.enabled=true"], ["style.show_wireframe=true", "style.line_dash=3"]
    layers, coat = [*lines, "material.opacity=0.5", "ground.mode=shadow"], ["material.clearcoat=1", "path.enabled=false"]
    easypbr("render", sphere, "-o", "backdrop.png", "--size", "13x9")
    backdrop = ["background.mode=image", f"background.image={tmp_path / 'backdrop.png'}"]
    mist = ["material.opacity=0.5", "style.overlay=true", "style.show_wireframe=true", "path.enabled=false"]
    glass = ["material.transmission=1", "material.thickness=1", "material.roughness=0.2", "path.enabled=false"]
    pictures = (([cloud], []), ([cloud], heights), ([cloud], occlusion), ([sphere], effects), ([sphere], lines),
                ([sphere], layers), ([sphere], coat), ([sphere], glass),
                ([sphere], mist), ([sphere], backdrop))
    for files, settings in pictures:
        options = ["--size", "64x48", *(word for setting in settings for word in ("--set", setting))]
        done = without_opengl("render", *files, "-o", tmp_path / "without.png", *options)
        assert done.returncode == 0, done.stderr
        easypbr("render", *files, "-o", "with.png", *options)
        assert (tmp_path / "without.png").read_bytes() == (tmp_path / "with.png").read_bytes()


def test_without_opengl_errors_name_the_pass_and_what_to_install(without_opengl, sphere, tmp_path):
    stripes = tmp_path / "stripes.glsl"
    stripes.write_text("void surface(inout Surface s) { s.base_color = vec3(1.0, 0.0, 0.0); }\n")
    done = without_opengl("render", sphere, "-o", tmp_path / "out.png", "--shader", stripes)
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert "geometry: this needs OpenGL" in done.stderr and "Install" in done.stderr
    assert not (tmp_path / "out.png").exists()
    done = without_opengl("render", sphere, "-o", tmp_path / "out.png", "--device", "gl")
    assert done.returncode == 1 and "libEGL.so.1 is not installed" in done.stderr


def test_without_opengl_glass_and_clearcoat_are_path_traced(without_opengl, easypbr, sphere, tmp_path):
    settings = ("--size", "64x48", "--set", "material.transmission=1", "--set", "material.clearcoat=1")
    done = without_opengl("render", sphere, "-o", tmp_path / "without.png", *settings)
    assert done.returncode == 0, done.stderr
    easypbr("render", sphere, "-o", "with.png", *settings)
    assert (tmp_path / "without.png").read_bytes() == (tmp_path / "with.png").read_bytes()


def test_without_opengl_the_cpu_records(without_opengl, easypbr, box, tmp_path):
    """The frames of a turntable, which are those that OpenGL draws: up to rounding, and edges that either may cover."""
    turn = ("render", box, "--turntable", "3", "--size", "64x48", "--samples", "2")
    done = without_opengl(*turn, "-o", tmp_path / "cpu_%d.png")
    assert done.returncode == 0, done.stderr
    easypbr(*turn, "-o", "gl_%d.png", "--device", "gl")
    frames = [[png.read(tmp_path / f"{device}_{i}.png").astype(int) for i in range(3)] for device in ("cpu", "gl")]
    for i in range(3):
        difference = np.abs(frames[0][i] - frames[1][i]).max(axis=2)
        assert (difference > 1).mean() < 0.01, i
    assert np.abs(frames[0][0] - frames[0][1]).max() > 20, "it turns"


def test_doctor_says_that_opengl_is_not_there(without_opengl):
    done = without_opengl("doctor")
    assert done.returncode == 0
    assert "device      cpu" in done.stdout and "OpenGL      not there" in done.stdout


def test_devices_are_chosen_by_name(easypbr, environment, sphere):
    for place in (("--device", "cpu", "render"), ("render", "--device", "gl")):
        easypbr(*place, sphere, "-o", "out.png", "--size", "16x16")
    assert "expected auto, gl or cpu" in easypbr("render", sphere, "-o", "x.png", "--device", "cpuu", code=2).stderr
    environment["EASYPBR_DEVICE"] = "fast"
    try:
        assert "expected auto, gl or cpu" in easypbr("render", sphere, "-o", "x.png", code=1).stderr
    finally:
        del environment["EASYPBR_DEVICE"]


@pytest.mark.parametrize("name, value, message", [
    ("EASYPBR_DEVICE", "gpu", "EASYPBR_DEVICE: there is no device 'gpu'; expected auto, gl or cpu"),
    ("EASYPBR_THREADS", "abc", "EASYPBR_THREADS: expected a whole number of 1 or more, got 'abc'"),
    ("EASYPBR_THREADS", "-1", "EASYPBR_THREADS: expected a whole number of 1 or more, got '-1'"),
    ("EASYPBR_THREADS", "1.5", "EASYPBR_THREADS: expected a whole number of 1 or more, got '1.5'"),
    ("EASYPBR_CACHE_LIMIT", "1GB", "EASYPBR_CACHE_LIMIT: expected a number of GB, 0 or more, got '1GB'"),
])  # fmt: skip
def test_wrong_variables_are_errors(easypbr, environment, sphere, tmp_path, monkeypatch, name, value, message):
    """And empty ones are as if they were not set."""
    draw = ("render", sphere, "-o", "out.png", "--size", "64x48", "--mode", "raster")
    monkeypatch.setitem(environment, name, value)
    (line,) = easypbr(*draw, code=1).stderr.splitlines()
    assert line.startswith("easypbr: error: ") and message in line
    assert list(tmp_path.iterdir()) == []
    monkeypatch.setitem(environment, name, "")
    easypbr(*draw)


def test_view_says_when_there_is_no_display(easypbr, environment, tmp_path):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        environment.pop(name, None)
    shapes.write_box(tmp_path / "a.obj")
    assert "no window" in easypbr("view", "a.obj", code=1).stderr


def test_view_makes_a_screenshot_without_a_display(easypbr, environment, tmp_path):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        environment.pop(name, None)
    shapes.write_box(tmp_path / "a.obj")
    easypbr("view", "a.obj", "--size", "320x200", "--set", "image.samples=1", "--screenshot", "window.png")
    assert easypbr("info", "window.png").stdout.count("320")
    assert "'bmp'" in easypbr("view", "a.obj", "--screenshot", "window.bmp", code=1).stderr
    assert "missing.ply" in easypbr("view", "missing.ply", "--screenshot", "window.png", code=1).stderr


def test_demo_writes_a_picture_and_says_where(easypbr, tmp_path):
    out = easypbr("demo", "-o", "demo.png", "--size", "160x90").stdout
    assert os.fspath(tmp_path / "demo.png") in out and "draw" in out
    assert png.read(tmp_path / "demo.png").shape == (90, 160, 4)


def test_demo_never_writes_what_it_cannot(easypbr, tmp_path):
    easypbr("demo", "-o", "missing/demo.png", code=1)
    easypbr("demo", "-o", "demo.png", "--size", "0x0", code=2)
    assert list(tmp_path.iterdir()) == []


def test_data_sets_need_no_variable_in_a_built_tree(easypbr, environment, tmp_path, monkeypatch):
    monkeypatch.delitem(environment, "EASYPBR_PYTHON", raising=False)
    monkeypatch.setitem(environment, "PATH", "/usr/bin:/bin")  # Whose Python has no package of ours.
    easypbr("dataset", "--demo", "-o", "drones", "--count", "1", "--workers", "1", "--writers", "coco", "--quiet")
    assert (tmp_path / "drones/records/000000.json").exists()


def test_traced_paths_need_no_filtered_environment(environment, box, tmp_path):
    """The cache holds filtered environments: path tracing makes none, the split sum of a rasterised image one."""
    cache = tmp_path / "cache"
    for mode, entries in (("path", 0), ("raster", 1)):
        subprocess.run([BINARY, "render", box, "-o", "out.png", "--size", "32x24", "--mode", mode.upper()], check=True, cwd=tmp_path,
                       env={**environment, "EASYPBR_CACHE_DIR": str(cache)})
        assert len(list(cache.glob("*"))) == entries, mode


def test_cache_shows_its_entries_and_drops_the_oldest(environment, box, tmp_path):
    """An entry is 4.2 MB: six faces of 4 half floats at each size, the first 256 (gpu/prefilter.h)."""
    cache = tmp_path / "cache"
    bounded = {**environment, "EASYPBR_CACHE_DIR": str(cache), "EASYPBR_CACHE_LIMIT": "0.009"}

    def run(*arguments):
        done = subprocess.run([BINARY, *map(str, arguments)], capture_output=True, text=True, env=bounded, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        return dict(line.split(None, 1) for line in done.stdout.splitlines())

    assert run("cache") == {"folder": str(cache), "entries": "0", "size": "0.0 MB", "limit": "9.0 MB"}
    kept = []
    for value in (0.2, 0.4, 0.6):
        exr.write(tmp_path / "map.exr", np.full((4, 8, 3), value, np.float32))
        before = set(cache.glob("*")) if cache.exists() else set()
        run("render", box, "-o", "out.png", "--env", "map.exr", "--size", "16x16", "--samples", "1")
        (added,) = set(cache.glob("*")) - before
        kept = [*kept[-1:], added]
        assert set(cache.glob("*")) == set(kept), "the one that was used last is left, and the new one"
    assert run("cache")["entries"] == "2" and run("cache")["size"] == "8.4 MB"
    assert run("cache", "--limit", "0.005")["entries"] == "1"
    assert list(cache.iterdir()) == [added]
    (cache / "notes.txt").write_text("kept")
    assert run("cache", "--clear") == {}
    assert [path.name for path in cache.iterdir()] == ["notes.txt"]


def test_cache_refuses_what_it_cannot_do(easypbr):
    assert "--limit" in easypbr("cache", "--limit", "-1", code=2).stderr
    assert "--clear" in easypbr("cache", "--limit", "1", "--clear", code=2).stderr
