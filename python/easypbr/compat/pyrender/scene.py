"""Scenes: trees of nodes."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import ArgumentError
from .bounded import Bounded
from .camera import Camera
from .changes import Latest, note
from .colors import color
from .light import DirectionalLight, Light, PointLight, SpotLight
from .mesh import Mesh
from .node import Node

_ONE_PARENT = "Scene: expected nodes with one parent each"


class Scene(Bounded):
    """Nodes, a background colour (sRGB, alpha counts with RenderFlags.RGBA) and ambient light (linear). Whole numbers of colours
    are 0 to 255, others 0 to 1."""

    def __init__(
        self,
        nodes: Sequence[Node] | None = None,
        bg_color: ArrayLike | None = None,
        ambient_light: ArrayLike | None = None,
        name: str | None = None,
    ) -> None:
        self.name = name
        self.bg_color, self.ambient_light = bg_color, ambient_light
        #: In the order in which they were added: keys, for a list is searched for what is removed.
        self._roots: dict[Node, None] = {}
        #: The parent of each node, None for roots, in the order in which they were added; as of the change `_seen` of trees.
        self._parents: dict[Node, Node | None] = {}
        self._seen = Latest.tree
        self._main_camera_node: Node | None = None
        inner = {id(child) for node in nodes or () for child in node.children}
        for node in nodes or ():
            if id(node) not in inner:
                self.add_node(node)
        if any(node not in self._parents for node in nodes or ()):
            raise ValueError(_ONE_PARENT)  # A cycle, which nothing leads into.

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._roots, self._parents = dict.fromkeys(self._roots), dict(self._parents)  # copy.copy() gives those of the original.
        self._seen = -1  # Numbers of changes are those of a process.

    @property
    def bg_color(self) -> NDArray[Any]:
        return self._bg_color

    @bg_color.setter
    def bg_color(self, value: ArrayLike | None) -> None:
        self._bg_color = color(value, 4, 1.0)
        note()

    @property
    def ambient_light(self) -> NDArray[Any]:
        return self._ambient_light

    @ambient_light.setter
    def ambient_light(self, value: ArrayLike | None) -> None:
        self._ambient_light = color(value, 3, 0.0)
        note()

    def walk(self) -> Iterator[tuple[Node, Node | None, NDArray[Any]]]:
        """Each node with its parent and its 4 x 4 pose in the world, parents first. Raises ValueError as all do that look at
        the tree: where lists of children give a node two parents, or a cycle."""
        self._tree()
        waiting: list[tuple[Node, Node | None, NDArray[Any]]] = [(node, None, np.eye(4)) for node in reversed(self._roots)]
        while waiting:
            node, parent, above = waiting.pop()
            pose = above @ node.matrix
            yield node, parent, pose
            waiting.extend((child, node, pose) for child in reversed(node.children))

    def _tree(self) -> dict[Node, Node | None]:
        """The parent of each node, after lists of children may have been changed by others."""
        if self._seen != Latest.tree:
            seen = Latest.tree
            found = self._below((root, None) for root in self._roots)
            kept = {node: found.pop(node) for node in self._parents if node in found}
            self._parents, self._seen = kept | found, seen
        return self._parents

    @property
    def nodes(self) -> set[Node]:
        return set(self._tree())

    def _ordered(self, attribute: str, kind: type = object) -> list[Node]:
        """In the order in which they were added."""
        return [node for node in self._tree() if (held := getattr(node, attribute)) is not None and isinstance(held, kind)]

    @property
    def mesh_nodes(self) -> set[Node]:
        return set(self._ordered("mesh"))

    @property
    def camera_nodes(self) -> set[Node]:
        return set(self._ordered("camera"))

    @property
    def light_nodes(self) -> set[Node]:
        return set(self._ordered("light"))

    @property
    def point_light_nodes(self) -> set[Node]:
        return set(self._ordered("light", PointLight))

    @property
    def spot_light_nodes(self) -> set[Node]:
        return set(self._ordered("light", SpotLight))

    @property
    def directional_light_nodes(self) -> set[Node]:
        return set(self._ordered("light", DirectionalLight))

    @property
    def meshes(self) -> set[Mesh]:
        return {node.mesh for node in self._ordered("mesh") if node.mesh is not None}

    @property
    def cameras(self) -> set[Camera]:
        return {node.camera for node in self._ordered("camera") if node.camera is not None}

    @property
    def lights(self) -> set[Light]:
        return {node.light for node in self._ordered("light") if node.light is not None}

    @property
    def point_lights(self) -> set[Light]:
        return {light for light in self.lights if isinstance(light, PointLight)}

    @property
    def spot_lights(self) -> set[Light]:
        return {light for light in self.lights if isinstance(light, SpotLight)}

    @property
    def directional_lights(self) -> set[Light]:
        return {light for light in self.lights if isinstance(light, DirectionalLight)}

    @property
    def main_camera_node(self) -> Node | None:
        """The node whose camera is drawn from: the first that was added, unless another one is assigned."""
        node = self._main_camera_node
        if node is None or node.camera is None or not self.has_node(node):
            self._main_camera_node = next(iter(self._ordered("camera")), None)
        return self._main_camera_node

    @main_camera_node.setter
    def main_camera_node(self, node: Node) -> None:
        if not isinstance(node, Node) or node.camera is None or not self.has_node(node):
            raise ArgumentError("main_camera_node: expected a node of this scene that has a camera")
        self._main_camera_node = node
        note()

    @property
    def bounds(self) -> NDArray[Any]:
        """Lower and upper corner of all meshes in the world, 2 x 3."""
        corners = []
        for node, _, pose in self.walk():
            if node.mesh is None:
                continue
            low, high = node.mesh.bounds
            box = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
            corners.append(box @ pose[:3, :3].T + pose[:3, 3])
        if not corners:
            return np.zeros((2, 3))
        points = np.concatenate(corners)
        return np.array([points.min(axis=0), points.max(axis=0)])

    def add(
        self,
        obj: Mesh | Light | Camera,
        name: str | None = None,
        pose: ArrayLike | None = None,
        parent_node: Node | None = None,
        parent_name: str | None = None,
    ) -> Node:
        """Adds a mesh, a light or a camera with a pose, and returns its node."""
        kinds = {"mesh": Mesh, "light": Light, "camera": Camera}
        found = [attribute for attribute, kind in kinds.items() if isinstance(obj, kind)]
        if not found:
            raise TypeError(f"Scene.add: expected a Mesh, a Light or a Camera, got a {type(obj).__name__}")
        node = Node(name=name, matrix=pose)
        setattr(node, found[0], obj)
        if parent_name is not None and parent_node is None:
            named = self.get_nodes(name=parent_name)
            if len(named) != 1:
                raise ValueError(f"Scene.add: expected one node with the name '{parent_name}', got {len(named)}")
            parent_node = next(iter(named))
        self.add_node(node, parent_node)
        return node

    def add_node(self, node: Node, parent_node: Node | None = None) -> None:
        """Adds a node with its children. One that was appended to the parent's list of children is there already."""
        tree = self._tree()
        if parent_node is not None and tree.get(node) is parent_node:
            return
        if node in tree:
            raise ValueError("Scene.add_node: the node is in the scene already")
        if parent_node is not None and parent_node not in tree:
            raise ValueError("Scene.add_node: the parent is not in the scene")
        added = self._below([(node, parent_node)])
        if any(below in tree for below in added):
            raise ValueError("Scene.add_node: a child of the node is in the scene already")
        if parent_node is None:
            self._roots[node] = None
        else:
            parent_node.children.append(node)
        tree.update(added)
        self._note(parent_node)

    def has_node(self, node: Node) -> bool:
        return node in self._tree()

    def remove_node(self, node: Node) -> None:
        """Removes a node with its children."""
        tree = self._tree()
        if node not in tree:
            raise ValueError("Scene.remove_node: the node is not in the scene")
        parent = tree[node]
        removed = self._below([(node, parent)])
        if parent is None:
            del self._roots[node]
        else:
            parent.children.remove(node)
        for below in removed:
            del tree[below]
        self._note(parent)

    @staticmethod
    def _below(tops: Iterable[tuple[Node, Node | None]]) -> dict[Node, Node | None]:
        """Nodes, given with their parents, and all that is below them, with the parent of each; parents first."""
        found: dict[Node, Node | None] = {}
        waiting = list(tops)[::-1]
        while waiting:
            node, parent = waiting.pop()
            if node in found:
                raise ValueError(_ONE_PARENT)
            found[node] = parent
            waiting.extend((child, node) for child in reversed(node.children))
        return found

    def _note(self, parent: Node | None) -> None:
        """Notes a change below a node that `_parents` has been told of."""
        if parent is None:
            note()  # No list of children has changed.
        else:
            self._seen = Latest.tree

    def clear(self) -> None:
        """Removes all nodes."""
        self._roots.clear()
        self._parents.clear()
        note()

    def get_nodes(
        self, node: Node | None = None, name: str | None = None, obj: Any = None, obj_name: str | None = None
    ) -> set[Node]:
        """The nodes that all given conditions hold for."""
        found = set()
        for known in self._tree() if node is None else [node] if self.has_node(node) else []:
            if name is not None and known.name != name:
                continue
            held = [thing for thing in (known.mesh, known.camera, known.light) if thing is not None]
            fits = obj is None or any(thing is obj for thing in held)
            if fits and (obj_name is None or any(thing.name == obj_name for thing in held)):
                found.add(known)
        return found

    def get_pose(self, node: Node) -> NDArray[Any]:
        """The node's 4 x 4 pose in the world."""
        tree = self._tree()
        if node not in tree:
            raise ValueError("Scene.get_pose: the node is not in the scene")
        pose, above = node.matrix, tree[node]
        while above is not None:
            pose, above = above.matrix @ pose, tree[above]
        return pose

    def set_pose(self, node: Node, pose: ArrayLike) -> None:
        """Sets the node's pose, 4 x 4, in its parent's frame."""
        if not self.has_node(node):
            raise ValueError("Scene.set_pose: the node is not in the scene")
        node.matrix = np.asarray(pose)

    @staticmethod
    def from_trimesh_scene(trimesh_scene: Any, bg_color: ArrayLike | None = None, ambient_light: ArrayLike | None = None) -> "Scene":
        """A scene of a trimesh.Scene."""
        scene = Scene(bg_color=bg_color, ambient_light=ambient_light)
        meshes = {name: Mesh.from_trimesh(geometry) for name, geometry in trimesh_scene.geometry.items()}
        for name in trimesh_scene.graph.nodes_geometry:
            pose, geometry = trimesh_scene.graph[name]
            scene.add(meshes[geometry], name=name, pose=pose)
        return scene
