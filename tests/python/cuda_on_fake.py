"""Run by test_cuda.py, with its own libcuda.so.1 in the way: layers through GL-CUDA sharing without a GPU."""

import ctypes
import logging
import sys

import numpy as np
import torch

from easypbr import Camera, ContextError, Scene, Viewer, shapes, tensors, viewer

fake = ctypes.CDLL("libcuda.so.1")
fake.fake_calls.restype = ctypes.c_char_p
fake.fake_fail.argtypes = [ctypes.c_char_p]
ONE_COPY = "allocate register map array copy wait unmap unregister"
NAMES = ["color", "hdr", "depth", "distance", "position", "normal_camera", "normal_world", "albedo", "roughness", "metallic",
         "instance_id", "semantic_id"]
CLASSES = {"left": 5, "right": 9}


class Tensor(ctypes.Structure):
    """DLTensor of DLPack, which a DLManagedTensor begins with."""

    _fields_ = [("data", ctypes.c_void_p), ("device_type", ctypes.c_int32), ("device_id", ctypes.c_int32),
                ("ndim", ctypes.c_int32), ("code", ctypes.c_uint8), ("bits", ctypes.c_uint8), ("lanes", ctypes.c_uint16),
                ("shape", ctypes.POINTER(ctypes.c_int64)), ("strides", ctypes.c_void_p), ("offset", ctypes.c_uint64)]


def as_the_cpu_sees_it(capsule):
    """A copy of what a capsule says to lie in CUDA memory."""
    cuda = 2
    pointer = ctypes.pythonapi.PyCapsule_GetPointer
    pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    tensor = Tensor.from_address(pointer(capsule, b"dltensor"))
    assert (tensor.device_type, tensor.device_id) == (cuda, 0)
    shape = tensor.shape[: tensor.ndim]
    kind = {0: "i", 1: "u", 2: "f"}[tensor.code] + str(tensor.bits // 8)
    count = int(np.prod(shape)) * tensor.bits // 8
    return torch.from_numpy(np.frombuffer(ctypes.string_at(tensor.data, count), kind).reshape(shape).copy())


def calls():
    text = fake.fake_calls().decode().split()
    fake.fake_reset()
    return " ".join(text)


def make_view():
    scene = Scene()
    for name, x in (("left", -0.7), ("right", 0.7)):
        ball = shapes.sphere(0.6, 32)
        ball.material.base_color, ball.material.roughness, ball.material.metallic = (0.2, 0.5, 0.8), 0.4, 1.0
        T = np.eye(4)
        T[0, 3] = x
        ball.T_parent_mesh = T
        scene.show(ball, name)
    view = Viewer((96, 64), scene=scene)
    view.camera = Camera.look_at((0.3, 0.2, 3), (0, 0, 0))
    return view


tensors_device = torch.device("cuda")
viewer.check_device = lambda device: tensors_device  # what a machine with a GPU says
viewer.from_dlpack = as_the_cpu_sees_it
viewer.converter = lambda as_, device: tensors.converter(as_)
view = make_view()
truth = view.render_layers(NAMES, samples=1, classes=CLASSES)
assert calls() == "", "nothing is asked of CUDA for layers of the CPU"

layers = view.render_layers(NAMES + ["uv"], samples=1, classes=CLASSES, as_="torch", device="cpu:0")
log = calls()
targets = 7  # two pictures, depth, normal, albedo, material, id
assert log == " ".join(["retain"] + [ONE_COPY] * targets + ["free"] * targets), log
assert fake.fake_left() == 0, "everything is given back when the tensors are"
assert list(layers) == NAMES + ["uv"]
for name in NAMES:
    ours = layers[name].numpy()
    assert ours.shape == truth[name].shape and ours.dtype == truth[name].dtype, name
    # The same targets; depth is the rasteriser's instead of the face's own. 1/1000 of a radian of an angle is what the
    # normal's 16 bits leave.
    tolerance = {"depth": 1e-3, "distance": 1e-3, "position": 1e-3, "normal_camera": 1e-6, "normal_world": 1e-6}.get(name, 1e-7)
    np.testing.assert_allclose(ours, truth[name], rtol=0, atol=tolerance, err_msg=name)
assert set(np.unique(layers["instance_id"])) == {0, 1, 2}
assert set(np.unique(layers["semantic_id"])) == {0, 5, 9}

# Labels of elements are looked up on the CPU.
view.scene.get("left").L = np.arange(len(view.scene.get("left").F)) % 3
names = ["depth", "semantic_id"]
labelled = [view.render_layers(names, samples=1, **options) for options in ({}, {"as_": "torch", "device": "cpu:0"})]
assert (labelled[0]["semantic_id"] == labelled[1]["semantic_id"].numpy()).all() and list(labelled[1]) == names
assert len(np.unique(labelled[0]["semantic_id"])) > 2
calls()

# Orthographic depths and positions.
T = view.camera.opencv_T_world_cam
flat = view.camera
flat.projection, flat.ortho_height = "orthographic", 2.5
view.camera = flat
names = ["depth", "distance", "position"]
both = [view.render_layers(names, samples=1, **options) for options in ({}, {"as_": "torch", "device": "cpu:0"})]
for name in names:
    np.testing.assert_allclose(both[1][name].numpy(), both[0][name], atol=1e-3, err_msg=name)
calls()

# A call that fails leaves nothing behind, and names itself.
for name, call in (("allocate", "cuMemAlloc"), ("register", "cuGraphicsGLRegisterImage"), ("map", "cuGraphicsMapResources"),
                   ("array", "cuGraphicsSubResourceGetMappedArray"), ("copy", "cuMemcpy2D"), ("wait", "cuStreamSynchronize")):
    fake.fake_fail(name.encode())
    try:
        view.render_layers(["depth"], as_="torch", device="cpu:0")
        sys.exit(f"{call} failed unseen")
    except ContextError as error:
        assert str(error) == f"CUDA: {call} failed: out of memory (2)", error
    assert fake.fake_left() == 0, name
    calls()

# Where the targets are not the layers, these are made on the CPU.
said = []
logging.getLogger("easypbr").addHandler(type("Keep", (logging.Handler,), {"emit": lambda self, record: said.append(record.getMessage())})())
K = np.array([[90, 0.0, 48], [0, 90, 32], [0, 0, 1]])
view.camera = Camera.from_opencv(K, T, (96, 64), [0.1, 0, 0, 0])
view.render_layers(["depth"], as_="torch", device="cpu:0")
assert calls() == "" and "the camera's lens distorts: layers are made on the CPU" in said[-1], said
fake.fake_devices(0)
view.camera = Camera.look_at((0.3, 0.2, 3), (0, 0, 0))
there = view.render_layers(["depth"], samples=1, as_="torch", device="cpu:0")["depth"]
assert calls() == "" and "which is no CUDA device" in said[-1], said
assert (there.numpy() == truth["depth"]).all()
print("done")
