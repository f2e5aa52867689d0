#!/usr/bin/env python3
"""Side-by-side baseline: VTK 9.7 (PyPI) on the same mesh, environment and size.

usage: peer_vtk.py MESH.ply MODE FRAMES [--env FILE.hdr] [--size WxH] [--out PREFIX]
MODE: phong | pbr (image-based lighting) | full (pbr + SSAO + tone mapping)
Prints one JSON line: seconds to load, for normals and for the first frame; median and minimum ms per frame while the
camera orbits by 3 degrees a frame, each frame finished by reading a pixel back.
"""
import argparse
import json
import math
import time

import vtk

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("mesh")
parser.add_argument("mode", choices=["phong", "pbr", "full"])
parser.add_argument("frames", type=int)
parser.add_argument("--env", required=True)
parser.add_argument("--size", default="1920x1080")
parser.add_argument("--out")
args = parser.parse_args()
width, height = map(int, args.size.split("x"))

t0 = time.perf_counter()
reader = vtk.vtkPLYReader() if args.mesh.endswith(".ply") else vtk.vtkOBJReader()
reader.SetFileName(args.mesh)
reader.Update()
t1 = time.perf_counter()

mapper = vtk.vtkPolyDataMapper()
source = reader
if args.mode != "phong":
    source = vtk.vtkPolyDataNormals()
    source.SetInputConnection(reader.GetOutputPort())
    source.SplittingOff()
    source.Update()
mapper.SetInputConnection(source.GetOutputPort())
t2 = time.perf_counter()

actor = vtk.vtkActor()
actor.SetMapper(mapper)
renderer = vtk.vtkRenderer()
renderer.AddActor(actor)
if args.mode != "phong":
    actor.GetProperty().SetInterpolationToPBR()
    actor.GetProperty().SetMetallic(0.0)
    actor.GetProperty().SetRoughness(0.4)
    hdr = vtk.vtkHDRReader()
    hdr.SetFileName(args.env)
    texture = vtk.vtkTexture()
    texture.SetInputConnection(hdr.GetOutputPort())
    texture.SetColorModeToDirectScalars()
    texture.MipmapOn()
    texture.InterpolateOn()
    renderer.SetEnvironmentTexture(texture)
    renderer.UseImageBasedLightingOn()
    skybox = vtk.vtkSkybox()
    skybox.SetTexture(texture)
    skybox.SetProjectionToSphere()
    skybox.GammaCorrectOn()
    renderer.AddActor(skybox)

window = vtk.vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(width, height)
window.SetMultiSamples(0)
window.AddRenderer(renderer)
renderer.ResetCamera()
if args.mode == "full":
    bounds = renderer.ComputeVisiblePropBounds()
    diagonal = math.sqrt(sum((bounds[2 * i + 1] - bounds[2 * i]) ** 2 for i in range(3)))
    ssao = vtk.vtkSSAOPass()
    ssao.SetRadius(0.05 * diagonal)
    ssao.SetBias(0.0005 * diagonal)
    ssao.SetKernelSize(32)
    ssao.BlurOn()
    ssao.SetDelegatePass(vtk.vtkRenderStepsPass())
    tone = vtk.vtkToneMappingPass()
    tone.SetDelegatePass(ssao)
    renderer.SetPass(tone)


def finish():
    window.Render()
    window.GetRGBACharPixelData(0, 0, 1, 1, 0, vtk.vtkUnsignedCharArray())


finish()
t3 = time.perf_counter()
times = []
for _ in range(args.frames):
    renderer.GetActiveCamera().Azimuth(3)
    start = time.perf_counter()
    finish()
    times.append(1e3 * (time.perf_counter() - start))
times.sort()
print(json.dumps({
    "tool": "VTK " + vtk.vtkVersion.GetVTKVersion(), "mode": args.mode, "mesh": args.mesh, "size": args.size,
    "load_s": round(t1 - t0, 3), "normals_s": round(t2 - t1, 3), "first_frame_s": round(t3 - t2, 3),
    "frame_ms_median": round(times[len(times) // 2], 1), "frame_ms_min": round(times[0], 1)}))
if args.out:
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(f"{args.out}_{args.mode}.png")
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
