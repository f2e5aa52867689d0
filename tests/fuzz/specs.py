"""Specs of data sets as a fuzzer's target: each is read, or refused by an error that names what is wrong.

`python specs.py [OPTION of libFuzzer...] CORPUS...` fuzzes, guided by the coverage of the package's modules (Atheris).
"""
import os
import sys
from importlib import import_module
from typing import Any


def target() -> Any:
    """A function of bytes, which raises what no spec may cause."""
    spec, errors = import_module("easypbr.dataset.spec"), import_module("easypbr.errors")

    def read(data: bytes) -> None:
        file = os.memfd_create("spec")
        try:
            os.write(file, data)
            spec.DatasetSpec.from_toml(f"/proc/self/fd/{file}")
        except (errors.ArgumentError, errors.FileError):
            pass
        finally:
            os.close(file)

    return read


def main() -> None:
    import atheris

    import easypbr  # noqa: F401 - what is compiled, and what is not of data sets, does not guide

    for name in [name for name in sys.modules if name.startswith("easypbr.dataset")]:
        del sys.modules[name]
    with atheris.instrument_imports(include=["easypbr.dataset", "tomllib"]):
        read = target()
    atheris.Setup(sys.argv, read)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
