"""Splats that examples/training/fit_splats.py has fitted, against the PyTorch reference of gsplat and against the
script's own renderer.

gsplat's reference projects, evaluates spherical harmonics, sorts by tiles and evaluates the alphas. Two steps of it
need CUDA and are written here: which Gaussians a pixel sees, and two functions of nerfacc with products along rays.
gsplat limits alphas to 0.999, EasyPBR to the 0.99 of Kerbl et al. 2023; gsplat leaves out a splat that lets less than
1e-4 through, EasyPBR only those behind it. Either is less than a hundredth of what is behind.
"""
import pathlib
import sys
import types

import numpy as np
import pytest
import torch

import easypbr
from easypbr import Camera

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples/training"))
import fit_splats  # noqa: E402

SIZE = (160, 120)
SEED, SPLATS, STEPS, DEGREE = 7, 800, 250, 3
#: Of the whole, of one side, from above, and so near that splats reach over all sides of the picture.
CAMERAS = [Camera.look_at(position, target, fov_y_deg=fov) for position, target, fov in [
    ((0.3, 1.6, 4.1), (0, 0.25, 0), 34), ((-3.6, 1.1, 1.4), (0, 0.3, 0), 30), ((1.0, 4.2, 0.6), (0, 0, 0), 32),
    ((1.5, 0.9, 1.6), (0.1, 0.3, 0), 50)]]
BACKGROUND = torch.tensor([0.2, 0.55, 0.9], dtype=torch.double)


@pytest.fixture(scope="module", autouse=True)
def one_thread():
    """What PyTorch sums does not depend on the machine's number of cores then."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(before)


@pytest.fixture(scope="module")
def seen():
    return fit_splats.render_views(fit_splats.example_scene(), fit_splats.cameras(14), (64, 64), samples=8)


def fitted_to(views, points, colors, steps):
    return fit_splats.fit(fit_splats.initial(points, colors, SPLATS, DEGREE, SEED), views, steps, SEED)


@pytest.fixture(scope="module")
def fitted(seen):
    views, points, colors = seen
    return fitted_to(views[:12], points, colors, STEPS)


@pytest.fixture(scope="module")
def ours(fitted, tmp_path_factory):
    """Pictures as fit_splats.View.picture has them, of the file that was written. One sample, in the middle of each
    pixel as gsplat has it, and no FXAA, which single frames have otherwise: it blurs the borders."""
    path = tmp_path_factory.mktemp("fitted") / "fitted.ply"
    easypbr.splats_of(fitted).save(path)
    options = {"size": SIZE, "samples": 1, "antialias": "none", "background": "transparent"}
    return [fit_splats.premultiplied(easypbr.render(path, camera=camera, **options)) for camera in CAMERAS]


def codes(picture):
    """8-bit sRGB over a colour, so that alphas count too; where something is drawn in one of the pictures."""
    return ((picture[..., :3] + (1 - picture[..., 3:]) * BACKGROUND).clamp(0, 1) * 255).round()


def psnr(a, b):
    drawn = (a[..., 3] > 0) | (b[..., 3] > 0)
    assert drawn.double().mean() > 0.2
    return float(-10 * ((codes(a) - codes(b))[drawn] / 255).square().mean().log10())


def pairs_of_reference(start, end, transmittances, means2d, conics, opacities, width, height, tile_size, offsets,
                       flatten_ids):
    """gsplat.rasterize_to_indices_in_range for one image: the Gaussians that each pixel sees, from the nearest on."""
    assert start == 0 and (transmittances == 1).all()  # All of a tile's Gaussians are in the first range.
    ends = torch.cat([offsets.flatten()[1:], torch.tensor([len(flatten_ids)])]).tolist()
    gaussians, pixels = [], []
    for tile, (first, last) in enumerate(zip(offsets.flatten().tolist(), ends)):
        top, left = (tile // offsets.shape[-1]) * tile_size, (tile % offsets.shape[-1]) * tile_size
        y, x = torch.meshgrid(torch.arange(top, min(top + tile_size, height)),
                              torch.arange(left, min(left + tile_size, width)), indexing="ij")
        ids = flatten_ids[first:last].long()
        dx, dy = (p.reshape(-1, 1) + 0.5 - means2d[0, ids, i] for i, p in enumerate((x, y)))
        a, b, c = conics[0, ids].unbind(1)
        alphas = (opacities[0, ids] * torch.exp(-0.5 * (a * dx**2 + c * dy**2) - b * dx * dy)).clamp(max=0.999)
        alphas[alphas < 1 / 255] = 0
        pixel, place = ((alphas > 0) & ((1 - alphas).cumprod(1) > 1e-4)).nonzero().unbind(1)
        gaussians.append(ids[place])
        pixels.append((y * width + x).reshape(-1)[pixel])
    found, at = torch.cat(gaussians), torch.cat(pixels)
    order = at.argsort(stable=True)
    return found[order], at[order], torch.zeros_like(at)


def weights_of_reference(alphas, ray_indices, n_rays):
    """nerfacc.render_weight_from_alpha: what each alpha contributes behind those before it on the same ray."""
    lengths = torch.unique_consecutive(ray_indices, return_counts=True)[1].tolist()
    through = torch.cat([torch.cat([torch.ones(1), (1 - ray[:-1]).cumprod(0)]) for ray in alphas.split(lengths)])
    return alphas * through, through


def sums_of_reference(weights, values, ray_indices, n_rays):
    """nerfacc.accumulate_along_rays."""
    terms = weights[:, None] if values is None else weights[:, None] * values
    return torch.zeros(n_rays, terms.shape[1], dtype=terms.dtype).index_add(0, ray_indices, terms)


@pytest.fixture
def gsplat(monkeypatch):
    """The module of gsplat that holds its reference, with what it lacks without CUDA."""
    import gsplat.cuda._torch_impl as reference
    import gsplat.cuda._wrapper as wrapper

    monkeypatch.setattr(wrapper, "rasterize_to_indices_in_range", pairs_of_reference)
    monkeypatch.setitem(sys.modules, "nerfacc", types.SimpleNamespace(
        render_weight_from_alpha=weights_of_reference, accumulate_along_rays=sums_of_reference))
    return reference


def drawn_by(gsplat, gaussians, view):
    """A picture as fit_splats.View.picture has it."""
    height, width = view.picture.shape[:2]
    (fx, fy), (cx, cy), tile = view.focal, view.center, 16
    K = torch.tensor([[[fx, 0, cx], [0, fy, cy], [0, 0, 1]]], dtype=torch.double)
    means = gaussians["means"]
    scales = gaussians["scales"].exp()
    covariances, _ = gsplat._quat_scale_to_covar_preci(gaussians["quats"], scales, compute_preci=False)
    radii, centers, depths, conics, _ = gsplat._fully_fused_projection(
        means, covariances, view.T_cam_world[None], K, width, height)
    eye = torch.linalg.inv(view.T_cam_world)[:3, 3]
    sh = torch.cat([gaussians["sh0"], gaussians["shN"]], 1)
    colors = (gsplat._spherical_harmonics(DEGREE, means - eye, sh) + 0.5).clamp(min=0)
    columns, rows = -(-width // tile), -(-height // tile)
    _, isect_ids, flatten_ids = gsplat._isect_tiles(centers, radii, depths, tile, columns, rows)
    offsets = gsplat._isect_offset_encode(isect_ids, 1, columns, rows)
    picture, alpha = gsplat._rasterize_to_pixels(centers, conics, colors[None], gaussians["opacities"].sigmoid()[None],
                                                 width, height, tile, offsets, flatten_ids)
    return torch.cat([picture[0], alpha[0]], -1)


def views():
    return [fit_splats.view_of(camera, torch.zeros(SIZE[1], SIZE[0], 4)) for camera in CAMERAS]


def test_gsplat_draws_the_same(gsplat, fitted, ours):
    """The issue asks for 45 dB; the limits of alphas (see above) and rounding leave more."""
    for view, picture in zip(views(), ours):
        assert psnr(picture, drawn_by(gsplat, fitted, view)) >= 50


def test_the_script_draws_the_same(fitted, ours):
    """The limits are the same: only roundings differ. Colours, alphas and both of what is compared are rounded to
    codes, each with a mean squared error of 1/12 code: a third of a square code together, 53 dB."""
    for view, picture in zip(views(), ours):
        assert psnr(picture, fit_splats.draw(fitted, view)) >= 50


def test_the_fit_is_good(seen, fitted):
    """Seed and PSNR, 1 dB below what was measured: 26.4 dB, and 24.2 and 25.1 dB of the views that were not fitted.
    PyTorch's kernels for AVX2 and for no AVX give the same to 0.01 dB. A hash would hold for one of them alone: sums
    differ in their last digits, and 250 steps make 0.1 of that in some quaternions."""
    with torch.no_grad():
        errors = [fit_splats.psnr(fit_splats.draw(fitted, view), view.picture) for view in seen[0]]
    assert np.mean(errors[:12]) > 25.4 and min(errors[12:]) > 23.2
    # Harmonics of all degrees are in what is compared.
    assert all(fitted["shN"][:, part].abs().mean() > 0.01 for part in (slice(0, 3), slice(3, 8), slice(8, 15)))


def test_the_fit_is_the_same_again(seen):
    views, points, colors = seen
    once, again = (fitted_to(views[:12], points, colors, 12) for _ in range(2))
    assert all(torch.equal(once[name], again[name]) for name in once)


@pytest.mark.parametrize("name", ["means", "scales", "quats", "opacities", "sh0", "shN"])
def test_gradients_are_those_of_differences(name):
    """Central differences along a random direction: a loss of 0.1 has errors of 1e-16, which a step of 1e-7 makes 1e-9,
    1e-4 of a slope of 1e-5. In so small a step no pixel's alpha crosses 1/255, a jump that gradients do not know."""
    random = torch.Generator().manual_seed(SEED)

    def normal(*shape):
        return torch.randn(shape, generator=random, dtype=torch.double)

    gaussians = {"means": 0.5 * normal(40, 3), "scales": -2 + 0.3 * normal(40, 3), "quats": normal(40, 4),
                 "opacities": normal(40), "sh0": normal(40, 1, 3), "shN": 0.2 * normal(40, 15, 3)}
    direction = normal(*gaussians[name].shape)
    view = fit_splats.view_of(CAMERAS[0], torch.rand((48, 64, 4), generator=random, dtype=torch.double))

    def loss(shift):
        moved = gaussians | {name: gaussians[name] + shift * direction}
        return (fit_splats.draw(moved, view) - view.picture).square().mean()

    shift = torch.zeros((), dtype=torch.double, requires_grad=True)
    slope = float(torch.autograd.grad(loss(shift), shift)[0])
    assert abs(slope) > 1e-5
    assert float(loss(1e-7) - loss(-1e-7)) / 2e-7 == pytest.approx(slope, rel=1e-4)
