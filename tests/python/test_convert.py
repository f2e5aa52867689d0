"""Objects of other libraries: tiny stand-ins with the same attributes, and the real ones where they are installed."""

import types

import numpy as np
import pytest

import easypbr
from easypbr import Mesh, as_mesh


def check(mesh, square):
    V, F = square
    np.testing.assert_array_equal(mesh.V, V)
    np.testing.assert_array_equal(mesh.F, F)


def test_paths_meshes_tuples_and_dicts(square, tmp_path):
    mesh = Mesh(*square)
    assert as_mesh(mesh) is mesh
    check(as_mesh(square), square)
    mesh.save(tmp_path / "square.ply")
    check(as_mesh(tmp_path / "square.ply"), square)
    V, F = square
    named = as_mesh({"V": V, "F": F, "UV": V[:, :2], "name": "square"})
    check(named, square)
    assert named.name == "square" and named.UV.shape == (4, 2)


def test_unknown_objects_are_refused():
    with pytest.raises(TypeError.__base__, match="cannot show a builtins.int: expected a path, an easypbr.Mesh"):
        as_mesh(3)
    with pytest.raises(KeyError, match="no array 'W'"):
        as_mesh({"W": [1]})


def test_trimesh_stand_in(square):
    V, F = square
    colors = np.full((4, 4), 255, dtype=np.uint8)
    visual = types.SimpleNamespace(kind="vertex", vertex_colors=colors)
    mesh = as_mesh(types.SimpleNamespace(vertices=V, faces=F, visual=visual, vertex_normals=V))
    check(mesh, square)
    assert (mesh.C == 1).all() and mesh.C.shape == (4, 4)
    assert len(mesh.N) == 0  # those would be computed, not the file's


def test_trimesh_materials(square):
    V, F = square
    image = types.SimpleNamespace(convert=lambda mode: np.full((2, 2, 4), 7, dtype=np.uint8))
    simple = types.SimpleNamespace(image=image, diffuse=np.array([255, 0, 128, 255], dtype=np.uint8))
    visual = types.SimpleNamespace(kind="texture", uv=V[:, :2], material=simple)
    mesh = as_mesh(types.SimpleNamespace(vertices=V, faces=F, visual=visual))
    np.testing.assert_array_equal(mesh.UV, V[:, :2])
    assert (mesh.material.base_color_texture == 7).all()
    # sRGB 128 / 255 is linear 0.21586.
    assert mesh.material.base_color == pytest.approx((1, 0, 0.21586), abs=1e-5)
    visual.material = types.SimpleNamespace(
        baseColorTexture=None, baseColorFactor=[255, 51, 0, 255], metallicFactor=0.25, roughnessFactor=None
    )
    material = as_mesh(types.SimpleNamespace(vertices=V, faces=F, visual=visual)).material
    # glTF's factors are linear, and roughness is 1 unless given.
    assert material.base_color == pytest.approx((1, 0.2, 0), abs=1e-6)
    assert (material.metallic, material.roughness) == (0.25, 1)


def test_trimesh_face_colors(square):
    V, F = square
    visual = types.SimpleNamespace(kind="face", face_colors=np.array([[255, 0, 0], [0, 0, 255]], dtype=np.uint8))
    mesh = as_mesh(types.SimpleNamespace(vertices=V, faces=F, visual=visual))
    np.testing.assert_array_equal(mesh.V, V[F.ravel()])
    np.testing.assert_array_equal(mesh.C, [[1, 0, 0]] * 3 + [[0, 0, 1]] * 3)


def test_open3d_stand_ins(square):
    V, F = square
    mesh = types.SimpleNamespace(vertices=V, triangles=F, vertex_normals=V, vertex_colors=[])
    check(as_mesh(mesh), square)
    np.testing.assert_array_equal(as_mesh(mesh).N, V)
    # uv per corner: each of the six corners becomes a vertex.
    mesh.triangle_uvs = np.arange(12.0).reshape(6, 2)
    split = as_mesh(mesh)
    np.testing.assert_array_equal(split.V, V[F.ravel()])
    np.testing.assert_array_equal(split.UV, mesh.triangle_uvs)
    np.testing.assert_array_equal(split.F, [[0, 1, 2], [3, 4, 5]])
    cloud = types.SimpleNamespace(points=V, colors=V, normals=[], has_colors=lambda: True)
    assert as_mesh(cloud).F.shape == (0, 3)
    np.testing.assert_array_equal(as_mesh(cloud).C, V)


def test_pyvista_stand_in(square):
    V, F = square
    faces = np.insert(F, 0, 3, axis=1).ravel()
    mesh = types.SimpleNamespace(
        points=V, faces=faces, point_data={"Normals": V}, n_points=4, is_all_triangles=True
    )
    check(as_mesh(mesh), square)
    np.testing.assert_array_equal(as_mesh(mesh).N, V)
    mesh.faces = np.array([4, 0, 1, 2, 3])
    mesh.point_data = {}
    check(as_mesh(mesh), square)
    np.testing.assert_array_equal(as_mesh(mesh).source_face, [0, 0])
    mesh.faces = np.array([3, 0, 1, 2, 4, 0, 1, 2, 3])
    np.testing.assert_array_equal(as_mesh(mesh).F, [[0, 1, 2], [0, 1, 2], [0, 2, 3]])
    np.testing.assert_array_equal(as_mesh(mesh).source_face, [0, 1, 1])


def test_real_trimesh(square):
    import trimesh

    mesh = trimesh.Trimesh(*square, process=False)
    check(as_mesh(mesh), square)
    scene = trimesh.Scene()
    T = trimesh.transformations.translation_matrix([1, 2, 3])
    scene.add_geometry(mesh, node_name="moved", transform=T)
    (child,) = as_mesh(scene).children
    check(child, square)
    assert child.name == "moved"
    np.testing.assert_array_equal(child.T_parent_mesh, T)
    cloud = trimesh.PointCloud(square[0])
    np.testing.assert_array_equal(as_mesh(cloud).V, square[0])


def test_real_pyvista(square):
    import pyvista

    V, F = square
    mesh = pyvista.PolyData(V, np.insert(F, 0, 3, axis=1).ravel())
    check(as_mesh(mesh), square)
    quad = pyvista.PolyData(V, np.array([4, 0, 1, 2, 3]))
    assert as_mesh(quad).F.shape == (2, 3)
    np.testing.assert_array_equal(as_mesh(quad).source_face, [0, 0])
    assert len(as_mesh(mesh).source_face) == 0
    quad.cell_data["RGB"] = np.array([[255, 0, 0]], np.uint8)
    assert len(as_mesh(quad).V) == 4, "triangles of a polygon share its corners"
    np.testing.assert_array_equal(as_mesh(quad).source_face, [0, 0])
    # The surface of a grid of one cell has six sides of two triangles each.
    assert as_mesh(pyvista.ImageData(dimensions=(2, 2, 2))).F.shape == (12, 3)
    cloud = as_mesh(pyvista.PolyData(V))
    np.testing.assert_array_equal(cloud.V, V)
    assert len(cloud.F) == 0
