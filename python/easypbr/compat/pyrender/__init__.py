"""pyrender's interface, drawn by EasyPBR: `import easypbr.compat.pyrender as pyrender`.

Scenes, nodes, meshes, materials, cameras and lights are those of https://pyrender.readthedocs.io; what differs stands in the
page "Coming from pyrender" of the documentation. No OpenGL context is made and none has to be chosen by PYOPENGL_PLATFORM.
"""

from . import camera, constants, light, material, mesh, node, offscreen
from . import primitive, renderer, sampler, scene, texture, utils, viewer
from .camera import Camera, IntrinsicsCamera, OrthographicCamera, PerspectiveCamera
from .constants import GLTF, RenderFlags, TextAlign
from .light import DirectionalLight, Light, PointLight, SpotLight
from .material import Material, MetallicRoughnessMaterial, SpecularGlossinessMaterial
from .mesh import Mesh
from .node import Node
from .offscreen import OffscreenRenderer
from .primitive import Primitive
from .renderer import Renderer
from .sampler import Sampler
from .scene import Scene
from .texture import Texture
from .viewer import Viewer

#: That of the pyrender whose interface this is.
__version__ = "0.1.45"

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
    "Renderer",
    "Sampler",
    "Scene",
    "SpecularGlossinessMaterial",
    "SpotLight",
    "TextAlign",
    "Texture",
    "Viewer",
    "__version__",
    "camera",
    "constants",
    "light",
    "material",
    "mesh",
    "node",
    "offscreen",
    "primitive",
    "renderer",
    "sampler",
    "scene",
    "texture",
    "utils",
    "viewer",
]
