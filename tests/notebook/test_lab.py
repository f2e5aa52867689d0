"""The widget in JupyterLab, driven as a person drives it."""

import base64

from conftest import PATIENCE_MS, SCENE
from playwright.sync_api import expect

import easypbr


def test_a_drag_turns_the_view_and_nothing_else_happens(open_lab):
    lab = open_lab("drag.ipynb", SCENE, "view", "print('cells', len(In))")
    lab.run(0)
    lab.run(1)
    first = lab.exact()
    before = lab.pixels()
    lab.drag(80, 30)
    second = lab.exact(0, first)
    assert lab.pixels() != before
    # Keys of JupyterLab's command mode: "a" adds a cell, "d d" deletes one. Here they fly.
    cells = lab.page.locator(".jp-Notebook .jp-Cell").count()
    for key in ("a", "d", "d"):
        lab.page.keyboard.press(key, delay=50)
    lab.exact(0, second)
    assert lab.page.locator(".jp-Notebook .jp-Cell").count() == cells


def test_at_rest_the_picture_is_the_rendered_one(open_lab):
    lab = open_lab("rest.ipynb", SCENE, "view.widget(size=(300, 200))")
    lab.run(0)
    lab.run(1)
    lab.exact()
    shown = easypbr._easypbr.decode_image(base64.b64decode(lab.pixels().partition(",")[2]))
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.box((3, 0.2, 0.5)), "bar")
    view = easypbr.Viewer((320, 240), {"image": {"samples": 4}}, scene=scene)
    assert shown.shape[:2] == (200, 300)
    assert (shown == view.render((300, 200))).all()


def test_cells_share_a_view_and_widgets_have_their_own(open_lab):
    lab = open_lab("several.ipynb", SCENE, "view", "view", "w = view.widget(size=(200, 150)); w", width=1000, height=1400)
    for cell in range(4):
        lab.run(cell)
    first = [lab.exact(number) for number in range(3)]
    before = [lab.pixels(number) for number in range(3)]
    lab.drag(70, 0, 1)
    lab.exact(1, first[1])
    lab.exact(0, first[0])
    assert lab.pixels(0) != before[0] and lab.pixels(1) != before[1]
    assert lab.pixels(0) == lab.pixels(1)
    assert lab.pixels(2) == before[2]
    lab.drag(50, 20, 2)
    lab.exact(2, first[2])
    assert lab.pixels(2) != before[2]


def test_the_program_changes_what_is_shown(open_lab):
    lab = open_lab("change.ipynb", SCENE, "view", "view.settings.material.color = '#ff0000'", "scene.show(easypbr.shapes.sphere(1), 'ball')")
    lab.run(0)
    lab.run(1)
    newest = lab.exact()
    for cell in (2, 3):
        before = lab.pixels()
        lab.run(cell)
        newest = lab.exact(0, newest)
        assert lab.pixels() != before


def test_it_moves_while_a_cell_runs(open_lab):
    busy = "import time\nend = time.time() + 15\nwhile time.time() < end: sum(range(10000))\nprint('done')"
    lab = open_lab("busy.ipynb", SCENE, "view", busy)
    lab.run(0)
    lab.run(1)
    newest = lab.exact()
    before = lab.pixels()
    lab.run(2)
    lab.page.wait_for_timeout(500)
    lab.drag(80, 0)
    lab.exact(0, newest)
    assert lab.pixels() != before
    assert lab.page.locator(".jp-Notebook .jp-CodeCell").nth(2).locator(".jp-OutputArea-output pre").count() == 0
    assert lab.text_of(2) == "done"


def test_where_bytes_are_lost_pictures_come_as_text(open_lab):
    """As in Colab, whose front end drops the buffers of messages."""
    loses = ("w = view.widget(size=(300, 200))\nkept, texts = w.send, []\n"
             "def send(content, buffers=None):\n    texts.append('data' in content)\n    kept(content)\n"
             "w.send = send\nw")
    lab = open_lab("lossy.ipynb", SCENE, loses, "print(sum(texts) > 1)")
    lab.run(0)
    lab.run(1)
    first = lab.exact()
    before = lab.pixels()
    lab.drag(80, 0)
    lab.exact(0, first)
    assert lab.pixels() != before
    lab.run(2)
    assert lab.text_of(2) == "True"


def test_frames_on_their_way_are_few(open_lab):
    spy = """sent, most = 0, 0
widget = view.widget(size=(300, 200))
import json
original_send, original_receive = widget.send, widget._channel.receive
on_way = set()
def spy_send(content, buffers=None):
    global most
    if buffers:
        on_way.add(int.from_bytes(buffers[0][4:8], "little"))
        most = max(most, len(on_way))
    original_send(content, buffers)
widget.send = spy_send
widget.on_msg(lambda _, content, __: on_way.discard(json.loads(content["text"]).get("frame")) if content.get("text") else None)
widget"""
    lab = open_lab("window.ipynb", SCENE, spy, "print(most)")
    lab.run(0)
    lab.run(1)
    newest = lab.exact()
    for _ in range(3):
        lab.drag(60, 20)
    lab.exact(0, newest)
    lab.run(2)
    assert 1 <= int(lab.text_of(2)) <= 9


def test_controls_fold_out_and_set(open_lab):
    lab = open_lab("controls.ipynb", SCENE, "view.widget(size=(700, 480))", width=1200)
    lab.run(0)
    lab.run(1)
    newest = lab.exact()
    before = lab.pixels()
    lab.canvas().hover()
    lab.page.get_by_role("button", name="Controls").click()
    lab.page.get_by_role("tab", name="Settings").click()
    lab.page.get_by_placeholder("Search settings").fill("exposure")
    lab.page.get_by_label("exposure", exact=True).first.fill("3")
    lab.page.keyboard.press("Enter")
    lab.exact(0, newest)
    assert lab.pixels() != before


def test_a_reload_brings_it_back(open_lab):
    lab = open_lab("reload.ipynb", SCENE, "view")
    lab.run(0)
    lab.run(1)
    lab.exact()
    book = lab.save()
    assert "image/png" in book.cells[1].outputs[0].data
    lab.page.reload()
    lab.page.wait_for_selector(".jp-Notebook .jp-Cell")
    lab.exact()


def test_a_kernel_that_began_anew_is_told(open_lab):
    lab = open_lab("anew.ipynb", SCENE, "view")
    lab.run(0)
    lab.run(1)
    lab.exact()
    lab.page.evaluate("() => { window.jupyterapp.commands.execute('kernelmenu:restart'); }")
    lab.page.locator(".jp-Dialog button", has_text="Restart").click()
    expect(lab.page.locator(".jp-OutputArea .silence")).to_contain_text("this picture stands still")
    lab.drag(60, 10)
    lab.run(0)
    lab.run(1)
    lab.exact()
    expect(lab.page.locator(".jp-OutputArea .silence")).to_have_count(0)


def test_a_cell_that_runs_again_ends_its_last_view(open_lab):
    count = "import threading, time; time.sleep(1.5); print(sum(thread.name == 'easypbr widget' for thread in threading.enumerate()))"
    lab = open_lab("again.ipynb", SCENE + "\nview", count)
    for _ in range(2):
        lab.run(0)
        lab.page.wait_for_timeout(2000)
    lab.exact()
    lab.run(1)
    assert lab.text_of(1) == "1"


def test_pages_of_other_sizes_take_clicks_at_their_place(open_lab):
    count = "print(view._widget()._channel.client_count())"
    lab = open_lab("pages.ipynb", SCENE, "view", count)
    lab.run(0)
    lab.run(1)
    lab.exact()
    lab.save()
    signed_in = lab.page.context.storage_state()
    context = lab.page.context.browser.new_context(storage_state=signed_in, viewport={"width": 1000, "height": 900}, device_scale_factor=2)
    page = context.new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.goto(lab.page.url)
    canvas = page.locator(".jp-OutputArea canvas.picture")
    expect(canvas).to_have_attribute("data-exact", "true")
    lab.canvas().click()  # In the middle.
    expect(lab.page.locator(".jp-OutputArea .read-out strong")).to_have_text("bar")
    canvas.click()
    expect(page.locator(".jp-OutputArea .read-out strong")).to_have_text("bar")
    context.close()
    lab.page.wait_for_timeout(1500)
    lab.run(2)
    assert lab.text_of(2) == "1"
