"""Data sets for training: pictures with exact annotations, from a spec and a seed.

    from easypbr.dataset import DatasetSpec, generate
    generate(DatasetSpec.demo(), "drones")
"""

from .run import generate
from .spec import DatasetSpec
from .tables import (
    BackgroundSpec,
    CameraSpec,
    ImageSpec,
    LightSpec,
    MotionSpec,
    ObjectSpec,
    OcclusionSpec,
    PlacementSpec,
    SensorSpec,
    SurroundingsSpec,
)

__all__ = [
    "BackgroundSpec",
    "CameraSpec",
    "DatasetSpec",
    "ImageSpec",
    "LightSpec",
    "MotionSpec",
    "ObjectSpec",
    "OcclusionSpec",
    "PlacementSpec",
    "SensorSpec",
    "SurroundingsSpec",
    "generate",
]
