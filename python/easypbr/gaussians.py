"""3D Gaussian splats from arrays."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _easypbr
from .errors import ArgumentError
from .tensors import as_numpy

__all__ = ["splats", "splats_of"]

CONSTANT = 0.28209479177387814
"""The spherical harmonic of degree 0."""


def splats(
    means: ArrayLike,
    scales: ArrayLike,
    quaternions: ArrayLike | None = None,
    opacities: ArrayLike | float = 1.0,
    sh: ArrayLike | None = None,
    colors: ArrayLike | None = None,
    raw: bool = False,
) -> "_easypbr.Mesh":
    """A mesh of n 3D Gaussians, drawn as splats.

    `means` is n x 3. `scales` are standard deviations along the Gaussians' own axes: n x 3, n x 2 of flat ones, or one
    number for each. `quaternions` (n x 4: w, x, y, z) turn the axes; by default they are those of the world.
    `opacities` are 0 to 1. `sh` holds spherical harmonics of degree 0 to 3, n x (degree + 1)^2 x 3, as gsplat and the
    reference implementation have them; or give `colors`, n x 3 sRGB values, the same from all directions, of the types and
    ranges that Mesh.C takes: 0 to 1, 0 to 255, uint8 or uint16.
    With `raw`, scales and opacities are what is trained: logarithms, and values before the sigmoid. All may be numpy
    arrays or tensors.
    """
    means = np.asarray(as_numpy(means), dtype=np.float64)
    if means.ndim != 2 or means.shape[1] != 3:
        raise ArgumentError(f"splats: expected means of n x 3, got {_shape(means)}")
    count = len(means)
    if (sh is None) == (colors is None):
        raise ArgumentError("splats: expected one of sh and colors")
    mesh = _easypbr.Mesh()
    mesh.assign(
        V=means,
        scales=_scales(_floats(scales), count, raw),
        rotations=np.tile([1.0, 0, 0, 0], (count, 1)) if quaternions is None else as_numpy(quaternions),
        opacities=_opacities(_floats(opacities), count, raw),
        sh=as_numpy(sh) if sh is not None else _harmonics(np.asarray(as_numpy(colors)), count),
    )
    mesh.name = "splats"
    return mesh


def splats_of(model: Mapping[str, Any]) -> "_easypbr.Mesh":
    """A mesh of the 3D Gaussians of a trained model, a dictionary of arrays or tensors as trainers save it.

    gsplat's has `means`, `scales`, `quats`, `opacities`, `sh0` (n x 1 x 3) and `shN` (n x k x 3, k = 0, 3, 8 or 15);
    that of nerfstudio's splatfacto `features_dc` (n x 3) and `features_rest` in their place. Scales are logarithms, and
    opacities values before the sigmoid. Names may have any prefix that ends with a dot, as in a `state_dict()`, and the
    arrays may lie in the members `splats`, `pipeline`, `model` or `state_dict`, one in another. Raises ArgumentError that
    names what is missing.
    """
    model = _parameters(model)

    def find(*names: str) -> Any:
        for name in names:
            if name in model:
                return np.asarray(as_numpy(model[name]), dtype=np.float64)
        raise ArgumentError(f"splats_of: expected {' or '.join(repr(name) for name in names)} among {sorted(model)}")

    means = find("means")
    count = len(means)
    first = find("sh0", "features_dc").reshape(count, 1, 3)
    rest = find("shN", "features_rest").reshape(count, -1, 3)
    return splats(
        means,
        find("scales"),
        find("quats"),
        find("opacities"),
        sh=np.concatenate([first, rest], axis=1),
        raw=True,
    )


def _parameters(model: Mapping[str, Any]) -> dict[str, Any]:
    """The arrays by their names without prefixes."""
    for member in ("splats", "pipeline", "model", "state_dict"):
        if isinstance(model, Mapping) and isinstance(model.get(member), Mapping):
            return _parameters(model[member])
    if not isinstance(model, Mapping):
        raise ArgumentError(f"splats_of: expected a dictionary of arrays, got {type(model).__name__}")
    return {str(name).rpartition(".")[2]: values for name, values in model.items()}


def _floats(values: Any) -> NDArray[Any]:
    return np.asarray(as_numpy(values), dtype=np.float64)


def _shape(array: NDArray[Any]) -> str:
    return " x ".join(map(str, array.shape)) or "one number"


def _harmonics(colors: NDArray[Any], count: int) -> NDArray[Any]:
    if colors.ndim == 1 and count == 1:
        colors = colors[None]
    if colors.shape != (count, 3):
        advice = ": transparency is given by opacities" if colors.shape == (count, 4) else ""
        raise ArgumentError(f"splats: expected colors of {count} x 3, got {_shape(colors)}{advice}")
    return (_easypbr.unit_colors(colors).astype(np.float64) - 0.5) / CONSTANT


def _scales(scales: NDArray[Any], count: int, raw: bool) -> NDArray[Any]:
    if scales.ndim < 2:
        scales = np.broadcast_to(scales.reshape(-1, 1), (count, 3)) if scales.size in (1, count) else scales
    if scales.shape not in ((count, 3), (count, 2)):
        raise ArgumentError(f"splats: expected scales of {count} x 3, {count} x 2 or {count}, got {_shape(scales)}")
    if raw:
        scales = np.exp(scales)
    return np.pad(scales, ((0, 0), (0, 3 - scales.shape[1])))


def _opacities(opacities: NDArray[Any], count: int, raw: bool) -> NDArray[Any]:
    opacities = opacities.reshape(-1)
    if opacities.size not in (1, count):
        raise ArgumentError(f"splats: expected one opacity or {count}, got {opacities.size}")
    if raw:
        opacities = 1 / (1 + np.exp(-opacities))
    return np.broadcast_to(opacities, count)
