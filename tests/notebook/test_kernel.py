"""Notebooks without a browser: what is saved, and kernels without support for widgets."""

import base64
import subprocess
import sys

import nbformat
import pytest
from conftest import SCENE, notebook
from jupyter_client.manager import start_new_kernel
from nbconvert import HTMLExporter
from nbconvert.preprocessors import ExecutePreprocessor

PICTURE = "data:image/png;base64,"


def executed(*cells):
    book = notebook(*cells)
    ExecutePreprocessor(timeout=120, store_widget_state=False).preprocess(book)
    return book


def test_nbconvert_keeps_the_picture(tmp_path):
    book = executed(SCENE, "view")
    data = book.cells[1].outputs[0].data
    assert base64.b64decode(data["image/png"]).startswith(b"\x89PNG")
    assert data["application/vnd.jupyter.widget-view+json"]["model_id"]
    html, _ = HTMLExporter().from_notebook_node(book)
    assert PICTURE in html and data["image/png"].replace("\n", "")[:200] in html
    # From a file too, as nbconvert is called.
    nbformat.write(book, tmp_path / "a.ipynb")
    subprocess.run([sys.executable, "-m", "nbconvert", "--to", "html", tmp_path / "a.ipynb"], check=True, capture_output=True)
    assert PICTURE in (tmp_path / "a.html").read_text()


def test_large_pictures_are_saved_as_jpeg():
    noise = "scene.show(easypbr.as_mesh(__import__('numpy').random.default_rng(1).random((60000, 6))), 'noise')"
    book = executed(SCENE, noise, "view.widget(size=(800, 600))")
    data = book.cells[2].outputs[0].data
    assert "image/png" not in data
    assert base64.b64decode(data["image/jpeg"]).startswith(b"\xff\xd8")


def test_without_anywidget_it_is_the_picture_alone():
    hide = "import sys; sys.modules['anywidget'] = None"
    book = executed(hide, SCENE, "view", "try:\n    view.widget()\nexcept ImportError as error:\n    print(error)")
    assert set(book.cells[2].outputs[0].data) == {"text/plain", "image/png"}
    assert "pip install easypbr[jupyter]" in book.cells[3].outputs[0].text


def test_importing_brings_nothing_of_notebooks():
    modules = "import easypbr, sys; print([name for name in ('anywidget', 'ipywidgets', 'IPython', 'traitlets') if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", modules], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("size, message", [("(0, 5)", "from 16 to 4096"), ("5", "expected \\(width, height\\)"), ("(1.5, 2)", "whole numbers")])
def test_wrong_sizes_are_told(size, message):
    with pytest.raises(Exception, match=message):
        executed(SCENE, f"view.widget(size={size})")


def test_closing_ends_the_threads():
    count = "import threading; print(sum(thread.name == 'easypbr widget' for thread in threading.enumerate()))"
    settle = "w.close(); v = None; import time; time.sleep(1.5)"
    book = executed(SCENE, "w = view.widget(); v = view.widget()", count, settle, count)
    assert [book.cells[number].outputs[0].text.strip() for number in (2, 4)] == ["2", "1"]


def test_what_is_no_message_harms_nothing():
    manager, client = start_new_kernel()
    try:
        client.execute_interactive(SCENE + "\nw = view.widget(); opened = w.comm.comm_id", output_hook=lambda _: None, timeout=120)
        answer = client.execute_interactive("", user_expressions={"id": "opened"}, output_hook=lambda _: None, timeout=60)
        comm = answer["content"]["user_expressions"]["id"]["data"]["text/plain"].strip("'")
        for content in (None, [], {}, {"client": "x"}, {"client": -1}, {"client": 1.5}, {"client": 2**70}, {"client": 5, "text": "nonsense"},
                        {"client": 6, "text": 7}, {"client": 7, "gone": True}, {"client": 8, "text": '{"kind":"set","name":"x","value":"y"}'}):
            message = client.session.msg("comm_msg", {"comm_id": comm, "data": {"method": "custom", "content": content}})
            client.shell_channel.send(message)
        seen = []
        client.execute_interactive("print(w._channel.is_open)", output_hook=lambda message: seen.append(message["content"]), timeout=60)
        assert any(content.get("text", "").strip() == "True" for content in seen)
        assert not any("traceback" in content for content in seen)
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)


COUNT = "import threading, time; time.sleep(1.5); print(sum(thread.name == 'easypbr widget' for thread in threading.enumerate()))"


def test_a_widget_ends_with_its_view():
    book = executed(SCENE, "from IPython.display import display\ndisplay(view)", COUNT, "view = None\nimport gc; gc.collect()", COUNT)
    assert [book.cells[number].outputs[0].text.strip() for number in (2, 4)] == ["1", "0"]


def test_a_widget_keeps_a_view_that_nobody_else_does():
    book = executed(SCENE, "w = view.widget(); view = None\nimport gc; gc.collect()", "w.keep(); print(w.comm is not None)", COUNT)
    assert [book.cells[number].outputs[0].text.strip() for number in (2, 3)] == ["True", "1"]


def test_a_cell_that_shows_another_view_ends_what_it_showed():
    cells = "import easypbr.widget\neasypbr.widget._running_cell = lambda: (cell, str(len(In)))\ncell = 'a'"
    again = SCENE + "\nview"
    both = "cell = 'b'\nother = easypbr.Viewer((320, 240), scene=scene)\ndisplay(view)\ndisplay(other)"
    # What the last run of cell a showed is shown in cell b, too, with another one.
    book = executed(cells, again, again, COUNT, both, COUNT, "cell = 'a'\n" + again, COUNT)
    assert [book.cells[number].outputs[-1].text.strip() for number in (3, 5, 7)] == ["1", "2", "3"]
