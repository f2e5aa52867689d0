"""Viewer: draws a scene."""

import atexit
import logging
import os
import threading
import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _easypbr
from .arguments import classes_of, missing_names, real_of, samples_of
from .cameras import set_camera
from .conversions.maker import Maker
from .errors import ArgumentError
from .lights import _STUDIO, Lights, SceneLight, StudioLight
from .recorder import Recorder, watch_recorder
from .scene import Scene, scene_of
from .settings import Settings
from .shapes import camera_frustum
from .sharing import Sharing
from .tensors import as_numpy, check_device, converter, from_dlpack, layers_of_targets


class Viewer(Sharing):
    """Renders a scene, by default the default scene. Nothing is rendered, and OpenGL is not loaded, before the first
    image. Threads may share a viewer; they take turns."""

    scene: Scene
    recorder: Recorder

    def __init__(
        self,
        size: ArrayLike | None = None,
        settings: Mapping[str, Any] | str | os.PathLike[str] | None = None,
        scene: Scene | None = None,
        device: str = "auto",
        preset: str | os.PathLike[str] | None = None,
    ) -> None:
        """`settings`: a file that save_settings() wrote, or a dict of values; `size`: (width, height). Both win over
        `preset`, see apply_preset().

        `device`: "gl" draws by OpenGL, "cpu" natively, where OpenGL is loaded only for what it alone can draw; "auto"
        is a GPU where there is one, else the CPU. The environment variable EASYPBR_DEVICE stands for "auto".
        """
        self.scene = Scene.default() if scene is None else scene
        self._handle = _easypbr.ViewerHandle(self.scene._handle, device)
        self.recorder = Recorder(self)
        self._settings = Settings(self._handle)
        self._missing_classes: set[str] = set()
        self._thread: threading.Thread | None = None
        self._made_at = time.monotonic()
        self._init_callbacks()
        self._init_sharing()
        if preset is not None:
            self.apply_preset(preset)
        if isinstance(settings, Mapping):
            self._settings.update(settings)
        elif settings is not None:
            self.load_settings(settings) if preset is None else self.apply_preset(settings)
        if size is not None:
            self._settings["image.size"] = size

    @property
    def device(self) -> str:
        """What draws: "gl" or "cpu"."""
        return self._handle.device

    @property
    def settings(self) -> Settings:
        """All settings: view.settings.<group>.<name>."""
        return self._settings

    @settings.setter
    def settings(self, values: Mapping[str, Any]) -> None:
        self._settings.update(values)

    def object_names(self) -> list[str]:
        """Names of what is visible; the layer "object_id" holds 1 + the place in this list."""
        return self._handle.object_names()

    @property
    def lights(self) -> Lights:
        """view.lights["key" | "fill" | "rim"] and the lights of the scene, by name."""
        return Lights(self._handle, self.scene._handle)

    def add_light(self, name: str, type: "str | _easypbr.Light" = "point", **values: Any) -> "SceneLight | StudioLight":
        """Adds or replaces a light: position, direction, color, intensity, ... as _easypbr.Light has them. Or a whole one:
        view.add_light("lamp", load_scene(path).lights["lamp"])."""
        if name in _STUDIO:
            raise ArgumentError(f"'{name}' is one of the three-point lights: use view.lights['{name}']")
        if isinstance(type, _easypbr.Light):
            if values:
                raise ArgumentError(f"add_light: a whole light needs no further values, got {', '.join(sorted(values))}")
            self.scene.set_light(name, type)
        else:
            self.scene.set_light(name, _easypbr.Light(type, **values))
        return self.lights[name]

    def remove_light(self, name: str) -> None:
        """Removes a light that was added."""
        if name in _STUDIO:
            raise ArgumentError(f"'{name}' cannot be removed: use view.lights['{name}'].enabled = False")
        self.scene.remove_light(name)

    def load_environment_map(self, source: Any) -> None:
        """Sets the environment map: a path, an array or an Environment."""
        if isinstance(source, (str, os.PathLike)):
            self._handle.load_environment_map(source)
        else:
            self.scene.environment = source
            self._handle.set_setting("environment.file", "")

    def load_background_image(self, source: Any) -> None:
        """Shows an image behind everything until another background is set: a path (photographs are turned upright, as EXIF
        says), or an array, height x width x (1 to 4), of uint8 or uint16 (sRGB), or of floats (linear, premultiplied by
        alpha). Files of settings do not hold arrays. What is no image raises an error, and the background before stays."""
        if isinstance(source, (str, os.PathLike)):
            self._handle.load_background_image(source)
        elif source is None:
            raise ArgumentError("background image: expected a path or an array, got None")
        else:
            self._handle.set_background_image(source)

    @property
    def camera(self) -> "_easypbr.Camera":
        """A copy of the camera of the next image. Assigning pins it: a Camera, "front", "back", "left", "right", "top",
        "bottom" or "iso", a dict of settings.camera, a 4 x 4 camera-to-world matrix with OpenGL axes, or (position, target,
        up)."""
        return self._handle.camera

    @camera.setter
    def camera(self, camera: Any) -> None:
        set_camera(self._handle, camera)

    @property
    def time(self) -> float:
        """Animation time in seconds, of the last frame of a window, of a recording, or, without both, of render(); assign to
        set that of the next frame."""
        return self._handle.time

    @time.setter
    def time(self, seconds: float) -> None:
        self._handle.time = real_of("time", seconds, "seconds")

    @property
    def elapsed(self) -> float:
        """Seconds of real time since this viewer was made; can be asked at any point."""
        return time.monotonic() - self._made_at

    @property
    def delta_time(self) -> float:
        """Seconds between the last two frames; 0 at the first, while recording 1 / fps at all others."""
        return self._handle.delta_time

    @property
    def fixed_step(self) -> float | None:
        """Seconds that each frame takes of the animation's time, however long it is drawn; None: real time. The first frame
        after a change between the two, or after view.time was set, is at view.time. While recording it is 1 / fps."""
        return self._handle.fixed_step

    @fixed_step.setter
    def fixed_step(self, seconds: float | None) -> None:
        self._handle.fixed_step = seconds

    def play(
        self,
        animations: "_easypbr.Animations | None" = None,
        animation: str | int = 0,
        speed: float | None = None,
        loop: bool | None = None,
    ) -> None:
        """Plays an animation of a file, by its name or number, from its start: view.play(load_scene(path).animations). It
        follows view.time: that of the window, or of the frames that are recorded. Without arguments it goes on after
        pause(), or from its start when it is at its end. `speed`: below 0 backwards, without a loop from its end. None: 1 and
        a loop for an animation, what they were when it goes on."""
        if speed is not None:
            speed = real_of("speed", speed)
        if animations is None:
            self._handle.resume(speed, loop)
        else:
            self._handle.play(animations, str(animation), 1.0 if speed is None else speed, loop is None or loop)

    def pause(self) -> None:
        """Pauses the animation until play()."""
        self._handle.pause()

    @property
    def is_playing(self) -> bool:
        """Whether an animation plays: it is neither paused nor, with `loop=False`, at its end."""
        return self._handle.is_playing()

    @property
    def animation_time(self) -> float:
        """Time in the animation that plays, in seconds; assign to seek."""
        return self._handle.animation_time

    @animation_time.setter
    def animation_time(self, seconds: float) -> None:
        self._handle.animation_time = real_of("animation_time", seconds, "seconds")

    def turntable(self, duration_s: float = 4.0) -> "_easypbr.CameraPath":
        """A path of one turn around the content from the current camera; an automatic camera is far enough away to keep
        the content in the image, with all that an animation that plays moves in that time."""
        return self._handle.turntable(duration_s)

    def refit(self) -> None:
        """Releases latched values, so that the next image infers them again."""
        self._handle.refit()

    def render(self, size: ArrayLike | None = None, samples: int | None = None, hdr: bool = False) -> NDArray[Any]:
        """Renders an image, height x width x 4, row 0 on top: uint8 sRGB, or linear float32 with `hdr`."""
        return self._handle.render(size, samples_of(samples), "linear" if hdr else "srgb8")

    def layers(self, names: Sequence[str] | None = None, size: ArrayLike | None = None) -> dict[str, NDArray[Any]]:
        """Exact values through the pixels' centres, float32, by name: albedo, normal_world, depth, roughness, metallic,
        occlusion, ambient_occlusion, object_id and element_id; all of them unless named. A name that render_layers() has too
        means the same: of surfels that overlap both give the nearest one's."""
        if isinstance(names, str):
            names = [names]
        return self._handle.layers(list(_easypbr.layer_names() if names is None else names), size)

    def render_layers(
        self,
        names: Sequence[str],
        size: ArrayLike | None = None,
        samples: int | None = None,
        instances_by: str = "object",
        classes: Mapping[str, int] | None = None,
        previous: "_easypbr.Moment | None" = None,
        next: "_easypbr.Moment | None" = None,
        amodal: bool = True,
        as_: str = "numpy",
        device: str = "cpu",
    ) -> dict[str, Any]:
        """The image and exact ground truth of the same frame by name, all of the same height and width: color, hdr,
        depth, distance, position, normal_world, normal_camera, albedo, roughness, metallic, instance_id, semantic_id,
        object_coordinates, face_id, barycentrics, uv, flow_forward, flow_backward and their occlusion_forward and
        occlusion_backward, and "instances", a list of Instance. Of the background, where depth is 0, all but the image is 0
        and face_id -1; flow is 0 there while the camera moves, too.

        `instances_by`: "object" (with all its children), "node" or "part". `classes`: semantic ids (int32) by the objects'
        names; a name that is neither an object's nor begins with one's and "/", ":" or "#" is logged as a warning, once. Flow
        needs the `next` or `previous` frame's moment(). Without `amodal` what is hidden of the instances is not measured.
        `as_`: "numpy" or "torch", whose tensors are made on `device`: with "cuda", color, hdr, depth, distance, position,
        normals, albedo, roughness, metallic, instance_id and (without labels of elements) semantic_id never leave the GPU
        when OpenGL draws on it too (depth, distance and position then have the rasteriser's rounding); what else is asked
        for is copied there."""
        if isinstance(names, str):
            names = [names]
        samples = samples_of(samples)
        classes = self._checked_classes(classes)
        convert = converter(as_, device)
        if device != "cpu":
            return self._layers_on(device, names, size, samples, instances_by, classes, previous, next, amodal)
        data = _easypbr.ground_truth(
            self._handle,
            [name for name in names if name != "instances"],
            size,
            samples,
            instances_by,
            classes,
            previous,
            next,
            "instances" in names,
            amodal,
        )
        return {name: value if name == "instances" else convert(value) for name, value in data.items()}

    def _checked_classes(self, classes: Mapping[str, int] | None) -> dict[str, int]:
        """Of render_layers(), with a warning of names that are no object's or instance's: once for each."""
        checked = classes_of(classes)
        for name in missing_names(checked, self.scene.names()) if checked else ():
            if name not in self._missing_classes:
                self._missing_classes.add(name)
                logging.getLogger("easypbr").warning("classes: the scene has no object %r", name)
        return checked

    def _layers_on(self, device: str, names: Sequence[str], size: ArrayLike | None, samples: int | None, instances_by: str,
                   classes: dict[str, int], previous: "_easypbr.Moment | None", next: "_easypbr.Moment | None",
                   amodal: bool) -> dict[str, Any]:
        """render_layers() with tensors of another device."""
        stays = [name for name in names if name in _easypbr.cuda_layer_names()]
        data = {}
        if check_device(device).type == "cuda" and stays:
            raw = _easypbr.cuda_layers(self._handle, stays, size, samples, instances_by, classes)
            data = layers_of_targets(raw, stays, from_dlpack) if raw else {}
            stays = [name for name in stays if name in data]
        else:
            stays = []
        rest = [name for name in names if name not in stays]
        if rest:
            data |= self.render_layers(rest, size, samples, instances_by, classes, previous, next, amodal, "torch")
        return {name: data[name] if name == "instances" else data[name].to(device) for name in names}

    def annotations(self, size: ArrayLike | None = None, **options: Any) -> "list[_easypbr.Instance]":
        """Masks, boxes, poses and visibility of all instances; options as render_layers() has them."""
        return self.render_layers(["instances"], size, **options)["instances"]

    def moment(self, size: ArrayLike | None = None) -> "_easypbr.Moment":
        """The current scene and camera, for flow between frames: render_layers(..., previous=moment)."""
        return _easypbr.moment(self._handle, size)

    def focus_at(self, x: int, y: int, size: ArrayLike | None = None) -> float:
        """Focuses the lens (settings.depth_of_field) on the surface at pixel (x, y) and returns its depth."""
        return self._handle.focus_at(x, y, size)

    def forget_motion(self) -> None:
        """Disables motion blur in the next image, as after a cut (settings.motion_blur)."""
        self._handle.forget_motion()

    def save_settings(self, path: str | os.PathLike[str]) -> None:
        """Writes all settings, given and inferred, with hashes of the files in use. Raises ArgumentError where the settings
        name a file, or the scene has a light, whose name is not UTF-8; of the scene's files such are left out, with a warning."""
        sources = (self.scene.get(name).source for name in self.scene.names())
        self._handle.save_settings(path, [source for source in sources if source])

    def load_settings(self, path: str | os.PathLike[str]) -> None:
        """Loads settings and lights from a file of save_settings()."""
        self._handle.load_settings(path)

    def apply_preset(self, preset: str | os.PathLike[str]) -> None:
        """Sets what a preset says: "dark", "flat", "paper", "studio", or a file of settings, which need not hold all. The
        rest stays; what was inferred is inferred anew, but for the camera."""
        self._handle.apply_preset(os.fspath(preset))

    @property
    def timing(self) -> dict[str, float]:
        """Seconds that the steps of the last picture took."""
        return self._handle.timing()

    def update(self) -> bool:
        """Opens the window at the first call; processes events and redraws changes. Waits up to 16 ms for events. False
        when the window has been closed: while view.update(): ..."""
        watch_recorder(self.recorder)  # The panel may begin a recording.
        self._run(self._before_draw)
        is_open = self._handle.update()
        self._run(self._after_draw)
        return is_open

    def show(self, block: bool = True) -> None:
        """Shows the window until it is closed; with block=False it runs on its own thread."""
        self._handle.reopen()
        if block:
            while self.update():
                pass
            return
        if self._thread is not None and self._thread.is_alive():
            return
        self.update()  # What keeps the window from opening is told here.
        self._thread = threading.Thread(target=self._live, name="easypbr window", daemon=True)
        self._thread.start()
        # A thread within the library must not outlive the interpreter.
        atexit.register(self._close_at_exit, os.getpid())

    def _close_at_exit(self, process: int) -> None:
        if os.getpid() == process:
            self.close()

    def show_image(
        self, name: str, image: Any, range: tuple[float, float] | None = None, colormap: Any = None
    ) -> None:
        """Shows an image in the window, beside the scene: an array or tensor of height x width (x 1, 3 or 4), of uint8,
        uint16, floats, bool or integers. Under the name of one that is there it takes its place, as in every iteration of a
        training loop. Values are shown as they are: 0 to 255, of floats 0 to 1, or `range`; of a single channel all of
        them, in a `colormap` (see colormap()). At most 16384 pixels a side. Without a window it is kept, for screenshots."""
        array = np.asarray(as_numpy(image))
        if array.dtype.kind not in "buif":
            raise ArgumentError(f"show_image: expected numbers, got {array.dtype}")
        if array.dtype == np.bool_:
            array = array.astype(np.uint8) * 255
        elif array.dtype not in (np.uint8, np.uint16):
            array = array.astype(np.float32)
        if array.ndim == 3 and array.shape[0] in (1, 3, 4) and array.shape[2] > 4:
            raise ArgumentError(
                f"show_image: expected height x width (x 1, 3 or 4), got {' x '.join(map(str, array.shape))}; "
                "permute(1, 2, 0) puts the channels last"
            )
        low, high = (None, None) if range is None else range
        self._handle.show_image(name, array, low, high, colormap)

    @property
    def camera_path(self) -> "_easypbr.CameraPath | None":
        """The path of the window's panel, drawn over the picture; assign one to see and edit it. None without two keys."""
        return self._handle.get_path()

    @camera_path.setter
    def camera_path(self, path: "_easypbr.CameraPath") -> None:
        if not isinstance(path, _easypbr.CameraPath):
            raise ArgumentError(f"camera_path: expected a CameraPath, got a {type(path).__name__}")
        self._handle.set_path(path)

    @property
    def panel_scale(self) -> float:
        """Scale of panels, text and manipulators relative to the screen's own, 0.5 to 4."""
        return self._handle.panel_scale

    @panel_scale.setter
    def panel_scale(self, scale: float) -> None:
        self._handle.panel_scale = scale

    def show_panels(self, *names: str) -> None:
        """Shows only these built-in panels, expanded: "Scene", "Object", "Effects", "Lights", "Environment",
        "Camera", "Channels", "Statistics", "Animations", "Camera path", "Recorder"."""
        known = self._handle.panel_names()
        for name in names:
            if name not in known:
                raise ArgumentError(f"show_panels: expected names out of {', '.join(known)}, got {name!r}")
        for name in known:
            self._handle.set_gui(name, name in names)
        for name in names:
            self._handle.set_gui("unfold", name)

    def remove_image(self, name: str) -> None:
        """Removes an image that was shown."""
        self._handle.remove_image(name)

    def image_names(self) -> list[str]:
        """Names of the images that are shown."""
        return self._handle.image_names()

    def add_camera_frustum(
        self,
        name: str,
        K: ArrayLike,
        T_world_cam: ArrayLike,
        image: Any = None,
        size: ArrayLike | None = None,
        depth: float = 1.0,
    ) -> "_easypbr.Mesh":
        """Shows a camera in the scene: what it sees, `depth` far, as lines, with its image in it. K and T_world_cam are
        OpenCV's; `size` is (width, height), by default the image's. See shapes.camera_frustum()."""
        if image is not None:
            image = np.asarray(as_numpy(image))
        return self.scene.show(camera_frustum((K, T_world_cam), image, size, depth), name)

    def _live(self) -> None:
        while self.update():
            pass

    def close(self) -> None:
        """Closes the window; update() returns False from now on, until show()."""
        self._handle.close()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()
            self._thread = None

    @property
    def is_open(self) -> bool:
        """Whether the window is open."""
        return self._handle.is_open()

    def add_pass(self, name: str, shader: str | os.PathLike[str], stage: str = "overlay") -> None:
        """Adds a custom full-screen pass: a fragment shader as GLSL text, or the path of a file (pathlib.Path), which is
        reloaded when it changes. `stage`: "light" (linear radiance, before depth of field and tone mapping), "overlay"
        (linear display colours, after tone mapping) or "picture" (the final image). A pass of the same name is
        replaced."""
        self._handle.add_pass(name, shader, stage)

    def remove_pass(self, name: str) -> None:
        """Removes a custom pass."""
        self._handle.remove_pass(name)

    def open(self, path: str | os.PathLike[str]) -> None:
        """Adds the contents of a file, like a file dropped on the window; HDR and EXR become the environment map."""
        self._handle.open(path)

    def pick(self, x: float, y: float, size: ArrayLike | None = None) -> "_easypbr.Pick | None":
        """What lies under a pixel of a picture of `size`, counted from the top left corner: object, part, face or vertex,
        position. None where there is no surface; lines are none."""
        return self._handle.pick(x, y, size)

    def screenshot(self, size: ArrayLike | None = None, scale: float = 1) -> NDArray[Any]:
        """The contents of the window as an image, panels included; needs no display. `scale`: HiDPI scale, 0.5 to 4."""
        return self._handle.screenshot(size, scale)


def show(
    what: Any,
    name: str | None = None,
    block: bool = True,
    size: ArrayLike = (1280, 720),
    settings: Mapping[str, Any] | str | os.PathLike[str] | None = None,
) -> Viewer:
    """Shows anything as_mesh() takes or a Scene in a window, until it is closed; with block=False the window
    runs on its own thread. Returns its Viewer; `settings` as for Viewer."""
    scene, made = scene_of(what, name)
    view = Viewer(size, settings, scene=scene)
    show_colorbar(view, made)
    view.show(block)
    return view


def show_colorbar(view: Viewer, made: Maker | None) -> None:
    """Shows a colour bar beside what its own library shows one for, unless the settings say whether there is one."""
    if made is not None and made.has_colorbar and view.settings["annotation.colorbar"] == _easypbr.auto:
        view.settings["annotation.colorbar"] = True
