"""The executable under test: $EASYPBR_BINARY, else the one that `make build` leaves in build/."""
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARY = pathlib.Path(os.environ.get("EASYPBR_BINARY", ROOT / "build/easypbr"))
