"""Meshes that move, and their hierarchy."""

import base64
import json

import numpy as np
import pytest

from easypbr import Mesh, Scene, Viewer, load_scene, shapes


def test_steps_of_motion():
    mesh = shapes.box()
    mesh.translate((1, 2, 3))
    mesh.rotate_axis_angle((0, 0, 1), 90)
    # A quarter turn about z takes x to y; the position stays.
    np.testing.assert_allclose(mesh.T_world_mesh @ [1, 0, 0, 1], [1, 3, 3, 1], atol=1e-15)
    mesh.orbit((0, 1, 0), (0, 0, 0), 180)
    np.testing.assert_allclose(mesh.T_world_mesh[:3, 3], [-1, 2, -3], atol=1e-15)
    mesh.scale(2)
    mesh.scale((1, 1, 3))
    np.testing.assert_allclose(np.linalg.norm(mesh.T_world_mesh[:3, :3], axis=0), [2, 2, 6], rtol=1e-15)
    with pytest.raises(ValueError, match="axis with a length"):
        mesh.rotate_axis_angle((0, 0, 0), 10)
    with pytest.raises(ValueError, match="factors other than 0"):
        mesh.scale(0)


def test_children_move_with_their_parent():
    car, wheel = shapes.box(), shapes.sphere(0.3)
    car.add_child(wheel)
    assert wheel.parent == car and car.parent is None
    wheel.translate((1, 0, 0))
    car.translate((0, 0, 5))
    np.testing.assert_allclose(wheel.T_world_mesh[:3, 3], [1, 0, 5])
    wheel.T_world_mesh = np.eye(4)
    np.testing.assert_allclose(wheel.T_parent_mesh[:3, 3], [0, 0, -5])
    with pytest.raises(ValueError, match="cannot become a child"):
        wheel.add_child(car)
    car.remove_child(wheel, keep_world_pose=True)
    assert car.children == [] and wheel.parent is None
    np.testing.assert_array_equal(wheel.T_parent_mesh, np.eye(4))


def test_a_moved_parent_is_drawn_where_it_is(size):
    """Moving a parent by a step is drawn as its child at that place: the same picture, bit for bit."""
    still, moved = Scene(), Scene()
    parent, child = Mesh(), shapes.box()
    parent.add_child(child)
    moved.show(parent, "box")
    settings = {"camera.position": (3, 2, 5), "camera.target": (0, 0, 0), "tonemap.exposure": 1.0}
    view = Viewer(size, settings, scene=moved)
    first = view.render(samples=1)
    parent.translate((0.5, 0, 0))
    second = view.render(samples=1)
    assert (first != second).any()
    other = shapes.box()
    still.show(other, "box")
    view = Viewer(size, settings, scene=still)
    np.testing.assert_array_equal(view.render(samples=1), first)
    other.translate((0.5, 0, 0))
    np.testing.assert_array_equal(view.render(samples=1), second)


@pytest.fixture
def moving(tmp_path):
    """A triangle that goes from x = 0 to x = 4 in two seconds."""
    arrays = [np.array(values, "<f4") for values in ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [0, 2], [[0, 0, 0], [4, 0, 0]])]
    views, data = [], b""
    for array in arrays:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        data += array.tobytes()
    (tmp_path / "moving.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "animations": [{"name": "go", "samplers": [{"input": 1, "output": 2}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
        "accessors": [{"bufferView": i, "componentType": 5126, "count": len(array), "type": ["SCALAR", "VEC3"][array.ndim - 1]}
                      for i, array in enumerate(arrays)],
        "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
    }))
    return load_scene(tmp_path / "moving.gltf")


def test_animations_of_a_file_move_its_meshes(moving, tmp_path):
    animations, (node,) = moving.animations, moving.mesh.children
    assert animations.names == ["go"] and len(animations) == 1 and animations.duration_s("go") == 2
    for time, x in ((0.5, 1), (1.5, 3), (2.5, 1), (-0.5, 3)):
        animations.apply(time)
        np.testing.assert_allclose(node.T_world_mesh[:3, 3], [x, 0, 0], atol=1e-12)
    animations.apply(2.5, "go", loop=False)
    np.testing.assert_allclose(node.T_world_mesh[:3, 3], [4, 0, 0])
    with pytest.raises(KeyError, match="there is no animation 'og'"):
        animations.apply(0, "og")
    shapes.box().save(tmp_path / "box.glb")
    assert not load_scene(tmp_path / "box.glb").animations
