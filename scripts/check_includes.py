#!/usr/bin/env python3
"""Checks who includes whom: rooms use only what they may, sub-rooms only those below them, public headers only public
ones, Eigen and the standard library, the Python package no circle.

usage: check_includes.py [ROOT]      exit code 1 and one line per violation
"""
import ast
import graphlib
import pathlib
import re
import sys
from collections.abc import Iterator

ROOMS = {
    "core": set(),
    "scene": {"core"},
    "gl": {"core"},
    "native": {"core"},
    "geometry": {"core", "scene"},
    "io": {"core", "scene"},
    "gpu": {"core", "scene", "gl", "native"},
    "render": {"core", "scene", "gl", "native", "gpu"},
    "app": {"core", "scene", "gl", "io", "gpu", "render"},
    "gui": {"core", "scene", "gl", "io", "gpu", "render", "app"},
    "dataset": {"core", "scene", "gl", "io", "gpu", "render", "app"},
    "remote": {"core", "scene", "gl", "io", "gpu", "render", "app"},
    "drawing": {"core", "scene", "geometry", "io", "gpu", "render", "app"},
    "viewer": {"core", "scene", "gl", "io", "gpu", "render", "app", "gui", "dataset", "remote", "drawing"},
    "cli": {"core", "scene", "geometry", "gl", "native", "io", "gpu", "render", "app", "gui", "dataset", "remote", "drawing", "viewer"},
    "python": {"core", "scene", "geometry", "gl", "io", "gpu", "render", "app", "gui", "dataset", "remote", "drawing", "viewer", "cli"},
}

# Sub-rooms from the ground up. A sub-room may use those above its own line in this list; folders below one of the
# names ("mesh/ply", "effects/bloom") stand side by side: they may use the sub-room's own files, not each other.
SUBROOMS = {
    "render": ["frame", "drawables", "raster", "primitives", "shadow", "raytrace", "denoise", "lighting", "transparency", "effects",
               "output", "pipeline"],
    "io": ["source", "archive", "tables", "image", "video", "settings", "mesh"],
}
# The face of a sub-room lists what stands in its folders: the one direction from a sub-room down into them.
FACES = {"io/mesh/mesh_io.cpp", "io/video/video_loader.cpp", "render/primitives/primitives.cpp", "render/effects/effects.cpp"}
# Sub-rooms whose folders nobody else names: what they share with the frame is an interface.
CLOSED = {"render/primitives"}
INCLUDE = re.compile(r'#\s*include\s+["<]easypbr/([\w/]+)\.h')
ANY_INCLUDE = re.compile(r'#\s*include\s+["<]([^">]+)[">]')
# What programs see is small; see docs/cpp.md.
PUBLIC = "include/easypbr"
MOST_PUBLIC = 57  # 48, those of the effects, and remote/server.h
FOREIGN = re.compile(r"Eigen/(Core|Geometry)|[a-z_]+")  # Eigen, and headers of the standard library, which have no ending


def place_of(path: str) -> tuple[str, str, str]:
    """Room, sub-room and folder inside it: "render/effects/bloom/bloom_pass" -> ("render", "effects", "bloom")."""
    parts = path.split("/")[:-1]
    return parts[0] if parts else "", parts[1] if len(parts) > 1 else "", "/".join(parts[2:])


def fault(source: str, target: str) -> str | None:
    """What is wrong with a file including another; None: nothing."""
    room, subroom, folder = place_of(source)
    other, other_subroom, other_folder = place_of(target)
    if not other:
        return None if not room else f"{room} may not include the face of the library"
    if room != other:
        return None if not room or other in ROOMS[room] else f"{room} may not include {other}"
    order = SUBROOMS.get(room)
    if not order:
        return None
    if f"{room}/{other_subroom}" in CLOSED and other_folder and folder != other_folder and source not in FACES:
        return f"{room}/{subroom} may not include {other_folder}, a folder of {room}/{other_subroom}: expected its interface"
    if subroom != other_subroom:
        below = order.index(other_subroom) < order.index(subroom)
        return None if below else f"{room}/{subroom} may not include {room}/{other_subroom}"
    if folder != other_folder and other_folder and source not in FACES and not folder.startswith(other_folder + "/") \
            and not other_folder.startswith(folder + "/"):
        return f"{room}/{subroom}/{folder} may not include its neighbour {other_folder}"
    return None


def sources_of(root: pathlib.Path) -> Iterator[tuple[pathlib.Path, str]]:
    """All headers and sources, each with its path as it is included."""
    for folder in (root / PUBLIC, root / "src/easypbr"):
        for path in sorted([*folder.rglob("*.h"), *folder.rglob("*.cpp")]):
            yield path, str(path.relative_to(folder))


def include_faults(root: pathlib.Path) -> Iterator[str]:
    for path, source in sources_of(root):
        room, subroom, _ = place_of(source)
        if room and room not in ROOMS or room in SUBROOMS and subroom not in SUBROOMS[room]:
            yield f"{path.relative_to(root)}: no room of this name is known"
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if match := INCLUDE.match(line):
                if what := fault(source, match[1]):
                    yield f"{path.relative_to(root)}:{number}: {what}"


def public_faults(root: pathlib.Path) -> Iterator[str]:
    """Public headers stand on their own, are few, and have no private twin."""
    folder = root / PUBLIC
    public = {str(path.relative_to(folder.parent)): path for path in sorted(folder.rglob("*.h"))}
    if len(public) > MOST_PUBLIC:
        yield f"{PUBLIC}: expected at most {MOST_PUBLIC} headers, got {len(public)}"
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.suffix != ".h":
            yield f"{path.relative_to(root)}: expected headers alone, which are installed"
    for name, path in public.items():
        if (root / "src" / name).exists():
            yield f"src/{name}: stands for {path.relative_to(root)} too"
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = ANY_INCLUDE.match(line)
            if match and match[1] not in public and not FOREIGN.fullmatch(match[1]):
                yield f"{path.relative_to(root)}:{number}: a public header may not include {match[1]}"


def module_imports(package: pathlib.Path, path: pathlib.Path, modules: set[str]) -> Iterator[str]:
    """Modules of the package that a file imports, at its top or inside its functions."""
    parts = path.relative_to(package.parent).with_suffix("").parts
    if parts[-1] == "__init__":
        parts, here = parts[:-1], parts[:-1]
    else:
        here = parts[:-1]
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in modules)
        elif isinstance(node, ast.ImportFrom):
            base = ".".join(here[: len(here) - node.level + 1]) if node.level else ""
            name = ".".join(filter(None, [base, node.module]))
            for alias in node.names:
                inner = f"{name}.{alias.name}"
                if inner in modules:
                    yield inner
                elif name in modules:
                    yield name


def import_faults(root: pathlib.Path) -> Iterator[str]:
    """Circles among the modules of the Python package; a package's __init__ lists its modules, which may not use it."""
    package = root / "python/easypbr"
    paths = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        paths[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    known = {*paths, "easypbr._easypbr"}
    graph = {name: set(module_imports(package, path, known)) - {name} for name, path in paths.items()}
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        yield "python: modules import each other in a circle: " + " <- ".join(error.args[1])


if __name__ == "__main__":
    base = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    found = [*include_faults(base), *public_faults(base), *import_faults(base)]
    print("\n".join(found) or "includes: every room uses only what it may, public headers are public")
    sys.exit(1 if found else 0)
