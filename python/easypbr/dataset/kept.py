"""What is read from files and kept in memory, up to a number of bytes."""

from collections import OrderedDict
from typing import Generic, TypeVar

from .._easypbr import Material, Mesh

Value = TypeVar("Value")


class Kept(Generic[Value]):
    """Values by key, of `most` bytes in all: the one that was asked for the longest ago is given up first, the last one never."""

    def __init__(self, most: int) -> None:
        self._most, self._bytes = most, 0
        self._values: OrderedDict[object, tuple[Value, int]] = OrderedDict()

    def get(self, key: object) -> Value | None:
        if key not in self._values:
            return None
        self._values.move_to_end(key)
        return self._values[key][0]

    def put(self, key: object, value: Value, size: int) -> Value:
        """Keeps a value of `size` bytes under a key that is not kept."""
        self._values[key] = value, size
        self._bytes += size
        while self._bytes > self._most and len(self._values) > 1:
            self._bytes -= self._values.popitem(last=False)[1][1]
        return value


_ARRAYS = ("V", "N", "C", "UV", "T", "B", "F", "E", "L", "I", "scales", "rotations", "opacities", "sh")
_TEXTURES = tuple(name for name in dir(Material) if name.endswith("_texture"))


def bytes_of(mesh: Mesh) -> int:
    """Bytes of the arrays and textures of a mesh and its children."""
    found: dict[int, int] = {}
    _collect(mesh, found)
    return sum(found.values())


def _collect(mesh: Mesh, found: dict[int, int]) -> None:
    """Bytes by their address: materials share textures."""
    arrays = [getattr(mesh, name) for name in _ARRAYS] + list(mesh.scalars.values())
    for material in mesh.materials:
        arrays += [image for image in (getattr(material, name) for name in _TEXTURES) if image is not None]
    found.update({array.__array_interface__["data"][0]: array.nbytes for array in arrays if array.nbytes})
    for child in mesh.children:
        _collect(child, found)
