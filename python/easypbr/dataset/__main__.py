"""easypbr dataset, as the command line runs it."""

import argparse
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from ..errors import ArgumentError, Error, FileError
from .run import check_engine, generate
from .spec import DatasetSpec


class _UsageError(Exception):
    """The command itself is wrong."""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """In place of a usage on many lines."""
        raise _UsageError(message.removeprefix("argument "))


def _whole_number(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected a whole number, got '{text}'") from None


def _one_of(*names: str) -> Callable[[str], str]:
    def checked(text: str) -> str:
        if text not in names:
            raise argparse.ArgumentTypeError(f"expected {' or '.join(names)}, got '{text}'")
        return text

    return checked


def _parsed(arguments: list[str] | None) -> argparse.Namespace:
    parser = _Parser(prog="easypbr dataset", description="Generate pictures with annotations for training.")
    parser.add_argument("spec", nargs="?", help="what to generate, a TOML file")
    parser.add_argument("--demo", action="store_true", help="generate the built-in drones")
    parser.add_argument("-o", "--output", help="folder to write")
    parser.add_argument("--count", type=_whole_number, help="number of pictures")
    parser.add_argument("--seed", type=_whole_number, help="another seed gives other pictures")
    parser.add_argument("--workers", type=_whole_number, help="processes that draw")
    parser.add_argument("--threads", type=_whole_number, help="cores of each worker")
    parser.add_argument("--engine", type=_one_of("local", "ray"), default="local", help="who runs the workers: local or ray")
    parser.add_argument("--address", help="of a cluster of Ray: HOST:PORT, or auto")
    parser.add_argument("--writers", help="formats, separated by commas")
    parser.add_argument("--on-error", type=_one_of("stop", "skip"), help="of a mesh that cannot be read: stop or skip")
    parser.add_argument("-q", "--quiet", action="store_true", help="neither progress nor a summary")
    options = parser.parse_args(arguments)
    if bool(options.spec) == options.demo:
        parser.error("expected a SPEC or --demo")
    if not options.output:
        parser.error("expected -o FOLDER")
    return options


def _apply(options: argparse.Namespace, spec: DatasetSpec) -> None:
    """Sets what the options say, and checks them. Raises _UsageError: the spec has been found right before."""
    for name in ("count", "seed", "on_error"):
        if getattr(options, name) is not None:
            setattr(spec, name, getattr(options, name))
    if options.writers is not None:
        spec.writers = tuple(options.writers.split(","))
    try:
        spec.check()
        check_engine(options.engine, options.address, options.workers, options.threads)
    except ArgumentError as error:
        raise _UsageError(str(error).removeprefix("dataset: ")) from None


def _run(options: argparse.Namespace) -> None:
    spec = DatasetSpec.demo() if options.demo else DatasetSpec.from_toml(options.spec)
    _apply(options, spec)
    engine = {"engine": options.engine, "address": options.address, "threads": options.threads}
    statistics = generate(spec, options.output, options.workers, options.quiet, **engine)
    for path in statistics["skipped"]:
        _tell("warning", f"left out: {path}")
    if options.quiet:
        return
    counts = ", ".join(f"{number} {name}" for name, number in statistics["classes"].items())
    _say(f"{statistics['images']} pictures with {counts}\n{Path(options.output).resolve()}")


def _say(text: str) -> None:
    """Raises FileError where standard output takes no more."""
    try:
        print(text, flush=True)
    except OSError as error:
        # What is still buffered would fail once more when Python ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise FileError(f"cannot write to standard output: {error.strerror}") from None


def _tell(kind: str, message: object) -> None:
    """One line, as the rest of the command line says it."""
    print(f"easypbr: {kind}: {message}".replace("\n", " "), file=sys.stderr)


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns the exit code: 0, 1 when the job failed, 2 for a wrong command, 130 for Ctrl-C."""
    try:
        _run(_parsed(arguments))
    except _UsageError as error:
        _tell("error", f"dataset: {error} (see 'easypbr dataset --help')")
        return 2
    except (Error, OSError, ImportError) as error:
        _tell("error", error)
        return 1
    except MemoryError:
        _tell("error", "out of memory: try fewer workers or a smaller image; what is finished is kept")
        return 1
    except KeyboardInterrupt:
        print("easypbr: interrupted: started again it goes on", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
