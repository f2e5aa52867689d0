"""Materials in Python: every value of the table is an attribute, checked, kept, and reachable as a setting."""
import math

import numpy as np
import pytest

import easypbr
from easypbr import Material, Mesh, Viewer
from easypbr.errors import ArgumentError

#: One value of each extension that is not its default.
EXTENDED = {
    "clearcoat": 0.5, "clearcoat_roughness": 0.25, "clearcoat_normal_scale": 0.5, "sheen_color": (0.25, 0.5, 1.0),
    "sheen_roughness": 0.5, "ior": 1.75, "specular": 0.5, "specular_color": (2.0, 1.0, 0.5), "transmission": 0.75,
    "thickness": 0.5, "attenuation_color": (0.5, 1.0, 0.25), "attenuation_distance": 2.0, "dispersion": 2.0, "iridescence": 0.5,
    "iridescence_ior": 1.5, "iridescence_thickness_min": 200.0, "iridescence_thickness_max": 500.0, "anisotropy": 0.5,
    "anisotropy_rotation_deg": 30.0,
}


def test_values_are_kept():
    material = Material(**EXTENDED)
    for name, value in EXTENDED.items():
        assert getattr(material, name) == value
        assert getattr(Material(), name) != value


def test_they_survive_a_file(tmp_path):
    mesh = easypbr.shapes.sphere(1, 8)
    mesh.material = Material(**EXTENDED)
    mesh.material.clearcoat_normal_texture = np.full((2, 2, 3), 128, np.uint8)
    mesh.save(tmp_path / "mesh.glb")
    read = Mesh(tmp_path / "mesh.glb").children[0].material
    for name, value in EXTENDED.items():
        assert getattr(read, name) == pytest.approx(value, rel=1e-6), name


@pytest.mark.parametrize("name, value", [
    ("clearcoat", 1.5), ("ior", 0.5), ("transmission", -0.1), ("iridescence_ior", 0.0), ("anisotropy", math.nan),
    ("attenuation_distance", 0.0), ("sheen_color", (2, 0, 0)), ("opacity", math.inf),
])
def test_values_out_of_range_are_refused(name, value):
    mesh = easypbr.shapes.box()
    for material in (Material(), mesh.material):
        before = getattr(material, name)
        with pytest.raises(ArgumentError, match=f"{name}: expected"):
            setattr(material, name, value)
        assert getattr(material, name) == before


def test_codes_are_no_base_color():
    mesh = easypbr.shapes.box()
    for material in (Material(), mesh.material):
        before = material.base_color
        for color in ((255, 0, 0), (1.5, 0, 0), np.array([0, 0, 2.0])):
            with pytest.raises(ArgumentError, match="base_color: expected a colour.*3 numbers from 0 to 1, got"):
                material.base_color = color
        assert material.base_color == before
        material.base_color = (1, 0, 1)
        material.emissive = (255, 0, 0)
        assert material.base_color == (1, 0, 1) and material.emissive == (255, 0, 0)


def test_alpha_mode():
    material = Material()
    assert material.alpha_mode == "auto"
    for mode in ("opaque", "mask", "blend", "auto"):
        material.alpha_mode = mode
        assert material.alpha_mode == mode
    with pytest.raises(ArgumentError, match="expected auto, opaque, mask or blend, got 'glass'"):
        material.alpha_mode = "glass"


def test_settings_take_the_same_names():
    settings = Viewer((16, 16)).settings.material
    for name, value in EXTENDED.items():
        if name not in ("clearcoat_normal_scale", "iridescence_thickness_min", "iridescence_thickness_max"):
            setattr(settings, name, min(value, 1.0) if isinstance(value, float) and name != "ior" else
                    tuple(min(channel, 1.0) for channel in value) if isinstance(value, tuple) else value)
    settings.iridescence_thickness = 500
    settings.alpha_mode = "blend"
    with pytest.raises(ValueError):
        settings.ior = 0.5


def test_colours_by_all_names_of_css():
    """Against matplotlib's table. A material's colour is linear: the curve of IEC 61966-2-1, up to the last bits of a float."""
    from matplotlib.colors import CSS4_COLORS

    assert len(CSS4_COLORS) == 148
    for name, code in CSS4_COLORS.items():
        srgb = np.array([int(code[i : i + 2], 16) for i in (1, 3, 5)]) / 255
        linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
        assert np.allclose(easypbr.Material(base_color=name).base_color, linear, rtol=0, atol=1e-6), name


def shown(mesh, **style):
    """The colour in the middle of a picture that a square fills."""
    for name, value in style.items():
        setattr(mesh.style, name, value)
    scene = easypbr.Scene()
    scene.show(mesh, "square")
    view = Viewer((16, 16), scene=scene)
    camera = easypbr.Camera.look_at((0, 0, 2), (0, 0, 0))
    camera.projection, camera.ortho_height = "orthographic", 1
    view.camera = camera
    return view.render(samples=1)[8, 8, :3], view.layers(["albedo"])["albedo"][8, 8, :3]


def square(**attributes):
    mesh = Mesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    for name, value in attributes.items():
        setattr(mesh, name, value)
    return mesh


def test_vertex_colours_are_those_of_the_surface():
    color = np.array([10, 200, 77], np.uint8)
    linear = np.where(color / 255 <= 0.04045, color / 255 / 12.92, ((color / 255 + 0.055) / 1.055) ** 2.4)
    colors = np.tile(color, (4, 1))
    # The albedo is stored in 16 bits.
    np.testing.assert_allclose(shown(square(C=colors))[1], linear, atol=2e-4)
    halved = square(C=colors)
    halved.material.base_color = (0.5, 0.5, 0.5)
    np.testing.assert_allclose(shown(halved)[1], linear / 2, atol=2e-4)


def test_unlit_materials_are_shown_exactly_where_nothing_is_lit():
    mesh = square()
    mesh.material = Material(unlit=True, base_color=(0.2158605,) * 3)
    assert (shown(mesh, lit=False)[0] == 128).all()


def test_files_whose_materials_are_all_unlit_are_shown_exactly(tmp_path):
    mesh = square()
    mesh.material = Material(unlit=True, base_color=(0.2158605,) * 3)
    mesh.save(tmp_path / "square.glb")
    read = Mesh(tmp_path / "square.glb")
    assert read.children[0].style.lit is False
    assert (shown(read)[0] == 128).all()


def textured_square() -> Mesh:
    """In the plane z = 0, with texture coordinates of the whole image."""
    mesh = Mesh(np.float32([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]), [[0, 1, 2], [0, 2, 3]])
    mesh.UV = np.float32([[0, 0], [1, 0], [1, 1], [0, 1]])
    mesh.material.roughness = mesh.material.metallic = 1
    return mesh


def centre_of(mesh: Mesh, *names: str) -> "list[np.ndarray]":
    """Values of layers in the middle of the square."""
    scene = easypbr.Scene()
    scene.show(mesh, "square")
    view = Viewer((16, 16), scene=scene)
    view.camera = easypbr.Camera.look_at((0, 0, 3), (0, 0, 0))
    data = view.render_layers(list(names), samples=1)
    return [data[name][8, 8] for name in names]


@pytest.mark.parametrize("kind", ["uint8", "uint16", "float32", "exr"])
def test_texels_of_data_are_numbers_whatever_their_type(tmp_path, kind):
    largest = {"uint8": 255, "uint16": 65535}.get(kind, 1)

    def texels(*values: float) -> "np.ndarray | str":
        array = np.tile(np.array(values) * largest, (4, 4, 1)).astype(kind if kind != "exr" else "float32")
        if kind != "exr":
            return array
        path = tmp_path / f"{len(list(tmp_path.iterdir()))}.exr"
        easypbr.save_image(array, path)
        return str(path)

    mesh = textured_square()
    mesh.material.roughness_texture = texels(0.5, 0.5, 0.5)
    mesh.material.metallic_texture = texels(0.25, 0.25, 0.25)
    mesh.material.normal_texture = texels(0.8, 0.5, 0.9)
    roughness, metallic, normal = centre_of(mesh, "roughness", "metallic", "normal_world")
    # A step of 8 bits; of a direction two, as its texels are twice that apart.
    assert abs(roughness - 0.5) <= 1 / 255 and abs(metallic - 0.25) <= 1 / 255
    assert np.abs(normal - np.array([0.6, 0, 0.8])).max() <= 2 / 255
    mesh.material.opacity_texture = texels(0.5, 0.5, 0.5)
    mesh.material.alpha_mode = "mask"
    for cutoff, seen in ((0.49, 1), (0.51, 0)):
        mesh.material.alpha_cutoff = cutoff
        assert centre_of(mesh, "instance_id") == [seen]


@pytest.mark.parametrize("extension", ["glb", "obj"])
def test_texels_of_data_are_written_as_numbers(tmp_path, extension):
    mesh = textured_square()
    for name in ("roughness", "metallic", "normal"):
        setattr(mesh.material, f"{name}_texture", np.full((2, 2, 3), 0.5, np.float32))
    mesh.save(tmp_path / f"square.{extension}")
    read = Mesh(tmp_path / f"square.{extension}")
    read = read.children[0] if read.children else read
    # Roughness is green and metallic blue in glTF.
    for name, channel in (("roughness", 1), ("metallic", 2), ("normal", 0)):
        # 0.5 * 255 = 127.5 rounds away from zero.
        assert (getattr(read.material, f"{name}_texture")[..., channel] == 128).all(), name


def test_floats_of_colours_are_linear_and_clamped_with_a_warning(caplog):
    mesh = textured_square()
    mesh.material.metallic = 0
    mesh.material.base_color_texture = np.full((2, 2, 3), 0.5, np.float32)
    # Held as code 188 (255 * 0.73536 = 187.52) of sRGB. The light of a step is there
    # 2.4 / 1.055 * ((0.737 + 0.055) / 1.055)^1.4 / 255 = 1 / 168.
    assert np.abs(centre_of(mesh, "albedo")[0] - 0.5).max() <= 1 / 168 and not caplog.records
    mesh.material.base_color_texture = np.full((2, 2, 3), 128, np.uint8)
    assert np.abs(centre_of(mesh, "albedo")[0] - 0.2159).max() <= 1 / 255
    bright = np.full((2, 2, 3), 0.25, np.float32)
    bright[0, 0] = 6.5
    for name in ("base_color", "emissive", "roughness"):
        mesh.material = Material()
        setattr(mesh.material, f"{name}_texture", bright)
        caplog.clear()
        scene = easypbr.Scene()
        scene.show(mesh, "square")
        view = Viewer((16, 16), scene=scene)
        for _ in range(2):
            view.render(samples=1)
        expected = [f"{name}_texture: colours above 1 were clamped to 1, the largest value is 6.5"]
        assert [record.getMessage() for record in caplog.records] == (expected if name != "roughness" else [])
    for name in ("base_color", "emissive"):
        assert "floats are linear and clamped to 1" in getattr(Material, f"{name}_texture").__doc__
