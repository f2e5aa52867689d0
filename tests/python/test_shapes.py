import numpy as np
import pytest

import easypbr
from easypbr import Camera, Mesh, shapes

NAN = float("nan")


@pytest.mark.parametrize("make, bounds", [
    (lambda: shapes.sphere(2), (2, 2, 2)),
    (lambda: shapes.icosphere(2, 4), (2, 2, 2)),
    (lambda: shapes.box(2), (1, 1, 1)),
    (lambda: shapes.box((1, 2, 3)), (0.5, 1, 1.5)),
    (lambda: shapes.plane(4, divisions=3), (2, 0, 2)),
    (lambda: shapes.grid(4, 3), (2, 0, 2)),
    (lambda: shapes.cylinder(1, 4), (1, 2, 1)),
    (lambda: shapes.cone(1, 4), (1, 2, 1)),
    (lambda: shapes.torus(2, 0.5), (2.5, 0.5, 2.5)),
    (lambda: shapes.capsule(1, 4), (1, 3, 1)),
])
def test_shapes_have_their_size(make, bounds):
    V = make().V
    # Round ones touch their bounds in a vertex (64 segments are a multiple of four); an icosphere's vertices do to a
    # hundredth of its radius.
    np.testing.assert_allclose(V.max(axis=0), bounds, atol=0.01 * max(bounds))
    np.testing.assert_allclose(V.min(axis=0), -np.array(bounds), atol=0.01 * max(bounds))


def test_arrow_and_axes():
    arrow = shapes.arrow((1, 0, 0), (1, 0, 3), radius=0.1)
    np.testing.assert_allclose(arrow.V.max(axis=0), (1.25, 0.25, 3), atol=1e-6)
    axes = shapes.axes(2)
    for axis in range(3):
        assert axes.C[axes.V[:, axis].argmax()].argmax() == axis


def test_arrows_of_a_field():
    starts = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]])
    vectors = np.array([[0, 3, 0], [0, 0, 0], [0, 0, 1.0]])
    arrows = shapes.arrows(starts, vectors, scale=1, radius=0.1, segments=8, values=[5, 6, 7], colors=np.eye(3))
    # 7 rings of 8; the vector of length 0 has no arrow. The first vertex of each is its tip.
    assert len(arrows.V) == 2 * 56
    np.testing.assert_allclose(arrows.V[[0, 56]], [[0, 3, 0], [2, 0, 1]], atol=1e-6)
    assert arrows.scalars["length"][[0, 111]].tolist() == [3, 1]
    assert arrows.scalars["value"][[0, 111]].tolist() == [5, 7]
    assert arrows.C[[0, 111]].tolist() == [[1, 0, 0], [0, 0, 1]]
    # Neighbours are 2 apart, which is more than a fiftieth of it.
    np.testing.assert_allclose(shapes.arrows(starts, vectors).V[0], [0, 2, 0], atol=1e-6)


def test_arrows_far_from_zero_keep_their_place():
    starts = np.array([[500000.25, 5400000.5, 100], [500001.25, 5400000.5, 100]])
    arrows = shapes.arrows(starts, [[0.125, 0, 0], [0, 0.125, 0]], scale=1)
    tips = arrows.V[[0, 7 * 12]].astype(np.float64) + arrows.offset
    # The offset is whole, so that the local coordinates are below 1024: float32 has them to 2^-14.
    np.testing.assert_allclose(tips, starts + [[0.125, 0, 0], [0, 0.125, 0]], atol=1e-4)


def test_arrows_leave_out_what_is_not_finite(caplog):
    starts, vectors = np.zeros((3, 3)), np.ones((3, 3))
    starts[1, 2] = NAN
    assert len(shapes.arrows(starts, vectors).V) == 2 * 84
    assert "1 of 3 arrows have no finite start and vector and are left out" in caplog.text
    with pytest.raises(easypbr.ArgumentError, match="in row 1 of 3"):
        shapes.arrows(starts, vectors, strict=True)
    assert len(shapes.arrows(np.zeros((0, 3)), np.zeros((0, 3))).V) == 0


@pytest.mark.parametrize("starts, vectors, options, message", [
    ([[0, 0]], [[1, 1, 1]], {}, "arrows: starts: expected n x 3, got 1 x 2 int64"),
    ([[0, 0, 0]], [1, 1, 1], {}, "arrows: vectors: expected n x 3, got 3 int64"),
    ([[0, 0, 0]], np.ones((2, 3)), {}, "arrows: vectors: expected one for each of 1 starts, got 2"),
    ([[0, 0, 0]], [[1, 1, 1]], {"scale": -1}, "arrows: scale: expected a number > 0, got -1"),
    ([[0, 0, 0]], [[1, 1, 1]], {"values": [1, 2]}, "arrows: values: expected one for each of 1 starts, got 2"),
])
def test_fields_that_do_not_fit_raise(starts, vectors, options, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        shapes.arrows(starts, vectors, **options)


@pytest.mark.parametrize("call", [
    lambda: shapes.sphere(0),
    lambda: shapes.icosphere(1, 11),
    lambda: shapes.box((1, 2)),
    lambda: shapes.box((1, 2, -1)),
    lambda: shapes.cylinder(NAN),
    lambda: shapes.cone(height=0),
    lambda: shapes.torus(1, 2),
    lambda: shapes.capsule(segments=1),
    lambda: shapes.arrow((0, 0, 0), (0, 0, 0)),
    lambda: shapes.arrow((0, 0, NAN), (0, 0, 1)),
    lambda: shapes.axes(-1),
    lambda: shapes.grid(divisions=0),
])
def test_impossible_shapes_raise(call):
    with pytest.raises(easypbr.ArgumentError):
        call()


def test_camera_frustum_of_a_camera_or_of_opencv():
    image = np.zeros((48, 64, 3), np.uint8)
    camera = Camera.look_at((0, 0, 5), (0, 0, 0))
    frustum = shapes.camera_frustum(camera, image, depth=2)
    assert len(frustum.E) == 10 and len(frustum.F) == 0
    np.testing.assert_allclose(frustum.T_parent_mesh, camera.T_world_cam)
    np.testing.assert_array_equal(frustum.children[0].material.base_color_texture, image)
    # Half of the full vertical angle of 30 degrees, two units away.
    assert frustum.V[6, 1] == pytest.approx(2 * np.tan(np.radians(15)), abs=1e-6)
    assert frustum.V[6, 0] == pytest.approx(frustum.V[6, 1] * 64 / 48, abs=1e-6)

    K = np.array([[100, 0, 31.5], [0, 100, 23.5], [0, 0, 1.0]])
    T_world_cam = np.eye(4)
    T_world_cam[:3, 3] = 1, 2, 3
    for given in (dict(image=image), dict(size=(64, 48))):
        frustum = shapes.camera_frustum((K, T_world_cam), **given)
        corner = frustum.T_parent_mesh @ [*frustum.V[5], 1]
        # OpenCV's lower right corner: x = 32 / 100 to the right, 24 / 100 down, 1 forward.
        np.testing.assert_allclose(corner[:3], (1.32, 2.24, 4), atol=1e-6)
    assert len(shapes.camera_frustum(Camera.from_opencv(K, T_world_cam, (64, 48))).children) == 0


def test_camera_frustum_says_what_is_missing():
    with pytest.raises(easypbr.ArgumentError, match="expected a size"):
        shapes.camera_frustum(Camera())
    with pytest.raises(easypbr.ArgumentError, match="expected a size"):
        shapes.camera_frustum((np.eye(3), np.eye(4)))
    with pytest.raises(easypbr.ArgumentError, match="expected a Camera or"):
        shapes.camera_frustum("camera")
    with pytest.raises(easypbr.ArgumentError, match="depth"):
        shapes.camera_frustum(Camera(), size=(4, 4), depth=NAN)


class OfDlpack:
    """An array of another library with nothing but DLPack."""

    def __init__(self, array):
        self._array = array

    def __dlpack_device__(self):
        return self._array.__dlpack_device__()

    def __dlpack__(self, **_):
        return self._array.__dlpack__()


def test_images_of_other_libraries():
    image, lens = np.zeros((48, 64, 3), np.uint8), (np.eye(3), np.eye(4))
    of_numpy, of_other = (shapes.camera_frustum(lens, given) for given in (image, OfDlpack(image)))
    np.testing.assert_array_equal(of_other.V, of_numpy.V)
    np.testing.assert_array_equal(of_other.children[0].material.base_color_texture, image)
    np.testing.assert_array_equal(shapes.image_plane(OfDlpack(image)).V, shapes.image_plane(image).V)
    assert len(shapes.voxel_grid(OfDlpack(np.ones((2, 2, 2), int))).V) == 8


@pytest.mark.parametrize("image, got", [(np.zeros(5), "5"), ("photo.png", "a str"), (np.zeros((0, 4, 3)), "0 x 4 x 3")])
def test_what_is_no_image_is_refused(image, got):
    with pytest.raises(easypbr.ArgumentError, match=rf"camera_frustum: image: expected .*load_image\(path\), got {got}$"):
        shapes.camera_frustum((np.eye(3), np.eye(4)), image)
    with pytest.raises(easypbr.ArgumentError, match=rf"image_plane: image: expected .*load_image\(path\), got {got}$"):
        shapes.image_plane(image)


def test_voxels_of_occupancy_labels_and_colors():
    occupied = np.zeros((2, 3, 4), bool)
    occupied[1, 2, 3] = occupied[0, 0, 0] = True
    mesh = shapes.voxel_grid(occupied, origin=(10, 20, 30), cell_size=0.5)
    np.testing.assert_array_equal(mesh.V, [[10.25, 20.25, 30.25], [10.75, 21.25, 31.75]])
    labels = np.where(occupied, 40, 0).astype(np.int64)
    np.testing.assert_array_equal(shapes.voxel_grid(labels).L, [40, 40])
    assert len(shapes.voxel_grid(labels, empty=40).L) == 22
    colors = np.zeros((2, 3, 4, 4), np.uint8)
    colors[occupied] = (255, 51, 0, 255)
    np.testing.assert_allclose(shapes.voxel_grid(colors).C, [[1, 0.2, 0, 1]] * 2, atol=1e-7)
    # A transposed view is not contiguous.
    np.testing.assert_array_equal(shapes.voxel_grid(occupied.T).V[1], [3.5, 2.5, 1.5])
    assert isinstance(shapes.voxel_grid(np.zeros((0, 3, 4), bool)), Mesh)


@pytest.mark.parametrize("array", [np.zeros((2, 3)), np.zeros((2, 2, 2)), np.zeros((2, 2, 2, 2)),
                                   np.zeros((2, 2, 2, 3), int), np.full((1, 1, 1), 2**40), np.array("x")])
def test_voxels_of_anything_else_are_refused(array):
    with pytest.raises(easypbr.ArgumentError, match="voxel_grid: expected"):
        shapes.voxel_grid(array)


@pytest.mark.parametrize("arguments", [dict(cell_size=0), dict(cell_size=NAN), dict(origin=(0, 0)),
                                       dict(origin=(0, NAN, 0))])
def test_voxels_without_a_place_are_refused(arguments):
    with pytest.raises(easypbr.ArgumentError):
        shapes.voxel_grid(np.ones((1, 1, 1), bool), **arguments)


def test_shapes_can_be_drawn(size):
    for mesh in (shapes.torus(), shapes.axes(), shapes.capsule()):
        picture = easypbr.render(mesh, size=size, samples=1)
        assert 0.05 < (picture[:, :, :3] != 217).any(axis=2).mean() < 0.9
