"""Sharp edges and faces of both windings in meshes without normals."""

import base64
import json
from pathlib import Path

import numpy as np
import pytest

import easypbr
from easypbr import Mesh, Scene, render

SMALL = {"size": (48, 36), "samples": 1}


def drawn(what, **settings) -> np.ndarray:
    return render(what, **SMALL, **settings)


def turned_box() -> tuple[np.ndarray, np.ndarray]:
    """A box with two triangles for each side, of which some are wound the wrong way round."""
    V = np.array([[x, y, z] for x in (-1, 1) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    F = np.array([half for a, b, c, d in quads for half in ((a, b, c), (a, c, d))])
    F[::3] = F[::3, ::-1]
    return V, F


@pytest.mark.parametrize("path", [False, True], ids=["raster", "path"])
def test_sides_of_a_box_without_normals_are_plane(path):
    V, F = turned_box()
    scene = Scene()
    scene.show(Mesh(V, F), "box")
    view = easypbr.Viewer((48, 36), {"path": {"enabled": path}, "camera": {"azimuth_deg": 30, "elevation_deg": 25}}, scene)
    layers = view.layers(["normal_world", "element_id", "depth"])
    normals = layers["normal_world"][layers["depth"].reshape(36, 48) > 0]
    # Three sides are seen, along the axes; 1e-4 for the encoding.
    np.testing.assert_allclose(normals.max(axis=1), 1, atol=1e-4)
    assert {tuple(row) for row in np.rint(normals).astype(int)} == {(1, 0, 0), (0, 1, 0), (0, 0, 1)}
    view.settings.load.crease_deg = 180
    smooth = view.layers(["normal_world", "element_id"])
    np.testing.assert_array_equal(smooth["element_id"], layers["element_id"])
    assert smooth["normal_world"].max(axis=2).min(where=layers["depth"].reshape(36, 48) > 0, initial=1) < 0.9


@pytest.mark.parametrize("look", [{"color_by": "label"}, {"color_by": "scalar"}], ids=["labels", "scalars"])
def test_sharp_edges_change_no_colours_of_faces_and_vertices(look):
    V, F = turned_box()
    mesh = Mesh(V, F)
    mesh.L = range(12)
    mesh.scalars["height"] = V[:, 1]
    flat = {"lit": False, **look}
    np.testing.assert_array_equal(drawn(mesh, **flat), drawn(mesh, crease_deg=180, **flat))


def test_points_on_a_mesh_with_sharp_edges_are_its_own():
    V, F = turned_box()
    # Points as large as the picture hide the box. They have no normals, and so are not shaded.
    points = {"show_points": True, "point_size": 100.0}
    np.testing.assert_array_equal(drawn((V, F), **points), drawn((V, F), crease_deg=180, **points))


def test_a_mesh_that_deforms_keeps_its_sharp_edges():
    V, F = turned_box()
    scene = Scene()
    mesh = scene.show(Mesh(V, F), "box")
    view = easypbr.Viewer((48, 36), {"camera": {"position": (2, 2, 6), "target": (0, 0, 0)}}, scene)
    view.layers(["normal_world"])
    # Sheared by atan(2) = 63.4 degrees: the edges between front and top are at 26.6 or 153.4 degrees.
    mesh.V = V + V[:, 1:2] * [0, 0, 2]
    normals = view.layers(["normal_world"])["normal_world"]
    seen = normals[np.linalg.norm(normals, axis=2) > 0.5]
    # At most three sides are seen, each with one normal: 0, 89.4, 178.9 and 200 parts of 200 are none that rounding
    # takes to two numbers when the encoding is off by 1e-4.
    assert len(np.unique(np.rint(seen * 200), axis=0)) <= 3


def hinge(angle_deg: float) -> np.ndarray:
    """Six vertices of two quads that share the z axis, folded by an angle."""
    x, y = np.cos(np.radians(angle_deg)), -np.sin(np.radians(angle_deg))
    return np.array([[0, 0, -1], [0, 0, 1], [-1, 0, 1], [-1, 0, -1], [x, y, 1], [x, y, -1]], np.float32)


def hinge_file(path: Path) -> Path:
    """Folded by 70 degrees at rest, and within a second to 40."""
    indices = np.array([0, 2, 1, 0, 3, 2, 0, 1, 4, 0, 4, 5], np.uint16)
    keys = np.array([0, 1], np.float32)
    moved = hinge(40) - hinge(70)
    arrays = [(hinge(70), "VEC3", 5126), (moved, "VEC3", 5126), (indices, "SCALAR", 5123), (keys, "SCALAR", 5126)]
    views, accessors, data = [], [], b""
    for i, (array, kind, component) in enumerate(arrays):
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        accessors.append({"bufferView": i, "componentType": component, "count": len(array), "type": kind})
        data += array.tobytes()
    accessors[0] |= {"min": hinge(70).min(axis=0).tolist(), "max": hinge(70).max(axis=0).tolist()}
    primitive = {"attributes": {"POSITION": 0}, "indices": 2, "targets": [{"POSITION": 1}]}
    channel = {"sampler": 0, "target": {"node": 0, "path": "weights"}}
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    content = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "animations": [{"samplers": [{"input": 3, "output": 3}], "channels": [channel]}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": uri}],
    }
    path.write_text(json.dumps(content))
    return path


@pytest.mark.parametrize("times", [[1], [0, 1], [1, 0], [0]])
def test_edges_of_what_an_animation_moves_are_those_at_rest(times, tmp_path):
    file = easypbr.load_scene(hinge_file(tmp_path / "hinge.gltf"))
    scene = Scene()
    scene.show(file.mesh, "hinge")
    settings = {"style": {"flat": False}, "camera": {"position": (1.5, 3, 3), "target": (0, 0, 0)}}
    view = easypbr.Viewer((48, 36), settings, scene)
    for seconds in times:
        file.animations.apply(seconds, 0)
        normals = view.layers(["normal_world"])["normal_world"]
    drawn_normals = normals[np.linalg.norm(normals, axis=2) > 0.5]
    # 70 degrees are sharp, whatever was drawn first: one normal for each quad. 1/50 is coarser than the encoding.
    assert len(np.unique(np.rint(drawn_normals * 50), axis=0)) == 2


def seen(what) -> np.ndarray:
    return render(what, size=(96, 72), samples=1, camera={"position": (2, 1.5, 3), "target": (0, 0, 0)}).astype(int)


def meshes_without_normals() -> dict[str, Mesh]:
    ball = easypbr.shapes.icosphere(0.5, 2)
    V, F = np.array(ball.V), np.array(ball.F)
    turned = F.copy()
    turned[::3] = turned[::3, ::-1]
    return {
        "box": Mesh(*turned_box()),
        "turned": Mesh(V, turned),
        "doubled": Mesh(V, np.concatenate([F, F[:, ::-1]])),
    }


# Positions and normals are written as they are drawn: colours differ by rounding alone.
ROUNDING = 2


@pytest.mark.parametrize("name", ["box", "turned", "doubled"])
@pytest.mark.parametrize("ending", ["glb", "ply", "obj", "npz"])
def test_files_of_meshes_without_normals_look_as_the_meshes(name, ending, tmp_path):
    mesh = meshes_without_normals()[name]
    mesh.save(tmp_path / f"a.{ending}")
    assert abs(seen(mesh) - seen(tmp_path / f"a.{ending}")).max() <= ROUNDING


@pytest.mark.parametrize("name", ["box", "turned", "doubled"])
def test_meshes_without_normals_merged_with_others_look_as_before(name, tmp_path):
    mesh = meshes_without_normals()[name]
    hidden = easypbr.shapes.sphere(0.01)
    both = mesh.merge(hidden)
    np.testing.assert_array_equal(both.V[: len(mesh.V)], mesh.V)
    wanted = seen(mesh)
    assert abs(wanted - seen(both)).max() <= ROUNDING
    easypbr.as_mesh([mesh, hidden]).save(tmp_path / "both.ply")
    assert abs(wanted - seen(tmp_path / "both.ply")).max() <= ROUNDING


@pytest.mark.parametrize("ending", ["glb", "ply", "obj", "npz"])
def test_seams_of_textures_keep_sharp_edges_in_files(ending, tmp_path):
    V = [[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    lines = [f"v {x} {y} {z}" for x, y, z in V] + ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    lines += ["f " + " ".join(f"{v + 1}/{k + 1}" for k, v in enumerate(quad)) for quad in quads]
    (tmp_path / "seams.obj").write_text("\n".join(lines) + "\n")
    Mesh(tmp_path / "seams.obj").save(tmp_path / f"out.{ending}")
    assert abs(seen(tmp_path / "seams.obj") - seen(tmp_path / f"out.{ending}")).max() <= ROUNDING
