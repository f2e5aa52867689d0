#!/usr/bin/env python3
"""Names the arguments of generic types, which nanobind's stubs leave open, so that strict type checkers take them.

usage: complete_stub.py FROM TO
"""
import pathlib
import re
import sys

#: Generic types as nanobind writes them, unless a bracket follows, and what they are.
COMPLETE = {
    r"\bos\.PathLike\b": "os.PathLike[str]",
    r"\bnumpy\.ndarray\b": "NDArray[Any]",
    r"(?<![.\w])NDArray\b": "NDArray[Any]",
    r"(?<=: )dict\b|(?<=-> )dict\b|(?<=\[)dict\b": "dict[str, Any]",
    r"(?<=: )list\b|(?<=-> )list\b|(?<=\[)list\b": "list[Any]",
    r"(?<=: )tuple\b|(?<=-> )tuple\b|(?<=\[)tuple\b": "tuple[Any, ...]",
}


def complete(text: str) -> str:
    head, imports, body = text.partition("import NDArray\n")
    for pattern, whole in COMPLETE.items():
        body = re.sub(f"(?:{pattern})(?![\\[(])", whole, body)
    return head + imports + body


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, target = map(pathlib.Path, sys.argv[1:])
    target.write_text(complete(source.read_text(encoding="utf-8")), encoding="utf-8")
