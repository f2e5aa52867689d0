"""What a data set is made of: plain classes, the tables of a TOML file."""

import dataclasses
import glob
import json
import os
import urllib.parse
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

from .._easypbr import readable_mesh_extensions
from ..errors import ArgumentError
from .content import BUILTIN

#: A number, or the least and the largest of a uniform distribution.
Range = float | tuple[float, float]


@dataclasses.dataclass
class ImageSpec:
    """The pictures."""

    size: tuple[int, int] = (640, 480)
    samples: int = 4
    format: str = "png"


@dataclasses.dataclass
class CameraSpec:
    """Where the camera stands, looking at the origin, and its lens."""

    fov_y_deg: Range = (35.0, 60.0)
    K: tuple[Any, ...] = ()
    distortion: tuple[float, ...] = ()
    distortion_model: str = "brown_conrady"
    distance: Range = 4.0
    azimuth_deg: Range = (-180.0, 180.0)
    elevation_deg: Range = (-25.0, 35.0)


@dataclasses.dataclass
class ObjectSpec:
    """A class of objects. `source`: a file, a folder, a pattern of files, or "builtin:drone", "builtin:shapes"."""

    source: str = "builtin:drone"
    class_name: str = ""
    count: tuple[int, int] = (1, 1)
    size: Range = (0.6, 1.2)
    rotation: str = "upright"
    tilt_deg: float = 0.0
    distractor: bool = False
    random_material: bool = False

    def name(self) -> str:
        """The name of the class: the one given, or that of its source."""
        return self.class_name or Path(self.source.removeprefix("builtin:")).stem

    def files(self, outputs: Collection[Path] = ()) -> list[str]:
        """The meshes that the source names; none for what is built in. Buffers of glTF files, whose name may end as that of a
        scan does (.bin), are none, nor is what a folder or pattern finds in `outputs`, folders that the set writes to. Raises
        ArgumentError for an unknown builtin and where there is no mesh."""
        if self.source.startswith("builtin:"):
            name = self.source.removeprefix("builtin:")
            if name not in BUILTIN:
                raise ArgumentError(f"dataset: there is no builtin '{name}': expected {', '.join(BUILTIN)}")
            return []
        if os.path.isdir(self.source):
            known = {"." + extension.lstrip(".") for extension in readable_mesh_extensions()}
            found = [str(p) for p in sorted(Path(self.source).rglob("*")) if p.suffix.lower() in known]
        else:
            found = [] if os.path.exists(self.source) else sorted(glob.glob(self.source, recursive=True))
            if not found:
                return [self.source]
        files = without_buffers(_outside(found, outputs))
        if not files:
            raise ArgumentError(f"dataset: {self.source}: there is no mesh")
        return files


def _outside(files: list[str], folders: Collection[Path]) -> list[str]:
    """The files that are in none of these folders, nor beneath them."""
    real_folders = [os.path.realpath(folder) for folder in folders]
    parents = {os.path.dirname(file) for file in files}
    inside = {parent for parent in parents if any(Path(os.path.realpath(parent)).is_relative_to(real) for real in real_folders)}
    return [file for file in files if os.path.dirname(file) not in inside]


def without_buffers(files: list[str]) -> list[str]:
    """The files less the buffers of glTF files among and beside them."""
    bins = [file for file in files if file.lower().endswith(".bin")]
    if not bins:
        return files
    scenes = {Path(file) for file in files if file.lower().endswith(".gltf")}
    for folder in {Path(file).parent for file in bins}:
        scenes |= {path for path in folder.glob("*") if path.suffix.lower() == ".gltf"}
    buffers = {path for scene in scenes for path in _buffers_of(scene)}
    return [file for file in files if os.path.realpath(file) not in buffers]


def _buffers_of(scene: Path) -> Iterator[str]:
    """The files that a glTF file names as its buffers; none of one that cannot be read, of which its reader tells."""
    try:
        uris = [buffer["uri"] for buffer in json.loads(scene.read_bytes())["buffers"] if "uri" in buffer]
        for uri in uris:
            if not uri.startswith("data:"):
                yield os.path.realpath(scene.parent / urllib.parse.unquote(uri))
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return


@dataclasses.dataclass
class PlacementSpec:
    """Where objects are: in the camera's frustum, or on a ground of this radius around the origin."""

    mode: str = "frustum"
    distance: Range = (3.0, 9.0)
    margin: float = 0.1
    radius: float = 3.0
    collisions: bool = False
    tries: int = 200


@dataclasses.dataclass
class OcclusionSpec:
    """Frames in which an object is hidden or cut off more than this are placed anew."""

    min_visible: float = 0.1
    max_truncation: float = 0.7
    tries: int = 20


@dataclasses.dataclass
class BackgroundSpec:
    """What lights and stands behind: sky (procedural), environment or image files, or color."""

    mode: str = "sky"
    files: tuple[str, ...] = ()
    color: str = "#808080"
    skies: int = 6
    intensity: Range = (0.7, 1.3)


@dataclasses.dataclass
class SurroundingsSpec:
    """A file that stands around the objects in every frame, such as a captured room of Gaussian splats: hidden by objects
    and hiding them, not annotated. Without a source there is none. The box around all but the outermost hundredth of its
    vertices has its middle at the origin, and a longest side of `size` metres; `up` is the axis of the file that points up:
    x, y, z, -x, -y or -z, in either case; +x is x. It is turned about the vertical by `turn_deg`."""

    source: str = ""
    size: float = 8.0
    up: str = "y"
    turn_deg: Range = 0.0


@dataclasses.dataclass
class LightSpec:
    """Lights beside the background: a number of suns (directional), or of lamps `distance` from the origin: point, or area
    lights that face it (square rectangle, disc, sphere) of a side or diameter `size` in world units. `illuminance` (lux) is
    what each gives there; the hue is random, `saturation` says how far it is from white."""

    type: str = "directional"
    count: tuple[int, int] = (1, 1)
    illuminance: Range = (1.0, 4.0)
    azimuth_deg: Range = (-180.0, 180.0)
    elevation_deg: Range = (15.0, 75.0)
    distance: Range = 6.0
    size: Range = 1.0
    saturation: Range = (0.0, 0.3)


@dataclasses.dataclass
class MotionSpec:
    """What moves until the next frame, for optical flow: objects along and about random axes, the camera along one."""

    translation: Range = 0.0
    rotation_deg: Range = 0.0
    camera: Range = 0.0

    def __bool__(self) -> bool:
        return any(value != 0 for value in dataclasses.astuple(self))


@dataclasses.dataclass
class SensorSpec:
    """What the sensor does: exposure in stops, blur and noise as standard deviations (pixels; parts of full scale), and the
    losses of a JPEG of this quality (100: none is made)."""

    exposure: Range = 0.0
    blur: Range = 0.0
    noise: Range = 0.0
    jpeg_quality: Range = 100.0


@dataclasses.dataclass
class DatasetTables:
    """All values of a data set; see DatasetSpec."""

    count: int = 100
    seed: int = 0
    writers: tuple[str, ...] = ("coco", "yolo")
    on_error: str = "stop"
    image: ImageSpec = dataclasses.field(default_factory=ImageSpec)
    camera: CameraSpec = dataclasses.field(default_factory=CameraSpec)
    objects: list[ObjectSpec] = dataclasses.field(default_factory=list)
    placement: PlacementSpec = dataclasses.field(default_factory=PlacementSpec)
    occlusion: OcclusionSpec = dataclasses.field(default_factory=OcclusionSpec)
    background: BackgroundSpec = dataclasses.field(default_factory=BackgroundSpec)
    surroundings: SurroundingsSpec = dataclasses.field(default_factory=SurroundingsSpec)
    lights: list[LightSpec] = dataclasses.field(default_factory=list)
    motion: MotionSpec = dataclasses.field(default_factory=MotionSpec)
    sensor: SensorSpec = dataclasses.field(default_factory=SensorSpec)

    def class_names(self) -> list[str]:
        """The classes that are annotated, in the order of their ids, which begin at 1."""
        return list(dict.fromkeys(entry.name() for entry in self.objects if not entry.distractor))
