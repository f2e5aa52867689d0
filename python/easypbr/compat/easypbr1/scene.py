"""Scene: the meshes that all viewers show."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import UnknownNameError
from ...scene import Scene as OwnScene
from .mesh import Mesh
from .vis_options import VisOptions

_shown: dict[str, Mesh] = {}
#: What viewers ask before they draw; None: nobody has said.
floor: dict[str, bool | None] = {"visible": None}


class _FloorOptions(VisOptions):
    """Options of the ground: whether it is visible."""

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, value)
        if name == "m_is_visible":
            floor["visible"] = bool(value)


def _ground() -> Mesh:
    """What scripts get as the mesh "grid_floor", to hide it."""
    mesh = Mesh()
    mesh.m_vis, mesh.name = _FloorOptions(), "grid_floor"
    mesh.m_vis._values["m_is_visible"] = floor["visible"] is not False
    return mesh


def flush() -> None:
    """Hands over what was assigned to shown meshes since."""
    for mesh in _shown.values():
        mesh.handle()


class Scene:
    """The one scene there is; all methods are static."""

    @staticmethod
    def show(mesh: Mesh, name: str) -> None:
        """Shows a mesh, or replaces the one of that name."""
        OwnScene.show(mesh.handle(), name)
        mesh.name = name
        _shown[name] = mesh

    add_mesh = show

    @staticmethod
    def get_mesh_with_name(name: str) -> Mesh:
        if name == "grid_floor" and name not in _shown:
            return _ground()
        if name not in _shown:
            raise UnknownNameError(f"there is no mesh '{name}' in the scene: there are {', '.join(_shown) or 'none'}")
        return _shown[name]

    @staticmethod
    def get_mesh_with_idx(index: int) -> Mesh:
        if not 0 <= index < len(_shown):
            raise UnknownNameError(f"there is no mesh {index} in the scene: there are {len(_shown)}")
        return Scene._all()[index]

    @staticmethod
    def does_mesh_with_name_exist(name: str) -> bool:
        return name in _shown

    @staticmethod
    def nr_meshes() -> int:
        return len(_shown)

    @staticmethod
    def remove_meshes_starting_with_name(prefix: str) -> None:
        for name in [name for name in _shown if name.startswith(prefix)]:
            OwnScene.remove(name)
            del _shown[name]

    @staticmethod
    def clear() -> None:
        Scene.remove_meshes_starting_with_name("")

    @staticmethod
    def hide_all() -> None:
        Scene._set_visible(False)

    @staticmethod
    def show_all() -> None:
        Scene._set_visible(True)

    @staticmethod
    def _all() -> list[Mesh]:
        return list(_shown.values())

    @staticmethod
    def _set_visible(visible: bool) -> None:
        for mesh in _shown.values():
            mesh.m_vis.m_is_visible = visible

    @staticmethod
    def _box() -> NDArray[Any]:
        boxes = [mesh.handle().bounding_box() for mesh in _shown.values() if mesh._has_vertices()]
        return np.array([np.min([box[0] for box in boxes], axis=0), np.max([box[1] for box in boxes], axis=0)]) if boxes else np.zeros((2, 3))

    @staticmethod
    def get_scale(use_mutex: bool = True) -> float:
        """Longest side of the box around everything."""
        low, high = Scene._box()
        return float((high - low).max())

    @staticmethod
    def get_centroid() -> NDArray[Any]:
        return Scene._box().mean(axis=0)

    @staticmethod
    def set_floor_visible(visible: bool) -> None:
        """Whether viewers draw a ground, from their next picture on."""
        floor["visible"] = bool(visible)
