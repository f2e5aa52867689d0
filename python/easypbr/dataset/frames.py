"""One frame of a data set: placed, drawn, annotated. Follows from the spec and the frame's number alone."""

from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import shapes
from .._easypbr import Camera, Environment, Instance, Light, Mesh, decode_image, encode_jpeg, load_image
from ..errors import ArgumentError, Error
from ..scene import Scene
from ..viewer import Viewer
from . import content
from .extents import bounds, diameter_of, fitted, is_lines, least_along, vertices_of, without_offset
from .frame import Frame, NextFrame, visible_corners
from .kept import Kept, bytes_of
from .lamps import random_light
from .poses import direction, draw, rotation, turn_about
from .spec import DatasetSpec
from .tables import ObjectSpec, SensorSpec

#: Name of the surroundings in the scene.
SURROUNDINGS = "surroundings"
_LAYERS = ("color", "depth", "normal_camera", "instance_id", "instances")
#: Bytes of meshes, and as many of skies, that a maker keeps.
_MOST_KEPT = 256 << 20

#: A mesh, and the least and largest coordinates in its own frame.
Model = tuple[Mesh, NDArray[Any], NDArray[Any]]


class FrameMaker:
    """Draws frames of a spec; `outputs` as ObjectSpec.files(). Meshes and skies are kept from frame to frame, up to a number of
    bytes; nothing else is."""

    classes: list[str]

    def __init__(self, spec: DatasetSpec, outputs: Collection[Path] = ()) -> None:
        spec.check()
        self.spec = spec
        self.classes = spec.class_names()
        self.skipped: list[str] = []
        self._files = [entry.files(outputs) for entry in spec.objects]
        self._models: Kept[Model] = Kept(_MOST_KEPT)
        self._skies: Kept[Environment] = Kept(_MOST_KEPT)
        self._surroundings: tuple[Mesh, NDArray[Any]] | None = None
        self._scene = Scene()
        self._view = Viewer(spec.image.size, {"ground.mode": "none"}, scene=self._scene)

    def _model(self, path: str) -> Model | None:
        """That of a file; None when it cannot be read and that is to be skipped."""
        if path in self.skipped:
            return None
        known = self._models.get(path)
        if known is not None:
            return known
        try:
            mesh = without_offset(Mesh(path))
        except Error:
            if self.spec.on_error == "stop":
                raise
            self.skipped.append(path)
            return None
        return self._models.put(path, (mesh, *bounds(mesh)), bytes_of(mesh))

    def _object(self, number: int, random: np.random.Generator) -> Model:
        entry = self.spec.objects[number]
        files = self._files[number]
        if not files:
            mesh = content.BUILTIN[entry.source.removeprefix("builtin:")](random)
            low, high = bounds(mesh)
        else:
            # The order is drawn whole, so that a file that is left out does not move the others.
            order = random.permutation(len(files))
            found = next((model for model in (self._model(files[i]) for i in order) if model is not None), None)
            if found is None:
                raise ArgumentError(f"dataset: {entry.source}: none of {len(files)} files can be read")
            kept, low, high = found
            mesh = kept.clone()
        if entry.random_material:
            content.random_material(mesh, random)
        return mesh, low, high

    def make(self, index: int) -> Frame:
        """The frame. Raises ArgumentError naming the constraint that cannot be met, and what reading meshes raises."""
        limit = self.spec.occlusion
        worst = ""
        for attempt in range(limit.tries):
            random = np.random.default_rng([self.spec.seed, index, attempt])
            data, camera, entries = self._attempt(random)
            counted = {name: entry for name, entry in entries.items() if not entry.distractor}
            worst = ""
            for instance in data["instances"]:
                if instance.name not in counted:
                    continue
                worst = self._what_fails(instance, counted[instance.name]) or worst
            if not worst:
                return self._finish(index, random, data, camera, counted)
        raise ArgumentError(f"dataset: frame {index}: {limit.tries} tries: {worst}")

    def _what_fails(self, instance: Instance, entry: ObjectSpec) -> str:
        """Which constraint an object does not meet, and what helps; empty when it meets all."""
        limit, placement = self.spec.occlusion, self.spec.placement
        if not instance.pixels_visible and is_lines(self._scene.get(instance.name)):
            return (f"a '{entry.name()}' has lines alone, which are in no layer: make it a distractor, or tubes of its "
                    "lines with mesh.to_tubes() or `easypbr convert --tubes RADIUS`")
        if not instance.pixels_visible:
            key = "placement.distance" if placement.mode == "frustum" else "placement.radius"
            others = ", or make surroundings.size larger" if self.spec.surroundings.source else ""
            return (f"no pixel of a '{entry.name()}' was visible: annotated objects must be in the image and not hidden: "
                    f"show fewer or larger objects, or make {key} smaller{others}")
        if instance.truncation > limit.max_truncation:
            failed = f"occlusion.max_truncation = {limit.max_truncation}"
        elif (instance.visible_fraction < limit.min_visible * (1 - limit.max_truncation)
              or instance.pixels_visible < limit.min_visible * instance.pixels_amodal_inside):
            failed = f"occlusion.min_visible = {limit.min_visible}"
        else:
            return ""
        return f"{failed} was not met: relax it, or show fewer objects"

    def _attempt(self, random: np.random.Generator) -> tuple[dict[str, Any], Camera, dict[str, ObjectSpec]]:
        spec = self.spec
        self._scene.clear()
        camera = self._camera(random)
        self._background(random)
        self._lights(random)
        self._surround(random)
        entries: dict[str, ObjectSpec] = {}
        spheres: list[tuple[NDArray[Any], float]] = []
        for number, entry in enumerate(spec.objects):
            low, high = entry.count
            for _ in range(int(random.integers(low, high + 1))):
                name = f"{len(entries):03d}"
                model = self._object(number, random)
                self._place(model, entry, camera, random, spheres)
                self._scene.show(model[0], name)
                entries[name] = entry
        if spec.placement.mode == "surface":
            ground = shapes.plane(4 * spec.placement.radius)
            content.random_material(ground, random)
            ground.material.metallic = 0
            self._scene.show(ground, "ground")
        self._view.refit()
        self._view.camera = camera
        classes = {name: self.classes.index(e.name()) + 1 for name, e in entries.items() if not e.distractor}
        self._view.settings["tonemap.exposure_compensation"] = draw(random, spec.sensor.exposure)
        data = self._view.render_layers(_LAYERS, samples=spec.image.samples, classes=classes)
        return data, camera, entries

    def _camera(self, random: np.random.Generator) -> Camera:
        given, (width, height) = self.spec.camera, self.spec.image.size
        azimuth, elevation = np.radians(draw(random, given.azimuth_deg)), np.radians(draw(random, given.elevation_deg))
        away = np.array([np.cos(elevation) * np.sin(azimuth), np.sin(elevation), np.cos(elevation) * np.cos(azimuth)])
        camera = Camera.look_at(away * draw(random, given.distance), (0, 0, 0))
        fov = draw(random, given.fov_y_deg)
        if given.K:
            K = np.array(given.K)
        else:
            focal = height / 2 / np.tan(np.radians(fov) / 2)
            K = np.array([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1]])
        return self._lens(K, camera.opencv_T_world_cam)

    def _lens(self, K: NDArray[Any], T_world_cam: NDArray[Any]) -> Camera:
        given = self.spec.camera
        return Camera.from_opencv(K, T_world_cam, self.spec.image.size, list(given.distortion), given.distortion_model)

    def _background(self, random: np.random.Generator) -> None:
        given, settings = self.spec.background, self._view.settings
        turn, intensity = random.uniform(-180, 180), draw(random, given.intensity)
        choice = int(random.integers(given.skies if given.mode == "sky" else max(len(given.files), 1)))
        settings["environment.rotation_deg"] = turn
        settings["environment.intensity"] = intensity
        settings["background.mode"] = "environment" if given.mode in ("sky", "environment") else given.mode
        settings["background.color"] = given.color
        if given.mode == "image":
            settings["background.image"] = given.files[choice]
        if given.mode in ("sky", "environment"):
            sky = self._skies.get(choice)
            if sky is None:
                own = np.random.default_rng([self.spec.seed, 1 << 32, choice])
                sky = content.sky(own) if given.mode == "sky" else Environment(load_image(given.files[choice]))
                self._skies.put(choice, sky, np.asarray(sky.to_numpy()).nbytes)
            self._scene.environment = sky

    def _surround(self, random: np.random.Generator) -> None:
        given = self.spec.surroundings
        if not given.source:
            return
        turn = turn_about(np.array([0.0, 1, 0]), np.radians(draw(random, given.turn_deg)))
        if self._surroundings is None:
            mesh = without_offset(Mesh(given.source))
            self._surroundings = mesh, fitted(mesh, given.size, given.up)
        mesh, T = self._surroundings
        placed = np.eye(4)
        placed[:3, :3] = turn
        mesh.T_parent_mesh = placed @ T
        self._scene.show(mesh, SURROUNDINGS)

    def _lights(self, random: np.random.Generator) -> None:
        for name in self._scene.light_names():
            self._scene.remove_light(name)
        for given in self.spec.lights:
            low, high = given.count
            for _ in range(int(random.integers(low, high + 1))):
                self._scene.set_light(f"light {len(self._scene.light_names())}", random_light(given, random))

    def _place(self, model: Model, entry: ObjectSpec, camera: Camera, random: np.random.Generator, spheres: list[Any]) -> None:
        """Sets the pose so that the mesh has its size and its ball meets no other's."""
        given = self.spec.placement
        size, turn = draw(random, entry.size), rotation(entry, random)
        mesh, low, high = model
        scale = size / max(float((high - low).max()), 1e-12)
        T = np.eye(4)
        T[:3, :3] = turn * scale
        middle = T[:3, :3] @ ((low + high) / 2)
        radius = float(np.linalg.norm(high - low)) / 2 * scale
        height = middle[1] - least_along(mesh, T[1, :3]) if given.mode == "surface" else 0.0
        for _ in range(given.tries):
            if given.mode == "frustum":
                centre = self._in_frustum(camera, random)
            else:
                r, a = given.radius * np.sqrt(random.random()), random.uniform(0, 2 * np.pi)
                centre = np.array([r * np.sin(a), height, r * np.cos(a)])
            if given.collisions or all(np.linalg.norm(centre - c) > radius + other for c, other in spheres):
                spheres.append((centre, radius))
                T[:3, 3] = centre - middle
                mesh.T_parent_mesh = T
                return
        raise ArgumentError(
            f"dataset: placement.collisions = false: no room for another '{entry.name()}' of {size:.3g} m in "
            f"{given.tries} tries: enlarge placement.{'distance' if given.mode == 'frustum' else 'radius'}, or show fewer or "
            "smaller objects"
        )

    def _in_frustum(self, camera: Camera, random: np.random.Generator) -> NDArray[Any]:
        given, size = self.spec.placement, np.array(self.spec.image.size)
        pixel = (given.margin + (1 - 2 * given.margin) * random.random(2)) * size - 0.5
        depth = draw(random, given.distance)
        T = camera.opencv_T_world_cam
        return T[:3, :3] @ (np.linalg.inv(camera.opencv_K(size)) @ [*pixel, 1] * depth) + T[:3, 3]

    def _next(self, random: np.random.Generator, camera: Camera) -> NextFrame:
        """Moves everything, draws, moves it back."""
        spec, poses = self.spec, {}
        for name in self._scene.names():
            mesh = self._scene.get(name)
            poses[name] = T = mesh.T_parent_mesh
            axis, shift = direction(random), direction(random) * draw(random, spec.motion.translation)
            angle = np.radians(draw(random, spec.motion.rotation_deg))
            if name in ("ground", SURROUNDINGS):
                continue
            moved, centre = T.copy(), T[:3, :3] @ np.mean(bounds(mesh), 0) + T[:3, 3]
            turn = turn_about(axis, angle)
            moved[:3, :3] = turn @ T[:3, :3]
            moved[:3, 3] = centre + shift + turn @ (T[:3, 3] - centre)
            mesh.T_parent_mesh = moved
        T_world_cam = camera.opencv_T_world_cam
        T_world_cam[:3, 3] += direction(random) * draw(random, spec.motion.camera)
        self._view.camera = self._lens(camera.opencv_K(spec.image.size), T_world_cam)
        picture = self._view.render_layers(["color"], samples=spec.image.samples)["color"][..., :3]
        moment = self._view.moment()
        for name, T in poses.items():
            self._scene.get(name).T_parent_mesh = T
        self._view.camera = camera
        data = self._view.render_layers(["flow_forward", "occlusion_forward"], next=moment)
        return NextFrame(sensor(picture, spec.sensor, random), data["flow_forward"], data["occlusion_forward"])

    def _finish(self, index: int, random: np.random.Generator, data: dict[str, Any], camera: Camera, counted: dict[str, Any]) -> Frame:
        size = self.spec.image.size
        picture = sensor(data["color"][..., :3], self.spec.sensor, random)
        wanted = [instance for instance in data["instances"] if instance.name in counted]
        numbers = np.zeros(len(data["instances"]) + 1, dtype=np.int32)
        objects = []
        for place, instance in enumerate(wanted):
            numbers[instance.id] = place + 1
            entry = _annotation(instance, counted[instance.name].name(), data["depth"])
            if "bop" in self.spec.writers:
                scale = np.linalg.norm(instance.T_cam_obj[:3, 0])
                entry["diameter"] = float(diameter_of(vertices_of(self._scene.get(instance.name))) * scale)
            objects.append(entry)
        moved = self._next(random, camera) if self.spec.motion else None
        return Frame(index, picture, data["depth"], data["normal_camera"], numbers[data["instance_id"]],
                     camera.opencv_K(size), camera.opencv_T_world_cam, list(camera.distortion),
                     self.spec.camera.distortion_model, objects, moved)


def sensor(picture: NDArray[Any], given: SensorSpec, random: np.random.Generator) -> NDArray[Any]:
    """The picture blurred, then with noise, then through a JPEG."""
    blur, noise = draw(random, given.blur), draw(random, given.noise)
    values = picture.astype(np.float32)
    if blur > 0.05:
        reach = int(np.ceil(3 * blur))
        kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / blur) ** 2).astype(np.float32)
        kernel /= kernel.sum()
        for axis in (0, 1):
            padded = np.pad(values, [(reach, reach) if a == axis else (0, 0) for a in range(3)], mode="edge")
            count = values.shape[axis]
            cuts = [padded[k : k + count] if axis == 0 else padded[:, k : k + count] for k in range(len(kernel))]
            values = np.asarray(sum((weight * cut for weight, cut in zip(kernel, cuts)), np.float32(0)))
    if noise > 0:
        values = values + random.standard_normal(values.shape, dtype=np.float32) * np.float32(255 * noise)
    picture = np.clip(np.rint(values), 0, 255).astype(np.uint8)
    if given.jpeg_quality == 100:
        return picture
    return decode_image(encode_jpeg(picture, round(draw(random, given.jpeg_quality))))[..., :3]


def _annotation(instance: Instance, class_name: str, depth: NDArray[Any]) -> dict[str, Any]:
    return {
        "class": class_name,
        "category_id": instance.semantic_id,
        "box": list(instance.box_visible),
        "box_amodal": list(instance.box_amodal),
        "pixels": instance.pixels_visible,
        "pixels_amodal": instance.pixels_amodal,
        "pixels_amodal_inside": instance.pixels_amodal_inside,
        "visible_fraction": instance.visible_fraction,
        "truncation": instance.truncation,
        "rle": instance.rle,
        "amodal_rle": instance.amodal_rle,
        "box3d_center": instance.box3d_center.tolist(),
        "box3d_size": instance.box3d_size.tolist(),
        "corners_px": instance.corners_px.tolist(),
        "corners_cam": instance.corners_cam.tolist(),
        "corners_visible": visible_corners(instance.corners_px, instance.corners_cam, depth),
        "T_cam_obj": instance.T_cam_obj.tolist(),
    }
