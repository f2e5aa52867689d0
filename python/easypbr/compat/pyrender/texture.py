"""pyrender's module of this name."""

from .material import Texture

__all__ = ["Texture"]
