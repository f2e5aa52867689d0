"""`easypbr render --layers` writes ground truth beside the picture's own layers; the files agree with each other."""
import json
import os
import re

import numpy as np
import pytest

import exr

CAMERA = ("--camera-position", "0,0,5", "--camera-target", "0,0,0", "--size", "64x48")


def decoded(rle):
    """COCO's run lengths: five bits a letter, differences to the run before the last, column by column."""
    counts, value, shift = [], 0, 0
    for letter in rle["counts"].encode():
        group = letter - 48
        value, shift = value | (group & 31) << shift, shift + 5
        if not group & 32:
            value -= (1 << shift) if group & 16 else 0
            counts.append(value + (counts[-2] if len(counts) > 2 else 0))
            value = shift = 0
    height, width = rle["size"]
    return np.repeat(np.arange(len(counts)) % 2 == 1, counts).reshape(width, height).T


def test_ground_truth_is_written_beside_the_picture(render, sphere, tmp_path):
    names = "depth,instance_id,distance,position,face_id,uv,instances"
    render(sphere, *CAMERA, "-o", "out.png", "--layers", names)
    found = {}
    for name in names.split(",")[:-1]:
        channels = exr.read(tmp_path / f"out_{name}.exr")
        found[name] = channels["Y"] if "Y" in channels else np.stack([channels[c] for c in "RGB"], -1)
    (instance,) = json.loads((tmp_path / "out_instances.json").read_text())
    assert instance["id"] == 1
    mask = found["instance_id"] == 1
    assert mask.shape == (48, 64) and (mask == (found["depth"] > 0)).all()
    assert ((found["face_id"].view(np.int32) >= 0) == mask).all()
    assert mask.sum() == instance["pixels_visible"] > 100 and instance["visible_fraction"] == 1
    assert (decoded(instance["rle"]) == mask).all()
    rows, columns = np.nonzero(mask)
    assert instance["box_visible"] == [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1]
    # float32 at a distance of 5.
    np.testing.assert_allclose(found["distance"][mask], np.linalg.norm(found["position"][mask] - (0, 0, 5), axis=-1), atol=1e-5)
    np.testing.assert_allclose(found["depth"][mask], 5 - found["position"][mask][:, 2], atol=1e-5)
    assert found["uv"].shape == (48, 64, 3) and (found["uv"][..., 2] == 0).all()  # two channels and an empty one
    corners = np.array(instance["corners_cam"])
    np.testing.assert_allclose(corners.max(0) - corners.min(0), instance["box3d_size"], atol=1e-9)


def test_integers_are_exact(render, tmp_path):
    """Labels that float32 rounds, and a negative one: each of four separate faces has one at all its corners."""
    labels = [16777217, 19660811, -5, 2147483647]
    corners = [f"{x} {y} 0" for i in range(4) for x, y in ((i, 0), (i + 1, 0), (i, 1))]
    header = ["ply", "format ascii 1.0", "element vertex 12", "property float x", "property float y", "property float z",
              "property int label", "element face 4", "property list uchar int vertex_indices", "end_header"]
    vertices = [f"{corner} {labels[i // 3]}" for i, corner in enumerate(corners)]
    faces = [f"3 {3 * i} {3 * i + 1} {3 * i + 2}" for i in range(4)]
    (tmp_path / "labels.ply").write_text("\n".join([*header, *vertices, *faces, ""]))
    render(tmp_path / "labels.ply", "-o", "out.png", "--camera-position", "2,0.5,5", "--camera-target", "2,0.5,0", "--layers",
           "semantic_id,face_id,instance_id")
    found = {name: exr.read(tmp_path / f"out_{name}.exr")["Y"] for name in ("semantic_id", "face_id", "instance_id")}
    assert all(values.dtype == np.uint32 for values in found.values())
    faces, labelled = found["face_id"].view(np.int32), found["semantic_id"].view(np.int32)
    assert set(faces.ravel()) == {-1, 0, 1, 2, 3}
    assert (labelled == np.where(faces < 0, 0, np.take(labels, faces))).all()
    assert (found["instance_id"] == (faces >= 0)).all()


def test_instances_behind_the_camera_have_no_pixels(render, sphere, tmp_path):
    render(sphere, "--camera-position", "0,0,0", "--camera-target", "0,0,-1", "-o", "out.png", "--layers", "instances")
    (instance,) = json.loads((tmp_path / "out_instances.json").read_text())
    assert [None, None] in instance["corners_px"]  # no NaN, which is no JSON


def test_names_that_are_not_utf_8_are_written(render, sphere, tmp_path):
    """JSON is UTF-8: other bytes become U+FFFD, as in `easypbr info --json`."""
    file = os.fsencode(tmp_path) + b"/r\xf6hre.obj"
    with open(file, "wb") as copy:
        copy.write(sphere.read_bytes())
    render(os.fsdecode(file), "-o", "out.png", "--layers", "instances")
    (instance,) = json.loads((tmp_path / "out_instances.json").read_text(encoding="utf-8"))
    assert "r\ufffdhre" in instance["name"]


@pytest.mark.parametrize("name, message", [
    ("instance", "no layer 'instance'.*did you mean 'instances'"),
    ("flow_forward", "flow_forward needs another frame.*render_layers"),
    ("colour", "no layer 'colour'"),
    ("normal", "no layer 'normal': it is called 'normal_world'"),
])
def test_layers_that_cannot_be_written(render, sphere, tmp_path, name, message):
    assert re.search(message, render(sphere, "-o", "out.png", "--layers", name, code=2).stderr)
    assert list(tmp_path.iterdir()) == []
