"""Files that clients have opened beneath a folder that is served."""

import os
import subprocess
import sys

import numpy as np
import pytest
from test_tools import tool_is, use

import easypbr
from client import Client


@pytest.fixture
def folder(tmp_path):
    """Meshes, a folder with more, what cannot be opened, and links that lead out."""
    served = tmp_path / "served"
    (served / "more").mkdir(parents=True)
    easypbr.shapes.box(3).save(served / "cube.ply")
    easypbr.shapes.torus(1, 0.3).save(served / "more" / "torus.ply")
    (served / "notes.md").write_text("no mesh")
    (served / "broken.ply").write_text("ply\n")
    easypbr.shapes.box(2).save(tmp_path / "secret.ply")
    (served / "secret.ply").symlink_to(tmp_path / "secret.ply")
    return served


@pytest.fixture
def server(view, folder):
    with view.serve(files=folder) as server:
        yield server


def opened(client, name):
    """Has a file opened; waits until it is in the scene."""
    use(client, "Files", name)
    client.until_told("notice", lambda notice: not notice["error"] and notice["text"] == f"Added {os.path.splitext(name)[0]}")


def test_folders_are_looked_through(connect):
    client = connect()
    top = tool_is(client, "Files", lambda rows: "cube.ply" in rows)
    assert {"more/", "cube.ply", "broken.ply"} <= set(top)
    assert not {"notes.md", "secret.ply", ".."} & set(top)
    use(client, "Files", "more/")
    deep = tool_is(client, "Files", lambda rows: "torus.ply" in rows)
    assert "/more" in deep and "cube.ply" not in deep
    use(client, "Files", "..")
    tool_is(client, "Files", lambda rows: "cube.ply" in rows and ".." not in rows)
    use(client, "Files", "Find", "CUB")
    found = tool_is(client, "Files", lambda rows: "broken.ply" not in rows)
    assert "cube.ply" in found


def test_what_a_client_opens_is_shown_to_all(view, connect, tmp_path):
    client, other = connect(), connect()
    first = other.until_exact()
    opened(client, "cube.ply")
    assert view.scene.names() == ["ball", "cube"]
    second = other.until_exact(first.number)
    assert not np.array_equal(second.image(tmp_path), first.image(tmp_path))
    # The next one takes its place; what the program shows stays.
    use(client, "Files", "more/")
    tool_is(client, "Files", lambda rows: "torus.ply" in rows)
    opened(client, "torus.ply")
    assert view.scene.names() == ["ball", "torus"]
    use(client, "Files", "Add to what is shown", "true")
    use(client, "Files", "..")
    tool_is(client, "Files", lambda rows: "cube.ply" in rows)
    opened(client, "cube.ply")
    assert view.scene.names() == ["ball", "cube", "torus"]


def test_nothing_outside_is_opened(view, connect, folder):
    client = connect()
    client.until_exact()
    for name in ("secret.ply", "../secret.ply", str(folder.parent / "secret.ply"), "more/torus.ply"):
        use(client, "Files", name)
    opened(client, "cube.ply")
    assert view.scene.names() == ["ball", "cube"]


def test_what_a_file_names_outside_is_left_out(view, connect, folder):
    """An OBJ's materials beside the folder; a link that was put into its place after it was listed."""
    (folder.parent / "red.mtl").write_text("newmtl red\nKd 1 0 0\n")
    (folder / "inner.mtl").write_text("newmtl red\nKd 0 1 0\n")
    for name, library in (("outer", "../red.mtl"), ("inner", "inner.mtl")):
        (folder / f"{name}.obj").write_text(f"mtllib {library}\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    client = connect()
    tool_is(client, "Files", lambda rows: "inner.obj" in rows)
    opened(client, "inner.obj")
    assert view.scene.get("inner").material.base_color == pytest.approx([0, 1, 0])
    opened(client, "outer.obj")
    assert view.scene.get("outer").material.base_color != pytest.approx([1, 0, 0])
    (folder / "cube.ply").unlink()
    (folder / "cube.ply").symlink_to(folder.parent / "secret.ply")
    use(client, "Files", "cube.ply")
    client.until_told("notice", lambda notice: notice["error"] and "outside of the folder" in notice["text"])
    assert view.scene.names() == ["ball", "outer"]


def test_damaged_files_are_said(view, connect):
    client = connect()
    tool_is(client, "Files", lambda rows: "broken.ply" in rows)
    use(client, "Files", "broken.ply")
    client.until_told("notice", lambda notice: notice["error"] and "broken.ply" in notice["text"])
    assert view.scene.names() == ["ball"]


def test_watchers_and_own_views_see_no_names(server, connect):
    controls, watches = connect(), connect(server.watch_url)
    tool_is(controls, "Files", lambda rows: "cube.ply" in rows)
    watches.until_exact()
    watches.collect(0.5)
    assert "Files" not in watches.tools and "Lights" in watches.tools
    use(watches, "Files", "cube.ply")
    watches.until_told("notice", lambda notice: notice["error"])


def test_without_a_folder_there_is_no_such_panel(view):
    with view.serve() as server:
        client = Client(server.url)
        client.until_exact()
        assert "Files" not in client.tools
        use(client, "Files", "a.ply")
        client.until_told("notice", lambda notice: notice["error"] and "there is no panel 'Files'" in notice["text"])
        client.close()
    with pytest.raises(easypbr.FileError, match="No such file"):
        view.serve(files="nowhere")


def test_the_command_line_needs_no_file(folder):
    program = [sys.executable, "-m", "easypbr", "serve"]
    bare = subprocess.run(program, capture_output=True, text=True, check=False)
    assert bare.returncode != 0 and "--files FOLDER" in bare.stderr
    with subprocess.Popen([*program, "--files", str(folder)], stdout=subprocess.PIPE, text=True) as served:
        url = served.stdout.readline().split()[1]
        client = Client(url)
        try:
            tool_is(client, "Files", lambda rows: "cube.ply" in rows)
            opened(client, "cube.ply")
            client.until_exact()
        finally:
            client.close()
            served.terminate()
