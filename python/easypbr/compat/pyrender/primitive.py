"""pyrender's module of this name."""

from .mesh import Primitive

__all__ = ["Primitive"]
