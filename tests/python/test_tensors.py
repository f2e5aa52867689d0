"""Arrays of torch and of whatever has DLPack; the parallel loader."""

import pickle

import numpy as np
import pytest
import torch

from easypbr import ArgumentError, FileError, Mesh, MeshLoader, Scene, Viewer, as_mesh, eigen2tensor, shapes, tensor2eigen


class OnlyDlpack:
    """Nothing but the protocol."""

    def __init__(self, array):
        self.array = array

    def __dlpack__(self, **options):
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


def test_the_loop_of_the_paper(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shapes.sphere().save("lantern.obj")
    net = lambda points: (points @ torch.ones(3, requires_grad=True) > 0).long()  # noqa: E731

    cloud   = Mesh("./lantern.obj")  # noqa: E221
    points  = eigen2tensor(cloud.V)  # noqa: E221
    pred    = net(points)  # noqa: E221
    cloud.L = tensor2eigen(pred)
    Scene.show(cloud, "cloud")

    assert (cloud.L == (cloud.V.sum(1) > 0)).all()
    Viewer((32, 32)).render(samples=1)


def test_tensors_are_taken_everywhere():
    V = torch.tensor([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], requires_grad=True)
    F = torch.tensor([[0, 1, 2]])
    mesh = Mesh(V, F)
    np.testing.assert_array_equal(mesh.V, V.detach().numpy())
    mesh.V = V * 2
    mesh.L = F[0]
    mesh.C = OnlyDlpack(np.eye(3))
    np.testing.assert_array_equal(mesh.V, 2 * V.detach().numpy())
    np.testing.assert_array_equal(mesh.C, np.eye(3))
    mesh.T_parent_mesh = torch.eye(4)
    Scene.show((V, F), "triangle")
    with pytest.raises(ArgumentError, match="argmax"):
        mesh.L = torch.zeros(3, 5, requires_grad=True)
    with pytest.raises(ArgumentError, match="argmax"):
        mesh.L = tensor2eigen(torch.zeros(3, 5, requires_grad=True))


def test_short_floats_become_float32():
    """numpy has no bfloat16."""
    V = torch.tensor([[0.5, 1, 2], [3, 4, 5], [6, 7.5, 8]])
    short = V.to(torch.bfloat16).requires_grad_()
    mesh = as_mesh(short)
    mesh.C = (V / 16).to(torch.bfloat16)
    for values in (mesh.V, 16 * mesh.C, Mesh(short).V, tensor2eigen(short), eigen2tensor(short)):
        np.testing.assert_array_equal(values, V)
    assert eigen2tensor(short).dtype == torch.float32 and tensor2eigen(V.half()).dtype == np.float16


@pytest.mark.parametrize("tensor, message", [
    (torch.eye(3).to_sparse(), "a tensor of torch.float32, torch.sparse_coo: expected numbers that numpy has: "),
    (torch.empty((3, 3), device="meta"), "a tensor of torch.float32, torch.strided: .*no data"),
    (torch.quantize_per_tensor(torch.eye(3), 0.01, 0, torch.quint8), "a tensor of torch.quint8, torch.strided: "),
])
def test_tensors_that_are_no_arrays_are_named(tensor, message):
    for take in (as_mesh, tensor2eigen, Mesh):
        with pytest.raises(ArgumentError, match=message) as caught:
            take(tensor)
        assert "Traceback" not in str(caught.value)


def test_eigen2tensor_may_be_written_to():
    mesh = shapes.sphere()
    tensor = eigen2tensor(mesh.V)
    tensor += 1
    assert np.abs(mesh.V).max() < 1.1
    assert tensor.dtype == torch.float32 and eigen2tensor(mesh.F).dtype == torch.int32


def test_layers_as_tensors():
    scene = Scene()
    scene.show(shapes.sphere(), "ball")
    data = Viewer((32, 24), scene=scene).render_layers(["depth", "instance_id", "instances"], as_="torch")
    assert isinstance(data["depth"], torch.Tensor) and tuple(data["depth"].shape) == (24, 32)
    assert data["instance_id"].dtype == torch.int32
    assert data["instances"][0].name == "ball"


@pytest.fixture
def files(tmp_path):
    paths = [tmp_path / f"{i}.ply" for i in range(6)]
    for i, path in enumerate(paths):
        shapes.sphere(segments=8 + 8 * (i % 3)).save(path)
    return paths


def test_loader_keeps_the_order(files):
    loader = MeshLoader(files, workers=3, prefetch=2)
    assert len(loader) == 6
    assert [len(sample["V"]) for sample in loader] == [len(Mesh(path).V) for path in files]
    assert [m for m in MeshLoader(files, transform=lambda mesh: len(mesh.F))] == [len(Mesh(path).F) for path in files]
    assert isinstance(loader, torch.utils.data.IterableDataset)
    batches = list(torch.utils.data.DataLoader(loader, batch_size=None))
    assert len(batches) == 6 and isinstance(batches[0]["V"], torch.Tensor)


@pytest.mark.parametrize("method", ["spawn", "forkserver"])
def test_loader_goes_to_workers_that_are_started_anew(files, method):
    """Each has its own share of the files."""
    loader = MeshLoader(files, transform=count_vertices)
    workers = torch.utils.data.DataLoader(loader, batch_size=None, num_workers=2, multiprocessing_context=method)
    assert list(workers) == [len(Mesh(path).V) for path in files]
    other = pickle.loads(pickle.dumps(Derived(files)))
    assert type(other).__mro__[1] is Derived and isinstance(other, torch.utils.data.IterableDataset) and len(other) == 6


class Derived(MeshLoader):
    """A loader of a user's own."""


def count_vertices(mesh):
    return len(mesh.V)


def test_loader_raises_at_the_sample(files):
    files[2].unlink()
    samples = iter(MeshLoader(files))
    next(samples), next(samples)
    with pytest.raises(FileError, match="2.ply"):
        next(samples)
    assert len(list(MeshLoader(files, on_error="skip"))) == 5
    with pytest.raises(ArgumentError, match="worker"):
        next(iter(MeshLoader(files, workers=0)))


def test_loader_reads_semantic_kitti(tmp_path):
    (tmp_path / "velodyne").mkdir()
    (tmp_path / "labels").mkdir()
    points = np.random.default_rng(0).normal(size=(50, 4)).astype("<f4")
    labels = np.full(50, 40 | (7 << 16), "<u4")
    points.tofile(tmp_path / "velodyne/000000.bin")
    labels.tofile(tmp_path / "labels/000000.label")
    (sample,) = MeshLoader([tmp_path / "velodyne/000000.bin"])
    np.testing.assert_array_equal(sample["V"].numpy(), points[:, :3])
    assert (sample["L"] == 40).all()


def test_bindings_take_a_meshs_array_for_numpys():
    """nanobind looks at the module of an array's class before it converts numbers (ndarray_import())."""
    V = shapes.box().V
    assert type(V).__module__ == "numpy"
    assert type(pickle.loads(pickle.dumps(V))) is np.ndarray
