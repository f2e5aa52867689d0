"""The scenes of bench/light.py as numbers that all renderers build them from, and how pictures are compared."""
import dataclasses
import pathlib
import sys

import numpy as np

SIZE = (256, 192)
#: Radiance from everywhere, in place of reflected light, that rasterisers may get where there is no sky.
AMBIENT = (0.0, 0.05, 0.1)
#: Of glass, where rasterisers blend it.
OPACITIES = (0.2, 0.4, 0.6, 0.8)
#: Materials: a diffuse surface; a conductor of a roughness; a dielectric of index 1.5 over a diffuse base; one that transmits.
DIFFUSE, CONDUCTOR, PLASTIC, GLASS = "diffuse", "conductor", "plastic", "glass"


@dataclasses.dataclass
class Shape:
    V: np.ndarray
    F: np.ndarray
    kind: str = DIFFUSE
    color: tuple = (0.6, 0.6, 0.6)
    roughness: float = 1.0
    emission: float = 0.0


@dataclasses.dataclass
class Setup:
    shapes: list
    position: tuple
    target: tuple
    fov_y_deg: float = 30.0
    sky: np.ndarray | None = None  #: equirectangular radiance
    lamps: list = dataclasses.field(default_factory=list)  #: position and intensity
    exposure: float = 1.0
    limit_samples: int = 512  #: of the mean that counts as the limit

    @property
    def shows_emitters(self):
        return any(shape.emission for shape in self.shapes)

    @property
    def half_height(self):
        """Of what is seen at the target."""
        return np.linalg.norm(np.subtract(self.position, self.target)) * np.tan(np.radians(self.fov_y_deg) / 2)

    @property
    def matt(self):
        return all(shape.kind == DIFFUSE for shape in self.shapes)

    @property
    def has_glass(self):
        return any(shape.kind == GLASS for shape in self.shapes)


def box(size, centre=(0.0, 0.0, 0.0)):
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.array(size) / 2 + centre
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
             [1, 5, 7], [1, 7, 3]]
    # Corners of their own for each face: flat.
    return corners[np.array(faces).ravel()].astype(np.float32), np.arange(36, dtype=np.int32).reshape(-1, 3)


def ball(radius, centre=(0.0, 0.0, 0.0), columns=96):
    """Of flat faces, as both renderers draw what has no normals."""
    rows = columns // 2
    polar, azimuth = np.meshgrid(np.linspace(0, np.pi, rows + 1), np.arange(columns) * 2 * np.pi / columns, indexing="ij")
    V = np.stack([np.sin(polar) * np.sin(azimuth), np.cos(polar), np.sin(polar) * np.cos(azimuth)], -1).reshape(-1, 3)
    row, column = np.divmod(np.arange(rows * columns), columns)
    a, b = row * columns + column, row * columns + (column + 1) % columns
    lower, upper = np.stack([a, a + columns, b + columns], -1), np.stack([a, b + columns, b], -1)
    F = np.concatenate([lower[row < rows - 1], upper[row > 0]])
    return (V * radius + centre).astype(np.float32), F.astype(np.int32)


def square(half, height):
    V = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]], np.float32) * half + np.array([0, height, 0], np.float32)
    return V, np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def room(tall=None, small=None):
    """A closed box of coloured walls, a lamp of a tenth of its ceiling, and two blocks, or what stands in their place."""
    wall = 0.05
    shapes = [Shape(*box((2, wall, 2), (0, -1, 0)), color=(0.7, 0.7, 0.7)),
              Shape(*box((2, wall, 2), (0, 1, 0)), color=(0.7, 0.7, 0.7)),
              Shape(*box((2, 2, wall), (0, 0, -1)), color=(0.7, 0.7, 0.7)),
              Shape(*box((wall, 2, 2), (-1, 0, 0)), color=(0.65, 0.06, 0.05)),
              Shape(*box((wall, 2, 2), (1, 0, 0)), color=(0.12, 0.45, 0.09)),
              tall or Shape(*box((0.55, 1.1, 0.55), (-0.35, -0.43, -0.35)), color=(0.7, 0.7, 0.7)),
              small or Shape(*box((0.5, 0.5, 0.5), (0.4, -0.72, 0.3)), color=(0.7, 0.7, 0.7)),
              Shape(*box((0.4, 0.02, 0.4), (0, 0.96, 0)), color=(0.0, 0.0, 0.0), emission=12.0)]
    # FLIP sees the noise of 512 samples here: 256 of them are 0.04 apart from it.
    return Setup(shapes, (0, 0, 4.6), (0, 0, 0), 28, limit_samples=4096)


def pit(sky):
    """A box that is open above and in front."""
    shapes = [Shape(*box((2, 0.1, 2), (0, -0.05, 0)), color=(0.7, 0.7, 0.7)),
              Shape(*box((2, 1.3, 0.1), (0, 0.65, -0.95)), color=(0.7, 0.7, 0.7)),
              Shape(*box((0.1, 1.3, 1.8), (-0.95, 0.65, 0.05)), color=(0.7, 0.1, 0.1)),
              Shape(*box((0.1, 1.3, 1.8), (0.95, 0.65, 0.05)), color=(0.1, 0.5, 0.1)),
              Shape(*box((0.5, 0.5, 0.5), (0.1, 0.25, -0.1)))]
    return Setup(shapes, (0, 0.9, 4.2), (0, 0.62, 0), 30, sky, exposure=2.0)


def rooms():
    gold = Shape(*box((0.55, 1.1, 0.55), (-0.35, -0.43, -0.35)), CONDUCTOR, (1.0, 0.77, 0.34), 0.15)
    glass = Shape(*ball(0.3, (0.4, -0.67, 0.3)), GLASS, (1.0, 1.0, 1.0), 0.0)
    return {"closed room": room(), "gold in a room": room(tall=gold), "glass in a room": room(small=glass)}


def balls(sky):
    """Of glass, on a ground under the sky."""
    ground = Shape(*square(3, -0.5), color=(0.5, 0.5, 0.5))

    def of(roughness):
        glass = Shape(*ball(0.5), GLASS, (1.0, 1.0, 1.0), roughness)
        # As in the rooms, 512 samples leave noise in what the light of the sun has passed.
        return Setup([glass, ground], (0.7, 0.5, 1.9), (0, -0.05, 0), 34, sky, exposure=2.5, limit_samples=4096)

    return {"glass ball": of(0.0), "frosted ball": of(0.45)}


def figures(V, F, sky, studio):
    """A figure of three materials on a ground under two skies, and under three lamps."""
    V = (V - (V.min(0) + V.max(0)) / 2) / np.ptp(V, axis=0).max()
    ground = Shape(*square(3, V[:, 1].min()), color=(0.5, 0.5, 0.5))
    lamps = [((1.5, 2.0, 2.0), 6.0), ((-2.0, 1.0, 1.5), 2.0), ((0.5, 1.5, -2.0), 3.0)]

    def of(figure, **more):
        return Setup([figure, ground], (0.7, 0.5, 1.9), (0, -0.05, 0), 34, **more)

    return {
        "matt figure": of(Shape(V, F), sky=sky, exposure=2.5),
        "gold figure": of(Shape(V, F, CONDUCTOR, (1.0, 0.77, 0.34), 0.2), sky=sky, exposure=2.5),
        "plastic figure": of(Shape(V, F, PLASTIC, (0.1, 0.25, 0.6), 0.3), sky=sky, exposure=2.5),
        "studio": of(Shape(V, F), sky=studio, exposure=1.0),
        "three lamps": of(Shape(V, F), lamps=lamps, exposure=1.5),
        "gold, three lamps": of(Shape(V, F, CONDUCTOR, (1.0, 0.77, 0.34), 0.3), lamps=lamps, exposure=1.5),
    }


def flat(shape):
    """Corners and normals, three of each a face, for what draws no flat faces of its own accord."""
    corners = shape.V[shape.F].astype(np.float32)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-20)
    return corners.reshape(-1, 3), np.repeat(normals, 3, axis=0)


def spots(setup, rows=2):
    """What stands for emissive boxes where only points send light: (position, direction, intensity), diffuse, of their undersides."""
    found = []
    for shape in setup.shapes:
        if shape.emission:
            low, high = shape.V.min(0), shape.V.max(0)
            intensity = shape.emission * (high - low)[0] * (high - low)[2] / rows ** 2
            steps = (np.arange(rows) + 0.5) / rows
            found += [(np.array([low[0] + x * (high - low)[0], low[1] - 1e-3, low[2] + z * (high - low)[2]]),
                       np.array([0.0, -1.0, 0.0]), intensity) for x in steps for z in steps]
    return found


def averaged(linear, factor):
    """Of factor x factor pixels each."""
    height, width, channels = linear.shape
    return linear.reshape(height // factor, factor, width // factor, factor, channels).mean((1, 3)).astype(np.float32)


def read_all(folder: pathlib.Path):
    """What bench/light.py has saved."""
    return np.load(folder / "setups.npy", allow_pickle=True).item()


def ambient_of(setup):
    return AMBIENT if setup.sky is None else AMBIENT[:1]


def opacities_of(setup):
    return OPACITIES if setup.has_glass else OPACITIES[:1]


def draw_each(folder: pathlib.Path, renderer, draw):
    """Saves what `draw` makes of each setup: pictures by what they were drawn with."""
    for name, setup in read_all(folder).items():
        np.save(folder / f"{renderer} {name}.npy", draw(setup))
        print(f"... {renderer}: {name}", file=sys.stderr, flush=True)


def displayed(radiance, exposure):
    """sRGB in [0, 1] of linear radiance, height x width x 3."""
    linear = np.clip(np.asarray(radiance, np.float32)[:, :, :3] * exposure, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055).astype(np.float32)
