#!/usr/bin/env python3
"""Fits 3D Gaussians to views of a teapot and a ball that EasyPBR renders, by gradient descent (Kerbl et al. 2023).

usage: fit_splats.py [--splats N] [--steps N] [--degree N] [--seed N] [--output FILE]
Writes fitted.ply, which is laid out as the files of the reference implementation, and fitted.png: views that were not
fitted above, the Gaussians below. Needs PyTorch; a minute and a half on one core.
"""
import argparse
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch

import easypbr
from easypbr import Camera, Material, Mesh, Scene, Viewer, shapes

#: The parameters of n Gaussians by the names of gsplat: means, scales (logarithms), quats (w, x, y, z), opacities
#: (before the sigmoid), sh0 (n x 1 x 3) and shN (n x k x 3).
Gaussians = dict[str, torch.Tensor]

LOW_PASS = 0.3  # Variance that each Gaussian gains on the screen, in square pixels.
LEAST_ALPHA, MOST_ALPHA = 1 / 255, 0.99
LEAST_TRANSMITTANCE = 1e-4
DERIVATIVE_LIMIT = 1.3  # In half sizes of the picture: further outside the derivative of the projection is that there.
NEAR = 0.01

#: Step sizes of Adam. That of the means falls to a hundredth, and is a part of the extent of the scene.
RATES = {"means": 4e-3, "scales": 4e-2, "quats": 2e-2, "opacities": 1e-1, "sh0": 2e-2, "shN": 2e-3}


@dataclass(frozen=True)
class View:
    """A picture and its camera. Colours are sRGB-encoded and premultiplied by the alpha, 0 to 1."""

    T_cam_world: torch.Tensor  # 4 x 4, with the axes of OpenCV
    focal: tuple[float, float]  # pixels
    center: tuple[float, float]  # The middle of the first pixel is at 0.5.
    picture: torch.Tensor  # height x width x 4


def view_of(camera: Camera, picture: torch.Tensor) -> View:
    K = camera.opencv_K((picture.shape[1], picture.shape[0]))
    T_cam_world = torch.from_numpy(np.linalg.inv(camera.opencv_T_world_cam))
    return View(T_cam_world, (K[0, 0], K[1, 1]), (K[0, 2] + 0.5, K[1, 2] + 0.5), picture)


def premultiplied(codes: np.ndarray[tuple[int, ...], np.dtype[np.uint8]]) -> torch.Tensor:
    """Of 8-bit colours with their alpha."""
    picture = torch.from_numpy(codes).double() / 255
    return torch.cat([picture[..., :3] * picture[..., 3:], picture[..., 3:]], -1)


def cameras(count: int, distance: float = 4.2) -> list[Camera]:
    """Around the scene in turns of the golden angle, from low to high."""
    heights = np.linspace(0.25, 0.85, count)
    turns = np.pi * (3 - 5**0.5) * np.arange(count)
    radii = np.sqrt(1 - heights**2)
    directions = np.stack([radii * np.cos(turns), heights, radii * np.sin(turns)], 1)
    target = np.array([0, 0.25, 0])
    return [Camera.look_at(target + distance * direction, target, fov_y_deg=32) for direction in directions]


def example_scene() -> list[Mesh]:
    ground = shapes.plane(2.2, 24)
    x, z = ground.V[:, 0], ground.V[:, 2]
    ground.C = np.stack([0.5 + 0.35 * np.sin(3 * x), 0.5 + 0.3 * np.cos(2.5 * z), 0.45 + 0.3 * np.sin(2 * (x + z))], 1)
    pot = shapes.teapot(0.7)
    pot.translate((-0.35, 0, -0.1))
    pot.material = Material(base_color="#c8642c", roughness=0.4)
    ball = shapes.sphere(0.3)
    ball.translate((0.6, 0.3, 0.35))
    ball.material = Material(base_color="#5078d0", metallic=1, roughness=0.45)
    return [ground, pot, ball]


def render_views(meshes: Sequence[Mesh], cameras: Sequence[Camera], size: tuple[int, int],
                 samples: int = 16) -> tuple[list[View], torch.Tensor, torch.Tensor]:
    """The views, and the points that they see with their colours, m x 3 each."""
    scene = Scene()
    for number, mesh in enumerate(meshes):
        scene.show(mesh, str(number))
    viewer = Viewer(size, {"background": {"mode": "transparent"}}, scene)
    views, points, colors = [], [], []
    for camera in cameras:
        viewer.camera = camera
        layers = viewer.render_layers(["color", "depth", "position"], samples=samples)
        # Where the pixel is covered altogether, its colour is that of the point.
        inside = (layers["depth"] > 0) & (layers["color"][..., 3] == 255)
        views.append(view_of(camera, premultiplied(layers["color"])))
        points.append(torch.from_numpy(layers["position"][inside]).double())
        colors.append(views[-1].picture[..., :3][torch.from_numpy(inside)])
    return views, torch.cat(points), torch.cat(colors)


def initial(points: torch.Tensor, colors: torch.Tensor, count: int, degree: int, seed: int) -> Gaussians:
    """Round Gaussians at some of the points, as wide as the distance to their neighbours is."""
    chosen = torch.randperm(len(points), generator=torch.Generator().manual_seed(seed))[:count]
    means, count = points[chosen], len(chosen)
    nearest = torch.cdist(means, means).topk(4, largest=False).values[:, 1:]
    scales = nearest.square().mean(1).sqrt().clamp(min=1e-4).log()
    return {
        "means": means,
        "scales": scales[:, None].repeat(1, 3),
        "quats": torch.tensor([1.0, 0, 0, 0], dtype=torch.double).repeat(count, 1),
        "opacities": torch.zeros(count, dtype=torch.double),
        "sh0": ((colors[chosen] - 0.5) / 0.28209479177387814)[:, None],
        "shN": torch.zeros(count, (degree + 1) ** 2 - 1, 3, dtype=torch.double),
    }


def harmonics(directions: torch.Tensor) -> torch.Tensor:
    """The real spherical harmonics up to degree 3 of unit vectors, n x 16, with the signs of Kerbl et al. 2023."""
    x, y, z = directions.unbind(1)
    xx, yy, zz = x * x, y * y, z * z
    return torch.stack([
        torch.full_like(x, 0.28209479177387814),
        -0.4886025119029199 * y, 0.4886025119029199 * z, -0.4886025119029199 * x,
        1.0925484305920792 * x * y, -1.0925484305920792 * y * z, 0.31539156525252005 * (2 * zz - xx - yy),
        -1.0925484305920792 * x * z, 0.5462742152960396 * (xx - yy),
        -0.5900435899266435 * y * (3 * xx - yy), 2.890611442640554 * x * y * z,
        -0.4570457994644658 * y * (4 * zz - xx - yy), 0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy),
        -0.4570457994644658 * x * (4 * zz - xx - yy), 1.445305721320277 * z * (xx - yy),
        -0.5900435899266435 * x * (xx - 3 * yy),
    ], 1)


def rotations(quaternions: torch.Tensor) -> torch.Tensor:
    """n x 3 x 3, of quaternions w, x, y, z of any length."""
    w, x, y, z = torch.nn.functional.normalize(quaternions, dim=1).unbind(1)
    turns: torch.Tensor = torch.stack([
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
    ], 1).reshape(-1, 3, 3)
    return turns


def colors_of(gaussians: Gaussians, view: View) -> torch.Tensor:
    """sRGB-encoded, 0 or more."""
    T = view.T_cam_world
    eye = -T[:3, :3].T @ T[:3, 3]
    sh = torch.cat([gaussians["sh0"], gaussians["shN"]], 1)
    basis = harmonics(torch.nn.functional.normalize(gaussians["means"] - eye, dim=1))[:, : sh.shape[1]]
    colors: torch.Tensor = (0.5 + (basis[:, :, None] * sh).sum(1)).clamp(min=0)
    return colors


def project(gaussians: Gaussians, view: View) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    """Depths, centres in pixels (n x 2) and covariances in square pixels (n x 3: xx, xy, yy), by the derivative of the
    projection at the means (Zwicker et al. 2002)."""
    height, width = view.picture.shape[:2]
    turn, shift = view.T_cam_world[:3, :3], view.T_cam_world[:3, 3]
    x, y, depth = (gaussians["means"] @ turn.T + shift).unbind(1)
    z = depth.clamp(min=NEAR)
    (fx, fy), (cx, cy) = view.focal, view.center
    centers = torch.stack([fx * x / z + cx, fy * y / z + cy], 1)
    rows = []
    for focal, ratio, center, size in ((fx, x / z, cx, width), (fy, y / z, cy, height)):
        reach = DERIVATIVE_LIMIT * size / 2
        limited = ratio.clamp((size / 2 - reach - center) / focal, (size / 2 + reach - center) / focal)
        rows.append((focal / z, -focal / z * limited))
    none = torch.zeros_like(z)
    derivative = torch.stack([rows[0][0], none, rows[0][1], none, rows[1][0], rows[1][1]], 1).reshape(-1, 2, 3)
    axes = derivative @ turn @ (rotations(gaussians["quats"]) * gaussians["scales"].exp()[:, None])
    own = axes @ axes.transpose(1, 2)
    return depth, centers, torch.stack([own[:, 0, 0] + LOW_PASS, own[:, 0, 1], own[:, 1, 1] + LOW_PASS], 1)


def pairs_of(centers: torch.Tensor, covariances: torch.Tensor, opacities: torch.Tensor, seen: torch.Tensor,
             size: tuple[int, int]) -> tuple[torch.Tensor, torch.Tensor]:
    """Gaussians and the pixels inside of their boxes, those of a Gaussian together, in the order of `seen`. Outside of
    its box the alpha of a Gaussian is below LEAST_ALPHA."""
    limits = torch.tensor(size)
    farthest = 2 * (opacities[seen] / LEAST_ALPHA).log()
    half = (farthest[:, None] * covariances[seen][:, [0, 2]]).sqrt()
    first = (centers[seen] - half - 0.5).ceil().long().clamp(min=0)
    end = torch.minimum((centers[seen] + half - 0.5).floor().long() + 1, limits)
    extent = (end - first).clamp(min=0)
    counts = extent.prod(1)
    owner = torch.repeat_interleave(torch.arange(len(seen)), counts)
    within = torch.arange(len(owner)) - (counts.cumsum(0) - counts)[owner]
    columns = extent[owner, 0]
    x = first[owner, 0] + within % columns
    y = first[owner, 1] + torch.div(within, columns, rounding_mode="floor")
    return seen[owner], y * size[0] + x


def draw(gaussians: Gaussians, view: View) -> torch.Tensor:
    """The picture of a view as View.picture has it, with gradients. One order serves all pixels: that of the depths of
    the means."""
    height, width = view.picture.shape[:2]
    depth, centers, covariances = project(gaussians, view)
    opacities = gaussians["opacities"].sigmoid()
    xx, xy, yy = covariances.unbind(1)
    area = xx * yy - xy * xy
    with torch.no_grad():
        seen = depth.argsort(stable=True)
        seen = seen[(depth[seen] > NEAR) & (opacities[seen] >= LEAST_ALPHA)]
        owner, pixel = pairs_of(centers, covariances, opacities, seen, (width, height))
    # What each pair needs, gathered at once.
    inverses = torch.stack([yy / area, -xy / area, xx / area], 1)
    table = torch.cat([centers, inverses, opacities[:, None], colors_of(gaussians, view)], 1)
    x, y, a, b, c, opacity = table[owner, :6].unbind(1)
    dx, dy = pixel % width + 0.5 - x, torch.div(pixel, width, rounding_mode="floor") + 0.5 - y
    alpha = (opacity * (-0.5 * (a * dx * dx + c * dy * dy) - b * dx * dy).exp()).clamp(max=MOST_ALPHA)
    kept = (alpha.detach() >= LEAST_ALPHA).nonzero()[:, 0]
    # Pixel by pixel; within a pixel from the nearest on.
    kept = kept[pixel[kept].argsort(stable=True)]
    owner, pixel, alpha = owner[kept], pixel[kept], alpha[kept]
    counts = torch.bincount(pixel, minlength=height * width)
    # Logarithms of the transmittance before each pair, since the first of all pixels, and since the first of its own.
    passed = torch.log1p(-alpha)
    before = passed.cumsum(0) - passed
    heads = (counts.cumsum(0) - counts)[counts > 0]
    through = (before - torch.repeat_interleave(before[heads], counts[counts > 0])).exp()
    weights = alpha * through * (through.detach() >= LEAST_TRANSMITTANCE)
    values = torch.cat([table[owner, 6:], torch.ones_like(alpha)[:, None]], 1) * weights[:, None]
    sums = torch.zeros(height * width, 4, dtype=torch.double).index_add(0, pixel, values)
    picture: torch.Tensor = sums.reshape(height, width, 4)
    return picture


def fit(gaussians: Gaussians, views: Sequence[View], steps: int, seed: int) -> Gaussians:
    """Minimises the mean squared error of the pictures by Adam, a view a step. On one thread it is reproducible."""
    fitted = {name: values.clone().requires_grad_() for name, values in gaussians.items()}
    extent = float((gaussians["means"] - gaussians["means"].mean(0)).norm(dim=1).max())
    rates = RATES | {"means": RATES["means"] * extent}
    groups = [{"params": [values], "lr": rates[name], "name": name} for name, values in fitted.items()]
    optimizer = torch.optim.Adam(groups, eps=1e-15)
    random = torch.Generator().manual_seed(seed)
    order: list[int] = []
    for step in range(steps):
        for group in optimizer.param_groups:
            falls = 0.01 if group["name"] == "means" else 0.1
            group["lr"] = rates[group["name"]] * falls ** (step / steps)
        order = order or torch.randperm(len(views), generator=random).tolist()
        view = views[order.pop()]
        loss = (draw(fitted, view) - view.picture).square().mean()
        optimizer.zero_grad()
        torch.autograd.backward(loss)
        optimizer.step()
    return {name: values.detach() for name, values in fitted.items()}


def psnr(a: torch.Tensor, b: torch.Tensor) -> float:
    """In dB, of values from 0 to 1."""
    return float(-10 * (a - b).square().mean().log10())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--splats", type=int, default=1500)
    parser.add_argument("--steps", type=int, default=1200)
    parser.add_argument("--degree", type=int, default=3, choices=range(4))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--output", default="fitted.ply")
    options = parser.parse_args()
    torch.set_num_threads(1)  # Sums do not depend on the number of cores.
    views, points, colors = render_views(example_scene(), cameras(24), (96, 96))
    held_out = views[3::6]
    fitted_to = [view for number, view in enumerate(views) if number % 6 != 3]
    gaussians = initial(points, colors, options.splats, options.degree, options.seed)
    gaussians = fit(gaussians, fitted_to, options.steps, options.seed)
    easypbr.splats_of(gaussians).save(options.output)
    with torch.no_grad():
        for name, some in (("fitted", fitted_to), ("held-out", held_out)):
            errors = [psnr(draw(gaussians, view), view.picture) for view in some]
            print(f"PSNR of {len(some)} {name} views: {np.mean(errors):.1f} dB, {min(errors):.1f} dB at least")
        above, below = [view.picture for view in held_out], [draw(gaussians, view) for view in held_out]
    pictures = torch.cat([torch.cat(above, 1), torch.cat(below, 1)])
    over_white = pictures[..., :3] + 1 - pictures[..., 3:]
    easypbr.save_image((over_white.clamp(0, 1) * 255).round().byte().numpy(), "fitted.png")


if __name__ == "__main__":
    main()
