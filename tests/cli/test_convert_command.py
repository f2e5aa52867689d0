"""`convert` with steps: what it does to a mesh between reading and writing."""
import json

import pytest

import png


def info(easypbr, file):
    return json.loads(easypbr("info", "--json", file).stdout)


def size(found):
    low, high = found["bounds"]["min"], found["bounds"]["max"]
    return [b - a for a, b in zip(low, high)]


# The sphere has 96 meridians and 48 rows of quads: 4704 vertices and 9216 triangles.
@pytest.mark.parametrize("steps, vertices, faces", [
    (["--decimate", "100"], None, (90, 100)),
    (["--decimate-error", "0.05"], None, (30, 600)),
    (["--upsample", "1"], None, (4 * 9216, 4 * 9216)),
    (["--smooth", "3"], 4704, (9216, 9216)),
    (["--subsample", "500"], 500, (0, 0)),
    (["--sample-surface", "321"], 321, (0, 0)),
    (["--subsample-cells", "10"], 8, (0, 0)),
    (["--voxelize", "10"], 8, (0, 0)),
    (["--flip-winding", "--flip-normals"], 4704, (9216, 9216)),
])
def test_steps_change_what_is_written(easypbr, sphere, steps, vertices, faces):
    easypbr("convert", sphere, "out.ply", *steps)
    found = info(easypbr, "out.ply")
    assert vertices is None or found["vertices"] == vertices
    assert faces[0] <= found["faces"] <= faces[1]


def test_sizes(easypbr, box):
    easypbr("convert", box, "large.ply", "--scale", "3", "--center")
    assert size(info(easypbr, "large.ply")) == [6, 6, 6]
    easypbr("convert", "large.ply", "small.ply", "--normalize-size", "0.5")
    assert size(info(easypbr, "small.ply")) == [0.5, 0.5, 0.5]


def test_steps_are_done_in_the_order_given(easypbr, box):
    # 24 vertices at 8 places, which differ in uv. Points on the surface come after or before there are no faces.
    easypbr("convert", box, "a.ply", "--sample-surface", "50", "--subsample", "10")
    assert info(easypbr, "a.ply")["vertices"] == 10
    assert "expected a mesh with faces" in easypbr(
        "convert", box, "b.ply", "--subsample", "10", "--sample-surface", "50", code=1).stderr
    easypbr("convert", box, "c.ply", "--scale", "2", "--normalize-size", "1", "--scale", "3")
    assert size(info(easypbr, "c.ply")) == [3, 3, 3]


def test_weld_and_clean(easypbr, tmp_path):
    (tmp_path / "soup.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0.001\nv 1 1 0\nv 0 1 0\nv 9 9 9\n"
                                       "f 1 2 3\nf 4 5 6\nf 1 1 2\n")
    easypbr("convert", "soup.obj", "out.ply", "--clean", "--weld", "0.01")
    found = info(easypbr, "out.ply")
    assert (found["vertices"], found["faces"]) == (4, 2)


def test_normals_and_surfels_of_points(easypbr, sphere):
    easypbr("convert", sphere, "points.ply", "--sample-surface", "2000")
    easypbr("convert", "points.ply", "normals.ply", "--estimate-normals", "12")
    assert "normals" in info(easypbr, "normals.ply")["attributes"]
    easypbr("convert", "points.ply", "surfels.ply", "--estimate-surfels", "16")
    easypbr("convert", sphere, "of_mesh.ply", "--to-surfels")
    for file in ("surfels.ply", "of_mesh.ply"):
        assert info(easypbr, file)["faces"] == 0 and "normals" in info(easypbr, file)["attributes"]


def test_lines_become_tubes(easypbr, tmp_path):
    (tmp_path / "lines.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n")
    easypbr("convert", "lines.obj", "tubes.glb", "--tubes", "0.1")
    found = info(easypbr, "tubes.glb")
    # Two bands of 12 quads, and at both ends two bands and 12 triangles of a half sphere.
    assert found["faces"] == 2 * 24 + 2 * (2 * 24 + 12)
    # The ends' poles and the outside of the mitre are 0.1 beyond the line.
    assert size(found) == pytest.approx([1.2, 1.2, 0.2], abs=1e-6)


def test_tubes_stand_beside_faces(easypbr, tmp_path):
    (tmp_path / "mixed.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\n"
                                        "o leaf\nf 1 2 3\no pipe\nl 4 5\n")
    easypbr("convert", "mixed.obj", "mixed.glb", "--tubes", "0.1")
    found = info(easypbr, "mixed.glb")
    # The triangle; a band of 12 quads, and at both ends two bands and 12 triangles of a half sphere.
    assert found["faces"] == 1 + 24 + 2 * (2 * 24 + 12)
    # From the triangle's corner to the end of the tube; its highest place is the triangle's.
    assert size(found) == pytest.approx([6.1, 1.1, 0.2], abs=1e-6)


def test_a_file_of_several_nodes_becomes_one_mesh(easypbr, box, tmp_path):
    easypbr("convert", box, "box.glb")
    easypbr("convert", "box.glb", "one.glb", "--merge")
    assert info(easypbr, "one.glb")["faces"] == 12


@pytest.mark.parametrize("steps, code, message", [
    (["--decimate", "-1"], 2, "--decimate: expected a whole number >= 0, got -1"),
    (["--decimate", "many"], 2, "many"),
    (["--cut-box", "1,1,1,0,0,0"], 2, "error: --cut-box: expected a box whose lowest corner is below its highest"),
    (["--crease", "-1"], 2, "--crease: setting 'load.crease_deg': expected 0 to 180 degrees"),
    (["--crease", "nan"], 2, "--crease: setting 'load.crease_deg': expected 0 to 180 degrees"),
    (["--crease", "1e30"], 2, "--crease: setting 'load.crease_deg': expected 0 to 180 degrees"),
    (["--memory", "-1"], 2, "--memory: setting 'limits.memory': expected 0 to 1000000 GB, got -1"),
    (["--voxelize", "nan"], 2, "--voxelize: expected a number > 0, got nan"),
    (["--estimate-surfels", "2"], 2, "--estimate-surfels: expected a whole number from 3 to 256, got 2"),
    (["--decimat", "5"], 2, "did you mean '--decimate'"),
    (["--scale", "0"], 2, "--scale: expected a finite number other than 0, got 0"),
    (["--crop-box", "1,2,3"], 2, "--crop-box"),
    (["--crop-sphere", "0,0,0,-1"], 2, "a radius > 0, got 0,0,0,-1"),
    (["--crop-sphere", "99,0,0,1"], 1, "nothing stays"),
    (["--tubes", "0"], 2, "--tubes: expected a number > 0, got 0"),
    (["--tubes", "0.1"], 1, "--tubes: expected a mesh with edges (E) of a length above 0"),
    (["--decimate-splats", "5"], 1, "expected a mesh with splats"),
])
def test_bad_steps_write_nothing(easypbr, box, tmp_path, steps, code, message):
    assert message in easypbr("convert", box, "out.ply", *steps, code=code).stderr
    assert not (tmp_path / "out.ply").exists()


@pytest.fixture
def splats(tmp_path):
    """100 splats in a row along x at 0, 1, ..., with opacities from 0 to 0.99."""
    import numpy as np

    import easypbr
    means = np.arange(100)[:, None] * [1.0, 0, 0]
    easypbr.splats(means, 0.1, opacities=np.arange(100) / 100, colors=np.full((100, 3), 0.5)).save(tmp_path / "row.ply")
    return "row.ply"


# Opacities are read back to single precision: limits lie between two of them.
@pytest.mark.parametrize("steps, count", [
    (["--crop-box", "9.5,-1,-1,20,1,1"], 11),
    (["--cut-box", "9.5,-1,-1,20,1,1"], 89),
    (["--crop-sphere", "50,0,0,2.5"], 5),
    (["--cut-sphere", "50,0,0,2.5"], 95),
    (["--prune-opacity", "0.895"], 10),
    (["--prune-size", "1"], 100),
    (["--decimate-splats", "30"], 30),
    (["--crop-sphere", "0,0,0,9.5", "--prune-opacity", "0.045", "--decimate-splats", "4"], 4),
])
def test_splats_are_edited(easypbr, splats, steps, count):
    for out in ("out.ply", "out.spz", "out.glb"):
        easypbr("convert", splats, out, *steps)
        found = info(easypbr, out)
        assert found["vertices"] == count and found["attributes"] == ["splats of degree 0"]
        assert found["bounds"]["max"][0] <= 99.01


def test_splats_become_other_data(easypbr, splats):
    for step, attributes in ((["--to-cloud"], ["colors"]), (["--to-surfels"], ["colors", "normals", "tangents"]),
                             (["--voxelize", "2"], ["colors"]), (["--subsample-cells", "2"], ["colors"])):
        easypbr("convert", splats, "out.ply", *step)
        assert info(easypbr, "out.ply")["attributes"] == attributes
    easypbr("convert", splats, "out.ply", "--prune-opacity", "0.5", "--to-mesh", "64")
    assert info(easypbr, "out.ply")["faces"] > 100
    assert "from 8 to 512" in easypbr("convert", splats, "out.ply", "--to-mesh", "7", code=2).stderr


@pytest.mark.parametrize("arguments, message", [
    ("in.obj out.stl", "out.stl: files with extension 'stl' cannot be written; expected one of ply, obj"),
    ("in.obj -", "OUT names a file, not standard output: expected one with extension ply, obj"),
    ("in.png -", "OUT names a file, not standard output: expected one with extension png"),
    ("in.png out.foo", "cannot write out.foo: unknown extension 'foo'"),
    ("in.obj out.ply --normalize-size 0", "--normalize-size: expected a number > 0, got 0"),
    ("in.obj out.ply --scale nan", "--scale: expected a finite number other than 0, got nan"),
    ("in.obj out.ply --upsample -1", "--upsample: expected a whole number from 0 to 12, got -1"),
    ("in.obj out.ply --subsample 0", "--subsample: expected a whole number >= 1, got 0"),
    ("in.obj out.ply --sample-surface 0", "--sample-surface: expected a whole number from 1 to 2147483647, got 0"),
    ("in.obj out.ply --weld -1", "--weld: expected a number >= 0, got -1"),
    ("in.obj out.ply --prune-size nan", "--prune-size: expected a number, got nan"),
    ("in.obj out.ply --crop-box 1,1,1,0,0,0", "--crop-box: expected a box whose lowest corner is below its highest, got 1,1,1,0,0,0"),
    ("in.obj out.ply --cut-sphere 0,0,0,0", "--cut-sphere: expected a finite centre and a radius > 0, got 0,0,0,0"),
    ("in.obj out.ply --center --smooth -1", "--smooth: expected a whole number from 0 to 100000, got -1"),
])  # fmt: skip
def test_what_the_options_show_is_told_before_anything_is_read(easypbr, tmp_path, arguments, message):
    """There is no file in.obj or in.png."""
    assert message in easypbr("convert", *arguments.split(), code=2).stderr
    assert list(tmp_path.iterdir()) == []


def test_help_names_every_format_that_is_written(easypbr):
    shown = " ".join(easypbr("convert", "--help").stdout.split())
    assert "Mesh file (ply, obj, glb, pcd, xyz, txt, asc, csv, npy, npz, spz) or image file (png, " in shown


def test_steps_are_for_meshes(easypbr, sphere, render, tmp_path):
    render(sphere, "-o", "picture.png")
    assert "--decimate is for meshes" in easypbr("convert", "picture.png", "out.png", "--decimate", "5", code=2).stderr
    assert not (tmp_path / "out.png").exists()


# Light of 1 and more before a transparent background: code 255 wherever anything is covered.
def test_alpha_is_straight_in_png_and_premultiplied_in_exr(easypbr, render, sphere, tmp_path):
    render(sphere, "-o", "a.exr", "--mode", "raster", "--background", "transparent", "--set", "ground.mode=none",
           "--samples", "4", "--set", "material.emissive=1,1,1")  # fmt: skip
    easypbr("convert", "a.exr", "a.png")
    picture = png.read(tmp_path / "a.png")
    covered = picture[..., 3] > 0
    assert ((picture[..., 3] > 0) & (picture[..., 3] < 255)).any() and (picture[covered][:, :3] == 255).all()
    assert "HDR has no transparency" in easypbr("convert", "a.exr", "a.hdr", code=1).stderr
    assert "JPEG has no transparency" in easypbr("convert", "a.png", "a.jpg", code=1).stderr
    assert not (tmp_path / "a.hdr").exists() and not (tmp_path / "a.jpg").exists()
