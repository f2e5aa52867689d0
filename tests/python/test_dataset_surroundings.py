"""Data sets whose objects stand in a captured scene of Gaussian splats."""

import numpy as np
import pytest

import easypbr
from easypbr import ArgumentError, FileError
from easypbr.dataset import CameraSpec, DatasetSpec, ImageSpec, ObjectSpec, PlacementSpec, SurroundingsSpec, generate
from easypbr.dataset.extents import fitted
from easypbr.dataset.frames import FrameMaker


@pytest.fixture
def wall(tmp_path):
    """An opaque square of splats across z, red where the file's y is below 0, else blue."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(-1, 1, 60), np.linspace(-1, 1, 60)))
    colors = np.where(y[:, None] < 0, [1.0, 0, 0], [0, 0, 1.0])
    mesh = easypbr.splats(np.stack([x, y, 0 * x], 1), [[0.04, 0.04, 0.001]] * len(x), opacities=0.99, colors=colors)
    mesh.save(tmp_path / "wall.ply")
    return tmp_path / "wall.ply"


def spec_with(wall, up="y", **changes):
    spec = DatasetSpec(
        count=2, image=ImageSpec((96, 72), 1), writers=("raw",), objects=[ObjectSpec("builtin:shapes", "thing", (1, 1), 0.5)],
        camera=CameraSpec(distance=4.0, azimuth_deg=0.0, elevation_deg=0.0, fov_y_deg=40.0),
        surroundings=SurroundingsSpec(str(wall), 8.0, up),
    )
    for name, value in changes.items():
        setattr(spec, name, value)
    return spec


def test_the_wall_is_behind_and_hides(wall):
    # The camera looks along -z from z = 4. Things at 2 to 6 m: those behind the wall are placed again.
    maker = FrameMaker(spec_with(wall, placement=PlacementSpec(distance=(2.0, 6.0))))
    for index in range(4):
        frame = maker.make(index)
        (thing,) = frame.objects
        assert thing["pixels"] > 0 and thing["box3d_center"]
        around = frame.instance_id == 0
        # A splat's depth is where it is densest along the ray: in the plane but for the low-pass.
        assert np.abs(frame.depth[around] - 4).max() < 0.05
        assert frame.depth[~around].max() < 4.05
        assert np.count_nonzero(~around) == thing["pixels"]


@pytest.mark.parametrize("up, top", [("y", 2), ("-y", 0)])
def test_the_axis_that_points_up(wall, up, top):
    frame = FrameMaker(spec_with(wall, up)).make(0)
    upper, lower = frame.picture[2, 2], frame.picture[-3, 2]
    assert upper[top] > 200 and upper[2 - top] < 60
    assert lower[2 - top] > 200 and lower[top] < 60


@pytest.mark.parametrize("up", ["x", "y", "z", "-x", "-y", "-z", "+y", "+Z", "-X"])
def test_fitted(up):
    V = np.random.default_rng(1).uniform((-1, -2, -3), (2, 4, 6), (5000, 3))
    V[0] = (1e4, 0, 0)  # left out
    mesh = easypbr.Mesh()
    mesh.V = V
    T = fitted(mesh, 5, up)
    axis = (-1 if up.startswith("-") else 1) * np.eye(3)["xyz".index(up[-1].lower())]
    scale = np.cbrt(np.linalg.det(T[:3, :3]))
    assert np.allclose(T[:3, :3] @ axis / scale, (0, 1, 0)) and np.allclose(T[:3, :3] @ T[:3, :3].T, scale**2 * np.eye(3))
    placed = np.asarray(mesh.V, float) @ T[:3, :3].T + T[:3, 3]
    low, high = np.quantile(placed[1:], (0, 1), axis=0)
    # But for the outermost hundredth, which a uniform distribution has in a hundredth of its side.
    assert abs((high - low).max() - 5) < 0.1 and np.abs(low + high).max() < 0.1


def test_without_surroundings_nothing_changes(wall):
    plain = DatasetSpec.demo()
    plain.image = ImageSpec((48, 36), 1)
    assert not plain.surroundings.source
    maker = FrameMaker(plain)
    maker.make(0)
    assert "surroundings" not in maker._scene.names()


def test_from_a_file(wall, tmp_path):
    (tmp_path / "spec.toml").write_text(
        'count = 1\nimage.size = [48, 36]\nwriters = ["raw"]\n[surroundings]\nsource = "wall.ply"\nup = "-y"\nturn_deg = [-180, 180]\n'
        '[[objects]]\nsource = "builtin:shapes"\n'
    )
    spec = DatasetSpec.from_toml(tmp_path / "spec.toml")
    assert generate(spec, tmp_path / "out", workers=1)


def test_what_is_refused(wall, tmp_path):
    with pytest.raises(ArgumentError, match="surroundings.up"):
        spec_with(wall, "up").check()
    for up in ("+z", "+Z", "-Y", "x"):
        spec_with(wall, up).check()
    with pytest.raises(ArgumentError, match="surroundings.size"):
        spec_with(wall, surroundings=SurroundingsSpec(str(wall), 0.0)).check()
    with pytest.raises(FileError):
        FrameMaker(spec_with(tmp_path / "none.ply")).make(0)
