"""easypbr.compat.pyrender: cameras by their projection matrices, poses with a scale, and the names of pyrender's modules.
Expected pixels and depths are computed of the matrices, as OpenGL does: clip = P @ inv(pose) @ point."""

import importlib

import numpy as np
import pytest

import easypbr.compat.pyrender as pyrender
from easypbr.compat.pyrender import RenderFlags

POINTS = np.array([[0.1, 0.2, 0.0], [-0.3, 0.1, 0.5], [0.25, -0.35, -0.6]])


class WeakPerspectiveCamera(pyrender.Camera):
    """As VIBE, PARE and ROMP have it."""

    def __init__(self, scale, translation, znear=pyrender.camera.DEFAULT_Z_NEAR, zfar=None, name=None):
        super().__init__(znear=znear, zfar=zfar, name=name)
        self.scale, self.translation = scale, translation

    def get_projection_matrix(self, width=None, height=None):
        P = np.eye(4)
        P[0, 0], P[1, 1] = self.scale
        P[0, 3], P[1, 3] = self.translation[0] * self.scale[0], -self.translation[1] * self.scale[1]
        P[2, 2] = -1
        return P


class Shifted(pyrender.PerspectiveCamera):
    """A perspective camera whose matrix is changed."""

    def __init__(self, *places, **values):
        super().__init__(yfov=1.0, **values)
        self.places = places

    def get_projection_matrix(self, width=None, height=None):
        P = super().get_projection_matrix(width, height)
        for row, column, value in self.places:
            P[row, column] = value
        return P


def at(x, y, z):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def seen(camera, pose, point, size, flags=RenderFlags.DEPTH_ONLY):
    """Column and row of the middle of a point, and its depth."""
    scene = pyrender.Scene()
    node = scene.add(pyrender.Mesh.from_points([point]))
    scene.add(camera, pose=pose)
    renderer = pyrender.OffscreenRenderer(*size, point_size=5)
    depth = renderer.render(scene, flags=flags, seg_node_map={node: 1})
    renderer.delete()
    rows, columns = np.nonzero(depth)
    return columns.mean() + 0.5, rows.mean() + 0.5, depth.max()


def projected(camera, pose, point, size):
    """The same of the matrix, by pyrender's formula for depths."""
    x, y, z, w = camera.get_projection_matrix(*size) @ np.linalg.inv(pose) @ [*point, 1]
    near, far = camera.znear, camera.zfar
    depth = 2 * near / (1 - z / w) if far is None else 2 * near * far / (far + near - z / w * (far - near))
    return (x / w + 1) / 2 * size[0], (1 - y / w) / 2 * size[1], depth


def assert_projected(camera, pose, size=(96, 72), points=POINTS):
    for point in points:
        found, expected = seen(camera, pose, point, size), projected(camera, pose, point, size)
        # A point is a square of whole pixels.
        np.testing.assert_allclose(found[:2], expected[:2], atol=0.75)
        assert found[2] == pytest.approx(expected[2], rel=1e-4)  # float32 z, times how fast pyrender's depths change with it.


@pytest.mark.parametrize("size, scale", [
    ((72, 72), (0.8, 0.8)), ((96, 48), (0.4, 0.8)), ((72, 72), (0.4, 0.8)), ((72, 72), (0.9, 0.5)), ((96, 72), (-0.6, -0.8)),
])  # fmt: skip
@pytest.mark.parametrize("zfar", [None, 1000.0])
def test_weak_perspective_cameras_draw_what_their_matrix_says(size, scale, zfar):
    assert_projected(WeakPerspectiveCamera(scale, (0.3, -0.2), zfar=zfar), np.eye(4), size)
    turned = at(0.1, 0, -0.2)
    turned[:3, :3] = [[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]]
    assert_projected(WeakPerspectiveCamera(scale, (0.3, -0.2), zfar=zfar), turned, size)


def test_weak_perspective_cameras_see_from_their_near_to_their_far_plane():
    """z of VIBE's matrix is that of the node, turned: from one metre behind it to one before it."""
    scene = pyrender.Scene()
    node = scene.add(pyrender.Mesh.from_points([[0.0, 0, 0]]))
    scene.add(WeakPerspectiveCamera((1, 1), (0, 0)))
    renderer = pyrender.OffscreenRenderer(32, 32)
    is_seen = []
    for z in (1.1, 0.9, -0.9, -1.1):
        scene.set_pose(node, at(0, 0, z))
        is_seen.append(bool((renderer.render(scene, flags=RenderFlags.DEPTH_ONLY) > 0).any()))
    assert is_seen == [False, True, True, False]


def test_what_is_nearer_hides_what_is_farther_for_parallel_lines_of_sight():
    F = [[0, 1, 2], [0, 2, 3]]
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    scene = pyrender.Scene()
    near, far = (scene.add(pyrender.Mesh([pyrender.Primitive(corners, indices=F)]), pose=at(0, 0, z)) for z in (0.5, -0.5))
    scene.add(WeakPerspectiveCamera((0.5, 0.5), (0, 0)))
    renderer = pyrender.OffscreenRenderer(32, 32)
    segments, _ = renderer.render(scene, flags=RenderFlags.SEG, seg_node_map={near: 1, far: 2})
    assert segments[16, 16, 0] == 1


@pytest.mark.parametrize("camera", [
    Shifted((0, 2, 0.5)), Shifted((0, 2, -0.3), (1, 2, 0.2)), Shifted((0, 0, 0.7), (1, 1, 1.9)), Shifted((0, 3, 0.2)),
    Shifted((0, 2, 0.5), zfar=7.0), Shifted((2, 2, -1.1), (2, 3, -0.4)),
    pyrender.PerspectiveCamera(0.9, zfar=20.0), pyrender.PerspectiveCamera(0.9, aspectRatio=1.0),
    pyrender.IntrinsicsCamera(75, 70, 35, 27.3),
])  # fmt: skip
def test_perspective_cameras_draw_what_their_matrix_says(camera):
    assert_projected(camera, at(0.1, 0.1, 2))


def test_a_principal_point_of_one_half_is_on_the_left():
    """On the axis x = -P[0, 2]: column (1 - 0.5) / 2 of the image."""
    column, row, _ = seen(Shifted((0, 2, 0.5)), at(0, 0, 2), [0, 0, 0], (80, 60))
    assert (column, row) == (pytest.approx(20, abs=0.6), pytest.approx(30, abs=0.6))


def test_lines_are_where_points_are():
    camera = WeakPerspectiveCamera((0.8, 0.8), (0.1, 0.2))
    scene = pyrender.Scene()
    scene.add(pyrender.Mesh([pyrender.Primitive([[-0.4, 0.1, 0.3], [0.5, 0.1, 0.3]], mode=pyrender.GLTF.LINES)]))
    scene.add(camera)
    depth = pyrender.OffscreenRenderer(80, 80).render(scene, flags=RenderFlags.DEPTH_ONLY)
    left, right = (projected(camera, np.eye(4), [x, 0.1, 0.3], (80, 80)) for x in (-0.4, 0.5))
    columns, rows = np.nonzero(depth.T)
    assert (columns.min(), columns.max() + 1) == (pytest.approx(left[0], abs=1), pytest.approx(right[0], abs=1))
    assert set(rows) == {int(left[1])}
    np.testing.assert_allclose(depth[depth > 0], left[2], rtol=1e-4)


@pytest.mark.parametrize("camera, message", [
    (Shifted((0, 1, 0.5)), "expected a last row of"),
    (Shifted((3, 3, 1.0)), "expected a last row of"),
    (Shifted((3, 2, 1.0)), "expected a last row of"),
    (Shifted((0, 0, -1.0)), "a mirrored image"),
    (Shifted((2, 3, 0.5)), "a near plane before the camera"),
    (Shifted((0, 0, np.nan)), "4 x 4 finite numbers"),
])  # fmt: skip
def test_matrices_that_cannot_be_drawn_are_refused(camera, message):
    with pytest.raises(ValueError, match=r"Shifted.get_projection_matrix\(\): .*" + message):
        seen(camera, np.eye(4), [0, 0, -2], (32, 32))


@pytest.mark.parametrize("scale", [(0.02, 0.5), (0.5, 0.02), (1e-9, 1)])
def test_pixels_may_be_sixteen_times_as_long_as_wide(scale):
    """0.5 / 0.02 is 25: the image would be drawn with 25 times as many rows, or columns."""
    camera = WeakPerspectiveCamera(scale, (0, 0))
    message = r"WeakPerspectiveCamera.get_projection_matrix\(\): expected pixels at most 16 times as long as wide"
    with pytest.raises(ValueError, match=message):
        seen(camera, np.eye(4), [0, 0, 0], (32, 32))
    # Of a square of a metre 0.05 * 64 / 2 = 1.6 columns, centres of two of them, and 0.75 * 64 / 2 = 24 rows.
    scene = pyrender.Scene()
    corners = [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]
    scene.add(pyrender.Mesh([pyrender.Primitive(corners, indices=[[0, 1, 2], [0, 2, 3]])]))
    scene.add(WeakPerspectiveCamera((0.05, 0.75), (0, 0)))
    rows, columns = np.nonzero(pyrender.OffscreenRenderer(64, 64).render(scene, flags=RenderFlags.DEPTH_ONLY))
    assert (set(columns), set(rows)) == ({31, 32}, set(range(20, 44)))


# Names.


@pytest.mark.parametrize("value, channels, expected", [
    ([[0.5], [0.25]], 4, [[0.5, 1, 1, 1], [0.25, 1, 1, 1]]), ([[0.5, 0.25], [0, 1]], 3, [[0.5, 0.25, 1], [0, 1, 1]]),
    ([[255, 0, 51], [0, 0, 0]], 4, [[1, 0, 0.2, 1], [0, 0, 0, 1]]), ([0.5, 0.25, 0, 0.5], 3, [[0.5, 0.25, 0]] * 2),
    ([0.5], 2, [[0.5, 1]] * 2), (np.full((2, 6), 0.5), 5, np.full((2, 5), 0.5)),
])  # fmt: skip
def test_arrays_of_colors_are_filled_with_ones_and_cut(value, channels, expected):
    """As pyrender 0.1.45 does."""
    found = pyrender.utils.format_color_array(value, (2, channels))
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, np.float32(expected))


@pytest.mark.parametrize("value", [0.5, [[0.5] * 3] * 3, np.zeros((2, 2, 3))])
def test_arrays_of_colors_of_other_dimensions_are_refused(value):
    with pytest.raises(ValueError, match="^format_color_array: expected 2 rows"):
        pyrender.utils.format_color_array(value, (2, 4))


def test_modules_of_pyrender_are_there():
    expected = {
        "camera": "Camera PerspectiveCamera IntrinsicsCamera DEFAULT_Z_NEAR",
        "constants": "RenderFlags GLTF TextAlign DEFAULT_Z_FAR",
        "light": "Light SpotLight", "material": "Material MetallicRoughnessMaterial", "mesh": "Mesh", "node": "Node",
        "offscreen": "OffscreenRenderer", "primitive": "Primitive", "renderer": "Renderer",
        "sampler": "Sampler", "scene": "Scene", "texture": "Texture", "viewer": "Viewer",
        "utils": "format_color_vector format_color_array",
    }  # fmt: skip
    for name, words in expected.items():
        module = importlib.import_module(f"easypbr.compat.pyrender.{name}")
        assert getattr(pyrender, name) is module
        assert [word for word in words.split() if not hasattr(module, word)] == []
    assert pyrender.Renderer and pyrender.TextAlign.TOP_CENTER == 8 and pyrender.__version__ == "0.1.45"
    assert pyrender.utils.format_color_vector([255, 0, 51], 4).tolist() == [1, 0, 0.2, 1]


# Poses.


def rounded():
    """A turn of 0.7 about (1, 2, 3) in JSON with three decimals: off by 5e-4."""
    axis = np.array([1.0, 2, 3]) / np.sqrt(14)
    cross = np.cross(np.eye(3), -axis)
    pose = np.eye(4)
    pose[:3, :3] = np.round(np.eye(3) + np.sin(0.7) * cross + (1 - np.cos(0.7)) * cross @ cross, 3)
    return pose


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 2, 2), (0.5, 1, 2)])
@pytest.mark.parametrize("camera", [
    pyrender.PerspectiveCamera(1.0, zfar=40.0), pyrender.IntrinsicsCamera(75, 70, 35, 27.3),
    WeakPerspectiveCamera((0.5, 0.7), (0, 0)),
])  # fmt: skip
def test_poses_of_cameras_may_have_a_scale_and_be_rounded(camera, scale):
    """As in pyrender, whose view is the inverse of the pose, the scale counts, also for depths and planes."""
    pose = rounded() @ np.diag([*scale, 1.0])
    depth = 0.3 if isinstance(camera, WeakPerspectiveCamera) else 2.0
    for place in ([0.1, 0.2, -depth], [-0.4, 0.3, -1.2 * depth]):
        point = (pose @ [*place, 1])[:3]
        found, expected = seen(camera, pose, point, (96, 72)), projected(camera, pose, point, (96, 72))
        np.testing.assert_allclose(found[:2], expected[:2], atol=0.75)
        # Rounding shears the axes by up to 1e-3, which is left out.
        assert found[2] == pytest.approx(expected[2], rel=2e-3)


def test_depths_of_an_orthographic_camera_are_divided_by_the_scale():
    pose = np.diag([2.0, 2, 2, 1])
    column, row, depth = seen(pyrender.OrthographicCamera(1.0, 1.0), pose, [0.5, 0.5, -3], (72, 72))
    # Half a metre of the two that ymag = 1 sees from the middle to the side.
    assert (column, row, depth) == (pytest.approx(36 * 1.25, abs=0.6), pytest.approx(36 * 0.75, abs=0.6), pytest.approx(1.5))


@pytest.mark.parametrize("rows, message", [
    (np.diag([1.0, 1, 0]), "expected an invertible matrix"), (np.zeros((3, 3)), "expected an invertible matrix"),
    (np.diag([1.0, 1, -1]), "a reflection"), ([[1, 0.5, 0], [0, 1, 0], [0, 0, 1]], "expected axes at right angles"),
])  # fmt: skip
def test_poses_that_are_no_view_are_refused(rows, message):
    pose = np.eye(4)
    pose[:3, :3] = rows
    with pytest.raises(ValueError, match="a camera's pose: .*" + message):
        seen(pyrender.PerspectiveCamera(1.0), pose, [0, 0, -2], (32, 32))


def test_matrices_of_nodes_are_finite():
    with pytest.raises(ValueError, match="a Node's matrix: expected 4 x 4 finite numbers"):
        pyrender.Node(matrix=np.full((4, 4), np.nan))
