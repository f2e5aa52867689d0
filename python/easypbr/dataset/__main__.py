"""easypbr dataset, as the command line runs it."""

import argparse
import sys
from pathlib import Path

from ..errors import Error
from .run import generate
from .spec import DatasetSpec


def main(arguments=None) -> int:
    """Runs the command; returns the exit code: 0, 1 when the job failed, 2 for a wrong command, 130 for Ctrl-C."""
    parser = argparse.ArgumentParser(prog="easypbr dataset", description="Generate pictures with annotations for training.")
    parser.add_argument("spec", nargs="?", help="what to generate, a TOML file")
    parser.add_argument("--demo", action="store_true", help="generate the built-in drones")
    parser.add_argument("-o", "--output", help="folder to write")
    parser.add_argument("--count", type=int, help="number of pictures")
    parser.add_argument("--seed", type=int, help="another seed gives other pictures")
    parser.add_argument("--workers", type=int, help="processes that draw")
    parser.add_argument("--threads", type=int, help="cores of each worker")
    parser.add_argument("--engine", choices=("local", "ray"), default="local", help="who runs the workers")
    parser.add_argument("--address", help="of a cluster of Ray: HOST:PORT, or auto")
    parser.add_argument("--writers", help="formats, separated by commas")
    parser.add_argument("--on-error", choices=("stop", "skip"), help="of a mesh that cannot be read")
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")
    options = parser.parse_args(arguments)
    if bool(options.spec) == options.demo:
        parser.error("expected a SPEC or --demo")
    if not options.output:
        parser.error("expected -o FOLDER")
    try:
        spec = DatasetSpec.demo() if options.demo else DatasetSpec.from_toml(options.spec)
        for name in ("count", "seed", "on_error"):
            if getattr(options, name) is not None:
                setattr(spec, name, getattr(options, name))
        if options.writers:
            spec.writers = tuple(options.writers.split(","))
        engine = {"engine": options.engine, "address": options.address, "threads": options.threads}
        statistics = generate(spec, options.output, options.workers, options.quiet, **engine)
    except (Error, OSError, ImportError) as error:
        print(f"easypbr: error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("easypbr: interrupted: started again it goes on", file=sys.stderr)
        return 130
    for path in statistics["skipped"]:
        print(f"easypbr: warning: left out: {path}", file=sys.stderr)
    counts = ", ".join(f"{number} {name}" for name, number in statistics["classes"].items())
    print(f"{statistics['images']} pictures with {counts}\n{Path(options.output).resolve()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
