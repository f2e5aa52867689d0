"""The pictures of bench/light_peers.py that Open3D draws, in the environment of scripts/peers.sh. usage: light_open3d.py FOLDER

Open3D draws by Filament: physically based shading, image-based lighting, ambient occlusion in screen space with and without traced
cones, shadow maps of all lamps. It reads an environment as a prefiltered cube map, which is made here as Filament's own cmgen does.
Lamps are point lights, or spot lights where the scene's are emissive meshes; what rooms get besides is an ambient light. Glass is
translucent: what Open3D refracts in screen space it does not draw into pictures of memory.
"""
import hashlib
import itertools
import math
import pathlib
import struct
import sys
import tempfile

import light_scenes
import numpy as np
import open3d
from open3d.visualization import rendering

SUPERSAMPLING = 4
SIZE = (SUPERSAMPLING * light_scenes.SIZE[0], SUPERSAMPLING * light_scenes.SIZE[1])
CUBE_SIZES = (256, 128, 64, 32, 16)
SKY_SAMPLES = 256
TONES, BRIGHTEST = 16, 1.5  #: per channel, of the measured tone curve, and where it ends
EXPOSURE = 2 * 38400.0  #: of lights: what its camera divides by, twice for dark values


def cube_directions(size):
    """6 x size x size x 3: of texels, in the order of OpenGL."""
    t, s = np.meshgrid(*[(np.arange(size) + 0.5) / size * 2 - 1] * 2, indexing="ij")
    one = np.ones_like(s)
    faces = ((one, -t, -s), (-one, -t, s), (s, one, t), (s, -one, -t), (s, -t, one), (-s, -t, -one))
    directions = np.stack([np.stack(face, -1) for face in faces])
    return directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def looked_up(image, directions):
    """The nearest pixels of an equirectangular image; -z is in its middle."""
    height, width, _ = image.shape
    u = np.arctan2(directions[..., 0], -directions[..., 2]) / (2 * np.pi) + 0.5
    v = np.arccos(np.clip(directions[..., 1], -1, 1)) / np.pi
    return image[np.minimum((v * height).astype(int), height - 1), (u * width).astype(int) % width]


def pyramid(image):
    levels = [image]
    while levels[-1].shape[0] % 2 == 0 and levels[-1].shape[1] % 2 == 0:
        levels.append(light_scenes.averaged(levels[-1], 2))
    return levels


def prefiltered(levels, directions, alpha):
    """Radiance from around each direction, weighted by a GGX lobe of that roughness."""
    up = np.where(np.abs(directions[..., 1:2]) < 0.9, (0, 1, 0), (1, 0, 0))
    x = np.cross(up, directions)
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    y = np.cross(directions, x)
    total, weights = 0.0, 0.0
    for i in range(SKY_SAMPLES):
        first = (i + 0.5) / SKY_SAMPLES
        turn = 2 * np.pi * (i * 0.6180339887 % 1)
        cos2 = (1 - first) / (1 + (alpha ** 2 - 1) * first)
        n_l = 2 * cos2 - 1
        if n_l <= 0:
            continue
        sin_l = np.sqrt(1 - n_l ** 2)
        density = (alpha / (cos2 * (alpha ** 2 - 1) + 1)) ** 2 / (4 * np.pi)
        pixels = levels[0].shape[0] * levels[0].shape[1] / (4 * np.pi * SKY_SAMPLES * density)
        level = levels[int(np.clip(round(0.5 * np.log2(max(pixels, 1))), 0, len(levels) - 1))]
        total = total + n_l * looked_up(level, n_l * directions + sin_l * (np.cos(turn) * x + np.sin(turn) * y))
        weights += n_l
    return total / weights


def harmonics(image):
    """Nine coefficients of the polynomials that Filament's shaders evaluate."""
    height, width, _ = image.shape
    polar, azimuth = np.meshgrid((np.arange(height) + 0.5) / height * np.pi, ((np.arange(width) + 0.5) / width - 0.5) * 2 * np.pi,
                                 indexing="ij")
    x, y, z = np.sin(polar) * np.sin(azimuth), np.cos(polar), -np.sin(polar) * np.cos(azimuth)
    solid_angle = np.sin(polar) * np.pi / height * 2 * np.pi / width
    polynomials = (np.ones_like(x), y, z, x, x * y, y * z, 3 * z * z - 1, z * x, x * x - y * y)
    norms = (0.282095, 0.488603, 0.488603, 0.488603, 1.092548, 1.092548, 0.315392, 1.092548, 0.546274)
    lobes = (1.0,) + (2 / 3,) * 3 + (0.25,) * 5  # of the cosine, over pi
    return [lobe * norm ** 2 * ((polynomial * solid_angle)[:, :, None] * image).sum((0, 1))
            for polynomial, norm, lobe in zip(polynomials, norms, lobes)]


def write_cube_map(sky, path):
    """A KTX file of halves; levels are of the roughness that Filament looks up in them."""
    levels, cubes = pyramid(sky), []
    for i, size in enumerate(CUBE_SIZES):
        alpha = (1 - np.sqrt(1 - i / (len(CUBE_SIZES) - 1))) ** 2
        directions = cube_directions(size)
        cubes.append(prefiltered(levels, directions, alpha) if i else looked_up(levels[min(1, len(levels) - 1)], directions))
    coarse = next(level for level in reversed(levels) if level.shape[0] >= 50)
    text = b"sh\0" + "\n".join(" ".join(f"{value:.6g}" for value in row) for row in harmonics(coarse)).encode() + b"\n\0"
    entry = struct.pack("<I", len(text)) + text
    entry += bytes(-len(entry) % 4)
    half_float, rgba, rgba16f = 0x140B, 0x1908, 0x881A
    header = struct.pack("<13I", 0x04030201, half_float, 2, rgba, rgba16f, rgba, CUBE_SIZES[0], CUBE_SIZES[0], 0, 0, 6, len(cubes),
                         len(entry))
    with open(path, "wb") as file:
        file.write(b"\xabKTX 11\xbb\r\n\x1a\n" + header + entry)
        for cube in cubes:
            pixels = np.concatenate([cube, np.ones_like(cube[..., :1])], -1).astype(np.float16)
            file.write(struct.pack("<I", pixels[0].nbytes) + pixels.tobytes())


def between(table, coordinates):
    """Trilinear, of a table over the unit cube."""
    last = table.shape[0] - 1
    position = np.clip(coordinates, 0, 1) * last
    low = np.minimum(position.astype(int), last - 1)
    part, total = position - low, 0.0
    for corner in itertools.product((0, 1), repeat=3):
        weight = np.prod(np.where(corner, part, 1 - part), -1, keepdims=True)
        total = total + weight * table[tuple(np.moveaxis(low + corner, -1, 0))]
    return total


def inverse_of(table, count=33):
    """The other way round, where coordinates are square roots of values up to BRIGHTEST: values over the unit cube."""
    wanted = np.stack(np.meshgrid(*[np.linspace(0, 1, count)] * 3, indexing="ij"), -1)
    found = wanted.copy()
    for _ in range(200):
        found = np.clip(found + 0.5 * (wanted - between(table, found)), 0, 1)
    return found ** 2 * BRIGHTEST


def material_of(shape, matt, opacity):
    material = rendering.MaterialRecord()
    material.shader = "defaultLit"
    material.base_color = (*shape.color, 1.0)
    material.base_metallic = float(shape.kind == light_scenes.CONDUCTOR)
    material.base_roughness = shape.roughness
    material.base_reflectance = 0.0 if matt else 0.5  # of 0.04
    if shape.emission:
        material.shader = "defaultUnlit"
        material.base_color = (1.0, 1.0, 1.0, 1.0)
    elif shape.kind == light_scenes.GLASS:
        material.shader = "defaultLitTransparency"
        material.base_color = (*shape.color, opacity)
        material.has_alpha = True
    return material


class Renderer:
    def __init__(self):
        self.offscreen = rendering.OffscreenRenderer(*SIZE)
        self.lights = []
        self.folder = tempfile.TemporaryDirectory()
        self.linear_of = inverse_of(self.tones())
        ground = light_scenes.Shape(*light_scenes.square(3, 0), color=(1.0, 1.0, 1.0))
        seen = self.draw(light_scenes.Setup([ground], (0, 3, 0.1), (0, 0, 0), lamps=[((0, 2, 0), 2 * np.pi)]))
        self.linear_of /= 2 * seen[light_scenes.SIZE[1] // 2, light_scenes.SIZE[0] // 2].mean()  # a half is what it should be

    def set_up(self, setup):
        """An empty scene and its camera."""
        scene = self.offscreen.scene
        scene.clear_geometry()
        scene.set_background([0, 0, 0, 1])
        scene.show_skybox(False)
        scene.scene.enable_sun_light(False)
        self.offscreen.setup_camera(setup.fov_y_deg, np.float32(setup.target), np.float32(setup.position), np.float32((0, 1, 0)),
                                    0.05, 20.0)

    def tones(self):
        """What it displays of colours: measured, since pictures of memory have the tone curve by default, whatever is chosen."""
        self.set_up(light_scenes.Setup([], (0, 0, 1), (0, 0, 0), 2 * math.degrees(math.atan(0.5))))
        steps = np.linspace(0, 1, TONES)
        colors = np.stack(np.meshgrid(*[steps ** 2] * 3, indexing="ij"), -1).reshape(-1, 3)
        side = int(np.ceil(np.sqrt(len(colors))))
        row, column = np.divmod(np.arange(len(colors)), side)
        centres = np.stack([(column + 0.5) / side - 0.5, (row + 0.5) / side - 0.5, np.zeros(len(colors))], -1)
        corners = centres[:, None] + np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * 0.5 / side
        faces = 4 * np.arange(len(colors))[:, None, None] + [[0, 1, 2], [0, 2, 3]]
        mesh = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(corners.reshape(-1, 3)),
                                            open3d.utility.Vector3iVector(faces.reshape(-1, 3)))
        mesh.vertex_colors = open3d.utility.Vector3dVector(np.repeat(colors, 4, axis=0))
        mesh.compute_vertex_normals()  # none is drawn without end
        material = rendering.MaterialRecord()
        material.shader = "defaultUnlit"
        material.base_color = (BRIGHTEST, BRIGHTEST, BRIGHTEST, 1.0)
        self.offscreen.scene.add_geometry("tones", mesh, material)
        pixels = self.pixels()
        height, width, _ = pixels.shape
        x, y = (width / 2 + centres[:, 0] * height).astype(int), (height / 2 - centres[:, 1] * height).astype(int)
        near = np.mean([pixels[y + i, x + j] for i in (-2, -1, 0, 1, 2) for j in (-2, -1, 0, 1, 2)], axis=0)
        return near.reshape(TONES, TONES, TONES, 3)

    def pixels(self):
        return np.asarray(self.offscreen.render_to_image())[:, :, :3] / 255.0

    def add_lights(self, setup):
        scene = self.offscreen.scene.scene
        for name in self.lights:
            scene.remove_light(name)
        self.lights = [f"light{i}" for i in range(len(setup.lamps) + len(light_scenes.spots(setup)))]
        names, white = iter(self.lights), np.ones(3, np.float32)
        for position, intensity in setup.lamps:
            lumen = 4 * np.pi * intensity * setup.exposure * EXPOSURE
            scene.add_point_light(next(names), white, np.float32(position), lumen, 1000, True)
        for position, direction, intensity in light_scenes.spots(setup):
            lumen = np.pi * intensity * setup.exposure * EXPOSURE
            scene.add_spot_light(next(names), white, np.float32(position), np.float32(direction), lumen, 1000, 0.01, np.pi / 2, True)

    def set_sky(self, setup, ambient):
        scene = self.offscreen.scene.scene
        if setup.sky is None and not ambient:
            scene.enable_indirect_light(False)
            return
        sky = setup.sky if setup.sky is not None else np.full((64, 128, 3), ambient, np.float32)
        name = hashlib.sha256(sky.tobytes()).hexdigest()
        if not pathlib.Path(self.folder.name, name + "_ibl.ktx").exists():
            write_cube_map(sky, f"{self.folder.name}/{name}_ibl.ktx")
        if not scene.set_indirect_light(f"{self.folder.name}/{name}"):
            sys.exit("Open3D does not read its environment")
        scene.enable_indirect_light(True)
        scene.set_indirect_light_intensity(setup.exposure * EXPOSURE)

    def draw(self, setup, occlusion="none", ambient=0.0, opacity=light_scenes.OPACITIES[0]):
        self.set_up(setup)
        for i, shape in enumerate(setup.shapes):
            corners, normals = light_scenes.flat(shape)
            mesh = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(corners.astype(float)),
                                                open3d.utility.Vector3iVector(np.arange(len(corners)).reshape(-1, 3)))
            mesh.vertex_normals = open3d.utility.Vector3dVector(normals.astype(float))
            self.offscreen.scene.add_geometry(f"shape{i}", mesh, material_of(shape, setup.matt, opacity))
        self.add_lights(setup)
        self.set_sky(setup, ambient)
        view = self.offscreen.scene.view
        view.set_ambient_occlusion(occlusion != "none", occlusion == "cones")
        view.set_antialiasing(False)
        view.set_shadowing(True, rendering.View.ShadowType.PCF)
        return light_scenes.averaged(between(self.linear_of, self.pixels()), SUPERSAMPLING)


def main():
    open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)  # it misses the picture of a sky, which is not shown
    renderer = Renderer()

    def draw_all(setup):
        return {f"occlusion {occlusion}, ambient {ambient}, opacity {opacity}": renderer.draw(setup, occlusion, ambient, opacity)
                for occlusion, ambient, opacity in itertools.product(
                    ("none", "ao", "cones"), light_scenes.ambient_of(setup), light_scenes.opacities_of(setup))}

    light_scenes.draw_each(pathlib.Path(sys.argv[1]), "open3d", draw_all)


if __name__ == "__main__":
    main()
