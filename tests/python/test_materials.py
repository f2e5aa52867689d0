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
