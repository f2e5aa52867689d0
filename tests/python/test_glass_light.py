"""Path traced light through glass: shadows of lamps against closed forms, and what shines or is shown within and behind it."""
import math

import numpy as np
import pytest

from easypbr import Material, Mesh, Scene, Viewer, render, shapes

#: Transmittance of a way of 1.
ABSORBING = np.array([0.8, 0.5, 0.2])
#: What a face of index 1.5 lets in.
ENTERING = 0.96


def box(low, high):
    """A closed mesh whose faces look outwards."""
    V = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    F = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
                  [1, 5, 7], [1, 7, 3]])
    return Mesh(np.array(low) + V * (np.array(high) - low), F)


def sheet(y, half, up=True):
    """A level square."""
    V = np.array([[-half, y, half], [half, y, half], [half, y, -half], [-half, y, -half]], float)
    mesh = Mesh(V, np.array([[0, 1, 2], [0, 2, 3]] if up else [[0, 2, 1], [0, 3, 2]]))
    mesh.UV = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    return mesh


def glass(**changes):
    return Material(**{"base_color": "white", "roughness": 0, "transmission": 1, **changes})


def absorbing(thickness=1.0, **changes):
    return glass(thickness=thickness, attenuation_color=tuple(ABSORBING), attenuation_distance=1, **changes)


def matt(value=0.5, **changes):
    return Material(base_color=(value,) * 3, specular=0, roughness=1, **changes)


def pixels(meshes, camera, lamp=None, samples=16, **changes):
    """A linear picture."""
    scene = Scene()
    for i, mesh in enumerate(meshes):
        scene.show(mesh, f"mesh{i}")
    values = {"environment": {"enabled": False}, "lights": {name: {"enabled": False} for name in ("key", "fill", "rim")},
              "path": {"enabled": True, "clamp": 0, "denoise": "off", "bounces": 0}, "ground": {"mode": "none"},
              "background": {"mode": "color", "color": "#000000"}, "tonemap": {"exposure": 1, "operator": "none"},
              "camera": {"fov_y_deg": 1, **camera}}
    view = Viewer((16, 16), values, scene)
    view.settings.update(changes)
    if lamp is not None:
        view.add_light("lamp", **lamp)
    return view.render(samples=samples, hdr=True)[..., :3].astype(float)


def picture(*scene, **changes):
    """The mean of a linear picture."""
    return pixels(*scene, **changes).mean((0, 1))


SUN = {"type": "directional", "direction": (0, -1, 0), "intensity": 2}
#: Beside the diagonals of squares, where rays meet both of their faces.
BELOW = {"position": (3.4, 1, 0.13), "target": (0.4, 0, 0.13)}


def part_of_light(caster, lamp=SUN, camera=None):
    """What a caster leaves of the light on a floor. Nothing is reflected, and no light is found by chance: only numbers are
    rounded."""
    floor = sheet(0, 50)
    floor.material = matt()
    camera = BELOW if camera is None else camera
    return picture([floor, caster], camera, lamp) / picture([floor], camera, lamp)


@pytest.mark.parametrize("thickness", [0.01, 1, 3])
def test_a_closed_volume_absorbs_along_the_way_through_it(thickness):
    slab = box((-5, 2, -5), (5, 3, 5))
    slab.material = absorbing(thickness)
    np.testing.assert_allclose(part_of_light(slab), ENTERING**2 * ABSORBING, rtol=0.003)


@pytest.mark.parametrize("pose", [np.diag([0.01, 0.01, 0.01, 1]), np.diag([-0.01, 0.01, 0.01, 1])])
@pytest.mark.parametrize("inward", [False, True])
def test_the_way_is_in_world_units_whichever_way_faces_look(pose, inward):
    slab = box((-500, 200, -500), (500, 300, 500))
    if inward:
        slab.F = np.asarray(slab.F)[:, ::-1].copy()
    slab.T_parent_mesh = pose
    slab.material = absorbing(100)
    np.testing.assert_allclose(part_of_light(slab), ENTERING**2 * ABSORBING, rtol=0.003)


def test_a_volume_is_tinted_once():
    slab = box((-5, 2, -5), (5, 3, 5))
    slab.material = absorbing(base_color=(0.5, 1, 0.25))
    np.testing.assert_allclose(part_of_light(slab), ENTERING**2 * ABSORBING * (0.5, 1, 0.25), rtol=0.003)


@pytest.mark.parametrize("up", [False, True])
def test_an_open_sheet_has_its_thickness_in_world_units(up):
    pane = sheet(200, 500, up)
    pane.T_parent_mesh = np.diag([0.01, 0.01, 0.01, 1])
    pane.material = absorbing(50, base_color=(0.5, 1, 0.25))
    np.testing.assert_allclose(part_of_light(pane), ENTERING * ABSORBING**0.5 * (0.5, 1, 0.25), rtol=0.003)


def test_a_lamp_in_a_volume_shines_through_what_is_before_it():
    slab = box((-5, 1, -5), (5, 5, 5))
    slab.material = absorbing()
    lamp = {"type": "point", "position": (0.4, 2.5, 0.13), "intensity": 10, "radius": 0}
    # Beside the lamp's foot the way is longer, by 0.13 % where the light is measured: 0.3 % of the most absorbed channel.
    np.testing.assert_allclose(part_of_light(slab, lamp), ENTERING * ABSORBING**1.5, rtol=0.006)


def test_a_surface_in_a_volume_is_lit_through_what_is_before_it():
    block = box((-2, -1, -2), (2, 1.5, 2))
    block.material = absorbing(ior=1)
    plate = sheet(0, 1)
    plate.material = matt()
    above = {"position": (0.3, 20, 0.13), "target": (0.3, 0, 0.13), "up": "+z"}
    # There and back, without reflection. 2 %: the way back is chosen by chance.
    seen = [picture(meshes, above, SUN, samples=256) for meshes in ([block, plate], [plate])]
    np.testing.assert_allclose(seen[0] / seen[1], ABSORBING**3, rtol=0.02)


def test_textures_and_vertex_colours_tint_the_light_of_lamps():
    linear = np.where(np.array([255, 60, 20]) > 10, ((np.array([255, 60, 20]) / 255 + 0.055) / 1.055) ** 2.4, 0)
    pane = sheet(2, 5)
    pane.material = glass(base_color_texture=np.tile(np.array([255, 60, 20], np.uint8), (4, 4, 1)))
    np.testing.assert_allclose(part_of_light(pane), ENTERING * linear, rtol=0.003)
    pane.material = glass(transmission_texture=np.zeros((4, 4), np.uint8))
    assert (part_of_light(pane) == 0).all()
    pane.material = glass(metallic=1, metallic_texture=np.full((4, 4), 51, np.uint8))
    np.testing.assert_allclose(part_of_light(pane), ENTERING * 0.8, rtol=0.003)
    pane.material = absorbing(2, thickness_texture=np.full((4, 4), 51, np.uint8))
    np.testing.assert_allclose(part_of_light(pane), ENTERING * ABSORBING**0.4, rtol=0.003)
    pane.material = glass()
    pane.C = np.tile([255, 60, 20], (4, 1)) / 255
    np.testing.assert_allclose(part_of_light(pane), ENTERING * linear, rtol=0.003)


@pytest.mark.parametrize("sun", [(0.6, 0, -1), (0.6, 0, 1)])
@pytest.mark.parametrize("front", ["window", "mirror"])
@pytest.mark.parametrize("unlit", [False, True])
def test_colours_past_the_light_are_seen_in_mirrors_and_through_windows(front, unlit, sun):
    color = np.array([0.8, 0.4, 0.2])
    shown = sheet(0, 90)
    shown.V = np.asarray(shown.V)[:, [0, 2, 1]] * [1, -1, 1] + [0, 0, -3 if front == "window" else 30]
    shown.material = Material(base_color=tuple(color), unlit=unlit)
    shown.style.lit = False
    pane = sheet(0, 5)
    pane.V = np.asarray(pane.V)[:, [0, 2, 1]] * [1, -1, 1]
    pane.material = glass() if front == "window" else Material(base_color="white", roughness=0, metallic=1)
    lamp = {"type": "directional", "direction": sun, "intensity": math.pi}
    exposure = 2
    seen = picture([shown, pane], {"position": (0, 0, 20), "target": (0, 0, 0)}, lamp, samples=256,
                   tonemap={"exposure": exposure, "operator": "none"}, path={"bounces": 4})
    # The window also reflects black, by chance: 3 % are three deviations of a choice of one in ten, and white is not exact.
    np.testing.assert_allclose(seen, color / exposure * (ENTERING if front == "window" else 1), rtol=0.03)


def ball(radius):
    """A finely divided closed sphere around (0, 2, 0) that looks outwards."""
    mesh = shapes.sphere(radius, 96)
    V = np.asarray(mesh.V, float)
    mesh.V = V - (V.min(0) + V.max(0)) / 2 + (0, 2, 0)
    return mesh


def test_what_shines_in_a_volume_sends_out_the_light_that_it_emits():
    lamp = ball(0.25)
    lamp.material = Material(base_color="black", specular=0, emissive=(20, 20, 20))
    around = ball(0.5)
    around.material = glass(thickness=1, specular=0)
    floor = sheet(0, 50)
    floor.material = matt(0.1)
    camera = {"position": (3.4, 1, 0.13), "target": (0.1, 0, 0.13)}
    bare, within = (picture([floor, lamp, *more], camera, samples=2048, path={"bounces": 1}) for more in ([], [around]))
    # Nothing is reflected, at no angle: the glass makes the lamp larger by its index, and darker by the square of it. 4 %: one
    # path of thirty finds the lamp through the glass, three deviations are 2 %, and facets.
    np.testing.assert_allclose(within / bare, 1, rtol=0.04)


def test_what_shines_in_a_volume_lights_what_is_beside_it_as_much_less():
    plate = sheet(0, 1)
    plate.material = matt()
    lamp = sheet(1, 0.5, up=False)
    lamp.V = np.asarray(lamp.V) + (0.6, 0, 0)
    lamp.material = Material(base_color="black", specular=0, emissive=(5, 5, 5))
    block = box((-2, -1, -2), (2, 1.5, 2))
    block.material = glass(thickness=1, specular=0)
    block.style.flat = True
    above = {"position": (-0.5, 20, 0.13), "target": (-0.5, 0, 0.13), "up": "+z"}
    bare, within = (picture(meshes, above, samples=256) for meshes in ([plate, lamp], [block, plate, lamp]))
    # 1 %: the noise of both, and the larger picture of what is below a face of glass.
    np.testing.assert_allclose(within / bare, 1 / 1.5**2, rtol=0.01)


@pytest.mark.parametrize("mode", ["raster", "path"])
@pytest.mark.parametrize("thickness", [0, 1])
def test_glass_on_a_white_page_is_bright(mode, thickness):
    mesh = shapes.sphere()
    mesh.material = glass(thickness=thickness)
    codes = render(mesh, background="white", size=(160, 120), mode=mode)[40:80, 60:100, :3]
    # Two faces leave 0.92 of what stands for white, 4, of which the tone curve makes 243. 20: the shadow on the ground behind,
    # and noise.
    assert np.median(codes) > 223


def frosted(roughness=0.4, **changes):
    return glass(roughness=roughness, **changes)


#: As bright at the origin from 30 above, all of them: lamps without an area, and one with an area.
LAMPS_ABOVE = {"directional": {"direction": (0, -1, 0), "intensity": 1},
               "point": {"position": (0, 30, 0), "intensity": 900, "radius": 0},
               "large point": {"position": (0, 30, 0), "intensity": 900, "radius": 0.5},
               "spot": {"position": (0, 30, 0), "direction": (0, -1, 0), "intensity": 900},
               "disc": {"position": (0, 30, 0), "direction": (0, -1, 0), "radius": 3, "intensity": 100 / math.pi}}


def below(caster, lamp, samples=1024):
    """What a caster leaves of the light of one of the lamps on a dark floor, which sends next to nothing back."""
    floor = sheet(0, 50)
    floor.material = matt(0.02)
    values = {"type": lamp.split()[-1], **LAMPS_ABOVE[lamp]}
    bare, through = (picture([floor, *more], BELOW, values, samples=samples, path={"bounces": 1}) for more in ([], [caster]))
    return (through / bare).mean()


@pytest.mark.parametrize("lamp", LAMPS_ABOVE)
def test_a_frosted_pane_passes_the_light_of_a_lamp_once(lamp):
    pane = sheet(2, 90)
    pane.material = frosted(base_color=(0.5,) * 3)
    # Light from everywhere falls on an endless pane: its tint is left, less what it reflects. 3 %: what facets turn back, and
    # three deviations of the noise of 262144 paths, of which one of 80 looks into the lobe.
    assert below(pane, lamp) == pytest.approx(0.5 * ENTERING, rel=0.03)


@pytest.mark.parametrize("roughness", [0.02, 0.1])
def test_what_is_nearly_clear_passes_the_light_of_lamps_straight(roughness):
    pane = sheet(2, 5)
    pane.material = frosted(roughness, base_color=(0.5,) * 3)
    slab = box((-5, 2, -5), (5, 3, 5))
    slab.material = absorbing(roughness=roughness)
    for caster, left in ((pane, 0.5 * ENTERING), (slab, ENTERING**2 * ABSORBING)):
        floor = sheet(0, 50)
        floor.material = matt(0.02)
        bare, through = (picture([floor, *more], BELOW, SUN, samples=256, path={"bounces": 4}) for more in ([], [caster]))
        # 1 %: what the floor and the glass reflect to each other. Paths to the glass find nothing of the lamp.
        np.testing.assert_allclose(through / bare, left, rtol=0.01)


def test_a_roughness_texture_tells_where_lamps_shine_straight_through():
    pane = sheet(2, 5)
    for value, left in ((0, ENTERING), (255, 0)):
        pane.material = frosted(1, roughness_texture=np.full((4, 4), value, np.uint8))
        np.testing.assert_allclose(part_of_light(pane), left, rtol=0.003)


@pytest.mark.parametrize("lamp", ["directional", "point", "spot"])
def test_a_frosted_volume_passes_the_light_of_lamps_as_of_areas(lamp):
    slab = box((-60, 2, -60), (60, 3, 60))
    slab.material = frosted(thickness=1)
    # 4 %: the noise of both, 1 % each.
    assert below(slab, lamp) == pytest.approx(below(slab, "disc"), rel=0.04)


@pytest.mark.parametrize(("roughness", "thickness", "samples"), [(0.3, 0, 2048), (0.7, 0, 2048), (0.1, 1, 512), (0.3, 1, 8192)])
def test_a_frosted_globe_sends_out_the_light_of_the_lamp_in_it(roughness, thickness, samples):
    globe = ball(0.2)
    globe.material = frosted(roughness, thickness=thickness)
    floor = sheet(0, 50)
    floor.material = matt(0.1)
    lamp = {"type": "point", "position": (0, 2, 0), "intensity": 10, "radius": 0}
    camera = {"position": (3.4, 1, 0.13), "target": (0.1, 0, 0.13)}
    # What a rough face reflects leaves by another one: nothing is lost. What is nearly clear loses it. 5 %: the size of the
    # globe, 1 %, tables of albedos, 1 %, and noise, 1.5 %; a path of a hundred meets the globe.
    bare, within = (picture([floor, *more], camera, lamp, samples=samples, path={"bounces": 8}) for more in ([], [globe]))
    np.testing.assert_allclose(within / bare, 1 if roughness > 0.15 else ENTERING, rtol=0.05)


@pytest.mark.parametrize("roughness", [0, 0.3])
def test_an_area_light_within_glass_sends_out_all_of_its_light(roughness):
    globe = ball(0.5)
    globe.material = glass(thickness=1, roughness=roughness)
    floor = sheet(0, 50)
    floor.material = matt(0.1)
    lamp = {"type": "sphere", "position": (0, 2, 0), "intensity": 100, "radius": 0.1}
    camera = {"position": (3.4, 1, 0.13), "target": (0.1, 0, 0.13)}
    bare, within = (picture([floor, *more], camera, lamp, samples=4096, path={"bounces": 16}) for more in ([], [globe]))
    # Radiance in glass is n^2 of that outside, and the cone in which it leaves is 1 / n^2 of a half space. 5 %: noise; a path
    # of sixty meets the globe, and the lamp is an eightieth of the directions there.
    np.testing.assert_allclose(within / bare, 1, rtol=0.05)


@pytest.mark.parametrize("lamp", ["directional", "point", "spot"])
def test_lamps_shine_on_what_stands_in_glass_as_areas_do(lamp):
    within, around = sheet(0, 40), box((-50, -0.5, -50), (50, 0.5, 50))
    within.material, around.material = matt(), glass(thickness=1)
    camera = {"position": (6, 9, 0.13), "target": (0.1, 0, 0.13)}
    shines = {name: picture([within, around], camera, {"type": name, **LAMPS_ABOVE[name]}, samples=1024, path={"bounces": 32})
              for name in (lamp, "disc")}
    # 4 %: the noise of the disc, which is found by chance: it is an eightieth of the directions.
    np.testing.assert_allclose(shines[lamp], shines["disc"], rtol=0.04)


@pytest.mark.parametrize("hidden", [True, False])
@pytest.mark.parametrize("light", ["sphere", "mesh"])
def test_a_volume_absorbs_the_light_that_shines_within_it(light, hidden):
    floor, around = sheet(0, 40), box((-50, -1, -50), (50, 5, 50))
    floor.material, around.material = matt(), absorbing(ior=1, specular=0)
    shape = shapes.sphere(0.5)
    shape.translate((0, 3, 0))
    shape.material = Material(base_color="black", specular=0, emissive=(20, 20, 20))
    lamp = {"type": "sphere", "position": (0, 3, 0), "radius": 0.5, "intensity": 20, "casts_shadows": hidden}
    shining = ([shape], None) if light == "mesh" else ([], lamp)
    camera = {"position": (6, 9, 0.13), "target": (3, 0, 0.13)}
    bare, within = (picture([floor, *more, *shining[0]], camera, shining[1], samples=256, path={"bounces": 1})
                    for more in ([], [around]))
    # The ways to the nearest part of the ball and to its border, and to where the camera's ray enters the volume. 2 %: what the
    # floor sends to itself in neither, and noise.
    middle, seen = math.dist((3, 0, 0.13), (0, 3, 0)), math.dist((3, 0), (3 + 5 / 3, 5))
    left = within / bare / ABSORBING**seen
    assert (left < ABSORBING ** (middle - 0.5) * 1.02).all() and (left > ABSORBING**middle * 0.98).all()


@pytest.mark.parametrize("roughness", [0.12, 0.2, 0.5])
def test_a_frosted_pane_before_a_lamp_is_as_bright_as_in_the_raster(roughness):
    pane = sheet(0, 5)
    pane.material = frosted(roughness)
    camera = {"position": (0, 10, 1), "target": (0, 0, 0)}
    lamp = {"type": "directional", "direction": (0.1, 1, -0.2), "intensity": 1, "angular_radius_deg": 0}
    # Paths alone know the light that facets scatter to each other.
    raster, path = (picture([pane], camera, lamp, path={"enabled": enabled}, shading={"multiple_scattering": False})
                    for enabled in (False, True))
    assert (raster > 0.01).all()
    # 5 %: tables of albedos, and the G-buffer, which rounds roughness to 8 bits.
    np.testing.assert_allclose(path, raster, rtol=0.05)


#: Straight through what stands before z = 0.
STRAIGHT = {"position": (0.03, 0.02, 9), "target": (0.03, 0.02, 0)}


def shining(z, stripes=1, width=20.0):
    """Upright stripes of radiance 1, half of them left out."""
    edges = np.linspace(-width / 2, width / 2, 2 * stripes)
    V = [(x, y, z) for x in edges for y in (-width / 2, width / 2)]
    mesh = Mesh(np.array(V), np.array([(4 * i + a, 4 * i + b, 4 * i + c) for i in range(stripes)
                                       for a, b, c in ((0, 2, 3), (0, 3, 1))]))
    mesh.material = Material(base_color="black", specular=0, emissive=(1, 1, 1))
    return mesh


@pytest.mark.parametrize(("outer", "inner"), [(1.5, 1.5), (1.5, 1), (1.33, 1.5), (1.5, 1.33), (1, 1.5)])
def test_faces_between_volumes_reflect_by_the_ratio_of_their_indices(outer, inner):
    around, within = box((-4, -4, -1), (4, 4, 1)), box((-3, -3, -0.5), (3, 3, 0.5))
    around.material, within.material = glass(thickness=1, ior=outer), glass(thickness=1, ior=inner)
    seen = picture([around, within, shining(-3)], STRAIGHT, samples=256, path={"bounces": 64})
    faces = [((a - b) / (a + b)) ** 2 for a, b in ((1, outer), (outer, inner))]
    # What is reflected back and forth between faces adds R / (1 - R) of each to the inverse. 0.006: the table of albedos at a
    # right angle is off by 0.004, and four deviations of 65536 paths, each of which arrives or does not, are 0.005.
    np.testing.assert_allclose(seen, 1 / (1 + 2 * sum(R / (1 - R) for R in faces)), atol=0.006)


def glass_ball(*within):
    """Pictures of stripes through a ball of glass."""
    around = ball(1)
    around.material = glass(thickness=1)
    camera = {"position": (0, 2, 6), "target": (0, 2, 0), "fov_y_deg": 18}
    return pixels([around, *within, shining(-3, 20)], camera, samples=256, path={"bounces": 64})


def test_glass_in_glass_is_not_seen():
    within = ball(0.5)
    within.material = glass(thickness=1)
    # 0.015: the noise of the mean of two pictures' differences; a lens of index 1.5 makes it 0.1.
    assert abs(glass_ball(within) - glass_ball()).mean() < 0.015


def test_a_ball_of_air_in_glass_is_a_hole_in_it():
    bubble, cavity, hollow = ball(0.5), ball(0.5), ball(1)
    bubble.material = glass(thickness=1, ior=1)
    count = len(np.asarray(hollow.V))
    F = np.vstack([np.asarray(hollow.F), np.asarray(cavity.F)[:, ::-1] + count])
    hollow = Mesh(np.vstack([np.asarray(hollow.V), np.asarray(cavity.V)]), F)
    hollow.material = glass(thickness=1)
    camera = {"position": (0, 2, 6), "target": (0, 2, 0), "fov_y_deg": 18}
    hole = pixels([hollow, shining(-3, 20)], camera, samples=256, path={"bounces": 64})
    # As above. Schlick's reflectance is the same from both sides.
    assert abs(glass_ball(bubble) - hole).mean() < 0.015


def window(z, front):
    """An upright square with the thickness of a half."""
    mesh = sheet(0, 4, front)
    mesh.V = np.asarray(mesh.V)[:, [0, 2, 1]] * (1, -1, 1) + (0, 0, z)
    mesh.material = absorbing(0.5, base_color=(0.5, 1, 0.25))
    return mesh


@pytest.mark.parametrize("mode", ["raster", "path"])
@pytest.mark.parametrize("front", [False, True])
def test_an_open_sheet_colours_what_is_behind_it_by_its_thickness(front, mode):
    wall = shining(-3)
    seen = picture([window(0, front), wall], STRAIGHT, samples=256, path={"enabled": mode == "path", "bounces": 64})
    # The wall is farther away than the sheet is thick. 1.5 %: a tenth of 65536 paths is reflected by chance, and half floats.
    np.testing.assert_allclose(seen, ENTERING * ABSORBING**0.5 * (0.5, 1, 0.25), rtol=0.015)


def test_a_sheet_does_not_gather_the_light_of_a_bright_spot_of_sky():
    sky = np.zeros((64, 128, 3), np.float32)
    sky[:3] = 100
    floor = sheet(0, 50)
    floor.material = matt()
    lit = []
    for more in ([], [sheet(2, 5)]):
        for pane in more:
            pane.material = absorbing(0.5)
        scene = Scene()
        for i, mesh in enumerate([floor, *more]):
            scene.show(mesh, f"mesh{i}")
        values = {"path.enabled": True, "path.clamp": 0, "path.denoise": "off", "path.bounces": 4, "environment.sun": False,
                  "background.mode": "transparent", "tonemap.operator": "none", "tonemap.exposure": 1, "ground.mode": "none",
                  "camera.position": (3.4, 1, 0.13), "camera.target": (0.4, 0, 0.13), "camera.fov_y_deg": 1}
        view = Viewer((16, 16), values, scene)
        view.load_environment_map(sky)
        for name in ("key", "fill", "rim"):
            view.lights[name].enabled = False
        lit.append(view.render(samples=1024, hdr=True)[..., :3].mean((0, 1)))
    # 8 %: the sheet sends back 4 % of the floor's light straight and more at an angle, of which the floor returns half; and the
    # spot is 8 degrees wide and found by chance through the sheet.
    np.testing.assert_allclose(lit[1] / lit[0], ENTERING * ABSORBING**0.5, rtol=0.08)


def test_a_ball_with_holes_still_refracts():
    around, camera = ball(1), {"position": (0, 2, 6), "target": (0, 2, 0), "fov_y_deg": 18}
    around.F = np.delete(np.asarray(around.F), [100, 3000, 7000], 0)
    around.material = glass(thickness=1)
    seen = pixels([around, shining(-3, 20)], camera, samples=256, path={"bounces": 64})
    # As above: three of thousands of faces are missing.
    assert abs(seen - glass_ball()).mean() < 0.015


@pytest.mark.parametrize("up", [False, True])
def test_the_rasterised_shadow_of_an_open_sheet_has_its_whole_thickness(up):
    pane = sheet(2, 5, up)
    pane.material = absorbing(0.5, base_color=(0.5, 1, 0.25))
    floor = sheet(0, 50)
    floor.material = matt()
    lit, tinted = (picture([floor, *more], BELOW, SUN, path={"enabled": False}) for more in ([], [pane]))
    # 1 %: sums of shadow maps are half floats.
    np.testing.assert_allclose(tinted / lit, ENTERING * ABSORBING**0.5 * (0.5, 1, 0.25), rtol=0.01)
