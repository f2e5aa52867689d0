#!/usr/bin/env python3
"""Counts what the structure of the tree is judged by, and checks the bounds that shaders keep.

usage: count_structure.py [ROOT]      prints the counts; exit code 1 and one line per fault when a bound does not hold
"""
import pathlib
import re
import subprocess
import sys
from collections.abc import Iterator

#: Most lines of #if in all shaders together. Variants are named features (gl/program.h); what remains has its reason.
MOST_CONDITIONS = 60

CONDITION = re.compile(r"\s*#\s*if")
INCLUDE = re.compile(r'\s*#\s*include\s+["<]([^">]+)[">]')
GL_CALL = re.compile(r"\bgl[A-Z]\w+\(")
#: What goes by the program's locale: letters, numbers with a decimal comma.
OF_LOCALE = re.compile(r"#\s*include\s*<(?:cctype|ctype\.h|cwctype|regex)>|\b(?:to(?:lower|upper)|is(?:alnum|alpha|blank|cntrl|digit"
                       r"|graph|lower|print|punct|space|upper|xdigit)|strn?casecmp|strto(?:d|f|ld)|ato(?:f|i|ll?)|sto(?:d|f|ld)|v?s?scanf)"
                       r"(?=[(,)])")
UNIFORM_BY_NAME = re.compile(r'\.set\(\s*"u_')
BLOCK = re.compile(r"^\s*layout\(std(?:140|430)[^)]*\)\s*(?:uniform|buffer)\s+(\w+)", re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*")
CLASSES = {"Renderer": "render/pipeline/renderer.h", "Frame": "render/frame/frame.h", "Session": "app/session.h"}


def shader_lines(root: pathlib.Path) -> Iterator[tuple[str, int, str]]:
    """File, number and text of each line of the shaders."""
    for path in sorted((root / "shaders").iterdir()):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            yield path.name, number, line


def sources(root: pathlib.Path) -> dict[str, str]:
    """The text of each C++ file, by its path in src/easypbr."""
    folder = root / "src/easypbr"
    paths = sorted([*folder.rglob("*.h"), *folder.rglob("*.cpp")])
    return {str(path.relative_to(folder)): path.read_text() for path in paths}


def without_bodies(text: str) -> str:
    """The text of a class without what stands in inner braces; where those end a statement, a semicolon."""
    braces, brackets, kept = 0, 0, []
    for letter in text:
        braces -= letter == "}"
        if braces == 0:
            brackets += (letter == "(") - (letter == ")")
            kept.append(letter if letter != "}" else "" if brackets else ";")
        braces += letter == "{"
    return "".join(kept)


def members(text: str, name: str) -> tuple[int, int] | None:
    """Fields and methods that a class or struct declares; None where the text does not define it."""
    begin = re.search(rf"^(?:class|struct) {name}(?: final)?(?: : [^{{;]*)? {{$(.*?)^}};", text, re.MULTILINE | re.DOTALL)
    if not begin:
        return None
    body = re.sub(r"//[^\n]*", "", begin[1])
    body = re.sub(r"\b(?:public|private|protected):", "", body)
    fields = methods = 0
    for statement in without_bodies(body).split(";"):
        statement = " ".join(statement.split())
        if not statement or re.match(r"(using|friend|static constexpr|struct|class|enum) ", statement):
            continue
        if re.search(r"\w\(|operator|~", re.sub(r"=.*|<[^()]*(\([^()]*\))?[^()]*>", "", statement)):
            methods += 1
        else:
            fields += 1 + re.sub(r"<[^<>]*>|\([^()]*\)|\{[^{}]*\}", "", statement).count(",")
    return fields, methods


def pulled_in(root: pathlib.Path, header: str) -> set[str]:
    """Our headers that an include of one brings with it, itself left out."""
    folders = [root / "include", root / "src"]
    seen, waiting = set(), [header]
    while waiting:
        name = waiting.pop()
        path = next((folder / name for folder in folders if (folder / name).exists()), None)
        if name in seen or path is None:
            continue
        seen.add(name)
        waiting += [match[1] for line in path.read_text().splitlines() if (match := INCLUDE.match(line))]
    return seen - {header}


def rebuilt(root: pathlib.Path, headers: set[str]) -> tuple[int, int]:
    """C++ units that include one of these headers, through others too, and how many units there are."""
    folders = [root / "include", root / "src", root / "tests"]
    direct: dict[pathlib.Path, set[pathlib.Path]] = {}
    units = [path for part in ("src", "tests", "bench") for path in (root / part).rglob("*.cpp")]

    def includes(path: pathlib.Path) -> set[pathlib.Path]:
        if path not in direct:
            names = [match[1] for line in path.read_text().splitlines() if (match := INCLUDE.match(line))]
            found = (next((folder / name for folder in (path.parent, *folders) if (folder / name).is_file()), None)
                     for name in names)
            direct[path] = {file.resolve() for file in found if file}
        return direct[path]

    wanted = {(folder / name).resolve() for folder in folders for name in headers if (folder / name).exists()}
    count = 0
    for unit in units:
        seen, waiting = set(), [unit]
        while waiting:
            path = waiting.pop()
            if path not in seen:
                seen.add(path)
                waiting += includes(path)
        count += bool(seen & wanted)
    return count, len(units)


def recompiled(root: pathlib.Path, headers: set[str]) -> tuple[int, int] | None:
    """Objects of the last build in build/ that are compiled anew when one of these headers changes, and all of them. A
    unity build compiles several sources as one. None without a build."""
    plan = root / "build/build.ninja"
    if not plan.is_file():
        return None
    objects = set(re.findall(r"^build (\S+\.o):", plan.read_text(), re.MULTILINE))
    printed = subprocess.run(["ninja", "-C", plan.parent, "-t", "deps"], capture_output=True, text=True, check=True)
    uses = {name: any(line.endswith(tuple(f"/{header}" for header in headers)) for line in lines.splitlines())
            for name, lines in re.findall(r"^(\S+): [^\n]*\n((?: +[^\n]*\n)*)", printed.stdout, re.MULTILINE)
            if name in objects}
    return sum(uses.values()), len(uses)


#: Most compilations that a change of a header may take.
MOST_RECOMPILED = {"render/effects/bloom/bloom_effect.h": 10, "scene/settings.h": 60, "scene/mesh.h": 120}


def header_faults(root: pathlib.Path) -> Iterator[str]:
    """Headers that too much of the last build includes; nothing without a build."""
    for header, most in MOST_RECOMPILED.items():
        compiled = recompiled(root, {f"easypbr/{header}"})
        if compiled and compiled[0] > most:
            yield f"{header}: a change takes {compiled[0]} compilations; expected at most {most}"


def installed_headers(root: pathlib.Path) -> int:
    """Headers of include/ where it stands, else of the rooms that cmake/install.cmake installs."""
    if (root / "include/easypbr").is_dir():
        return sum(1 for _ in (root / "include").rglob("*.h"))
    left_out = {"cli", "python", "tools", "module", "reader", "ffmpeg"}
    return sum(1 for path in (root / "src/easypbr").rglob("*.h") if not left_out & set(path.relative_to(root).parts))


def counts(root: pathlib.Path) -> Iterator[tuple[str, str]]:
    """What is counted, and how much of it there is."""
    yield "lines of #if in shaders", str(sum(bool(CONDITION.match(line)) for _, _, line in shader_lines(root)))
    texts = sources(root)
    # The window's own renderer and its surface are a front end of their own.
    calls = {name: len(GL_CALL.findall(text)) for name, text in texts.items() if not name.startswith(("gl/", "gui/"))}
    yield "raw GL calls outside gl/ and gui/", f"{sum(calls.values())} in {sum(map(bool, calls.values()))} files"
    yield "uniforms set by string", str(sum(len(UNIFORM_BY_NAME.findall(text)) for text in texts.values()))
    for name, place in CLASSES.items():
        found = next(filter(None, (members(text, name) for text in [texts.get(place, ""), *texts.values()])), None)
        yield f"{name}: fields, methods", "not there" if found is None else f"{found[0]}, {found[1]}"
    yield "headers installed", str(installed_headers(root))
    yield "our headers that easypbr.h pulls in", str(len(pulled_in(root, "easypbr/easypbr.h")))
    effect = {"easypbr/render/effects/bloom/bloom_effect.h", "easypbr/render/bloom_pass.h"}
    for what, headers in (("bloom's header", effect), ("scene/settings.h", {"easypbr/scene/settings.h"}),
                          ("scene/mesh.h", {"easypbr/scene/mesh.h"})):
        yield f"sources that a change of {what} reaches", "{} of {}".format(*rebuilt(root, headers))
        if compiled := recompiled(root, headers):
            yield f"compilations that a change of {what} takes", "{} of {}".format(*compiled)
    yield 'files of src that name "surfel", but for its own', str(len(naming(root, "surfel")))


def shader_faults(root: pathlib.Path) -> Iterator[str]:
    """Where shaders break a bound: too many conditions, one without a reason, a block that two files declare."""
    conditions = [place for place in shader_lines(root) if CONDITION.match(place[2])]
    if len(conditions) > MOST_CONDITIONS:
        yield f"shaders have {len(conditions)} lines of #if; expected at most {MOST_CONDITIONS}: declare a #feature"
    for name, number, line in conditions:
        if "//" not in line:
            yield f"shaders/{name}:{number}: expected the reason of this #if in a comment behind it"
    declared: dict[str, str] = {}
    for path in sorted((root / "shaders").iterdir()):
        for block in BLOCK.findall(path.read_text()):
            if block in declared:
                yield f"shaders/{path.name}: block {block} is declared in {declared[block]} too"
            declared[block] = path.name


#: Lines of the function that draws a frame, from its signature to its brace.
LONGEST_FRAME = 50

#: Files that may name a kind of primitive beside its own: settings, style, bindings, the list of all kinds.
MOST_NAMING_A_KIND = 8


def naming(root: pathlib.Path, kind: str) -> list[str]:
    """Files of src that name a kind of primitive; those that carry its name are its own."""
    return [name for name, text in sources(root).items() if kind in text.lower() and kind not in name]


def frame_lines(root: pathlib.Path) -> int:
    """Lines of Pipeline::draw(), the whole frame."""
    text = (root / "src/easypbr/render/pipeline/pipeline.cpp").read_text()
    begin = text.index("LitPicture Pipeline::draw(")
    return text[begin : text.index("\n}\n", begin) + 2].count("\n") + 1


def code_faults(root: pathlib.Path) -> Iterator[str]:
    """Where the code breaks a bound: OpenGL outside the rooms that own it, a function that goes by the locale, a frame that
    does not fit a screen."""
    for name, text in sources(root).items():
        if not name.startswith(("gl/", "gui/imgui_renderer", "gui/window")):
            for call in GL_CALL.findall(text):
                yield f"src/easypbr/{name}: calls {call[:-1]}(): expected a function of gl/"
        for found in OF_LOCALE.findall(COMMENT.sub("", text)):
            yield f"src/easypbr/{name}: {found} goes by the locale: expected core/ascii.h, from_chars() or io/source/text_scanner.h"
    if len(names := naming(root, "surfel")) > MOST_NAMING_A_KIND:
        yield f"src/easypbr: {len(names)} files name surfels; expected at most {MOST_NAMING_A_KIND}: {', '.join(names)}"
    if frame_lines(root) > LONGEST_FRAME:
        yield f"render/pipeline/pipeline.cpp: the frame has {frame_lines(root)} lines; expected at most {LONGEST_FRAME}"


if __name__ == "__main__":
    base = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    for what, number in counts(base):
        print(f"{what:58} {number}")
    faults = [*shader_faults(base), *header_faults(base), *(code_faults(base) if (base / "src/easypbr/render/pipeline").is_dir() else ())]
    print("\n".join(faults), end="\n" if faults else "")
    sys.exit(1 if faults else 0)
