"""MeshLoader: prefetches meshes and clouds for training."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from . import _easypbr
from .arguments import chosen
from .errors import Error
from .tensors import check_device, eigen2tensor

#: What a sample holds when no transform is given: those of these arrays that the mesh has.
_ARRAYS = ("V", "N", "C", "F", "L", "I", "UV")


class MeshLoader:
    """An iterable over files: meshes and clouds are read on native threads, without the GIL, in order, at most
    `prefetch` of them ahead. Also a torch IterableDataset if torch is imported: DataLoader(loader, batch_size=None).

    `transform(mesh)` makes a sample of a Mesh; without it a sample is a dict of torch tensors of the mesh's arrays
    (V, N, C, F, L, I, UV). Tensors in the result are moved to `device`. A file that cannot be read raises in place of
    its sample, with its name; `on_error="skip"` skips it. SemanticKITTI's scans (.bin) come with their .label
    files."""

    paths: list[str]
    workers: int
    prefetch: int

    def __init__(
        self,
        paths: Iterable[str | os.PathLike[str]],
        transform: Callable[..., Any] | None = None,
        workers: int = 2,
        prefetch: int = 4,
        device: str = "cpu",
        on_error: str = "raise",
    ) -> None:
        on_error = chosen("on_error", on_error, ("raise", "skip"))
        if device != "cpu":
            check_device(device)
        self.paths = [os.fspath(path) for path in paths]
        self.transform = transform
        self.workers, self.prefetch = workers, prefetch
        self.device = device
        self.on_error = on_error

    def __new__(cls, *arguments: Any, **options: Any) -> "MeshLoader":
        return super().__new__(_with_torch(cls))

    def __reduce__(self) -> tuple[Any, ...]:
        # The class that is derived from torch's too has no name to be found by.
        cls = next(cls for cls in type(self).__mro__ if "_is_derived" not in vars(cls))
        return _restored, (cls, self.__dict__)

    def __len__(self) -> int:
        return len(self.paths)

    def __iter__(self) -> Iterator[Any]:
        queue = _easypbr.MeshQueue(_own_share(self.paths), self.workers, self.prefetch)
        for _ in range(len(queue)):
            try:
                mesh = queue.next()
            except Error:
                if self.on_error == "raise":
                    raise
                continue
            if mesh is None:
                return
            yield _moved(_tensors(mesh) if self.transform is None else self.transform(mesh), self.device)


def _with_torch(cls: type) -> type:
    """The class, derived from torch's IterableDataset too if torch has been imported: only then can it matter."""
    data = getattr(sys.modules.get("torch"), "utils", None)
    if data is None or not hasattr(data, "data") or issubclass(cls, data.data.IterableDataset):
        return cls
    return type(cls.__name__, (cls, data.data.IterableDataset), {"__module__": cls.__module__, "_is_derived": True})


def _restored(cls: type[MeshLoader], members: dict[str, Any]) -> MeshLoader:
    """A loader as it was sent to another process."""
    loader = cls.__new__(cls)
    loader.__dict__.update(members)
    return loader


def _own_share(paths: list[Any]) -> list[Any]:
    """The files of this worker process of a DataLoader."""
    data = getattr(getattr(sys.modules.get("torch"), "utils", None), "data", None)
    worker = data.get_worker_info() if data is not None else None
    return paths if worker is None else paths[worker.id :: worker.num_workers]


def _tensors(mesh: "_easypbr.Mesh") -> dict[str, Any]:
    if mesh.children:
        mesh = mesh.merge()  # all nodes of a hierarchy
    arrays = {name: getattr(mesh, name) for name in _ARRAYS}
    return {name: eigen2tensor(array) for name, array in arrays.items() if len(array)}


def _moved(sample: Any, device: str) -> Any:
    if device == "cpu":
        return sample
    if isinstance(sample, dict):
        return {name: _moved(value, device) for name, value in sample.items()}
    if isinstance(sample, (tuple, list)):
        return type(sample)(_moved(value, device) for value in sample)
    if not hasattr(sample, "to"):
        return sample
    # From pinned memory the copy runs while the next sample is made.
    pinned = sample.pin_memory() if device.startswith("cuda") and hasattr(sample, "pin_memory") else sample
    return pinned.to(device, non_blocking=True)
