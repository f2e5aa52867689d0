"""Data sets of files: far from zero, of turned nodes, more than memory holds."""

import io

import numpy as np
import pytest
import trimesh

import easypbr
from easypbr import Mesh, shapes
from easypbr.dataset import ObjectSpec, PlacementSpec, SurroundingsSpec
from easypbr.dataset.extents import bounds, vertices_of, without_offset
from easypbr.dataset.frames import FrameMaker
from easypbr.dataset.kept import Kept, bytes_of
from easypbr.dataset.models import model_ply
from easypbr.dataset.poses import turn_about
from test_dataset import small

FAR = np.array([691000.0, 5335000.0, 500.0])


@pytest.fixture
def boxes(tmp_path):
    """A box, and the same one as a file in UTM coordinates."""
    box = shapes.box((2, 1, 0.5))
    box.save(tmp_path / "near.ply")
    box.V = box.V + FAR
    box.save(tmp_path / "far.ply")
    assert np.abs(Mesh(tmp_path / "far.ply").offset - FAR).max() < 10
    return str(tmp_path / "near.ply"), str(tmp_path / "far.ply")


def thing(source, **changes):
    return ObjectSpec(source, "thing", (1, 1), 0.8, **changes)


@pytest.mark.parametrize("mode", ["frustum", "surface"])
def test_files_far_from_zero_are_placed_as_others(boxes, mode):
    near, far = boxes
    placement = PlacementSpec(mode, radius=1.0)
    first, second, third = (FrameMaker(small(objects=objects, placement=placement)).make(0)
                            for objects in ([thing(near)] * 2, [thing(near), thing(far)], [thing(far), thing(near)]))
    np.testing.assert_array_equal(first.depth, second.depth)
    np.testing.assert_array_equal(first.depth, third.depth)


def test_models_of_files_far_from_zero(boxes):
    near, far = (trimesh.load(io.BytesIO(model_ply(path, 0.8)), file_type="ply", process=False) for path in boxes)
    np.testing.assert_allclose(far.extents, near.extents, rtol=1e-5)
    assert np.abs(far.vertices).max() < 2000


def test_georeferenced_glb_files(boxes, tmp_path):
    """The offset of a GLB is the translation of a node."""
    Mesh(boxes[1]).save(tmp_path / "far.glb")
    local = without_offset(Mesh(tmp_path / "far.glb"))
    # The box reaches 1 from its centre, to which the offset is rounded by 0.5 at most.
    assert np.abs(vertices_of(local)).max() < 2
    near, far = (trimesh.load(io.BytesIO(model_ply(path, 0.8)), file_type="ply", process=False)
                 for path in (boxes[0], str(tmp_path / "far.glb")))
    # float32 of 400 mm has spacings of 2^-15 mm; the shortest side has 200 mm: 1.5e-7 of it, at both of its ends.
    np.testing.assert_allclose(far.extents, near.extents, rtol=1e-6)
    assert np.abs(far.vertices).max() < 2000


def test_surroundings_far_from_zero(tmp_path):
    x, y = (a.ravel() for a in np.meshgrid(*[np.linspace(-1, 1, 40)] * 2))
    means = np.stack([x, y, 0 * x], 1) + FAR
    easypbr.splats(means, 0.04, opacities=0.99, colors=np.ones((1600, 3))).save(tmp_path / "wall.ply")
    spec = small(objects=[thing("builtin:shapes")], placement=PlacementSpec(distance=2.0),
                 surroundings=SurroundingsSpec(str(tmp_path / "wall.ply"), 20.0))
    frame = FrameMaker(spec).make(0)
    assert ((frame.depth > 0) & (frame.instance_id == 0)).mean() > 0.3


def test_offsets_move_into_poses(boxes):
    """Of a mesh, a child of another offset that is turned, and a child of that one, as merge() places them."""
    root, child, last = (Mesh(boxes[1]) for _ in range(3))
    for mesh, axis, offset in ((child, (0, 0, 1), FAR + (10, 0, 0)), (last, (0, 1, 0), FAR - (0, 5, 0))):
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = turn_about(np.array(axis, float), 0.5), (1, 2, 3)
        mesh.T_parent_mesh, mesh.offset = T, offset
    root.offset = FAR
    root.add_child(child)
    child.add_child(last)
    wanted = root.merge()
    local = without_offset(root)
    assert not np.any(local.offset) and not np.any(local.children[0].offset)
    np.testing.assert_allclose(vertices_of(local) + FAR, wanted.V.astype(float) + wanted.offset, atol=1e-4)


def test_sizes_are_those_of_turned_nodes(tmp_path):
    """A ball in a node that is turned: the boxes of its box are up to sqrt(3) longer."""
    root, ball = Mesh(), shapes.icosphere(0.5, 4)
    T = np.eye(4)
    T[:3, :3] = turn_about(np.array([0.0, 1, 0]), np.radians(35.26)) @ turn_about(np.array([1.0, 0, 0]), np.radians(45))
    ball.T_parent_mesh = T
    root.add_child(ball)
    root.save(tmp_path / "ball.glb")
    low, high = bounds(Mesh(tmp_path / "ball.glb"))
    np.testing.assert_allclose([low, high], [[-0.5] * 3, [0.5] * 3], atol=5e-3)  # facets of an icosphere
    spec = small(objects=[ObjectSpec(str(tmp_path / "ball.glb"), "ball", (1, 1), 1.0)], writers=("bop",))
    (entry,) = FrameMaker(spec).make(0).objects
    assert entry["diameter"] == pytest.approx(1, abs=5e-3)


def test_values_are_kept_up_to_a_number_of_bytes():
    kept = Kept(10)
    for key in "abc":
        kept.put(key, key.upper(), 4)
    assert kept.get("a") is None and kept.get("b") == "B"
    kept.put("d", "D", 4)
    assert kept.get("c") is None and kept.get("b") == "B" and kept.get("d") == "D"
    kept.put("e", "E", 100)
    assert [kept.get(key) for key in "bde"] == [None, None, "E"]


def test_makers_keep_few_of_many_files(tmp_path, monkeypatch):
    """What is read again gives the same frames."""
    for i in range(5):
        shapes.torus(0.3, 0.1, 20 + i, 12).save(tmp_path / f"{i}.ply")
    monkeypatch.setattr("easypbr.dataset.frames._MOST_KEPT", 2 * bytes_of(Mesh(tmp_path / "4.ply")))
    spec = small(objects=[thing(str(tmp_path))])
    maker = FrameMaker(spec)
    frames = [maker.make(index) for index in range(12)]
    assert len(maker._models._values) == 2
    np.testing.assert_array_equal(maker.make(0).picture, frames[0].picture)


def test_bytes_of_meshes():
    mesh = shapes.box()
    before = bytes_of(mesh)
    assert before == sum(getattr(mesh, name).nbytes for name in ("V", "N", "UV", "F"))
    mesh.material.base_color_texture = np.zeros((8, 16, 3), np.uint8)
    assert bytes_of(mesh) == before + 8 * 16 * 3
