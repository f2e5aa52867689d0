"""What the options of `easypbr render` do to the pixels."""
import numpy as np
import pytest

import exr
import png

FRONT = ("--camera-position", "0,0,5", "--camera-target", "0,0,0")


def linear(code):
    """Linear value of an 8-bit sRGB code (IEC 61966-2-1)."""
    c = code / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def srgb8(value):
    return 255 * (12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055)


@pytest.fixture(scope="session")
def constant(meshes):
    """An environment of radiance 0.7 everywhere."""
    exr.write(meshes / "constant.exr", np.full((16, 32, 3), 0.7, np.float32))
    return meshes / "constant.exr"


@pytest.fixture
def picture(render, tmp_path):
    def draw(*arguments):
        render(*arguments, "-o", "out.png")
        return png.read(tmp_path / "out.png")

    return draw


@pytest.fixture
def layers(render, tmp_path):
    def draw(names, *arguments):
        render(*arguments, "-o", "out.png", "--layers", names)
        return [exr.read(tmp_path / f"out_{name}.exr") for name in names.split(",")]

    return draw


@pytest.mark.parametrize("samples", ["1", "4"])
def test_background_color_is_shown_exactly(picture, sphere, samples):
    pixels = picture(sphere, "--background", "#204060", "--samples", samples, "--exposure", "3")
    assert pixels[0, 0].tolist() == [0x20, 0x40, 0x60, 255]


def test_background_may_be_named(picture, sphere):
    assert picture(sphere, "--background", "white")[0, 0].tolist() == [255, 255, 255, 255]


def test_transparent_background_has_no_alpha(picture, sphere):
    pixels = picture(sphere, "--background", "transparent")
    assert pixels[0, 0, 3] == 0 and pixels[24, 32, 3] == 255


def test_background_may_be_an_image(easypbr, picture, sphere, tmp_path):
    exr.write(tmp_path / "back.exr", np.full((4, 4, 3), (0.1, 0.2, 0.4), np.float32))
    easypbr("convert", "back.exr", "back.png")
    shown = png.read(tmp_path / "back.png")[0, 0, :3].tolist()
    assert picture(sphere, "--background", "back.png")[0, 0, :3].tolist() == shown


@pytest.mark.parametrize("mode", ["env", "blur"])
def test_background_may_be_the_environment(picture, sphere, constant, mode):
    pixels = picture(sphere, "--env", constant, "--background", mode, "--tonemap", "none", "--exposure", "1")
    # 1: rounding to 8 bits.
    assert abs(pixels[0, 0, :3] - srgb8(0.7)).max() <= 1


@pytest.mark.parametrize("exposure", ["1", "0.5"])
def test_exposure_is_a_factor_on_radiance(picture, sphere, constant, exposure):
    pixels = picture(sphere, "--env", constant, "--color", "white", "--metallic", "1", "--roughness", "0.5",
                     "--tonemap", "none", "--exposure", exposure, "--set", "ground.mode=none")
    # 1.5: rounding to 8 bits, and 0.5 % of radiance, which is 0.5 codes here.
    assert abs(pixels[24, 32, :3] - srgb8(0.7 * float(exposure))).max() <= 1.5


def test_tone_curve_changes_the_picture(picture, sphere):
    pictures = [picture(sphere, "--exposure", "1", "--tonemap", name) for name in ("aces", "reinhard", "agx", "none")]
    for i, a in enumerate(pictures):
        for b in pictures[i + 1 :]:
            assert (a[24, 32] != b[24, 32]).any()


@pytest.mark.parametrize("rotation, brighter", [("0", "right"), ("180", "left")])
def test_environment_turns_about_the_up_axis(picture, sphere, tmp_path, rotation, brighter):
    halves = np.full((16, 32, 3), 0.1, np.float32)
    halves[:, 16:] = 0.7  # u > 0.5 is right of -Z, where the camera looks
    exr.write(tmp_path / "halves.exr", halves)
    pixels = picture(sphere, "--env", "halves.exr", "--env-rotation", rotation, "--background", "env", *FRONT)
    left, right = pixels[0, 0, 0], pixels[0, -1, 0]
    assert (right > left) == (brighter == "right") and right != left


def test_material_overrides_reach_the_gbuffer(layers, sphere):
    albedo, roughness, metallic = layers("albedo,roughness,metallic", sphere, "--color", "#804020", "--metallic", "1",
                                         "--roughness", "0.3")
    # 0.002: half a step of 8 bits.
    assert [albedo[c][24, 32] for c in "RGB"] == pytest.approx([linear(v) for v in (0x80, 0x40, 0x20)], abs=0.002)
    assert next(iter(roughness.values()))[24, 32] == pytest.approx(0.3, abs=0.002)
    assert next(iter(metallic.values()))[24, 32] == pytest.approx(1, abs=0.002)


@pytest.mark.parametrize("lens", [("--ortho", "4"), ("--fov-y", "53.13010235")])
def test_lens_covers_the_pixels_it_must(layers, box, lens):
    # The front face, 2 x 2 and 4 away, is half as high as the picture there: 4 = 2 x 4 tan(53.13 / 2 degrees).
    (albedo,) = layers("albedo", box, "--size", "40x40", *FRONT, *lens)
    covered = albedo["A"] > 0
    expected = np.zeros((40, 40), bool)
    expected[10:30, 10:30] = True
    assert (covered == expected).all()


def test_depth_and_normal_are_those_of_the_front_face(layers, box):
    depth, normal = layers("depth,normal_world", box, "--flat", *FRONT)
    # float32 depth: relative error 1e-5.
    assert next(iter(depth.values()))[24, 32] == pytest.approx(4, rel=1e-5)
    assert [normal[c][24, 32] for c in "RGB"] == pytest.approx([0, 0, 1], abs=2e-4)


def test_pose_file_is_the_same_camera(picture, box, tmp_path):
    by_position = picture(box, *FRONT)
    (tmp_path / "gl.txt").write_text("1 0 0 0\n0 1 0 0\n0 0 1 5\n0 0 0 1\n")
    (tmp_path / "cv.txt").write_text("1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 5, 0, 0, 0, 1")
    assert (picture(box, "--camera-pose", "gl.txt") == by_position).all()
    assert (picture(box, "--camera-pose", "cv.txt", "--camera-axes", "opencv") == by_position).all()


def test_camera_of_the_command_line_replaces_the_pose_of_a_settings_file(layers, box, tmp_path):
    (tmp_path / "pose.txt").write_text("1 0 0 0\n0 1 0 0\n0 0 1 9\n0 0 0 1\n")
    layers("depth", box, "--camera-pose", "pose.txt", "--save-settings", "look.json")
    (depth,) = layers("depth", box, "--settings", "look.json", *FRONT)
    assert next(iter(depth.values()))[24, 32] == pytest.approx(4, rel=1e-5)


@pytest.mark.parametrize("up, channel, sign", [("+y", "G", 1), ("-y", "G", -1), ("+z", "B", 1), ("-Y", "G", -1), ("+Z", "B", 1),
                                               ("Z", "B", 1), ("auto", "G", 1)])
def test_up_axis_points_up(layers, sphere, up, channel, sign):
    (normal,) = layers("normal_world", sphere, "--camera-position", "5,0,0", "--camera-target", "0,0,0", "--up", up)
    top = normal[channel][8, 32]  # the sphere covers rows 1 to 46 or fewer
    assert sign * top > 0.4


def test_texture_colors_the_surface(easypbr, layers, box, tmp_path):
    exr.write(tmp_path / "red.exr", np.full((4, 4, 3), (0.5, 0.1, 0.05), np.float32))
    easypbr("convert", "red.exr", "red.png")
    code = png.read(tmp_path / "red.png")[0, 0]
    (albedo,) = layers("albedo", box, "--color", "white", "--texture", "base_color=red.png", *FRONT)
    assert [albedo[c][24, 32] for c in "RGB"] == pytest.approx([linear(int(v)) for v in code[:3]], abs=0.004)


def test_flat_shading_has_one_normal_per_face(layers, meshes):
    import shapes

    coarse = shapes.write_sphere(meshes / "coarse.obj", 12)
    normals = {}
    for style in ("--flat", "--smooth"):
        (planes,) = layers("normal_world", coarse, style)
        stacked = np.stack([planes[c] for c in "RGB"], axis=2).reshape(-1, 3)
        normals[style] = len(np.unique(stacked, axis=0))
    # 12 x 6 quads are at most 144 triangles; the smooth sphere has another normal in every one of 1600 pixels.
    assert normals["--flat"] <= 145 and normals["--smooth"] > 1000


def test_crease_angle_decides_on_stl_edges(layers, tmp_path):
    faces = {(0, 0, 1): [(0, 0, 0), (1, 0, 0), (0, 1, 0)], (1, 0, 0): [(0, 0, 0), (0, 1, 0), (0, 0, -1)]}
    text = "solid s\n"
    for triangle in faces.values():
        text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex %d %d %d\n" % p for p in triangle)
        text += "endloop\nendfacet\n"
    (tmp_path / "edge.stl").write_text(text + "endsolid s\n")
    view = ("--camera-position", "0.3,0.3,5", "--camera-target", "0.3,0.3,0", "--ortho", "1")
    (sharp,), (soft,) = (layers("normal_world", "edge.stl", "--crease", angle, *view) for angle in ("30", "180"))
    # The picture's middle is on the first triangle, whose own normal is +z.
    assert sharp["B"][24, 32] == pytest.approx(1, abs=1e-4) and soft["B"][24, 32] < 0.99


def test_crease_angle_decides_on_edges_of_files_without_normals(layers, easypbr, tmp_path):
    # Two triangles at a right angle with a common edge.
    (tmp_path / "edge.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 -1\nf 1 2 3\nf 1 3 4\n")
    view = ("--camera-position", "0.3,0.3,5", "--camera-target", "0.3,0.3,0", "--ortho", "1")
    (sharp,), (soft,), (plain,) = (
        layers("normal_world", "edge.obj", *crease, *view) for crease in (("--crease", "30"), ("--crease", "180"), ())
    )
    # The picture's middle is on the first triangle, whose own normal is +z.
    assert sharp["B"][24, 32] == pytest.approx(1, abs=1e-4)
    assert soft["B"][24, 32] < 0.99 and (plain["B"] == sharp["B"]).all()
    for crease, vertices in (("30", 6), ("100", 4)):
        easypbr("convert", "edge.obj", "edge.ply", "--crease", crease)
        assert b"element vertex %d\n" % vertices in (tmp_path / "edge.ply").read_bytes()


def test_bit_depth_16_writes_16_bits(picture, sphere):
    pixels = picture(sphere, "--bit-depth", "16", "--background", "#204060")
    assert pixels.dtype.itemsize == 2 and pixels[0, 0].tolist() == [0x20 * 257, 0x40 * 257, 0x60 * 257, 65535]


def test_samples_smooth_edges_and_are_deterministic(picture, sphere):
    one, many, again = (picture(sphere, "--set", "image.antialias=none", "--samples", n) for n in ("1", "16", "16"))
    assert (many == again).all() and (one != many).any()


def test_f3d_spellings_give_the_same_picture(easypbr, render, sphere, constant, tmp_path):
    render(sphere, "-o", "ours.png", "--env", constant, "--size", "40x30")
    easypbr("render", sphere, "--output=theirs.png", f"--hdri-file={constant}", "--resolution=40,30", "--samples=1")
    assert (tmp_path / "ours.png").read_bytes() == (tmp_path / "theirs.png").read_bytes()
    assert png.read(tmp_path / "ours.png").shape == (30, 40, 4)


@pytest.mark.parametrize("thickness", ["0", "1"])
def test_clear_glass_vanishes_in_a_uniform_environment(picture, sphere, constant, thickness):
    pixels = picture(sphere, "--env", constant, "--background", "env", "--tonemap", "none", "--exposure", "1",
                     "--color", "white", "--metallic", "0", "--roughness", "0", "--set", "material.transmission=1",
                     "--set", f"material.thickness={thickness}")
    # What is not reflected goes through: 1 for rounding to 8 bits, 1 for the tables of the reflection (0.5 %).
    assert abs(pixels[:, :, :3] - srgb8(0.7)).max() <= 2
    plain = picture(sphere, "--env", constant, "--background", "env", "--tonemap", "none", "--exposure", "1",
                    "--color", "black", "--metallic", "0", "--roughness", "0")
    assert plain[24, 32, 0] < 100


def test_a_ground_catches_shadows_on_a_transparent_background(picture, sphere):
    # Anti-aliasing of single frames mixes codes.
    arguments = (sphere, "--background", "transparent", "--camera-position", "0,4,5", "--camera-target", "0,0,0", "--set",
                 "image.antialias=none")
    assert not (picture(*arguments)[40, :, 3] > 0).any()
    caught = picture(*arguments, "--set", "ground.mode=shadow")
    row = caught[40]
    # Black where some light is missing, and nowhere all of it: studio and three lights.
    assert (row[:, :3] == 0).all() and 4 < row[:, 3].max() < 255
    half = picture(*arguments, "--set", "ground.mode=shadow", "--set", "ground.shadow_strength=0.5")[40]
    # The alpha is that of codes: light that is missing, in codes of 255. 3.5: half a code of both, by the slope of the sRGB
    # curve, up to 2.28, and twice that of the half.
    missing, half_missing = (255 * (1 - np.vectorize(linear)(255 - pixels[:, 3].astype(float))) for pixels in (row, half))
    assert abs(half_missing * 2 - missing).max() <= 3.5
    lifted = picture(*arguments, "--set", "ground.mode=plane", "--set", "ground.height=-3", "--set", "ground.plane_color=#ff0000")
    assert lifted[46, 32, 0] > lifted[46, 32, 1] + 20 and lifted[46, 32, 3] == 255


@pytest.mark.parametrize("setting, words", [
    ("ground.mode=mirror", ["ground.mode", "shadow", "mirror"]),
    ("ground.shadow_strength=2", ["ground.shadow_strength", "2"]),
    ("ground.radius=0", ["ground.radius", "0"]),
    ("ground.plane_roughness=-0.1", ["ground.plane_roughness", "-0.1"]),
    ("ground.height=nan", ["ground.height", "nan"]),
])
def test_a_wrong_ground_is_named(easypbr, sphere, setting, words):
    done = easypbr("render", sphere, "-o", "out.png", "--set", setting, code=2)
    assert all(word in done.stderr for word in words)
