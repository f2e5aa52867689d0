"""Files are read and drawn alike under every locale. Python takes that of letters (LC_CTYPE) from the environment; in Turkish,
toupper('i') and tolower('I') are no ASCII letters and leave these as they are."""
import json
import os
import subprocess
import sys

import numpy as np
import pytest

import easypbr
from easypbr import Material, Mesh

PROGRAM = """
import ctypes, json, locale, pathlib, sys
import easypbr

folder = pathlib.Path(sys.argv[1])
if sys.argv[2] == "all":
    locale.setlocale(locale.LC_ALL, "")
easypbr.render(folder / "board.glb", folder / f"{sys.argv[3]}.png", size=(64, 48), settings={"image.samples": 1})
cloud = easypbr.Mesh(folder / "cloud.csv")
json.dump({
    "capital of i": chr(ctypes.CDLL(None).toupper(ord("i"))),
    "decimal point": locale.localeconv()["decimal_point"],
    "I": cloud.I.tolist(),
    "scalars": list(cloud.scalars),
    "facets": easypbr.Mesh(folder / "FACETS.STL").F.tolist(),
    "colour": list(easypbr.Material(base_color="INDIGO").base_color),
    "metallic": easypbr.Mesh(folder / "CAPITALS.OBJ").material.metallic,
    "radiance": easypbr.load_image(folder / "exposed.HDR")[0, 0].tolist(),
}, sys.stdout)
"""


@pytest.fixture
def answer(tmp_path):
    """What PROGRAM says of the files of tmp_path, and its picture's bytes, in a locale; its data are compiled first."""
    def run(name, categories="letters"):
        environment = {key: value for key, value in os.environ.items() if not key.startswith(("LC_", "LANG"))}
        if name != "C.UTF-8":
            locales = tmp_path / "locales"
            locales.mkdir(exist_ok=True)
            subprocess.run(["localedef", "-i", name.split(".")[0], "-f", "UTF-8", locales / name], check=True)
            environment["LOCPATH"] = str(locales)
        done = subprocess.run([sys.executable, "-c", PROGRAM, tmp_path, categories, name], capture_output=True, text=True,
                              timeout=300, env={**environment, "LC_ALL": name})
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout), (tmp_path / f"{name}.png").read_bytes()

    return run


def board(**textures):
    mesh = Mesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    mesh.UV = [[0, 0], [1, 0], [1, 1], [0, 1]]
    mesh.material = Material(metallic=1, emissive=(1, 1, 1), **textures)
    return mesh


#: One half of the board is metal, the other emits. The shader's features of both have an i in their names.
HALVES = np.array([[255, 255, 0, 0]] * 2, np.uint8)
TEXTURES = {"metallic_texture": HALVES, "emissive_texture": np.stack([255 - HALVES, 0 * HALVES, 0 * HALVES], axis=-1)}


@pytest.fixture
def files(tmp_path):
    board(**TEXTURES).save(tmp_path / "board.glb")
    (tmp_path / "cloud.csv").write_text("X,Y,Z,INTENSITY\n0,0,0,1.5\n1,0,0,2.5\n0,1,0,3.5\n")
    corners = "".join(f"VERTEX {corner}\n" for corner in ("0 0 0", "1 0 0", "0 1 0"))
    (tmp_path / "FACETS.STL").write_text(f"SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\n{corners}ENDLOOP\nENDFACET\nENDSOLID A\n")
    (tmp_path / "CAPITALS.OBJ").write_text("mtllib capitals.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "capitals.mtl").write_text("newmtl a\nPm 0.75\nILLUM 2\n")
    # Mantissa 128 of 256 and exponent 129 - 128 are 1, half of the radiance by the exposure.
    (tmp_path / "exposed.HDR").write_bytes(b"#?RADIANCE\nEXPOSURE=0.5\n\n-Y 1 +X 1\n\x80\x80\x80\x81")
    return tmp_path


def test_a_turkish_locale_changes_nothing(files, answer):
    expected, picture = answer("C.UTF-8")
    assert expected.pop("capital of i") == "I"
    assert expected["I"] == [1.5, 2.5, 3.5] and expected["metallic"] == 0.75
    assert expected["facets"] == [[0, 1, 2]] and expected["radiance"] == [2, 2, 2]
    turkish, turkish_picture = answer("tr_TR.UTF-8")
    assert turkish.pop("capital of i") == "i"
    assert turkish == expected
    assert turkish_picture == picture


def test_a_decimal_comma_changes_nothing(files, answer):
    """The program has taken over the locale of numbers, too, as GTK and Qt do."""
    expected, picture = answer("C.UTF-8")
    german, german_picture = answer("de_DE.UTF-8", "all")
    assert (expected.pop("decimal point"), german.pop("decimal point")) == (".", ",")
    assert german == expected
    assert german_picture == picture


@pytest.mark.parametrize("texture", TEXTURES)
def test_the_board_shows_each_texture(texture):
    """Else the pictures would be the same without them."""
    pictures = [easypbr.render(board(**textures), size=(64, 48), settings={"image.samples": 1})
                for textures in (TEXTURES, {name: value for name, value in TEXTURES.items() if name != texture})]
    assert not np.array_equal(*pictures)
