"""VisOptions: how a mesh is drawn, in the first EasyPBR's words, and as EasyPBR's style and material."""

import difflib
from typing import Any

import numpy as np

from ... import _easypbr
from ..._easypbr import auto

#: Its defaults; None where EasyPBR infers a value that suits the data better.
_DEFAULTS: dict[str, Any] = {
    "m_is_visible": True,
    "m_force_cast_shadow": False,
    "m_show_mesh": True,
    "m_show_points": False,
    "m_show_lines": False,
    "m_show_normals": False,
    "m_show_wireframe": False,
    "m_show_surfels": False,
    "m_overlay_points": False,
    "m_overlay_lines": False,
    "m_points_as_circle": True,
    "m_point_size": None,
    "m_line_width": None,
    "m_is_line_dashed": False,
    "m_dash_size": 30.0,
    "m_gap_size": 30.0,
    "m_point_color": None,
    "m_line_color": None,
    "m_solid_color": None,
    "m_metalness": None,
    "m_roughness": None,
    "m_opacity": None,
    "m_use_custom_shader": False,
}


def _hex(color: Any) -> str:
    return "#" + "".join(f"{round(255 * min(max(float(c), 0), 1)):02x}" for c in np.asarray(color).ravel()[:3])


class VisOptions:
    """Options of the first EasyPBR. What is not assigned is inferred by EasyPBR: the size of points by their spacing, for example.
    m_force_cast_shadow, m_gap_size and m_use_custom_shader have no effect."""

    m_show_mesh: bool
    m_show_points: bool
    m_show_lines: bool
    m_show_surfels: bool

    def __init__(self) -> None:
        object.__setattr__(self, "_values", dict(_DEFAULTS))
        object.__setattr__(self, "_color_by", None)

    def __getattr__(self, name: str) -> Any:
        if name in _DEFAULTS:
            return self._values[name]
        raise AttributeError(self._unknown(name))

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in _DEFAULTS:
            raise AttributeError(self._unknown(name))
        self._values[name] = value

    @staticmethod
    def _unknown(name: str) -> str:
        near = difflib.get_close_matches(name, _DEFAULTS, 1)
        return f"VisOptions has no '{name}'" + (f" (did you mean '{near[0]}'?)" if near else "")

    def _set_color(self, source: str) -> None:
        object.__setattr__(self, "_color_by", source)

    def set_color_solid(self) -> None:
        self._set_color("solid")

    def set_color_pervertcolor(self) -> None:
        self._set_color("vertex")

    def set_color_texture(self) -> None:
        self._set_color("texture")

    def set_color_semanticpred(self) -> None:
        self._set_color("pred")

    def set_color_semanticgt(self) -> None:
        self._set_color("gt")

    def set_color_normalvector(self) -> None:
        self._set_color("normal")

    # Normals of the camera's frame are drawn as those of the world.
    set_color_normalvector_viewcoords = set_color_normalvector

    def set_color_height(self) -> None:
        self._set_color("height")

    def set_color_intensity(self) -> None:
        self._set_color("intensity")

    def set_color_uv(self) -> None:
        self._set_color("uv")

    def _mode(self, has_faces: bool, has_edges: bool) -> str | None:
        if self.m_show_surfels:
            return "surfels"
        if has_faces and self.m_show_mesh:
            return "mesh"
        if self.m_show_lines and has_edges:
            return "lines"
        if self.m_show_points:
            return "points"
        return None if not has_faces else ""

    def apply(self, mesh: "_easypbr.Mesh") -> None:
        """Sets the mesh's style and material."""
        has_faces, has_edges = len(mesh.F) > 0, len(mesh.E) > 0
        mode = self._mode(has_faces, has_edges)
        style, material, values = mesh.style, mesh.material, self._values
        style.mode = mode or auto
        # A mesh of which nothing is to be shown is not shown.
        style.visible = bool(values["m_is_visible"]) and mode != ""
        style.show_points = bool(values["m_show_points"]) if mode in ("mesh", "lines") else auto
        style.show_wireframe, style.show_normals = bool(values["m_show_wireframe"]), bool(values["m_show_normals"])
        style.overlay = bool((mode == "points" and values["m_overlay_points"]) or (mode == "lines" and values["m_overlay_lines"]))
        style.point_shape = "round" if values["m_points_as_circle"] else "square"
        style.point_size = auto if values["m_point_size"] is None else float(values["m_point_size"])
        style.line_width = auto if values["m_line_width"] is None else float(values["m_line_width"])
        style.line_dash = float(values["m_dash_size"]) if values["m_is_line_dashed"] else 0
        style.line_color = auto if values["m_line_color"] is None else _hex(values["m_line_color"])
        source = {"pred": "label", "gt": "label"}.get(self._color_by, self._color_by)
        style.color_by = source or auto
        solid = values["m_point_color"] if mode == "points" and values["m_point_color"] is not None else values["m_solid_color"]
        if solid is not None:
            material.base_color = _hex(solid)
        for name, old in (("metallic", "m_metalness"), ("roughness", "m_roughness"), ("opacity", "m_opacity")):
            if values[old] is not None:
                setattr(material, name, float(values[old]))
