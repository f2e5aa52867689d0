"""Viewer, Recorder and Gui."""

import contextlib
import os
import pathlib
import weakref
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..._easypbr import Automatic, auto
from ...errors import ArgumentError, UnknownNameError
from ...scene import Scene as OwnScene
from ...viewer import Viewer as OwnViewer
from . import config
from .camera import Camera, SpotLight
from .mat import Mat, _swapped
from .scene import Scene, floor, flush
from .vis_options import _hex

_viewers: "weakref.WeakSet[Viewer]" = weakref.WeakSet()
_STUDIO = ("key", "fill", "rim")
#: Their targets and our layers.
_LAYERS = {
    "diffuse_gtex": ["albedo"],
    "normal_gtex": ["normal_world"],
    "metalness_and_roughness_gtex": ["metallic", "roughness"],
    "mesh_id_gtex": ["object_id"],
    "ao_gtex": ["ambient_occlusion"],
    "depth_gtex": ["depth"],
}


class Viewer:
    """Made by Viewer.create(). `own` is EasyPBR's viewer, with all that it has beyond this interface."""

    own: OwnViewer
    m_recorder: "Recorder"
    m_gui: "Gui"
    m_nr_drawn_frames: int
    m_recording_path: str
    m_record_gui: bool
    m_record_with_transparency: bool

    def __init__(self, config_file: "str | os.PathLike[str]" = "") -> None:
        settings, values = config.read(config_file) if config_file else ({}, {})
        self.own = OwnViewer((1920, 1080), settings)
        self._camera: Camera | None = None
        self._sent = np.eye(4)
        self._has_floor: bool | None = None
        self._values = values
        #: What was handed over last.
        self._exposure: float | None = None
        fov = values.get("cam.fov")
        self._fov = fov if isinstance(fov, float) else None
        self.m_viewport_size: ArrayLike = [1920, 1080]
        self.m_recorder, self.m_gui = Recorder(self), Gui()
        self.m_nr_drawn_frames = 0
        self.m_recording_path, self.m_record_gui, self.m_record_with_transparency = "./recordings", False, True
        self._frame: NDArray[Any] | None = None
        self._is_off_screen = bool(values.get("use_offscreen")) or not any(map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY")))
        for index, name in enumerate(_STUDIO):
            self._configure_light(index, name)
        if path := values.get("ibl.environment_map_path"):
            if os.path.exists(path):
                self.load_environment_map(path)
        _viewers.add(self)

    @classmethod
    def create(cls, config_file: "str | os.PathLike[str]" = "") -> "Viewer":
        """Paths in the file are relative to the working directory; the environment map is left out where it is not there."""
        return cls(config_file)

    def _configure_light(self, index: int, name: str) -> None:
        light, prefix = self.own.lights[name], f"lights.spot_light_{index}."
        if isinstance(power := self._values.get(prefix + "power"), float):
            light.intensity = power
        if isinstance(color := self._values.get(prefix + "color"), list):
            light.color = tuple(color)

    # The camera.

    @property
    def m_camera(self) -> Camera:
        """The camera; changes of it pin it."""
        self._hand_over_lens()
        seen = self._seen()
        if self._camera is None:
            self._camera = Camera()
            if isinstance(fov := self._values.get("cam.fov"), float):
                self._camera._fov = fov
        if not self._camera._is_changed and seen is not None:
            # What is automatic, or was turned in the window.
            target = Scene.get_centroid() if np.allclose(self._sent, np.eye(4)) else self._camera.lookat()
            self._camera._T = seen
            if not self._camera._is_fov_changed:
                width, height = self._size()
                self._camera._fov = self.own.camera.fov_y_deg * width / height
            self._camera._distance = float((target - seen[:3, 3]) @ -seen[:3, 2]) or 1.0
        return self._camera

    @m_camera.setter
    def m_camera(self, camera: Camera) -> None:
        self._camera = camera
        camera._is_changed = True

    m_default_camera = m_camera

    def _seen(self) -> NDArray[Any] | None:
        flush()
        self._fit_size()
        return np.array(self.own.camera.T_world_cam) if any(mesh._has_vertices() for mesh in Scene._all()) else None

    def _size(self) -> tuple[int, int]:
        width, height = (int(side) for side in np.asarray(self.m_viewport_size).ravel())
        return width, height

    def _fit_size(self) -> None:
        """An automatic camera is fitted to pictures of this size."""
        if tuple(self.own.settings.image.size) != self._size():
            self.own.settings.image.size = self._size()

    def _hand_over(self) -> None:
        flush()
        self._fit_size()
        if floor["visible"] is not None and floor["visible"] != self._has_floor:
            self._has_floor = floor["visible"]
            self.own.settings.ground.mode = auto if self._has_floor else "none"
        self._hand_over_lens()
        camera = self._camera
        if camera is None or not camera._is_changed:
            return
        width, height = self._size()
        self.own.camera = camera.camera(width / height)
        camera._is_changed, self._sent = False, camera.model_matrix()

    def _hand_over_lens(self) -> None:
        """Exposure and field of view, which leave an automatic camera automatic."""
        camera = self._camera
        if camera is not None and camera.m_exposure is not None and camera.m_exposure != self._exposure:
            self._exposure = float(camera.m_exposure)
            self.own.settings.tonemap.exposure = self._exposure
        if camera is not None and camera._is_fov_changed:
            self._fov, camera._is_fov_changed = camera.m_fov, False
        if self._fov is not None:
            width, height = self._size()
            self.own.settings.camera.fov_y_deg = self._fov * height / width
            self._fov = None

    @contextlib.contextmanager
    def _somewhere(self) -> Iterator[None]:
        """Gives an automatic camera a place while there is nothing to fit it to: the background is drawn."""
        camera = self.own.settings.camera
        has_place = any(mesh.m_vis.m_is_visible and mesh._has_vertices() for mesh in Scene._all()) or not isinstance(camera.position, Automatic) or len(camera.pose)
        if has_place:
            yield
            return
        camera.position, camera.target = (0, 0.5, 5), (0, 0, 0)
        try:
            yield
        finally:
            camera.position = camera.target = auto

    # Drawing.

    def draw(self, fbo_id: int = 0) -> None:
        """Draws a picture of m_viewport_size; rendered_mat_no_gui() gives it."""
        self._hand_over()
        with self._somewhere():
            self._frame = self.own.render(size=self._size())
        self.m_nr_drawn_frames += 1

    def update(self, fbo_id: int = 0) -> None:
        """Draws the window and takes what mouse and keys did. Without a display, and with use_offscreen, it is draw(). Closing the
        window ends the script, whose loop has no other end: SystemExit is raised."""
        if self._is_off_screen:
            self.draw()
        else:
            self._hand_over()
            if not self.own.update():
                raise SystemExit(0)
            self._frame = None
            self.m_nr_drawn_frames += 1
        self.m_recorder._add()

    def _picture(self) -> NDArray[Any]:
        if self._frame is None:
            self.draw()
        assert self._frame is not None
        return self._frame

    def rendered_mat_no_gui(self, with_transparency: bool = True) -> Mat:
        """The last picture, bottom row first, red, green, blue. The background is transparent only if it is set so."""
        picture = self._picture()
        return Mat(picture[::-1] if with_transparency else picture[::-1, :, :3])

    def rendered_mat_with_gui(self) -> Mat:
        self._hand_over()
        return Mat(self.own.screenshot(self._size())[::-1, :, :3])

    def gbuffer_mat_with_name(self, name: str) -> Mat:
        """A target by its name, bottom row first. Normals are encoded as 0.5 n + 0.5; depth_gtex holds distances along the optical
        axis, 0 where there is nothing."""
        if name not in _LAYERS:
            raise UnknownNameError(f"there is no target '{name}': expected {', '.join(_LAYERS)}")
        self._hand_over()
        layers = self.own.layers(_LAYERS[name], self._size())
        channels = [np.atleast_3d(layers[layer]) for layer in _LAYERS[name]]
        data = np.concatenate(channels, axis=2)
        if name == "normal_gtex":
            there = (data != 0).any(axis=2, keepdims=True)
            data = np.where(there, 0.5 * data + 0.5, 0)
        return Mat(data[::-1])

    # The look.

    def load_environment_map(self, path: "str | os.PathLike[str]") -> None:
        self.own.load_environment_map(path)

    def spotlight_with_idx(self, index: int) -> SpotLight:
        """0 key, 1 fill, 2 rim."""
        if not 0 <= index < len(_STUDIO):
            raise UnknownNameError(f"there is no light {index}: expected 0 (key), 1 (fill) or 2 (rim)")
        self._hand_over()
        return SpotLight(self.own.lights[_STUDIO[index]])

    @property
    def m_background_color(self) -> NDArray[Any]:
        """sRGB, 0 to 1."""
        return np.asarray(self.own.settings.background.color)

    @m_background_color.setter
    def m_background_color(self, color: ArrayLike) -> None:
        self.own.settings.background.mode, self.own.settings.background.color = "color", _hex(color)

    @property
    def m_enable_ssao(self) -> bool:
        return self.own.settings.ssao.enabled is not False

    @m_enable_ssao.setter
    def m_enable_ssao(self, on: bool) -> None:
        self.own.settings.ssao.enabled = bool(on)

    @property
    def m_kernel_radius(self) -> Any:
        return self.own.settings.ssao.radius

    @m_kernel_radius.setter
    def m_kernel_radius(self, radius: float) -> None:
        self.own.settings.ssao.radius = float(radius)

    @property
    def m_enable_edl_lighting(self) -> bool:
        return bool(self.own.settings.edl.enabled)

    @m_enable_edl_lighting.setter
    def m_enable_edl_lighting(self, on: bool) -> None:
        self.own.settings.edl.enabled = bool(on)

    # Their numbers mean nothing to other formulas.
    m_ao_power: float = 1.0
    m_edl_strength: float = 1.0
    m_enable_culling = m_debug = False
    m_swap_buffers = True


class Recorder:
    """Writes pictures at once, so that none is in flight: is_finished() is always true."""

    def __init__(self, viewer: Viewer) -> None:
        self._viewer = weakref.ref(viewer)
        self._is_recording, self._count = False, 0

    def _of(self) -> Viewer:
        viewer = self._viewer()
        if viewer is None:
            raise ArgumentError("the viewer of this recorder is gone")
        return viewer

    def record(self, name: str, folder: "str | os.PathLike[str]" = ".") -> pathlib.Path:
        """Writes what is seen now to folder/name."""
        viewer = self._of()
        viewer._hand_over()
        pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
        self._count += 1
        return viewer.own.recorder.record(pathlib.Path(folder) / name, size=viewer._size())

    snapshot = record

    def write_without_buffering(self, mat: Mat, name: str, folder: "str | os.PathLike[str]" = ".") -> None:
        pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
        mat.to_file(pathlib.Path(folder) / name)

    def start_recording(self) -> None:
        """From now on each update() writes a picture to Viewer.m_recording_path."""
        self._is_recording = True

    def pause_recording(self) -> None:
        self._is_recording = False

    stop_recording = pause_recording

    def _add(self) -> None:
        if self._is_recording:
            self.record(f"{self._count:06}.png", self._of().m_recording_path)

    def is_finished(self) -> bool:
        return True

    def nr_images_recorded(self) -> int:
        return self._count


class Gui:
    """Image windows beside the scene."""

    @staticmethod
    def show(*mats_and_names: Any, interpolation: str = "bilinear") -> None:
        """Gui.show(mat, name[, mat, name ...]): images with blue, green, red channels, as OpenCV has them."""
        if len(mats_and_names) % 2:
            raise ArgumentError("Gui.show: expected images and names in turns")
        for mat, name in zip(mats_and_names[::2], mats_and_names[1::2]):
            data = mat.data if isinstance(mat, Mat) else np.atleast_3d(np.asarray(mat))
            for viewer in _viewers:
                viewer.own.show_image(name, np.ascontiguousarray(_swapped(data)))

    @staticmethod
    def selected_mesh_idx() -> int:
        """The first mesh: selections are the window's own."""
        return 0 if OwnScene.names() else -1
