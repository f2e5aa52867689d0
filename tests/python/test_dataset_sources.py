"""A set goes on with the files that it was begun with: others would not go with the frames that are there."""

import json
import os
import shutil

import numpy as np
import pytest

import easypbr
from easypbr import ArgumentError, shapes
from easypbr.dataset import BackgroundSpec, ImageSpec, ObjectSpec, SurroundingsSpec, generate
from easypbr.dataset.writers import Bop
from test_dataset import hashes, small


@pytest.fixture
def meshes(tmp_path):
    folder = tmp_path / "meshes"
    folder.mkdir()
    shapes.box((1, 1, 1)).save(folder / "a.ply")
    shapes.box((1, 1, 2)).save(folder / "b.ply")
    return folder


def spec_of(source, **changes):
    return small(**{"image": ImageSpec((48, 36), 1), "count": 2, "writers": ("coco",), "background": BackgroundSpec("color"),
                    "objects": [ObjectSpec(str(source), "thing")], **changes})


def begin(spec, folder):
    """A set of which the second frame is missing."""
    generate(spec, folder, workers=1)
    made = hashes(folder)
    (folder / "records/000001.json").unlink()
    return made


def later(path):
    """Gives a file another time."""
    time = path.stat().st_mtime_ns + 10**9
    os.utime(path, ns=(time, time))


def changed(path):
    """Changes a bit of a file, not its size."""
    data = bytearray(path.read_bytes())
    data[-1] ^= 1
    path.write_bytes(data)
    later(path)


def refused(spec, folder, message):
    before = hashes(folder)
    with pytest.raises(ArgumentError, match=f"^dataset: {folder}: {message}"):
        generate(spec, folder, workers=1)
    assert hashes(folder) == before


@pytest.mark.parametrize("source", ["a.ply", "*.ply", "."])
def test_a_mesh_that_has_changed_is_named(meshes, tmp_path, source):
    spec = spec_of(meshes / source)
    begin(spec, tmp_path / "set")
    changed(meshes / "a.ply")
    refused(spec, tmp_path / "set", f"{meshes}/a.ply is not the file that the set was begun with: its content has changed")


@pytest.mark.parametrize("source", ["*.ply", "."])
def test_files_that_come_and_go_are_named(meshes, tmp_path, source):
    spec = spec_of(meshes / source)
    made = begin(spec, tmp_path / "set")
    shutil.copy(meshes / "a.ply", meshes / "c.ply")
    refused(spec, tmp_path / "set", f"{meshes}/c.ply is none of the files that the set was begun with: it has been added")
    (meshes / "c.ply").unlink()
    (meshes / "a.ply").rename(tmp_path / "a.ply")
    refused(spec, tmp_path / "set", f"{meshes}/a.ply, a file that the set was begun with, is gone")
    (tmp_path / "a.ply").rename(meshes / "a.ply")
    generate(spec, tmp_path / "set", workers=1)
    assert hashes(tmp_path / "set") == made


def test_pictures_and_surroundings_are_files_of_a_set(meshes, tmp_path):
    back = tmp_path / "back.png"
    easypbr.save_image(np.zeros((2, 2, 3), np.uint8), back)
    spec = spec_of(meshes / "a.ply", background=BackgroundSpec("image", (str(back),)),
                   surroundings=SurroundingsSpec(str(meshes / "b.ply"), 0.1))
    begin(spec, tmp_path / "set")
    for path in (back, meshes / "b.ply"):
        before = path.read_bytes()
        changed(path)
        refused(spec, tmp_path / "set", f"{path} is not the file that the set was begun with")
        path.write_bytes(before)
    generate(spec, tmp_path / "set", workers=1)


def test_a_file_that_is_the_same_at_another_time_is_no_other(meshes, tmp_path):
    spec = spec_of(meshes)
    made = begin(spec, tmp_path / "set")
    shutil.copy(meshes / "a.ply", tmp_path / "a.ply")
    (tmp_path / "a.ply").replace(meshes / "a.ply")
    later(meshes / "a.ply")
    generate(spec, tmp_path / "set", workers=1)
    found = hashes(tmp_path / "set")
    assert found.pop("spec.json") != made.pop("spec.json")  # It has the new time, for which the file is not read once more.
    assert found == made


def test_files_of_known_size_and_time_are_not_read_again(meshes, tmp_path, monkeypatch):
    spec = spec_of(meshes)
    begin(spec, tmp_path / "set")
    monkeypatch.setattr("easypbr.dataset.sources._sha256", None)
    generate(spec, tmp_path / "set", workers=1)


def test_finished_sets_need_their_files_no_more(meshes, tmp_path):
    spec = spec_of(meshes)
    generate(spec, tmp_path / "set", workers=1)
    made = hashes(tmp_path / "set")
    shutil.rmtree(meshes)
    generate(spec, tmp_path / "set", workers=1)
    assert hashes(tmp_path / "set") == made


def test_models_are_of_the_file_that_was_drawn(meshes, tmp_path):
    """BOP's are made of the file at the end of each run."""
    spec = spec_of(meshes / "a.ply", writers=("bop",), objects=[ObjectSpec(str(meshes / "a.ply"), "thing", size=0.8)])
    generate(spec, tmp_path / "set", workers=1)
    changed(meshes / "a.ply")
    refused(spec, tmp_path / "set", f"{meshes}/a.ply is not the file")


def test_a_set_without_a_frame_takes_the_files_that_are_there(meshes, tmp_path):
    spec = spec_of(meshes / "a.ply")
    whole = (meshes / "a.ply").read_bytes()
    (meshes / "a.ply").write_text("ply\nnonsense")
    with pytest.raises(easypbr.FormatError):
        generate(spec, tmp_path / "set", workers=1)
    (meshes / "a.ply").write_bytes(whole)
    generate(spec, tmp_path / "set", workers=1)
    (tmp_path / "set/records/000001.json").unlink()
    generate(spec, tmp_path / "set", workers=1)


def test_sets_of_earlier_versions_go_on(meshes, tmp_path):
    """Their spec.json lists no files."""
    spec = spec_of(meshes / "a.ply")
    begin(spec, tmp_path / "set")
    path = tmp_path / "set/spec.json"
    values = json.loads(path.read_text())
    del values["files"]
    path.write_text(json.dumps(values, indent=1) + "\n")
    before = path.read_text()
    shutil.copy(meshes / "b.ply", meshes / "a.ply")
    generate(spec, tmp_path / "set", workers=1)
    assert path.read_text() == before  # What the first frame was drawn from is not known.


@pytest.mark.parametrize("source", ["**/*.ply", "."])
@pytest.mark.parametrize("place", ["meshes", "meshes/set", "."])
def test_files_of_a_set_are_none_of_its_meshes(meshes, tmp_path, source, place):
    """Labels could be read as points, models of BOP as meshes. The set is with its meshes, beneath them, and around them."""
    folder = tmp_path / place
    spec = spec_of("x", writers=("yolo", "bop"), objects=[ObjectSpec(str(meshes / source), "thing", size=0.8)])
    (meshes / "b.ply").unlink()
    generate(spec, tmp_path / "beyond", workers=1)
    wanted = hashes(tmp_path / "beyond")
    shutil.rmtree(tmp_path / "beyond")
    made = begin(spec, folder)
    assert (folder / "bop/models/obj_000001.ply").exists() and (folder / "labels/000000.txt").exists()
    generate(spec, folder, workers=1)
    assert hashes(folder) == made
    assert wanted.items() <= made.items()


def bop_models(meshes, sizes):
    """models_info.json of a class whose objects have models of these sizes, each in a frame of its own."""
    spec = spec_of(meshes / "a.ply", objects=[ObjectSpec(str(meshes / "a.ply"), "thing", size=0.8)])
    truth = {str(i): [{"obj_id": 1, "model": {"diameter": 1.5 * size, "size_x": size}}] for i, size in enumerate(sizes)}
    files = Bop("png", ["thing"], spec)._models(truth, meshes / "set")
    return json.loads(files.pop("bop/models/models_info.json")), set(files)


def test_a_class_of_models_that_differ_is_not_in_bop_models(meshes):
    model = {"diameter": 1200, "size_x": 800}
    # Poses are of double precision: sizes have errors of 1e-15 of theirs.
    assert bop_models(meshes, [800, 800 * (1 + 1e-15)]) == ({"1": model}, {"bop/models/obj_000001.ply"})
    assert bop_models(meshes, [800, 799.9]) == ({}, set())
