"""Tensors in CUDA memory: on a GPU where there is one, else by a driver that the test builds and that notes every call."""

import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest
import torch

from easypbr import ArgumentError, ContextError, Mesh, MeshLoader, Scene, Viewer, eigen2tensor, shapes

HERE = pathlib.Path(__file__).parent
NO_GPU = not torch.cuda.is_available()
needs_gpu = pytest.mark.skipif(NO_GPU, reason="left out: PyTorch sees no CUDA device on this machine")


def test_layers_by_way_of_a_driver_that_notes_its_calls(tmp_path):
    library = tmp_path / "libcuda.so.1"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-Wall", "-o", library, HERE / "fake_cuda.c", "-ldl"], check=True)
    environment = os.environ | {"LD_LIBRARY_PATH": str(tmp_path)}
    done = subprocess.run([sys.executable, HERE / "cuda_on_fake.py"], env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout == "done\n", done.stdout + done.stderr


@pytest.mark.skipif(not NO_GPU, reason="this machine has a GPU")
def test_without_a_gpu_it_says_so(tmp_path):
    scene = Scene()
    scene.show(shapes.sphere())
    for use in (
        lambda: Viewer((32, 32), scene=scene).render_layers(["depth"], as_="torch", device="cuda"),
        lambda: MeshLoader([tmp_path / "no.obj"], device="cuda"),
        lambda: eigen2tensor(np.zeros(3), device="cuda:1"),
    ):
        with pytest.raises(ContextError, match="device 'cuda(:1)?': PyTorch sees 0 CUDA devices.*'cpu'"):
            use()


def test_wrong_devices_are_refused():
    view = Viewer((32, 32), scene=Scene())
    with pytest.raises(ArgumentError, match="expected 'cpu', 'cuda' or 'cuda:1', got 'gpu'"):
        view.render_layers(["depth"], as_="torch", device="gpu")
    with pytest.raises(ArgumentError, match="numpy's arrays are the CPU's: expected as_='torch'"):
        view.render_layers(["depth"], device="cuda")


@needs_gpu
def test_layers_are_on_the_gpu_and_equal_the_cpus():
    scene = Scene()
    scene.show(shapes.sphere(1, 64), "ball")
    view = Viewer((160, 120), scene=scene)
    names = ["color", "depth", "distance", "normal_camera", "instance_id", "position", "uv"]
    there = view.render_layers(names, samples=1, as_="torch", device="cuda")
    here = view.render_layers(names, samples=1)
    for name in names:
        assert there[name].is_cuda and there[name].shape == here[name].shape, name
        # At silhouettes the rasteriser's depth changes within its rounding of vertices, 1/256 of a pixel.
        apart = np.abs(there[name].cpu().numpy().astype(float) - here[name]) > 1e-3
        assert apart.mean() < 1e-3, name


@needs_gpu
def test_tensors_come_from_the_gpu_and_the_loader_gives_them_there(tmp_path):
    V = torch.eye(3, device="cuda")
    mesh = Mesh(V, torch.tensor([[0, 1, 2]], device="cuda"))
    np.testing.assert_array_equal(mesh.V, np.eye(3))
    shapes.box().save(tmp_path / "box.ply")
    sample = next(iter(MeshLoader([tmp_path / "box.ply"], device="cuda")))
    assert sample["V"].is_cuda and len(sample["V"]) == len(Mesh(tmp_path / "box.ply").V)
