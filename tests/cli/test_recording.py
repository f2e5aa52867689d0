"""Recordings as FFmpeg and the stills see them: frame for frame."""
import contextlib
import json
import os
import resource
import signal
import subprocess
import time

import numpy as np
import pytest

import png
from binary import BINARY

SIZE = (96, 64)
LOOK = ("--size", "96x64", "--samples", "1", "--camera-position", "3,2,4", "--camera-target", "0,0,0")


def probe(path, *, count=True):
    """What ffprobe finds in the one stream of a video; its frames are counted by decoding them."""
    command = ["ffprobe", "-v", "error", "-show_streams", "-show_format", "-of", "json"]
    command += ["-count_frames"] if count else []
    done = subprocess.run([*command, path], capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    (stream,) = found["streams"]
    return {**stream, "file_duration": found["format"].get("duration")}


def luma_of_video(path, width, height):
    """The Y plane of every frame, as it is in the file."""
    command = ["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "yuv420p", "-"]
    raw = subprocess.run(command, capture_output=True, check=True).stdout
    frame = width * height * 3 // 2
    planes = np.frombuffer(raw, np.uint8).reshape(-1, frame)
    return planes[:, : width * height].reshape(-1, height, width).astype(float)


def luma(picture):
    """Y of BT.709 in limited range (ITU-R BT.709-6, items 3.2 and 3.4) of a picture's 8-bit values."""
    return 16 + 219 / 255 * (picture[..., :3].astype(float) @ [0.2126, 0.7152, 0.0722])


def psnr(a, b):
    return 10 * np.log10(255**2 / np.mean((a - b) ** 2))


def test_turntable_video_has_the_frames_of_the_stills(easypbr, render, box, tmp_path):
    render(box, "--turntable", "12", "--fps", "24", "-o", "a.mp4", *LOOK)
    render(box, "--turntable", "12", "--fps", "24", "-o", "f_%02d.png", *LOOK)
    found = probe(tmp_path / "a.mp4")
    assert (found["codec_name"], found["width"], found["height"]) == ("h264", *SIZE)
    assert (found["nb_frames"], found["nb_read_frames"]) == ("12", "12")
    assert found["r_frame_rate"] == "24/1" and found["pix_fmt"] == "yuv420p"
    assert float(found["file_duration"]) == pytest.approx(0.5, abs=1e-3) and float(found["start_time"]) == 0
    tags = [found[name] for name in ("color_range", "color_space", "color_primaries", "color_transfer")]
    assert tags == ["tv", "bt709", "bt709", "bt709"]
    planes = luma_of_video(tmp_path / "a.mp4", *SIZE)
    stills = [luma(png.read(tmp_path / f"f_{i:02}.png")) for i in range(12)]
    for i, still in enumerate(stills):
        assert psnr(planes[i], still) >= 38, i
    # The test above tells frames apart: the next one is another picture.
    assert psnr(planes[0], stills[1]) < 30


def test_odd_sizes_get_their_last_row_and_column_twice(render, box, tmp_path):
    render(box, "--turntable", "2", "-o", "odd.mp4", "--size", "51x33", "--samples", "1")
    render(box, "--turntable", "2", "-o", "odd_%d.png", "--size", "51x33", "--samples", "1")
    found = probe(tmp_path / "odd.mp4")
    assert (found["width"], found["height"]) == (52, 34)
    plane = luma_of_video(tmp_path / "odd.mp4", 52, 34)[0]
    still = np.pad(luma(png.read(tmp_path / "odd_0.png")), ((0, 1), (0, 1)), "edge")
    assert psnr(plane, still) >= 38


@pytest.mark.parametrize("name, codec", [("a.webm", "vp9"), ("a.gif", "gif"), ("a.mkv", "h264"), ("a.mov", "h264")])
def test_other_videos(render, box, tmp_path, name, codec):
    render(box, "--turntable", "10", "--fps", "25", "-o", name, *LOOK)
    found = probe(tmp_path / name)
    assert (found["codec_name"], found["width"], found["height"], found["nb_read_frames"]) == (codec, *SIZE, "10")
    assert float(found["file_duration"]) == pytest.approx(0.4, abs=0.03)


@pytest.mark.parametrize("codec, name", [("libx265", "hevc"), ("mpeg4", "mpeg4")])
def test_other_encoders_do_not_print(render, box, tmp_path, codec, name):
    there = subprocess.run(["ffmpeg", "-v", "error", "-encoders"], capture_output=True, text=True, check=True).stdout
    if f" {codec} " not in there:
        pytest.skip(f"left out: this FFmpeg has no {codec}")
    done = render(box, "--turntable", "3", "-o", "a.mp4", "--codec", codec, *LOOK)
    assert (done.stdout, done.stderr) == ("", "")
    assert (probe(tmp_path / "a.mp4")["codec_name"], probe(tmp_path / "a.mp4")["nb_read_frames"]) == (name, "3")


def test_gif_colours(render, box, tmp_path):
    """256 colours of their own for each frame and a dither of +- 5: the means agree within a step."""
    render(box, "--turntable", "2", "-o", "a.gif", *LOOK)
    render(box, "--turntable", "2", "-o", "f_%d.png", *LOOK)
    command = ["ffmpeg", "-v", "error", "-i", tmp_path / "a.gif", "-vsync", "passthrough", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    frames = np.frombuffer(subprocess.run(command, capture_output=True, check=True).stdout, np.uint8)
    frames = frames.reshape(2, SIZE[1], SIZE[0], 3).astype(float)
    for i in range(2):
        still = png.read(tmp_path / f"f_{i}.png")[..., :3].astype(float)
        assert np.abs(frames[i] - still).mean() < 6
        assert np.abs(frames[i].mean((0, 1)) - still.mean((0, 1))).max() < 1.5


def test_pictures_and_their_folder(render, box, tmp_path):
    render(box, "--turntable", "3", "-o", "out", *LOOK)
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [f"frame_{i:05}.png" for i in range(3)]
    render(box, "--turntable", "2", "-o", "out/f_%d.exr", *LOOK)
    assert (tmp_path / "out/f_1.exr").exists()


def test_older_pictures_behind_the_last_are_told(render, box, tmp_path):
    assert "older" not in render(box, "--turntable", "5", "-o", "out/f_%03d.png", *LOOK).stderr
    # Other names, and numbers that the pattern would write with zeros, are no frames of it.
    for name in ("f_07.png", "f_0009.png", "f_006.exr", "f_008_2.png", "f_.png", "g_009.png"):
        (tmp_path / "out" / name).touch()
    before = sorted(p.name for p in (tmp_path / "out").iterdir())
    told = render(box, "--turntable", "3", "-o", "out/f_%03d.png", *LOOK).stderr
    assert "2 older pictures are left behind the 3 of this recording (out/f_003.png to out/f_004.png)" in told
    told = render(box, "--turntable", "4", "-o", "out/f_%03d.png", *LOOK).stderr
    assert "1 older picture is left behind the 4 of this recording (out/f_004.png)" in told
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == before, "nothing is deleted"
    assert "older" not in render(box, "--turntable", "5", "-o", "out/f_%03d.png", *LOOK).stderr


def test_a_camera_path_hits_its_keys(render, box, tmp_path):
    """Frame 0 and the last frame are the stills at the first and the last key, bit for bit."""
    keys = [{"position": [3, 2, 4], "target": [0, 0, 0]}, {"position": [-3, 1, 4], "target": [0, 0.2, 0]}]
    (tmp_path / "path.json").write_text(json.dumps({"keys": keys, "segment_s": 0.2}))
    light = ("--exposure", "1", "--set", "lights.key.enabled=false", "--set", "lights.fill.enabled=false",
             "--set", "lights.rim.enabled=false")
    render(box, "--camera-path", "path.json", "--fps", "20", "-o", "p_%d.png", "--size", "96x64", *light)
    assert len(list(tmp_path.glob("p_*.png"))) == 5
    for number, key in ((0, keys[0]), (4, keys[1])):
        position, target = (",".join(map(str, key[name])) for name in ("position", "target"))
        render(box, "--camera-position", position, "--camera-target", target, "-o", "still.png", "--size", "96x64", *light)
        frame, still = png.read(tmp_path / f"p_{number}.png"), png.read(tmp_path / "still.png")
        # The path's quaternion is the look-at matrix but for its last bits.
        assert (np.abs(frame.astype(int) - still.astype(int)) > 0).mean() < 1e-3


@pytest.mark.parametrize(
    "arguments, message",
    [
        (("--turntable", "0", "-o", "a.mp4"), "expected at least one frame, got 0"),
        (("--turntable", "5", "--camera-path", "p.json", "-o", "a.mp4"), "exclude each other"),
        (("-o", "a.mp4"), "a video needs --turntable, --camera-path or --animation"),
        (("--fps", "30", "-o", "a.png"), "--fps needs --turntable, --camera-path or --animation"),
        (("--turntable", "5", "-o", "-"), "cannot go to standard output"),
        (("--turntable", "5", "-o", "a.mp4", "--layers", "depth"), "--layers are of one picture"),
        (("--turntable", "5", "-o", "a.png"), "one picture cannot hold many frames"),
        (("--turntable", "5", "-o", "out/f_%d.tga"), "cannot record to out/f_%d.tga: unknown extension 'tga'; expected"),
        (("--turntable", "5", "-o", "a.xyz"), "cannot record to a.xyz: unknown extension 'xyz'; expected"),
        (("--turntable", "5", "-o", "a.html"), "an HTML page is no recording"),
    ],
)
def test_wrong_commands(render, box, arguments, message):
    assert message in render(box, *arguments, code=2).stderr


@pytest.mark.parametrize(
    "arguments, message",
    [
        (("--turntable", "5", "-o", "a.mp4", "--codec", "betamax"), "no encoder 'betamax' for it; it has "),
        (("--turntable", "5", "-o", "no/such/folder/a.mp4"), "no/such/folder"),
        (("--turntable", "5", "-o", "a.mp4", "--background", "transparent"), "no transparency"),
        (("--camera-path", "none.json", "-o", "a.mp4"), "none.json"),
    ],
)
def test_what_cannot_be_recorded(render, box, tmp_path, arguments, message):
    assert message in render(box, *arguments, code=1).stderr
    assert not (tmp_path / "a.mp4").exists()


@pytest.fixture
def without_module(environment, tmp_path):
    """The program and its library alone, in a folder without the module: a command, and its environment."""
    folder = tmp_path / "alone"
    folder.mkdir()
    for file in (BINARY, *BINARY.parent.glob("libeasypbr.so*")):
        (folder / file.name).write_bytes(file.read_bytes())
        (folder / file.name).chmod(0o755)
    own = {**environment, "LD_LIBRARY_PATH": str(folder)}
    return folder / BINARY.name, own


def render_alone(without_module, folder, *arguments, code=0, **more):
    program, environment = without_module
    done = subprocess.run([program, "render", *arguments], cwd=folder, env={**environment, **more}, capture_output=True,
                          text=True, timeout=300)
    assert done.returncode == code, done.stderr
    return done


def test_an_ffmpeg_that_is_missing_is_named(without_module, box, tmp_path):
    """Neither the module nor a program: the message has both ways to get one."""
    done = render_alone(without_module, tmp_path, box, "--turntable", "2", "-o", "a.mp4", code=1, PATH=str(tmp_path))
    for part in ("libeasypbr_ffmpeg.so", "apt install ffmpeg", "pip install imageio-ffmpeg", "frame_%04d.png"):
        assert part in done.stderr
    assert not (tmp_path / "a.mp4").exists()


def test_the_program_writes_the_frames_of_the_stills(without_module, render, box, tmp_path):
    """Where the module is missing the program ffmpeg writes: the same frames, size and tags as the module's video."""
    look = ("--size", "51x33", *LOOK[2:])
    render_alone(without_module, tmp_path, box, "--turntable", "6", "--fps", "24", "-o", "a.mp4", *look)
    render(box, "--turntable", "6", "--fps", "24", "-o", "f_%d.png", *look)
    found = probe(tmp_path / "a.mp4")
    assert (found["codec_name"], found["width"], found["height"], found["nb_read_frames"]) == ("h264", 52, 34, "6")
    assert found["r_frame_rate"] == "24/1" and found["pix_fmt"] == "yuv420p"
    tags = [found[name] for name in ("color_range", "color_space", "color_primaries", "color_transfer")]
    assert tags == ["tv", "bt709", "bt709", "bt709"]
    planes = luma_of_video(tmp_path / "a.mp4", 52, 34)
    stills = [np.pad(luma(png.read(tmp_path / f"f_{i}.png")), ((0, 1), (0, 1)), "edge") for i in range(6)]
    for i, still in enumerate(stills):
        assert psnr(planes[i], still) >= 38, i
    assert psnr(planes[0], stills[1]) < 30


@pytest.mark.parametrize("name, codec", [("a.webm", "vp9"), ("a.gif", "gif"), ("a.mkv", "h264"), ("a.mov", "h264")])
def test_other_videos_of_the_program(without_module, box, tmp_path, name, codec):
    render_alone(without_module, tmp_path, box, "--turntable", "10", "--fps", "25", "-o", name, *LOOK)
    found = probe(tmp_path / name)
    assert (found["codec_name"], found["width"], found["height"], found["nb_read_frames"]) == (codec, *SIZE, "10")
    assert float(found["file_duration"]) == pytest.approx(0.4, abs=0.03)


def test_errors_of_the_program_are_ours(without_module, box, tmp_path):
    """A codec that it lacks, one that the container does not take, and a disk that is full: no file remains."""
    for codec, message in (("betamax", "no encoder 'betamax' for it; it has "), ("libvpx-vp9", "cannot write a.mov")):
        done = render_alone(without_module, tmp_path, box, "--turntable", "3", "-o", "a.mov", "--codec", codec, *LOOK, code=1)
        assert message in done.stderr
        assert not (tmp_path / "a.mov").exists()
    program, environment = without_module
    # In KiB: more than the list of encoders, which is read from a file in memory; less than 50 frames of this size take.
    limited = ["bash", "-c", 'ulimit -f 60; exec "$0" "$@"', program, "render", box, "--turntable", "50", "-o", "a.gif", *LOOK]
    done = subprocess.run(limited, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 1 and "cannot write a.gif" in done.stderr, done.stderr
    assert not (tmp_path / "a.gif").exists(), "half a video"


def test_a_program_that_does_not_work_is_named(without_module, box, tmp_path):
    (tmp_path / "ffmpeg").write_text("#!/bin/sh\nexit 3\n")
    (tmp_path / "ffmpeg").chmod(0o755)
    done = render_alone(without_module, tmp_path, box, "--turntable", "2", "-o", "a.mp4", code=1, PATH=f"{tmp_path}:/bin")
    assert f"{tmp_path}/ffmpeg does not work: it lists no encoders" in done.stderr


@contextlib.contextmanager
def running_recording(command, environment, growing):
    """Runs a recording until its file has grown, and kills it for good at the end of the block."""
    process = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
    try:
        deadline = time.monotonic() + 60
        while not growing.exists() or growing.stat().st_size < 60_000:
            assert time.monotonic() < deadline and process.poll() is None
            time.sleep(0.02)
        yield
        assert process.poll() is None
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()


def killed_recording(environment, box, folder, name, written=None):
    """Kills a recording for good while it runs; `written`: the file that grows."""
    command = [BINARY, "render", box, "--turntable", "2000", "-o", folder / name, *LOOK]
    with running_recording(command, environment, folder / (written or name)):
        pass


@pytest.mark.parametrize("name", ["a.mp4", "a.webm"])
def test_a_killed_recording_can_be_played(environment, box, tmp_path, name):
    killed_recording(environment, box, tmp_path, name)
    assert 20 < int(probe(tmp_path / name)["nb_read_frames"]) < 2000


def test_a_killed_recording_leaves_the_video_before(environment, box, tmp_path):
    (tmp_path / "a.mp4").write_bytes(b"the old one")
    killed_recording(environment, box, tmp_path, "a.mp4", "a.part.mp4")
    assert (tmp_path / "a.mp4").read_bytes() == b"the old one"
    assert 20 < int(probe(tmp_path / "a.part.mp4")["nb_read_frames"]) < 2000


@pytest.mark.parametrize("old", [False, True])
def test_a_program_of_its_own_records_meanwhile(easypbr, environment, box, tmp_path, old):
    """A new video that another process records is refused; one that is to be replaced has a file for each process."""
    part = tmp_path / ("a.part.mp4" if old else "a.mp4")
    if old:
        (tmp_path / "a.mp4").write_bytes(b"the old one")
    command = [BINARY, "render", box, "--turntable", "20000", "-o", tmp_path / "a.mp4", *LOOK]
    with running_recording(command, environment, part):
        done = easypbr("render", box, "--turntable", "5", "-o", "a.mp4", *LOOK, code=0 if old else 1)
        assert old or "cannot write a.mp4: it is being recorded" in done.stderr
    if old:
        assert probe(tmp_path / "a.mp4")["nb_read_frames"] == "5"
    assert 20 < int(probe(part)["nb_read_frames"]) < 20000
    # Nothing remains of the process that was killed but its file, which stays.
    left = part.read_bytes()
    easypbr("render", box, "--turntable", "3", "-o", "a.mp4", *LOOK)
    assert probe(tmp_path / "a.mp4")["nb_read_frames"] == "3"
    assert not old or part.read_bytes() == left
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted({"a.mp4", part.name})


def test_the_program_writes_a_file_of_its_own(without_module, box, tmp_path):
    """A file of each name that the recording would take stays, and none is written through a link."""
    part, link, target = (tmp_path / name for name in ("a.part.mp4", "a.part-2.mp4", "target"))
    for path in (tmp_path / "a.mp4", part, target):
        path.write_bytes(b"mine")
    link.symlink_to("target")
    render_alone(without_module, tmp_path, box, "--turntable", "4", "-o", "a.mp4", *LOOK)
    assert probe(tmp_path / "a.mp4")["nb_read_frames"] == "4"
    assert part.read_bytes() == target.read_bytes() == b"mine" and link.is_symlink()
    assert not (tmp_path / "a.part-3.mp4").exists()


def test_a_full_disk_is_an_error(environment, box, tmp_path):
    """The system's limit on a file's size stands for a full disk."""

    def small_files():
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # Python's processes ignore it; a shell's do not.
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

    for name in ("a.mp4", "f_%03d.png"):
        command = [BINARY, "render", box, "--turntable", "50", "-o", tmp_path / name, *LOOK]
        # The caches of the run must not be what fails.
        done = subprocess.run(command, capture_output=True, text=True, env=environment, preexec_fn=small_files)
        assert done.returncode == 1 and "cannot write" in done.stderr, done.stderr
    assert not list(tmp_path.glob("*.mp4")), "half a video"
    for picture in tmp_path.glob("f_*.png"):
        assert picture.stat().st_size > 2000 or png.read(picture).shape == (64, 96, 4)
