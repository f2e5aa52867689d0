"""The files that a data set is made of: what they were when it was begun, and whether they still are."""

import hashlib
import os
import stat
from collections.abc import Collection, Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from .tables import DatasetTables

#: Size in bytes, time of the last change in nanoseconds, and SHA-256 of a file; None where there is no file that can be read.
State = dict[str, Any] | None
#: By the file's absolute name.
States = dict[str, State]


def absolute_file(file: str) -> str:
    """The file's name from the root on, by a folder without symbolic links."""
    folder, name = os.path.split(os.path.abspath(file))
    return os.path.join(os.path.realpath(folder), name)


def source_files(spec: DatasetTables, outputs: Collection[Path]) -> list[str]:
    """The absolute names of the files that a spec names, by folders and patterns too; not of those that a mesh names in turn.
    `outputs` as ObjectSpec.files(), which says what is raised."""
    files = [file for entry in spec.objects for file in entry.files(outputs)]
    if spec.surroundings.source:
        files.append(spec.surroundings.source)
    if spec.background.mode in ("environment", "image"):
        files += spec.background.files
    return sorted({absolute_file(file) for file in files})


def states_of(files: Iterable[str], known: States) -> States:
    """How the files are. The hash of one whose size and time are the known ones is the known one: it is not read."""
    names = list(files)
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:  # Hashes are made and files read without the GIL.
        return dict(zip(names, pool.map(lambda file: _state(file, known.get(file)), names), strict=True))


def are_states(values: object) -> bool:
    """Whether these are States, as JSON holds them."""
    return isinstance(values, dict) and all(state is None or _is_state(state) for state in values.values())


def _is_state(state: object) -> bool:
    return (isinstance(state, dict) and isinstance(state.get("size"), int) and isinstance(state.get("mtime_ns"), int)
            and isinstance(state.get("sha256"), str))


def _state(file: str, known: State) -> State:
    try:
        status = os.stat(file)
        if not stat.S_ISREG(status.st_mode):
            return None  # A pipe can be read but once.
        size, time = status.st_size, status.st_mtime_ns
        if known is not None and (known["size"], known["mtime_ns"]) == (size, time):
            return known
        return {"size": size, "mtime_ns": time, "sha256": _sha256(file)}
    except OSError:
        return None


def _sha256(file: str) -> str:
    digest = hashlib.sha256()
    with open(file, "rb", buffering=0) as stream:
        while part := stream.read(1 << 20):
            digest.update(part)
    return digest.hexdigest()


def first_difference(known: States, found: States) -> str:
    """What tells the files that a set was begun with from those that are there; empty when they are the same."""
    for file in sorted({*known, *found}):
        before, now = known.get(file), found.get(file)
        if now is None and before is not None:
            return f"{file}, a file that the set was begun with, is gone or cannot be read"
        if file not in known or (before is None and now is not None):
            return f"{file} is none of the files that the set was begun with: it has been added"
        if before is not None and now is not None and before["sha256"] != now["sha256"]:
            return f"{file} is not the file that the set was begun with: its content has changed"
    return ""
