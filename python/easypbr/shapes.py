"""Shapes made in code, centred at the origin unless said otherwise, with normals and uv; y is up."""

import numpy as np

from . import _easypbr
from ._easypbr import arrow, axes, box, capsule, cone, cylinder, grid, icosphere, plane, sphere, teapot, torus
from .errors import ArgumentError

__all__ = [
    "arrow",
    "axes",
    "box",
    "camera_frustum",
    "capsule",
    "cone",
    "cylinder",
    "grid",
    "icosphere",
    "plane",
    "sphere",
    "teapot",
    "torus",
    "voxel_grid",
]


def camera_frustum(camera, image=None, size=None, depth: float = 1.0) -> "_easypbr.Mesh":
    """What a camera sees, as lines, with its image in it.

    `camera` is a Camera, or (K, T_world_cam) with OpenCV's axes. The outline of its picture is laid at `depth` along
    the optical axis, with a roof on the upper border; `image` fills it. `size` is (width, height), by default the
    image's, or what the camera's intrinsics belong to.
    """
    if isinstance(camera, _easypbr.Camera):
        return _easypbr._camera_frustum(camera, image, size, depth)
    if not isinstance(camera, (tuple, list)) or len(camera) != 2:
        raise ArgumentError(f"camera_frustum: expected a Camera or (K, T_world_cam), got a {type(camera).__name__}")
    if size is None and image is not None:
        size = np.shape(image)[1::-1]
    if size is None:
        raise ArgumentError("camera_frustum: expected a size, (width, height), or an image, beside (K, T_world_cam)")
    return _easypbr._camera_frustum(_easypbr.Camera.from_opencv(*camera, size), image, size, depth)


def voxel_grid(array, origin=(0, 0, 0), cell_size: float = 1.0, empty: int = 0) -> "_easypbr.Mesh":
    """The occupied cells of a grid, drawn as cubes. Cell [i, j, k] spans origin + cell_size * (i..i+1, j..j+1, k..k+1).

    `array` is nx x ny x nz of bool (occupancy) or of integers (labels; those that are not `empty`), or
    nx x ny x nz x 3 or 4 of uint8 or floats 0 to 1 (sRGB colours; cells with alpha 0 or NaN are empty).
    """
    array = np.asarray(array)
    is_color = array.ndim == 4 and array.shape[3] in (3, 4) and (array.dtype == np.uint8 or array.dtype.kind == "f")
    is_cells = array.ndim == 3 and array.dtype.kind in "biu"
    if is_color:
        values = array / np.float32(255) if array.dtype == np.uint8 else array
        values = values.astype(np.float32)
    elif is_cells and array.dtype.kind == "b":
        values = array.astype(np.uint8)
    elif is_cells:
        values = array.astype(np.int32)
        if (values != array).any():
            raise ArgumentError("voxel_grid: expected labels from -2147483648 to 2147483647, got others")
    else:
        raise ArgumentError(
            "voxel_grid: expected nx x ny x nz of bool or integers, or nx x ny x nz x 3 or 4 of uint8 or floats, got "
            f"{' x '.join(map(str, array.shape)) or 'a single'} {array.dtype}"
        )
    return _easypbr._voxels(np.ascontiguousarray(values), origin, cell_size, empty)
