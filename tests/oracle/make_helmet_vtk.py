#!/usr/bin/python3
"""Draws the scene of make_helmet.py with VTK 9 (Debian's python3-vtk9), for test_helmet.py to compare with:

    xvfb-run -a /usr/bin/python3 tests/oracle/make_helmet_vtk.py --data FOLDER --exposure E

The same helmet, ground, sky and camera; E is the exposure that test_helmet.py fixes by the reference (printed by its
failures, and kept in helmet_vtk.json). VTK has no exposure without a tone curve, so the sky's and the glow's light is
multiplied by it. Environments cast no shadows in VTK: its screen-space ambient occlusion is on, with the radius that is best
of 0.05, 0.1, 0.2, 0.4 and 0.8 of the ground's side. helmet_vtk.png and helmet_vtk.json beside this file are committed.
"""
import argparse
import json
import os
import pathlib
import tempfile

import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from file_hash import hash_of

HERE = pathlib.Path(__file__).resolve().parent
SCENE = json.loads((HERE / "helmet.json").read_text())


def sky(path, exposure):
    # The file says EXPOSURE=0, which VTK's reader divides by: it gets a copy with another header.
    with tempfile.NamedTemporaryFile(suffix=".hdr") as copy:
        copy.write(path.read_bytes().replace(b"EXPOSURE=0\n", b"EXPOSURE=1\n", 1))
        copy.flush()
        reader = vtk.vtkHDRReader()
        reader.SetFileName(copy.name)
        reader.Update()
    image = reader.GetOutput()
    scaled = numpy_to_vtk(vtk_to_numpy(image.GetPointData().GetScalars()) * exposure, deep=True)
    image.GetPointData().SetScalars(scaled)
    texture = vtk.vtkTexture()
    texture.SetInputData(image)
    texture.SetColorModeToDirectScalars()
    texture.MipmapOn()
    texture.InterpolateOn()
    return texture


def ground(about):
    plane = vtk.vtkPlaneSource()
    half, y = about["size"] / 2, about["height"]
    plane.SetOrigin(-half, y, half)
    plane.SetPoint1(half, y, half)
    plane.SetPoint2(-half, y, -half)
    plane.SetResolution(64, 64)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(plane.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    surface = actor.GetProperty()
    surface.SetInterpolationToPBR()
    surface.SetColor(3 * [about["reflectance"]])
    surface.SetMetallic(0)
    surface.SetRoughness(1)
    return actor


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    folder = os.environ.get("EASYPBR_TEST_DATA")
    parser.add_argument("--data", type=pathlib.Path, default=folder, required=not folder)
    parser.add_argument("--exposure", type=float, required=True)
    parser.add_argument("--output", type=pathlib.Path, default=HERE)
    chosen = parser.parse_args()
    data = pathlib.Path(chosen.data)

    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(*SCENE["size"])
    window.SetMultiSamples(8)
    importer = vtk.vtkGLTFImporter()
    importer.SetFileName(str(data / SCENE["mesh"]))
    importer.SetRenderWindow(window)
    importer.Update()
    renderer = window.GetRenderers().GetFirstRenderer()
    renderer.RemoveAllLights()
    renderer.AutomaticLightCreationOff()
    dark = vtk.vtkLight()  # Without any light VTK shades nothing, not even by the sky.
    dark.SetIntensity(0)
    renderer.AddLight(dark)
    actors = renderer.GetActors()
    actors.InitTraversal()
    for _ in range(actors.GetNumberOfItems()):
        surface = actors.GetNextActor().GetProperty()
        surface.SetEmissiveFactor(3 * [chosen.exposure])
    renderer.AddActor(ground(SCENE["ground"]))
    renderer.UseImageBasedLightingOn()
    renderer.SetEnvironmentTexture(sky(data / SCENE["environment"], chosen.exposure))
    renderer.SetEnvironmentRight(0, 0, -1)  # the picture's middle
    renderer.SetBackground(0, 0, 0)
    camera = vtk.vtkCamera()
    camera.SetPosition(SCENE["camera"]["position"])
    camera.SetFocalPoint(SCENE["camera"]["target"])
    camera.SetViewUp(0, 1, 0)
    camera.SetViewAngle(SCENE["camera"]["fov_y_deg"])
    renderer.SetActiveCamera(camera)
    renderer.ResetCameraClippingRange()
    ssao = vtk.vtkSSAOPass()
    ssao.SetRadius(0.05 * SCENE["ground"]["size"])
    ssao.SetBias(0.001 * SCENE["ground"]["size"])
    ssao.SetKernelSize(64)
    ssao.BlurOn()
    ssao.SetDelegatePass(vtk.vtkRenderStepsPass())
    renderer.SetPass(ssao)
    window.Render()

    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    path = chosen.output / "helmet_vtk.png"
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
    about = {"vtk": vtk.vtkVersion.GetVTKVersion(), "exposure": chosen.exposure,
             "sha256": hash_of(path)}
    (chosen.output / "helmet_vtk.json").write_text(json.dumps(about, indent=1) + "\n")


if __name__ == "__main__":
    main()
