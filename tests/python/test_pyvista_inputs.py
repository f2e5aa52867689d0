"""Data sets of PyVista and VTK as meshes."""

import numpy as np
import pytest

import easypbr
from easypbr import as_mesh, render

POINTS = np.random.default_rng(0).random((40, 3))
SMALL = {"size": (48, 36), "samples": 1}


def drawn(what, **settings) -> np.ndarray:
    return render(what, **SMALL, **settings)


@pytest.fixture(scope="module")
def pyvista():
    return pytest.importorskip("pyvista")


def test_active_scalars_are_drawn_with_a_color_bar(pyvista):
    ball = pyvista.Sphere()
    ball["height"] = ball.points[:, 2]
    ball.cell_data["number"] = np.arange(ball.n_cells)
    ball.set_active_scalars("height")
    mesh = as_mesh(ball)
    assert (mesh.style.color_by, mesh.style.scalar) == ("scalar", "height")
    np.testing.assert_allclose(mesh.scalars["height"], ball.points[:, 2])
    np.testing.assert_array_equal(mesh.scalars["number"], np.arange(ball.n_cells))
    with_bar = drawn(ball)
    np.testing.assert_array_equal(with_bar, drawn(mesh, colorbar=True))
    np.testing.assert_array_equal(drawn(ball, colorbar=False), drawn(mesh))
    assert (with_bar != drawn(ball, colorbar=False)).any()
    ball.set_active_scalars("number")
    assert as_mesh(ball).style.scalar == "number"


def test_scalars_that_are_not_active_colour_when_asked_for(pyvista):
    """As PyVista draws them. Texture coordinates are no scalars, whatever they are called."""
    ball = pyvista.Sphere()
    ball.point_data.set_array(ball.points[:, 2], "height")
    for data, name in ((pyvista.Cube(), "FaceIndex"), (ball, "height")):
        mesh = as_mesh(data)
        assert list(mesh.scalars) == [name]
        np.testing.assert_array_equal(drawn(data), drawn(mesh, color_by="solid"))
        assert (drawn(data) != drawn(data, scalar=name)).any()
    assert list(as_mesh(pyvista.Plane()).scalars) == []


def test_colors_of_points_and_cells(pyvista):
    box = pyvista.Cube().triangulate()
    colors = np.random.default_rng(0).integers(0, 256, (box.n_cells, 3)).astype(np.uint8)
    box.cell_data["paint"] = colors
    box.set_active_scalars("paint")
    mesh = as_mesh(box)
    np.testing.assert_allclose(mesh.C[0::3], colors / 255, atol=1e-6)
    np.testing.assert_allclose(mesh.C[2::3], colors / 255, atol=1e-6)
    assert mesh.style.color_by != "scalar"


def test_as_many_cells_as_points_keep_their_values(pyvista):
    """Four points, four triangles: values of the triangles must not become those of the points."""
    tetrahedron = pyvista.PolyData(np.vstack([np.zeros(3), np.eye(3)]), [3, 0, 2, 1, 3, 0, 1, 3, 3, 0, 3, 2, 3, 1, 2, 3])
    tetrahedron.cell_data["number"] = np.arange(4.0)
    mesh = as_mesh(tetrahedron)
    np.testing.assert_array_equal(mesh.scalars["number"], np.repeat(np.arange(4.0), 3))
    assert len(mesh.V) == 12


def test_triangles_of_a_strip_are_polygons_of_their_own(pyvista):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 2, 0], [2, 0, 0], [2, 1, 0]], float)
    data = pyvista.PolyData(corners, faces=[4, 1, 5, 6, 3], strips=[5, 0, 1, 2, 3, 4])
    polygons = as_mesh(data).source_face
    assert sorted(np.unique(polygons, return_counts=True)[1]) == [1, 1, 1, 2]


def test_vectors_are_scalars_and_what_is_lost_is_said(pyvista, caplog):
    ball = pyvista.Sphere()
    ball["wind"] = ball.points * 2
    ball["wide"] = np.zeros((ball.n_points, 30))
    ball.set_active_scalars("wind")
    mesh = as_mesh(ball)
    np.testing.assert_allclose(mesh.scalars["wind_1"], ball.points[:, 1] * 2, rtol=1e-6)
    np.testing.assert_allclose(mesh.scalars["wind"], np.linalg.norm(ball.points * 2, axis=1), rtol=1e-5)
    assert "the array 'wide' of 30 values, more than 16" in caplog.text


def test_lines_points_and_faces_of_one_polydata(pyvista):
    V = np.random.default_rng(0).random((6, 3))
    data = pyvista.PolyData(V, faces=[3, 0, 1, 2], lines=[3, 2, 3, 4], verts=[1, 5])
    data.cell_data["number"] = [10.0, 20.0, 30.0]  # of the point, the line and the face, in VTK's order
    face, line, point = as_mesh(data).children
    np.testing.assert_array_equal(face.F, [[0, 1, 2]])
    assert face.scalars["number"][0] == 30
    np.testing.assert_allclose(line.V[line.E.ravel()], V[[2, 3, 3, 4]], rtol=1e-6)
    assert set(line.scalars["number"]) == {20}
    np.testing.assert_allclose(point.V, V[[5]], rtol=1e-6)
    np.testing.assert_array_equal(point.scalars["number"], [10])


def test_a_volume_is_three_slices_of_its_values(pyvista):
    volume = pyvista.ImageData(dimensions=(9, 7, 5))
    volume["heat"] = volume.points[:, 0] + 10 * volume.points[:, 1]
    mesh = as_mesh(volume)
    low, high = mesh.V.min(axis=0), mesh.V.max(axis=0)
    np.testing.assert_array_equal([low, high], [[0, 0, 0], [8, 6, 4]])
    middle = np.isclose(mesh.V, [4, 3, 2])
    assert middle.any(axis=1).all()
    np.testing.assert_allclose(mesh.scalars["heat"], mesh.V[:, 0] + 10 * mesh.V[:, 1], atol=1e-4)
    picture = drawn(volume, colorbar=False)
    assert np.ptp(picture[:, :, :3].astype(int), axis=2).max() > 60, "not a grey box"


def test_a_flat_image_is_a_plane_and_cells_keep_their_values(pyvista):
    image = pyvista.ImageData(dimensions=(4, 3, 1))
    image.cell_data["heat"] = np.arange(6.0)
    mesh = as_mesh(image)
    assert set(mesh.scalars["heat"]) == set(range(6))
    assert (mesh.V[:, 2] == 0).all()


def test_a_volume_without_values_says_that_its_surface_is_drawn(pyvista, caplog):
    assert as_mesh(pyvista.ImageData(dimensions=(2, 2, 2))).F.shape == (12, 3)
    assert "it has no values, its surface is drawn" in caplog.text


def test_unstructured_and_structured_grids_are_their_surface(pyvista):
    cells = pyvista.ImageData(dimensions=(4, 4, 4)).cast_to_unstructured_grid()
    cells["height"] = cells.points[:, 2]
    mesh = as_mesh(cells)
    assert len(mesh.F) == 6 * 9 * 2
    np.testing.assert_allclose(mesh.scalars["height"], mesh.V[:, 2])
    x, y = np.meshgrid(np.arange(4.0), np.arange(3.0))
    assert as_mesh(pyvista.StructuredGrid(x, y, x * 0)).F.shape == (12, 3)


def test_blocks_are_children_with_names(pyvista, caplog):
    blocks = pyvista.MultiBlock({"ball": pyvista.Sphere(), "nothing": None, "inner": pyvista.MultiBlock([pyvista.Cube()])})
    mesh = as_mesh(blocks)
    assert [child.name for child in mesh.children] == ["ball", "inner"]
    assert "1 blocks without points of a" in caplog.text
    with pytest.raises(easypbr.ArgumentError, match="expected points, got none"):
        as_mesh(pyvista.MultiBlock())


def test_plain_vtk(pyvista):
    vtk = pytest.importorskip("vtkmodules.vtkFiltersSources")
    source = vtk.vtkSphereSource()
    source.Update()
    data = source.GetOutput()
    mesh = as_mesh(data)
    assert (len(mesh.V), len(mesh.F)) == (data.GetNumberOfPoints(), data.GetNumberOfPolys())
    assert len(mesh.N) == len(mesh.V)
    from vtkmodules.vtkCommonDataModel import vtkTable

    with pytest.raises(easypbr.ArgumentError, match="vtkTable: expected a data set with points"):
        as_mesh(vtkTable())


def test_vtk_points_without_cells(pyvista):
    cloud = pyvista.PolyData(POINTS)
    cloud["heat"] = POINTS[:, 0]
    for data in (cloud, pyvista.PointSet(POINTS)):
        mesh = as_mesh(data)
        np.testing.assert_allclose(mesh.V, POINTS, rtol=1e-6)
        assert len(mesh.F) == 0
