"""Recorder: images and recordings of a viewer as files."""

import atexit
import os
import weakref
from collections.abc import Callable
from pathlib import Path

from numpy.typing import ArrayLike

from . import _easypbr
from .arguments import samples_of
from .errors import ArgumentError
from .panels import WindowCallbacks

_DEFAULT_FPS = 30.0
#: Recorders that may be recording when the program ends.
_started: "weakref.WeakSet[Recorder]" = weakref.WeakSet()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_started.clear)  # They are the parent's.


@atexit.register
def _finish_recordings() -> None:
    for recorder in list(_started):
        recorder.stop()


def watch_recorder(recorder: "Recorder") -> None:
    """Finishes the recording when the program ends."""
    _started.add(recorder)


class Recorder:
    """Writes images and recordings of a viewer. Frames are encoded on other threads, all of them, in order."""

    def __init__(self, viewer: WindowCallbacks) -> None:
        self._handle = viewer._handle

    def record(self, path: str | os.PathLike[str], size: ArrayLike | None = None, samples: int | None = None, deep: bool = False) -> Path:
        """Writes one image, complete when the call returns: PNG (16 bits with `deep`), JPEG, HDR or EXR, by the
        extension. `deep` with another extension than PNG raises ArgumentError."""
        return self._handle.record(path, size, samples_of(samples), deep)

    def start(
        self,
        path: str | os.PathLike[str],
        fps: float = _DEFAULT_FPS,
        size: ArrayLike | None = None,
        samples: int | None = None,
        codec: str = "",
        deep: bool = False,
    ) -> "Recorder":
        """Starts a recording: a video (MP4, MOV, MKV, WebM, GIF) or numbered images ("out/frame_%04d.png", or a
        folder), by the name. `with view.recorder.start("out.mp4"):` stops it at the end of the block. `codec` is
        FFmpeg's name of an encoder. While recording, view.time advances by 1 / fps per frame."""
        was_recording = self.is_recording
        _started.add(self)
        try:
            self._handle.start_recording(path, fps, size, samples_of(samples), codec, deep)
        except BaseException:
            # Ctrl-C raises after the call, when the recording has started.
            if not was_recording:
                self.stop()
            raise
        return self

    def add_frame(self, picture: ArrayLike | None = None) -> None:
        """Renders the scene as the next frame and advances view.time. A `picture` of the recording's size is
        added in place of that; videos, PNG and JPEG get floats as sRGB."""
        self._handle.add_frame(picture)

    def stop(self) -> int:
        """Waits until all frames are written and finishes the file; returns their number. A recording without frames leaves no
        file and is a warning."""
        _started.discard(self)
        return self._handle.stop_recording()

    @property
    def is_recording(self) -> bool:
        return self._handle.is_recording()

    @property
    def frame_count(self) -> int:
        """Frames of this recording so far."""
        return self._handle.frame_count()

    def record_path(
        self,
        path: "_easypbr.CameraPath",
        out: str | os.PathLike[str],
        fps: float | None = None,
        frames: int | None = None,
        size: ArrayLike | None = None,
        samples: int | None = None,
        codec: str = "",
        on_frame: Callable[[int, float], None] | None = None,
    ) -> int:
        """Records along a camera path: path.frame_times(fps), or `frames` evenly spaced times. `fps` is 30 by default, or
        with `frames` path.frame_rate(frames): the recording lasts as long as the path. on_frame(number, seconds) is called
        before each frame, for example to move objects. The camera is restored afterwards. Returns the number of frames."""
        if not isinstance(path, _easypbr.CameraPath):
            raise ArgumentError(f"record_path: expected a CameraPath, got a {type(path).__name__}")
        before = self._handle.camera_state
        camera = self._handle.camera
        try:
            if fps is None:
                fps = _DEFAULT_FPS if frames is None else path.frame_rate(frames)
            times = path.frame_times(fps) if frames is None else path.times(frames)
            with self.start(out, fps, size, samples, codec):
                # A closed path was on its way before the first frame; on an open one the camera rests until then.
                step = times[1] - times[0] if len(times) > 1 else 1 / fps
                self._handle.begin_motion(path.camera(times[0] - step, camera))
                for number, seconds in enumerate(times):
                    if on_frame is not None:
                        on_frame(number, seconds)
                    self._handle.camera = path.camera(seconds, camera)
                    self.add_frame()
                return self.frame_count
        finally:
            self._handle.camera_state = before

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()
