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
    below, matrix = pyrender.Scene._below, Node.matrix

    def counting(tops):
        found = below(tops)
        counts["walked"] += len(found)
        return found

    def get(node):
        counts["matrices"] += 1
        return matrix.fget(node)

    monkeypatch.setattr(pyrender.Scene, "_below", staticmethod(counting))
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
    assert counted["walked"] == 101 + 100, "each node when it is added, and when it is removed"
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


def test_a_node_may_be_appended_and_added():
    """As pyrender 0.1.45 takes it."""
    scene = pyrender.Scene()
    root, other = scene.add(camera(), pose=at(1, 0, 0)), scene.add(camera())
    child = Node(children=[Node()])
    root.children.append(child)
    scene.add_node(child, parent_node=root)
    assert root.children == [child] and scene.nodes == {root, other, child, *child.children}
    assert scene.get_pose(child)[0, 3] == 1
    for parent in (None, other):
        with pytest.raises(ValueError, match="the node is in the scene already"):
            scene.add_node(child, parent)
    with pytest.raises(ValueError, match="the node is in the scene already"):
        scene.add_node(root)


def looped():
    a, b = Node(), Node()
    a.children, b.children = [b], [a]
    return a, b


@pytest.mark.parametrize("wrong", [
    lambda root, other: other.children.append(root.children[0]),
    lambda root, other: root.children.append(other),
    lambda root, other: root.children.append(root.children[0]),
    lambda root, other: root.children[0].children.append(root),
    lambda root, other: root.children[0].children.append(root.children[0]),
    lambda root, other: root.children[0].children.extend(looped()),
])  # fmt: skip
def test_lists_of_children_that_are_no_tree_are_refused(wrong):
    scene = pyrender.Scene()
    root, other = scene.add(camera()), scene.add(camera())
    child = scene.add(camera(), parent_node=root)
    wrong(root, other)
    lists = [list(node.children) for node in (root, other, child)]
    for look in (
        lambda: scene.nodes, lambda: scene.remove_node(child), lambda: scene.remove_node(root), lambda: scene.add(camera()),
        lambda: scene.get_pose(child), lambda: list(scene.walk()), lambda: scene.bounds, lambda: scene.main_camera_node,
    ):  # fmt: skip
        with pytest.raises(ValueError, match="Scene: expected nodes with one parent each"):
            look()
    assert [node.children for node in (root, other, child)] == lists, "what is refused changes nothing"
    root.children, other.children, child.children = [child], [], []
    assert scene.nodes == {root, other, child}


def test_cycles_are_no_scenes():
    a, b = looped()
    for given in ([a, b], [a], [Node(), a, b]):
        with pytest.raises(ValueError, match="Scene: expected nodes with one parent each"):
            pyrender.Scene(given)


def test_a_shallow_copy_has_roots_of_its_own():
    scene = pyrender.Scene()
    root = scene.add(camera())
    other = copy.copy(scene)
    added = other.add(camera())
    other.remove_node(root)
    for made, node in ((scene, root), (other, added)):
        assert made.nodes == {node} and [found for found, _, _ in made.walk()] == [node]
    assert (scene.main_camera_node, other.main_camera_node) == (root, added)
    scene.clear()
    assert other.nodes == {added}


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
