"""A pyrender scene as EasyPBR's: kept from image to image, so that only what changed is made again."""

from collections.abc import Container, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import _easypbr
from ...scene import Scene as OwnScene
from ...viewer import Viewer as OwnViewer
from .constants import RenderFlags
from .light import DirectionalLight, Light, PointLight, SpotLight
from .lines import segments_of
from .mesh import Mesh, Primitive
from .node import Node
from .projection import Projection
from .scene import Scene

_STUDIO = ("key", "fill", "rim")
_SHADOWS = ((DirectionalLight, RenderFlags.SHADOWS_DIRECTIONAL), (PointLight, RenderFlags.SHADOWS_POINT), (SpotLight, RenderFlags.SHADOWS_SPOT))
#: pyrender draws with four samples per pixel, too.
_SAMPLES = 4


def _state(primitive: Primitive, is_flat: bool) -> tuple[list[Any], tuple[Any, ...]]:
    """What a primitive was made from: objects that are compared by identity, and values."""
    p, material = primitive, primitive.material
    images = [None if texture is None else texture.source for texture in material.textures()]
    objects = [p.positions, p.normals, p.indices, p.color_0, p.texcoord_0, p.poses, material, *images]
    color, metallic, roughness = material._color_and_numbers()
    values = (tuple(color), metallic, roughness, tuple(material.emissiveFactor), material.alphaMode, material.alphaCutoff,
              material.doubleSided, material.smooth, p.mode, is_flat)  # fmt: skip
    return objects, values


def _is_same(a: tuple[list[Any], tuple[Any, ...]], b: tuple[list[Any], tuple[Any, ...]]) -> bool:
    return a[1] == b[1] and len(a[0]) == len(b[0]) and all(x is y for x, y in zip(a[0], b[0]))


@dataclass(eq=False)
class _Prototype:
    """What was made of a primitive."""

    state: tuple[list[Any], tuple[Any, ...]]
    mesh: "_easypbr.Mesh"
    #: Whether it is blended with what is behind it.
    is_clear: bool

    @cached_property
    def ends(self) -> NDArray[Any]:
        """k x 2 x 3: ends of the lines that it is drawn with, in its own frame."""
        part = self.mesh if len(self.mesh.V) else self.mesh.children[0]
        return np.asarray(part.V, dtype=np.float64)[segments_of(part)]


class Drawing:
    """Draws a pyrender scene with a viewer of its own."""

    view: OwnViewer

    def __init__(self) -> None:
        self.view = OwnViewer(scene=OwnScene())
        #: Names of objects: the nodes that they show.
        self.shown: dict[str, Node] = {}
        self._primitives: dict[Primitive, _Prototype] = {}
        self._nodes: dict[Node, tuple[str, list[_easypbr.Mesh], _easypbr.Mesh]] = {}
        #: What is measured otherwise than it is drawn: parts that are seen through, with their alpha modes; parts whose faces
        #: are drawn as lines; what is drawn as lines, with nodes and poses.
        self._clear: list[tuple[_easypbr.Mesh, str]] = []
        self._wires: list[_easypbr.Mesh] = []
        self._lines: list[tuple[Node, _easypbr.Mesh, _Prototype, NDArray[Any]]] = []
        self._is_flat = False
        #: Lights that move with the camera, with their poses in its frame; the flags that say whether they cast shadows.
        self.carried: list[tuple[Light, NDArray[Any]]] = []
        self._carried_flags = 0
        self._ambient: tuple[float, ...] | None = None
        self._count = 0
        self.view.settings.update({
            "ground.mode": "none", "path.enabled": False, "shadows.mode": "pcf", "image.samples": _SAMPLES, "annotation.legend": False, "annotation.colorbar": False,
        })  # fmt: skip

    def update(
        self,
        scene: Scene,
        flags: int,
        only: "Container[Node] | None" = None,
        point_size: float = 1.0,
        carried: "Sequence[tuple[Light, NDArray[Any]]]" = (),
    ) -> None:
        """Takes over nodes, lights and the background. `only`: nodes that are drawn, None: all. `carried`: lights that carry()
        puts where the camera is, with their poses in its frame."""
        self.carried = list(carried)
        used: set[Node] = set()
        prototypes: set[Primitive] = set()
        self.shown, self._clear, self._wires, self._lines = {}, [], [], []
        if not flags & (RenderFlags.DEPTH_ONLY | RenderFlags.SEG):  # Depths alone need no colours made anew.
            self._is_flat = bool(flags & RenderFlags.FLAT)
        lights = []
        for node, _, pose in scene.walk():
            if node.light is not None:
                lights.append((node.light, pose))
            mesh = node.mesh
            if mesh is None or not mesh.is_visible or not mesh.primitives or (only is not None and node not in only):
                continue
            used.add(node)
            prototypes.update(mesh.primitives)
            self._show(node, mesh, pose, flags, point_size)
        for node in [known for known in self._nodes if known not in used]:
            self.view.scene.remove(self._nodes.pop(node)[0])
        for primitive in [known for known in self._primitives if known not in prototypes]:
            del self._primitives[primitive]
        self._light(scene, lights, flags)

    def _show(self, node: Node, mesh: Mesh, pose: NDArray[Any], flags: int, point_size: float) -> None:
        made = [self._made(primitive) for primitive in mesh.primitives]
        name, parts, root = self._nodes.get(node, ("", [], None))
        if root is None or len(parts) != len(made) or any(a is not b for a, b in zip(parts, made)):
            if root is None:
                self._count += 1
                name = f"node {self._count}"
            children = [prototype.clone() for prototype in made]
            root = children[0] if len(children) == 1 and mesh.primitives[0].poses is None else _easypbr.Mesh()
            for child in children if root is not children[0] else ():
                root.add_child(child)
            self.view.scene.show(root, name)
            self._nodes[node] = name, made, root
        root.T_parent_mesh = pose
        branches = [root] if len(made) == 1 and mesh.primitives[0].poses is None else root.children
        for primitive, branch in zip(mesh.primitives, branches):
            is_wire = _is_wire(primitive, flags)
            prototype = self._primitives[primitive]
            for part, T_world_part in _all_parts(branch, pose if branch is root else pose @ branch.T_parent_mesh):
                self._style(part, flags, point_size, is_wire)
                if prototype.is_clear:
                    self._clear.append((part, part.material.alpha_mode))
                if is_wire and len(part.F):
                    self._wires.append(part)
                if len(part.E) or (is_wire and len(part.F)):
                    self._lines.append((node, part, prototype, T_world_part))
        self.shown[name] = node

    def _made(self, primitive: Primitive) -> "_easypbr.Mesh":
        state = _state(primitive, self._is_flat)
        known = self._primitives.get(primitive)
        if known is None or not _is_same(known.state, state):
            is_clear = primitive.is_transparent and primitive.material.alphaMode == "BLEND"
            known = self._primitives[primitive] = _Prototype(state, primitive.made(self._is_flat), is_clear)
        return known.mesh

    def _style(self, part: "_easypbr.Mesh", flags: int, point_size: float, is_wire: bool) -> None:
        style = part.style
        is_cloud = len(part.F) == 0 and len(part.E) == 0
        values: dict[str, Any] = {
            "two_sided": bool(flags & RenderFlags.SKIP_CULL_FACES) or part.material.double_sided,
            "lit": not flags & RenderFlags.FLAT,
            "line_width": 1.0,
        }
        if is_cloud:
            values["mode"] = "points"
            values["point_size"] = max(float(point_size), 1.0)
        elif len(part.F):
            values["mode"] = "lines" if is_wire else "mesh"
        for name, value in values.items():
            if getattr(style, name) != value:
                setattr(style, name, value)

    def layers(self, names: list[str], size: tuple[int, int], is_solid: bool) -> dict[str, NDArray[Any]]:
        """Layers of what is drawn, however transparent it is. `is_solid`: of the faces of wireframes, too."""
        solid = self._wires if is_solid else []
        for part, _ in self._clear:
            part.material.alpha_mode = "opaque"
        for part in solid:
            part.style.mode = "mesh"
        try:
            return self.view.layers(names, size)
        finally:
            for part, mode in self._clear:
                part.material.alpha_mode = mode
            for part in solid:
                part.style.mode = "lines"

    def lines(self, is_solid: bool) -> "list[tuple[Node, NDArray[Any]]]":
        """Nodes with the ends (k x 2 x 3, in the world) of the lines that they draw. `is_solid`: without those of wireframes."""
        solid = set(map(id, self._wires)) if is_solid else set()
        drawn = [(node, prototype.ends, T) for node, part, prototype, T in self._lines if id(part) not in solid]
        return [(node, ends @ T[:3, :3].T + T[:3, 3]) for node, ends, T in drawn]

    def _light(self, scene: Scene, lights: list[Any], flags: int) -> None:
        own, settings = self.view.scene, self.view.settings
        for name in own.light_names():
            own.remove_light(name)
        for number, (light, pose) in enumerate(lights):
            own.set_light(f"light {number}", light.made(pose, _casts(light, flags)))
        self._carried_flags = flags
        ambient = tuple(float(part) for part in scene.ambient_light)
        is_given = bool(lights) or bool(self.carried) or any(ambient)
        if self._ambient != (ambient if is_given else None):
            self._ambient = ambient if is_given else None
            own.environment = np.full((8, 16, 3), ambient, np.float32) if any(ambient) else _easypbr.Environment()
        # pyrender's numbers are what is seen; a scene without any light, which it draws black, is lit automatically.
        chosen: dict[str, Any] = {"tonemap.operator": "none", "tonemap.exposure": 1.0, "environment.intensity": 1.0}
        automatic: dict[str, Any] = {name: _easypbr.field(name).default for name in chosen}
        values = chosen if is_given else automatic
        values["environment.enabled"] = values["ssao.enabled"] = any(ambient) or not is_given
        values.update({f"lights.{name}.enabled": _easypbr.auto if not is_given else False for name in _STUDIO})
        for name, value in values.items():
            settings[name] = value

    def carry(self, pose: NDArray[Any]) -> None:
        """Puts the lights that move with the camera to its pose."""
        for number, (light, local) in enumerate(self.carried):
            self.view.scene.set_light(f"camera light {number}", light.made(pose @ local, _casts(light, self._carried_flags)))

    def set_camera(self, projection: Projection) -> None:
        """Draws with a projection."""
        self.view.camera = projection.own
        self.view.settings["camera.near"] = projection.own.near

    def close(self) -> None:
        """Forgets everything, the context too."""
        self.shown, self._primitives, self._nodes = {}, {}, {}
        self._clear, self._wires, self._lines = [], [], []
        self.view = OwnViewer(scene=OwnScene())


def _casts(light: Light, flags: int) -> bool:
    """Whether a light casts shadows."""
    return any(isinstance(light, kind) and bool(flags & flag) for kind, flag in _SHADOWS)


def _is_wire(primitive: Primitive, flags: int) -> bool:
    """Whether the edges of its faces are drawn in their place."""
    return bool(flags & RenderFlags.ALL_WIREFRAME) or primitive.material.wireframe != bool(flags & RenderFlags.FLIP_WIREFRAME)


def _all_parts(mesh: "_easypbr.Mesh", T: NDArray[Any]) -> "list[tuple[_easypbr.Mesh, NDArray[Any]]]":
    """The meshes that are drawn, each with its pose in the world. `T`: that of `mesh`."""
    parts = [(mesh, T)]
    for child in mesh.children:
        parts += _all_parts(child, T @ child.T_parent_mesh)
    return [part for part in parts if len(part[0].V)]
