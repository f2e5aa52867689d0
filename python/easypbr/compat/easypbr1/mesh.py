"""Mesh: arrays by the first EasyPBR's names, drawn as a mesh of EasyPBR."""

import os
import weakref
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ... import _easypbr, shapes
from ...errors import ArgumentError
from .affine import Affine3d, pose_from_string
from .helpers import LabelMngr
from .mat import Mat, _swapped
from .vis_options import VisOptions

#: Their arrays and ours.
_ARRAYS = {"V": "V", "F": "F", "C": "C", "E": "E", "NV": "N", "UV": "UV", "I": "I", "V_tangent_u": "T", "V_lenght_v": "B"}
_LABELS = ("L_pred", "L_gt")
_OWN = ("V", "N", "C", "UV", "T", "B", "F", "E", "L", "I")


class Mesh:
    """Arrays are assigned in any order and in steps; they must fit each other when the mesh is drawn, saved or changed by a method,
    else that raises ArgumentError."""

    m_vis: VisOptions
    m_disk_path: str
    name: str

    def __init__(self, path: "str | os.PathLike[str] | None" = None) -> None:
        self._mesh = _easypbr.Mesh() if path is None else _easypbr.Mesh(path)
        self._pending: dict[str, Any] = {}
        #: Arrays that were read since the last picture, those that somebody still has, and what was in them: they may be changed
        #: in place.
        self._read: dict[str, NDArray[Any]] = {}
        self._lent: weakref.WeakValueDictionary[str, NDArray[Any]] = weakref.WeakValueDictionary()
        self._content: dict[str, NDArray[Any]] = {}
        self._labels: dict[str, NDArray[Any]] = {}
        self._fields: dict[str, Any] = {}
        self._children: list[Mesh] = []
        self.m_vis = VisOptions()
        self.m_label_mngr: LabelMngr | None = None
        self.m_disk_path = "" if path is None else os.fspath(path)
        self.m_force_vis_update = self.m_is_dirty = self.m_is_shadowmap_dirty = False
        self.m_width = self.m_height = self.id = 0
        self.D = np.zeros((0, 1))
        self.name = self._mesh.name

    @classmethod
    def _of(cls, mesh: "_easypbr.Mesh") -> "Mesh":
        made = cls()
        made._mesh = mesh
        return made

    # Arrays.

    def __getattr__(self, name: str) -> Any:
        if name in _ARRAYS:
            return self._array(_ARRAYS[name])
        if name in _LABELS:
            return self._labels.get(name, np.zeros((0, 1), np.int32))
        if name in ("NF", "V_bitangent_v"):
            return self.face_normals() if name == "NF" else np.cross(self.NV, self.V_tangent_u)
        raise AttributeError(f"Mesh has no '{name}'")

    def __setattr__(self, name: str, value: Any) -> None:
        if name in _ARRAYS:
            array = np.array(value)
            # Columns of one number are our plain rows of numbers.
            self._pending[_ARRAYS[name]] = array.ravel() if name in ("I", "V_lenght_v") else array
            self._forget([_ARRAYS[name]])
        elif name in _LABELS:
            self._labels[name] = np.asarray(value).ravel().astype(np.int32)
        else:
            object.__setattr__(self, name, value)

    def _array(self, name: str) -> NDArray[Any]:
        """An array that may be changed in place, as the first EasyPBR's: what is changed is handed over with the next picture."""
        found = self._pending.get(name)
        if found is None:
            found = self._lent.get(name)
        if found is None:
            found = np.array(getattr(self._mesh, name))
            self._content[name] = found.copy()
        self._read[name] = self._lent[name] = found
        return found

    def _forget(self, names: "Sequence[str]" = _OWN) -> None:
        """Arrays that were read are no longer the mesh's."""
        for name in names:
            for known in (self._read, self._lent, self._content):
                known.pop(name, None)

    def _put(self, **arrays: Any) -> None:
        """Replaces arrays."""
        self._mesh.assign(**arrays)
        self._forget()

    def _collect(self) -> None:
        """Makes pending what was changed in place."""
        for name, array in self._lent.items():
            if name in self._content and not np.array_equal(array, self._content[name], equal_nan=array.dtype.kind == "f"):
                self._pending.setdefault(name, array)

    def handle(self) -> "_easypbr.Mesh":
        """EasyPBR's mesh, with all that was assigned or changed in place."""
        self._collect()
        pending, self._pending = self._pending, {}
        # Whatever belongs to vertices that are replaced by another number of them goes, unless it is assigned, too.
        if "V" in pending and len(pending["V"]) != len(self._mesh.V):
            for name in set(_OWN) - {"V"} - set(pending):
                pending[name] = None
        try:
            if pending:
                self._mesh.assign(**pending)
        except Exception:
            self._pending = {name: array for name, array in pending.items() if array is not None}
            raise
        self._forget([name for name, array in pending.items() if array is not self._lent.get(name)])
        self._read.clear()
        self._content = {name: array.copy() if name in pending else self._content[name] for name, array in self._lent.items()}
        labels = self._labels.get("L_gt" if self.m_vis._color_by == "gt" else "L_pred")
        if labels is not None and len(labels):
            self._mesh.assign(L=labels)
        if self.m_label_mngr is not None:
            self._mesh.label_map = self.m_label_mngr._map()
        self.m_vis.apply(self._mesh)
        for child in self._children:
            child.handle()
        return self._mesh

    def _take(self, mesh: "_easypbr.Mesh") -> None:
        """Replaces arrays by those of a mesh that was computed."""
        arrays = {name: getattr(mesh, name) for name in _OWN}
        self._put(**{name: array if len(array) else None for name, array in arrays.items()})
        self._labels.clear()

    def _changed(self, method: str, *arguments: Any, **named: Any) -> None:
        self._take(getattr(self.handle(), method)(*arguments, **named))

    # Files.

    def load_from_file(self, path: "str | os.PathLike[str]") -> None:
        self._mesh, self._pending, self.m_disk_path = _easypbr.Mesh(path), {}, os.fspath(path)
        self._forget()

    read_obj = load_from_file

    def save_to_file(self, path: "str | os.PathLike[str]") -> None:
        """Without the pose, unlike the first EasyPBR, which baked it and dropped vertices at the origin."""
        self.handle().save(path)

    def clone(self) -> "Mesh":
        other = Mesh._of(self.handle().clone())
        other.m_vis = VisOptions()
        other.m_vis._values.update(self.m_vis._values)
        object.__setattr__(other.m_vis, "_color_by", self.m_vis._color_by)
        other._labels = {name: array.copy() for name, array in self._labels.items()}
        other._fields, other.m_label_mngr, other.name = dict(self._fields), self.m_label_mngr, self.name
        return other

    def is_empty(self) -> bool:
        V = self._pending.get("V")
        return len(self._mesh.V if V is None else V) == 0

    def _has_vertices(self) -> bool:
        """Of its own, or of its children."""
        return not self.is_empty() or any(child._has_vertices() for child in self._children)

    def sanity_check(self) -> None:
        """Raises ArgumentError when the arrays do not fit each other."""
        self.handle()

    # Shapes.

    def create_box(self, width: float = 1, height: float = 1, length: float = 1) -> None:
        self._take(shapes.box((width, height, length)))

    def create_sphere(self, center: ArrayLike = (0, 0, 0), radius: float = 1) -> None:
        T = np.eye(4)
        T[:3, 3] = center
        self._take(shapes.sphere(radius).transform(T))

    def create_cylinder(self, main_axis: ArrayLike, height: float, radius: float, origin_at_bottom: bool = True,
                        with_cap: bool = True) -> None:  # fmt: skip
        axis = np.asarray(main_axis, dtype=np.float64) / np.linalg.norm(main_axis)
        side = np.cross(axis, (1.0, 0, 0) if abs(axis[0]) < 0.9 else (0, 0, 1.0))
        side /= np.linalg.norm(side)
        T = np.eye(4)
        T[:3, 0], T[:3, 1], T[:3, 2] = side, axis, np.cross(side, axis)
        made = shapes.cylinder(radius, height)
        low = made.bounding_box()[0][1]
        T[:3, 3] = axis * (-low if origin_at_bottom else -low - height / 2)
        if not with_cap:
            # Caps are the faces whose normals are along the axis.
            made.assign(F=made.F[np.abs(made.face_normals()[:, 1]) < 0.5])
        self._take(made.transform(T))

    def create_grid(self, nr_segments: int, y_pos: float, scale: float) -> None:
        T = np.eye(4)
        T[1, 3] = y_pos
        self._take(shapes.grid(scale, nr_segments).transform(T))

    def create_floor(self, y_pos: float, scale: float) -> None:
        T = np.eye(4)
        T[1, 3] = y_pos
        self._take(shapes.plane(scale).transform(T))

    def create_quad(self) -> None:
        corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
        self._put(V=corners, F=[[0, 1, 2], [0, 2, 3]], UV=(corners[:, :2] + 1) / 2)

    def create_line_strip_from_points(self, points: Sequence[ArrayLike]) -> None:
        V = np.array([np.asarray(point).ravel() for point in points], dtype=np.float64)
        first = np.arange(len(V) - 1)
        self._put(V=V, E=np.stack([first, first + 1], axis=1))
        self.m_vis.m_show_lines = True

    # Poses.

    @property
    def model_matrix(self) -> Affine3d:
        """The pose; its methods move the mesh."""
        def changed() -> None:
            self._mesh.T_parent_mesh = pose.matrix()

        pose = Affine3d(self._mesh.T_parent_mesh, changed)
        return pose

    @model_matrix.setter
    def model_matrix(self, T: Any) -> None:
        self._mesh.T_parent_mesh = np.asarray(T, dtype=np.float64)

    @property
    def cur_pose(self) -> Affine3d:
        return self.model_matrix

    def transform_model_matrix(self, T: Any) -> None:
        self._mesh.T_parent_mesh = np.asarray(T, dtype=np.float64) @ self._mesh.T_parent_mesh

    def translate_model_matrix(self, step: ArrayLike) -> None:
        self._mesh.translate(step)

    def set_model_matrix_from_string(self, text: str) -> None:
        """x y z qx qy qz qw."""
        self._mesh.T_parent_mesh = pose_from_string(text)

    def add_child(self, mesh: "Mesh") -> None:
        self._mesh.add_child(mesh.handle(), keep_world_pose=True)
        self._children.append(mesh)

    def apply_model_matrix_to_cpu(self, transform_points_at_zero: bool = True) -> None:
        """Applies the pose to the vertices."""
        T, self._mesh.T_parent_mesh = self._mesh.T_parent_mesh, np.eye(4)
        self.transform_vertices_cpu(T, transform_points_at_zero)

    def transform_vertices_cpu(self, T: Any, transform_points_at_zero: bool = True) -> None:
        stays = np.zeros(0, int) if transform_points_at_zero else np.flatnonzero((self.V == 0).all(axis=1))
        self._changed("transform", np.asarray(T, dtype=np.float64))
        if len(stays):
            V = np.array(self.V)
            V[stays] = 0
            self._put(V=V)

    # Size and place.

    def get_scale(self) -> float:
        """Longest side of the bounding box."""
        low, high = self.handle().bounding_box(np.eye(4))
        return float((high - low).max())

    def centroid(self) -> NDArray[Any]:
        return self.handle().bounding_box(np.eye(4)).mean(axis=0)

    def normalize_size(self) -> None:
        self._changed("normalize_size", 1.0)

    def normalize_position(self) -> None:
        self._changed("center")

    def scale_mesh(self, factor: float) -> None:
        self._changed("transform", np.diag([factor, factor, factor, 1.0]))

    def recalculate_min_max_height(self) -> None:
        """Without effect: the range of heights is that of the vertices that are drawn."""

    # Normals and tangents.

    def face_normals(self) -> NDArray[Any]:
        return self.handle().face_normals()

    def recalculate_normals(self) -> None:
        mesh = self.handle()
        self._put(N=mesh.vertex_normals())

    def flip_normals(self) -> None:
        self._changed("flip_normals")

    def compute_tangents(self, tangent_length: float = 1.0) -> None:
        """Discs of surfels: as large as the first EasyPBR drew them, of radius tangent_length / sqrt(2)."""
        mesh = self.handle()
        N = np.asarray(mesh.N if len(mesh.N) else mesh.vertex_normals(), dtype=np.float64)
        other = np.where(np.abs(N[:, :1]) < 0.9, [[1.0, 0, 0]], [[0, 0, 1.0]])
        U = np.cross(N, other)
        U *= tangent_length / np.sqrt(2) / np.linalg.norm(U, axis=1, keepdims=True)
        self._put(N=N, T=U, B=np.full(len(N), tangent_length / np.sqrt(2)))

    def estimate_normals_from_neighbourhood(self, radius: float) -> None:
        """Of 16 neighbours each, whatever the radius."""
        self._changed("estimate_normals")

    # Colours and textures.

    def color_solid2pervert(self) -> None:
        solid = (1.0, 206 / 255, 143 / 255) if self.m_vis.m_solid_color is None else self.m_vis.m_solid_color
        self._put(C=np.tile(np.asarray(solid, dtype=np.float32), (len(self.handle().V), 1)))

    def color_from_label_indices(self, labels: ArrayLike) -> None:
        self.L_pred = labels
        self.m_vis.set_color_semanticpred()

    def color_from_mat(self, mat: Mat) -> None:
        """Of the image at each vertex's texture coordinate."""
        mesh, data = self.handle(), _swapped(mat.to_cv32f().data)
        x = np.clip((mesh.UV[:, 0] * mat.cols).astype(int), 0, mat.cols - 1)
        y = np.clip(((1 - mesh.UV[:, 1]) * mat.rows).astype(int), 0, mat.rows - 1)
        self._put(C=data[y, x, :3])

    def _texture(self, name: str, source: "str | os.PathLike[str] | Mat") -> None:
        setattr(self._mesh.material, f"{name}_texture", _swapped(source.data) if isinstance(source, Mat) else os.fspath(source))

    def set_diffuse_tex(self, source: "str | os.PathLike[str] | Mat", subsample: int = 1, read_alpha: bool = False) -> None:
        """Textures are used in full; `subsample` has no effect."""
        self._texture("base_color", source)

    def set_metalness_tex(self, source: "str | os.PathLike[str] | Mat", subsample: int = 1, read_alpha: bool = False) -> None:
        self._texture("metallic", source)

    def set_roughness_tex(self, source: "str | os.PathLike[str] | Mat", subsample: int = 1, read_alpha: bool = False) -> None:
        self._texture("roughness", source)

    def set_smoothness_tex(self, source: "str | os.PathLike[str] | Mat", subsample: int = 1, read_alpha: bool = False) -> None:
        data = source.data if isinstance(source, Mat) else _easypbr.load_image(source)
        self._mesh.material.roughness_texture = (255 if data.dtype == np.uint8 else 1) - data

    def set_normals_tex(self, source: "str | os.PathLike[str] | Mat", subsample: int = 1, read_alpha: bool = False) -> None:
        self._texture("normal", source)

    # Topology.

    def decimate(self, nr_faces: int) -> None:
        self._changed("decimate", faces=nr_faces)

    def upsample(self, iterations: int = 1, smooth: bool = False) -> None:
        self._take(self.handle().upsample(iterations, method="loop" if smooth else "midpoint"))

    def remove_unreferenced_verts(self) -> None:
        self._changed("remove_unreferenced_vertices")

    def remove_duplicate_vertices(self) -> None:
        self._changed("remove_duplicate_vertices")

    def flip_winding(self) -> None:
        self._changed("flip_winding")

    def random_subsample(self, percentage_removal: float) -> None:
        self._changed("subsample", fraction=1 - percentage_removal)

    def remove_marked_vertices(self, mask: ArrayLike, keep: bool) -> None:
        """Removes vertices where the mask is true, or with `keep` all others; faces and edges of them go too."""
        mesh, kept = self.handle(), np.asarray(mask, dtype=bool).ravel() == bool(keep)
        if len(kept) != len(mesh.V):
            raise ArgumentError(f"remove_marked_vertices: expected {len(mesh.V)} values, got {len(kept)}")
        number = np.cumsum(kept) - 1
        arrays: dict[str, Any] = {name: getattr(mesh, name)[kept] if len(getattr(mesh, name)) == len(kept) else None
                                  for name in ("V", "N", "C", "UV", "T", "B", "L", "I")}  # fmt: skip
        for name in ("F", "E"):
            rows = getattr(mesh, name)
            arrays[name] = number[rows[kept[rows].all(axis=1)]] if len(rows) else None
        self._put(**arrays)
        self._labels = {name: labels[kept] for name, labels in self._labels.items() if len(labels) == len(kept)}

    def remove_vertices_at_zero(self) -> None:
        self.remove_marked_vertices((self.V == 0).all(axis=1), False)

    def add(self, other: "Mesh | Sequence[Mesh]") -> None:
        """Appends meshes, with their poses."""
        others = [other] if isinstance(other, Mesh) else list(other)
        mesh = self.handle().clone()
        pose, mesh.T_parent_mesh = mesh.T_parent_mesh, np.eye(4)
        self._take(mesh.merge(*(one.handle() for one in others)) if len(mesh.V) else others[0].handle().merge(
            *(one.handle() for one in others[1:])))  # fmt: skip
        self._mesh.T_parent_mesh = pose

    # Questions.

    def radius_search(self, query: ArrayLike, radius: float) -> int:
        """How many vertices are within the radius."""
        return int((np.linalg.norm(self.V - np.asarray(query).ravel(), axis=1) <= radius).sum())

    def compute_distance_to_mesh(self, other: "Mesh") -> NDArray[Any]:
        """Distances of the vertices to the other surface, in D too."""
        self.D = other.handle().closest_points(self.handle().V)[0].reshape(-1, 1)
        return self.D

    # Custom fields.

    def add_extra_field(self, name: str, value: Any) -> None:
        self._fields[name] = value

    def has_extra_field(self, name: str) -> bool:
        return name in self._fields

    def get_extra_field(self, name: str) -> Any:
        if name not in self._fields:
            raise ArgumentError(f"there is no field '{name}'")
        return self._fields[name]

    get_extra_field_int = get_extra_field
    get_extra_field_float = get_extra_field
    get_extra_field_double = get_extra_field
    get_extra_field_string = get_extra_field
    get_extra_field_mat = get_extra_field
    get_extra_field_matrixXi = get_extra_field
    get_extra_field_matrixXf = get_extra_field
    get_extra_field_matrixXd = get_extra_field

    def preallocate_V(self, count: int) -> None:
        """Without effect."""
