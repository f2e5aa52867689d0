#!/usr/bin/env python3
"""Writes the reference of the public C++ headers as a page of the documentation: Doxygen reads the headers, its XML
becomes Markdown, so that the page looks as the others do and is searched with them.

usage: write_cpp_reference.py OUTPUT_FILE      doxygen must be in PATH
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator

ROOT = pathlib.Path(__file__).resolve().parents[1]
#: Folders of include/easypbr in the order of the page.
ROOMS = {"viewer": "Viewer", "scene": "Scene", "geometry": "Geometry", "io": "Files", "app": "Recording, animation, passes",
         "dataset": "Ground truth", "remote": "Browser view", "core": "Images, colours, errors"}  # fmt: skip
CONFIG = """
INPUT = {include}
RECURSIVE = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
OUTPUT_DIRECTORY = {folder}
EXTRACT_ALL = YES
HIDE_FRIEND_COMPOUNDS = YES
JAVADOC_AUTOBRIEF = YES
QUIET = YES
WARNINGS = NO
ENABLE_PREPROCESSING = YES
MACRO_EXPANSION = NO
"""
HEAD = """# C++ library

All public headers, `include/easypbr`. [C++](../cpp.md) shows a program. Names are in the namespace `easypbr`; headers state what is
not repeated here, see the comments at their beginning.
"""


def run_doxygen(folder: pathlib.Path) -> pathlib.Path:
    config = folder / "Doxyfile"
    config.write_text(CONFIG.format(include=ROOT / "include", folder=folder))
    subprocess.run(["doxygen", config], check=True, capture_output=True)
    return folder / "xml"


def plain(node: ET.Element | None) -> str:
    return " ".join("".join(node.itertext()).split()) if node is not None else ""


def escaped(text: str) -> str:
    return text.replace("<", "&lt;").replace("*", r"\*").replace("_", r"\_")


def doc_of(node: ET.Element) -> str:
    # A comment behind a member is its brief description; longer ones are the detailed one.
    parts = [plain(node.find("briefdescription")), plain(node.find("detaileddescription"))]
    return escaped(" ".join(part for part in parts if part))


def shortened(text: str) -> str:
    """As the headers write it: `const Scene& scene`, `std::vector<Skin>`."""
    text = re.sub(r"\s+", " ", text).replace("easypbr::", "").replace("< ", "<").replace(" >", ">")
    text = re.sub(r" ?([&*]+) ?(?=[\w(])", r"\1 ", text).replace("operator* ", "operator*").replace("operator& ", "operator&")
    return re.sub(r"(?<! )=(delete|default)", r" = \1", text).strip()


def signature(member: ET.Element) -> str:
    name, kind = plain(member.find("name")), plain(member.find("type"))
    arguments = plain(member.find("argsstring"))
    if member.get("kind") == "enum":
        values = ", ".join(plain(value.find("name")) for value in member.findall("enumvalue"))
        return shortened(f"enum class {name} {{ {values} }}")
    if member.get("kind") == "typedef":
        return shortened(f"using {name} = {kind}")
    if member.get("kind") == "variable":
        return shortened(f"{kind} {name}{arguments} {plain(member.find('initializer'))}")
    static = "static " if member.get("static") == "yes" else ""
    return shortened(f"{static}{kind} {name}{arguments}")


def members(compound: ET.Element) -> Iterator[ET.Element]:
    for section in compound.findall("sectiondef"):
        if not section.get("kind", "").startswith("private"):
            yield from (member for member in section.findall("memberdef") if member.get("prot") == "public"
                        and "delete" not in plain(member.find("argsstring")))


def item(member: ET.Element) -> str:
    explained = doc_of(member)
    for value in member.findall("enumvalue"):
        if doc := doc_of(value):
            explained += f" `{plain(value.find('name'))}`: {doc}"
    return f"- `{signature(member)}`" + (f"  \n  {explained.strip()}" if explained.strip() else "")


def header_of(node: ET.Element) -> pathlib.PurePath:
    location = node.find("location")
    assert location is not None
    # Doxygen shortens paths below the folder that it runs in.
    return pathlib.PurePath((location.get("declfile") or location.get("file", "")).split("include/easypbr/")[-1])


def compounds(xml: pathlib.Path) -> dict[str, list[tuple[str, str]]]:
    """Of each header what it declares, as (title, text): classes, then what stands free in its namespaces."""
    found: dict[str, list[tuple[str, str]]] = {}
    free: dict[str, list[str]] = {}
    for path in sorted(xml.glob("*.xml")):
        compound = ET.parse(path).getroot().find("compounddef")
        if compound is None or "detail" in plain(compound.find("compoundname")):
            continue
        kind, name = compound.get("kind"), plain(compound.find("compoundname")).removeprefix("easypbr::")
        if kind == "namespace":
            for member in members(compound):
                if not plain(member.find("name")).startswith("@"):
                    free.setdefault(str(header_of(member)), []).append(item(member))
        elif kind in ("class", "struct") and compound.get("prot", "public") == "public":
            body = "\n".join(item(member) for member in members(compound))
            text = f"{doc_of(compound)}\n\n{body}\n".lstrip()
            found.setdefault(str(header_of(compound)), []).append((f"{kind} {name}", text))
    for header, items in free.items():
        found.setdefault(header, []).append(("", "\n".join(items) + "\n"))
    return found


def head_comment(header: str) -> str:
    """The comment that a header begins with."""
    lines = (ROOT / "include/easypbr" / header).read_text().splitlines()
    count = next(i for i, line in enumerate(lines) if not line.startswith("//"))
    return escaped(" ".join(line.lstrip("/ ") for line in lines[:count]))


def cpp_page() -> str:
    with tempfile.TemporaryDirectory() as folder:
        found = compounds(run_doxygen(pathlib.Path(folder)))
    text = HEAD
    for room, title in ROOMS.items():
        text += f"\n## {title}\n"
        for header in sorted(name for name in found if name.split("/")[0] == room):
            text += f"\n### {header}\n\n`#include <easypbr/{header}>`\n\n{head_comment(header)}\n"
            for name, body in found[header]:
                text += f"\n#### {name}\n\n{body}" if name else f"\n{body}"
    return text


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    pathlib.Path(sys.argv[1]).write_text(cpp_page())
