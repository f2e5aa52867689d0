"""H.264 while something moves: who gets it, from which picture on, and what happens on slow lines."""

import subprocess
import time

import numpy as np
import pytest
from client import H264, JPEG, MOVING, Client


def moving(client, codec=None):
    return [frame for frame in client.frames if frame.kind == MOVING and codec in (None, frame.codec)]


def turn(client, seconds=1.0, others=()):
    """Drags to and fro; all clients receive what comes."""
    client.pointer("press", 80, 60)
    end, step = time.monotonic() + seconds, 0
    while time.monotonic() < end:
        client.pointer("move", 60 + 40 * abs((step := step + 1) % 20 - 10) / 10, 60)
        for each in (client, *others):
            each.collect(0.02)
    client.pointer("release", 60, 60)


def decode(frames, folder):
    """Pictures of a video, height x width x 3 each, by FFmpeg's program; all have the size of the first."""
    path = folder / "stream.h264"
    path.write_bytes(b"".join(frame.data for frame in frames))
    size = (frames[0].height + frames[0].height % 2, frames[0].width + frames[0].width % 2, 3)
    raw = subprocess.run(["ffmpeg", "-v", "error", "-f", "h264", "-i", path, "-fps_mode", "passthrough", "-f", "rawvideo",
                          "-pix_fmt", "rgb24", "-"], capture_output=True, check=True).stdout
    return np.frombuffer(raw, np.uint8).reshape(-1, *size)


def test_who_decodes_gets_a_video_from_a_key_frame_on(connect, tmp_path):
    client = connect(video=True)
    client.until_exact()
    turn(client)
    frames = moving(client)
    # One drawn between its two first messages is a JPEG: the server does not know yet that it decodes.
    if frames[0].codec == JPEG:
        frames = frames[1:]
    assert len(frames) >= 5
    assert {frame.codec for frame in frames} == {H264}
    assert frames[0].is_key
    # Frames of one size, from the last key frame on, are a video without a gap.
    begin = max(k for k, frame in enumerate(frames) if frame.is_key)
    pictures = decode(frames[begin:], tmp_path)
    assert len(pictures) == len(frames) - begin
    assert pictures[-1].std() > 5


def test_the_pictures_of_the_video_are_those_that_are_drawn(view, connect, tmp_path):
    """Who decodes and who does not see the same picture, as H.264 and as JPEG: both lossy, 30 dB apart at most."""
    view.settings.path.enabled = False
    client = connect(video=True, size=(320, 240))
    other = connect()
    client.until_exact()
    other.until_exact()
    turn(client, 1.5, [other])
    frames = moving(client, H264)
    begin = max(k for k, frame in enumerate(frames) if frame.is_key)
    pictures = decode(frames[begin:], tmp_path)
    twins = {frame.number: frame for frame in moving(other, JPEG)}
    pairs = [(picture, twins[frame.number]) for picture, frame in zip(pictures, frames[begin:]) if frame.number in twins]
    assert pairs
    for picture, twin in pairs:
        image = twin.image(tmp_path)[..., :3]
        picture = picture[:image.shape[0], :image.shape[1]]
        error = np.mean((picture.astype(float) - image) ** 2)
        assert 10 * np.log10(255 ** 2 / error) > 30


def test_at_rest_it_is_exact_as_ever(view, connect, tmp_path):
    view.settings.path.enabled = False
    view.render((200, 120))
    client = connect(video=True, size=(200, 120))
    first = client.until_exact()
    assert np.array_equal(first.image(tmp_path), view.render((200, 120)))
    turn(client, 0.5)
    last = client.until_exact(first.number, shows=client.inputs)
    assert last.codec == 2


def test_who_does_not_decode_gets_jpeg_beside_it(connect):
    client = connect()
    watcher = connect(video=True)
    client.until_exact()
    watcher.until_exact()
    client.frames.clear()
    watcher.frames.clear()
    # On a busy machine it may be late for a picture; it gets JPEG until it comes back, after a second.
    turn(client, 3, [watcher])
    assert {frame.codec for frame in moving(client)} == {JPEG}
    assert H264 in {frame.codec for frame in moving(watcher)}


def test_who_no_longer_decodes_gets_jpeg(connect):
    client = connect(video=True)
    client.until_exact()
    turn(client, 0.5)
    client.send("decodes", h264=False)
    client.collect(0.3)
    before = len(client.frames)
    turn(client, 0.5)
    assert {frame.codec for frame in client.frames[before:] if frame.kind == MOVING} == {JPEG}


def test_a_watcher_that_answers_nothing_falls_out_and_comes_back(connect):
    client = connect(video=True)
    slow = connect(video=True, answers=False)
    client.until_exact()
    slow.collect(1)
    for frame in list(slow.frames):
        slow.ack(frame)
    slow.frames.clear()
    turn(client, 2, [slow])
    # It holds nobody up, and nothing waits for it: its window of frames is all that it was sent.
    assert len(moving(client)) > len(moving(slow))
    assert 1 <= len(moving(slow)) <= 8
    for frame in list(slow.frames):
        slow.ack(frame)
    slow.answers = True
    slow.collect(0.5)
    slow.frames.clear()
    turn(client, 4, [slow])
    video = moving(slow, H264)
    assert video and video[0].is_key
    numbers = [frame.number for frame in moving(client, H264)]
    begin = numbers.index(video[0].number)
    assert [frame.number for frame in video] == numbers[begin:begin + len(video)]


def test_jpeg_can_be_chosen(view):
    with view.serve(codec="jpeg") as server:
        client = Client(server.url, video=True)
        client.until_exact()
        turn(client, 0.5)
        assert {frame.codec for frame in moving(client)} == {JPEG}
        client.close()
    with pytest.raises(ValueError, match="codec 'av1'"):
        view.serve(codec="av1")
