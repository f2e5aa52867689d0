"""The pictures of bench/light_peers.py that VTK 9.7 draws, in the environment of scripts/peers.sh. usage: light_vtk.py FOLDER

Physically based shading, image-based lighting and screen-space ambient occlusion. Lamps are spot lights towards the scene, which have
shadow maps in VTK where point lights have none; emissive meshes are spot lights with the cosine of a diffuse emitter. What rooms get
besides is an ambient light. Glass is translucent, blended in order of depth: VTK refracts no light in surfaces.
"""
import itertools
import pathlib
import sys

import light_scenes
import numpy as np
import vtk
from vtkmodules.util import numpy_support

SUPERSAMPLING = 4
SIZE = (SUPERSAMPLING * light_scenes.SIZE[0], SUPERSAMPLING * light_scenes.SIZE[1])
#: From the axis, degrees, of lamps and of the lights that stand for emissive meshes. Wider ones have coarser shadow maps.
LAMP_ANGLE, EMITTER_ANGLE = 75.0, 80.0


def poly_data(shape):
    """Of flat faces: corners and normals of their own."""
    corners, normals = light_scenes.flat(shape)
    data = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetData(numpy_support.numpy_to_vtk(corners, deep=True))
    data.SetPoints(points)
    ends = numpy_support.numpy_to_vtk(np.arange(0, len(corners) + 1, 3), deep=True, array_type=vtk.VTK_ID_TYPE)
    indices = numpy_support.numpy_to_vtk(np.arange(len(corners)), deep=True, array_type=vtk.VTK_ID_TYPE)
    cells = vtk.vtkCellArray()
    cells.SetData(ends, indices)
    data.SetPolys(cells)
    data.GetPointData().SetNormals(numpy_support.numpy_to_vtk(normals, deep=True))
    return data


def actor_of(shape, matt, opacity):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(poly_data(shape))
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    material = actor.GetProperty()
    if shape.emission:
        material.SetAmbient(1)  # white, and lit: the shadow pass draws nothing that is not
        material.SetDiffuse(0)
        return actor
    material.SetInterpolationToPBR()
    material.SetColor(*shape.color)  # linear
    material.SetMetallic(float(shape.kind == light_scenes.CONDUCTOR))
    material.SetRoughness(shape.roughness)
    material.SetBaseIOR(1.0 if matt else 1.5)
    if shape.kind == light_scenes.GLASS:
        material.SetOpacity(opacity)
    return actor


def texture_of(sky):
    height, width, _ = sky.shape
    image = vtk.vtkImageData()
    image.SetDimensions(width, height, 1)
    # u is 0.5 at +x and grows towards +z.
    pixels = np.roll(sky, -width // 4, axis=1)[::-1].reshape(-1, 3)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(np.ascontiguousarray(pixels, np.float32), deep=True))
    texture = vtk.vtkTexture()
    texture.SetInputDataObject(image)
    texture.SetColorModeToDirectScalars()
    texture.MipmapOn()
    texture.InterpolateOn()
    return texture


def add_light(renderer, position, target, intensity, angle, exponent):
    """A spot light; the intensity is that of its axis."""
    light = vtk.vtkLight()
    light.SetLightTypeToSceneLight()
    light.PositionalOn()
    light.SetPosition(*position)
    light.SetFocalPoint(*target)
    light.SetConeAngle(angle)
    light.SetExponent(exponent)
    light.SetAttenuationValues(0, 0, 1)
    light.SetIntensity(intensity)
    light.SetColor(1, 1, 1)
    renderer.AddLight(light)


def add_lights(renderer, setup):
    for position, intensity in setup.lamps:
        add_light(renderer, position, setup.target, intensity * setup.exposure, LAMP_ANGLE, 0)
    for position, direction, intensity in light_scenes.spots(setup):
        add_light(renderer, position, position + direction, intensity * setup.exposure, EMITTER_ANGLE, 1)


def passes_of(setup, occlusion, shadows):
    """Steps of a frame, or None for those by default."""
    made = vtk.vtkRenderStepsPass()
    if shadows:
        baker, mapped = vtk.vtkShadowMapBakerPass(), vtk.vtkShadowMapPass()
        opaque, sequence = vtk.vtkSequencePass(), vtk.vtkSequencePass()
        inner = vtk.vtkRenderPassCollection()
        for step in (vtk.vtkLightsPass(), vtk.vtkOpaquePass()):
            inner.AddItem(step)
        opaque.SetPasses(inner)
        camera = vtk.vtkCameraPass()
        camera.SetDelegatePass(opaque)
        baker.SetOpaqueSequence(camera)
        baker.SetResolution(2048)
        baker.SetExponentialConstant(5)  # of 11, the default, light surfaces are darker
        mapped.SetShadowMapBakerPass(baker)
        mapped.SetOpaqueSequence(opaque)
        steps = vtk.vtkRenderPassCollection()
        for step in (baker, mapped, vtk.vtkTranslucentPass()):
            steps.AddItem(step)
        sequence.SetPasses(steps)
        made = vtk.vtkCameraPass()
        made.SetDelegatePass(sequence)
    if occlusion:
        ssao = vtk.vtkSSAOPass()
        ssao.SetRadius(0.25 * setup.half_height)
        ssao.SetBias(0.0025 * setup.half_height)
        ssao.SetKernelSize(128)
        ssao.BlurOn()
        ssao.SetDelegatePass(made)
        made = ssao
    return made


def draw(setup, occlusion=False, shadows=False, ambient=0.0, opacity=light_scenes.OPACITIES[0]):
    renderer = vtk.vtkRenderer()
    renderer.AutomaticLightCreationOff()
    renderer.SetBackground(0, 0, 0)
    matt = setup.matt
    for shape in setup.shapes:
        renderer.AddActor(actor_of(shape, matt, opacity))
    sky = setup.sky if setup.sky is not None else np.full((64, 128, 3), ambient, np.float32) if ambient else None
    if sky is not None:
        renderer.SetEnvironmentTexture(texture_of(sky * setup.exposure))
        renderer.UseImageBasedLightingOn()
        renderer.GetEnvMapLookupTable().SetLUTSize(128)  # smooth, and slow to make
        if setup.sky is None:
            renderer.GetEnvMapPrefiltered().SetPrefilterMaxSamples(1)  # of what is the same everywhere
    add_lights(renderer, setup)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*setup.position)
    camera.SetFocalPoint(*setup.target)
    camera.SetViewUp(0, 1, 0)
    camera.SetViewAngle(setup.fov_y_deg)
    renderer.ResetCameraClippingRange()
    renderer.SetUseDepthPeeling(True)
    if occlusion or shadows:
        renderer.SetPass(passes_of(setup, occlusion, shadows))
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetAlphaBitPlanes(1)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    pixels = numpy_support.vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())
    pixels = pixels.reshape(SIZE[1], SIZE[0], -1)[::-1, :, :3]
    # Its shaders take the root of 2.2.
    return light_scenes.averaged((pixels / 255.0) ** 2.2, SUPERSAMPLING)


def draw_all(setup):
    lit = bool(setup.lamps or setup.shows_emitters)
    return {f"occlusion {occlusion}, shadows {shadows}, ambient {ambient}, opacity {opacity}":
            draw(setup, occlusion, shadows, ambient, opacity) for occlusion, shadows, ambient, opacity in itertools.product(
                (False, True), (False, True) if lit else (False,), light_scenes.ambient_of(setup), light_scenes.opacities_of(setup))}


def main():
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_OFF)
    light_scenes.draw_each(pathlib.Path(sys.argv[1]), "vtk", draw_all)


if __name__ == "__main__":
    main()
