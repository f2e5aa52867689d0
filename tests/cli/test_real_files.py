"""Files that other programs wrote: each is drawn and fills the frame, without a word but for what is left out."""
import os
import pathlib

import numpy as np
import pytest

import png

DATA = os.environ.get("EASYPBR_TEST_DATA")
pytestmark = pytest.mark.skipif(not DATA, reason="left out: EASYPBR_TEST_DATA is not set")

SILENT = ["head.obj", "nefertiti.obj", "spot.obj", "bunny.ply", "room_scene.obj", "misc/brain.ply",
          "misc/matteonormb.ply", "misc/rangemap.ply", "misc/knot_max_simplified.STL", "Duck/Duck.gltf",
          "DamagedHelmet/DamagedHelmet.gltf"]
# MeshLab gives the same names to values of vertices and of faces.
SAID = {"misc/rangemap.ply": ["the scalars 'flags' of the faces are left out",
                              "the scalars 'quality' of the faces are left out"]}
# This terrain ends in corners so sharp that their last pixels have no centre inside.
SHARP = ["misc/matteonormb.ply"]


def covered(easypbr, tmp_path, *arguments):
    """The pixels that show the object, and what was said on stderr."""
    done = easypbr("render", *arguments, "-o", "out.png", "--size", "200x200", "--samples", "1",
                   "--background", "transparent", "--set", "image.antialias=none")
    return png.read(tmp_path / "out.png"), done.stderr


@pytest.mark.parametrize("name", SILENT)
def test_object_fills_the_frame(easypbr, tmp_path, name):
    pixels, said = covered(easypbr, tmp_path, pathlib.Path(DATA or "") / name)
    warnings = said.splitlines()
    assert len(warnings) == len(SAID.get(name, []))
    assert all(warning in line for warning, line in zip(SAID.get(name, []), warnings))
    rows, columns = np.nonzero(pixels[:, :, 3])
    extent = max(np.ptp(rows), np.ptp(columns)) + 1
    # The margin of 0.05 leaves 190 of 200 pixels; each of the two edges is within 1 pixel.
    assert 190 - (4 if name in SHARP else 2) <= extent <= 192
    # Lit, not black or blown out, and with more than one shade.
    shades = pixels[rows, columns, :3].astype(int).sum(axis=1)
    assert 60 < shades.mean() < 740 and shades.std() > 2


@pytest.mark.parametrize("name, missing", [("misc/bunny10k_textured.obj", "TextureDouble_A.png")])
def test_missing_texture_is_a_warning(easypbr, tmp_path, name, missing):
    pixels, said = covered(easypbr, tmp_path, pathlib.Path(DATA or "") / name)
    assert said.startswith("easypbr: warning: ") and missing in said and said.count("\n") == 1
    assert pixels[:, :, 3].any()


def test_maps_given_by_option_replace_the_materials(easypbr, tmp_path):
    folder = pathlib.Path(DATA or "") / "lantern"
    maps = {"base_color": "Base_Color", "metallic": "Metallic", "roughness": "Roughness", "normal": "Normal_OpenGL",
            "ao": "Mixed_AO"}
    options = [f"--texture={use}={folder}/textures/lantern_{name}.jpg" for use, name in maps.items()]
    pixels, _ = covered(easypbr, tmp_path, folder / "lantern_obj.obj", *options)
    shown = pixels[pixels[:, :, 3] == 255][:, :3].astype(int)
    # The lantern is painted red.
    assert ((shown[:, 0] > 2 * shown[:, 1]) & (shown[:, 0] > 2 * shown[:, 2])).mean() > 0.2
