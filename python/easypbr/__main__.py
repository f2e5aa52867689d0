"""The command line: python -m easypbr."""

import sys

from ._easypbr import main as run


def main() -> int:
    return run(["easypbr", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
