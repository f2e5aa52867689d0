import numpy as np
import pytest

from easypbr import Camera, Viewer, shapes, Scene


def test_look_at():
    camera = Camera.look_at((0, 0, 5), (0, 0, 0), fov_y_deg=40)
    # Looking along -z with y up is the identity rotation.
    expected = np.eye(4)
    expected[2, 3] = 5
    np.testing.assert_allclose(camera.T_world_cam, expected, atol=1e-12)
    assert camera.fov_y_deg == 40
    with pytest.raises(ValueError, match="position"):
        Camera.look_at((1, 1, 1), (1, 1, 1))
    with pytest.raises(ValueError, match="target: expected 3 numbers, got 2 int64"):
        Camera.look_at((1, 1, 1), (1, 1))


def test_opencv_round_trip():
    K = np.array([[500, 0, 320], [0, 510, 240], [0, 0, 1.0]])
    T = np.eye(4)
    T[:3, 3] = 1, 2, 3
    camera = Camera.from_opencv(K, T, (640, 480))
    np.testing.assert_allclose(camera.opencv_K((640, 480)), K, atol=1e-9)
    np.testing.assert_allclose(camera.opencv_T_world_cam, T, atol=1e-12)
    # OpenCV looks along +z with y down; OpenGL along -z with y up.
    np.testing.assert_allclose(camera.T_world_cam, T @ np.diag([1, -1, -1, 1]), atol=1e-12)
    with pytest.raises(ValueError, match="K: expected a 3 x 3 matrix"):
        Camera.from_opencv(np.eye(4), T, (640, 480))


@pytest.mark.parametrize("focal, size", [
    (60000, (640, 480)), (6000, (640, 40)), (9000, (9000, 16)), (300, (320, 1)), (3, (64, 640)),
])
def test_a_k_may_have_any_angle(focal, size):
    """The vertical angle is 0.46, 0.38, 0.1, 0.19 and 179 degrees: the setting camera.fov_y_deg takes 1 to 170."""
    width, height = size
    K = np.array([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1.0]])
    scene = Scene()
    # Seen along its normal, at a depth of 2 everywhere, and wider than any of the pictures but the last.
    wall = shapes.plane(40)
    wall.T_parent_mesh = [[1.0, 0, 0, 0], [0, 0, -1, 0], [0, -1, 0, 2], [0, 0, 0, 1]]
    scene.show(wall, "wall")
    view = Viewer((64, 48), scene=scene)
    view.camera = Camera.from_opencv(K, np.eye(4), size)
    fov_y_deg = 2 * np.degrees(np.arctan(height / 2 / focal))
    assert view.camera.fov_y_deg == pytest.approx(fov_y_deg)
    assert view.settings["camera.fov_y_deg"] == (1 if fov_y_deg < 1 else 170)
    assert view.render(samples=1).shape == (48, 64, 4)
    depth = view.render_layers(["depth"])["depth"]
    np.testing.assert_allclose(depth[24, 32], 2, rtol=1e-6)  # float32


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("shape", [(1, 5), (5, 1), (5,)])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_distortion_as_opencv_returns_it(shape, dtype):
    K, k = np.array([[100, 0, 16], [0, 100, 12], [0, 0, 1.0]]), [0.125, 0.25, 0, 0, 0.5]
    camera = Camera.from_opencv(K, np.eye(4), (32, 24), distortion=np.array(k, dtype).reshape(shape))
    assert camera.distortion == k  # Each is a float32.


@pytest.mark.parametrize("count", [12, 14])
def test_distortion_of_the_longer_models(count):
    K, k = np.array([[100, 0, 16], [0, 100, 12], [0, 0, 1.0]]), [0.1, 0.2, 0, 0, 0.3, 0.1, 0.2, 0.4]
    camera = Camera.from_opencv(K, np.eye(4), (32, 24), distortion=np.array([k + [0] * (count - 8)]))
    assert camera.distortion == k
    with pytest.raises(ValueError, match="expected 0 for the coefficients after the eighth: .*thin prisms.*tilted"):
        Camera.from_opencv(K, np.eye(4), (32, 24), distortion=k + [0] * (count - 9) + [0.1])
    with pytest.raises(ValueError, match="distortion: expected 4 .*got 12"):
        Camera.from_opencv(K, np.eye(4), (32, 24), distortion=[0.1] * 4 + [0] * 8, model="fisheye")


@pytest.mark.parametrize("wrong, message", [
    ([0.1] * 6, "expected 4, 5 or 8 .*got 6"), ("k1", "distortion: expected"), ({}, "distortion: expected"),
])
def test_what_is_no_distortion(wrong, message):
    with pytest.raises(ValueError, match=message):
        Camera.from_opencv(np.diag([100, 100, 1.0]), np.eye(4), (32, 24), distortion=wrong)


def test_from_opengl_refuses_what_is_no_pose():
    with pytest.raises(ValueError):
        Camera.from_opengl(np.diag([2, 1, 1, 1]))


def test_a_pinned_camera_is_used_and_read_back(size):
    Scene.show(shapes.plane(2), "plane")
    view = Viewer(size)
    # From (0, 3, 0) straight down, the plane's depth is 3 at every pixel that sees it.
    camera = Camera.look_at((0, 3, 0), (0, 0, 0), up=(0, 0, -1))
    view.camera = camera
    np.testing.assert_allclose(view.camera.T_world_cam, camera.T_world_cam, atol=1e-9)
    depth = view.layers("depth")["depth"]
    # float32 depth through one matrix product: a few units in the last place of 3.
    np.testing.assert_allclose(depth[depth > 0], 3, rtol=1e-5)
    assert depth[24, 32] > 0


@pytest.mark.parametrize(
    "wrong",
    [
        {"position": (5, 5, 5), "fov_y_deg": 500},
        {"position": (float("nan"), 0, 0)},
        {"azimuth_deg": 50, "margin": 44},
        {"position": (5, 5, 5), "target": (0, 0, 0), "up": (0, 0, 1), "fov_y_deg": 500},
        {"position": (5, 5, 5), "target": (5, 5, 5), "up": (0, 0, 1)},
        {"target": (0, 0, 0), "focal_point": (0, 0, 0)},
    ],
)
def test_what_is_no_camera_changes_nothing(wrong):
    view = Viewer(scene=Scene())
    view.camera = Camera.from_opencv(np.array([[500, 0, 320], [0, 510, 240], [0, 0, 1.0]]), np.eye(4), (640, 480))
    before = list(view.settings)
    with pytest.raises(ValueError):
        view.camera = wrong
    assert list(view.settings) == before


def test_an_up_vector_goes_with_other_values():
    view = Viewer(scene=Scene())
    view.camera = {"position": (0, 0, 5), "target": (0, 0, 0), "up": (1, 0, 0), "fov": 50, "near": 0.25}
    # Backwards is +z and up +x, so that right is up x backwards: -y.
    np.testing.assert_allclose(view.camera.T_world_cam[:3, :3], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-12)
    assert view.settings.camera.fov_y_deg == 50 and view.settings.camera.near == 0.25
