"""The folder of a data set: files that are whole or not there."""

import contextlib
import ctypes
import dataclasses
import json
import os
from pathlib import Path

from .. import _easypbr
from ..errors import ArgumentError, FileError
from .frames import Frame
from .spec import DatasetSpec
from .writers import WRITERS, Writer


def keep_memory() -> None:
    """For a process that makes frame after frame: glibc keeps the buffers that each gives back for the next one, instead of
    returning them to the system and faulting their pages in anew (a seventh of a frame's time)."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        m_trim_threshold, m_mmap_threshold = -1, -3
        mallopt(m_trim_threshold, 256 << 20)
        mallopt(m_mmap_threshold, 32 << 20)


class FolderWriter:
    """All files of a set. A frame's record is written last: a frame without it does not count."""

    def __init__(self, spec: DatasetSpec, folder: Path, classes: list[str]):
        self.folder = folder
        self.base = Writer(spec.image.format, classes)
        self.writers = [WRITERS[name](spec.image.format, classes, spec) for name in spec.writers]

    def record_path(self, index: int) -> Path:
        return self.folder / "records" / f"{index:06d}.json"

    def write_frame(self, frame: Frame) -> None:
        picture = self.folder / self.base.picture(frame.index)
        if picture.suffix == ".png":
            self.put(self.base.picture(frame.index), _easypbr.encode_png(frame.picture))
        else:
            picture.parent.mkdir(parents=True, exist_ok=True)
            _easypbr.save_image(frame.picture, picture)  # writes beside and renames
        for writer in self.writers:
            for name, data in writer.frame(frame).items():
                self.put(name, data)
        self.put(f"records/{frame.index:06d}.json", (json.dumps(frame.record()) + "\n").encode())

    def put(self, name: str, data: bytes) -> None:
        """The whole file or none: written under another name, then renamed."""
        path = self.folder / name
        temporary = self.folder / "unfinished" / f"{os.getpid()}-{path.name}"
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            temporary.parent.mkdir(exist_ok=True)
            temporary.write_bytes(data)
            os.replace(temporary, path)
        except OSError as error:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)
            raise FileError(f"cannot write {path}: {error.strerror}: free some space or choose another folder, "
                            "then start again: what is finished is kept") from None


def claim(spec: DatasetSpec, folder: Path) -> None:
    """Writes the spec into the folder, or compares it with the one that is there."""
    text = json.dumps(dataclasses.asdict(spec), indent=1) + "\n"
    path = folder / "spec.json"
    if path.exists():
        if path.read_text() != text:
            raise ArgumentError(f"dataset: {folder} holds a set of another spec or count: choose another folder, or remove it")
        return
    FolderWriter(spec, folder, []).put("spec.json", text.encode())
