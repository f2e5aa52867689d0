"""The command line: python -m easypbr."""

import os
import signal
import sys

from ._easypbr import main as run


def main() -> int:
    """Runs the command line on sys.argv; returns the exit code."""
    # Python's handlers would wait for the native job to end. Ignored it is in the background of a script.
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    # The command that hands over to this package.
    os.environ["EASYPBR_PYTHON"] = sys.executable
    return run(["easypbr", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
