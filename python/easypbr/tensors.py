"""Arrays of other libraries: torch, JAX, CuPy, any with DLPack. They are imported on demand."""

from collections.abc import Callable, Iterable
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _easypbr
from .arguments import chosen
from .errors import ArgumentError, ContextError


class SharedArray(np.ndarray[Any, np.dtype[Any]]):
    """A read-only array that a mesh owns, such as mesh.V. Other libraries take it by DLPack: without a copy if they know
    DLPack 1.0, whose flag says that it is read-only, else a copy. What is computed from it is a plain numpy array."""

    # Bindings made with nanobind, such as libigl's, convert only arrays of a class of numpy's to another type of number.
    __module__ = "numpy"

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, out: Any = None, **options: Any) -> Any:
        if out is not None:
            options["out"] = tuple(_plain(array) for array in out)
        return getattr(ufunc, method)(*(_plain(array) for array in inputs), **options)

    def __reduce__(self) -> Any:
        return _plain(self).__reduce__()

    def __dlpack_device__(self) -> tuple[int, Literal[0]]:
        return (1, 0)  # The memory of the CPU.

    def __dlpack__(
        self, *, stream: Any = None, max_version: Any = None, dl_device: Any = None, copy: bool | None = None
    ) -> Any:
        if dl_device is not None and tuple(dl_device) != self.__dlpack_device__():
            raise BufferError(f"a mesh's array is in the memory of the CPU, device (1, 0): got device {tuple(dl_device)}")
        knows_readonly = max_version is not None and max_version[0] >= 1
        if self.flags.writeable:
            return _plain(self).__dlpack__(stream=stream)
        if knows_readonly and not copy:
            return _easypbr._dlpack_of(_plain(self)).__dlpack__(max_version=max_version)
        if copy is False:
            raise BufferError("a mesh's array is read-only, which DLPack before 1.0 cannot say: expected copy=None or True")
        return _plain(self).copy().__dlpack__(stream=stream)


def _plain(array: Any) -> Any:
    return array.view(np.ndarray) if isinstance(array, SharedArray) else array


def converter(name: str, device: str = "cpu") -> Callable[..., Any]:
    """A function from numpy arrays to those of "numpy" or "torch", without a copy."""
    if chosen("as_", name, ("numpy", "torch")) == "numpy":
        if device != "cpu":
            raise ArgumentError(f"device: numpy's arrays are the CPU's: expected as_='torch' with device '{device}'")
        return lambda array: array
    return _torch().from_numpy


def check_device(device: str) -> Any:
    """The torch device of this name. Raises ArgumentError for an invalid name, ContextError if PyTorch does not see the
    device."""
    torch = _torch()
    try:
        found = torch.device(device)
    except RuntimeError as error:
        raise ArgumentError(f"device: expected 'cpu', 'cuda' or 'cuda:1', got '{device}': {error}") from None
    if found.type == "cuda":
        count = torch.cuda.device_count() if torch.cuda.is_available() else 0
        if (found.index or 0) >= count:
            built = "" if torch.version.cuda else ", and is built without CUDA"
            raise ContextError(f"device '{device}': PyTorch sees {count} CUDA devices{built}: choose another, or 'cpu'")
    return found


def from_dlpack(capsule: Any) -> Any:
    """A torch tensor from a DLPack capsule, without a copy."""
    return _torch().utils.dlpack.from_dlpack(capsule)


def layers_of_targets(raw: dict[str, Any], names: Iterable[str], from_dlpack: Callable[..., Any]) -> dict[str, Any]:
    """Layers by name as GPU tensors, computed from the targets; `raw` is the result of cuda_layers(). Without semantic_id where
    elements have labels of their own."""
    torch = _torch()
    targets = {name: from_dlpack(target) for name, target in raw["targets"].items()}
    result = {name: targets[name] if name == "color" else targets[name].float() for name in names if name in ("color", "hdr")}
    if "depth" not in targets:
        return result
    inverse = targets["depth"][..., 0]
    seen = inverse > 0
    near, far = raw["near"], raw["far"]
    depth = far + (near - far) * inverse if raw["orthographic"] else near / inverse

    def shown(values: Any) -> Any:
        return torch.where(seen if values.dim() == 2 else seen[..., None], values, torch.zeros_like(values))

    def points() -> Any:
        """In the camera's frame, OpenCV's axes; in double precision, as on the CPU."""
        height, width = inverse.shape
        steps = {"dtype": torch.float64, "device": inverse.device}
        x = (2 * (torch.arange(width, **steps) + 0.5) / width - 1 + raw["ray_shift"][0]) * raw["ray_scale"][0]
        y = (1 - 2 * (torch.arange(height, **steps) + 0.5) / height + raw["ray_shift"][1]) * raw["ray_scale"][1]
        z = depth.double()
        across, down = torch.meshgrid(x, y, indexing="xy")
        return torch.stack([across, down, z] if raw["orthographic"] else [across * z, down * z, z], -1)

    def distance() -> Any:
        return depth if raw["orthographic"] else points().norm(dim=-1).float()

    def position() -> Any:
        return (points() @ T_world_cam[:3, :3].T + T_world_cam[:3, 3]).float()

    def by_object(values: list[int]) -> Any:
        id_ = torch.where(seen, targets["id"][..., 0], torch.zeros_like(targets["id"][..., 0])).long()
        return torch.as_tensor(values, dtype=torch.int32, device=inverse.device)[id_]

    def fractions(name: str) -> Any:  # 16 bits without a sign
        return (targets[name].int() & 0xFFFF).float()

    def normal() -> Any:
        return _octahedral(torch, fractions("normal") / 32767.5 - 1)

    T_world_cam = torch.as_tensor(raw["T_world_cam"], dtype=torch.float64, device=inverse.device)
    make = {
        "depth": lambda: depth,
        "distance": distance,
        "position": position,
        "normal_world": normal,
        "normal_camera": lambda: normal() @ T_world_cam[:3, :3].float(),
        "albedo": lambda: fractions("albedo")[..., :3] / 65535,
        "metallic": lambda: targets["material"][..., 0].float() / 255,
        "roughness": lambda: targets["material"][..., 1].float() / 255,
        "instance_id": lambda: by_object(raw["instance_ids"]),
    }
    if raw["semantic_ids"]:
        make["semantic_id"] = lambda: by_object(raw["semantic_ids"])
    return result | {name: shown(make[name]()).contiguous() for name in names if name in make}


def _octahedral(torch: Any, p: Any) -> Any:
    """Unit vectors from octahedral coordinates (Cigolle et al. 2014)."""
    z = 1 - p.abs().sum(-1, keepdim=True)
    fold = (-z).clamp(min=0)
    return torch.nn.functional.normalize(torch.cat([p - torch.where(p >= 0, fold, -fold), z], -1), dim=-1)


def _torch() -> Any:
    try:
        import torch
    except ImportError as error:
        raise ImportError("this needs PyTorch: apt install python3-torch, or pip install torch") from error
    return torch


def _is_torch(what: Any) -> bool:
    return type(what).__module__.split(".")[0] == "torch"


#: Types that are told at once: lists of faces have many of them.
_NO_ARRAYS = frozenset((int, float, str, list, tuple))


def is_array(what: Any) -> bool:
    """Whether this is an array of numpy or of another library, by the protocols that numpy takes or by CUDA's."""
    if type(what) in _NO_ARRAYS or isinstance(what, (np.generic, type)):
        return False
    return isinstance(what, np.ndarray) or any(
        hasattr(what, name) for name in ("__array__", "__array_interface__", "__dlpack__", "__cuda_array_interface__")
    )


def as_numpy(what: Any) -> Any:
    """A numpy array of an array of another library, without a copy if it is in host memory: a torch tensor of any
    device, with or without gradients, or any object that is_array() tells. bfloat16 and other short floats that numpy lacks
    become float32, and masked values NaN. Other objects are returned unchanged, numpy's scalars too. Raises ArgumentError for
    arrays of other libraries that numpy does not take, and for masked values that are no floats. Structured arrays keep their
    masks."""
    if _is_torch(what) and hasattr(what, "detach"):
        return _of_tensor(what)
    if isinstance(what, np.ma.MaskedArray) and what.dtype.names is None:
        return _unmasked(what)
    if isinstance(what, np.ndarray):
        return _known(what)
    if not is_array(what):
        return what
    if not hasattr(what, "__dlpack__"):
        return _by_numpy(what)
    device = what.__dlpack_device__()[0] if hasattr(what, "__dlpack_device__") else 1
    if device in (1, 3):  # The memory of the CPU, pinned or not.
        try:
            return np.from_dlpack(what)
        except (BufferError, RuntimeError, TypeError) as error:
            if not hasattr(what, "__array__"):
                kind = type(what).__qualname__
                raise ArgumentError(f"a {kind}: expected numbers that numpy takes by DLPack: {error}") from error
    if hasattr(what, "get"):  # CuPy
        return what.get()
    return _by_numpy(what)


def _by_numpy(what: Any) -> NDArray[Any]:
    try:
        return _known(np.asarray(what))
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"a {type(what).__qualname__}: expected numbers that numpy takes: {error}") from error


def array_of(what: Any, name: str) -> NDArray[Any]:
    """as_numpy() of what may be nested lists or a list of arrays, too. Raises ArgumentError, which begins with the name, for
    rows of different lengths."""
    try:
        if isinstance(what, (tuple, list)) and len(what) > 0 and is_array(what[0]):
            return np.asarray([as_numpy(row) for row in what])
        return np.asarray(as_numpy(what))
    except ArgumentError:
        raise
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"{name}: expected an array of numbers: {error}") from error


def rows_of(given: "tuple[Any, ...] | list[Any]", name: str) -> NDArray[Any] | list[NDArray[Any]]:
    """array_of() where all rows have the same shape; else an array for each."""
    if all(isinstance(row, (tuple, list)) for row in given) and len({len(row) for row in given}) == 1:
        try:
            array = np.asarray(given)
            if array.ndim == 2 and array.dtype.kind in "iuf":
                return array
        except (TypeError, ValueError):
            pass  # They hold more than numbers: below an error names the row's.
    rows = [row if _is_plain(row) else array_of(row, name) for row in given]
    return rows if len({row.shape for row in rows}) > 1 else np.asarray(rows)


def _is_plain(what: Any) -> bool:
    """Whether as_numpy() has nothing to convert."""
    return type(what) is np.ndarray and what.dtype.kind in "iuf"


def _of_tensor(tensor: Any) -> NDArray[Any]:
    try:
        tensor = tensor.detach().cpu()
        is_short = tensor.is_floating_point() and str(tensor.dtype) not in ("torch.float16", "torch.float32", "torch.float64")
        array: NDArray[Any] = (tensor.float() if is_short else tensor).numpy()
        return array
    except (TypeError, RuntimeError) as error:
        raise ArgumentError(f"a tensor of {tensor.dtype}, {tensor.layout}: expected numbers that numpy has: {error}") from error


def _unmasked(array: Any) -> NDArray[Any]:
    count = int(np.count_nonzero(np.ma.getmaskarray(array)))
    if count == 0:
        return np.ma.getdata(array)
    if array.dtype.kind != "f":
        raise ArgumentError(f"a masked array of {array.dtype} with {count} masked values: expected floats, whose masked values become "
                            "NaN, as of array.astype(float), or array.filled(value)")
    filled: NDArray[Any] = array.filled(np.nan)
    return filled


def _known(array: NDArray[Any]) -> NDArray[Any]:
    """Numbers of the package ml_dtypes, which JAX uses, as float32."""
    return array.astype(np.float32) if array.dtype.type.__module__ == "ml_dtypes" else array


def eigen2tensor(array: Any, device: str | None = None) -> Any:
    """A torch tensor of an array of a mesh (or any other): a copy, so that training may write to it."""
    torch = _torch()
    return torch.from_numpy(np.array(as_numpy(array))).to(check_device(device or "cpu"))


def tensor2eigen(tensor: Any) -> NDArray[Any]:
    """A numpy array of a tensor of any device, with or without gradients: mesh.V = tensor2eigen(t)."""
    return np.ascontiguousarray(as_numpy(tensor))
