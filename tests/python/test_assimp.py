"""What assimp reads, and files that it does not survive: they end its own process, and are errors here."""
import logging
import os
import pathlib
import signal
import subprocess
import sys
import time
import zipfile

import pytest

from easypbr import FormatError, Mesh, MeshLoader, shapes

#: A limit of a second, and what a busy machine may add; the limit on a file's time is 60 s.
SOON_S = 20

#: assimp reads its vertex 77777777: SIGSEGV.
CRASHING_ASE = """*3DSMAX_ASCIIEXPORT 200
*GEOMOBJECT {
*MESH {
*MESH_NUMVERTEX 3
*MESH_NUMFACES 1
*MESH_VERTEX_LIST {
*MESH_VERTEX 0 0 0 0
*MESH_VERTEX 1 1 0 0
*MESH_VERTEX 2 0 1 0
}
*MESH_FACE_LIST {
*MESH_FACE 0: A: 77777777 B: 1 C: 2 AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 0 *MESH_MTLID 0
}
}
}
"""

#: assimp waits at the end of the file for a name.
ENDLESS_SMD = "version 1\nnodes\n0\n"


@pytest.fixture
def crashing(tmp_path):
    path = tmp_path / "crash.ase"
    path.write_text(CRASHING_ASE)
    try:
        Mesh(path)
    except FormatError as error:
        if "crashed" not in str(error):
            pytest.skip("left out: built without the assimp reader")
    return path


def children(process: int) -> list[int]:
    tasks = pathlib.Path(f"/proc/{process}/task")
    return [int(child) for task in tasks.iterdir() for child in (task / "children").read_text().split()]


def is_running(process: int) -> bool:
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_a_crash_is_an_error_with_the_file_s_name(crashing):
    with pytest.raises(FormatError, match=r"crash\.ase: the assimp reader crashed \(signal 11\)"):
        Mesh(crashing)


def test_the_loader_skips_a_file_that_crashes(crashing, tmp_path):
    good = tmp_path / "good.ply"
    shapes.sphere().save(good)
    count = len(Mesh(good).V)
    loader = MeshLoader([good, crashing, good, crashing, good], transform=lambda mesh: len(mesh.V), on_error="skip")
    assert list(loader) == [count] * 3


def test_the_reader_does_not_outlive_its_parent(crashing, tmp_path):
    path = tmp_path / "endless.smd"
    path.write_text(ENDLESS_SMD)
    parent = subprocess.Popen([sys.executable, "-c", f"import easypbr; easypbr.Mesh({str(path)!r})"], env=os.environ)
    end = time.monotonic() + SOON_S
    readers: list[int] = []
    while not readers and time.monotonic() < end:
        time.sleep(0.2)
        readers = children(parent.pid)
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    assert readers
    while any(map(is_running, readers)) and time.monotonic() < end:
        time.sleep(0.05)
    assert not any(map(is_running, readers))


#: The parts of a 3MF file but its model.
CONTENT_TYPES = """<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>"""
RELATIONSHIPS = """<?xml version="1.0"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="r0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"""
VERTICES = '<vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices>'
TRIANGLE = '<triangle v1="0" v2="1" v3="2"/>'


def object_of_3mf(number: int, properties: str = "", triangles: str = TRIANGLE) -> str:
    return (f'<object id="{number}" type="model" {properties}><mesh>{VERTICES}'
            f"<triangles>{triangles}</triangles></mesh></object>")


def read_3mf(path: pathlib.Path, resources: str, object_count: int = 1) -> list[Mesh]:
    """The meshes of a 3MF file with these resources, whose objects are 1, 2, ..., that have faces."""
    items = "".join(f'<item objectid="{i + 1}"/>' for i in range(object_count))
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("[Content_Types].xml", CONTENT_TYPES)
        file.writestr("_rels/.rels", RELATIONSHIPS)
        file.writestr(
            "3D/3dmodel.model", '<?xml version="1.0"?><model unit="millimeter" '
            'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" '
            'xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">'
            f"<resources>{resources}</resources><build>{items}</build></model>")
    return surfaces(Mesh(path))


def surfaces(mesh: Mesh) -> list[Mesh]:
    return ([mesh] if len(mesh.F) else []) + [found for child in mesh.children for found in surfaces(child)]


@pytest.mark.parametrize("text, opacity", [("#FF8000", 1), ("#FF8000FF", 1), ("#ff800033", 0.2)])
def test_display_colors_of_3mf_are_srgb(crashing, tmp_path, text, opacity):
    """3MF Core Specification, 3.4.1.1: sRGB and alpha. 128 is ((128 / 255 + 0.055) / 1.055)^2.4 = 0.21586, to 5 digits."""
    materials = f'<basematerials id="9"><base name="x" displaycolor="{text}"/></basematerials>'
    mesh, = read_3mf(tmp_path / "a.3mf", materials + object_of_3mf(1, 'pid="9" pindex="0"'))
    assert mesh.material.base_color == pytest.approx((1, 0.21586, 0), abs=1e-5)
    assert mesh.material.opacity == pytest.approx(opacity, abs=1e-6)


def test_a_3mf_file_without_materials_has_the_default_color(crashing, tmp_path):
    """assimp's default material is no display colour: as sRGB, its 0.6 would be 0.319."""
    mesh, = read_3mf(tmp_path / "a.3mf", object_of_3mf(1))
    assert mesh.material.base_color == shapes.box().material.base_color


def test_colors_of_3mf_that_are_not_read_are_named(crashing, tmp_path, caplog):
    bases = "".join(f'<base name="{color}" displaycolor="{color}"/>' for color in ("#FF0000", "#00FF00"))
    materials = f'<basematerials id="9">{bases}</basematerials>'
    red, green = (TRIANGLE.replace("/>", f' pid="9" p1="{i}"/>') for i in (0, 1))
    with caplog.at_level(logging.WARNING, "easypbr"):
        read_3mf(tmp_path / "one.3mf", materials + object_of_3mf(1, triangles=red + red))
        assert not caplog.messages
        read_3mf(tmp_path / "two.3mf", materials + object_of_3mf(1, triangles=red + green))
    message, = caplog.messages
    assert message.endswith("left out: materials of single triangles (objects: 1)")


#: A triangle of an AMF file, with what stands between its vertices and their use.
AMF = """<?xml version="1.0"?><amf unit="millimeter"><object id="0"><mesh><vertices>
<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates></vertex></vertices>
<volume>COLOR<triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object></amf>"""


@pytest.mark.parametrize("text, colors", [("", []), ("<color><r>1</r><g>0.5</g><b>0</b></color>", [[1, 0.5, 0, 1]] * 3),
                                          ("<color><r>0</r><g>0</g><b>0</b></color>", [[0, 0, 0, 1]] * 3)])
def test_an_amf_file_without_colors_has_none(crashing, tmp_path, text, colors):
    """assimp gives it transparent black at each vertex; 1, 0.5 and 0 are exact."""
    path = tmp_path / "a.amf"
    path.write_text(AMF.replace("COLOR", text))
    mesh, = surfaces(Mesh(path))
    assert mesh.C.tolist() == colors
