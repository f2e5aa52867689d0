"""Open3D's geometries as meshes: stand-ins with the attributes of its classes, and the real ones where it is installed."""

import types

import numpy as np
import pytest

import easypbr
from easypbr import as_mesh

POINTS = np.random.default_rng(0).random((40, 3))
COLORS = np.random.default_rng(1).integers(0, 256, (40, 3))


def open3d_mesh(V, F, **more):
    return types.SimpleNamespace(vertices=V, triangles=F, vertex_normals=[], vertex_colors=[], **more)


def test_open3d_lines_have_a_color_each(square):
    V, _ = square
    lines = types.SimpleNamespace(points=V, lines=np.array([[0, 1], [1, 2]]), colors=np.eye(3)[:2], has_lines=lambda: True)
    mesh = as_mesh(lines)
    np.testing.assert_array_equal(mesh.E, [[0, 1], [2, 3]])
    np.testing.assert_array_equal(mesh.V, V[[0, 1, 1, 2]])
    np.testing.assert_array_equal(mesh.C, np.eye(3)[[0, 0, 1, 1]])
    lines.colors = []
    np.testing.assert_array_equal(as_mesh(lines).E, [[0, 1], [1, 2]])


def test_open3d_voxels():
    voxel = lambda index, color: types.SimpleNamespace(grid_index=np.array(index), color=np.array(color))  # noqa: E731
    grid = types.SimpleNamespace(
        get_voxels=lambda: [voxel([0, 0, 0], [1.0, 0, 0]), voxel([2, 0, 1], [0, 0, 1.0])],
        voxel_size=0.5, origin=np.array([10.0, 0, 0]), has_colors=lambda: True,
    )  # fmt: skip
    mesh = as_mesh(grid)
    np.testing.assert_allclose(mesh.V, [[0.25, 0.25, 0.25], [1.25, 0.25, 0.75]])
    np.testing.assert_array_equal(mesh.T_parent_mesh[:3, 3], [10, 0, 0])
    np.testing.assert_array_equal(mesh.C, [[1, 0, 0], [0, 0, 1]])
    assert (mesh.style.mode, mesh.style.voxel_size) == ("voxels", 0.5)
    grid.get_voxels = list
    with pytest.raises(easypbr.ArgumentError, match="expected voxels, got none"):
        as_mesh(grid)


def test_open3d_models_have_meshes_with_materials(square):
    record = types.SimpleNamespace(base_color=np.array([1, 0.5, 0, 1]), base_metallic=0.75, base_roughness=0.25,
                                   albedo_img=np.full((2, 2, 3), 9, dtype=np.uint8))  # fmt: skip
    info = types.SimpleNamespace(mesh=open3d_mesh(*square), mesh_name="wing", material_idx=0)
    other = types.SimpleNamespace(mesh=open3d_mesh(*square), mesh_name="tail", material_idx=-1)
    model = types.SimpleNamespace(meshes=[info, other], materials=[record])
    wing, tail = as_mesh(model).children
    assert (wing.name, tail.name) == ("wing", "tail")
    assert wing.material.base_color == pytest.approx((1, 0.5, 0))
    assert (wing.material.metallic, wing.material.roughness) == pytest.approx((0.75, 0.25))
    assert (wing.material.base_color_texture == 9).all()


class Tensor:
    """What Open3D's tensors have."""

    def __init__(self, array):
        self._array = np.asarray(array)

    def cpu(self):
        return self

    def numpy(self):
        return self._array


def test_open3d_tensor_geometry(square, caplog):
    V, F = square
    vertex = {"positions": Tensor(V), "colors": Tensor(np.full((4, 3), 51, dtype=np.uint8)), "heat": Tensor(V[:, :1])}
    mesh = types.SimpleNamespace(vertex=vertex, triangle={"indices": Tensor(F)}, to_legacy=lambda: None)
    made = as_mesh(mesh)
    np.testing.assert_array_equal(made.F, F)
    np.testing.assert_allclose(made.C, 0.2)
    np.testing.assert_array_equal(made.scalars["heat"], V[:, 0])
    mesh.triangle["texture_uvs"] = Tensor(np.arange(12.0).reshape(2, 3, 2))
    split = as_mesh(mesh)
    np.testing.assert_array_equal(split.V, V[F.ravel()])
    np.testing.assert_array_equal(split.UV, np.arange(12.0).reshape(6, 2))
    np.testing.assert_array_equal(split.scalars["heat"], V[F.ravel(), 0])
    point = {"positions": Tensor(V), "labels": Tensor(np.arange(4)[:, None]), "flow": Tensor(V)}
    cloud = types.SimpleNamespace(point=point, to_legacy=lambda: None)
    np.testing.assert_array_equal(as_mesh(cloud).L, range(4))
    assert "attributes of an Open3D tensor geometry: flow" in caplog.text
    lines = types.SimpleNamespace(point={"positions": Tensor(V)}, line={"indices": Tensor([[0, 1], [2, 3]])}, to_legacy=lambda: None)
    np.testing.assert_array_equal(as_mesh(lines).E, [[0, 1], [2, 3]])
    with pytest.raises(easypbr.ArgumentError, match="expected point.positions"):
        as_mesh(types.SimpleNamespace(point={}, to_legacy=lambda: None))


def test_open3d_boxes_are_edges():
    corners = np.array([[0, 0, 0], [4, 0, 0], [0, 2, 0], [0, 0, 1], [4, 2, 1], [0, 2, 1], [4, 0, 1], [4, 2, 0]], dtype=float)
    angle = 0.3
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    for turned in (corners, corners @ turn.T + 5):
        mesh = as_mesh(types.SimpleNamespace(get_box_points=lambda points=turned: points, color=(1, 0, 0)))
        lengths = np.linalg.norm(mesh.V[mesh.E[:, 0]] - mesh.V[mesh.E[:, 1]], axis=1)
        np.testing.assert_allclose(sorted(lengths), [1] * 4 + [2] * 4 + [4] * 4, atol=1e-5)


def test_real_open3d(square):
    open3d = pytest.importorskip("open3d")
    V, F = square
    vector = open3d.utility.Vector3dVector
    mesh = open3d.geometry.TriangleMesh(vector(V), open3d.utility.Vector3iVector(F))
    np.testing.assert_array_equal(as_mesh(mesh).F, F)
    tensor_mesh = open3d.t.geometry.TriangleMesh.from_legacy(mesh)
    np.testing.assert_array_equal(as_mesh(tensor_mesh).F, F)
    cloud = open3d.geometry.PointCloud(vector(POINTS))
    cloud.colors = vector(COLORS / 255)
    np.testing.assert_allclose(as_mesh(cloud).C, COLORS / 255, atol=1e-6)
    np.testing.assert_allclose(as_mesh(open3d.t.geometry.PointCloud.from_legacy(cloud)).C, COLORS / 255, atol=1e-6)
    lines = open3d.geometry.LineSet(vector(V), open3d.utility.Vector2iVector([[0, 1], [1, 2]]))
    lines.colors = vector(np.eye(3)[:2])
    for kind in (lines, open3d.t.geometry.LineSet.from_legacy(lines)):
        np.testing.assert_array_equal(as_mesh(kind).V, V[[0, 1, 1, 2]])
    grid = open3d.geometry.VoxelGrid.create_from_point_cloud(cloud, voxel_size=0.25)
    voxels = as_mesh(grid)
    assert len(voxels.V) == len(grid.get_voxels())
    np.testing.assert_allclose(voxels.V[0] + voxels.T_parent_mesh[:3, 3],
                               grid.get_voxel_center_coordinate(grid.get_voxels()[0].grid_index), atol=1e-6)
    for box in (cloud.get_axis_aligned_bounding_box(), cloud.get_oriented_bounding_box()):
        assert as_mesh(box).E.shape == (12, 2)
    assert len(as_mesh([cloud, mesh, lines]).children) == 3
