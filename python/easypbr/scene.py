"""Scene: named meshes, lights and an environment map."""

import types
from collections.abc import Callable
from typing import Any, Concatenate, Generic, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _easypbr
from .conversions.maker import Maker
from .convert import converted

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


class _OnDefaultScene(Generic[Arguments, Result]):
    """A method that acts on the default scene when it is called on the class."""

    __name__: str

    def __init__(self, function: Callable[Concatenate[Any, Arguments], Result]) -> None:
        self.function = function
        self.__doc__, self.__name__ = function.__doc__, function.__name__
        self.__wrapped__ = function

    def __get__(self, instance: "Scene | None", owner: "type[Scene]") -> Callable[Arguments, Result]:
        return types.MethodType(self.function, owner.default() if instance is None else instance)


class Scene:
    """A scene. On the class, `Scene.show(...)` and the other methods act on the default scene."""

    def __init__(self) -> None:
        self._handle = _easypbr.SceneHandle()

    @classmethod
    def _of(cls, handle: "_easypbr.SceneHandle") -> "Scene":
        scene = cls.__new__(cls)
        scene._handle = handle
        return scene

    @classmethod
    def default(cls) -> "Scene":
        """The default scene of a Viewer."""
        return cls._of(_easypbr.default_scene())

    @classmethod
    def demo(cls) -> "Scene":
        """The embedded demo scene."""
        return cls._of(_easypbr.demo_scene())

    @_OnDefaultScene
    def show(self, what: Any, name: str | None = None, strict: bool = False) -> "_easypbr.Mesh":
        """Shows a mesh (or whatever as_mesh() takes) under a name; the same name again replaces it. For a path, the
        lights of the file are added too, as "name/light". `strict` as for as_mesh()."""
        return _show(self, what, name, strict)[0]

    @_OnDefaultScene
    def get(self, name: str) -> "_easypbr.Mesh":
        """The mesh shown under this name."""
        return self._handle.get(name)

    @_OnDefaultScene
    def remove(self, name: str) -> None:
        """Removes a mesh."""
        self._handle.remove(name)

    @_OnDefaultScene
    def clear(self) -> None:
        """Removes all meshes and lights and the environment."""
        self._handle.clear()

    @_OnDefaultScene
    def hide(self, name: str, hidden: bool = True) -> None:
        """Hides (or shows again) a mesh without removing it."""
        self._handle.hide(name, hidden)

    @_OnDefaultScene
    def names(self) -> list[str]:
        """Names of the meshes, in order."""
        return self._handle.names()

    @_OnDefaultScene
    def contains(self, name: str) -> bool:
        """Whether a mesh is shown under this name."""
        return self._handle.contains(name)

    @_OnDefaultScene
    def set_light(self, name: str, light: "_easypbr.Light") -> None:
        """Adds or replaces a light."""
        self._handle.set_light(name, light)

    @_OnDefaultScene
    def light(self, name: str) -> "_easypbr.Light":
        """A copy of the light with this name."""
        return self._handle.light(name)

    @_OnDefaultScene
    def remove_light(self, name: str) -> None:
        """Removes a light."""
        self._handle.remove_light(name)

    @_OnDefaultScene
    def light_names(self) -> list[str]:
        """Names of the lights of the scene."""
        return self._handle.light_names()

    @property
    def origin(self) -> NDArray[Any]:
        """Where the scene's frame has its origin, in the coordinates that meshes were given (mesh.offset + mesh.V):
        cameras, lights and poses are relative to it. It is the offset of the mesh that was shown first, taken when
        something is drawn for the first time; so it is zero unless that mesh lies far from zero."""
        return self._handle.origin

    @origin.setter
    def origin(self, origin: ArrayLike) -> None:
        self._handle.origin = origin

    @property
    def environment(self) -> "_easypbr.Environment":
        """The environment map; empty: none was given."""
        return self._handle.environment

    @environment.setter
    def environment(self, environment: Any) -> None:
        if not isinstance(environment, _easypbr.Environment):
            environment = _easypbr.Environment(environment)
        self._handle.environment = environment

    def __contains__(self, name: str) -> bool:
        return self._handle.contains(name)

    def __repr__(self) -> str:
        return f"<easypbr.Scene: {', '.join(self._handle.names()) or 'empty'}>"


def _show(scene: Scene, what: Any, name: str | None, strict: bool) -> "tuple[_easypbr.Mesh, Maker]":
    """Scene.show(), and what came with the mesh."""
    mesh, make = converted(what, strict)
    name = mesh.name or "mesh" if name is None else name
    scene._handle.show(mesh, name)
    for light_name, light in make.lights.items():
        scene._handle.set_light(f"{name}/{light_name}", light)
    return mesh, make


def scene_of(what: Any, name: str | None = None, strict: bool = False) -> "tuple[Scene, Maker | None]":
    """A scene of whatever can be shown, and what came with it; a Scene is returned as it is."""
    if isinstance(what, Scene):
        return what, None
    scene = Scene()
    return scene, _show(scene, what, name, strict)[1]
