#!/usr/bin/env python3
"""Checks the names that sources keep to themselves (unnamed namespaces, static functions). A unity build compiles sources
of a target as one, where such a name meets those of other sources: it is defined twice, or it changes which function a
call means.

usage: check_unity_names.py [ROOT]      exit code 1 and one line per clash
"""
import collections
import pathlib
import re
import sys
from collections.abc import Iterator
from typing import NamedTuple

#: Folders of src/easypbr whose sources are targets of their own beside the room's; see cmake/.
OWN_TARGETS = {"reader", "ffmpeg", "tools"}

INCLUDE = re.compile(r'^\s*#\s*include\s+["<]([^">]+)[">]', re.MULTILINE)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)
COMMENT_OR_TEXT = re.compile(
    r"""//[^\n]*|/\*.*?\*/|R"(?P<mark>\w*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|(?<!\w)'(?:\\.|[^'\\\n])+'""", re.DOTALL)
TOKEN = re.compile(r"[A-Za-z_]\w*|::|->|<<|\S")
CLOSING = {"(": ")", "[": "]", "{": "}"}
GROUPS = {"()", "[]", "{}"}
WORD = re.compile(r"[A-Za-z_]\w*$")
TYPES = {"class", "struct", "union", "enum"}
#: Statements that declare no name of their own.
OTHERS = {"friend", "static_assert", "extern", "typedef"}

#: Tests that compile functions of native shaders themselves, in the namespace that those are compiled in.
ALONE = {"simd_test.cpp"}


class Declaration(NamedTuple):
    namespace: tuple[str, ...]
    name: str
    is_local: bool  #: to its source
    is_function: bool
    alias: str = ""  #: what it stands for, of aliases


def tokens_of(text: str) -> list[str]:
    plain = COMMENT_OR_TEXT.sub(lambda match: '""' if match[0].endswith('"') else " ", text)
    return TOKEN.findall(DIRECTIVE.sub("", plain).replace('""', " "))


def end_of_group(tokens: list[str], begin: int) -> int:
    """The place behind the bracket that closes the one at `begin`."""
    opening, closing, depth = tokens[begin], CLOSING[tokens[begin]], 0
    for i in range(begin, len(tokens)):
        depth += (tokens[i] == opening) - (tokens[i] == closing)
        if depth == 0:
            return i + 1
    return len(tokens)


def without_template(head: list[str]) -> list[str]:
    """A statement without what stands before it: attributes, and parameters of templates."""
    while head and head[0] in {"[]", "template"}:
        if head.pop(0) == "[]":
            continue
        depth = 0
        while head:
            depth += {"<": 1, ">": -1}.get(token := head.pop(0), 0)
            if token == ">" and depth == 0:
                break
    return head


def names_of(statement: list[str]) -> Iterator[tuple[str, bool]]:
    """The names that a statement of a namespace declares, and whether they are functions. Bracketed groups are one token."""
    head = without_template(list(statement))
    if not head or head[0] in OTHERS:
        return
    if head[0] == "using":
        if len(head) > 2 and head[2] == "=":
            yield head[1], False
        return
    if head[0] in TYPES:
        words = [token for token in head[1:] if token not in TYPES and token not in GROUPS]
        if "{}" in head or ":" in head or words[1:] == [";"]:
            if WORD.match(words[0]) and words[1] not in {"<", "::"}:
                yield words[0], False
            return
        head = head[1:]  # A variable or function of a type that is named with its key.
    depth, begins = 0, True
    for i, token in enumerate(head):
        depth += {"<": 1, ">": -1}.get(token, 0)
        if token == ":":  # Members that a constructor initialises.
            return
        if depth == 0 and token == ",":
            begins = True
        elif depth == 0 and begins and (token in GROUPS or token in {"=", ";"} or head[i + 1 : i + 2] == [","]):
            last = i if WORD.match(token) else i - 1
            begins = False
            if last > 0 and WORD.match(head[last]) and head[last - 1] not in {"::", "operator"}:
                yield head[last], token == "()" and "=" not in head[:i]


def is_function(head: list[str]) -> bool:
    """Whether braces that follow are the body of a function, which ends without a semicolon."""
    return "()" in head and ("=" not in head or "operator" in head) and head[0] not in TYPES


def statement_at(tokens: list[str], begin: int) -> tuple[list[str], int]:
    """The statement of a namespace that begins at a place, its groups as one token, and the place behind it."""
    statement: list[str] = []
    i = begin
    while i < len(tokens):
        token = tokens[i]
        if token not in CLOSING:
            statement.append(token)
            i += 1
            if token in {";", "}"}:
                break
            continue
        head = without_template(list(statement))
        if token == "{" and head and (head[0] == "namespace" or head[:2] == ["inline", "namespace"]):
            return [*statement, token], i + 1
        of_member = ":" in statement and bool(WORD.match(statement[-1]))  # Constructor() : member{...}
        i = end_of_group(tokens, i)
        statement.append(token + CLOSING[token])
        if token == "{" and (head == ["extern"] or is_function(head) and not of_member):
            break
    return statement, i


def declarations_of(text: str) -> Iterator[Declaration]:
    """What the namespaces of a file declare."""
    tokens, scopes, i = tokens_of(text), [], 0
    while i < len(tokens):
        statement, i = statement_at(tokens, i)
        if "namespace" in statement and statement[-1] == "{":
            scopes.append([token for token in statement if WORD.match(token) and token not in {"inline", "namespace"}])
        elif statement == ["}"]:
            if scopes:
                scopes.pop()
        elif statement[:1] != ["namespace"]:
            is_local = [] in scopes or "static" in statement
            namespace = tuple(name for scope in scopes for name in scope)
            for name, is_function in names_of(statement):
                alias = " ".join(statement) if statement[0] == "using" else ""
                yield Declaration(namespace, name, is_local, is_function, alias)


class Tree:
    """The sources and headers of a folder with src/ and include/."""

    def __init__(self, root: pathlib.Path):
        self.root = root
        self.texts = {path: path.read_text() for folder in (root / "src", root / "include") if folder.is_dir()
                      for path in sorted(folder.rglob("*")) if path.suffix in {".h", ".cpp"}}

    def name(self, path: pathlib.Path) -> str:
        return str(path.relative_to(self.root))

    def targets(self) -> dict[str, list[pathlib.Path]]:
        """Sources by the target that compiles them."""
        targets = collections.defaultdict(list)
        for path in self.texts:
            if path.suffix == ".cpp":
                parts = path.relative_to(self.root / "src/easypbr").parts[:-1]
                own = next((parts[: i + 1] for i, part in enumerate(parts) if part in OWN_TARGETS), parts[:1])
                targets["/".join(own)].append(path)
        return dict(targets)

    def headers_of(self, sources: list[pathlib.Path]) -> list[pathlib.Path]:
        """What the sources include, through others too."""
        seen, waiting = set(), list(sources)
        while waiting:
            path = waiting.pop()
            for name in INCLUDE.findall(self.texts[path]):
                for found in (path.parent / name, self.root / "src" / name, self.root / "include" / name):
                    if found in self.texts and found not in seen:
                        seen.add(found)
                        waiting.append(found)
        return sorted(seen)


def clashes(root: pathlib.Path) -> Iterator[str]:
    tree = Tree(root)
    declared = {path: list(declarations_of(text)) for path, text in tree.texts.items()}
    for target, sources in sorted(tree.targets().items()):
        local: dict[tuple[tuple[str, ...], str], dict[str, str]] = collections.defaultdict(dict)
        for path in sources:
            for declaration in declared[path]:
                if declaration.is_local:
                    local[declaration.namespace, declaration.name][tree.name(path)] = declaration.alias
        shared = collections.defaultdict(set)
        for path in tree.headers_of(sources):
            for declaration in declared[path]:
                if declaration.is_function and not declaration.is_local:
                    shared[declaration.name].add((declaration.namespace, tree.name(path)))
        for (namespace, name), places in sorted(local.items()):
            first, *others = sorted(places)
            for other in others:
                if places[other] and places[other] == places[first]:
                    continue  # The same alias twice is the same type.
                yield f"{other}: {name} is also a name of {first}, in the same unity build"
            for outer, header in sorted(shared[name]):
                if namespace[: len(outer)] == outer:
                    yield f"{first}: {name} is also a function of {header}, which it hides or overloads in a unity build"


def nameless_tests(root: pathlib.Path) -> Iterator[str]:
    """Tests whose names do not stand in a namespace called as their file: they have helpers of the same names."""
    for path in sorted((root / "tests").glob("*/*_test.cpp")):
        if path.name in ALONE:
            continue
        if not re.search(rf"^namespace easypbr(?:::\w+)*::{path.stem} {{$", path.read_text(), re.MULTILINE):
            yield f"{path.relative_to(root)}: expected its names in a namespace easypbr::{path.stem}"


if __name__ == "__main__":
    base = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    found = [*clashes(base), *nameless_tests(base)]
    print("\n".join(found) or "unity builds: sources of a target have no name of their own in common")
    sys.exit(1 if found else 0)
