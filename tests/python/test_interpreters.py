"""Sub-interpreters of Python are refused, and leave the main interpreter's module as it is."""
import subprocess
import sys

import pytest

PROGRAM = """
# As servers make them; into isolated ones Python itself lets no module of this kind.
try:
    import _interpreters as interpreters
    options = {"config": "legacy"}
except ImportError:
    import _xxsubinterpreters as interpreters
    options = {"isolated": False}

TRY = '''
try:
    import easypbr
    print(easypbr.shapes.box().V.shape)
except ImportError as error:
    print("refused:", error, flush=True)
'''


def run():
    one = interpreters.create(**options)
    interpreters.run_string(one, TRY)
    interpreters.destroy(one)


if BEFORE:
    run()
import easypbr
run()
print(easypbr.shapes.box().V.shape, len(easypbr.render(easypbr.shapes.box(), size=(16, 12))), flush=True)
"""


@pytest.mark.parametrize("before", [False, True])
def test_a_sub_interpreter_is_refused(before):
    """Also where it comes before the main interpreter."""
    # A call in a sub-interpreter would never end.
    done = subprocess.run([sys.executable, "-c", PROGRAM.replace("BEFORE", str(before))], capture_output=True, text=True,
                          timeout=120)
    assert done.returncode == 0, done.stderr
    *refused, shape = done.stdout.splitlines()
    assert len(refused) == 1 + before
    assert all(line.startswith("refused: easypbr works in the main interpreter only") for line in refused)
    # A box has three vertices of its own for each of 8 corners.
    assert shape == "(24, 3) 12"
