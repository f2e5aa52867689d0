"""Animations of glTF files from the command line."""
import base64
import json

import numpy as np
import pytest

import png

LOOK = ("--camera-position", "3,2,6", "--camera-target", "0,0,0", "--exposure", "1", "--preset", "dark")


@pytest.fixture
def moving(tmp_path):
    """A triangle that goes from x = 0 to x = 1 in half a second."""
    positions = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], "<f4")
    data = positions.tobytes() + np.array([0, 0.5], "<f4").tobytes() + np.array([0, 0, 0, 1, 0, 0], "<f4").tobytes()
    views = [(0, 36), (36, 8), (44, 24)]
    kinds = [(3, "VEC3"), (2, "SCALAR"), (2, "VEC3")]
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    (tmp_path / "moving.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "animations": [{"name": "go", "samplers": [{"input": 1, "output": 2}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
        "accessors": [{"bufferView": i, "componentType": 5126, "count": count, "type": kind}
                      for i, (count, kind) in enumerate(kinds)],
        "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": length} for start, length in views],
        "buffers": [{"byteLength": len(data), "uri": uri}],
    }))
    return tmp_path / "moving.gltf"


def test_a_still_shows_the_animation_at_a_time(render, moving, tmp_path):
    for time in (0, 0.25):
        render(moving, "--animation", "go", "--animation-time", time, "-o", f"{time}.png", *LOOK)
    rest, moved = (np.abs(png.read(tmp_path / name)[..., :3].astype(int) - 64).max(2) > 8 for name in ("0.png", "0.25.png"))
    # The triangle has gone by half a unit: to the right.
    assert np.argwhere(moved)[:, 1].mean() > np.argwhere(rest)[:, 1].mean() + 2


def test_a_recording_plays_it(render, moving, tmp_path):
    """Frame k is the still k / fps later, bit for bit, with the camera at rest."""
    pose = np.eye(4)
    pose[2, 3] = 6
    (tmp_path / "rest.json").write_text(json.dumps({"keys": [pose.tolist()] * 2, "segment_s": 0.2, "mode": "linear"}))
    look = ("--exposure", "1", "--set", "lights.key.enabled=false", "--set", "lights.fill.enabled=false", "--set",
            "lights.rim.enabled=false", "--set", "camera.near=0.1")
    render(moving, "--animation", "0", "--camera-path", "rest.json", "--fps", "10", "-o", "f_%d.png", *look)
    (tmp_path / "pose.txt").write_text(" ".join(map(str, pose.ravel())))
    for frame in range(3):
        render(moving, "--animation", "0", "--animation-time", frame / 10, "--camera-pose", "pose.txt", "-o", "s.png", *look)
        np.testing.assert_array_equal(png.read(tmp_path / f"f_{frame}.png"), png.read(tmp_path / "s.png"))
    assert (png.read(tmp_path / "f_0.png") != png.read(tmp_path / "f_2.png")).any()


def test_a_still_is_blurred_like_a_frame_of_a_recording(render, moving, tmp_path):
    """Its shutter was open since the frame before, which is 1 / fps ago, whatever a single still is drawn after."""
    pose = np.eye(4)
    pose[2, 3] = 6
    (tmp_path / "rest.json").write_text(json.dumps({"keys": [pose.tolist()] * 2, "segment_s": 0.2, "mode": "linear"}))
    (tmp_path / "pose.txt").write_text(" ".join(map(str, pose.ravel())))
    look = ("--animation", "0", "--fps", "10", "--samples", "8", "--exposure", "1", "--set", "camera.near=0.1", "--set",
            "lights.key.enabled=false", "--set", "lights.fill.enabled=false", "--set", "lights.rim.enabled=false")
    blurred = ("--set", "motion_blur.enabled=true", "--set", "motion_blur.shutter=1")
    render(moving, "--camera-path", "rest.json", "-o", "f_%d.png", *look, *blurred)
    still = ("--animation-time", "0.2", "--camera-pose", "pose.txt", *look)
    render(moving, "-o", "blurred.png", *still, *blurred)
    render(moving, "-o", "sharp.png", *still)
    np.testing.assert_array_equal(png.read(tmp_path / "f_2.png"), png.read(tmp_path / "blurred.png"))
    assert (png.read(tmp_path / "blurred.png") != png.read(tmp_path / "sharp.png")).any()
    # At its beginning the animation has not moved yet; it does not come from its end.
    render(moving, "-o", "first.png", "--animation-time", "0", "--camera-pose", "pose.txt", *look, *blurred)
    render(moving, "-o", "rest.png", "--animation-time", "0", "--camera-pose", "pose.txt", *look)
    np.testing.assert_array_equal(png.read(tmp_path / "first.png"), png.read(tmp_path / "rest.png"))


def test_where_it_goes_around_nothing_is_blurred_across(render, moving, tmp_path):
    """0.5 s at 10 frames a second: frame 6 of a longer recording is frame 1 again; it came from the beginning."""
    pose = np.eye(4)
    pose[2, 3] = 6
    (tmp_path / "rest.json").write_text(json.dumps({"keys": [pose.tolist()] * 2, "segment_s": 0.8, "mode": "linear"}))
    look = ("--animation", "0", "--fps", "10", "--samples", "8", "--exposure", "1", "--set", "camera.near=0.1", "--set",
            "lights.key.enabled=false", "--set", "lights.fill.enabled=false", "--set", "lights.rim.enabled=false", "--set",
            "motion_blur.enabled=true", "--set", "motion_blur.shutter=1")
    render(moving, "--camera-path", "rest.json", "-o", "f_%d.png", *look)
    # Poses before are found by subtraction: they differ in the last bits of a double, pictures by rounding.
    first, again = (png.read(tmp_path / f"f_{i}.png").astype(int) for i in (1, 6))
    assert np.abs(first - again).max() <= 1
    # Before its beginning an animation goes around as well: the shutter is as long as elsewhere.
    (tmp_path / "pose.txt").write_text(" ".join(map(str, pose.ravel())))
    for time in (-0.1, 0.4):
        render(moving, "-o", f"t{time}.png", "--animation-time", time, "--camera-pose", "pose.txt", *look)
    assert np.abs(png.read(tmp_path / "t-0.1.png").astype(int) - png.read(tmp_path / "t0.4.png")).max() <= 1


@pytest.fixture
def moving_camera(moving):
    """The same file with a camera and a lamp, six units before the triangle, that go with it."""
    file = json.loads(moving.read_text())
    file["nodes"] += [{"name": "eye", "camera": 0, "translation": [0, 0, 6], "extensions": {"KHR_lights_punctual": {"light": 0}}}]
    file["nodes"][0]["children"] = [1]
    file["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}]
    file["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 200}]}}
    moving.write_text(json.dumps(file))
    return moving


LIT = ("--exposure", "1", "--set", "lights.key.enabled=false", "--set", "lights.fill.enabled=false", "--set",
       "lights.rim.enabled=false", "--preset", "dark", "--mode", "raster")


def test_cameras_and_lights_go_with_it(render, moving_camera, tmp_path):
    """What the camera and its lamp go with stays in the same place of the picture, equally lit; seen from afar it does not."""
    for time in (0, 0.25):
        render(moving_camera, "--animation", "go", "--animation-time", time, "--camera", "eye", "-o", f"{time}.png", *LIT)
    rest, moved = (png.read(tmp_path / name)[..., :3].astype(int) for name in ("0.png", "0.25.png"))
    assert rest.max() > 40
    np.testing.assert_allclose(rest, moved, atol=1)
    for time in (0, 0.25):
        render(moving_camera, "--animation", "go", "--animation-time", time, "--camera-position", "0,0,6", "--camera-target",
               "0,0,0", "-o", f"far {time}.png", *LIT)
    assert (png.read(tmp_path / "far 0.png") != png.read(tmp_path / "far 0.25.png")).any()


def test_info_names_them(easypbr, moving_camera):
    info = json.loads(easypbr("info", "--json", moving_camera).stdout)
    assert info["animations"] == [{"name": "go", "duration_s": 0.5}]
    assert info["camera_names"] == ["eye"] and len(info["light_names"]) == info["lights"] == 1
    text = easypbr("info", moving_camera).stdout
    assert "animation   'go': 0.5 s\n" in text and "cameras     1: eye\n" in text


def test_an_animation_alone_is_recorded(render, moving_camera, tmp_path):
    """Half a second at 10 frames a second, once around; each frame is the still of its time."""
    render(moving_camera, "--animation", "go", "--camera", "0", "--fps", "10", "-o", "f_%d.png", *LIT)
    assert sorted(path.name for path in tmp_path.glob("f_*.png")) == [f"f_{i}.png" for i in range(5)]
    render(moving_camera, "--animation", "go", "--camera", "0", "--animation-time", 0.3, "-o", "s.png", *LIT)
    np.testing.assert_array_equal(png.read(tmp_path / "f_3.png"), png.read(tmp_path / "s.png"))
    # Without a camera of the file that of the first frame stays.
    render(moving_camera, "--animation", "go", "--fps", "10", "-o", "r_%d.png", *LIT)
    assert (png.read(tmp_path / "r_0.png") != png.read(tmp_path / "r_4.png")).any()


def send(moving, place):
    """Lets the triangle, bright from both sides, go to another place in its half second."""
    file = json.loads(moving.read_text())
    file["materials"] = [{"doubleSided": True, "emissiveFactor": [1, 1, 1]}]
    file["meshes"][0]["primitives"][0]["material"] = 0
    head = "data:application/octet-stream;base64,"
    data = bytearray(base64.b64decode(file["buffers"][0]["uri"][len(head):]))
    data[44:68] = np.array([0, 0, 0, *place], "<f4").tobytes()
    file["buffers"][0]["uri"] = head + base64.b64encode(data).decode()
    moving.write_text(json.dumps(file))


def whole_areas(folder, pattern, count):
    """Pixels of the triangle in each of the pictures; it reaches no picture's border."""
    areas = []
    for i in range(count):
        picture = png.read(folder / (pattern % i))[..., :3].astype(int)
        seen = np.abs(picture - 64).max(2) > 8
        assert not (seen[0].any() or seen[-1].any() or seen[:, 0].any() or seen[:, -1].any()), i
        areas.append(seen.sum())
    return areas


NO_GROUND = ("--exposure", "1", "--preset", "dark", "--set", "ground.mode=none")


def test_the_automatic_camera_shows_all_of_a_recording(render, moving, tmp_path):
    """A triangle that goes five of its widths to the right: it is in all pictures whole, at no picture's border."""
    send(moving, (10, 0, 0))
    render(moving, "--animation", "go", "--fps", "10", "-o", "f_%d.png", "--exposure", "1", "--preset", "dark")
    areas = whole_areas(tmp_path, "f_%d.png", 5)
    assert min(areas) > 0
    # It is seen from 30 degrees to the side: it comes nearer by half of its way, from about three times that to twice.
    assert max(areas) < 6 * min(areas)


@pytest.mark.parametrize("frames", [5, 76])
def test_a_turntable_shows_all_of_a_recording(render, moving, tmp_path, frames):
    """The triangle rises by five of its heights. It is seen whole from all sides, in a turn too in which it does so fifteen
    times: sixteen moments evenly over the 7.5 s to its last frame would be the same pose."""
    send(moving, (0, 10, 0))
    render(moving, "--animation", "go", "--fps", "10", "--turntable", frames, "-o", "f_%d.png", *NO_GROUND)
    areas = whole_areas(tmp_path, "f_%d.png", frames)
    # From 30 degrees to the side on in fifths of a turn: none of these is edge-on.
    assert min(areas[:: frames // 5]) > 0


def test_a_turntable_without_perspective_shows_all_of_a_recording(render, moving, tmp_path):
    """What rises stays in the picture: its height is that of an image of all poses."""
    send(moving, (0, 10, 0))
    render(moving, "--animation", "go", "--fps", "10", "--turntable", "5", "-o", "f_%d.png", *NO_GROUND, "--ortho", "auto",
           "--set", "camera.margin=0.2")
    assert min(whole_areas(tmp_path, "f_%d.png", 5)) > 0


@pytest.mark.parametrize("recording", [(), ("--turntable", "5")])
def test_the_ground_rests_below_what_falls(render, moving, tmp_path, recording):
    """The triangle of 2 x 2 falls by 8 until the last frame: its lowest point is at -9, and the ground the usual gap of 5e-5 of
    its diagonal below that, in all frames as if that height were given."""
    send(moving, (0, -10, 0))
    look = ("--animation", "go", "--fps", "10", *recording, "--camera-position", "6,2,12", "--camera-target", "0,-5,0",
            "--exposure", "1", "--set", "ground.mode=plane", "--set", "ground.radius=30")
    render(moving, "-o", "f_%d.png", "--save-settings", "after.json", *look)
    for name, lowest in (("g", -9), ("h", -1)):
        height = lowest - 5e-5 * np.sqrt(8)
        render(moving, "-o", f"{name}_%d.png", *look, "--set", f"ground.height={height!r}")
    for i in range(5):
        frame, given, high = (png.read(tmp_path / f"{name}_{i}.png").astype(int) for name in "fgh")
        # The heights differ in the last bits of a double: roundings may differ.
        assert np.abs(frame - given).max() <= 1, i
        # The ground given below the first pose is another: what is given counts.
        assert np.abs(frame - high).max() > 8, i
    # The height was that of the recording alone.
    assert json.loads((tmp_path / "after.json").read_text())["settings"]["ground"]["height"] == "auto"


@pytest.mark.parametrize("folder", ["out", "out/"])
def test_an_animation_alone_is_recorded_to_a_folder(render, moving, tmp_path, folder):
    render(moving, "--animation", "go", "--fps", "4", "-o", folder, *LOOK)
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["frame_00000.png", "frame_00001.png"]
    # Standard output takes one picture.
    still = render(moving, "--animation", "go", "-o", "-", *LOOK, text=False).stdout
    assert still.startswith(b"\x89PNG")


def test_what_is_not_there(render, moving, box):
    assert "there is no animation 'og'" in render(moving, "--animation", "og", "-o", "a.png", code=1).stderr
    assert "the files hold no animations" in render(box, "--animation", "go", "-o", "a.png", code=1).stderr
    arguments = ("--animation", "go", "--fps", "0", "-o", "a.png")
    assert "--fps: expected a number above 0" in render(moving, *arguments, code=2).stderr
    assert "--animation-time needs --animation" in render(moving, "--animation-time", "1", "-o", "a.png", code=2).stderr
