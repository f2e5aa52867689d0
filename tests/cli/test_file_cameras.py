"""Cameras that a glTF file holds can be looked through by name and by number."""
import json

import png


def write_gltf(path):
    """A square in the plane z = 0 and two cameras: one sees it whole, one looks away."""
    import base64
    import struct
    vertices = struct.pack("<12f", -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0)
    faces = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    data = "data:application/octet-stream;base64," + base64.b64encode(vertices + faces).decode()
    perspective = {"type": "perspective", "perspective": {"yfov": 0.4, "znear": 0.1}}
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 20]},
                  {"camera": 1, "translation": [0, 0, 20], "rotation": [0, 1, 0, 0]}],
        "cameras": [{"name": "front", **perspective}, {"name": "turned away", **perspective}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0],
                       "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": 60, "uri": data}]}))


def covered(path):
    return int((png.read(path)[..., 3] > 127).sum())


def test_cameras_of_a_file(render, tmp_path):
    scene = tmp_path / "scene.gltf"
    write_gltf(scene)
    for camera in ("front", "0"):
        render(scene, "-o", tmp_path / "a.png", "--camera", camera, "--background", "transparent", "--size", "100x100")
        # 2 units of 40 tan(0.2) = 8.108 that the picture is high: 24.67 pixels to a side.
        assert abs(covered(tmp_path / "a.png") - 24.67 ** 2) < 50
    render(scene, "-o", tmp_path / "b.png", "--camera", "turned away", "--background", "transparent")
    assert covered(tmp_path / "b.png") == 0
    done = render(scene, "-o", tmp_path / "c.png", "--camera", "frnt", code=1)
    assert "did you mean 'front'?" in done.stderr


def test_file_without_cameras(render, meshes, tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert "no camera" in render(tmp_path / "a.obj", "-o", tmp_path / "c.png", "--camera", "0", code=1).stderr
