"""Arrays of other libraries: torch, JAX, CuPy, anything with DLPack. None is imported before it is asked for."""

from collections.abc import Callable

import numpy as np

from .errors import ArgumentError


def converter(name: str) -> Callable:
    """What turns a numpy array into one of the library of this name, without a copy: "numpy" or "torch"."""
    if name == "numpy":
        return lambda array: array
    if name == "torch":
        return _torch().from_numpy
    raise ArgumentError(f"as_: expected 'numpy' or 'torch', got '{name}'")


def _torch():
    try:
        import torch
    except ImportError as error:
        raise ImportError("this needs PyTorch: apt install python3-torch, or pip install torch") from error
    return torch


def _is_torch(what) -> bool:
    return type(what).__module__.split(".")[0] == "torch"


def as_numpy(what):
    """A numpy array of what other libraries hold, without a copy where it lies in this machine's memory: a torch tensor
    of any device, with or without gradients, or anything with DLPack. Other things are returned as they are."""
    if _is_torch(what) and hasattr(what, "detach"):
        return what.detach().cpu().numpy()
    if isinstance(what, np.ndarray) or not hasattr(what, "__dlpack__"):
        return what
    device = what.__dlpack_device__()[0] if hasattr(what, "__dlpack_device__") else 1
    if device in (1, 3):  # The memory of the CPU, pinned or not.
        return np.from_dlpack(what)
    if hasattr(what, "get"):  # CuPy
        return what.get()
    return np.asarray(what)


def eigen2tensor(array, device=None):
    """A torch tensor of a mesh's array (or any other): a copy, so that training may write to it."""
    torch = _torch()
    return torch.from_numpy(np.array(as_numpy(array))).to(device or "cpu")


def tensor2eigen(tensor) -> np.ndarray:
    """A numpy array of a tensor, wherever it lies and whether or not it has a gradient: for mesh.V = tensor2eigen(t)."""
    return np.ascontiguousarray(as_numpy(tensor))
