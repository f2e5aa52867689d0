#!/usr/bin/env python3
"""Fits a sphere's vertices to the points of a bean by gradient descent, and serves both while it runs: open the printed link in
a browser, turn the view, change the rate and watch the loss.

usage: watch_fit.py [--steps N] [--port N]
Needs PyTorch; a minute on a CPU. The server draws on a thread of its own: the loop does not wait for browsers.
"""
import argparse

import numpy as np
import torch

from easypbr import Material, Mesh, Panel, Scene, Viewer, eigen2tensor, shapes


def chamfer(a: torch.Tensor, b: torch.Tensor) -> torch.Tensor:
    """Mean squared distance of each point to the nearest of the other set, in both directions."""
    squared: torch.Tensor = torch.cdist(a, b).square()
    mean: torch.Tensor = squared.amin(0).mean() + squared.amin(1).mean()
    return mean


def roughness(V: torch.Tensor, edges: torch.Tensor) -> torch.Tensor:
    """Mean squared distance of each vertex to the mean of its neighbours."""
    ends = torch.cat([edges, edges.flip(1)])
    sums = torch.zeros_like(V).index_add(0, ends[:, 0], V[ends[:, 1]])
    counts = torch.zeros(len(V)).index_add(0, ends[:, 0], torch.ones(len(ends)))
    mean: torch.Tensor = (V - sums / counts.clamp(min=1)[:, None]).square().sum(1).mean()
    return mean


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=600)
    parser.add_argument("--port", type=int, default=0)
    options = parser.parse_args()
    torch.manual_seed(0)
    target = eigen2tensor(shapes.sphere(1, 48).V)
    target = target[torch.randperm(len(target))[:1500]] * torch.tensor([1.0, 0.6, 0.6])
    target[:, 1] -= 0.5 * target[:, 0].square()
    ball = shapes.sphere(0.8, 32)
    corners, numbers = np.unique(np.round(ball.V, 4), axis=0, return_inverse=True)  # One vertex where its two edges meet.
    fitted = Mesh(corners, numbers.reshape(-1)[ball.F])
    fitted.material = Material(base_color="#e0a030", roughness=0.5)
    V = eigen2tensor(fitted.V).requires_grad_()
    F = eigen2tensor(fitted.F).long()
    edges = torch.cat([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])

    scene = Scene()
    scene.show(fitted, "fitted")
    points = Mesh(V=target)
    points.style.point_size, points.style.point_size_unit = 0.02, "world"
    scene.show(points, "target")
    view = Viewer((960, 720), scene=scene)
    losses: list[float] = []
    state = {"rate": 5e-3, "stops": False}

    @view.add_panel("Fit")
    def panel(ui: Panel) -> None:
        state["rate"] = ui.slider("rate", state["rate"], 1e-4, 2e-2)
        ui.plot("loss", losses)
        state["stops"] = ui.button("Stop") or state["stops"]

    optimizer = torch.optim.Adam([V], state["rate"])
    with view.serve(port=options.port) as server:
        print(server.url, flush=True)
        for _ in range(options.steps):
            optimizer.param_groups[0]["lr"] = state["rate"]
            loss = torch.add(chamfer(V, target), roughness(V, edges), alpha=0.2)
            optimizer.zero_grad()
            torch.autograd.backward(loss)
            optimizer.step()
            losses.append(float(loss.detach()))
            fitted.V = V.detach()  # Seen in every browser at once.
            if state["stops"]:
                break
    print(f"loss {losses[0]:.4f} before, {losses[-1]:.4f} after {len(losses)} steps")
    view.recorder.record("fit.png")


if __name__ == "__main__":
    main()
