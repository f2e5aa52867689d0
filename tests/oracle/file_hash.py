"""Tells whether a file is the one that a reference was made from, or the reference itself."""
import hashlib
import pathlib


def hash_of(path: pathlib.Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
