"""easypbr.compat.pyrender: trees of nodes, their cameras, and what a change costs."""

import copy
import pickle

import numpy as np
import pytest

import easypbr.compat.pyrender as pyrender
from easypbr.compat.pyrender import Node


def at(x, y, z):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def camera():
    return pyrender.PerspectiveCamera(yfov=1.0)


@pytest.fixture
def counted(monkeypatch):
    """Counts the nodes that scenes walk over, and the poses that are computed."""
    counts = {"walked": 0, "matrices": 0}
    walk, matrix = pyrender.Scene.walk, Node.matrix

    def counting(scene):
        for found in walk(scene):
            counts["walked"] += 1
            yield found

    def get(node):
        counts["matrices"] += 1
        return matrix.fget(node)

    monkeypatch.setattr(pyrender.Scene, "walk", counting)
    monkeypatch.setattr(Node, "matrix", property(get, matrix.fset))
    return counts


def test_changes_of_a_tree_do_not_walk_over_it(counted):
    scene = pyrender.Scene()
    arm = scene.add(camera(), pose=at(1, 0, 0))
    nodes = [scene.add(camera(), pose=at(0, i, 0), parent_node=arm if i % 2 else None) for i in range(100)]
    for i, node in enumerate(nodes):
        scene.set_pose(node, at(0, 0, i))
        assert scene.get_pose(node)[2, 3] == i and scene.get_pose(node)[0, 3] == i % 2
        assert scene.has_node(node) and scene.main_camera_node is arm
    for node in nodes:
        scene.remove_node(node)
    assert scene.nodes == {arm} and not arm.children and not scene.has_node(nodes[0])
    assert counted["walked"] == 0
    assert counted["matrices"] <= 100 * 2 * 2, "a pose is that of a node and of its parents"


def test_lists_of_children_may_be_changed():
    scene = pyrender.Scene()
    root = scene.add(camera(), pose=at(1, 0, 0))
    hand, finger = Node(matrix=at(0, 1, 0), camera=camera()), Node(matrix=at(0, 0, 1))
    assert not scene.has_node(hand)
    root.children.append(hand)
    assert scene.has_node(hand) and scene.get_pose(hand)[:3, 3].tolist() == [1, 1, 0]
    hand.children += [finger]
    assert scene.get_pose(finger)[:3, 3].tolist() == [1, 1, 1]
    root.children = [finger]
    assert scene.nodes == {root, finger} and scene.get_pose(finger)[:3, 3].tolist() == [1, 0, 1]
    del root.children[0]
    assert scene.nodes == {root} and scene.camera_nodes == {root}
    with pytest.raises(ValueError, match="not in the scene"):
        scene.remove_node(finger)


def test_a_node_of_two_scenes_has_its_children_in_both():
    shared, child = Node(), Node()
    scenes = [pyrender.Scene([shared]), pyrender.Scene([shared])]
    scenes[0].add_node(child, shared)
    assert [scene.has_node(child) for scene in scenes] == [True, True]
    scenes[1].remove_node(child)
    assert [scene.has_node(child) for scene in scenes] == [False, False]


def test_nodes_have_one_parent_and_are_added_once():
    child = Node()
    parent = Node(children=[child])
    scene = pyrender.Scene([parent, child])
    assert scene.nodes == {parent, child}
    for wrong, message in (
        (child, "the node is in the scene already"),
        (Node(children=[child]), "a child of the node is in the scene already"),
        (Node(children=[once := Node(), once]), "expected nodes with one parent each"),
    ):
        with pytest.raises(ValueError, match=message):
            scene.add_node(wrong)
    assert scene.nodes == {parent, child}, "what is refused changes nothing"


def test_the_main_camera_is_the_first_that_was_added():
    """Not the first of the tree: `late` is below a node that was added before `first`."""
    scene = pyrender.Scene()
    root = Node()
    scene.add_node(root)
    first = scene.add(camera())
    late = scene.add(camera(), parent_node=root)
    copies = [copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))]
    assert scene.main_camera_node is first
    assert all(made.main_camera_node in made._roots for made in copies)
    scene.main_camera_node = late
    assert scene.main_camera_node is late
    scene.remove_node(root)
    assert scene.main_camera_node is first
    first.camera = None
    assert scene.main_camera_node is None
    with pytest.raises(ValueError, match="expected a node of this scene that has a camera"):
        scene.main_camera_node = late
