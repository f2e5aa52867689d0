"""Optical flow against motion that is known: by the camera's matrices, there and back, and by the pictures themselves."""

import numpy as np
import pytest

from easypbr import Camera, Scene, Viewer, shapes

K = np.array([[210, 0, 79.5], [0, 210, 59.5], [0, 0, 1.0]])
SIZE = (160, 120)


def pose(x, y, z, turn_deg=0.0):
    c, s = np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))
    return np.array([[c, 0, s, x], [0, 1, 0, y], [-s, 0, c, z], [0, 0, 0, 1]])


T_WORLD_CAM = np.diag([1, -1, -1, 1.0])
NEXT_CAM = T_WORLD_CAM.copy()
NEXT_CAM[:3, 3] = 0.02, -0.01, 0.03
NOW = {"ball": pose(-0.4, 0.2, -3), "cube": pose(0.45, -0.1, -3.5, 20)}
NEXT = {"ball": pose(-0.3, 0.25, -2.9, 5), "cube": pose(0.4, -0.1, -3.6, 28)}


@pytest.fixture(scope="module")
def frames():
    """Now with flow to the next frame, the next with flow back to now."""
    scene = Scene()
    scene.show(shapes.sphere(0.5), "ball")
    scene.show(shapes.box((0.8, 0.8, 0.8)), "cube")
    view = Viewer(SIZE, scene=scene)

    def put(poses, T_world_cam):
        for name, T in poses.items():
            scene.get(name).T_parent_mesh = T
        view.camera = Camera.from_opencv(K, T_world_cam, SIZE)

    put(NEXT, NEXT_CAM)
    next_moment = view.moment()
    put(NOW, T_WORLD_CAM)
    now_moment = view.moment()
    layers = ["position", "instance_id", "depth"]
    now = view.render_layers([*layers, "flow_forward", "occlusion_forward"], next=next_moment)
    put(NEXT, NEXT_CAM)
    after = view.render_layers([*layers, "flow_backward", "occlusion_backward"], previous=now_moment)
    return now, after


def projected(points, T_world_cam):
    seen = (points - T_world_cam[:3, 3]) @ T_world_cam[:3, :3]
    pixels = seen @ K.T
    return pixels[:, :2] / pixels[:, 2:]


@pytest.mark.parametrize("number, name", [(1, "ball"), (2, "cube")])
def test_flow_is_the_motion_of_the_points(frames, number, name):
    """Each pixel's point, moved as its object and seen by the moved camera, is where the flow leads: points are float32, of
    3 m, seen at 210 px / 3 m, so that 0.001 px is what rounding leaves."""
    now, after = frames
    for data, layer, here, there, camera in ((now, "flow_forward", NOW, NEXT, NEXT_CAM), (after, "flow_backward", NEXT, NOW, T_WORLD_CAM)):
        y, x = np.nonzero(data["instance_id"] == number)
        T = there[name] @ np.linalg.inv(here[name])
        points = data["position"][y, x] @ T[:3, :3].T + T[:3, 3]
        expected = projected(points, camera) - np.stack([x, y], -1)
        assert np.abs(expected).max() > 2
        np.testing.assert_allclose(data[layer][y, x], expected, atol=1e-3)


def test_flow_warps_the_next_frame_onto_this_one(frames):
    """At the place where a pixel's point goes, the next frame sees that very point: the four pixels around it, interpolated,
    lead back to within half a pixel, which is what the issue asks for (they do to a hundredth, but where faces meet)."""
    now, after = frames
    sure = (now["instance_id"] > 0) & ~now["occlusion_forward"]
    y, x = np.nonzero(sure)
    there = np.stack([x, y], -1) + now["flow_forward"][y, x].astype(float)
    x0, y0 = np.floor(there).astype(int).T
    inside = (x0 >= 0) & (y0 >= 0) & (x0 < SIZE[0] - 1) & (y0 < SIZE[1] - 1)
    x, y, x0, y0, there = x[inside], y[inside], x0[inside], y0[inside], there[inside]
    around = [(y0 + v, x0 + u) for v in (0, 1) for u in (0, 1)]
    same = np.all([after["instance_id"][place] == now["instance_id"][y, x] for place in around], axis=0)
    assert same.sum() > 0.85 * sure.sum()
    u, v = (there - np.stack([x0, y0], -1))[same].T
    weights = [(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v]
    back = sum(w[:, None] * after["flow_backward"][py[same], px[same]] for w, (py, px) in zip(weights, around))
    error = np.linalg.norm(there[same] + back - np.stack([x, y], -1)[same], axis=1)
    assert error.max() < 0.5 and np.median(error) < 0.01


def test_what_the_other_frame_does_not_show_is_occluded(frames):
    """A pixel is marked exactly when no pixel beside its place shows its object at its depth; most are seen."""
    now, _ = frames
    covered = now["instance_id"] > 0
    assert not now["occlusion_forward"][~covered].any() and (now["flow_forward"][~covered] == 0).all()
    assert 0 < (now["occlusion_forward"] & covered).sum() < 0.15 * covered.sum()


@pytest.mark.parametrize("ground", ["none", "plane"])
def test_background_holds_nothing_while_the_camera_moves(ground):
    """As the page says: 0 in each layer, -1 of faces, and depth and ids agree on what is background."""
    view = Viewer(SIZE, {"ground.mode": ground, "path.enabled": False}, scene=Scene())
    view.scene.show(shapes.sphere(0.5), "ball")
    view.camera = Camera.from_opencv(K, pose(0, 0, 3) @ T_WORLD_CAM, SIZE)
    other = view.moment()
    view.camera = Camera.from_opencv(K, pose(0.1, 0, 3) @ T_WORLD_CAM, SIZE)
    names = ["depth", "distance", "position", "normal_world", "normal_camera", "albedo", "roughness", "metallic", "instance_id",
             "semantic_id", "object_coordinates", "barycentrics", "uv", "flow_forward", "flow_backward", "occlusion_forward",
             "occlusion_backward", "face_id"]
    data = view.render_layers(names, previous=other, next=other)
    background = data["instance_id"] == 0
    assert 0 < background.sum() < background.size and ((data["depth"] == 0) == background).all()
    for name in names:
        assert (data[name][background] == (-1 if name == "face_id" else 0)).all(), name
    # The ball itself moves against the camera, by 210 px / 3 m * 0.1 m and more where it is nearer.
    assert (np.abs(data["flow_forward"][~background][:, 0]) > 6).all()


def test_more_instances_than_16_bits_count():
    """A wall of small squares, each an object: ids go on beyond 65,535, and each is where its square is."""
    side, columns = 0.01, 257
    scene = Scene()
    square = shapes.plane(side * 0.9)
    count = columns * columns  # 66,049
    for i in range(count):
        tile = square.clone()
        # The plane lies in x and z: turned upright, facing the camera.
        tile.T_parent_mesh = [[1, 0, 0, (i % columns - columns // 2) * side], [0, 0, -1, (columns // 2 - i // columns) * side],
                              [0, 1, 0, -1], [0, 0, 0, 1]]
        scene.show(tile, f"{i:05d}")
    view = Viewer((columns, columns), scene=scene)
    # A pixel for each square: pixels are 0.01 m wide at 1 m.
    camera = np.array([[100, 0, columns // 2], [0, 100, columns // 2], [0, 0, 1.0]])
    view.camera = Camera.from_opencv(camera, T_WORLD_CAM, (columns, columns))
    view.settings.shadows.enabled = False
    ids = view.render_layers(["instance_id"])["instance_id"]
    assert (ids == np.arange(1, count + 1).reshape(columns, columns)).all()
