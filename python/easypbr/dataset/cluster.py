"""Frames of a data set as tasks of Ray, on this machine or on many. What runs where and when, and what becomes of the
tasks of a worker that dies, is Ray's."""

import contextlib
import os
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..errors import ArgumentError, ContextError
from .folder import FolderWriter, keep_memory
from .frames import FrameMaker
from .spec import DatasetSpec
from .writers import outputs

#: How often a task is given to another worker after one has died.
_RETRIES = 3
#: Frames of a task at most; few, so that workers end at nearly the same time and a death costs little.
_LONGEST_RANGE = 16
#: Bytes for objects that tasks hand over: ours are file names, and this is Ray's least.
_STORE = 80 << 20


def find_ray() -> Any:
    """The module. Raises ImportError saying how to get it. Ray's statistics of usage are switched off: nothing is sent."""
    os.environ["RAY_USAGE_STATS_ENABLED"] = "0"
    try:
        import ray
    except ImportError as error:
        raise ImportError(f"dataset: engine ray needs Ray ({error}): pip install 'easypbr[ray]'") from None
    return ray


_worker: tuple[Any, ...] | None = None


def make_range(spec: DatasetSpec, folder: Path, indices: list[int], threads: int, start: Path) -> list[str]:
    """A task: makes those of these frames that are missing; the files that were left out. A worker process keeps its
    renderer for the tasks that follow. `start`: the folder that relative paths of the spec begin in."""
    global _worker
    if start.is_dir():
        os.chdir(start)
    if _worker is None or _worker[0] != (spec, folder):
        keep_memory()
        os.environ["LP_NUM_THREADS"] = os.environ["EASYPBR_THREADS"] = str(threads)
        maker = FrameMaker(spec, outputs(spec, folder))
        _worker = (spec, folder), maker, FolderWriter(spec, folder, maker.classes)
    _, maker, writer = _worker
    for index in indices:
        # Of a task whose worker has died some frames are there.
        if not writer.is_finished(index):
            writer.write_frame(maker.make(index))
    return maker.skipped


def make(spec: DatasetSpec, folder: Path, missing: list[int], workers: int | None, threads: int, address: str | None,
         progress: Any) -> set[str]:
    """Makes the frames that are missing and returns the files that were left out. `threads`: cores of each worker."""
    ray = find_ray()
    own = not ray.is_initialized()
    if own:
        _start(ray, min(workers or max(1, len(os.sched_getaffinity(0)) // threads), len(missing)) * threads, address)
    try:
        cores = int(ray.cluster_resources().get("CPU", 0))
        if cores < threads:
            raise ArgumentError(f"dataset: threads: expected at most the {cores} cores that Ray has, got {threads}")
        task = ray.remote(num_cpus=threads, max_retries=_RETRIES)(make_range)
        step = min(max(1, len(missing) * threads // (4 * cores)), _LONGEST_RANGE)
        start = Path.cwd()
        parts = [missing[first : first + step] for first in range(0, len(missing), step)]
        pending = {task.remote(spec, folder, part, threads, start): len(part) for part in parts}
        try:
            return _collect(ray, pending, progress)
        finally:
            # Ray ends what runs in a cluster that ends. In another's tasks are asked to stop, not forced to: Ray aborts
            # when one that it stops by force ends by itself at that moment.
            for left in () if own else pending:
                ray.cancel(left)
    finally:
        if own:
            ray.shutdown()


@contextlib.contextmanager
def _in_root() -> Iterator[None]:
    """Ray lets workers search the folder that it is started in for modules, before all others: there is none in this one."""
    before = Path.cwd()
    os.chdir("/")
    try:
        yield
    finally:
        os.chdir(before)


def _start(ray: Any, cores: int, address: str | None) -> None:
    quiet = {"log_to_driver": False, "logging_level": "ERROR"}
    if address is None:
        # The address of its own machine needs no network.
        with _in_root():
            ray.init(num_cpus=cores, include_dashboard=False, object_store_memory=_STORE, _node_ip_address="127.0.0.1", **quiet)
        return
    try:
        _reach(address)
        with _in_root():
            ray.init(address=address, **quiet)
    except (OSError, ValueError, RuntimeError, SystemExit) as error:  # Ray ends the process when nobody answers.
        raise ContextError(f"dataset: no cluster of Ray answers at '{address}': start one (ray start --head), or leave the "
                           f"address out: {error}") from None


def _reach(address: str) -> None:
    """Raises OSError at once where Ray would wait for minutes."""
    host, _, port = address.rpartition(":")
    if port.isdigit() and "/" not in host:
        socket.create_connection((host, int(port)), timeout=5).close()


def _collect(ray: Any, pending: dict[str, Any], progress: Any) -> set[str]:
    skipped: set[str] = set()
    missing = sum(pending.values())
    try:
        while pending:
            for done in ray.wait(list(pending))[0]:
                skipped |= set(ray.get(done))
                missing -= pending[done]
                progress.add(pending.pop(done))
    except ray.exceptions.RayTaskError as error:
        raise error.cause from None
    except ray.exceptions.RayError as error:
        raise ArgumentError(f"dataset: workers died {_RETRIES + 1} times; up to {missing} frames are missing: is there enough "
                            f"memory? Try fewer workers ({type(error).__name__})") from None
    return skipped
