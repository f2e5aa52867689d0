"""What files hold beside a mesh, workers, and pictures that would be empty."""
import base64
import json
import multiprocessing
import os
import struct

import numpy as np
import pytest

import easypbr


def write_lit_square(path):
    """A square in the plane z = 0 with a point light of 8 candela 2 before it."""
    data = struct.pack("<12f6H", -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 1, 2, 0, 2, 3)
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "lamp", "intensity": 8}]}},
        "nodes": [{"mesh": 0}, {"translation": [0, 0, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0],
                       "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64," +
                     base64.b64encode(data).decode()}]}))


def test_lights_of_a_file_are_drawn(tmp_path):
    write_lit_square(tmp_path / "lit.gltf")
    assert easypbr.load_scene(tmp_path / "lit.gltf").lights["lamp"].intensity == 8
    common = dict(size=(33, 33), samples=1, hdr=True, roughness=1, metallic=0, color="#ffffff",
                  settings={"environment.enabled": False, "lights.key.enabled": False, "lights.fill.enabled": False,
                            "lights.rim.enabled": False, "shading.dielectric_f0": 0, "shading.multiple_scattering": False,
                            "camera.position": (0, 0, 6), "camera.target": (0, 0, 0)})
    picture = easypbr.render(tmp_path / "lit.gltf", **common)
    # Lambert: albedo I / (pi d^2), seen along the normal.
    assert picture[16, 16, 0] == pytest.approx(8 / (np.pi * 4), rel=0.005)
    content = json.loads((tmp_path / "lit.gltf").read_text())
    content["extensions"]["KHR_lights_punctual"]["lights"][0]["range"] = 3
    (tmp_path / "lit.gltf").write_text(json.dumps(content))
    for path in (False, True):
        common["settings"].update({"path.enabled": path, "ground.mode": "none"})
        picture = easypbr.render(tmp_path / "lit.gltf", **common)
        # KHR_lights_punctual: times 1 - (d / range)^4. Nothing else sends light to the square.
        assert picture[16, 16, 0] == pytest.approx(8 / (np.pi * 4) * (1 - (2 / 3) ** 4), rel=0.005)


def test_material_variants_are_chosen_by_name(tmp_path):
    write_lit_square(tmp_path / "plain.gltf")
    content = json.loads((tmp_path / "plain.gltf").read_text())
    content["materials"] = [{"name": "grey"}, {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}]
    content["extensions"]["KHR_materials_variants"] = {"variants": [{"name": "street red"}]}
    mappings = {"mappings": [{"material": 1, "variants": [0]}]}
    content["meshes"][0]["primitives"][0].update(material=0, extensions={"KHR_materials_variants": mappings})
    path = tmp_path / "shoe.gltf"
    path.write_text(json.dumps(content))
    assert easypbr.load_scene(path).variants == ["street red"]
    assert easypbr.load_scene(path).mesh.children[0].material.name == "grey"
    red = easypbr.load_scene(path, variant="street red").mesh.children[0].material
    assert (red.name, red.base_color) == ("red", (1, 0, 0))
    with pytest.raises(easypbr.UnknownNameError, match="did you mean 'street red'"):
        easypbr.load_scene(path, variant="street rod")


def render_in_child(connection):
    try:
        easypbr.render(easypbr.shapes.sphere(), size=(16, 16), samples=1)
        connection.send("drew")
    except easypbr.ContextError as error:
        connection.send(str(error))


def test_a_forked_child_is_told_to_spawn():
    easypbr.render(easypbr.shapes.sphere(), size=(16, 16), samples=1)
    ours, theirs = multiprocessing.Pipe()
    child = multiprocessing.get_context("fork").Process(target=render_in_child, args=(theirs,))
    child.start()
    answered = ours.poll(20)
    child.kill() if not answered else child.join()
    assert answered, "the child hangs"
    assert "spawn" in ours.recv()


def test_points_without_faces_are_drawn():
    x, y = np.meshgrid(*[np.linspace(0, 1, 100)] * 2)
    V = np.stack([x, y, np.zeros_like(x)], -1).reshape(-1, 3)
    camera = {"azimuth_deg": 0, "elevation_deg": 0}
    picture = easypbr.render({"V": V}, size=(64, 64), background="transparent", camera=camera)
    # Splats leave no hole between the points of a grid; the square fills the picture but the margin of 0.05, and some pixels more.
    assert 0.95**2 - 0.01 < (picture[..., 3] > 0).mean() < 0.97


def test_values_override_textures(tmp_path):
    easypbr.save_image(np.full((4, 4, 3), 40, np.uint8), tmp_path / "dark.png")
    mesh = easypbr.shapes.plane()
    mesh.material.roughness_texture = tmp_path / "dark.png"
    view = easypbr.Viewer(size=(32, 32), scene=easypbr.Scene())
    view.scene.show(mesh, "plane")
    view.settings.camera.elevation_deg = 60
    textured = view.layers(["roughness"])["roughness"]
    view.settings.material.roughness = 0.9
    overridden = view.layers(["roughness"])["roughness"]
    assert textured.max() < 0.2
    assert overridden.max() == pytest.approx(0.9, abs=0.003)


def test_settings_files_bring_their_size(tmp_path):
    view = easypbr.Viewer(size=(40, 30), scene=easypbr.Scene())
    view.scene.show(easypbr.shapes.sphere(), "sphere")
    view.settings.image.samples = 2
    view.save_settings(tmp_path / "look.json")
    assert easypbr.render(easypbr.shapes.sphere(), settings=tmp_path / "look.json").shape == (30, 40, 4)


def test_inferred_light_can_be_scaled():
    view = easypbr.Viewer(size=(16, 16), scene=easypbr.Scene())
    view.scene.show(easypbr.shapes.sphere(), "sphere")
    before = view.lights["key"].intensity
    view.lights["key"].intensity *= 2
    assert view.settings.lights.key.intensity == pytest.approx(2 * before, rel=1e-6)


def test_ids_name_objects():
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.sphere(), "a")
    scene.show(easypbr.shapes.sphere(0.5), "b").T_parent_mesh = np.array(
        [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    view = easypbr.Viewer(size=(60, 40), scene=scene)
    ids = view.layers(["object_id"])["object_id"]
    assert set(np.unique(ids)) == {0.0, 1.0, 2.0}
    assert view.object_names() == ["a", "b"]


def test_seams_of_texture_coordinates_are_smooth(tmp_path):
    """Two squares in an angle that share an edge but not its texture coordinates: one smooth edge."""
    (tmp_path / "seam.obj").write_text(
        "v -1 0 0\nv 0 0 1\nv 0 1 1\nv -1 1 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt .1 .1\nvt .1 .9\n"
        "f 1/1 2/2 3/3 4/4\nf 2/5 5/2 6/3 3/6\n")
    view = easypbr.Viewer(size=(64, 64), scene=easypbr.Scene())
    view.scene.show(easypbr.Mesh(tmp_path / "seam.obj"), "seam")
    view.settings.camera.azimuth_deg = 0
    view.settings.camera.elevation_deg = 0
    view.settings.load.crease_deg = 180
    normals = view.layers(["normal_world"])["normal_world"]
    # By symmetry the common edge's normal is +z; flat halves would have x = -0.707 and +0.707 beside each other.
    assert np.abs(normals[32, 30:34, 0]).max() < 0.1


def test_a_file_that_asks_for_too_much_memory(tmp_path):
    path = tmp_path / "zeros.gltf"
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"mode": 0, "attributes": {"POSITION": 0}}]}],
        "accessors": [{"count": 1_000_000, "componentType": 5126, "type": "VEC3"}]}))
    with pytest.raises(easypbr.FormatError, match=r"accessors\[0\] would take 12 MB"):
        easypbr.load_scene(path, memory_gb=0.01)
    assert len(easypbr.load_scene(path, memory_gb=0.02).mesh.children[0].V) == 1_000_000
    with pytest.raises(ValueError, match="expected 0 or more GB"):
        easypbr.load_scene(path, memory_gb=-1)


def write_brushed_square(path, tangent, uv):
    """A square of anisotropic metal that faces +z, with TANGENT, and with texture coordinates or without."""
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], "f4")
    arrays = {"POSITION": corners, "NORMAL": np.tile(np.float32([0, 0, 1]), (4, 1)), "TANGENT": np.tile(np.float32(tangent), (4, 1))}
    if uv:
        arrays["TEXCOORD_0"] = (corners[:, :2] + 1) / 2
    faces = np.array([0, 1, 2, 0, 2, 3], "u4")
    data, views, accessors = b"", [], []
    for array in [*arrays.values(), faces]:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        kind = "SCALAR" if array.ndim == 1 else f"VEC{array.shape[1]}"
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126 if array.dtype == "f4" else 5125,
                          "count": len(array), "type": kind})
        data += array.tobytes()
    accessors[0] |= {"min": [-1, -1, 0], "max": [1, 1, 0]}
    primitive = {"attributes": {name: i for i, name in enumerate(arrays)}, "indices": len(arrays), "material": 0}
    material = {"pbrMetallicRoughness": {"roughnessFactor": 0.3}, "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 1}}}
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0, "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}], "materials": [material], "extensionsUsed": ["KHR_materials_anisotropy"],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data), "uri": uri}]}))


@pytest.mark.parametrize("mode", ["raster", "path"])
def test_tangents_without_texture_coordinates(tmp_path, mode):
    """Anisotropy runs along TANGENT, whether there are texture coordinates or not."""
    def picture(tangent, uv):
        write_brushed_square(tmp_path / "square.gltf", tangent, uv)
        # A ground would be seen in it.
        path, settings = tmp_path / "square.gltf", {"ground.mode": "none"}
        return easypbr.render(path, size=(48, 48), samples=1, mode=mode, settings=settings).astype(int)

    along_x, along_y = [1, 0, 0, 1], [0, 1, 0, 1]
    assert np.array_equal(picture(along_y, False), picture(along_y, True))
    # Without TANGENT the grain runs around the up axis, which is along x here.
    assert np.abs(picture(along_y, False) - picture(along_x, False)).max() > 50
