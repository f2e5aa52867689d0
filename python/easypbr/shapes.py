"""Procedural shapes, centred at the origin unless stated otherwise, with normals and uv; y is up."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _easypbr
from ._easypbr import arrow, arrows, axes, box, capsule, cone, cylinder, grid, icosphere, plane, sphere, teapot, torus
from .errors import ArgumentError
from .tensors import array_of

__all__ = [
    "arrow",
    "arrows",
    "axes",
    "box",
    "camera_frustum",
    "camera_path",
    "capsule",
    "cone",
    "cylinder",
    "grid",
    "icosphere",
    "image_plane",
    "plane",
    "sphere",
    "teapot",
    "torus",
    "voxel_grid",
]


def camera_frustum(
    camera: Any, image: ArrayLike | None = None, size: ArrayLike | None = None, depth: float = 1.0
) -> "_easypbr.Mesh":
    """A camera frustum as lines, with its image.

    `camera` is a Camera, or (K, T_world_cam) with OpenCV axes. The image plane is at `depth` along the optical axis,
    with a triangle on the upper border; `image` fills it. `size` is (width, height), by default the
    image's, or what the camera's intrinsics belong to.
    """
    if isinstance(camera, _easypbr.Camera):
        return _easypbr._camera_frustum(camera, image, size, depth)
    if not isinstance(camera, (tuple, list)) or len(camera) != 2:
        raise ArgumentError(f"camera_frustum: expected a Camera or (K, T_world_cam), got a {type(camera).__name__}")
    if size is None and image is not None:
        image = _picture(image, "camera_frustum: image")
        size = image.shape[1], image.shape[0]
    if size is None:
        raise ArgumentError("camera_frustum: expected a size, (width, height), or an image, beside (K, T_world_cam)")
    K, T_world_cam = camera
    return _easypbr._camera_frustum(_easypbr.Camera.from_opencv(K, T_world_cam, size), image, size, depth)


def camera_path(
    path: "_easypbr.CameraPath", size: ArrayLike = (4, 3), fov_y_deg: float = 30.0, depth: float | None = None
) -> "_easypbr.Mesh":
    """The curve of a camera path as lines, with camera frustums as children: one at each key, twelve on an orbit.
    `size` gives their aspect ratio, and the field of view applies where the path has none; `depth` is the length of
    the frustums, by default a tenth of the curve's extent."""
    return _easypbr._camera_path(path, size, fov_y_deg, depth)


def image_plane(image: ArrayLike, width: float | None = None, height: float | None = None) -> "_easypbr.Mesh":
    """An image in the xy plane around the origin, facing +z, unlit: shown as it is, past exposure and tone curve.

    `image` is an array of height x width (x 1 to 4), uint8, uint16 or linear floats. One of width and height is enough; by
    default the plane is 1 high.
    """
    image = _picture(image, "image_plane: image")
    rows, columns = image.shape[:2]
    if width is None:
        width = (1.0 if height is None else height) * columns / rows
    if height is None:
        height = width * rows / columns
    if not (width > 0 and height > 0):
        raise ArgumentError(f"image_plane: expected width and height above 0, got {width} and {height}")
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * (width / 2, height / 2, 0)
    mesh = _easypbr.Mesh(corners, [[0, 1, 2], [0, 2, 3]])
    mesh.assign(N=np.tile([0, 0, 1], (4, 1)), UV=[[0, 0], [1, 0], [1, 1], [0, 1]])
    mesh.name = "image"
    mesh.material.base_color = (1, 1, 1)
    mesh.material.unlit = True
    mesh.style.lit = False
    mesh.material.double_sided = True
    mesh.material.base_color_texture = image
    return mesh


def _picture(image: ArrayLike, name: str) -> NDArray[Any]:
    """The image as an array of numpy's with rows and columns. Raises ArgumentError, which begins with the name."""
    array = array_of(image, name)
    if array.ndim not in (2, 3) or array.size == 0:
        got = " x ".join(map(str, array.shape)) or f"a {type(image).__name__}"
        raise ArgumentError(f"{name}: expected an array of height x width (x 1 to 4), such as load_image(path), got {got}")
    return array


def voxel_grid(array: ArrayLike, origin: ArrayLike = (0, 0, 0), cell_size: float = 1.0, empty: int = 0) -> "_easypbr.Mesh":
    """The occupied cells of a grid, drawn as cubes. Cell [i, j, k] spans origin + cell_size * (i..i+1, j..j+1, k..k+1).

    `array` is nx x ny x nz of bool (occupancy) or of integers (labels; those that are not `empty`), or
    nx x ny x nz x 3 or 4 of uint8 or floats 0 to 1 (sRGB colours; cells with alpha 0 or NaN are empty).
    """
    array = array_of(array, "voxel_grid")
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
