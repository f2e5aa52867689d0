"""Recorder: pictures of a viewer as files, one by one or as recordings of many frames."""

import atexit
import os
import weakref
from collections.abc import Callable
from pathlib import Path

from numpy.typing import ArrayLike

from . import _easypbr
from .errors import ArgumentError
from .panels import WindowCallbacks

#: Recorders that may be recording when the program ends.
_started: "weakref.WeakSet[Recorder]" = weakref.WeakSet()


@atexit.register
def _finish_recordings() -> None:
    for recorder in list(_started):
        recorder.stop()


def watch_recorder(recorder: "Recorder") -> None:
    """Finishes what this recorder records when the program ends."""
    _started.add(recorder)


class Recorder:
    """Pictures of a viewer as files, and recordings: frames are encoded beside the drawing, all of them, in order."""

    def __init__(self, viewer: WindowCallbacks) -> None:
        self._handle = viewer._handle

    def record(self, path: str | os.PathLike, size: ArrayLike | None = None, samples: int | None = None, deep: bool = False) -> Path:
        """Writes one picture, complete when the call returns: PNG (16 bits with `deep`), JPEG, HDR or EXR, by the
        extension."""
        return self._handle.record(path, size, samples, deep)

    def start(
        self,
        path: str | os.PathLike,
        fps: float = 30.0,
        size: ArrayLike | None = None,
        samples: int | None = None,
        codec: str = "",
        deep: bool = False,
    ) -> "Recorder":
        """Begins a recording: a video (MP4, MOV, MKV, WebM, GIF) or numbered pictures ("out/frame_%04d.png", or a
        folder), by the name. `with view.recorder.start("out.mp4"):` stops it at the end of the block. `codec` is
        FFmpeg's name of an encoder. While recording, view.time makes steps of 1 / fps."""
        self._handle.start_recording(path, fps, size, samples, codec, deep)
        _started.add(self)
        return self

    def add_frame(self, picture: ArrayLike | None = None) -> None:
        """Draws the scene as it is as the next frame, and lets view.time make its step. A `picture` of the
        recording's size is taken as it is."""
        self._handle.add_frame(picture)

    def stop(self) -> int:
        """Waits until all frames are written and finishes the file; returns how many there are."""
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
        out: str | os.PathLike,
        fps: float = 30.0,
        frames: int | None = None,
        size: ArrayLike | None = None,
        samples: int | None = None,
        codec: str = "",
        on_frame: Callable[[int, float], None] | None = None,
    ) -> int:
        """Records the camera on its way along a path: path.frame_times(fps), or `frames` evenly over it. on_frame(number,
        seconds) is called before each frame is drawn, for example to move something. The camera is afterwards what it
        was. Returns the number of frames."""
        if not isinstance(path, _easypbr.CameraPath):
            raise ArgumentError(f"record_path: expected a CameraPath, got a {type(path).__name__}")
        before = self._handle.camera_state
        camera = self._handle.camera
        try:
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
