"""Pictures do not depend on the unit of radiance: exposure is metered, and textures of half floats hold what fits."""
from typing import Literal

import numpy as np
import pytest

import easypbr

# Two kinds of halves' ends: their largest value is 2^16, and below 2^-14 they lose digits.
FACTORS = [2.0**-24, 2.0**24]


def environment(factor: float) -> np.ndarray:
    """A sky that is brighter above, with a bright patch that is reflected."""
    rows = np.linspace(1.5, 0.2, 32, dtype=np.float32)[:, None, None]
    sky = np.broadcast_to(rows, (32, 64, 3)).copy() * np.array([0.8, 0.9, 1.0], np.float32)
    sky[6:9, 20:24] = 40
    return sky * np.float32(factor)


def picture(factor: float, mode: Literal["raster", "path"], settings: dict[str, object]) -> np.ndarray:
    scene = easypbr.Scene()
    floor = easypbr.Mesh(V=[[-3, 0, -3], [3, 0, -3], [3, 0, 3], [-3, 0, 3]], F=[[0, 2, 1], [0, 3, 2]])
    floor.material = easypbr.Material(base_color=(0.6, 0.3, 0.2), roughness=0.4)
    ball = easypbr.shapes.sphere(0.8)
    ball.translate((0, 0.8, 0))
    ball.material = easypbr.Material(base_color=(0.9, 0.7, 0.3), metallic=1, roughness=0.3)
    scene.show(floor, "floor")
    scene.show(ball, "ball")
    scene.set_light("lamp", easypbr.Light("point", position=(2, 3, 2), intensity=20 * factor))
    camera = {"position": (3, 2, 4), "target": (0, 0.6, 0)}
    fixed = {"ground.mode": "none", "background.mode": "environment"}
    samples = 4 if mode == "path" else 1
    image = easypbr.render(scene, size=(96, 72), samples=samples, environment=environment(factor), camera=camera, mode=mode,
                           settings=fixed | settings)
    return np.asarray(image).astype(int)


KINDS = {
    "single frame": ("raster", {}),
    "blurred background": ("raster", {"background.mode": "blur"}),
    "rays": ("raster", {"rays.enabled": True, "rays.count": 8}),
    "lens": ("raster", {"depth_of_field.enabled": True, "depth_of_field.f_number": 0.5}),
    "bloom": ("raster", {"bloom.enabled": True}),
    "paths": ("path", {}),
}


@pytest.mark.parametrize("factor", FACTORS)
@pytest.mark.parametrize("kind", KINDS)
def test_unit_of_radiance(kind: str, factor: float) -> None:
    usual, scaled = picture(1, *KINDS[kind]), picture(factor, *KINDS[kind])
    # Factors are powers of two: nothing but the rounding of halves near zero and of exposure changes.
    assert np.abs(usual - scaled).max() <= 1


def test_mode_of_render() -> None:
    """`mode` is path.enabled: single frames are path traced too, images of several samples rasterised."""
    square = ([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    for mode, samples in (("raster", 2), ("path", 1)):
        by_setting = easypbr.render(square, size=(32, 24), samples=samples, settings={"path.enabled": mode == "path"})
        by_default = easypbr.render(square, size=(32, 24), samples=samples)
        image = easypbr.render(square, size=(32, 24), samples=samples, mode=mode)
        assert np.array_equal(image, by_setting)
        assert not np.array_equal(image, by_default)
    with pytest.raises(easypbr.ArgumentError, match="mode: expected 'raster' or 'path', got 'fast'"):
        easypbr.render(square, mode="fast")  # type: ignore[call-overload]
