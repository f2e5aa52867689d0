"""Lenses, models, motion and sensors of data sets, read back as the formats' users read them."""

import io
import json
import pathlib
import tarfile

import numpy as np
import pytest
import trimesh
import yaml
from test_dataset import level, records, small
from test_ground_truth import brown, fisheye

import easypbr
from easypbr import ArgumentError, Mesh, shapes
from easypbr.dataset import (
    CameraSpec,
    DatasetSpec,
    LightSpec,
    MotionSpec,
    ObjectSpec,
    OcclusionSpec,
    PlacementSpec,
    SensorSpec,
    generate,
)
from easypbr.dataset.extents import diameter_of
from easypbr.dataset.frame import visible_corners
from easypbr.dataset.frames import FrameMaker
from easypbr.dataset.lamps import random_light
from easypbr.dataset.models import model_ply
from easypbr.dataset.report import draw_annotations
from easypbr.dataset.writers import encode_flow

LENSES = {
    "PINHOLE": ((), "brown_conrady"),
    "OPENCV": ((-0.2, 0.05, 0.001, -0.002), "brown_conrady"),
    "FULL_OPENCV": ((-0.2, 0.05, 0.001, -0.002, 0.01), "brown_conrady"),
    "OPENCV_FISHEYE": ((0.05, -0.01, 0.002, 0.001), "fisheye"),
}


def distorted(slopes, model, lens):
    if model == "OPENCV_FISHEYE":
        return fisheye(slopes, *lens)
    if len(lens) > 4:
        x, y = slopes.T
        r2 = (x * x + y * y)[:, None]
        return brown(slopes, *lens[:4]) + slopes * lens[4] * r2**3  # k3
    return brown(slopes, *lens) if len(lens) else slopes


@pytest.mark.parametrize("model", LENSES)
def test_lenses_are_in_the_formats_that_have_them(tmp_path, model):
    """The corners of the boxes, projected by what each format says of the camera, are where they are published."""
    lens, name = LENSES[model]
    spec = small(count=1, camera=CameraSpec(fov_y_deg=40.0, distortion=lens, distortion_model=name),
                 writers=("nerfstudio", "colmap", "bop"))
    generate(spec, tmp_path / "out", workers=1)
    (record,) = records(tmp_path / "out")
    corners = np.concatenate([entry["corners_cam"] for entry in record["objects"]])
    published = np.concatenate([entry["corners_px"] for entry in record["objects"]])
    slopes = corners[:, :2] / corners[:, 2:]

    fields = (tmp_path / "out/sparse/0/cameras.txt").read_text().splitlines()[1].split()
    assert fields[1:4] == [model, "96", "72"]
    fx, fy, cx, cy, *given = map(float, fields[4:])
    assert len(given) == {"PINHOLE": 0, "OPENCV": 4, "FULL_OPENCV": 8, "OPENCV_FISHEYE": 4}[model]
    pixels = distorted(slopes, model, given) * (fx, fy) + (cx, cy)
    # Pixel edges are at integers there; nine decimals are written.
    np.testing.assert_allclose(pixels - 0.5, published, atol=1e-5)

    nerf = json.loads((tmp_path / "out/transforms.json").read_text())
    assert nerf["camera_model"] == {"FULL_OPENCV": "OPENCV"}.get(model, model)
    order = ("k1", "k2", "k3", "k4") if name == "fisheye" else ("k1", "k2", "p1", "p2", "k3")
    frame = nerf["frames"][0]
    pixels = distorted(slopes, model, [nerf[key] for key in order if key in nerf])
    pixels = pixels * (frame["fl_x"], frame["fl_y"]) + (frame["cx"], frame["cy"])
    np.testing.assert_allclose(pixels - 0.5, published, atol=1e-9)

    camera = json.loads((tmp_path / "out/bop/000000/scene_camera.json").read_text())["0"]
    assert camera.get("cam_dist", []) == list(lens) and camera.get("cam_dist_model", name) == name


@pytest.mark.parametrize("writer, camera, message", [
    ("nerfstudio", {"distortion": (0.1, 0, 0, 0, 0, 0.1, 0, 0)}, "nerfstudio.*k3"),
    ("nerfstudio", {"K": ((80, 1, 48), (0, 80, 36), (0, 0, 1))}, "nerfstudio.*skew"),
    ("colmap", {"K": ((80, 1, 48), (0, 80, 36), (0, 0, 1))}, "colmap.*skew"),
    ("kitti", {"distortion": (0.1, 0, 0, 0)}, "kitti.*rectified"),
    ("flow", {}, "flow.*motion"),
])
def test_formats_refuse_what_they_cannot_say(tmp_path, writer, camera, message):
    with pytest.raises(ArgumentError, match=message):
        generate(level(writers=(writer,), camera=CameraSpec(elevation_deg=0.0, **camera)), tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("changes, message", [
    ({"camera": CameraSpec()}, r"camera.elevation_deg = 0 instead of \[-25, 35\]$"),
    ({"camera": CameraSpec(elevation_deg=10.0)}, "camera.elevation_deg = 0 instead of 10$"),
    ({"objects": [ObjectSpec(), ObjectSpec(tilt_deg=20.0)]}, r"expected objects\[1\].tilt_deg = 0 instead of 20$"),
    ({"objects": [ObjectSpec(rotation="any")]}, r'expected objects\[0\].rotation = "upright" instead of "any"$'),
    ({"camera": CameraSpec(elevation_deg=(0.0, 5.0)), "objects": [ObjectSpec(rotation="any", tilt_deg=-5.0)]},
     r"elevation_deg = 0 instead of \[0, 5\], objects\[0\].rotation = .*, objects\[0\].tilt_deg = 0 instead of -5$"),
])
def test_kitti_refuses_boxes_that_are_tilted_before_the_camera(tmp_path, changes, message):
    with pytest.raises(ArgumentError, match="kitti: its boxes turn only about the camera's y axis.*" + message):
        generate(level(**changes), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_kitti_takes_all_that_does_not_tilt_annotated_objects():
    """Of "none", tilt_deg tilts nothing; distractors have no labels; motion is that of the next frame."""
    objects = [ObjectSpec(rotation="none", tilt_deg=20.0), ObjectSpec("builtin:shapes", rotation="any", distractor=True)]
    level(objects=objects, camera=CameraSpec(elevation_deg=(0.0, 0.0)), motion=MotionSpec(0.1, 10.0, 0.1)).check()


def test_bop_poses_are_of_models_in_millimetres(tmp_path):
    """BOP's poses have no scale: the model of its keys, turned and moved, has the corners that are published."""
    shapes.box((2, 1, 0.5)).save(tmp_path / "box.ply")
    objects = [ObjectSpec(str(tmp_path / "box.ply"), "box", (2, 2), 0.5, "any"), ObjectSpec(class_name="drone")]
    generate(small(count=2, objects=objects, writers=("bop",)), tmp_path / "out", workers=1)
    base = tmp_path / "out/bop"
    truth, cameras = (json.loads((base / f"000000/{name}.json").read_text()) for name in ("scene_gt", "scene_camera"))
    for record in records(tmp_path / "out"):
        key = str(record["index"])
        K = np.array(cameras[key]["cam_K"]).reshape(3, 3)
        for pose, entry in zip(truth[key], record["objects"]):
            R, t, model = np.array(pose["cam_R_m2c"]).reshape(3, 3), pose["cam_t_m2c"], pose["model"]
            corners = [[model[f"min_{axis}"] + (i >> k & 1) * model[f"size_{axis}"] for k, axis in enumerate("xyz")] for i in range(8)]
            seen = corners @ R.T + t
            np.testing.assert_allclose(seen / 1000, entry["corners_cam"], atol=1e-6)
            pixels = seen @ K.T
            np.testing.assert_allclose(pixels[:, :2] / pixels[:, 2:], entry["corners_px"], atol=1e-3)
    # Boxes of 0.5 m are one model; drones, of which no two are alike, are none.
    models = json.loads((base / "models/models_info.json").read_text())
    assert list(models) == ["1"]
    sizes = [models["1"][f"size_{axis}"] for axis in "xyz"]
    np.testing.assert_allclose(sizes, [500, 250, 125], rtol=1e-5)
    np.testing.assert_allclose(models["1"]["diameter"], np.linalg.norm(sizes), rtol=1e-5)  # of a box its diagonal
    assert [path.name for path in sorted((base / "models").iterdir())] == ["models_info.json", "obj_000001.ply"]
    model = trimesh.load(base / "models/obj_000001.ply", process=False)  # another reader of PLY
    low = [models["1"][f"min_{axis}"] for axis in "xyz"]
    np.testing.assert_allclose(model.bounds, [low, np.add(low, sizes)], atol=1e-3)
    assert (base / "models/obj_000001.ply").read_bytes().startswith(b"ply\nformat ascii 1.0\n")
    box = shapes.box((2, 1, 0.5))
    np.testing.assert_array_equal(model.faces, box.F)
    np.testing.assert_allclose(model.vertex_normals, box.N, atol=1e-6)


def strict(text: str):
    """What JSON is: NaN and Infinity are none of its values."""
    def refuse(word):
        raise ValueError(f"{word} is no JSON")

    return json.loads(text, parse_constant=refuse)


def distance_to(start, end, points):
    """From points to the line between two others."""
    along = end - start
    t = np.clip((points - start) @ along / (along @ along), 0, 1)
    return np.linalg.norm(points - start - t[:, None] * along, axis=1)


def test_keypoints_say_what_is_seen(tmp_path):
    """Of a box that stands alone, a corner is hidden where none of its three faces is turned to the camera; one beyond the
    picture has no place. Pixels cannot tell it of a hidden corner that is within one of the outline."""
    shapes.box((2, 1, 0.5)).save(tmp_path / "box.ply")
    spec = small(count=8, objects=[ObjectSpec(str(tmp_path / "box.ply"), "box", size=(1.0, 2.0), rotation="any")], writers=("coco",))
    spec.placement.margin, spec.occlusion.max_truncation = 0.0, 0.9
    generate(spec, tmp_path / "out", workers=1)
    annotations = strict((tmp_path / "out/annotations.json").read_text())["annotations"]
    found = []
    for annotation, record in zip(annotations, records(tmp_path / "out"), strict=True):
        (entry,) = record["objects"]
        corners = np.array(entry["corners_cam"])
        sides = np.array([[i >> axis & 1 for axis in range(3)] for i in range(8)])
        turned_to = np.zeros((3, 2), bool)
        for axis in range(3):
            for side in (0, 1):
                middle = corners[sides[:, axis] == side].mean(0)
                turned_to[axis, side] = (middle - corners.mean(0)) @ middle < 0
        pixels = np.array(entry["corners_px"], float) + 0.5  # from the picture's corner
        inside = ((pixels >= 0) & (pixels < (96, 72))).all(1)
        seen = turned_to[np.arange(3), sides].any(1)
        keypoints = np.reshape(annotation["keypoints"], (8, 3))
        clear = np.full(8, True)
        for axis in range(3):  # Outlines are edges between a face that is turned to the camera and one that is not.
            for i in np.nonzero(sides[:, axis] == 0)[0]:
                others = [turned_to[k, sides[i, k]] for k in range(3) if k != axis]
                if others[0] != others[1]:
                    clear &= seen | (distance_to(pixels[i], pixels[i + (1 << axis)], pixels) > 1.5)
        np.testing.assert_array_equal(keypoints[clear, 2], np.where(inside, np.where(seen, 2, 1), 0)[clear])
        np.testing.assert_allclose(keypoints[:, :2], np.where(inside[:, None], pixels, 0), atol=0.00051)
        assert annotation["num_keypoints"] == inside.sum()
        found += keypoints[:, 2].tolist()
    assert min(found.count(flag) for flag in (0, 1, 2)) > 3


def test_corners_behind_what_the_picture_shows_are_hidden():
    depth = np.zeros((4, 5), np.float32)
    depth[:, :3] = 2  # a wall 2 m away on the left, nothing on the right
    corners_px = np.array([[0.5, 1.5], [0.5, 1.5], [2.5, 1.5], [4.2, 1], [4.6, 1], [-0.4, 3.4], [np.nan, np.nan], [1, 0]])
    z = [3, 2, 3, 9, 9, 1.9, -1, 2.5]
    visible = visible_corners(corners_px, np.c_[np.zeros((8, 2)), z], depth)
    assert visible == [False, True, True, True, False, True, False, False]


def test_numbers_that_are_none_are_null(tmp_path):
    """Boxes around the camera have corners behind it, which no pixel shows."""
    shapes.sphere().save(tmp_path / "ball.ply")
    spec = small(count=3, objects=[ObjectSpec(str(tmp_path / "ball.ply"), "ball", size=5.0)], writers=("coco", "webdataset", "bop", "yolo"))
    spec.placement.distance, spec.occlusion = (2.0, 2.4), OcclusionSpec(0.0, 1.0)
    generate(spec, tmp_path / "out", workers=1)
    texts = [path.read_text() for path in sorted((tmp_path / "out/records").iterdir())]
    with tarfile.open(tmp_path / "out/shards/000000.tar") as tar:
        samples = [tar.extractfile(f"{i:06d}.json").read().decode() for i in range(3)]
    for path in (tmp_path / "out").rglob("*.json"):
        strict(path.read_text())
    behind = 0
    for text, sample in zip(texts, samples, strict=True):
        assert strict(text) == strict(sample)
        (entry,) = strict(text)["objects"]
        for pixel, corner in zip(entry["corners_px"], entry["corners_cam"], strict=True):
            assert (pixel == [None, None]) == (corner[2] <= 0)
            behind += corner[2] <= 0
    assert 0 < behind < 24
    (record, *_) = records(tmp_path / "out")
    picture = np.zeros((72, 96, 3), np.uint8)
    assert draw_annotations(picture, record["objects"], edges=True).any()


def test_bop_models_of_several_nodes_have_normals_and_colours(tmp_path):
    """A pyramid without normals above another one, half as large: normals by hand, where four faces of equal angles meet."""
    V = np.array([[1, 0, 1], [1, 0, -1], [-1, 0, -1], [-1, 0, 1], [0, 1, 0]], float)
    F = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    root, child = Mesh(V, F), Mesh(V / 2 + (0, 3, 0), F)
    root.C = child.C = np.tile([1.0, 0.5, 0.0], (5, 1))
    root.add_child(child)
    root.save(tmp_path / "two.glb")
    model = trimesh.load(io.BytesIO(model_ply(str(tmp_path / "two.glb"), 0.7)), file_type="ply", process=False)
    assert len(model.faces) == 8
    np.testing.assert_allclose(model.extents, [400, 700, 400], rtol=1e-6)  # 2 x 3.5 x 2 shown 0.7 m high
    tops = model.vertices[:, 1] > model.vertices[:, 1].max() - 1e-3
    np.testing.assert_allclose(model.vertex_normals[tops], [[0, 1, 0]], atol=1e-6)
    np.testing.assert_array_equal(model.visual.vertex_colors[:, :3], np.tile([255, 128, 0], (len(model.vertices), 1)))


def test_diameters():
    points = np.random.default_rng(0).normal(size=(300, 3))
    distances = np.linalg.norm(points[:, None] - points[None], axis=-1)
    assert diameter_of(points) == pytest.approx(distances.max(), rel=1e-12)
    assert diameter_of(shapes.sphere(0.5, 32).V.astype(float)) == pytest.approx(1, abs=1e-6)
    assert diameter_of(np.zeros((3, 3))) == 0


def test_flow_files_lead_to_the_next_picture(tmp_path):
    """Read as KITTI's devkit reads them; a box of known motion is where they say."""
    shapes.box().save(tmp_path / "box.ply")
    spec = small(count=2, objects=[ObjectSpec(str(tmp_path / "box.ply"), "box", (2, 2), 0.8)], writers=("flow", "raw"),
                 motion=MotionSpec((0.05, 0.2), (2.0, 8.0), 0.05), occlusion=OcclusionSpec(0.3, 0.5))
    generate(spec, tmp_path / "out", workers=1)
    for i in range(2):
        folder = tmp_path / "out/kitti_flow"
        every, seen = (easypbr.load_image(folder / f"flow_{name}/{i:06d}_10.png") for name in ("occ", "noc"))
        raw = np.load(tmp_path / f"out/raw/{i:06d}.npz")
        valid = every[..., 2] == 1
        assert (valid == (raw["depth"] > 0)).all() and ((seen[..., 2] == 1) == (valid & ~raw["occlusion_forward"])).all()
        flow = (every[..., :2].astype(float) - 2**15) / 64
        # A step of the file is 1/64 pixel.
        np.testing.assert_allclose(flow[valid], raw["flow_forward"][valid], atol=0.5 / 64 + 1e-6)
        assert np.linalg.norm(flow[valid], axis=-1).max() > 0.5
        assert (easypbr.load_image(folder / f"image_2/{i:06d}_10.png") == easypbr.load_image(tmp_path / f"out/images/{i:06d}.png")).all()
        assert (easypbr.load_image(folder / f"image_2/{i:06d}_11.png") != easypbr.load_image(folder / f"image_2/{i:06d}_10.png")).any()


def test_flow_that_does_not_fit_is_not_valid():
    flow = np.array([[[1.5, -2], [511, 0], [512, 0], [0, -513], [np.nan, np.nan]]], np.float32)
    encoded = encode_flow(flow, np.array([[True, True, True, True, True]]))
    # KITTI's devkit: u = (R - 2^15) / 64.
    assert encoded.tolist() == [[[32864, 32640, 1], [65472, 32768, 1], [0, 0, 0], [0, 0, 0], [0, 0, 0]]]
    assert (encode_flow(flow, np.zeros((1, 5), bool)) == 0).all()


def test_exr_holds_what_npz_holds(tmp_path):
    generate(small(count=1, writers=("exr", "raw")), tmp_path / "out", workers=1)
    raw = np.load(tmp_path / "out/raw/000000.npz")
    for folder, name in (("depth", "depth"), ("normal", "normal_camera"), ("id", "instance_id")):
        picture = easypbr.load_image(tmp_path / f"out/exr/{folder}/000000.exr")
        assert picture.dtype == np.float32
        assert (picture.squeeze() == raw[name]).all()


def test_jpeg_loses_what_its_quality_says():
    """The same frame: quality 100 leaves it, 90 changes it a little, 20 more, and shows the 8 x 8 blocks."""
    spec = small()
    spec.sensor = SensorSpec()
    plain = FrameMaker(spec).make(0).picture.astype(float)
    errors = []
    for quality in (90.0, 20.0):
        spec.sensor = SensorSpec(jpeg_quality=quality)
        picture = FrameMaker(spec).make(0).picture
        assert picture.shape == plain.shape and picture.dtype == np.uint8
        errors.append(np.sqrt(np.mean((picture - plain) ** 2)))
    assert 0.1 < errors[0] < errors[1] / 1.5 < 20
    steps = np.abs(np.diff(picture.astype(float), axis=1)).mean((0, 2))
    assert steps[7::8].mean() > 1.1 * np.delete(steps, np.s_[7::8]).mean()


def test_lights_are_drawn_from_their_distribution():
    spec = small(objects=[ObjectSpec("builtin:shapes", "thing")])
    spec.background.mode, spec.background.intensity = "color", 0.0
    spec.lights = [LightSpec("directional", (2, 2), 3.0), LightSpec("point", (1, 1), (1.0, 2.0), distance=(4.0, 5.0), saturation=0.8)]
    maker = FrameMaker(spec)
    maker.make(0)
    lights = [maker._scene.light(name) for name in maker._scene.light_names()]
    assert [light.type for light in lights] == ["directional", "directional", "point"]
    for light in lights[:2]:
        assert light.intensity == pytest.approx(3)
        direction = np.array(light.direction) / np.linalg.norm(light.direction)
        assert np.sin(np.radians(15)) <= -direction[1] <= np.sin(np.radians(75))
    distance = np.linalg.norm(lights[2].position)
    assert 4 <= distance <= 5
    # Lux at the origin, of candela from there; the strongest channel is not weakened.
    assert 1 <= lights[2].intensity / distance**2 <= 2
    assert max(lights[2].color) == pytest.approx(1) and min(lights[2].color) < 0.95
    first = [tuple(light.direction) for light in lights[:2]]
    maker.make(1)
    maker.make(0)
    assert [tuple(maker._scene.light(name).direction) for name in maker._scene.light_names()][:2] == first


@pytest.mark.parametrize("kind", ("point", "rectangle", "disc", "sphere"))
def test_lamps_give_their_illuminance(kind):
    """The sum over points of a lamp gives the illuminance that was asked for where it aims. 1e-3: 400 x 400 midpoints."""
    given = LightSpec(kind, (1, 1), 2.0, azimuth_deg=30.0, elevation_deg=40.0, distance=1.5, size=1.6, saturation=0.0)
    light = random_light(given, np.random.default_rng(3))
    position = np.array(light.position)
    distance = np.linalg.norm(position)
    assert distance == pytest.approx(1.5)
    u, v = (axis.ravel() for axis in np.meshgrid(*[(np.arange(400) + 0.5) / 400] * 2))
    if kind == "point":
        assert light.intensity / distance**2 == pytest.approx(2)
        return
    if kind == "sphere":
        assert light.radius == pytest.approx(0.8)
        end = np.sqrt(1 - (0.8 / distance) ** 2)
        total = np.mean(1 - u * (1 - end)) * 2 * np.pi * (1 - end)
    else:
        np.testing.assert_allclose(np.array(light.direction) / np.linalg.norm(light.direction), -position / distance, atol=1e-6)
        if kind == "disc":
            assert light.radius == pytest.approx(0.8)
            squared, area = distance**2 + 0.64 * u, 0.64 * np.pi
        else:
            assert tuple(light.size) == pytest.approx((1.6, 1.6))
            squared, area = distance**2 + (1.6 * (u - 0.5)) ** 2 + (1.6 * (v - 0.5)) ** 2, 1.6**2
        total = np.mean(distance**2 / squared**2) * area
    assert light.intensity * total == pytest.approx(2, rel=1e-3)


@pytest.mark.parametrize("text, message", [
    ("[[lights]]\ntype = 'spot'\n[[objects]]", r"lights\[0\].type.*directional"),
    ("[[lights]]\ntype = 'disc'\nsize = 0\n[[objects]]", r"lights\[0\].size"),
    ("[sensor]\njpeg_quality = 0\n[[objects]]", "jpeg_quality.*1 to 100"),
    ("[motion]\nspin = 3", "no 'spin'.*translation"),
])
def test_bad_lights_motion_and_sensors(tmp_path, text, message):
    (tmp_path / "spec.toml").write_text(text)
    with pytest.raises(ArgumentError, match=message):
        DatasetSpec.from_toml(tmp_path / "spec.toml")


def test_calibrations_are_kittis(tmp_path):
    """By lines, as OpenPCDet reads them, and by names."""
    generate(level(count=1), tmp_path, workers=1)
    lines = (tmp_path / "kitti/calib/000000.txt").read_text().splitlines()
    assert [line.partition(":")[0] for line in lines] == ["P0", "P1", "P2", "P3", "R0_rect", "Tr_velo_to_cam", "Tr_imu_to_velo"]
    values = [np.array(line.strip().split(" ")[1:], np.float64) for line in lines]
    P, R, T = values[2].reshape(3, 4), values[4].reshape(3, 3), values[5].reshape(3, 4)
    np.testing.assert_allclose(P[:, :3], records(tmp_path)[0]["K"])
    ahead, left = P @ [*R @ T @ [10, 0, 0, 1], 1], P @ [*R @ T @ [10, 1, 0, 1], 1]
    np.testing.assert_allclose([*ahead[:2] / ahead[2], left[2]], [*P[:2, 2], 10])
    assert left[0] < ahead[0] and left[1] == ahead[1]
    picture = easypbr.load_image(tmp_path / "kitti/image_2/000000.png")
    np.testing.assert_array_equal(picture, easypbr.load_image(tmp_path / "images/000000.png"))


@pytest.mark.parametrize("distance, scale", [(20.0, 1), (80.0, 2)])
def test_bop_depths_reach_the_farthest_object(tmp_path, distance, scale):
    drone = ObjectSpec(class_name="drone", size=10.0)
    spec = small(count=1, objects=[drone], writers=("bop", "raw"), placement=PlacementSpec(distance=distance))
    generate(spec, tmp_path, workers=1)
    base = tmp_path / "bop/000000"
    camera, info = (json.loads((base / f"scene_{name}.json").read_text())["0"] for name in ("camera", "gt_info"))
    depth = easypbr.load_image(base / "depth/000000.png") * camera["depth_scale"] / 1000
    assert camera["depth_scale"] == scale
    np.testing.assert_allclose(depth, np.load(tmp_path / "raw/000000.npz")["depth"], atol=scale * 0.00051)
    assert np.count_nonzero(depth[easypbr.load_image(base / "mask/000000_000000.png") > 0]) == info[0]["px_count_valid"] > 10


def test_yolo_sets_are_found_from_any_folder(tmp_path):
    """Ultralytics takes the folder of the file where it has no path, and the current one for "."."""
    generate(small(count=1, writers=("yolo",)), tmp_path, workers=1)
    data = yaml.safe_load((tmp_path / "data.yaml").read_text())
    root = pathlib.Path(data.get("path") or (tmp_path / "data.yaml").parent)
    assert (root / data["train"] / "000000.png").exists() and (root / data["val"]).samefile(tmp_path / "images")
