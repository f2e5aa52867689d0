"""Generated data sets: the same bytes however they are made, formats that agree with the layers they come from."""

import hashlib
import json
import signal
import subprocess
import sys
import tarfile
import time
from pathlib import Path

import numpy as np
import pytest

import easypbr
from easypbr import ArgumentError, FileError, shapes
from easypbr.dataset import (
    CameraSpec,
    DatasetSpec,
    ImageSpec,
    ObjectSpec,
    OcclusionSpec,
    PlacementSpec,
    SensorSpec,
    generate,
)
from easypbr.dataset.frames import FrameMaker
from easypbr.dataset.writers import decode_rle, quaternion

ALL = ("coco", "yolo", "bop", "nerfstudio", "colmap", "webdataset", "raw", "exr", "png")


def small(**changes) -> DatasetSpec:
    spec = DatasetSpec.demo()
    spec.count, spec.image = 3, ImageSpec((96, 72), 1)
    spec.background.skies = 1
    spec.writers = ALL
    for name, value in changes.items():
        setattr(spec, name, value)
    return spec


def level(**changes) -> DatasetSpec:
    """What KITTI's boxes can say: upright objects before a level camera."""
    spec = small(camera=CameraSpec(elevation_deg=0.0), objects=[ObjectSpec(class_name="drone", count=(1, 3))], writers=("kitti", "raw"))
    for name, value in changes.items():
        setattr(spec, name, value)
    return spec


def hashes(folder) -> dict[str, str]:
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made") / "set"
    generate(small(), folder, workers=1)
    return folder


def records(folder):
    return [json.loads(path.read_text()) for path in sorted((folder / "records").iterdir())]


def test_frames_follow_from_their_number_alone(made, tmp_path):
    """Workers that draw other frames before, in other processes, give the same bytes."""
    generate(small(), tmp_path / "again", workers=2)
    assert hashes(tmp_path / "again") == hashes(made)
    other = FrameMaker(small(seed=1)).make(0)
    assert not np.array_equal(other.picture, easypbr.load_image(made / "images/000000.png"))


def test_killed_and_started_again_ends_the_same(made, tmp_path):
    folder = tmp_path / "killed"
    script = tmp_path / "job.py"
    script.write_text(
        "import sys\nsys.path.insert(0, sys.argv[2])\nfrom test_dataset import small, generate\n"
        "if __name__ == '__main__':\n    generate(small(), sys.argv[1], workers=1)\n"
    )
    job = [sys.executable, script, folder, str(__import__("pathlib").Path(__file__).parent)]
    for wanted in (1, 2):
        process = subprocess.Popen(job)
        while process.poll() is None and len(list(folder.glob("records/*.json"))) < wanted:
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
        for record in records(folder):  # What counts is complete.
            assert (folder / f"images/{record['index']:06d}.png").exists()
    assert len(records(folder)) < 4
    generate(small(), folder, workers=1)
    assert hashes(folder) == hashes(made)


def test_coco(made):
    data = json.loads((made / "annotations.json").read_text())
    assert [image["file_name"] for image in data["images"]] == [f"images/{i:06d}.png" for i in range(3)]
    assert data["categories"][0]["name"] == "drone"
    total = sum(entry["pixels"] > 0 for record in records(made) for entry in record["objects"])
    assert len(data["annotations"]) == total > 2
    for annotation in data["annotations"]:
        ids = np.load(made / f"raw/{annotation['image_id']:06d}.npz")["instance_id"]
        mask = decode_rle(annotation["segmentation"])
        assert mask.sum() == annotation["area"]
        rows, columns = np.nonzero(mask)
        x, y, w, h = annotation["bbox"]
        assert (x, y, w, h) == (columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1)
        assert len(np.unique(ids[mask])) == 1 and len(annotation["keypoints"]) == 24


def test_yolo_and_raw_agree(made):
    for record in records(made):
        name = f"{record['index']:06d}"
        lines = (made / f"labels/{name}.txt").read_text().splitlines()
        seen = [entry for entry in record["objects"] if entry["box"][2] > 0]
        assert len(lines) == len(seen)
        for line, entry in zip(lines, seen):
            number, cx, cy, w, h = map(float, line.split())
            x, y, width, height = entry["box"]
            # Six decimals of parts of 96 and 72 pixels.
            np.testing.assert_allclose([cx * 96, cy * 72, w * 96, h * 72], [x + width / 2, y + height / 2, width, height], atol=1e-4)
        raw = np.load(made / f"raw/{name}.npz")
        assert (easypbr.load_image(made / f"ids/{name}.png") == raw["instance_id"]).all()
        assert ((raw["depth"] > 0) == (raw["instance_id"] > 0)).all()


def kitti_corners(fields: list[str]) -> np.ndarray:
    """The eight corners of a label's box, as KITTI's devkit computes them (computeBox3D)."""
    height, width, length, x, y, z, turn = map(float, fields[8:15])
    along = np.array([1, 1, -1, -1] * 2) * length / 2
    across = np.array([1, -1, -1, 1] * 2) * width / 2
    down = np.repeat([0, -height], 4)
    c, s = np.cos(turn), np.sin(turn)
    return np.stack([c * along + s * across + x, down + y, c * across - s * along + z], axis=1)


def test_kitti(tmp_path):
    generate(level(), tmp_path / "set", workers=2)
    generate(level(), tmp_path / "again", workers=1)
    assert hashes(tmp_path / "set") == hashes(tmp_path / "again")
    for record in records(tmp_path / "set"):
        name = f"{record['index']:06d}"
        lines = (tmp_path / f"set/kitti/label_2/{name}.txt").read_text().splitlines()
        seen = [entry for entry in record["objects"] if entry["box"][2] > 0]
        calib = [line.split(": ") for line in (tmp_path / f"set/kitti/calib/{name}.txt").read_text().splitlines()]
        P = np.array(dict(calib)["P2"].split(), float).reshape(3, 4)
        assert len(lines) == len(seen) > 0
        for line, entry in zip(lines, seen):
            fields = line.split()
            assert len(fields) == 15 and fields[0] == "drone"
            corners = kitti_corners(fields)
            distances = np.linalg.norm(corners[:, None] - entry["corners_cam"], axis=2)
            # Three decimals: half a millimetre of each of three coordinates and sizes, half a milliradian of up to 0.85 m.
            assert distances.min(0).max() < 2.5e-3 and distances.min(1).max() < 2.5e-3
            pixels = np.c_[corners, np.ones(8)] @ P.T
            pixels = pixels[:, :2] / pixels[:, 2:]
            np.testing.assert_allclose(pixels.min(0), np.min(entry["corners_px"], 0), atol=0.2)
            np.testing.assert_allclose(pixels.max(0), np.max(entry["corners_px"], 0), atol=0.2)
        raw = np.load(tmp_path / f"set/raw/{name}.npz")
        depth = easypbr.load_image(tmp_path / f"set/kitti/depth/{name}.png")
        assert depth.dtype == np.uint16
        np.testing.assert_allclose(depth / 256, raw["depth"], atol=1 / 256)


def test_bop(made):
    base = made / "bop/000000"
    truth, info = (json.loads((base / f"{name}.json").read_text()) for name in ("scene_gt", "scene_gt_info"))
    camera = json.loads((base / "scene_camera.json").read_text())
    for record in records(made):
        key, name = str(record["index"]), f"{record['index']:06d}"
        raw = np.load(made / f"raw/{name}.npz")
        depth = easypbr.load_image(base / f"depth/{name}.png") * camera[key]["depth_scale"] / 1000
        np.testing.assert_allclose(depth, raw["depth"], atol=0.00051)
        for i, (pose, numbers, entry) in enumerate(zip(truth[key], info[key], record["objects"])):
            R = np.array(pose["cam_R_m2c"]).reshape(3, 3)
            np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-9)
            visible = easypbr.load_image(base / f"mask_visib/{name}_{i:06d}.png") > 0
            whole = easypbr.load_image(base / f"mask/{name}_{i:06d}.png") > 0
            assert visible.sum() == numbers["px_count_visib"] and not (visible & ~whole).any()
            assert (visible == (raw["instance_id"] == i + 1)).all()
            # BOP's boxes end at their last pixel.
            assert numbers["bbox_visib"][2] == entry["box"][2] - 1


def test_cameras_for_nerfstudio_and_colmap(made):
    frames = json.loads((made / "transforms.json").read_text())["frames"]
    images = [line.split() for line in (made / "sparse/0/images.txt").read_text().splitlines() if line and line[0] != "#"]
    for record, frame, image in zip(records(made), frames, images):
        T = np.array(record["T_world_cam"])
        np.testing.assert_allclose(np.array(frame["transform_matrix"]) @ np.diag([1, -1, -1, 1]), T)
        w, x, y, z = map(float, image[1:5])
        R = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                      [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                      [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
        T_cam_world = np.linalg.inv(T)
        np.testing.assert_allclose(R, T_cam_world[:3, :3], atol=1e-7)
        np.testing.assert_allclose(list(map(float, image[5:8])), T_cam_world[:3, 3], atol=1e-7)
        assert frame["cx"] == record["K"][0][2] + 0.5
    np.testing.assert_allclose(quaternion(np.diag([1.0, -1, -1])), [0, 1, 0, 0], atol=1e-12)


def test_webdataset(made):
    with tarfile.open(made / "shards/000000.tar") as tar:
        assert tar.getnames() == [f"{i:06d}.{extension}" for i in range(3) for extension in ("png", "json")]
        assert tar.extractfile("000001.png").read() == (made / "images/000001.png").read_bytes()


def test_objects_do_not_meet_and_are_seen():
    spec = small(objects=[ObjectSpec("builtin:shapes", "thing", (5, 5), (0.3, 0.6), "any")],
                 occlusion=OcclusionSpec(0.4, 0.5), sensor=SensorSpec())
    frame = FrameMaker(spec).make(0)
    centres = [np.mean(entry["corners_cam"], 0) for entry in frame.objects]
    radii = [np.linalg.norm(np.subtract(entry["corners_cam"][0], entry["corners_cam"][7])) / 2 for entry in frame.objects]
    assert len(frame.objects) == 5
    for i in range(5):
        assert frame.objects[i]["truncation"] <= 0.5
        assert frame.objects[i]["pixels"] >= 0.4 * frame.objects[i]["pixels_amodal_inside"]
        # The longest edge is the size that was asked for.
        size = np.linalg.norm(np.diff(np.array(frame.objects[i]["corners_cam"])[[0, 1, 0, 2, 0, 4]], axis=0)[::2], axis=1).max()
        assert 0.3 - 1e-6 < size < 0.6 + 1e-6
        for j in range(i):
            assert np.linalg.norm(centres[i] - centres[j]) > radii[i] + radii[j]


def test_objects_stand_on_the_ground():
    spec = small(objects=[ObjectSpec("builtin:shapes", "thing", (3, 3), 0.5, "none")],
                 placement=PlacementSpec("surface", radius=2.0), camera=CameraSpec(elevation_deg=40.0, distance=6.0))
    frame = FrameMaker(spec).make(1)
    assert len(frame.objects) == 3
    for entry in frame.objects:
        corners = np.c_[entry["corners_cam"], np.ones(8)] @ frame.T_world_cam.T
        np.testing.assert_allclose(corners[:, 1].min(), 0, atol=1e-6)
        assert np.hypot(*corners[:, [0, 2]].mean(0)) < 2


@pytest.mark.parametrize("entry", [
    {"rotation": "any"}, {"rotation": "upright", "tilt_deg": 70.0}, {"rotation": "upright"}, {"rotation": "none"},
], ids=lambda entry: f"{entry['rotation']}{entry.get('tilt_deg', '')}")
def test_lowest_vertices_touch_the_ground(tmp_path, entry):
    """Of a ball with a smaller one beside it in a node of its own, turned and stretched."""
    ball, child = shapes.sphere(0.5, 24), shapes.sphere(0.3, 16)
    child.T_parent_mesh = [[0.6, -0.8, 0, 0.7], [0.8, 0.6, 0, 0.2], [0, 0, 1.5, 0.1], [0, 0, 0, 1]]
    ball.add_child(child)
    ball.save(tmp_path / "balls.glb")
    spec = small(objects=[ObjectSpec(str(tmp_path / "balls.glb"), "balls", (2, 2), 1.0, **entry)], occlusion=OcclusionSpec(0.0, 1.0),
                 placement=PlacementSpec("surface", radius=2.0), camera=CameraSpec(elevation_deg=40.0, distance=6.0))
    whole = easypbr.Mesh(tmp_path / "balls.glb").merge().V
    maker = FrameMaker(spec)
    for index in range(3):
        frame = maker.make(index)
        assert len(frame.objects) == 2
        for entry in frame.objects:
            T = frame.T_world_cam @ entry["T_cam_obj"]
            heights = whole @ T[1, :3] + T[1, 3]
            assert abs(heights.min()) < 1e-5 < heights.max()  # metres; single precision of sizes of 1 m


def test_impossible_specs_name_the_constraint():
    crowd = ObjectSpec(class_name="drone", count=(40, 40), size=2.0)
    with pytest.raises(ArgumentError, match="placement.collisions.*200 tries"):
        FrameMaker(small(objects=[crowd])).make(0)
    with pytest.raises(ArgumentError, match="occlusion.max_truncation"):
        near = PlacementSpec(distance=0.4, margin=0.0)
        one = [ObjectSpec(class_name="drone")]
        FrameMaker(small(objects=one, placement=near, occlusion=OcclusionSpec(0.1, 0.0, 3))).make(0)


@pytest.mark.parametrize("changes, message", [
    ({"placement": PlacementSpec("surface", radius=1e4)}, "or make placement.radius smaller$"),
    ({"objects": [ObjectSpec(class_name="drone", size=1e-5)]}, "or make placement.distance smaller$"),
], ids=("beyond", "tiny"))
def test_objects_that_cannot_be_seen_are_named(changes, message):
    """No constraint of a spec forbids it: occlusion.min_visible is 0."""
    with pytest.raises(ArgumentError, match="^dataset: frame 0: 3 tries: no pixel of a 'drone' was visible: .*fewer or larger.*" + message):
        FrameMaker(small(occlusion=OcclusionSpec(0.0, 1.0, 3), **changes)).make(0)


def test_lines_are_in_no_layer(tmp_path):
    lines = easypbr.Mesh()
    lines.V, lines.E = np.eye(3), np.array([[0, 1], [1, 2]])
    lines.save(tmp_path / "lines.ply")
    source = ObjectSpec(str(tmp_path / "lines.ply"), class_name="wire")
    with pytest.raises(ArgumentError, match="20 tries: a 'wire' has lines alone, which are in no layer: .*distractor.*--tubes"):
        FrameMaker(small(objects=[source])).make(0)
    source.distractor = True
    assert FrameMaker(small(objects=[source, ObjectSpec(class_name="drone")])).make(0).depth.any()


@pytest.mark.parametrize("fov_y_deg, size", [(0.001, 2e-5), (0.5, 0.01), (175.0, 6.0), (179.0, 30.0)])
def test_lenses_of_every_angle(fov_y_deg, size):
    """Wider and narrower than the setting camera.fov_y_deg takes: a data set's cameras have a K."""
    spec = small(camera=CameraSpec(fov_y_deg=fov_y_deg), objects=[ObjectSpec(class_name="drone", size=size)],
                 placement=PlacementSpec("frustum", distance=4.0), occlusion=OcclusionSpec(0.0, 1.0, 20))
    assert (FrameMaker(spec).make(0).depth > 0).any()


@pytest.mark.parametrize("text, message", [
    ("cuont = 3", "no 'cuont'.*'count'"),
    ("[camera]\nfov = 3", "no 'fov'.*fov_y_deg"),
    ("[[objects]]\nsouce = 'a'", "no 'souce'.*'source'"),
    ("count = 'three'", "count: expected a whole number"),
    ("[camera]\ndistance = [5, 2]", "least, largest"),
    ("writers = ['cocoo']\n[[objects]]", "'cocoo'.*'coco'"),
    ("count = 3", "objects"),
    ("count = 0\n[[objects]]", "count: expected 1 to 1000000"),
    ("count = ", "spec.toml"),
    ("writers = " + "[" * 3000, "nested too deeply"),
    ("[[objects]]\nrotation = 'sideways'", "rotation.*upright"),
    ("seed = -1\n[[objects]]", "seed: expected 0 or more, got -1"),
    ("[[objects]]\ncount = [3, 1]", r"objects\[0\].count: expected \[least, largest\], got \[3, 1\]"),
    ("[[objects]]\n[[objects]]\nsize = -1.0", r"objects\[1\].size: expected more than 0, got -1"),
    ("[[objects]]\nsize = nan", r"objects\[0\].size: expected more than 0, got nan"),
    ("[image]\nsize = [0, 10]\n[[objects]]", r"image.size: expected 1 to 65536, got \[0, 10\]"),
    ("[camera]\nfov_y_deg = 200.0\n[[objects]]", "camera.fov_y_deg: expected 0.001 to 179, got 200"),
    ("[camera]\nK = [[nan, 0, 1], [0, 1, 1], [0, 0, 1]]\n[[objects]]", "camera: K: expected finite"),
    ("[camera]\nK = [[0, 0, 1], [0, 1, 1], [0, 0, 1]]\n[[objects]]", "camera: expected K = .* with fx, fy > 0"),
    ("[camera]\nK = [600, 0, 320, 0, 600, 240, 0, 0, 1]", "camera: K: expected rows of numbers"),
    ("[camera]\ndistortion = [0.1]\n[[objects]]", "camera distortion: expected 4, 5 or 8"),
    ("[occlusion]\ntries = 0\n[[objects]]", "occlusion.tries: expected 1 to 1000000"),
    ("[sensor]\nnoise = [-0.1, 0.1]\n[[objects]]", r"sensor.noise: expected 0 to 10, got \[-0.1, 0.1\]"),
    ("writers = ['png']\n[[objects]]\ncount = [1, 65535]\n[[objects]]", "up to 65535 instances.*allows for 65536"),
])
def test_bad_specs_say_what_is_wrong(tmp_path, text, message):
    (tmp_path / "spec.toml").write_text(text)
    with pytest.raises(ArgumentError, match=message):
        DatasetSpec.from_toml(tmp_path / "spec.toml")


KEPT_SPECS = sorted((Path(__file__).parents[1] / "fuzz/python_seeds/spec").iterdir())


@pytest.mark.parametrize("kept", KEPT_SPECS, ids=lambda kept: kept.name)
def test_specs_kept_by_the_fuzzer_are_read_or_refused(kept, monkeypatch):
    monkeypatch.syspath_prepend(kept.parents[2])
    from specs import target
    target()(kept.read_bytes())


def test_files_that_are_no_specs_or_folders_are_named(tmp_path):
    with pytest.raises(FileError, match="cannot read .*none.toml: No such file"):
        DatasetSpec.from_toml(tmp_path / "none.toml")
    (tmp_path / "spec.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(ArgumentError, match="spec.toml: .*utf-8"):
        DatasetSpec.from_toml(tmp_path / "spec.toml")
    with pytest.raises(FileError, match="cannot write .*spec.toml"):
        generate(small(), tmp_path / "spec.toml", workers=1)


def write_gltf(path, buffer: str, data: bytes) -> None:
    """A triangle whose three vertices are the first 36 bytes of its buffer."""
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"uri": buffer, "byteLength": len(data)}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    }))


def test_side_files_of_meshes_are_no_objects(tmp_path):
    """Buffers of a multiple of 16 bytes could be read as scans of KITTI; scans are still found."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [9, 9, 9]], "<f4").tobytes()  # 48 bytes
    folder = tmp_path / "models"
    (folder / "data").mkdir(parents=True)
    write_gltf(folder / "a.gltf", "data/far%20away.bin", corners)
    write_gltf(folder / "b.GLTF", "b.bin", corners)
    write_gltf(folder / "c.gltf", "data:application/octet-stream;base64,AAAA", corners)
    (folder / "broken.gltf").write_text('{"buffers": 3}')
    for name in ("data/far away.bin", "b.bin", "scan.bin"):
        (folder / name).write_bytes(corners)
    easypbr.save_image(np.zeros((2, 2, 3), np.uint8), folder / "texture.png")
    shapes.box().save(folder / "d.obj")
    (folder / "d.mtl").write_text("newmtl d\n")

    def found(source):
        return {str(Path(file).relative_to(folder)) for file in ObjectSpec(str(source)).files()}

    assert found(folder) == {"a.gltf", "b.GLTF", "c.gltf", "broken.gltf", "scan.bin", "d.obj"}
    assert found(folder / "*.bin") == {"scan.bin"} and found(folder / "b.*") == {"b.GLTF"}
    assert found(folder / "b.bin") == {"b.bin"}  # A file that is named is taken.
    with pytest.raises(ArgumentError, match="no mesh"):
        found(folder / "b*.bin")
    for name in ("c.gltf", "broken.gltf", "scan.bin", "d.obj"):
        (folder / name).unlink()
    generate(small(count=1, objects=[ObjectSpec(str(folder), "triangle", (2, 2))], writers=()), tmp_path / "set", workers=1)
    (record,) = records(tmp_path / "set")
    for entry in record["objects"]:
        assert sorted(entry["box3d_size"]) == [0, 1, 1]  # Of a scan it would be 9.


def test_specs_are_files(tmp_path):
    shapes.teapot(1, 4).save(tmp_path / "pot.ply")
    (tmp_path / "broken.ply").write_text("ply\nnonsense")
    (tmp_path / "spec.toml").write_text(
        "count = 2\nseed = 7\nwriters = ['yolo']\non_error = 'skip'\n[image]\nsize = [64, 48]\nsamples = 1\n"
        "[background]\nmode = 'color'\ncolor = '#203040'\n[[objects]]\nsource = '.'\nclass = 'pot'\nrandom_material = true\n"
    )
    spec = DatasetSpec.from_toml(tmp_path / "spec.toml")
    statistics = generate(spec, tmp_path / "out", workers=1)
    assert statistics["classes"] == {"pot": 2}
    assert not statistics["skipped"] or statistics["skipped"][0].endswith("broken.ply")
    assert "pot" in (tmp_path / "out/data.yaml").read_text()
    spec.on_error = "stop"
    spec.objects[0].source = str(tmp_path / "broken.ply")
    with pytest.raises(easypbr.FormatError, match="broken.ply"):
        generate(spec, tmp_path / "other", workers=1)
    with pytest.raises(ArgumentError, match="another spec"):
        generate(small(), tmp_path / "out", workers=1)


POT = ("count = 1\nwriters = []\n[image]\nsize = [32, 24]\nsamples = 1\n[background]\nmode = 'image'\nfiles = ['back.png']\n"
       "[surroundings]\nsource = 'pot.ply'\nsize = 0.1\n[[objects]]\nsource = 'pot.ply'\n")


def write_pot(folder: Path) -> Path:
    """A spec of files beside it."""
    folder.mkdir()
    shapes.teapot(1, 4).save(folder / "pot.ply")
    easypbr.save_image(np.zeros((2, 2, 3), np.uint8), folder / "back.png")
    (folder / "spec.toml").write_text(POT)
    return folder / "spec.toml"


def test_a_set_goes_on_however_its_spec_is_spelt(tmp_path, monkeypatch):
    path, out = write_pot(tmp_path / "one"), tmp_path / "out"
    (tmp_path / "link").symlink_to("one")
    monkeypatch.chdir(path.parent)
    generate(DatasetSpec.from_toml("spec.toml"), out, workers=1)
    made = hashes(out)
    for folder, spelling in ((".", path), ("..", "one/spec.toml"), (".", "../one/./spec.toml"), ("..", "link/spec.toml")):
        monkeypatch.chdir(path.parent / folder)
        generate(DatasetSpec.from_toml(spelling), out, workers=1)
        assert hashes(out) == made
    other = write_pot(tmp_path / "other")  # The same words, of other files.
    with pytest.raises(ArgumentError, match="another spec"):
        generate(DatasetSpec.from_toml(other), out, workers=1)
    monkeypatch.chdir(other.parent)
    with pytest.raises(ArgumentError, match="another spec"):
        generate(DatasetSpec.from_toml("spec.toml"), out, workers=1)


def test_a_run_without_an_image_does_not_block_its_folder(tmp_path):
    path, out = write_pot(tmp_path / "one"), tmp_path / "out"
    path.write_text(POT.replace("[[objects]]\nsource = 'pot.ply'", "[[objects]]\nsource = 'pott.ply'"))
    for workers in (1, 2):
        with pytest.raises(easypbr.FileError, match="pott.ply"):
            generate(DatasetSpec.from_toml(path), out, workers=workers)
    path.write_text(POT)
    generate(DatasetSpec.from_toml(path), out, workers=1)
    fresh = tmp_path / "fresh"
    generate(DatasetSpec.from_toml(path), fresh, workers=1)
    assert hashes(out) == hashes(fresh)
    path.write_text(POT.replace("count = 1", "count = 2"))
    with pytest.raises(ArgumentError, match="another spec or count"):
        generate(DatasetSpec.from_toml(path), out, workers=1)


def test_a_strange_spec_is_not_replaced(tmp_path):
    (tmp_path / "spec.json").write_text('{"objects": []}')
    with pytest.raises(ArgumentError, match="another spec"):
        generate(small(), tmp_path, workers=1)
    assert (tmp_path / "spec.json").read_text() == '{"objects": []}'


def test_objects_that_are_not_seen_are_no_boxes():
    from easypbr.dataset.writers import Coco, Yolo

    entry = {"box": [0, 0, 0, 0], "category_id": 1, "corners_px": [[0, 0]] * 8}
    record = {"index": 0, "width": 4, "height": 4, "objects": [entry]}
    files = Coco("png", ["a"]).finish([record], None)
    assert json.loads(files["annotations.json"])["annotations"] == []


def test_a_full_disk_is_an_error(made, tmp_path, monkeypatch):
    from pathlib import Path

    def full(self, data):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(FileError, match="No space left"):
        generate(small(), tmp_path / "full", workers=1)
    assert not list((tmp_path / "full/unfinished").glob("*"))
