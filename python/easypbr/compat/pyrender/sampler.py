"""pyrender's module of this name."""

from .material import Sampler

__all__ = ["Sampler"]
