"""Making a data set: frames by worker processes, resumable, the same bytes however often it is killed."""

import concurrent.futures
import contextlib
import ctypes
import json
import multiprocessing
import multiprocessing.resource_tracker
import os
import signal
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from .. import _easypbr
from ..errors import ArgumentError, Error
from . import cluster
from .folder import FolderWriter, check_sources, claim, keep_memory, locked
from .frames import FrameMaker
from .report import contact_sheet, statistics_page
from .spec import DatasetSpec
from .writers import outputs

#: How often a frame is given to another worker after one has died.
_RETRIES = 3


def generate(
    spec: DatasetSpec,
    folder: str | os.PathLike[str],
    workers: int | None = None,
    quiet: bool = True,
    engine: str = "local",
    address: str | None = None,
    threads: int | None = None,
) -> dict[str, Any]:
    """Makes the data set in a folder, or what is missing of it, and returns its statistics. Worker processes are started
    for more than one worker, so scripts need the usual `if __name__ == "__main__":`. `engine`: "local", or "ray": frames
    are tasks of Ray (pip install 'easypbr[ray]'), on this machine or on the cluster at `address`, whose machines share
    the folder. `threads`: cores of each worker. Raises ArgumentError when the folder holds another set or one whose files
    have changed since, or another process generates into it, ContextError when no cluster answers, and what drawing and
    writing raise."""
    spec.check()
    folder = Path(folder).absolute()
    check_engine(engine, address, workers, threads)
    if engine == "ray":
        cluster.find_ray()  # Before anything is written.
    with locked(folder):
        return _generate(spec, folder, workers, quiet, engine, address, threads)


def _generate(spec: DatasetSpec, folder: Path, workers: int | None, quiet: bool, engine: str, address: str | None,
              threads: int | None) -> dict[str, Any]:
    claim(spec, folder)
    writer = FolderWriter(spec, folder, [])
    writer.remove_unfinished()
    missing = _missing(spec, folder, range(spec.count))
    if missing or any(format_writer.reads_sources for format_writer in writer.writers):
        check_sources(spec, folder, begun=len(missing) < spec.count)
    progress = _Progress(spec.count, spec.count - len(missing), quiet)
    if not missing:
        skipped: set[str] = set()
    elif engine == "ray":
        skipped = cluster.make(spec, folder, missing, workers, threads or 1, address, progress)
    else:
        workers = min(workers or max(1, len(os.sched_getaffinity(0)) // (threads or 2)), len(missing))
        if workers == 1 and threads is None:
            skipped = _make_here(spec, folder, missing, progress)
        else:
            skipped = _make_apart(spec, folder, missing, workers, threads, progress)
    progress.end()
    statistics = _finish(spec, folder)
    statistics["skipped"] = sorted(skipped)
    return statistics


def _missing(spec: DatasetSpec, folder: Path, indices: Iterable[int]) -> list[int]:
    """Those of these frames that are to be made."""
    writer = FolderWriter(spec, folder, [])
    return [index for index in indices if not writer.is_finished(index)]


def check_engine(engine: str, address: str | None, workers: int | None, threads: int | None) -> None:
    """Raises ArgumentError for what cannot be, or does not go together."""
    if engine not in ("local", "ray"):
        raise ArgumentError(f"dataset: engine: expected local or ray, got '{engine}'")
    for name, value in (("workers", workers), ("threads", threads)):
        if value is not None and value < 1:
            raise ArgumentError(f"dataset: {name}: expected 1 or more, got {value}")
    if address is not None and engine != "ray":
        raise ArgumentError("dataset: address: it is of a cluster of Ray: expected engine ray with it")
    if address is not None and workers is not None:
        raise ArgumentError("dataset: workers: a cluster starts as many as it has cores for; expected none with an address")


@contextlib.contextmanager
def _starting_thread() -> Iterator[None]:
    """Raises Error where the system gives no thread, for which Python has no class of its own."""
    try:
        yield
    except RuntimeError as error:
        if "can't start new thread" not in str(error):
            raise
        raise Error("dataset: cannot start a thread (see the limits of processes: ulimit -u, pids.max)") from None


def _make_here(spec: DatasetSpec, folder: Path, missing: list[int], progress: "_Progress") -> set[str]:
    """Each frame is written while the next one is drawn: compressing pictures keeps a single core busy."""
    maker = FrameMaker(spec, outputs(spec, folder))
    writer = FolderWriter(spec, folder, maker.classes)

    def finish(frames: list[concurrent.futures.Future[Any]]) -> None:
        for frame in frames:
            frame.result()
            progress.add()

    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        written: list[concurrent.futures.Future[Any]] = []
        for index in missing:
            frame = maker.make(index)
            finish(written)
            with _starting_thread():
                written = [pool.submit(writer.write_frame, frame)]
        finish(written)
    return set(maker.skipped)


_worker: tuple[FrameMaker, FolderWriter] | None = None


def _end_with_parent() -> None:
    """Linux kills this process when its parent dies: one that waits for frames would wait for ever."""
    pr_set_pdeathsig = 1
    parent = multiprocessing.parent_process()
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGKILL)
    if parent is not None and os.getppid() != parent.pid:
        os._exit(1)  # It has died before.


def _begin_worker(spec: DatasetSpec, folder: Path, cores: list[int], share: int) -> None:
    """Each worker keeps to its part of the cores, and ends with the process that started it."""
    global _worker
    _end_with_parent()
    number = multiprocessing.current_process()._identity[-1] - 1
    keep_memory()
    own = [cores[(number * share + k) % len(cores)] for k in range(share)]
    os.sched_setaffinity(0, own)
    os.environ["LP_NUM_THREADS"] = str(share)
    maker = FrameMaker(spec, outputs(spec, folder))
    _worker = maker, FolderWriter(spec, folder, maker.classes)


def _make_one(index: int) -> list[str]:
    assert _worker is not None  # _begin_worker() has run.
    maker, writer = _worker
    writer.write_frame(maker.make(index))
    return maker.skipped


@contextlib.contextmanager
def _starting_workers() -> Iterator[None]:
    """Processes that start meanwhile search no current folder for modules before they have taken over this process's
    sys.path (from Python 3.11 on), and leave Ctrl-C, which a terminal sends to all, to this one."""
    before = os.environ.get("PYTHONSAFEPATH")
    os.environ["PYTHONSAFEPATH"] = "1"
    multiprocessing.resource_tracker.ensure_running()  # Its start would let the signal in again.
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        if before is None:
            del os.environ["PYTHONSAFEPATH"]
        else:
            os.environ["PYTHONSAFEPATH"] = before


@contextlib.contextmanager
def _ended_by_sigterm() -> Iterator[None]:
    """SIGTERM ends this process by SystemExit, so that workers end and what is shared with them is given back. A handler of
    the program's own stays."""
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        yield
        return

    def end(*_: object) -> None:
        raise SystemExit(128 + signal.SIGTERM)  # as shells count it

    signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _make_apart(spec: DatasetSpec, folder: Path, missing: list[int], workers: int, threads: int | None,
                progress: "_Progress") -> set[str]:
    skipped: set[str] = set()
    rest = set(missing)
    cores = sorted(os.sched_getaffinity(0))
    share = min(threads or max(1, len(cores) // workers), len(cores))
    for attempt in range(_RETRIES + 1):
        try:
            with contextlib.ExitStack() as stack:
                with _starting_workers():
                    context = multiprocessing.get_context("spawn")
                    pool = stack.enter_context(
                        concurrent.futures.ProcessPoolExecutor(workers, context, _begin_worker, (spec, folder, cores, share)))
                    futures = {pool.submit(_make_one, index): index for index in sorted(rest)}
                processes = list((pool._processes or {}).values())
                try:
                    with _ended_by_sigterm():
                        for future in concurrent.futures.as_completed(futures):
                            skipped |= set(future.result())
                            rest.discard(futures[future])
                            progress.add()
                except BaseException:
                    pool.shutdown(wait=False, cancel_futures=True)
                    for process in processes:
                        process.terminate()  # Sets survive it, and a frame may take long.
                    raise
            return skipped
        except concurrent.futures.process.BrokenProcessPool:
            rest = set(_missing(spec, folder, rest))
            if attempt == _RETRIES:
                raise ArgumentError(f"dataset: workers died {attempt + 1} times; {len(rest)} frames are missing: "
                                    "is there enough memory? Try fewer workers") from None
    return skipped


def _finish(spec: DatasetSpec, folder: Path) -> dict[str, Any]:
    """Files of the whole set, made of the records in their order."""
    records = [json.loads((folder / "records" / f"{i:06d}.json").read_text()) for i in range(spec.count)]
    classes = spec.class_names()
    writer = FolderWriter(spec, folder, classes)
    for format_writer in writer.writers:
        for name, data in format_writer.finish(records, folder).items():
            writer.put(name, data)
    page, statistics = statistics_page(records, classes)
    writer.put("statistics.html", page.encode())
    writer.put("contact_sheet.png", _easypbr.encode_png(contact_sheet(records, folder, writer.base)))
    writer.remove_unfinished()  # A worker that died may have left files.
    return statistics


class _Progress:
    """A line on a terminal's error stream: what is done, images per second, time left."""

    def __init__(self, total: int, done: int, quiet: bool) -> None:
        self.total, self.done = total, done
        self.quiet = quiet or not sys.stderr.isatty()
        self.start, self.first, self.shown = time.monotonic(), done, 0.0

    def add(self, count: int = 1) -> None:
        self.done += count
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
