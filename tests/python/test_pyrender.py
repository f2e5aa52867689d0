"""easypbr.compat.pyrender: an unchanged pyrender script, after one import line. Depths are compared with those that pyrender
0.1.45 itself measures (RenderFlags.SEG, whose depths are of the pixels' centres), and with geometry."""

import numpy as np
import pytest

import easypbr.compat.pyrender as pyrender

trimesh = pytest.importorskip("trimesh")

RED, GREY = (255, 0, 0), (7, 7, 7)
#: Per camera: depths at rows 22, 27, ... 52 and columns 14, 24, ... 74 of 80 x 60 pixels; pixels of the ball, of the box.
MEASURED = {
    "perspective": (
        [[0, 0, 0, 0, 0, 0, 0], [0, 0, 2.1733, 0, 0, 0, 0], [0, 2.1386, 2.0593, 2.2082, 2.55, 2.55, 0],
         [0, 2.0733, 2.0123, 2.1373, 2.55, 2.55, 0], [0, 2.0687, 2.0056, 2.135, 0, 0, 0],
         [0, 2.1299, 2.0428, 2.2202, 0, 0, 0], [0, 0, 2.1735, 0, 0, 0, 0]], 692, 196),
    "intrinsics": (
        [[0, 2.3659, 0, 0, 0, 0, 0], [0, 2.1082, 2.143, 2.55, 2.55, 0, 0], [2.2638, 2.0322, 2.0616, 2.55, 2.55, 0, 0],
         [2.2077, 2.0088, 2.0384, 2.55, 2.55, 0, 0], [0, 2.0296, 2.0619, 0, 0, 0, 0],
         [0, 2.1249, 2.1732, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0]], 687, 195),
    "far plane": (
        [[0, 0, 0, 0, 0, 0, 0], [0, 0, 2.1733, 0, 0, 0, 0], [0, 2.1386, 2.0593, 0, 0, 0, 0],
         [0, 2.0733, 2.0123, 2.1373, 0, 0, 0], [0, 2.0687, 2.0056, 2.135, 0, 0, 0],
         [0, 2.1299, 2.0428, 0, 0, 0, 0], [0, 0, 2.1736, 0, 0, 0, 0]], 539, 0),
    "aspect ratio": (
        [[0, 0, 0, 0, 0, 0, 0], [0, 2.2128, 2.1812, 2.4495, 0, 0, 0], [2.3393, 2.0768, 2.0646, 2.1735, 2.55, 2.55, 0],
         [2.1817, 2.0253, 2.0174, 2.1094, 2.55, 2.55, 0], [2.1827, 2.0201, 2.011, 2.1056, 0, 0, 0],
         [0, 2.0611, 2.0489, 2.1737, 0, 0, 0], [0, 2.2428, 2.1854, 0, 0, 0, 0]], 924, 255),
}  # fmt: skip
CAMERAS = {
    "perspective": pyrender.PerspectiveCamera(yfov=np.pi / 4),
    "intrinsics": pyrender.IntrinsicsCamera(75, 70, 35, 27.3),
    "far plane": pyrender.PerspectiveCamera(yfov=np.pi / 4, zfar=2.2),
    "aspect ratio": pyrender.PerspectiveCamera(yfov=np.pi / 4, aspectRatio=1.0),
}


def at(x, y, z):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


@pytest.fixture
def ball():
    return trimesh.creation.icosphere(subdivisions=3, radius=0.5)


@pytest.fixture
def box():
    made = trimesh.creation.box((0.6, 0.4, 0.5))
    made.apply_translation([0.8, 0.1, -0.3])
    return made


@pytest.fixture
def scene(ball, box):
    scene = pyrender.Scene(bg_color=[0.2, 0.4, 0.6, 1.0], ambient_light=[0.1, 0.1, 0.1])
    scene.add(pyrender.Mesh.from_trimesh(ball), name="ball")
    scene.add(pyrender.Mesh.from_trimesh(box, smooth=False), name="box")
    scene.add(pyrender.DirectionalLight(color=np.ones(3), intensity=3.0), pose=np.eye(4))
    return scene


@pytest.fixture
def renderer():
    renderer = pyrender.OffscreenRenderer(80, 60)
    yield renderer
    renderer.delete()


def node(scene, name):
    (found,) = scene.get_nodes(name=name)
    return found


@pytest.mark.parametrize("name", MEASURED)
def test_depths_and_segments_are_those_of_pyrender(scene, renderer, name):
    scene.add(CAMERAS[name], pose=at(0.2, 0.3, 2.5))
    colors = {node(scene, "ball"): RED, node(scene, "box"): GREY}
    segments, depth = renderer.render(scene, flags=pyrender.RenderFlags.SEG, seg_node_map=colors)
    expected, of_ball, of_box = MEASURED[name]
    assert segments.shape == (60, 80, 3) and segments.dtype == np.uint8 and depth.dtype == np.float32
    np.testing.assert_allclose(depth[22:56:5, 14:76:10], expected, atol=2e-4)
    # A pixel whose centre lies on an edge may fall on either side.
    assert abs((segments == RED).all(axis=2).sum() - of_ball) <= 2
    assert abs((segments == GREY).all(axis=2).sum() - of_box) <= 2
    assert (segments[depth == 0] == 0).all()


def test_orthographic_depths_are_metres(scene, renderer):
    scene.add(pyrender.OrthographicCamera(xmag=1.0, ymag=1.0), pose=at(0.8, 0.1, 2.5))
    depth = renderer.render(scene, flags=pyrender.RenderFlags.DEPTH_ONLY)
    # The box's front is at z = -0.3 + 0.25; 60 pixels are 2 metres: 0.6 x 0.4 metres are 18 x 12 pixels.
    front = np.abs(depth - 2.55) < 1e-5
    assert abs(front.sum() - 18 * 12) <= 24 and front[30, 40]


def test_colors_and_background(scene, renderer):
    scene.add(CAMERAS["perspective"], pose=at(0.2, 0.3, 2.5))
    color, depth = renderer.render(scene)
    assert color.shape == (60, 80, 3) and color.dtype == np.uint8
    assert tuple(color[0, 0]) == (51, 102, 153)
    # pyrender's own picture has 139 in the middle of the ball and 143 on the box.
    np.testing.assert_allclose(color[37, 34].astype(int), 139, atol=12)
    np.testing.assert_allclose(color[35, 58].astype(int), 143, atol=12)
    scene.bg_color = [0.2, 0.4, 0.6, 0.0]
    rgba, _ = renderer.render(scene, flags=pyrender.RenderFlags.RGBA)
    assert rgba.shape == (60, 80, 4)
    assert tuple(rgba[0, 0]) == (51, 102, 153, 0) and rgba[37, 34, 3] == 255
    only = renderer.render(scene, flags=pyrender.RenderFlags.DEPTH_ONLY)
    np.testing.assert_array_equal(only, depth)


def test_what_moves_is_drawn_where_it_is(scene, renderer):
    scene.add(CAMERAS["perspective"], pose=at(0.2, 0.3, 2.5))
    ball = node(scene, "ball")
    colors = {ball: RED}
    before, _ = renderer.render(scene, flags=pyrender.RenderFlags.SEG, seg_node_map=colors)
    scene.set_pose(ball, at(0.5, 0, 0))
    after, depth = renderer.render(scene, flags=pyrender.RenderFlags.SEG, seg_node_map=colors)
    columns = np.arange(80)
    middle = [np.average(columns, weights=(image[:, :, 0] > 0).sum(axis=0)) for image in (before, after)]
    # 0.5 metres at a distance of 2.5 are 0.5 / 2.5 * 30 / tan(22.5 deg) = 14.5 pixels.
    assert middle[1] - middle[0] == pytest.approx(14.5, abs=0.7)
    assert (depth[after[:, :, 0] == 0] == 0).all(), "what has no colour is not drawn"
    ball.mesh.is_visible = False
    assert (renderer.render(scene, flags=pyrender.RenderFlags.SEG, seg_node_map=colors)[1] == 0).all()
    scene.remove_node(ball)
    scene.remove_node(node(scene, "box"))
    color, depth = renderer.render(scene)
    assert (depth == 0).all() and (color == (51, 102, 153)).all()


def test_a_changed_material_and_new_arrays_are_seen(ball, renderer):
    mesh = pyrender.Mesh.from_trimesh(ball, material=pyrender.MetallicRoughnessMaterial(baseColorFactor=(1.0, 0.0, 0.0), metallicFactor=0.0))
    scene = pyrender.Scene(ambient_light=[1.0, 1.0, 1.0])
    scene.add(mesh)
    scene.add(CAMERAS["perspective"], pose=at(0, 0, 2.5))
    red = renderer.render(scene)[0][30, 40].astype(int)
    mesh.primitives[0].material.baseColorFactor = (0.0, 1.0, 0.0)
    green = renderer.render(scene)[0][30, 40].astype(int)
    assert red[0] > red[1] + 100 and green[1] > green[0] + 100
    mesh.primitives[0].positions = mesh.primitives[0].positions * 0.5
    assert renderer.render(scene)[1][30, 40] == pytest.approx(2.25, abs=0.01)


def test_ambient_light_alone_is_the_base_color(ball, renderer):
    """pyrender adds ambient light times base colour; 0.5 linear is 188 in sRGB (186 in its power of 2.2)."""
    material = pyrender.MetallicRoughnessMaterial(baseColorFactor=(0.5, 0.5, 0.5, 1), metallicFactor=0.0, roughnessFactor=1.0)
    scene = pyrender.Scene(ambient_light=[1.0, 1.0, 1.0])
    scene.add(pyrender.Mesh.from_trimesh(ball, material=material))
    scene.add(CAMERAS["perspective"], pose=at(0, 0, 2.5))
    np.testing.assert_allclose(renderer.render(scene)[0][30, 40].astype(int), 188, atol=10)


def test_a_scene_without_lights_is_lit(ball, renderer):
    scene = pyrender.Scene()
    scene.add(pyrender.Mesh.from_trimesh(ball))
    scene.add(CAMERAS["perspective"], pose=at(0, 0, 2.5))
    assert renderer.render(scene)[0][30, 40].min() > 40


def test_shadows_by_flags(ball, box):
    scene = pyrender.Scene()
    floor = trimesh.creation.box((4, 0.1, 4))
    floor.apply_translation([0, -0.6, 0])
    scene.add(pyrender.Mesh.from_trimesh(floor))
    scene.add(pyrender.Mesh.from_trimesh(ball))
    down = np.array([[1, 0, 0, 0], [0, 0, 1, 3], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=float)
    scene.add(pyrender.SpotLight(intensity=30.0, innerConeAngle=0.4, outerConeAngle=0.6), pose=down)
    above = np.array([[1, 0, 0, 0], [0, 0.6, 0.8, 2.4], [0, -0.8, 0.6, 2.2], [0, 0, 0, 1]], dtype=float)
    scene.add(pyrender.PerspectiveCamera(yfov=1.0), pose=above)
    renderer = pyrender.OffscreenRenderer(80, 60)
    plain = renderer.render(scene)[0].astype(int)
    dark = renderer.render(scene, flags=pyrender.RenderFlags.SHADOWS_SPOT)[0].astype(int)
    np.testing.assert_array_equal(renderer.render(scene, flags=pyrender.RenderFlags.SHADOWS_POINT)[0], plain.astype(np.uint8))
    assert ((plain - dark).max(axis=2) > 40).sum() > 50


def test_point_clouds_have_their_colors(renderer):
    points = np.array([[-0.5, 0, 0], [0.5, 0, 0]])
    scene = pyrender.Scene(bg_color=[0, 0, 0])
    scene.add(pyrender.Mesh.from_points(points, colors=np.array([[255, 0, 0], [0, 255, 0]], dtype=np.uint8)))
    scene.add(CAMERAS["perspective"], pose=at(0, 0, 2.5))
    renderer.point_size = 5.0
    color, depth = renderer.render(scene)
    assert (depth > 0).sum() in range(20, 60) and np.allclose(depth[depth > 0], 2.5)
    left, right = color[30, :40].max(axis=0), color[30, 40:].max(axis=0)
    assert left[0] > 200 and left[1] < 10 and right[1] > 200 and right[0] < 10


def test_poses_draw_a_mesh_several_times(ball, renderer):
    poses = np.array([at(-0.6, 0, 0), at(0.6, 0, 0)])
    scene = pyrender.Scene()
    scene.add(pyrender.Mesh.from_trimesh(ball, poses=poses))
    scene.add(CAMERAS["perspective"], pose=at(0, 0, 2.5))
    depth = renderer.render(scene, flags=pyrender.RenderFlags.DEPTH_ONLY)
    assert depth[30, 20] > 0 and depth[30, 59] > 0 and depth[30, 40] == 0


def test_back_faces_are_culled_unless_asked_for(renderer):
    V, F = np.array([[-1.0, -1, 0], [1, -1, 0], [0, 1, 0]]), np.array([[0, 2, 1]])
    scene = pyrender.Scene()
    mesh = pyrender.Mesh([pyrender.Primitive(V, indices=F)])
    scene.add(mesh)
    scene.add(CAMERAS["perspective"], pose=at(0, 0, 2.5))
    depth = lambda flags: renderer.render(scene, flags=flags | pyrender.RenderFlags.DEPTH_ONLY)  # noqa: E731
    assert (depth(0) == 0).all()
    assert (depth(pyrender.RenderFlags.SKIP_CULL_FACES) > 0).any()
    mesh.primitives[0].material.doubleSided = True
    assert (depth(0) > 0).any()


@pytest.mark.parametrize("mode, indices, kind, expected", [
    (pyrender.GLTF.TRIANGLES, None, "F", [[0, 1, 2], [3, 4, 5]]),
    (pyrender.GLTF.TRIANGLE_STRIP, [0, 1, 2, 3], "F", [[0, 1, 2], [2, 1, 3]]),
    (pyrender.GLTF.TRIANGLE_FAN, [0, 1, 2, 3], "F", [[0, 1, 2], [0, 2, 3]]),
    (pyrender.GLTF.LINES, None, "E", [[0, 1], [2, 3], [4, 5]]),
    (pyrender.GLTF.LINE_LOOP, [0, 1, 2], "E", [[0, 1], [1, 2], [2, 0]]),
    (pyrender.GLTF.LINE_STRIP, [0, 1, 2], "E", [[0, 1], [1, 2]]),
])  # fmt: skip
def test_modes_of_primitives(mode, indices, kind, expected):
    found, elements = pyrender.Primitive(np.zeros((6, 3)), indices=indices, mode=mode).elements()
    assert found == kind
    np.testing.assert_array_equal(elements, expected)


# Scenes and nodes.


def test_nodes_and_poses(ball):
    scene = pyrender.Scene()
    arm = pyrender.Node(name="arm", translation=[1, 0, 0], rotation=[0, 0, np.sin(np.pi / 4), np.cos(np.pi / 4)], scale=2)
    scene.add_node(arm)
    hand = scene.add(pyrender.Mesh.from_trimesh(ball), name="hand", pose=at(1, 0, 0), parent_name="arm")
    # A quarter turn about z and a scale of 2 bring (1, 0, 0) to (0, 2, 0).
    np.testing.assert_allclose(scene.get_pose(hand)[:3, 3], [1, 2, 0], atol=1e-12)
    np.testing.assert_allclose(pyrender.Node(matrix=arm.matrix).rotation, arm.rotation, atol=1e-12)
    np.testing.assert_allclose(scene.bounds, [[0, 1, -1], [2, 3, 1]], atol=1e-2)
    assert scene.mesh_nodes == {hand} and scene.nodes == {arm, hand}
    assert scene.get_nodes(name="hand") == {hand} and scene.get_nodes(obj=hand.mesh) == {hand}
    scene.remove_node(arm)
    assert not scene.nodes
    for wrong in (lambda: scene.get_pose(hand), lambda: scene.remove_node(hand), lambda: scene.set_pose(hand, np.eye(4))):
        with pytest.raises(ValueError, match="not in the scene"):
            wrong()
    with pytest.raises(TypeError, match="expected a Mesh, a Light or a Camera, got a int"):
        scene.add(3)


def test_scenes_of_trimesh(ball, renderer):
    given = trimesh.Scene()
    given.add_geometry(ball, node_name="moved", transform=at(0.5, 0, 0))
    scene = pyrender.Scene.from_trimesh_scene(given)
    np.testing.assert_array_equal(scene.get_pose(node(scene, "moved")), at(0.5, 0, 0))


def test_mistakes_are_told(scene, renderer, ball):
    with pytest.raises(ValueError, match="the scene has no camera"):
        renderer.render(scene)
    scene.add(CAMERAS["perspective"], pose=at(0, 0, 2.5))
    with pytest.raises(ValueError, match="needs seg_node_map"):
        renderer.render(scene, flags=pyrender.RenderFlags.SEG)
    with pytest.raises(ValueError, match="from_trimesh: expected a trimesh.Trimesh"):
        pyrender.Mesh.from_trimesh(3)
    with pytest.raises(ValueError, match="expected a quaternion of length 1"):
        pyrender.Node(rotation=[1, 1, 1, 1])
    with pytest.raises(ValueError, match="expected 4 x 4"):
        pyrender.Node(matrix=np.eye(3))


def test_the_names_that_scripts_use_are_there():
    names = """Camera PerspectiveCamera OrthographicCamera IntrinsicsCamera Light PointLight DirectionalLight SpotLight Sampler Texture
        Material MetallicRoughnessMaterial Primitive Mesh Node Scene Viewer OffscreenRenderer RenderFlags GLTF constants""".split()
    assert [name for name in names if not hasattr(pyrender, name)] == []
    assert pyrender.constants.RenderFlags.SHADOWS_ALL == 224


def test_light_comes_straight_from_the_lamps(renderer):
    """As in pyrender: a floor is as bright beside a wall as without it."""
    floor = trimesh.Trimesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    wall = trimesh.Trimesh([[-1, -1, 0], [-1, 1, 0], [-1, 1, 1], [-1, -1, 1]], [[0, 1, 2], [0, 2, 3]])
    scene = pyrender.Scene()
    scene.add(pyrender.Mesh.from_trimesh(floor, smooth=False))
    scene.add(pyrender.DirectionalLight(intensity=3.0), pose=np.eye(4))
    scene.add(pyrender.DirectionalLight(intensity=3.0), pose=np.array([[0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]]))
    scene.add(pyrender.PerspectiveCamera(yfov=0.2), pose=at(-0.8, 0, 2))
    alone, _ = renderer.render(scene)
    scene.add(pyrender.Mesh.from_trimesh(wall, smooth=False))
    beside, _ = renderer.render(scene)
    assert np.array_equal(alone[20:40, 30:50], beside[20:40, 30:50])
    assert alone[30, 40].min() > 50
