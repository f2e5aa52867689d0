import numpy as np
import pytest

import easypbr
from easypbr import Material, Scene, Viewer, shapes


def lamp(emissive=20.0):
    mesh = shapes.sphere(1, 48)
    mesh.material = Material(base_color="#000000", emissive=(emissive,) * 3)
    return mesh


@pytest.fixture
def view(size):
    scene = Scene()
    scene.show(lamp(), "lamp")
    values = {"camera": {"position": (0, 0, 6), "target": (0, 0, 0)}, "background": {"mode": "transparent"}}
    return Viewer(size, values, scene)


def test_bloom_adds_no_light(view):
    plain = view.render(samples=4, hdr=True)
    view.settings.update({"bloom": {"enabled": True, "threshold": 0, "intensity": 0.5}})
    glowing = view.render(samples=4, hdr=True)
    # 2 %: the glow of a sphere that fills half of the picture reaches its borders, see tests/render/bloom_test.cpp.
    assert glowing[:, :, 1].sum() == pytest.approx(plain[:, :, 1].sum(), rel=0.02)
    assert glowing[0, 0, 1] > 0


def test_focus_at_returns_and_pins_the_depth(view, size):
    distance = view.focus_at(size[0] // 2, size[1] // 2)
    assert distance == pytest.approx(5, abs=0.01)
    assert view.settings.depth_of_field.focus_distance == distance
    with pytest.raises(easypbr.ArgumentError, match="shows nothing"):
        view.focus_at(0, 0)
    with pytest.raises(easypbr.ArgumentError, match="expected a pixel"):
        view.focus_at(0, size[1])


def test_the_lens_softens_what_is_out_of_focus(view):
    sharp = view.render(samples=16, hdr=True)
    view.settings.update({"depth_of_field": {"enabled": True, "f_number": 0.5, "focus_distance": 20}})
    for samples in (1, 32):
        soft = view.render(samples=samples, hdr=True)
        row = soft.shape[0] // 2
        assert np.abs(np.diff(soft[row, :, 1])).max() < 0.7 * np.abs(np.diff(sharp[row, :, 1])).max()


def test_what_moved_since_the_last_picture_is_blurred(view):
    view.settings.motion_blur.enabled = True
    view.settings.motion_blur.shutter = 1
    view.render(samples=1)
    ball = view.scene.get("lamp")
    pose = np.eye(4)
    pose[0, 3] = 0.5
    ball.T_parent_mesh = pose
    moved, still = view.render(samples=16), view.render(samples=16)
    assert (moved != still).any()
    pose[0, 3] = 0
    ball.T_parent_mesh = pose
    view.forget_motion()
    fresh = view.render(samples=16)
    np.testing.assert_array_equal(view.render(samples=16), fresh)


def test_a_texture_with_broken_values_is_mended(size):
    texture = np.full((8, 8, 3), 0.5, np.float32)
    texture[2, 3, 1] = np.nan
    texture[5, 5, 0] = np.inf
    mesh = shapes.plane(2)
    mesh.material = Material(base_color_texture=texture)
    values = {"bloom": {"enabled": True, "threshold": 0}}
    picture = easypbr.render(mesh, size=size, samples=4, hdr=True, settings=values)
    assert np.isfinite(picture).all()


@pytest.mark.parametrize("path", [False, True])
@pytest.mark.parametrize("samples", [1, 16])
def test_shadows_of_a_transparent_image_are_as_dark_on_a_white_page(size, samples, path):
    scene = Scene()
    scene.show(shapes.box(), "box")
    settings = {"ground.mode": "shadow", "path.enabled": path, "image.antialias": "none", "ssao.enabled": True}
    drawn = {}
    for name, background in (("cut", {"background.mode": "transparent"}), ("page", {"background.color": "#ffffff"})):
        drawn[name] = Viewer(size, {**settings, **background}, scene).render(samples=samples) / 255.0
    alpha = drawn["cut"][..., 3:]
    blended = drawn["cut"][..., :3] * alpha + 1 - alpha  # as viewers of PNG do
    black = (drawn["cut"][..., :3] == 0).all(axis=2)
    # Beside the box a pixel may show a little of it, which is black too.
    apart = np.lib.stride_tricks.sliding_window_view(np.pad(black, 1, constant_values=True), (3, 3)).all(axis=(2, 3))
    shadow = apart & (alpha[..., 0] > 0)
    assert shadow.sum() > 100 and alpha[shadow].max() > 0.1
    # 2: both are rounded to codes, and sums of frames are kept in floats.
    assert abs(blended - drawn["page"][..., :3])[shadow].max() <= 2 / 255
    assert alpha.max() == 1  # the box


def test_the_alpha_of_surfaces_before_a_shadow_catcher_is_what_they_cover(size):
    """Before a ground that no shadow falls on: with it and without it the same."""
    scene = Scene()
    scene.show(shapes.box(), "box")
    settings = {"background.mode": "transparent", "ground.shadow_strength": 0.0, "rays.enabled": False}
    with_ground, without = (Viewer(size, {**settings, "ground.mode": mode}, scene).render(samples=8) for mode in ("shadow", "none"))
    partly = (without[..., 3] > 0) & (without[..., 3] < 255)
    assert partly.any()
    # 1: the share of the ground is a sum of its own.
    assert abs(with_ground.astype(int) - without)[..., 3].max() <= 1


@pytest.mark.parametrize("samples", [1, 2])
@pytest.mark.parametrize("denoise", ["off", "filter"])
def test_a_shadow_takes_a_part_of_the_light_from_the_first_sample_on(samples, denoise):
    """What few paths find of a shadow is up to some times the light that there is."""
    scene = Scene()
    scene.show(shapes.box(1.0), "box")
    settings = {"ground.mode": "shadow", "path.enabled": True, "path.denoise": denoise, "image.samples": samples}
    alpha = Viewer((160, 120), {**settings, "background.mode": "transparent"}, scene).render(hdr=True)[..., 3]
    assert alpha.min() >= 0 and alpha.max() <= 1
    # Something of the shadow is there, and not the box alone.
    assert ((alpha > 0) & (alpha < 1)).sum() > 100
    page = Viewer((160, 120), {**settings, "background.color": "#ffffff"}, scene).render(hdr=True)
    assert page[..., :3].min() >= 0
