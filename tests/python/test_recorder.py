"""Camera paths, time and recordings from Python."""

import json
import subprocess
import sys
import threading

import numpy as np
import pytest

import easypbr
from easypbr import Camera, CameraPath, Scene, Viewer, load_image, shapes

LOOK = {"camera.position": (3, 2, 5), "camera.target": (0, 0, 0)}


@pytest.fixture
def view(size):
    scene = Scene()
    scene.show(shapes.box(), "box")
    view = Viewer(size, LOOK, scene=scene)
    view.settings.image.samples = 1
    return view


def frames_of(path) -> int:
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "json", path]
    (stream,) = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["streams"]
    return int(stream["nb_read_frames"])


def poses():
    T = np.tile(np.eye(4), (3, 1, 1))
    T[1, :3, 3] = 1, 2, 0
    T[2, :3, :3] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
    return T


def test_path_passes_through_its_keys():
    T = poses()
    for mode in ("smooth", "linear"):
        path = CameraPath(T, segment_s=[0.5, 2], mode=mode)
        assert path.duration_s == 2.5 and path.key_times_s == [0, 0.5, 2.5]
        for time, key in zip(path.key_times_s, T):
            np.testing.assert_allclose(path.pose(time), key, atol=1e-12)
        np.testing.assert_allclose(path.keys, T, atol=1e-15)
    assert len(path.frame_times(30)) == 76 and len(path.times(4)) == 4
    # Both ends, however short the path is.
    assert path.frame_times(0.1) == [0, 2.5]


def test_path_takes_opencv_poses_and_cameras():
    T = poses()
    opencv = CameraPath(T, axes="opencv")
    np.testing.assert_allclose(opencv.camera(0).opencv_T_world_cam, T[0], atol=1e-15)
    cameras = [Camera.look_at((0, 0, 5), (0, 0, 0), fov_y_deg=20), Camera.look_at((5, 0, 0), (0, 0, 0), fov_y_deg=60)]
    path = CameraPath(cameras, ease="in_out", closed=True)
    assert path.closed and path.duration_s == 2
    assert path.camera(0).fov_y_deg == pytest.approx(20) and path.camera(1).fov_y_deg == pytest.approx(60)
    assert CameraPath(T, fov_y_deg=44).camera(0.3).fov_y_deg == pytest.approx(44)
    assert CameraPath(T).camera(0.3, cameras[1]).fov_y_deg == 60


def test_path_through_calibrated_cameras_and_others():
    K = np.array([[150, 0, 40.0], [0, 100, 30], [0, 0, 1]])
    calibrated = Camera.from_opencv(K, np.diag([1.0, -1, -1, 1]), (320, 200))
    plain = Camera.look_at((1, 2, 3), (0, 0, 0), fov_y_deg=20)
    # tan(fov / 2) = 200 / 2 / 100; the pose between them gets the mean of the logarithms.
    path = CameraPath([calibrated, poses()[1], plain])
    assert path.camera(0).fov_y_deg == pytest.approx(90) and path.camera(2).fov_y_deg == pytest.approx(20)
    assert np.tan(np.radians(path.camera(1).fov_y_deg / 2)) == pytest.approx(np.sqrt(np.tan(np.radians(10))))
    alone = CameraPath([calibrated, calibrated])
    np.testing.assert_allclose(alone.camera(0.5, calibrated).opencv_K((320, 200)), K)
    flat = Camera.look_at((1, 2, 3), (0, 0, 0))
    flat.projection = "orthographic"
    with pytest.raises(ValueError, match="key 1 is orthographic and key 0 perspective"):
        CameraPath([plain, flat])
    assert CameraPath([plain, flat], fov_y_deg=40).camera(0.5).fov_y_deg == pytest.approx(40)


def test_path_files(tmp_path):
    path = CameraPath(poses(), fov_y_deg=[20, 30, 40])
    path.save(tmp_path / "path.json")
    np.testing.assert_allclose(CameraPath.load(tmp_path / "path.json").pose(0.7), path.pose(0.7), atol=1e-15)
    with pytest.raises(OSError, match="none.json"):
        CameraPath.load(tmp_path / "none.json")


@pytest.mark.parametrize(
    "keys, values, message",
    [
        ([], {}, "at least two keys, got 0"),
        ([np.eye(4)], {}, "at least two keys, got 1"),
        ([np.eye(4)] * 2, {"segment_s": 0}, "time above 0 seconds from key 0"),
        ([np.eye(4)] * 3, {"segment_s": [1]}, "segment_s: expected one number or 2, got 1"),
        ([np.eye(4), 2 * np.eye(4)], {}, "key 1: camera pose: expected a rotation"),
        ([np.eye(3)] * 2, {}, "key: expected a 4 x 4 matrix, got 3 x 3"),
        ([np.eye(4)] * 2, {"mode": "cubic"}, "mode: expected smooth or linear, got 'cubic'"),
        ([np.eye(4)] * 2, {"fov_y_deg": 0}, "between 0 and 180"),
    ],
)
def test_what_is_no_path(keys, values, message):
    with pytest.raises(ValueError, match=message):
        CameraPath(keys, **values)


@pytest.mark.parametrize("name", ["a.mp4", "a.webm", "a.gif", "a_%d.png", "folder/"])
def test_a_recording_without_frames_leaves_no_file(name, tmp_path, caplog):
    view = Viewer((32, 24), scene=Scene())
    view.recorder.start(f"{tmp_path}/{name}", fps=5)
    assert view.recorder.stop() == 0
    assert list(tmp_path.iterdir()) == []
    assert "no frame was added" in caplog.text


def test_path_as_a_shape():
    orbit = CameraPath.orbit(Camera.look_at((0, 0, 5), (0, 0, 0)), axis=(0, 1, 0))
    mesh = shapes.camera_path(orbit)
    assert len(mesh.children) == 12
    np.testing.assert_allclose(np.linalg.norm(mesh.V, axis=1), 5, rtol=1e-6)


def test_the_first_frame_of_a_turn_is_blurred_like_the_others(view, size, tmp_path):
    view.settings.motion_blur.enabled = True
    path, camera = view.turntable(1), view.camera
    times = path.times(6)
    view.recorder.record_path(path, tmp_path / "f_%d.png", frames=6, samples=8)
    stills = []
    for before in (times[-1], times[0]):
        view.camera = path.camera(before, camera)
        view.render(samples=1)
        view.camera = path.camera(times[0], camera)
        stills.append(view.render(samples=8))
    frame = load_image(tmp_path / "f_0.png")
    np.testing.assert_array_equal(frame, stills[0])
    assert (frame != stills[1]).any()


def test_record_path(view, size, tmp_path):
    before = view.camera.T_world_cam
    seen = []
    path = view.turntable(duration_s=0.2)
    count = view.recorder.record_path(path, tmp_path / "f_%d.png", fps=20, on_frame=lambda *values: seen.append(values))
    assert count == 4 and [number for number, _ in seen] == [0, 1, 2, 3]
    np.testing.assert_array_equal(view.camera.T_world_cam, before)
    for number, seconds in seen:
        view.camera = path.camera(seconds, view.camera)
        np.testing.assert_array_equal(load_image(tmp_path / f"f_{number}.png"), view.render())


def test_so_many_frames_last_as_long_as_the_path(view, tmp_path):
    times = []
    note = lambda *_: times.append(view.time)  # noqa: E731
    view.recorder.record_path(view.turntable(2), tmp_path / "a.gif", frames=8, samples=1, on_frame=note)
    assert frames_of(tmp_path / "a.gif") == 8 and times == [i / 4 for i in range(8)]
    view.time = 0
    view.recorder.record_path(view.turntable(2), tmp_path / "f_%d.png", fps=16, frames=2, samples=1, on_frame=note)
    assert times[8:] == [0, 1 / 16]


def test_time_makes_even_steps_while_recording(view, tmp_path):
    box = view.scene.get("box")
    assert view.time == 0 and view.delta_time == 0 and view.fixed_step is None
    times = []
    with view.recorder.start(tmp_path / "a.mp4", fps=8) as recorder:
        while view.time < 1:
            times.append(view.time)
            box.rotate_axis_angle((0, 1, 0), 90 * view.delta_time)
            recorder.add_frame()
        assert recorder.is_recording and recorder.frame_count == 8
    assert times == [i / 8 for i in range(8)] and view.fixed_step is None
    assert frames_of(tmp_path / "a.mp4") == 8 and not view.recorder.is_recording
    view.time = 3
    view.fixed_step = 0.5
    assert view.time == 3
    with pytest.raises(ValueError, match="above 0 seconds"):
        view.fixed_step = 0


def test_recordings_are_the_same_every_time(view, tmp_path):
    """What moves by view.time is where it was in the other recording."""
    box = view.scene.get("box")
    for name in ("a", "b"):
        box.T_parent_mesh = np.eye(4)
        view.time = 0
        with view.recorder.start(tmp_path / name) as recorder:
            for _ in range(3):
                box.rotate_axis_angle((1, 1, 0), 400 * view.delta_time)
                recorder.add_frame()
    for frame in range(3):
        first, second = (load_image(tmp_path / name / f"frame_{frame:05}.png") for name in "ab")
        np.testing.assert_array_equal(first, second)


def test_an_exception_loses_no_frame(view, tmp_path):
    with pytest.raises(ZeroDivisionError):
        with view.recorder.start(tmp_path / "a.mp4") as recorder:
            for i in range(5):
                recorder.add_frame()
            1 / 0  # noqa: B018
    assert frames_of(tmp_path / "a.mp4") == 5

    def fail(number, seconds):
        if number == 3:
            raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        view.recorder.record_path(view.turntable(1), tmp_path / "b.mp4", on_frame=fail)
    assert frames_of(tmp_path / "b.mp4") == 3 and not view.recorder.is_recording


def test_pictures_of_ones_own_are_frames(view, size, tmp_path):
    with view.recorder.start(tmp_path / "own_%d.png"):
        for value in (0, 128, 255):
            view.recorder.add_frame(np.full((size[1], size[0], 3), value, np.uint8))
    assert [load_image(tmp_path / f"own_{i}.png")[0, 0, 0] for i in range(3)] == [0, 128, 255]
    with pytest.raises(ValueError, match="nothing is being recorded"):
        view.recorder.add_frame()
    with view.recorder.start(tmp_path / "a.mp4"):
        view.recorder.add_frame()
        with pytest.raises(ValueError, match="expected frames of 64x48, got 3x2"):
            view.recorder.add_frame(np.zeros((2, 3, 3), np.uint8))
        with pytest.raises(ValueError, match=r"a\.mp4 is being recorded"):
            view.recorder.start(tmp_path / "b.mp4")
        assert view.recorder.is_recording


class InterruptedStart:
    """A viewer's handle with which Ctrl-C comes during start_recording(): Python raises when the call is over."""

    def __init__(self, handle):
        self.handle = handle

    def __getattr__(self, name):
        return getattr(self.handle, name)

    def start_recording(self, *values):
        self.handle.start_recording(*values)
        raise KeyboardInterrupt


def test_an_interrupted_start_records_nothing(view, tmp_path):
    recorder, handle = view.recorder, view.recorder._handle
    path = view.turntable(1)
    for start in (lambda: recorder.start(tmp_path / "a.mp4"), lambda: recorder.record_path(path, tmp_path / "a.mp4", frames=2)):
        recorder._handle = InterruptedStart(handle)
        with pytest.raises(KeyboardInterrupt):
            start()
        recorder._handle = handle
        assert not recorder.is_recording and view.fixed_step is None and list(tmp_path.iterdir()) == []
    assert recorder.record_path(path, tmp_path / "a.mp4", frames=2) == 2


@pytest.mark.parametrize("ending", ["", "del view, recorder", "raise SystemExit(0)"])
def test_the_end_of_a_program_finishes_its_recording(tmp_path, ending):
    program = f"""
import gc
from easypbr import *
scene = Scene()
scene.show(shapes.box(), "box")
view = Viewer((64, 48), scene=scene)
view.settings.image.samples = 1
recorder = view.recorder.start({str(tmp_path / "a.mp4")!r})
for _ in range(6):
    recorder.add_frame()
{ending}
"""
    subprocess.run([sys.executable, "-c", program], check=True, timeout=120)
    assert frames_of(tmp_path / "a.mp4") == 6


def test_viewers_record_on_several_threads(tmp_path):
    failures = []

    def record(number):
        try:
            scene = Scene()
            scene.show(shapes.sphere(1, 16), "sphere")
            view = Viewer((48, 32), scene=scene)
            view.recorder.record_path(view.turntable(0.2), tmp_path / f"{number}.mp4", samples=1)
        except Exception as error:  # noqa: BLE001
            failures.append(error)

    threads = [threading.Thread(target=record, args=(i,)) for i in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures
    assert [frames_of(tmp_path / f"{i}.mp4") for i in range(3)] == [6, 6, 6]


def test_image_plane_shows_its_pixels(size):
    """A picture in front of an orthographic camera that it fills is that picture, past exposure and tone curve."""
    rng = np.random.default_rng(1)
    image = rng.integers(0, 256, (6, 8, 3), dtype=np.uint8).repeat(8, 0).repeat(8, 1)
    scene = Scene()
    plane = scene.show(shapes.image_plane(image), "image")
    assert np.ptp(plane.V, axis=0) == pytest.approx([64 / 48, 1, 0])
    view = Viewer(size, scene=scene)
    camera = Camera.look_at((0, 0, 2), (0, 0, 0))
    camera.projection, camera.ortho_height = "orthographic", 1
    view.camera = camera
    shown = view.render(samples=1)[..., :3].astype(int)
    # Blocks of 8 x 8 pixels: their middles are no edges, which anti-aliasing softens.
    middles = np.s_[3::8, 3::8]
    assert np.abs(shown[middles] - image[middles].astype(int)).max() <= 1
    assert shapes.image_plane(image, height=2).bounding_box()[1] == pytest.approx([64 / 48, 1, 0])
    with pytest.raises(ValueError, match="width and height above 0"):
        shapes.image_plane(image, width=0)
