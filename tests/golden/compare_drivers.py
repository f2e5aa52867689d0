"""Draws the golden scenes on Mesa's drivers for the CPU and prints how far each picture is from the committed one. The exit
status is 1 where one disagrees or a driver is missing.

    .venv/bin/python tests/golden/compare_drivers.py [DRIVER...]

zink needs Debian's mesa-vulkan-drivers; softpipe offers less than OpenGL 4.5, and draws by what it has of it.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
# What chooses a driver, and what its name begins with.
DRIVERS = {
    "native": ({"EASYPBR_NATIVE": "1"}, ""),
    "llvmpipe": ({"GALLIUM_DRIVER": "llvmpipe"}, "llvmpipe"),
    "softpipe": ({"GALLIUM_DRIVER": "softpipe", "MESA_GL_VERSION_OVERRIDE": "4.5", "MESA_GLSL_VERSION_OVERRIDE": "450"},
                 "softpipe"),
    "zink": ({"GALLIUM_DRIVER": "zink", "LIBGL_ALWAYS_SOFTWARE": "1"}, "zink"),
}
# Larger bounds of the mean and of the part above 8, and why.
KNOWN = {
    # Softpipe's discs of 3 pixels cover other pixels at their rims, and the shading of edges sees each of these steps.
    ("softpipe", "eye_dome"): (2.0, 0.06),
}
DRAW = """
import sys, easypbr
from effects import EFFECTS
for name, draw in EFFECTS.items():
    easypbr.save_image(draw(), f"{sys.argv[1]}/{name}.png")
"""


def renderer(environment):
    """The driver's name, as easypbr's own context has it."""
    program = os.environ.get("EASYPBR_BINARY", HERE.parents[1] / "build/easypbr")
    done = subprocess.run([program, "doctor"], env=environment, capture_output=True, text=True, check=False)
    lines = (line.split(maxsplit=1) for line in done.stdout.splitlines())
    return next((line[1] for line in lines if len(line) == 2 and line[0] == "renderer"), "")


def compare(driver, folder):
    """Rows of a table, and whether all pictures agree."""
    import easypbr
    from effects import EFFECTS
    from test_golden import agrees, difference

    variables, begin = DRIVERS[driver]
    environment = {**os.environ, "EASYPBR_DEVICE": "gl", "EASYPBR_NATIVE": "0", **variables}
    name = renderer(environment)
    if not name.startswith(begin):
        return [f"{driver}: not there, the renderer is '{name}'"], False
    command = [sys.executable, "-c", DRAW, folder]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, cwd=HERE, check=False)
    if done.returncode:
        return [f"{driver}: {done.stderr.strip().splitlines()[-1]}"], False
    rows, good = [], True
    for effect in EFFECTS:
        golden = easypbr.load_image(HERE / "pictures" / f"{effect}.png")
        picture = easypbr.load_image(pathlib.Path(folder) / f"{effect}.png")
        mean, part = difference(picture, golden)
        most = abs(picture.astype(int) - golden.astype(int)).max()
        bounds = KNOWN.get((driver, effect))
        fine = agrees(picture, golden) or (bounds is not None and mean < bounds[0] and part < bounds[1])
        good &= fine
        verdict = ("  known" if bounds else "") if fine else "  disagrees"
        rows.append(f"{driver:10} {effect:30} {mean:8.4f} {100 * part:8.3f} {most:6}{verdict}")
    return rows, good


def main():
    sys.path.insert(0, str(HERE))
    print(f"{'driver':10} {'picture':30} {'mean':>8} {'% > 8':>8} {'most':>6}   codes of 255")
    good = True
    for driver in sys.argv[1:] or DRIVERS:
        with tempfile.TemporaryDirectory() as folder:
            rows, agree = compare(driver, folder)
        print("\n".join(rows), flush=True)
        good &= agree
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
