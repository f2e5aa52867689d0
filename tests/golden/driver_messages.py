"""Draws every golden scene by OpenGL in a debug context, and prints what the driver said as JSON."""
import json
import logging

from effects import EFFECTS

import easypbr

FOR_THEIR_SPEED = "OpenGL performance: "


class Messages(logging.Handler):
    """Keeps the errors and the hints of the driver."""

    def __init__(self):
        super().__init__()
        self.errors, self.performance = [], []

    def emit(self, record):
        text = record.getMessage()
        if text.startswith(FOR_THEIR_SPEED):
            self.performance.append(text.removeprefix(FOR_THEIR_SPEED))
        elif text.startswith("OpenGL: "):
            self.errors.append(text)


def main():
    messages = Messages()
    logger = logging.getLogger("easypbr")
    logger.setLevel(logging.DEBUG)
    logger.addHandler(messages)
    for draw in EFFECTS.values():
        draw()
    device = easypbr.Viewer((8, 8)).device
    print(json.dumps({"device": device, "errors": messages.errors, "performance": sorted(set(messages.performance))}))


if __name__ == "__main__":
    main()
