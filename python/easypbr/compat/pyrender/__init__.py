"""pyrender's interface, drawn by EasyPBR: `import easypbr.compat.pyrender as pyrender`.

Scenes, nodes, meshes, materials, cameras and lights are those of https://pyrender.readthedocs.io; what differs stands in the
page "Coming from pyrender" of the documentation. No OpenGL context is made and none has to be chosen by PYOPENGL_PLATFORM.
"""

from . import constants
from .cameras import Camera, IntrinsicsCamera, OrthographicCamera, PerspectiveCamera
from .constants import GLTF, RenderFlags
from .lights import DirectionalLight, Light, PointLight, SpotLight
from .materials import Material, MetallicRoughnessMaterial, Sampler, SpecularGlossinessMaterial, Texture
from .mesh import Mesh, Primitive
from .node import Node
from .renderer import OffscreenRenderer
from .scene import Scene
from .viewer import Viewer

__all__ = [
    "Camera",
    "DirectionalLight",
    "GLTF",
    "IntrinsicsCamera",
    "Light",
    "Material",
    "Mesh",
    "MetallicRoughnessMaterial",
    "Node",
    "OffscreenRenderer",
    "OrthographicCamera",
    "PerspectiveCamera",
    "PointLight",
    "Primitive",
    "RenderFlags",
    "Sampler",
    "Scene",
    "SpecularGlossinessMaterial",
    "SpotLight",
    "Texture",
    "Viewer",
    "constants",
]
