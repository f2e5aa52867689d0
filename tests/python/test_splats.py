"""3D Gaussian splats from arrays."""

import numpy as np
import pytest

from easypbr import ArgumentError, Mesh, render, splats, splats_of


def wide(color=(1.0, 0.0, 0.0), **options):
    """One splat that fills the picture, three quarters opaque."""
    return splats([[0, 0, 0]], [[5, 5, 0.01]], opacities=0.75, colors=[color], **options)


def picture(mesh, samples=1):
    camera = {"position": (0, 0, 4), "target": (0, 0, 0)}
    return render(mesh, size=(32, 32), samples=samples, camera=camera, background="transparent")


def test_one_fills_the_picture():
    middle = picture(wide())[16, 16]
    # The splat's opacity at its middle; half a code.
    assert np.abs(middle.astype(int) - [255, 0, 0, round(0.75 * 255)]).max() <= 1


def test_layouts():
    count, random = 5, np.random.default_rng(1)
    means = random.normal(size=(count, 3))
    sh = random.normal(size=(count, 16, 3)).astype(np.float32)
    mesh = splats(means, np.full((count, 2), 0.1), random.normal(size=(count, 4)), np.full(count, 0.5), sh)
    assert mesh.scales.shape == (count, 3) and (mesh.scales[:, 2] == 0).all()
    assert np.array_equal(mesh.sh, sh.reshape(count, 48))
    mesh = splats(means, np.log(0.1), opacities=0.0, colors=np.full((count, 3), 0.5), raw=True)
    assert np.allclose(mesh.scales, 0.1) and np.allclose(mesh.opacities, 0.5) and np.allclose(mesh.sh, 0)
    assert np.array_equal(mesh.rotations[0], [1, 0, 0, 0])


def test_tensors():
    torch = pytest.importorskip("torch")
    mesh = splats(torch.zeros(2, 3, requires_grad=True), torch.ones(2, 3), torch.ones(2, 4), torch.ones(2), torch.zeros(2, 4, 3))
    assert mesh.sh.shape == (2, 12)


@pytest.mark.parametrize("dtype, white", [("f8", 1), ("f4", 255), ("i8", 255), ("u1", 255), ("u2", 65535)])
def test_colors_of_every_range(dtype, white):
    """As Mesh.C has them: (Mesh.C - 1/2) divided by the harmonic of degree 0."""
    colors = (np.array([[0, 0.2, 1], [0.4, 0.6, 0.8]]) * white).astype(dtype)
    mesh = splats([[0, 0, 0], [1, 0, 0]], 0.1, colors=colors)
    plain = Mesh([[0, 0, 0], [1, 0, 0]])
    plain.C = colors
    assert np.allclose(mesh.sh, (plain.C - 0.5) * np.sqrt(4 * np.pi), atol=1e-6) and np.isclose(plain.C[0, 2], 1)


def test_none():
    for given in (dict(colors=np.zeros((0, 3))), dict(sh=np.zeros((0, 16, 3)))):
        mesh = splats(np.zeros((0, 3)), np.zeros((0, 3)), **given)
        assert mesh.V.shape == (0, 3) and len(mesh.sh) == 0


@pytest.mark.parametrize(
    "arguments, message",
    [
        (dict(means=[[0, 0, 0]], scales=1, colors=[[1, 1, 1, 1]]), "colors of 1 x 3, got 1 x 4: transparency is given by opacities"),
        (dict(means=[[0, 0, 0]], scales=1, colors=[[1, 1, 1]] * 2), "colors of 1 x 3, got 2 x 3"),
        (dict(means=[[0, 0, 0]], scales=1, colors=[[300, 1, 1]]), "colours: expected 0 to 1 or 0 to 255"),
        (dict(means=[[0, 0]], scales=1, colors=[[1, 1, 1]]), "means of n x 3"),
        (dict(means=[[0, 0, 0]], scales=[[1, 1, 1, 1]], colors=[[1, 1, 1]]), "scales"),
        (dict(means=[[0, 0, 0]], scales=1), "one of sh and colors"),
        (dict(means=[[0, 0, 0]], scales=1, colors=[[1, 1, 1]], opacities=[1, 1]), "one opacity or 1"),
        (dict(means=[[0, 0, 0]], scales=1, colors=[[1, 1, 1]], opacities=2), "opacities"),
        (dict(means=[[0, 0, 0]], scales=-1, colors=[[1, 1, 1]]), "scales"),
        (dict(means=[[0, 0, 0]], scales=1, sh=np.zeros((1, 2, 3))), "sh"),
        (dict(means=[[0, 0, 0]], scales=1, sh=np.full((1, 3), np.nan)), "sh"),
        (dict(means=[[0, 0, 0]], scales=1, quaternions=[[0, 0, 0, 0]], colors=[[1, 1, 1]]), "rotations"),
    ],
)
def test_what_is_refused(arguments, message):
    with pytest.raises(ArgumentError, match=message):
        splats(**arguments)


def model(count=4, degree=3):
    random = np.random.default_rng(2)
    return {
        "means": random.normal(size=(count, 3)),
        "scales": random.normal(size=(count, 3)),
        "quats": random.normal(size=(count, 4)),
        "opacities": random.normal(size=count),
        "sh0": random.normal(size=(count, 1, 3)),
        "shN": random.normal(size=(count, (degree + 1) ** 2 - 1, 3)),
    }


@pytest.mark.parametrize("degree", range(4))
def test_models_of_gsplat(degree):
    trained = model(degree=degree)
    mesh = splats_of({"step": 7, "splats": trained})
    # Single precision.
    assert np.allclose(mesh.V, trained["means"]) and np.allclose(mesh.rotations, trained["quats"])
    assert np.allclose(mesh.scales, np.exp(trained["scales"]))
    assert np.allclose(mesh.opacities, 1 / (1 + np.exp(-trained["opacities"])))
    assert np.allclose(mesh.sh, np.concatenate([trained["sh0"], trained["shN"]], axis=1).reshape(4, -1))


def test_models_of_nerfstudio():
    trained = model()
    other = dict(trained, features_dc=trained["sh0"][:, 0], features_rest=trained["shN"])
    del other["sh0"], other["shN"]
    other["opacities"] = other["opacities"][:, None]
    saved = {"pipeline": {f"_model.gauss_params.{name}": values for name, values in other.items()}}
    assert np.array_equal(splats_of(saved).sh, splats_of(trained).sh)


def test_models_without_a_part():
    trained = model()
    del trained["quats"]
    with pytest.raises(ArgumentError, match="'quats'"):
        splats_of(trained)
    with pytest.raises(ArgumentError, match="dictionary"):
        splats_of([1, 2])


@pytest.mark.parametrize("name", ["a.spz", "a.glb"])
def test_other_files(tmp_path, name):
    mesh = wide(color=(0.2, 0.4, 0.6))
    mesh.save(tmp_path / name)
    # Codes of colours are 0.028 apart (SPZ), and opacities 1 / 255.
    assert np.abs(picture(Mesh(tmp_path / name)).astype(int) - picture(mesh)).max() <= 5


def test_tools():
    mesh = splats([[float(i), 0, 0] for i in range(10)], [0.1, 0.2, 0.3] * np.ones((10, 1)), opacities=np.arange(10) / 10,
                  colors=np.full((10, 3), 0.5))
    assert mesh.crop_box((1.5, -1, -1), (4, 1, 1)).V[:, 0].tolist() == [2, 3, 4]
    assert mesh.crop_box((1.5, -1, -1), (4, 1, 1), invert=True).V[:, 0].tolist() == [0, 1, 5, 6, 7, 8, 9]
    assert mesh.crop_sphere((5, 0, 0), 1).V[:, 0].tolist() == [4, 5, 6]
    assert mesh.prune_splats(min_opacity=0.75).V[:, 0].tolist() == [8, 9]
    assert len(mesh.decimate_splats(3).scales) == 3
    cloud, surfels = mesh.to_cloud(), mesh.to_surfels()
    assert cloud.scales.size == 0 and np.allclose(cloud.C[:, 3], mesh.opacities)
    # sqrt(2) standard deviations of the two longer axes; across the shortest.
    assert np.allclose(np.abs(surfels.N), [1, 0, 0]) and np.allclose(surfels.B, np.sqrt(2) * 0.2)
    assert np.allclose(np.linalg.norm(surfels.T, axis=1), np.sqrt(2) * 0.3)
    surface = splats([[0, 0, 0]], 0.5, colors=[[0.2, 0.4, 0.6]]).to_mesh(resolution=32, level=0.5)
    assert np.allclose(np.linalg.norm(surface.V, axis=1), 0.5 * np.sqrt(2 * np.log(2)), atol=0.01)
    assert np.allclose(surface.C[:, :3], [0.2, 0.4, 0.6], atol=1e-4) and len(surface.F) > 100
    with pytest.raises(ArgumentError, match="from 8 to 512"):
        mesh.to_mesh(resolution=4)
    with pytest.raises(ArgumentError, match="nothing stays"):
        mesh.prune_splats(max_size=0.1)
    with pytest.raises(ArgumentError, match="mesh with splats"):
        cloud.decimate_splats(2)


def test_files(tmp_path):
    mesh = wide()
    mesh.save(tmp_path / "a.ply")
    again = Mesh(tmp_path / "a.ply")
    assert np.allclose(again.scales, mesh.scales, rtol=1e-6) and np.allclose(again.sh, mesh.sh)
    assert np.array_equal(picture(again), picture(mesh))



def test_samples_agree_with_one_frame():
    random = np.random.default_rng(3)
    mesh = splats(random.uniform(-0.5, 0.5, (200, 3)), 0.15, opacities=0.5, colors=random.random((200, 3)))
    one, many = (picture(mesh, n).astype(float) for n in (1, 16))
    # Colours as they cover: those of a pixel of opacity 1/255 mean nothing. Splats are about as wide as pixels, whose
    # samples make them a little wider.
    one, many = (p[:, :, :3] * p[:, :, 3:] / 255 for p in (one, many))
    assert one.max() > 100 and np.abs(one - many).mean() < 2
