"""Figure 2: one picture in slices: metal and roughness, albedo, ambient occlusion, normals, final. Writes slices.png."""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Material, Mesh, Scene, Viewer, shapes
from figure import main, sized


def content(data: pathlib.Path | None) -> Mesh:
    """The helmet of glTF's sample models, or a teapot."""
    if data:
        helmet = Mesh(data / "DamagedHelmet/DamagedHelmet.gltf")
        helmet.rotate_axis_angle((1, 0, 0), 90)
        return helmet
    mesh = shapes.teapot(1.0)
    mesh.material = Material(base_color="#b03a2e", metallic=0.6, roughness=0.3)
    return mesh


def encoded(linear: NDArray[Any]) -> NDArray[Any]:
    """8-bit sRGB of linear values (IEC 61966-2-1)."""
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
    return (np.clip(curve, 0, 1) * 255 + 0.5).astype(np.uint8)


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    scene = Scene()
    scene.show(content(data), "content")
    size = sized(720, 540, scale)
    view = Viewer(size, {"camera": {"azimuth_deg": -10, "elevation_deg": 8}, "ssao": {"radius": 0.25}}, scene)
    final = view.render(samples=32)[:, :, :3]
    found = view.layers(["albedo", "normal_world", "metallic", "roughness", "ambient_occlusion", "depth"])
    seen = found["depth"] > 0
    metal = np.dstack([found["metallic"], found["roughness"], np.zeros_like(found["metallic"])])
    occlusion = np.repeat(found["ambient_occlusion"][:, :, None], 3, axis=2)
    planes = [encoded(metal), encoded(found["albedo"][:, :, :3]), encoded(occlusion),
              ((found["normal_world"] * 0.5 + 0.5) * 255).astype(np.uint8)]
    slices = [np.where(seen[:, :, None], plane, final) for plane in planes] + [final]
    # Slanted cuts, the last slice twice as wide as the others.
    columns = np.flatnonzero(seen.any(axis=0))
    rows, x = np.indices(seen.shape)
    slant = x + 0.25 * (rows - size[1] / 2)
    part = (slant - columns[0]) / (columns[-1] - columns[0]) * (len(slices) + 1)
    index = np.clip(part, 0, len(slices) - 1).astype(int)
    picture: NDArray[Any] = np.choose(index[:, :, None], slices)
    width_in_pixels = (columns[-1] - columns[0]) / (len(slices) + 1)
    border = (abs(part - np.round(part)) * width_in_pixels < 1.5) & (part > 0.5) & (part < len(slices) - 0.5) & seen
    picture[border] = 255
    return picture


if __name__ == "__main__":
    main(draw)
