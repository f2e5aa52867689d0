"""EasyPBR: a physically based renderer for meshes, point clouds and labelled data.

    from easypbr import *
    view = Viewer()
    Scene.show(Mesh("drone.ply"), "drone")
    view.recorder.record("img.png")
"""

from . import interpreter  # noqa: F401 - first: it refuses sub-interpreters
from . import _easypbr, errors, shapes
from ._easypbr import (
    Automatic,
    Camera,
    CameraPath,
    Environment,
    Event,
    Instance,
    Follow,
    KdTree,
    LabelMap,
    Light,
    Material,
    Mesh,
    Moment,
    Pick,
    RayHits,
    RayTree,
    ServerClient,
    Style,
    auto,
    colormap,
    compare_images,
    follow,
    load_image,
    load_scene,
    save_image,
)
from .convert import as_mesh
from .errors import ArgumentError, ContextError, Error, FileError, FormatError, ShaderError, UnknownNameError
from .gaussians import splats, splats_of
from .loader import MeshLoader
from .panels import Panel
from .remote import Server
from .rendering import render
from .scene import Scene
from .settings import Settings
from .tensors import eigen2tensor, tensor2eigen
from .viewer import Viewer, show

__version__: str = getattr(_easypbr, "__version__")
__all__ = [
    "ArgumentError",
    "Automatic",
    "Camera",
    "CameraPath",
    "ContextError",
    "ShaderError",
    "Environment",
    "Error",
    "Event",
    "FileError",
    "Follow",
    "FormatError",
    "Instance",
    "KdTree",
    "LabelMap",
    "Light",
    "Material",
    "Mesh",
    "MeshLoader",
    "Moment",
    "Panel",
    "Pick",
    "RayHits",
    "RayTree",
    "Scene",
    "Server",
    "ServerClient",
    "Settings",
    "Style",
    "UnknownNameError",
    "Viewer",
    "as_mesh",
    "auto",
    "colormap",
    "compare_images",
    "eigen2tensor",
    "errors",
    "follow",
    "load_image",
    "load_scene",
    "render",
    "save_image",
    "shapes",
    "show",
    "splats",
    "splats_of",
    "tensor2eigen",
]
