"""Shapes made in code, centred at the origin unless said otherwise, with normals and uv; y is up."""

from ._easypbr import box, plane, sphere, teapot

__all__ = ["box", "plane", "sphere", "teapot"]
