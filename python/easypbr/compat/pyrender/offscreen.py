"""pyrender's module of this name."""

from .renderer import OffscreenRenderer, RenderFlags

__all__ = ["OffscreenRenderer", "RenderFlags"]
