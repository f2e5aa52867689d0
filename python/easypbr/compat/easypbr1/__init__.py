"""The first EasyPBR's interface, drawn by EasyPBR: `from easypbr.compat.easypbr1 import *` in place of `from easypbr import *`.

Names and meanings are those of https://github.com/AIS-Bonn/easy_pbr; what differs stands in the page "Coming from the first EasyPBR" of
the documentation, beside the names that programs written today use.
"""

from .affine import Affine3d
from .camera import Camera, SpotLight
from .frame import Frame
from .helpers import ColorMngr, LabelMngr, Profiler
from .mat import Mat, mat2tensor, tensor2mat
from .mesh import Mesh
from .scene import Scene
from .viewer import Gui, Recorder, Viewer
from .vis_options import VisOptions

Affine3f = Affine3d

__all__ = [
    "Affine3d",
    "Affine3f",
    "Camera",
    "ColorMngr",
    "Frame",
    "Gui",
    "LabelMngr",
    "Mat",
    "Mesh",
    "Profiler",
    "Recorder",
    "Scene",
    "SpotLight",
    "Viewer",
    "VisOptions",
    "mat2tensor",
    "tensor2mat",
]
