import gc
import threading
import time

import numpy as np
import pytest

import easypbr
from easypbr import Mesh, Scene, Viewer, render, shapes


@pytest.fixture(scope="module")
def sphere():
    return shapes.sphere(1, 32)


def test_a_picture_is_an_array_with_row_0_on_top(sphere, size):
    # Above the horizon the environment is white, below black: the sphere's top is the brighter half.
    environment = np.zeros((16, 32, 3), dtype=np.float32)
    environment[:8] = 1
    picture = render(sphere, size=size, samples=2, environment=environment)
    assert picture.shape == (48, 64, 4) and picture.dtype == np.uint8
    assert picture.flags.c_contiguous and picture.flags.writeable
    assert picture[14, 32, :3].mean() > picture[34, 32, :3].mean() + 10


def test_hdr_is_linear_float(sphere, size):
    picture = render(sphere, size=size, samples=1, hdr=True, background="transparent")
    assert picture.shape == (48, 64, 4) and picture.dtype == np.float32
    assert np.isfinite(picture).all()
    assert picture[0, 0, 3] == 0 and picture[24, 32, 3] == 1


def test_two_renders_are_equal_bit_for_bit(sphere, size):
    first = render(sphere, size=size, samples=4)
    np.testing.assert_array_equal(render(sphere, size=size, samples=4), first)


def test_everything_that_can_be_rendered(sphere, size, tmp_path):
    expected = render(sphere, size=size, samples=1)
    sphere.save(tmp_path / "sphere.ply")
    scene = Scene()
    scene.show(sphere, "mesh")
    arrays = {"V": sphere.V, "F": sphere.F, "N": sphere.N, "UV": sphere.UV}
    for what in (scene, str(tmp_path / "sphere.ply"), tmp_path / "sphere.ply", arrays):
        np.testing.assert_array_equal(render(what, size=size, samples=1), expected)
    assert render((sphere.V, sphere.F), size=size, samples=1).shape == (48, 64, 4)


@pytest.mark.parametrize("name, dtype", [("a.png", np.uint8), ("a.exr", np.float32), ("a.hdr", np.float32)])
def test_out_writes_the_file_too(sphere, size, tmp_path, name, dtype):
    for hdr in (False, True):
        picture = render(sphere, tmp_path / name, size=size, samples=1, hdr=hdr)
        assert picture.dtype == (np.float32 if hdr else np.uint8)
        written = easypbr.load_image(tmp_path / name)
        assert written.dtype == dtype
        if written.dtype == picture.dtype and name != "a.hdr":  # which shares an exponent and has no alpha
            np.testing.assert_array_equal(written, picture)


def test_an_unwritable_output_fails_before_rendering(sphere, tmp_path):
    started = time.monotonic()
    with pytest.raises(OSError, match="none"):
        render(sphere, tmp_path / "none" / "a.png", size=(4000, 4000), samples=64)
    with pytest.raises(ValueError, match="did you mean 'png'"):
        render(sphere, tmp_path / "a.pnng", size=(4000, 4000), samples=64)
    # Such a picture takes a minute in software.
    assert time.monotonic() - started < 2
    assert list(tmp_path.iterdir()) == []


def test_overrides_by_short_names(sphere, size):
    plain = render(sphere, size=size, samples=1)
    red = render(sphere, size=size, samples=1, color="#ff0000", metallic=0, roughness=1, tonemap="none", exposure=1)
    assert red[24, 32, 0] > red[24, 32, 1] + 20
    assert not np.array_equal(plain, red)
    np.testing.assert_array_equal(
        red,
        render(
            sphere,
            size=size,
            samples=1,
            color=(1, 0, 0),
            settings={"material": {"metallic": 0, "roughness": 1}, "tonemap.operator": "none", "tonemap.exposure": 1},
        ),
    )
    with pytest.raises(TypeError, match="did you mean 'material.roughness'"):
        render(sphere, rougness=1)
    with pytest.raises(ValueError, match="'position' may be camera.position or lights.key.position"):
        render(sphere, position=(1, 2, 3))


def test_backgrounds(sphere, size, tmp_path):
    corner = lambda background: tuple(render(sphere, size=size, samples=1, background=background)[0, 0])  # noqa: E731
    assert corner("#102030") == (0x10, 0x20, 0x30, 255)
    assert corner((1, 0, 0)) == (255, 0, 0, 255)
    assert corner("transparent")[3] == 0
    easypbr.save_image(np.full((4, 4, 3), (10, 200, 30), dtype=np.uint8), tmp_path / "b.png")
    assert corner(tmp_path / "b.png") == (10, 200, 30, 255)
    assert corner(str(tmp_path / "b.png")) == (10, 200, 30, 255)
    assert corner("env") == corner("environment")


def linear(codes):
    codes = codes / 255.0
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


# Of a pixel with the alpha a a black page is a surface's light times a, and a white one 1 - a more, whatever is caught below.
# 0.02: half a code of alpha, and half a code of each picture at up to 0.009 of linear light a code.
@pytest.mark.parametrize("strength", [1.0, 30.0])
def test_bright_silhouettes_let_the_page_through_before_a_catcher(strength):
    ball = shapes.sphere()
    ball.material.base_color, ball.material.emissive = "#000000", (strength, strength, 0.5 * strength)
    ball.material.specular = 0.0  # the page is not seen in it

    def drawn(page):
        return render(ball, size=(100, 80), samples=8, background=page)[:40]  # above the ground

    alpha = drawn("transparent")[..., 3] / 255.0
    edge = (alpha > 0.1) & (alpha < 0.9)
    assert edge.sum() > 20
    through = linear(drawn("#ffffff")[..., :3]) - linear(drawn("#000000")[..., :3])
    assert np.abs(through - (1 - alpha)[..., None])[edge].max() < 0.02


@pytest.mark.parametrize("size", [(0, 10), (-1, 10), (70000, 10)])
def test_impossible_sizes(sphere, size):
    with pytest.raises(ValueError, match="size"):
        render(sphere, size=size)


@pytest.mark.parametrize("size", [(1.5, 10), 800, (1, 2, 3), "800x600"])
def test_what_is_no_size(sphere, size):
    with pytest.raises(ValueError, match="size"):
        Viewer(scene=Scene()).render(size=size)


def test_an_empty_scene_says_so(size):
    with pytest.raises(easypbr.Error):
        Viewer(size, scene=Scene()).layers(["depth"])


def test_recorder(sphere, size, tmp_path):
    Scene.show(sphere, "sphere")
    view = Viewer(size)
    path = view.recorder.record(tmp_path / "img.png")
    assert path == tmp_path / "img.png"
    np.testing.assert_array_equal(easypbr.load_image(path), view.render())
    assert easypbr.load_image(view.recorder.record(tmp_path / "deep.png", deep=True)).dtype == np.uint16
    for name in ("deep.jpg", "deep.hdr", "deep.exr"):
        with pytest.raises(easypbr.ArgumentError, match="16 bits per channel need a PNG file"):
            view.recorder.record(tmp_path / name, deep=True)
        assert not (tmp_path / name).exists()
    assert view.timing["draw"] > 0


def test_layers(sphere, size):
    Scene.show(sphere, "sphere")
    view = Viewer(size)
    layers = view.layers()
    shapes_of = {"albedo": (48, 64, 4), "normal_world": (48, 64, 3)}
    for name, image in layers.items():
        assert image.dtype == np.float32
        assert image.shape == shapes_of.get(name, (48, 64)), name
    assert {"albedo", "normal_world", "depth", "roughness", "metallic"} <= set(layers)
    covered = layers["depth"] > 0
    assert 0.2 < covered.mean() < 0.9
    # Normals are stored in 2 x 16 bits: their length is 1 within 1e-4.
    np.testing.assert_allclose(np.linalg.norm(layers["normal_world"][covered], axis=1), 1, atol=1e-4)
    assert (layers["normal_world"][~covered] == 0).all()
    with pytest.raises(KeyError, match="did you mean 'depth'"):
        view.layers(["deph"])
    for name, now in (("normal", "normal_world"), ("id", "object_id"), ("element", "element_id")):
        with pytest.raises(KeyError, match=f"'{name}': it is called '{now}'"):
            view.layers(name)
    assert view.layers("depth", size=(10, 20))["depth"].shape == (20, 10)


def test_notebooks_get_a_png(sphere, tmp_path):
    for shown in (sphere, Viewer(scene=_scene_of(sphere))):
        (tmp_path / "a.png").write_bytes(shown._repr_png_())
        assert easypbr.load_image(tmp_path / "a.png").shape == (600, 800, 4)
    assert Viewer(scene=Scene())._repr_png_() is None


def test_without_a_display_there_is_no_window(sphere, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    view = Viewer(scene=_scene_of(sphere))
    for act in (view.show, view.update, lambda: view.show(block=False), lambda: easypbr.show(sphere)):
        with pytest.raises(easypbr.ContextError, match=r"no window: .*render\(\)"):
            act()
    assert issubclass(easypbr.ContextError, RuntimeError) and not view.is_open
    view.close()
    assert not view.update()


def test_a_screenshot_holds_picture_and_panels(sphere):
    view = Viewer((400, 300), {"image": {"samples": 2}}, scene=_scene_of(sphere))
    with_panels = view.screenshot()
    view._handle.set_gui("show_panels", False)
    without = view.screenshot()
    assert with_panels.shape == (300, 400, 4)
    assert np.abs(without[:, :, :3].astype(int) - view.render()[:, :, :3]).max() <= 1
    assert np.mean(np.any(with_panels != without, axis=2)) > 0.3


def test_picking_names_object_face_and_position(sphere, size):
    view = Viewer(size, scene=_scene_of(sphere))
    view.camera = easypbr.Camera.look_at((0, 0, 4), (0, 0, 0))
    pick = view.pick(size[0] / 2, size[1] / 2)
    assert pick.is_face and 0 <= pick.element < len(sphere.F) and pick.object in view.object_names()
    corners = sphere.V[sphere.F[pick.element]]
    assert np.all(pick.position >= corners.min(axis=0) - 1e-4) and np.all(pick.position <= corners.max(axis=0) + 1e-4)
    assert abs(pick.depth - (4 - pick.position[2])) < 1e-4
    assert view.pick(0, 0) is None and view.pick(-1, 1e6) is None


def test_a_moved_mesh_moves_in_the_picture(sphere, size):
    mesh = sphere.clone()
    Scene.show(mesh, "sphere")
    view = Viewer(size)
    before = view.layers("depth")["depth"]
    with mesh.edit("V") as v:
        v[:, 0] += 0.5
    after = view.layers("depth")["depth"]
    columns = np.arange(64)
    assert ((after > 0) @ np.ones(64)).sum() > 0
    assert np.average(columns, weights=(after > 0).sum(0)) > np.average(columns, weights=(before > 0).sum(0)) + 1


def test_two_threads_with_two_viewers(sphere, size):
    expected = render(sphere, size=size, samples=2)
    results, errors = {}, []

    def work(index):
        try:
            view = Viewer(size, scene=_scene_of(sphere))
            results[index] = [view.render(samples=2) for _ in range(3)]
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
    [t.start() for t in threads]
    [t.join() for t in threads]
    assert not errors
    for picture in results[0] + results[1]:
        np.testing.assert_array_equal(picture, expected)


def test_threads_take_turns_in_one_viewer(sphere, size):
    view = Viewer(size, scene=_scene_of(sphere))
    expected = view.render(samples=2)
    results = []
    threads = [threading.Thread(target=lambda: results.append(view.render(samples=2))) for _ in range(4)]
    [t.start() for t in threads]
    [t.join() for t in threads]
    assert len(results) == 4
    for picture in results:
        np.testing.assert_array_equal(picture, expected)


def test_other_threads_run_while_a_picture_is_drawn(sphere):
    view = Viewer((640, 480), scene=_scene_of(sphere))
    view.render(samples=1)
    ticks, stop = [], threading.Event()

    def count():
        while not stop.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=count, daemon=True)
    thread.start()
    start = time.monotonic()
    view.render(samples=64)
    end = time.monotonic()
    stop.set()
    thread.join()
    # A held GIL would let no tick fall well inside the call.
    inside = [t for t in ticks if start + 0.2 * (end - start) < t < start + 0.8 * (end - start)]
    assert len(inside) >= 3


def test_a_viewer_may_be_deleted_on_another_thread(sphere, size):
    holder = [Viewer(size, scene=_scene_of(sphere))]
    expected = holder[0].render(samples=1)
    thread = threading.Thread(target=holder.clear)
    thread.start()
    thread.join()
    gc.collect()
    np.testing.assert_array_equal(render(sphere, size=size, samples=1), expected)


def _scene_of(mesh: Mesh) -> Scene:
    scene = Scene()
    scene.show(mesh, "mesh")
    return scene
