"""Material variants of glTF files are chosen by name."""
import base64
import json
import struct

import pytest

import png


@pytest.fixture
def shoe(tmp_path):
    """A square in the plane z = 0 that is grey, red or blue, without light of its own."""
    data = struct.pack("<12f6H", -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 1, 2, 0, 2, 3)
    colors = {"grey": (0.5, 0.5, 0.5, 1), "red": (1, 0, 0, 1), "blue": (0, 0, 1, 1)}
    variants = "KHR_materials_variants"
    mappings = [{"material": 1, "variants": [0]}, {"material": 2, "variants": [1]}]
    path = tmp_path / "shoe.gltf"
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "extensionsUsed": [variants, "KHR_materials_unlit"],
        "extensions": {variants: {"variants": [{"name": "street red"}, {"name": "blue"}]}},
        "materials": [{"name": name, "pbrMetallicRoughness": {"baseColorFactor": color},
                       "extensions": {"KHR_materials_unlit": {}}} for name, color in colors.items()],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0,
                                    "extensions": {variants: {"mappings": mappings}}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0],
                       "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}))
    return path


def test_info_lists_the_variants(easypbr, shoe):
    assert json.loads(easypbr("info", "--json", shoe).stdout)["variants"] == ["street red", "blue"]
    assert "variants    street red, blue\n" in easypbr("info", shoe).stdout


@pytest.mark.parametrize("command", ["render", "view"])
@pytest.mark.parametrize("options, color", [
    ((), "grey"),
    (("--variant", "street red"), "red"),
    (("--set", "load.variant=blue"), "blue"),
])  # fmt: skip
def test_a_variant_is_drawn(easypbr, shoe, tmp_path, command, options, color):
    output = ("-o", "a.png", "--samples", "1") if command == "render" else ("--screenshot", "a.png")
    looking = ("--set", "camera.position=0,0,3", "--set", "camera.target=0,0,0")
    easypbr(command, shoe, *output, "--size", "640x480", *looking, *options)
    picture = png.read(tmp_path / "a.png").astype(int)
    redder = picture[..., 0] - picture[..., 2]
    # The window has panels beside the square.
    shares = {"red": (redder > 150).mean(), "blue": (redder < -150).mean()}
    assert {name for name, share in shares.items() if share > 0.1} == {color} - {"grey"}


def test_convert_writes_the_variant(easypbr, shoe):
    easypbr("convert", shoe, "red.glb", "--variant", "street red")
    assert json.loads(easypbr("info", "--json", "red.glb").stdout)["materials"][0]["name"] == "red"


@pytest.mark.parametrize("command", [("render", "-o", "a.png", "--size", "32x24"), ("convert", "out.ply")])
def test_a_variant_of_a_file_without_any_is_a_warning(easypbr, box, command):
    done = easypbr(command[0], box, *command[1:], "--variant", "red")
    assert done.stderr == f"easypbr: warning: {box} has no material variants: 'red' changes nothing\n"


def test_an_unknown_variant_is_an_error(easypbr, shoe, tmp_path):
    error = easypbr("render", shoe, "-o", "a.png", "--variant", "Street red", code=1).stderr
    assert "has no material variant 'Street red' (did you mean 'street red'?): it has street red, blue" in error
    assert not (tmp_path / "a.png").exists()
