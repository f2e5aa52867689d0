"""Formats. Each has files of a frame, written with it, and files of the set, made of all frames' records at the end."""

import io
import json
import tarfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from .. import _easypbr
from ..errors import ArgumentError
from .frame import Frame
from .models import model_ply, single_model
from .tables import DatasetTables, Range


#: What is written whatever the writers are.
COMMON = ("images", "records", "unfinished", "statistics.html", "contact_sheet.png")


def _json(value: object) -> bytes:
    return (json.dumps(value, indent=1, allow_nan=False) + "\n").encode()


def _png(array: NDArray[Any]) -> bytes:
    return _easypbr.encode_png(array)


def _exr(array: NDArray[Any]) -> bytes:
    return _easypbr.encode_exr(np.ascontiguousarray(array, np.float32))


def _refuse(name: str, what: str) -> NoReturn:
    raise ArgumentError(f"dataset: writer {name}: {what}")


def decode_rle(rle: dict[str, Any]) -> NDArray[Any]:
    """The mask, height x width, of COCO's compressed run lengths."""
    height, width = rle["size"]
    counts: list[int] = []
    value = shift = 0
    for letter in rle["counts"].encode():
        group = letter - 48
        value |= (group & 31) << shift
        shift += 5
        if not group & 32:
            if group & 16:
                value -= 1 << shift
            counts.append(value + (counts[-2] if len(counts) > 2 else 0))
            value = shift = 0
    flags = np.repeat(np.arange(len(counts)) % 2 == 1, counts)
    return flags.reshape(width, height).T


def outputs(spec: DatasetTables, folder: Path) -> list[Path]:
    """Files and folders in the set's folder that all of its files are among, beside spec.json."""
    return [folder / name for name in (*COMMON, *(path for writer in spec.writers for path in WRITERS[writer].paths))]


class Writer:
    """The base of all: nothing is written."""

    image_format: str
    classes: list[str]
    spec: DatasetTables
    #: Files and folders in the set's folder that all of its files are among.
    paths: tuple[str, ...] = ()
    #: Whether finish() reads files that the spec names.
    reads_sources = False

    def __init__(self, image_format: str, classes: list[str], spec: DatasetTables | None = None) -> None:
        self.image_format, self.classes, self.spec = image_format, classes, spec or DatasetTables()

    @classmethod
    def check(cls, spec: DatasetTables) -> None:
        """Raises ArgumentError for a spec that the format cannot express."""

    def picture(self, index: int) -> str:
        """Where the picture of a frame is, in the set's folder."""
        return f"images/{index:06d}.{self.image_format}"

    def frame(self, frame: Frame) -> dict[str, bytes]:
        """Files of a frame by their path in the set's folder."""
        return {}

    def finish(self, records: list[dict[str, Any]], folder: Path) -> dict[str, bytes]:
        """Files of the set."""
        return {}


class Coco(Writer):
    """annotations.json: boxes, masks as run lengths, and the corners of the 3D box as keypoints: of visibility 2, of 1 behind
    what the picture shows, of 0 beyond it."""

    paths: tuple[str, ...] = ("annotations.json",)

    def finish(self, records: list[dict[str, Any]], folder: Path) -> dict[str, bytes]:
        images: list[dict[str, Any]] = []
        annotations: list[dict[str, Any]] = []
        for record in records:
            size = {"width": record["width"], "height": record["height"]}
            images.append({"id": record["index"], "file_name": self.picture(record["index"]), **size})
            for entry in record["objects"]:
                if entry["box"][2] < 1 or entry["box"][3] < 1:
                    continue  # Nothing is seen: COCO has no empty boxes.
                keypoints = self._keypoints(entry, record)
                annotations.append({
                    "id": len(annotations) + 1, "image_id": record["index"], "category_id": entry["category_id"],
                    "bbox": entry["box"], "area": entry["pixels"], "iscrowd": 0, "segmentation": entry["rle"],
                    "keypoints": keypoints, "num_keypoints": sum(flag > 0 for flag in keypoints[2::3]),
                })
        names = [f"corner_{i}" for i in range(8)]
        edges = [[a + 1, b + 1] for a in range(8) for b in range(a + 1, 8) if bin(a ^ b).count("1") == 1]
        categories = [{"id": i + 1, "name": name, "keypoints": names, "skeleton": edges} for i, name in enumerate(self.classes)]
        return {"annotations.json": _json({"images": images, "categories": categories, "annotations": annotations})}

    @staticmethod
    def _keypoints(entry: dict[str, Any], record: dict[str, Any]) -> list[float]:
        flat: list[float] = []
        for (x, y), visible in zip(entry["corners_px"], entry["corners_visible"]):
            if x is None or not (-0.5 <= x < record["width"] - 0.5 and -0.5 <= y < record["height"] - 0.5):
                flat += [0, 0, 0]
            else:  # COCO's pixel edges are at integers.
                flat += [round(x + 0.5, 3), round(y + 0.5, 3), 2 if visible else 1]
        return flat


class Yolo(Writer):
    """labels/*.txt: class, centre and size of the box as parts of the picture; data.yaml."""

    paths: tuple[str, ...] = ("labels", "data.yaml")

    def frame(self, frame: Frame) -> dict[str, bytes]:
        height, width = frame.depth.shape
        lines = []
        for entry in frame.objects:
            x, y, w, h = entry["box"]
            if w > 0 and h > 0:
                place = (x + w / 2) / width, (y + h / 2) / height, w / width, h / height
                lines.append(f"{entry['category_id'] - 1} " + " ".join(f"{value:.6f}" for value in place))
        return {f"labels/{frame.index:06d}.txt": "".join(line + "\n" for line in lines).encode()}

    def finish(self, records: list[dict[str, Any]], folder: Path) -> dict[str, bytes]:
        # JSON's texts are YAML's too: a name may look like a number or hold a colon.
        names = "".join(f"  {i}: {json.dumps(name, ensure_ascii=False)}\n" for i, name in enumerate(self.classes))
        # Without a path the folder of the file counts; "." would be the current one.
        return {"data.yaml": f"train: images\nval: images\nnames:\n{names}".encode()}


def _what_tilts(spec: DatasetTables) -> Iterator[str]:
    """What must be set otherwise for the y axes of the camera and of all annotated objects to be parallel."""
    elevation = spec.camera.elevation_deg
    if any(np.atleast_1d(elevation) != 0):
        yield f"camera.elevation_deg = 0 instead of {_number(elevation)}"
    for i, entry in enumerate(spec.objects):
        if entry.distractor:
            continue
        if entry.rotation == "any":
            yield f"objects[{i}].rotation = \"upright\" instead of \"any\""
        if entry.rotation != "none" and entry.tilt_deg != 0:
            yield f"objects[{i}].tilt_deg = 0 instead of {_number(entry.tilt_deg)}"


def _number(value: Range) -> str:
    return f"[{value[0]:g}, {value[1]:g}]" if isinstance(value, tuple) else f"{value:g}"


class Kitti(Writer):
    """image_2/*.png, label_2/*.txt and calib/*.txt of KITTI's object benchmark, depth/*.png (uint16, 1/256 m). Boxes turn about the
    camera's y axis alone: cameras are level, annotated objects upright."""

    paths: tuple[str, ...] = ("kitti",)

    @classmethod
    def check(cls, spec: DatasetTables) -> None:
        if spec.camera.distortion:
            _refuse("kitti", "its pictures are rectified: expected no camera.distortion")
        wanted = list(_what_tilts(spec))
        if wanted:
            _refuse("kitti", "its boxes turn only about the camera's y axis, so the camera must be level and annotated objects upright: "
                             f"expected {', '.join(wanted)}")

    def frame(self, frame: Frame) -> dict[str, bytes]:
        name = f"{frame.index:06d}"
        calib = "".join(f"{key}: {' '.join(f'{value:.12e}' for value in np.ravel(matrix))}\n"
                        for key, matrix in self._calibration(frame.K).items())
        # 0: no depth; farther than 65535 / 256 m is none either.
        depth = np.rint(frame.depth * 256)
        depth = np.where(depth < 65536, depth, 0).astype(np.uint16)
        labels = "".join(self._line(entry) for entry in frame.objects if entry["box"][2] > 0)
        return {f"kitti/label_2/{name}.txt": labels.encode(), f"kitti/calib/{name}.txt": calib.encode(),
                f"kitti/image_2/{name}.png": _png(frame.picture), f"kitti/depth/{name}.png": save16(depth)}

    @staticmethod
    def _calibration(K: NDArray[Any]) -> dict[str, NDArray[Any]]:
        """All matrices that readers ask for, by line or by name. The four cameras are one, where a laser scanner (x forward, y left,
        z up) and the inertial unit stand, too."""
        P = np.c_[K, np.zeros(3)]
        T_cam_velo = np.array([[0.0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 0]])
        return {"P0": P, "P1": P, "P2": P, "P3": P, "R0_rect": np.eye(3), "Tr_velo_to_cam": T_cam_velo, "Tr_imu_to_velo": np.eye(3, 4)}

    @staticmethod
    def _line(entry: dict[str, Any]) -> str:
        hidden = 1 - entry["pixels"] / max(entry["pixels_amodal_inside"], 1)
        occluded = 0 if hidden < 0.1 else 1 if hidden < 0.5 else 2
        T = np.array(entry["T_cam_obj"])
        scale = np.linalg.norm(T[:3, :3], axis=0)
        width, height, length = np.array(entry["box3d_size"]) * scale  # x, y, z of the object; z is its front
        bottom = np.array(entry["box3d_center"]) - (0, entry["box3d_size"][1] / 2, 0)
        x, y, z = T[:3, :3] @ bottom + T[:3, 3]
        front = T[:3, 2] / scale[2]
        turn = np.arctan2(-front[2], front[0])
        alpha = (turn - np.arctan2(x, z) + np.pi) % (2 * np.pi) - np.pi
        u, v, w, h = entry["box"]
        values = [entry["truncation"], alpha, u, v, u + w - 1, v + h - 1, height, width, length, x, y, z, turn]
        numbers = [f"{value:.3f}" for value in values]
        name = entry["class"].replace(" ", "_")
        return f"{name} {numbers[0]} {occluded} {' '.join(numbers[1:])}\n"


def save16(array: NDArray[Any]) -> bytes:
    """A PNG of 16 bits."""
    return _easypbr.encode_png(array, deep=True)


class Flow(Writer):
    """Optical flow as KITTI has it: image_2/*_10.png and *_11.png, flow_occ (all points) and flow_noc (those that the second
    picture shows too): uint16, 64 x pixels + 32768, the third channel 1 where there is a value: of
    the background there is none."""

    paths: tuple[str, ...] = ("kitti_flow",)

    @classmethod
    def check(cls, spec: DatasetTables) -> None:
        if not spec.motion:
            _refuse("flow", "nothing moves: expected motion.translation, rotation_deg or camera")

    def frame(self, frame: Frame) -> dict[str, bytes]:
        assert frame.next is not None  # The spec has motion: check() has seen to it.
        name, base = f"{frame.index:06d}", "kitti_flow"
        seen = frame.depth > 0
        return {f"{base}/image_2/{name}_10.png": _png(frame.picture), f"{base}/image_2/{name}_11.png": _png(frame.next.picture),
                f"{base}/flow_occ/{name}_10.png": save16(encode_flow(frame.next.flow, seen)),
                f"{base}/flow_noc/{name}_10.png": save16(encode_flow(frame.next.flow, seen & ~frame.next.occluded))}


def encode_flow(flow: NDArray[Any], valid: NDArray[Any]) -> NDArray[Any]:
    """height x width x 3 of uint16. What is 512 pixels or more cannot be said and is not valid,
    nor is what is not finite."""
    values = np.rint(np.asarray(flow, float) * 64 + 32768)
    valid = valid & np.isfinite(values).all(-1) & (values >= 0).all(-1) & (values < 65536).all(-1)
    return np.where(valid[..., None], np.dstack([values, np.ones(valid.shape)]), 0).astype(np.uint16)


class Bop(Writer):
    """A scene of the BOP challenge: rgb, depth, mask, mask_visib, scene_camera, scene_gt, scene_gt_info, models_info."""

    paths: tuple[str, ...] = ("bop",)
    reads_sources = True

    def frame(self, frame: Frame) -> dict[str, bytes]:
        name, base = f"{frame.index:06d}", "bop/000000"
        depth = np.rint(frame.depth * 1000 / self._depth_scale(frame.objects))
        files = {f"{base}/depth/{name}.png": save16(np.where(depth < 65536, depth, 0).astype(np.uint16)),
                 f"{base}/rgb/{name}.png": _png(frame.picture)}
        for i, entry in enumerate(frame.objects):
            visible = (frame.instance_id == i + 1).astype(np.uint8) * 255
            files[f"{base}/mask_visib/{name}_{i:06d}.png"] = _png(visible)
            files[f"{base}/mask/{name}_{i:06d}.png"] = _png(decode_rle(entry["amodal_rle"]).astype(np.uint8) * 255)
        return files

    def finish(self, records: list[dict[str, Any]], folder: Path) -> dict[str, bytes]:
        camera, truth, info = {}, {}, {}
        for record in records:
            T_cam_world = np.linalg.inv(record["T_world_cam"])
            key = str(record["index"])
            camera[key] = {"cam_K": np.ravel(record["K"]).tolist(), "depth_scale": self._depth_scale(record["objects"]),
                           "cam_R_w2c": T_cam_world[:3, :3].ravel().tolist(), "cam_t_w2c": (1000 * T_cam_world[:3, 3]).tolist()}
            if record["distortion"]:  # BOP has no key for a lens: these are ours.
                camera[key] |= {"cam_dist": record["distortion"], "cam_dist_model": record["distortion_model"]}
            truth[key] = [self._pose(entry) for entry in record["objects"]]
            info[key] = [self._info(entry) for entry in record["objects"]]
        base = "bop/000000"
        return {f"{base}/scene_camera.json": _json(camera), f"{base}/scene_gt.json": _json(truth),
                f"{base}/scene_gt_info.json": _json(info), **self._models(truth, folder)}

    @staticmethod
    def _depth_scale(objects: list[dict[str, Any]]) -> float:
        """Millimetres of a unit of depth in a frame: as many as 16 bits need to hold all annotated objects."""
        farthest = max((corner[2] for entry in objects for corner in entry["corners_cam"]), default=0)
        return float(max(1, np.ceil(1000 * farthest / 65535)))

    @staticmethod
    def _pose(entry: dict[str, Any]) -> dict[str, Any]:
        T = np.array(entry["T_cam_obj"])
        scale = np.linalg.norm(T[:3, :3], axis=0)
        size, centre = 1000 * scale * entry["box3d_size"], 1000 * scale * entry["box3d_center"]
        # A pose has no scale: the model is in millimetres as large as it is shown.
        model = dict(zip(("min_x", "min_y", "min_z"), (centre - size / 2).tolist()))
        model |= dict(zip(("size_x", "size_y", "size_z"), size.tolist()))
        return {"cam_R_m2c": (T[:3, :3] / scale).ravel().tolist(), "cam_t_m2c": (1000 * T[:3, 3]).tolist(),
                "obj_id": entry["category_id"], "model": {"diameter": 1000 * entry["diameter"], **model}}

    def _models(self, truth: dict[str, list[dict[str, Any]]], folder: Path) -> dict[str, bytes]:
        """models_info.json and the meshes of the classes whose objects are all of one file and size. A class is left out if its
        objects differ all the same, as where the file changed after some frames."""
        models: dict[int, list[dict[str, float]]] = {}
        for entries in truth.values():
            for entry in entries:
                models.setdefault(entry["obj_id"], []).append(entry["model"])
        single = {}
        for number, name in enumerate(self.classes, 1):
            source = single_model(self.spec, name, outputs(self.spec, folder))
            if source and number in models and _are_one(models[number]):
                single[number] = source
        info = {str(number): models[number][0] for number in single}
        return {"bop/models/models_info.json": _json(info),
                **{f"bop/models/obj_{number:06d}.ply": model_ply(*source) for number, source in single.items()}}

    @staticmethod
    def _info(entry: dict[str, Any]) -> dict[str, Any]:
        def box(xywh: list[int]) -> list[int]:  # BOP's width is the difference of the outermost pixels.
            return [xywh[0], xywh[1], xywh[2] - 1, xywh[3] - 1] if xywh[2] > 0 else [-1, -1, -1, -1]

        return {"bbox_obj": box(entry["box_amodal"]), "bbox_visib": box(entry["box"]), "px_count_all": entry["pixels_amodal"],
                "px_count_valid": entry["pixels_amodal_inside"], "px_count_visib": entry["pixels"],
                "visib_fract": entry["visible_fraction"]}


#: The coefficients in OpenCV's order.
_BROWN = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")


def _has_skew(spec: DatasetTables) -> bool:
    return bool(spec.camera.K) and spec.camera.K[0][1] != 0


def _are_one(models: list[dict[str, float]]) -> bool:
    """Whether the boxes and diameters are those of one model, but for the rounding of poses (1e-15 of its size)."""
    values = np.array([list(model.values()) for model in models])
    return bool((np.ptp(values, axis=0) <= 1e-9 * values[:, 0].max()).all())  # The first is the diameter.


class Nerfstudio(Writer):
    """transforms.json: poses with OpenGL's axes, the lens's coefficients."""

    paths: tuple[str, ...] = ("transforms.json",)

    @classmethod
    def check(cls, spec: DatasetTables) -> None:
        if _has_skew(spec) or (spec.camera.distortion_model != "fisheye" and len(spec.camera.distortion) > 5):
            _refuse("nerfstudio", "its cameras have no skew and at most k1, k2, p1, p2, k3: choose another camera.K or distortion")

    def finish(self, records: list[dict[str, Any]], folder: Path) -> dict[str, bytes]:
        frames = []
        for record in records:
            K = np.array(record["K"])
            T = np.array(record["T_world_cam"]) @ np.diag([1, -1, -1, 1.0])
            # Its pixel edges are at integers.
            frames.append({"file_path": self.picture(record["index"]), "transform_matrix": T.tolist(), "fl_x": K[0, 0],
                           "fl_y": K[1, 1], "cx": K[0, 2] + 0.5, "cy": K[1, 2] + 0.5, "w": record["width"], "h": record["height"]})
        lens, model = records[0]["distortion"], records[0]["distortion_model"]
        if not lens:
            common = {"camera_model": "PINHOLE"}
        elif model == "fisheye":
            common = {"camera_model": "OPENCV_FISHEYE", **dict(zip(("k1", "k2", "k3", "k4"), lens))}
        else:
            common = {"camera_model": "OPENCV", **dict(zip(_BROWN, lens))}
        return {"transforms.json": _json({**common, "frames": frames})}


class Colmap(Writer):
    """sparse/0/cameras.txt, images.txt and an empty points3D.txt."""

    paths: tuple[str, ...] = ("sparse",)

    @classmethod
    def check(cls, spec: DatasetTables) -> None:
        if _has_skew(spec):
            _refuse("colmap", "its cameras have no skew: expected camera.K with a zero there")

    @staticmethod
    def _model(record: dict[str, Any]) -> tuple[str, list[Any]]:
        """COLMAP's name of the camera model, and the coefficients after fx, fy, cx, cy."""
        lens = record["distortion"]
        if not lens:
            return "PINHOLE", []
        if record["distortion_model"] == "fisheye":
            return "OPENCV_FISHEYE", lens
        return ("OPENCV", lens) if len(lens) == 4 else ("FULL_OPENCV", lens + [0.0] * (8 - len(lens)))

    def finish(self, records: list[dict[str, Any]], folder: Path) -> dict[str, bytes]:
        cameras, images = ["# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]"], ["# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME"]
        for record in records:
            K, number = np.array(record["K"]), record["index"] + 1
            model, lens = self._model(record)
            numbers = " ".join(f"{v:.9f}" for v in (K[0, 0], K[1, 1], K[0, 2] + 0.5, K[1, 2] + 0.5, *lens))
            cameras.append(f"{number} {model} {record['width']} {record['height']} {numbers}")
            T = np.linalg.inv(record["T_world_cam"])
            pose = " ".join(f"{value:.9f}" for value in (*quaternion(T[:3, :3]), *T[:3, 3]))
            images += [f"{number} {pose} {number} {Path(self.picture(record['index'])).name}", ""]
        return {"sparse/0/cameras.txt": "\n".join(cameras + [""]).encode(), "sparse/0/points3D.txt": b"",
                "sparse/0/images.txt": "\n".join(images + [""]).encode()}


def quaternion(R: NDArray[Any]) -> NDArray[Any]:
    """w, x, y, z of a rotation, w not negative: the eigenvector of Bar-Itzhack's matrix (2000)."""
    (a, b, c), (d, e, f), (g, h, i) = R
    M = np.array([[a - e - i, b + d, c + g, h - f], [b + d, e - a - i, f + h, c - g],
                  [c + g, f + h, i - a - e, d - b], [h - f, c - g, d - b, a + e + i]]) / 3
    x, y, z, w = np.linalg.eigh(M)[1][:, -1]
    q = np.array([w, x, y, z])
    return -q if q[0] < 0 else q


class WebDataset(Writer):
    """shards/*.tar of up to 1000 samples: the picture and its annotation."""

    paths: tuple[str, ...] = ("shards",)
    per_shard = 1000

    def finish(self, records: list[dict[str, Any]], folder: Path) -> dict[str, bytes]:
        files = {}
        for first in range(0, len(records), self.per_shard):
            buffer = io.BytesIO()
            with tarfile.open(fileobj=buffer, mode="w", format=tarfile.USTAR_FORMAT) as tar:
                for record in records[first : first + self.per_shard]:
                    name = f"{record['index']:06d}"
                    picture = (folder / self.picture(record["index"])).read_bytes()
                    for extension, data in ((self.image_format, picture), ("json", _json(record))):
                        entry = tarfile.TarInfo(f"{name}.{extension}")  # of time 0: the same bytes at every run
                        entry.size = len(data)
                        tar.addfile(entry, io.BytesIO(data))
            files[f"shards/{first // self.per_shard:06d}.tar"] = buffer.getvalue()
        return files


class Raw(Writer):
    """raw/*.npz: depth, normals, instance ids, K, T_world_cam; with motion, flow and occlusion."""

    paths: tuple[str, ...] = ("raw",)

    def frame(self, frame: Frame) -> dict[str, bytes]:
        buffer = io.BytesIO()
        moved = {} if frame.next is None else {"flow_forward": frame.next.flow, "occlusion_forward": frame.next.occluded}
        np.savez_compressed(buffer, depth=frame.depth, normal_camera=frame.normal, instance_id=frame.instance_id, K=frame.K,
                            T_world_cam=frame.T_world_cam, **moved)
        return {f"raw/{frame.index:06d}.npz": buffer.getvalue()}


class Exr(Writer):
    """exr/depth, exr/normal, exr/id: float32, without loss."""

    paths: tuple[str, ...] = ("exr",)

    def frame(self, frame: Frame) -> dict[str, bytes]:
        name = f"{frame.index:06d}.exr"
        return {f"exr/depth/{name}": _exr(frame.depth), f"exr/normal/{name}": _exr(frame.normal),
                f"exr/id/{name}": _exr(frame.instance_id)}


class Png(Writer):
    """depth/*.png (uint16, millimetres), normals/*.png and ids/*.png (uint16): what a fast loader reads."""

    paths: tuple[str, ...] = ("depth", "normals", "ids")

    @classmethod
    def check(cls, spec: DatasetTables) -> None:
        most = sum(entry.count[1] for entry in spec.objects if not entry.distractor)
        if most > 65535:
            _refuse("png", f"its 16 bits hold up to 65535 instances, and objects.count allows for {most}: choose exr or raw")

    def frame(self, frame: Frame) -> dict[str, bytes]:
        name = f"{frame.index:06d}.png"
        depth = np.rint(frame.depth * 1000)
        return {f"depth/{name}": save16(np.where(depth < 65536, depth, 0).astype(np.uint16)),
                f"normals/{name}": _png(np.rint(127.5 * (frame.normal + 1)).astype(np.uint8)),
                f"ids/{name}": save16(frame.instance_id.astype(np.uint16))}


WRITERS: dict[str, type[Writer]] = {"coco": Coco, "yolo": Yolo, "kitti": Kitti, "flow": Flow, "bop": Bop, "nerfstudio": Nerfstudio, "colmap": Colmap,
           "webdataset": WebDataset, "raw": Raw, "exr": Exr, "png": Png}
