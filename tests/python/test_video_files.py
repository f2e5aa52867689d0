"""The files that videos are written into: each recording's own, and those that are there already."""

import json
import subprocess

import pytest

import easypbr
from easypbr import Scene, Viewer, shapes


@pytest.fixture
def recorders():
    """Two, of viewers whose images differ in size."""
    scene = Scene()
    scene.show(shapes.box(), "box")
    look = {"camera.position": (3, 2, 5), "camera.target": (0, 0, 0), "image.samples": 1}
    return [Viewer(size, look, scene=scene).recorder for size in ((64, 48), (96, 64))]


@pytest.fixture
def recorder(recorders):
    return recorders[0]


def frames_of(path) -> int:
    """Counted by decoding them."""
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "json", path]
    (stream,) = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["streams"]
    return int(stream["nb_read_frames"])


def names_in(folder) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize("name", ["a.mp4", "a.mov", "a.mkv", "a.gif"])
def test_recordings_of_one_name_replace_it_whole(recorders, tmp_path, name, first):
    """Each has a file of its own; after each end the video has as many frames as the recording that ended."""
    file = tmp_path / name
    file.write_bytes(b"the old one")
    counts = (7, 4)
    for recorder in recorders:
        recorder.start(file)
    assert names_in(tmp_path) == sorted([name, name.replace(".", ".part."), name.replace(".", ".part-2.")])
    for step in range(max(counts)):
        for recorder, count in zip(recorders, counts):
            if step < count:
                recorder.add_frame()
    for i in (first, 1 - first):
        assert recorders[i].stop() == counts[i]
        assert frames_of(file) == counts[i]
    assert names_in(tmp_path) == [name]


@pytest.mark.parametrize("name", ["a.mp4", "a.webm", "a.gif"])
def test_a_new_video_is_recorded_once_at_a_time(recorders, tmp_path, name):
    file, (recorder, other) = tmp_path / name, recorders
    with recorder.start(file):
        recorder.add_frame()
        with pytest.raises(easypbr.FileError, match=f"cannot write .*{name}: it is being recorded"):
            other.start(file)
        assert names_in(tmp_path) == [name]
        recorder.add_frame()
        recorder.add_frame()
    assert frames_of(file) == 3
    with other.start(file):
        other.add_frame()
    assert frames_of(file) == 1


@pytest.mark.parametrize("name", ["a.mp4", "a.mkv"])
def test_a_recording_leaves_a_file_that_took_its_place(recorders, tmp_path, name):
    """Another program's file, and a recording that began where the file had been removed."""
    file, (recorder, other) = tmp_path / name, recorders
    recorder.start(file)
    recorder.add_frame()
    (tmp_path / "other").write_bytes(b"another file")
    (tmp_path / "other").replace(file)
    with pytest.raises(easypbr.FileError, match="removed or replaced while it was written"):
        recorder.stop()
    assert file.read_bytes() == b"another file" and names_in(tmp_path) == [name]

    recorder.start(file)
    recorder.add_frame()
    file.unlink()
    with other.start(file):
        for _ in range(2):
            other.add_frame()
        part = name.replace(".", ".part.")
        with pytest.raises(easypbr.FileError, match=f"{name}: it is being recorded meanwhile; this recording is .*{part}"):
            recorder.stop()
    assert (frames_of(file), frames_of(tmp_path / part)) == (2, 1)


@pytest.mark.parametrize("old", [False, True])
@pytest.mark.parametrize("name", ["a.mp4", "a.mov"])
def test_indexing_a_video_writes_no_other_file(recorder, tmp_path, name, old):
    """A fragmented MP4 is made an ordinary one by way of a new file, which nothing else can have the name of."""
    file, part, target = tmp_path / name, tmp_path / f"{name}.part", tmp_path / "target"
    link = tmp_path / (name.replace(".", ".part.") + ".part")
    for path in (part, target, *([file] if old else [])):
        path.write_bytes(b"mine")
    link.symlink_to("target")
    with recorder.start(file):
        for _ in range(3):
            recorder.add_frame()
    # ISO/IEC 14496-12: "moof" begins a fragment; an ordinary file has none.
    assert frames_of(file) == 3 and b"moof" not in file.read_bytes()
    assert names_in(tmp_path) == sorted([name, part.name, link.name, "target"])
    assert part.read_bytes() == target.read_bytes() == b"mine" and link.is_symlink()


def test_a_new_video_has_the_permissions_of_new_files(recorder, tmp_path):
    (tmp_path / "new").touch()
    with recorder.start(tmp_path / "a.mp4"):
        recorder.add_frame()
    assert (tmp_path / "a.mp4").stat().st_mode == (tmp_path / "new").stat().st_mode


@pytest.mark.parametrize("name", ["a.mp4", "a.gif"])
def test_files_beside_a_recording_stay(recorder, tmp_path, name):
    """A file, a link to one and a link to none, each with the name that the recording would take next."""
    file, parts = tmp_path / name, [tmp_path / name.replace(".", f".part{number}.") for number in ("", "-2", "-3")]
    for path in (file, parts[0], tmp_path / "target"):
        path.write_bytes(b"mine")
    parts[1].symlink_to("target")
    parts[2].symlink_to("nothing")
    before = names_in(tmp_path)
    with recorder.start(file):
        recorder.add_frame()
    assert frames_of(file) == 1 and names_in(tmp_path) == before
    assert parts[0].read_bytes() == (tmp_path / "target").read_bytes() == b"mine"
    assert parts[1].is_symlink() and parts[2].is_symlink()


def test_who_may_not_read_a_video_may_not_read_its_part(recorder, tmp_path):
    file = tmp_path / "a.mp4"
    file.write_bytes(b"mine")
    file.chmod(0o640)
    with recorder.start(file):
        recorder.add_frame()
        # The group of a new file may be another one.
        assert (tmp_path / "a.part.mp4").stat().st_mode & 0o777 == 0o600
    assert file.stat().st_mode & 0o777 == 0o640 and frames_of(file) == 1


def test_a_recording_is_finished_where_it_began(recorder, tmp_path, monkeypatch):
    (tmp_path / "later").mkdir()
    monkeypatch.chdir(tmp_path)
    with recorder.start("a.mp4"):
        recorder.add_frame()
        monkeypatch.chdir("later")
    data = (tmp_path / "a.mp4").read_bytes()
    # ISO/IEC 14496-12: "moof" begins a fragment; an ordinary file has none.
    assert b"moof" not in data and data.index(b"moov") < data.index(b"mdat")
    assert frames_of(tmp_path / "a.mp4") == 1


def test_a_part_of_too_long_a_name_is_named(recorder, tmp_path, monkeypatch):
    """A name of 252 bytes fits, but not with ".part" in it: a file's name has 255 bytes at most, on all file systems of Linux
    that hold the tests."""
    monkeypatch.chdir(tmp_path)
    stem = "a" * 248
    (tmp_path / f"{stem}.mp4").write_bytes(b"the old one")
    with pytest.raises(easypbr.FileError, match=rf"^cannot write {stem}\.mp4: {stem}\.part\.mp4: File name too long$"):
        recorder.start(f"{stem}.mp4")
    assert (tmp_path / f"{stem}.mp4").read_bytes() == b"the old one"


@pytest.mark.parametrize("old", [False, True])
def test_a_size_that_no_video_has_names_the_video(tmp_path, monkeypatch, old):
    """Not the file beside the old one that it would be written into."""
    monkeypatch.chdir(tmp_path)
    if old:
        (tmp_path / "a.mp4").write_bytes(b"the old one")
    scene = Scene()
    scene.show(shapes.box(), "box")
    recorder = Viewer((16386, 2), {"image.samples": 1}, scene=scene).recorder
    with pytest.raises(easypbr.ArgumentError, match="^cannot write a.mp4: expected a size from 2x2 to 16384x16384, got 16386x2"):
        recorder.start("a.mp4")
        recorder.add_frame()
    assert names_in(tmp_path) == ["a.mp4"] * old
