"""Making a data set: frames by worker processes, resumable, the same bytes however often it is killed."""

import concurrent.futures
import dataclasses
import json
import multiprocessing
import os
import sys
import time
from pathlib import Path

from .. import _easypbr
from ..errors import ArgumentError, FileError
from .frames import Frame, FrameMaker
from .report import contact_sheet, statistics_page
from .spec import DatasetSpec
from .writers import WRITERS, Writer

#: How often a frame is given to another worker after one has died.
_RETRIES = 3


class FolderWriter:
    """All files of a set. A frame's record is written last: a frame without it does not count."""

    def __init__(self, spec: DatasetSpec, folder: Path, classes: list[str]):
        self.folder = folder
        self.base = Writer(spec.image.format, classes)
        self.writers = [WRITERS[name](spec.image.format, classes) for name in spec.writers]

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
            temporary.unlink(missing_ok=True)
            raise FileError(f"cannot write {path}: {error.strerror}: free some space or choose another folder, "
                            "then start again: what is finished is kept") from None


def generate(spec: DatasetSpec, folder, workers: int | None = None, quiet: bool = True) -> dict:
    """Makes the data set in a folder, or what is missing of it, and returns its statistics. Worker processes are started
    for more than one worker, so scripts need the usual `if __name__ == "__main__":`. Raises ArgumentError when the folder
    holds another set, and what drawing and writing raise."""
    spec.check()
    folder = Path(folder)
    if workers is not None and workers < 1:
        raise ArgumentError(f"dataset: workers: expected 1 or more, got {workers}")
    _claim(spec, folder)
    for left in (folder / "unfinished").glob("*") if (folder / "unfinished").exists() else ():
        left.unlink()
    missing = [i for i in range(spec.count) if not (folder / "records" / f"{i:06d}.json").exists()]
    progress = _Progress(spec.count, spec.count - len(missing), quiet)
    workers = min(workers or max(1, len(os.sched_getaffinity(0)) // 2), max(1, len(missing)))
    skipped = _make_here(spec, folder, missing, progress) if workers == 1 else _make_apart(spec, folder, missing, workers, progress)
    progress.end()
    statistics = _finish(spec, folder)
    statistics["skipped"] = sorted(skipped)
    return statistics


def _claim(spec: DatasetSpec, folder: Path) -> None:
    """Writes the spec into the folder, or compares it with the one that is there."""
    text = json.dumps(dataclasses.asdict(spec), indent=1) + "\n"
    path = folder / "spec.json"
    if path.exists():
        if path.read_text() != text:
            raise ArgumentError(f"dataset: {folder} holds a set of another spec or count: choose another folder, or remove it")
        return
    FolderWriter(spec, folder, []).put("spec.json", text.encode())


def _make_here(spec, folder, missing, progress) -> set[str]:
    maker = FrameMaker(spec)
    writer = FolderWriter(spec, folder, maker.classes)
    for index in missing:
        writer.write_frame(maker.make(index))
        progress.add()
    return set(maker.skipped)


_worker: tuple[FrameMaker, FolderWriter] | None = None


def _begin_worker(spec: DatasetSpec, folder: Path, cores: list[int]) -> None:
    """Each worker keeps to its part of the cores."""
    global _worker
    number = multiprocessing.current_process()._identity[-1] - 1
    share = max(1, len(cores) // max(1, int(os.environ.get("EASYPBR_DATASET_WORKERS", "1"))))
    own = [cores[(number * share + k) % len(cores)] for k in range(share)]
    os.sched_setaffinity(0, own)
    os.environ["LP_NUM_THREADS"] = str(share)
    maker = FrameMaker(spec)
    _worker = maker, FolderWriter(spec, folder, maker.classes)


def _make_one(index: int) -> list[str]:
    maker, writer = _worker
    writer.write_frame(maker.make(index))
    return maker.skipped


def _make_apart(spec, folder, missing, workers, progress) -> set[str]:
    skipped: set[str] = set()
    rest = set(missing)
    os.environ["EASYPBR_DATASET_WORKERS"] = str(workers)
    for attempt in range(_RETRIES + 1):
        pool = concurrent.futures.ProcessPoolExecutor(
            workers, multiprocessing.get_context("spawn"), _begin_worker, (spec, folder, sorted(os.sched_getaffinity(0)))
        )
        try:
            with pool:
                futures = {pool.submit(_make_one, index): index for index in sorted(rest)}
                try:
                    for future in concurrent.futures.as_completed(futures):
                        skipped |= set(future.result())
                        rest.discard(futures[future])
                        progress.add()
                except BaseException:
                    pool.shutdown(wait=False, cancel_futures=True)
                    raise
            return skipped
        except concurrent.futures.process.BrokenProcessPool:
            rest = {index for index in rest if not (folder / "records" / f"{index:06d}.json").exists()}
            if attempt == _RETRIES:
                raise ArgumentError(f"dataset: workers died {attempt + 1} times; {len(rest)} frames are missing: "
                                    "is there enough memory? Try fewer workers") from None
    return skipped


def _finish(spec: DatasetSpec, folder: Path) -> dict:
    """Files of the whole set, made of the records in their order."""
    records = [json.loads((folder / "records" / f"{i:06d}.json").read_text()) for i in range(spec.count)]
    classes: list[str] = []
    for entry in spec.objects:
        if not entry.distractor and FrameMaker.class_of(entry) not in classes:
            classes.append(FrameMaker.class_of(entry))
    writer = FolderWriter(spec, folder, classes)
    for format_writer in writer.writers:
        for name, data in format_writer.finish(records, folder).items():
            writer.put(name, data)
    page, statistics = statistics_page(records, classes)
    writer.put("statistics.html", page.encode())
    writer.put("contact_sheet.png", _easypbr.encode_png(contact_sheet(records, folder, writer.base)))
    if (folder / "unfinished").exists():
        (folder / "unfinished").rmdir()
    return statistics


class _Progress:
    """A line on the error stream: what is done, images per second, time left."""

    def __init__(self, total: int, done: int, quiet: bool):
        self.total, self.done, self.quiet = total, done, quiet
        self.start, self.first, self.shown = time.monotonic(), done, 0.0

    def add(self) -> None:
        self.done += 1
        now = time.monotonic()
        if self.quiet or (now - self.shown < 0.2 and self.done < self.total):
            return
        self.shown = now
        rate = (self.done - self.first) / max(now - self.start, 1e-9)
        left = (self.total - self.done) / rate
        bar = "#" * (30 * self.done // self.total)
        sys.stderr.write(f"\r[{bar:<30}] {self.done}/{self.total}  {rate:.1f} images/s  {left:.0f} s left ")
        sys.stderr.flush()

    def end(self) -> None:
        if not self.quiet and self.done > self.first:
            sys.stderr.write("\n")
