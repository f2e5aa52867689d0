"""Depths of lines, which the layers of EasyPBR leave out: one pixel wide, as OpenGL draws them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import _easypbr
from .projection import Projection


def segments_of(mesh: "_easypbr.Mesh") -> NDArray[Any]:
    """k x 2 indices of the ends: the edges of a mesh of lines, else those of the triangles, each once."""
    if len(mesh.E):
        return np.asarray(mesh.E)
    F = np.asarray(mesh.F)
    return np.unique(np.sort(np.concatenate([F[:, :2], F[:, 1:], F[:, ::2]]), axis=1), axis=0)


def depths_of_lines(ends: NDArray[Any], projection: Projection) -> NDArray[Any]:
    """Height x width float32: metres along the optical axis, from EasyPBR's camera, of the nearest line, infinite where there is
    none. `ends`: k x 2 x 3 in the world."""
    width, height = projection.size
    depth = np.full((height, width), np.inf, np.float32)
    to_camera = np.linalg.inv(projection.pose)
    places = _clipped(ends @ to_camera[:3, :3].T + to_camera[:3, 3], projection)
    if len(places) == 0:
        return depth
    clip = np.concatenate([places, np.ones((len(places), 2, 1))], axis=2) @ projection.matrix.T
    pixels = (clip[:, :, :2] / clip[:, :, 3:] * (1, -1) + 1) / 2 * (width, height)
    # What changes evenly along a line of the image: the depth of parallel rays, its inverse of others.
    is_parallel = projection.is_parallel
    even = projection.back - places[:, :, 2] if is_parallel else -1 / places[:, :, 2]
    # A pixel for each column that a line passes whose slope is below 1, for each row otherwise.
    for axis, is_steep in ((0, False), (1, True)):
        length = np.abs(pixels[:, 1] - pixels[:, 0])
        chosen = (length[:, 1] > length[:, 0]) == is_steep
        along, across, value = pixels[chosen][:, :, axis], pixels[chosen][:, :, 1 - axis], even[chosen]
        line, centre = _centres(along, (width, height)[axis])
        t = (centre - along[line, 0]) / (along[line, 1] - along[line, 0])
        side = np.floor(across[line, 0] + t * (across[line, 1] - across[line, 0]))
        found = value[line, 0] + t * (value[line, 1] - value[line, 0])
        inside = (side >= 0) & (side < (width, height)[1 - axis])
        place = [np.floor(centre[inside]).astype(int), side[inside].astype(int)]
        np.minimum.at(depth, (place[1 - axis], place[axis]), (found if is_parallel else 1 / found)[inside].astype(np.float32))
    return depth


def _clipped(ends: NDArray[Any], projection: Projection) -> NDArray[Any]:
    """The parts of lines, k x 2 x 3 in the camera's frame, that are between the near and the far plane."""
    for limit, sign in ((projection.near, 1), (projection.far, -1)):
        if limit is None:
            continue
        inside = sign * (-ends[:, :, 2] - limit)  # At least 0 within.
        kept = (inside >= 0).any(axis=1)
        ends, inside = ends[kept].copy(), inside[kept]
        for end in (0, 1):
            out = inside[:, end] < 0
            t = inside[out, end] / (inside[out, end] - inside[out, 1 - end])
            ends[out, end] += t[:, None] * (ends[out, 1 - end] - ends[out, end])
    return ends


def _centres(along: NDArray[Any], size: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """The pixels' centres from 0 to `size` that lines pass between along[:, 0] and along[:, 1]: the line's index, the centre."""
    first = np.clip(np.ceil(along.min(axis=1) - 0.5), 0, size).astype(int)
    last = np.clip(np.ceil(along.max(axis=1) - 0.5), 0, size).astype(int)
    count = np.maximum(last - first, 0)
    line = np.repeat(np.arange(len(along)), count)
    step = np.arange(len(line)) - np.repeat(np.cumsum(count) - count, count)
    return line, first[line] + step + 0.5
