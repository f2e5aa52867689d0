"""easypbr.compat.pyrender: colours, materials, lines and segments as pyrender 0.1.45 has them. Numbers that stand for pyrender's
are those of its own pictures, or follow from its conventions."""

import copy
import pickle

import numpy as np
import pytest

import easypbr.compat.pyrender as pyrender
from easypbr.compat.pyrender import RenderFlags

trimesh = pytest.importorskip("trimesh")

SIZE = (96, 72)
CORNERS = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
UV = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def at(x, y, z):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def square(side=2.0, z=0.0, **visual):
    """A trimesh in the plane z."""
    made = trimesh.Trimesh(CORNERS * (side / 2, side / 2, 1) + (0, 0, z), FACES, process=False)
    if visual:
        made.visual = trimesh.visual.TextureVisuals(uv=UV, **visual)
    return made


def plain(**values):
    """A rough material that is no metal."""
    return pyrender.MetallicRoughnessMaterial(metallicFactor=0.0, roughnessFactor=1.0, **values)


@pytest.fixture
def renderer():
    renderer = pyrender.OffscreenRenderer(*SIZE)
    yield renderer
    renderer.delete()


def scene_of(mesh, pose=None, **values):
    """A scene with a mesh three metres before the camera, and its node."""
    values = {"ambient_light": [1.0, 1.0, 1.0], "bg_color": [0.0, 0.0, 0.0], **values}
    scene = pyrender.Scene(**values)
    node = scene.add(mesh, pose=at(0, 0, -3) if pose is None else pose)
    scene.add(pyrender.PerspectiveCamera(yfov=0.9))
    return scene, node


def middle(picture):
    return picture[SIZE[1] // 2, SIZE[0] // 2].astype(int).tolist()


# Segments.


def test_segments_of_primitives_and_of_poses_are_those_of_their_node(renderer):
    two = pyrender.Mesh.from_trimesh([square(0.6), square(1.0, z=-1)])
    posed = pyrender.Mesh.from_trimesh(square(0.6), poses=np.stack([at(-0.5, 0, 0), at(0.5, 0, -1)]))
    for mesh in (two, posed):
        scene, node = scene_of(mesh)
        segments, depth = renderer.render(scene, flags=RenderFlags.SEG, seg_node_map={node: (9, 8, 7)})
        assert np.unique(depth).tolist() == [0, 3, 4]
        assert (segments[depth > 0] == (9, 8, 7)).all() and (segments[depth == 0] == 0).all()


def test_segments_have_an_alpha_with_rgba(renderer):
    scene, node = scene_of(pyrender.Mesh.from_trimesh(square(0.6)))
    other = scene.add(pyrender.Mesh.from_trimesh(square(0.6)), pose=at(0, 0, 5))
    for shown in (node, other):  # The other one is behind the camera.
        segments, _ = renderer.render(scene, flags=RenderFlags.SEG | RenderFlags.RGBA, seg_node_map={shown: 9})
        assert segments.shape == (72, 96, 4) and (segments[..., 3] == 255).all()
    other.mesh.is_visible = False
    segments, _ = renderer.render(scene, flags=RenderFlags.SEG | RenderFlags.RGBA, seg_node_map={other: 9})
    assert segments.shape == (72, 96, 4) and (segments == (0, 0, 0, 255)).all()


@pytest.mark.parametrize("color", [300, -1, 0.5, np.nan, (0, 0, 256), (0.2, 0.4, 0.6), (1, 2), "red"])
def test_colors_of_segments_are_bytes(renderer, color):
    """pyrender divides them by 255: 300 would be clamped, 0.5 black."""
    scene, node = scene_of(pyrender.Mesh.from_trimesh(square(0.6)))
    other = scene.add(pyrender.Mesh.from_trimesh(square(0.6)), pose=at(0, 0, 5))  # Also of what is not seen.
    with pytest.raises(ValueError, match="seg_node_map: expected whole numbers from 0 to 255"):
        renderer.render(scene, flags=RenderFlags.SEG, seg_node_map={node: 1, other: color})


@pytest.mark.parametrize("color", [44, 44.0, (44, 44, 44), np.full(3, 44.0), [44, 44, 44, 255], np.uint8(44)])
def test_colors_of_segments_are_one_number_or_three(renderer, color):
    scene, node = scene_of(pyrender.Mesh.from_trimesh(square(0.6)))
    assert middle(renderer.render(scene, flags=RenderFlags.SEG, seg_node_map={node: color})[0]) == [44] * 3


# What is seen through.


@pytest.mark.parametrize("how", ["material", "colors", "texture"])
def test_depths_and_segments_are_of_transparent_meshes_too(renderer, how):
    pixels = np.full((4, 4, 4), (255, 0, 0, 80), np.uint8)
    primitive = {
        "material": lambda: pyrender.Primitive(CORNERS, indices=FACES, material=plain(alphaMode="BLEND", baseColorFactor=(1.0, 0.0, 0.0, 0.3))),
        "colors": lambda: pyrender.Primitive(CORNERS, indices=FACES, color_0=[1.0, 0.0, 0.0, 0.3], material=plain(alphaMode="BLEND")),
        "texture": lambda: pyrender.Primitive(CORNERS, indices=FACES, texcoord_0=UV, material=plain(alphaMode="BLEND", baseColorTexture=pixels)),
    }[how]()
    mesh = pyrender.Mesh([primitive])
    assert mesh.is_transparent
    scene, node = scene_of(mesh)
    scene.add(pyrender.Mesh.from_trimesh(square(), material=plain(baseColorFactor=(0.0, 1.0, 0.0))), pose=at(0, 0, -4))
    before, depth = renderer.render(scene)
    assert depth[36, 48] == 3
    assert min(middle(before)[:2]) > 100, "both colours are seen"
    segments, depth = renderer.render(scene, flags=RenderFlags.SEG, seg_node_map={node: 5})
    assert middle(segments) == [5, 5, 5] and depth[36, 48] == 3
    assert renderer.render(scene, flags=RenderFlags.DEPTH_ONLY)[36, 48] == 3
    np.testing.assert_array_equal(renderer.render(scene)[0], before)


@pytest.mark.parametrize("ground", [(1.0, 0.0, 0.0, 1.0), (0.2, 0.9, 0.5, 1.0), (1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.4)])
@pytest.mark.parametrize("is_flat", [False, True])
def test_colors_over_the_background_are_the_same_with_rgba(renderer, ground, is_flat):
    """Half of blue over red, blended linearly, is 188 of both; edges are blended, too."""
    material = plain(alphaMode="BLEND", baseColorFactor=(0.0, 0.0, 1.0, 0.5))
    scene, _ = scene_of(pyrender.Mesh([pyrender.Primitive(CORNERS[:3], indices=FACES[:1], material=material)]), bg_color=ground)
    flags = RenderFlags.FLAT if is_flat else RenderFlags.NONE
    rgb, rgba = renderer.render(scene, flags=flags)[0], renderer.render(scene, flags=flags | RenderFlags.RGBA)[0]
    # Colours that are kept beside their alpha are rounded before they are blended: by 1 / 255, more in what is dark and thin.
    tolerance = 0 if ground[3] == 1 else 3
    np.testing.assert_allclose(rgba[..., :3].astype(int), rgb.astype(int), atol=tolerance)
    alpha = 255 * (0.5 + 0.5 * ground[3])
    assert rgba[36, 50, 3] == pytest.approx(alpha, abs=1) and rgba[0, 0, 3] == round(255 * ground[3])
    if ground[:3] == (1, 0, 0):
        # Dielectrics reflect a few percent of the ambient light.
        np.testing.assert_allclose(middle(rgb)[::2], [188, 188], atol=3)


def test_colors_before_a_far_plane_are_those_without_one(renderer):
    material = plain(alphaMode="BLEND", baseColorFactor=(0.0, 0.0, 1.0, 0.5))
    scene, _ = scene_of(pyrender.Mesh.from_trimesh(square(), material=material), bg_color=(1.0, 0.0, 0.0))
    expected = middle(renderer.render(scene)[0])
    scene.add(pyrender.Mesh.from_trimesh(square(0.1)), pose=at(1.2, 0, -3.5))
    scene.main_camera_node.camera.zfar = 3.2
    np.testing.assert_allclose(middle(renderer.render(scene)[0]), expected, atol=2)


def test_what_is_transparent():
    blend = {"alphaMode": "BLEND"}
    faint = np.full((2, 2, 4), 100, np.uint8)
    cases = [
        (plain(), False), (plain(**blend), False), (plain(baseColorFactor=(1.0, 1.0, 1.0, 0.5)), False),
        (plain(baseColorFactor=(1.0, 1.0, 1.0, 0.5), **blend), True), (plain(baseColorTexture=faint, **blend), True),
        (plain(baseColorFactor=(1.0, 1.0, 1.0, 0.5), alphaMode="MASK", alphaCutoff=0.4), False),
    ]  # fmt: skip
    for material, expected in cases:
        assert pyrender.Mesh.from_trimesh(square(), material=material).is_transparent == expected
    assert not pyrender.Mesh.from_trimesh(square()).is_transparent


@pytest.mark.parametrize("cutoff, is_seen", [(0.3, True), (0.5, False)])
def test_masked_materials_are_cut_out_at_their_cutoff(renderer, cutoff, is_seen):
    material = plain(alphaMode="MASK", alphaCutoff=cutoff, baseColorFactor=(1.0, 1.0, 1.0, 0.4))
    scene, _ = scene_of(pyrender.Mesh.from_trimesh(square(), material=material))
    assert (renderer.render(scene)[1][36, 48] > 0) == is_seen


# Colours.


def test_whole_numbers_of_colors_are_0_to_255():
    scene = pyrender.Scene(bg_color=[255, 0, 51], ambient_light=np.array([51, 51, 51], np.uint8))
    np.testing.assert_allclose(scene.bg_color, [1, 0, 0.2, 1])
    np.testing.assert_allclose(scene.ambient_light, [0.2] * 3)
    np.testing.assert_allclose(pyrender.DirectionalLight(color=[1, 1, 1]).color, [1 / 255] * 3)
    np.testing.assert_allclose(pyrender.PointLight(color=0.5).color, [0.5] * 3)
    np.testing.assert_allclose(plain(baseColorFactor=[255, 0, 0, 51]).baseColorFactor, [1, 0, 0, 0.2])
    np.testing.assert_allclose(plain(baseColorFactor=[1.0, 0, 0]).baseColorFactor, [1, 0, 0, 1])


def test_a_script_with_whole_numbers_is_as_bright_as_in_pyrender(renderer):
    mesh = pyrender.Mesh.from_trimesh(square())
    scene, _ = scene_of(mesh, ambient_light=[0.1, 0.1, 0.3])
    scene.add(pyrender.DirectionalLight(color=[1, 1, 1], intensity=500.0))
    # pyrender's own picture: 121, 121, 137. Its highlights and its power of 2.2 in place of sRGB differ by a few.
    np.testing.assert_allclose(middle(renderer.render(scene)[0]), [121, 121, 137], atol=8)


@pytest.mark.parametrize("color", [[0.5, 0.25, 1.0], np.array([128, 64, 255], np.uint8)])
def test_vertex_colors_are_linear_factors(renderer, color):
    """0.5 and 0.25 linear are 188 and 137 in sRGB; a few are added by what dielectrics reflect of the ambient light."""
    primitive = pyrender.Primitive(CORNERS, indices=FACES, color_0=np.tile(color, (4, 1)), material=plain())
    scene, _ = scene_of(pyrender.Mesh([primitive]))
    np.testing.assert_allclose(middle(renderer.render(scene)[0]), [188, 137, 255], atol=8)


def test_flat_colors_are_shown_as_they_are(renderer):
    """Colours that are labels come back as they were given: pyrender does not encode them with FLAT."""
    mesh = square()
    mesh.visual.vertex_colors = np.tile([10, 128, 250, 255], (4, 1)).astype(np.uint8)
    scene, node = scene_of(pyrender.Mesh.from_trimesh(mesh))
    lit = middle(renderer.render(scene)[0])
    np.testing.assert_allclose(middle(renderer.render(scene, flags=RenderFlags.FLAT)[0]), [10, 128, 250], atol=1)
    assert middle(renderer.render(scene)[0]) == lit and lit[1] > 160
    scene.remove_node(node)
    scene.add(pyrender.Mesh.from_trimesh(square(), material=plain(baseColorFactor=(0.5, 0.25, 0.0))), pose=at(0, 0, -3))
    np.testing.assert_allclose(middle(renderer.render(scene, flags=RenderFlags.FLAT)[0]), [128, 64, 0], atol=1)


def test_colors_have_as_many_rows_as_positions():
    with pytest.raises(ValueError, match="color_0: expected 4 x 3 or 4 x 4, got 3 x 3"):
        pyrender.Primitive(CORNERS, color_0=np.zeros((3, 3)))
    assert pyrender.Primitive(CORNERS, color_0=[255, 0, 0]).color_0.tolist() == [[1, 0, 0, 1]] * 4


# Materials of trimesh.


def test_materials_of_trimesh_keep_what_they_have(renderer):
    image = pytest.importorskip("PIL.Image").fromarray(np.full((4, 4, 3), 255, np.uint8))
    given = trimesh.visual.material.PBRMaterial(
        emissiveFactor=[1.0, 0.5, 0.0], emissiveTexture=image, occlusionTexture=image, baseColorFactor=[0, 0, 0, 255],
        doubleSided=True, alphaMode="MASK", alphaCutoff=0.3, metallicFactor=0.3,
    )  # fmt: skip
    mesh = pyrender.Mesh.from_trimesh(square(material=given))
    made = mesh.primitives[0].material
    np.testing.assert_allclose(made.emissiveFactor, [1, 0.5, 0])
    assert made.emissiveTexture is not None and made.occlusionTexture is not None
    # pyrender draws all materials of trimesh with "BLEND".
    assert (made.doubleSided, made.alphaCutoff, made.alphaMode, made.metallicFactor) == (True, 0.3, "BLEND", 0.3)
    scene, _ = scene_of(mesh, ambient_light=[0.01] * 3)
    # 1 and 0.5 linear are 255 and 188 in sRGB.
    np.testing.assert_allclose(middle(renderer.render(scene)[0]), [255, 188, 0], atol=4)


def test_simple_materials_of_trimesh_have_the_roughness_of_their_highlight():
    made = pyrender.Mesh.from_trimesh(square(material=trimesh.visual.material.SimpleMaterial(diffuse=[204, 102, 51, 255], Ns=30.0)))
    material = made.primitives[0].material
    np.testing.assert_allclose(material.baseColorFactor, [0.8, 0.4, 0.2, 1])
    # Phong's exponent n and the perceptual roughness r: r^4 = 2 / (n + 2).
    assert material.roughnessFactor == pytest.approx((2 / 32) ** 0.25) and material.metallicFactor == 1


def test_a_given_material_is_copied_and_replaces_colors(renderer):
    material = plain(baseColorFactor=(1.0, 0.0, 0.0))
    mesh = square()
    mesh.visual.vertex_colors = np.tile([0, 255, 0, 255], (4, 1)).astype(np.uint8)
    made = pyrender.Mesh.from_trimesh([mesh, square()], material=material, wireframe=True)
    assert not material.wireframe and [p.material.wireframe for p in made.primitives] == [True, True]
    assert all(p.material is not material and p.color_0 is None for p in made.primitives)


def test_textures_are_exchanged(renderer):
    mesh = pyrender.Mesh.from_trimesh(square(image=None), material=plain())
    scene, _ = scene_of(mesh)
    material = mesh.primitives[0].material
    shown = lambda: middle(renderer.render(scene, flags=RenderFlags.FLAT)[0])  # noqa: E731
    material.baseColorTexture = np.full((2, 2, 3), (255, 0, 0), np.uint8)
    assert shown() == [255, 0, 0]
    material.baseColorTexture.source = np.full((2, 2, 3), (0, 0, 255), np.uint8)
    assert shown() == [0, 0, 255]
    material.baseColorTexture = None
    assert shown() == [255, 255, 255]
    with pytest.raises(ValueError, match="alphaMode: expected OPAQUE, MASK, BLEND, got 'blend'"):
        material.alphaMode = "blend"


@pytest.mark.parametrize("mode", ["L", "P", "RGBA", "LA", "1"])
def test_images_of_pillow_are_textures_whatever_their_mode(mode):
    pixels = np.zeros((2, 2, 3), np.uint8)
    pixels[0] = 255
    image = pytest.importorskip("PIL.Image").fromarray(pixels).convert(mode)
    found = pyrender.Texture(source=image, source_channels="RGB").pixels
    rows = found.reshape(2, 2, -1)[:, 0, 0]
    assert found.dtype == np.uint8 and rows.tolist() == [255, 0]


def test_metallic_and_roughness_in_two_channels(renderer):
    """Green and blue of glTF alone: roughness, metallic."""
    both = np.full((4, 4, 2), (128, 255), np.uint8)
    pictures = []
    for pixels in (both, np.dstack([np.zeros((4, 4), np.uint8), both])):
        material = pyrender.MetallicRoughnessMaterial(metallicRoughnessTexture=pixels)
        primitive = pyrender.Primitive(CORNERS, normals=np.tile([0.0, 0, 1], (4, 1)), indices=FACES, texcoord_0=UV, material=material)
        scene, _ = scene_of(pyrender.Mesh([primitive]))
        pictures.append(renderer.render(scene)[0])
    np.testing.assert_array_equal(*pictures)


# Lines, points and arrays.


def test_wireframes_are_lines_and_solid_in_depths_alone(renderer):
    mesh = pyrender.Mesh.from_trimesh(square(), wireframe=True)
    scene, node = scene_of(mesh)
    color, depth = renderer.render(scene)
    # The square is 72 / 2 / tan(0.45) / 3 = 24.8 pixels from the middle to its sides, and has a diagonal: 50 pixels by 5 lines.
    assert (depth[30:42, 44:47] == 0).sum() > 24 and (color[30, 40] == 0).all(), "nothing between the lines"
    assert (depth > 0).sum() == pytest.approx(5 * 50, abs=10) and depth.max() == pytest.approx(3)
    assert (color[depth > 0].max(axis=1) > 0).mean() > 0.9, "a pixel at an end may be missed"
    solid = renderer.render(scene, flags=RenderFlags.DEPTH_ONLY)
    assert (solid > 0).sum() == pytest.approx(50 * 50, abs=100)
    segments, depth = renderer.render(scene, flags=RenderFlags.SEG, seg_node_map={node: 3})
    np.testing.assert_array_equal(depth, solid)
    np.testing.assert_array_equal(segments[..., 0] == 3, solid > 0)
    np.testing.assert_array_equal(renderer.render(scene)[0], color)


def test_flags_of_wireframes(renderer):
    scene, node = scene_of(pyrender.Mesh.from_trimesh(square()))
    filled = lambda flags: (renderer.render(scene, flags=flags)[0].max(axis=2) > 0).mean() > 0.3  # noqa: E731
    material = node.mesh.primitives[0].material
    found = []
    for material.wireframe in (False, True):
        found.append([filled(flags) for flags in (0, RenderFlags.FLIP_WIREFRAME, RenderFlags.ALL_WIREFRAME)])
    assert found == [[True, False, False], [False, True, False]]


#: Mode and indices; pixels that pyrender 0.1.45 draws of it with SEG.
LINES = [(pyrender.GLTF.LINES, None, 52), (pyrender.GLTF.LINE_LOOP, [0, 1, 3, 2], 98), (pyrender.GLTF.LINE_STRIP, None, 78)]


@pytest.mark.parametrize("mode, indices, count", LINES)
@pytest.mark.parametrize("is_parallel", [False, True])
def test_lines_have_depths_and_segments(renderer, mode, indices, count, is_parallel):
    ends = np.array([[-0.5, -0.5, 0], [0.5, -0.4, 0], [-0.5, 0.5, 0.5], [0.5, 0.4, 0.0]])
    scene, node = scene_of(pyrender.Mesh([pyrender.Primitive(ends, mode=mode, indices=indices)]))
    if is_parallel:
        scene.main_camera_node.camera = pyrender.OrthographicCamera(1.0, 1.449)  # As high as the perspective one three metres away.
    segments, depth = renderer.render(scene, flags=RenderFlags.SEG, seg_node_map={node: 7})
    np.testing.assert_array_equal(segments[..., 0] == 7, depth > 0)
    # Places on edges of pixels fall on either side.
    assert (depth > 0).sum() == pytest.approx(count, abs=2 if not is_parallel else 6)
    assert np.isin(np.round(depth[depth > 0].min(), 2), [2.5, 2.51, 2.52]) and depth.max() == pytest.approx(3, abs=1e-5)
    color, again = renderer.render(scene)
    np.testing.assert_array_equal(again, depth)
    assert (color[depth > 0].max(axis=1) > 0).mean() > 0.9


def test_lines_behind_something_or_beyond_the_planes_are_hidden(renderer):
    line = pyrender.Mesh([pyrender.Primitive([[-0.5, 0, 0], [0.5, 0, 0]], mode=pyrender.GLTF.LINES)])
    scene, node = scene_of(line)
    wall = scene.add(pyrender.Mesh.from_trimesh(square(0.5)), pose=at(0, 0, -2))
    depth = renderer.render(scene, flags=RenderFlags.DEPTH_ONLY)
    # Half a metre at two metres hides 0.75 at three: a quarter of the line is left, 24.8 / 4 pixels.
    assert (depth == 3).sum() == pytest.approx(24.8 / 4, abs=2)
    scene.remove_node(wall)
    camera = scene.main_camera_node.camera
    camera.zfar = 2.9
    assert (renderer.render(scene, flags=RenderFlags.DEPTH_ONLY) == 0).all()
    camera.znear, camera.zfar = 2.9, 3.1
    assert (renderer.render(scene, flags=RenderFlags.DEPTH_ONLY) > 0).sum() == pytest.approx(24.8, abs=1)
    turned = at(0, 0, -3)
    turned[:3, :3] = [[0, 0, -1], [0, 1, 0], [1, 0, 0]]  # Along the axis, from 2.5 to 3.5 metres.
    scene.set_pose(node, turned @ at(0, 1, 0))
    depth = renderer.render(scene, flags=RenderFlags.DEPTH_ONLY)
    assert depth[depth > 0].min() >= 2.9 and depth.max() <= 3.1


def test_points_by_indices(renderer):
    points = np.array([[-0.5, 0, 0], [0, 0, 0], [0.5, 0, 0]])
    colors = np.eye(3)
    primitive = pyrender.Primitive(points, mode=pyrender.GLTF.POINTS, indices=[2], color_0=colors, material=plain())
    scene, node = scene_of(pyrender.Mesh([primitive]))
    renderer.point_size = 5.0
    color, depth = renderer.render(scene, flags=RenderFlags.FLAT)
    assert (depth[:, :53] == 0).all() and (depth[:, 53:] > 0).any()
    assert color[..., 2].max() > 200 and color[..., :2].max() == 0
    primitive.indices = [3]
    with pytest.raises(ValueError, match="expected indices from 0 to 2, got 3 to 3"):
        renderer.render(scene)


def test_points_without_a_place_are_left_out(renderer):
    points = np.array([[0.0, 0, 0], [np.nan, 0, 0], [0.5, np.inf, 0]])
    scene, _ = scene_of(pyrender.Mesh.from_points(points, colors=np.eye(3)))
    assert (renderer.render(scene)[1] > 0).sum() == 1


@pytest.mark.parametrize("mode, indices", [(4, np.zeros((0, 3), int)), (5, [0]), (1, np.zeros((0, 2), int))])
def test_primitives_without_elements_show_nothing(renderer, mode, indices):
    scene, _ = scene_of(pyrender.Mesh([pyrender.Primitive(np.zeros((3, 3)), mode=mode, indices=indices)]))
    color, depth = renderer.render(scene)
    assert (depth == 0).all() and (color == 0).all()


def test_lists_and_other_types_are_taken_as_arrays(renderer):
    mesh = pyrender.Mesh.from_trimesh(square(0.6))
    primitive = mesh.primitives[0]
    primitive.positions = (primitive.positions + (0, 0, 1)).tolist()
    primitive.indices = primitive.indices.astype(np.float32)
    primitive.texcoord_0 = np.column_stack([UV, np.zeros(4)]).tolist()
    primitive.poses = at(0.5, 0, 0)
    scene, _ = scene_of(mesh)
    assert np.unique(renderer.render(scene)[1]).tolist() == [0, 2]
    np.testing.assert_allclose(mesh.bounds, [[0.2, -0.3, 1], [0.8, 0.3, 1]], atol=1e-6)
    primitive.poses = np.zeros((0, 4, 4))
    assert (renderer.render(scene)[1] == 0).all() and (mesh.bounds == 0).all()
    with pytest.raises(TypeError, match="expected a Material, got a str"):
        primitive.material = "red"


# Scenes.


def test_scenes_are_copied_and_pickled(renderer):
    scene, node = scene_of(pyrender.Mesh.from_trimesh(square(0.6)))
    expected = renderer.render(scene)
    for other in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        found = renderer.render(other)
        np.testing.assert_array_equal(found[0], expected[0])
        np.testing.assert_array_equal(found[1], expected[1])


def test_the_matrix_of_a_node_is_a_copy():
    node = pyrender.Node(matrix=at(1, 2, 3))
    node.matrix[0, 3] = 7
    assert node.matrix[0, 3] == 1


def test_lights_by_kind():
    scene = pyrender.Scene()
    lights = [scene.add(kind()).light for kind in (pyrender.PointLight, pyrender.SpotLight, pyrender.DirectionalLight)]
    assert [scene.point_lights, scene.spot_lights, scene.directional_lights] == [{light} for light in lights]
