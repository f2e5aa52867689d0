#!/usr/bin/env python3
"""Writes the generated pages of the documentation: settings.md from the table of settings, python.md from the package's
stub and sources, cpp.md from the public headers, gallery.md from the sources of the pictures.

usage: write_reference.py OUTPUT_FOLDER      the easypbr package must be importable, doxygen in PATH
"""
import ast
import pathlib
import sys

import write_cpp_reference
import write_gallery

import easypbr
from easypbr import _easypbr

#: Groups in the order of the page; every public name of the package is in one of them.
PYTHON_GROUPS = {
    "Drawing": ["render", "Viewer", "Scene", "Settings", "auto", "follow", "Automatic", "Follow",
                "Server", "ServerClient"],
    "Content": ["Mesh", "LabelMap", "load_scene", "as_mesh", "splats", "splats_of", "Material", "Style", "Light", "Environment", "Camera", "CameraPath"],
    "Geometry": ["KdTree", "RayTree", "RayHits"],
    "Ground truth and tensors": ["Instance", "Moment", "MeshLoader", "eigen2tensor", "tensor2eigen"],
    "Images": ["load_image", "save_image", "compare_images", "colormap"],
    "Window": ["show", "Pick", "Panel", "Event"],
    "Errors": ["Error", "FileError", "FormatError", "ArgumentError", "UnknownNameError", "ShaderError", "ContextError"],
}
#: Modules with names of their own.
MODULES = {"shapes": "Shapes"}
#: What public functions and attributes return; described below the group of what returns them.
HELPERS = {"Drawing": ["Recorder", "Lights", "StudioLight"], "Content": ["LoadedScene", "Animations"]}

SETTINGS_HEAD = """# Settings

Every setting there is. The same names serve `--set name=value` on the command line, `view.settings.name = value` in
Python, and the keys of a settings file. `auto` marks a default that is inferred; see
[Settings and reproducibility](../settings_and_reproducibility.md).
"""
PYTHON_HEAD = """# Python package

Everything that `from easypbr import *` brings, from the package's own stub. Attributes marked *read-only* cannot be
assigned. What the settings are called stands in [Settings](settings.md).
"""


def limit(value: float) -> str:
    return "" if abs(value) >= 1e30 else f"{value:g}"


def range_of(field) -> str:
    """What values a setting takes, in words short enough for a table."""
    if field.type == "colormap":
        return ", ".join(f"`{choice}`" for choice in field.choices) + ", or colours: `#000080,#ffffff`"
    if field.type == "choice":
        return ", ".join(f"`{choice}`" for choice in field.choices)
    if field.type in ("boolean", "text", "color"):
        return {"boolean": "true, false", "text": "text", "color": "`#rrggbb` or r,g,b in 0..1"}[field.type]
    numbers = f"{' or '.join(map(str, field.sizes))} numbers" if field.sizes else ""
    low, high = limit(field.min), limit(field.max)
    # The least positive number stands for "above 0".
    low = "above 0" if 0 < field.min < 1e-20 else low
    bounds = f"{low} to {high}" if low and high else low if low.startswith("above") else f"from {low}" if low else ""
    return ", ".join(part for part in (numbers, bounds) if part)


def default_of(field) -> str:
    value = field.default
    is_color = field.type == "color" and isinstance(value, tuple)
    if is_color and all(abs(255 * c - round(255 * c)) < 1e-4 for c in value):
        return "#" + "".join(f"{round(255 * c):02x}" for c in value)
    if isinstance(value, tuple):
        return ",".join(f"{v:g}" for v in value) or "none"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value) or "none"


def settings_page(fields) -> str:
    lines = [SETTINGS_HEAD]
    group = None
    for field in fields:
        if field.name.split(".")[0] != group:
            group = field.name.split(".")[0]
            lines += ["", f"## {group}", "", "| Setting | Default | Values | Meaning |", "|---|---|---|---|"]
        unit = f" [{field.unit}]" if field.unit else ""
        lines.append(f"| `{field.name}` | `{default_of(field)}` | {range_of(field)}{unit} | {field.doc} |")
    return "\n".join(lines) + "\n"


def definitions(package: pathlib.Path) -> dict:
    """Top-level definitions by name, the sources' before the stub's, overloads as a list."""
    found: dict = {}
    sources = sorted(package.glob("*.py"))
    for path in [*sources, package / "_easypbr.pyi"]:
        for node in ast.parse(path.read_text()).body:
            if path.suffix == ".py" and is_overload(node):
                continue  # The function itself says more.
            name = getattr(node, "name", None) or ast.unparse(getattr(node, "target", ast.Name("")))
            if name:
                found.setdefault(name, []).append(node)
    return found


def is_overload(node) -> bool:
    return any(ast.unparse(decorator).endswith("overload") for decorator in getattr(node, "decorator_list", ()))


class PlainAnnotations(ast.NodeTransformer):
    """Annotations as they are read: without quotes and without the module that only the package sees."""

    def visit_Constant(self, node):
        is_quoted_type = isinstance(node.value, str) and "_easypbr." in node.value
        return ast.parse(node.value.replace("_easypbr.", ""), mode="eval").body if is_quoted_type else node


def text_of(node) -> str:
    return ast.unparse(PlainAnnotations().visit(node))


def signature(node, name: str) -> str:
    arguments = text_of(node.args)
    for own in ("self, /, ", "self, /", "self, ", "self", "cls, ", "cls"):
        if arguments == own or (own.endswith(" ") and arguments.startswith(own)):
            arguments = arguments[len(own) :]
            break
    returns = f" -> {text_of(node.returns)}" if node.returns and name != "__init__" else ""
    return f"({arguments}){returns}"


def doc(node) -> str:
    # A placeholder in angle brackets must not be taken for HTML.
    return " ".join((ast.get_docstring(node) or "").split()).replace("<", "&lt;").replace("_easypbr.", "")


def item(text: str, explanation: str) -> str:
    return f"- `{text}`" + (f"  \n  {explanation}" if explanation else "")


def decorators(node) -> set:
    return {ast.unparse(decorator) for decorator in node.decorator_list}


def members(node) -> list:
    """Attributes first, then methods, each in the order of the source."""
    functions = [part for part in node.body if isinstance(part, ast.FunctionDef) and not part.name.startswith("_")]
    settable = {part.name for part in functions if f"{part.name}.setter" in decorators(part)}
    attributes, methods = [], []
    for part in functions:
        if "property" in decorators(part):
            text = f"{part.name}: {text_of(part.returns)}" if part.returns else part.name
            read_only = "" if part.name in settable else "*read-only*"
            attributes.append(item(text, f"{read_only} {doc(part)}".strip()))
        elif f"{part.name}.setter" not in decorators(part):
            methods.append(item(part.name + signature(part, part.name), doc(part)))
    return attributes + methods


def class_section(node) -> list:
    bases = [ast.unparse(base) for base in node.bases if ast.unparse(base) != "SettingsGroup"]
    made = [part for part in node.body if isinstance(part, ast.FunctionDef) and part.name == "__init__"]
    lines = ["", f"### {node.name}", "", doc(node)]
    if bases:
        lines += ["", f"Derives from {' and '.join(f'`{base}`' for base in bases)}."]
    if made and node.name not in (*sum(HELPERS.values(), []), "Settings"):
        lines += ["", *(item(node.name + signature(part, "__init__"), doc(part)) for part in made)]
    listed = members(node)
    # One list: a blank line would make some items paragraphs and others not.
    return [*lines, *([] if lines[-1].startswith("- ") else [""]), *listed]


def section(name: str, nodes: list) -> list:
    node = nodes[0]
    if isinstance(node, ast.ClassDef):
        return class_section(node)
    if isinstance(node, ast.FunctionDef):
        return ["", f"### {name}", "", *(item(name + signature(each, name), doc(each)) for each in nodes)]
    return ["", f"### {name}", "", f"The one value of type `{text_of(node.annotation)}`."]


def python_page(package: pathlib.Path) -> str:
    found = definitions(package)
    lines = [PYTHON_HEAD]
    for title, names in PYTHON_GROUPS.items():
        lines += ["", f"## {title}"]
        for name in [*names, *HELPERS.get(title, [])]:
            lines += section(name, found[name])
    for module, title in MODULES.items():
        lines += ["", f"## {title}", "", doc(ast.parse((package / f"{module}.py").read_text()))]
        for name in getattr(easypbr, module).__all__:
            lines += section(name, found[name])
    return "\n".join(lines) + "\n"


def write_reference(folder: pathlib.Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "settings.md").write_text(settings_page(_easypbr.fields()))
    (folder / "python.md").write_text(python_page(pathlib.Path(easypbr.__file__).parent))
    (folder / "cpp.md").write_text(write_cpp_reference.cpp_page())
    (folder / "gallery.md").write_text(write_gallery.gallery_page())


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write_reference(pathlib.Path(sys.argv[1]))
