"""A mesh in the browser as others show it: VTK draws on the server and trame or viser brings the pictures. Prints its address, then
`drawn SECONDS` (since the epoch) at the end of each drawing. Run by remote_peers.py, in an environment of its own.

usage: remote_peer.py trame|viser MESH.ply PORT WIDTHxHEIGHT
"""
import sys
import threading
import time

import vtk


def drawn() -> None:
    print(f"drawn {time.time():.6f}", flush=True)


def window_of(path: str, size: tuple[int, int]) -> "vtk.vtkRenderWindow":
    reader = vtk.vtkPLYReader()
    reader.SetFileName(path)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(reader.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    renderer = vtk.vtkRenderer()
    renderer.AddActor(actor)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    renderer.ResetCamera()
    return window


def serve_trame(path: str, port: int, size: tuple[int, int]) -> None:
    from trame.app import get_server
    from trame.ui.html import DivLayout
    from trame.widgets import vtk as widgets

    server = get_server(client_type="vue3")
    window = window_of(path, size)
    interactor = vtk.vtkRenderWindowInteractor()
    interactor.SetRenderWindow(window)
    interactor.SetInteractorStyle(vtk.vtkInteractorStyleTrackballCamera())
    window.AddObserver("EndEvent", lambda *_: drawn())
    with DivLayout(server) as layout:
        layout.root.style = "position: fixed; inset: 0"
        widgets.VtkRemoteView(window, interactive_ratio=1, still_ratio=1)
    print(f"http://127.0.0.1:{port}/", flush=True)
    server.start(port=port, host="127.0.0.1", open_browser=False, show_connection_info=False, timeout=0)


def serve_viser(path: str, port: int, size: tuple[int, int]) -> None:
    """As nerfview does it: the newest camera is drawn, the picture becomes the background of the client's scene."""
    import viser
    from vtk.util.numpy_support import vtk_to_numpy

    server = viser.ViserServer(host="127.0.0.1", port=port, verbose=False)
    server.scene.world_axes.visible = False
    wanted: list[viser.CameraHandle] = []
    there = threading.Condition()

    @server.on_client_connect
    def _(client: viser.ClientHandle) -> None:
        @client.camera.on_update
        def _(camera: viser.CameraHandle) -> None:
            with there:
                wanted[:] = [camera]
                there.notify()

    print(f"http://127.0.0.1:{port}/", flush=True)
    window = window_of(path, size)
    camera = window.GetRenderers().GetFirstRenderer().GetActiveCamera()
    bounds = window.GetRenderers().GetFirstRenderer().ComputeVisiblePropBounds()
    middle = [(bounds[2 * k] + bounds[2 * k + 1]) / 2 for k in range(3)]
    radius = max(bounds[2 * k + 1] - bounds[2 * k] for k in range(3))
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    while True:
        with there:
            there.wait_for(lambda: wanted)
            seen = wanted.pop()
        # viser's scene is some units wide: the mesh is brought to its middle.
        camera.SetPosition(*(middle[k] + radius / 2 * float(seen.position[k]) for k in range(3)))
        camera.SetFocalPoint(*(middle[k] + radius / 2 * float(seen.look_at[k]) for k in range(3)))
        camera.SetViewUp(*(float(x) for x in seen.up_direction))
        window.GetRenderers().GetFirstRenderer().ResetCameraClippingRange()
        window.Render()
        grab.Modified()
        grab.Update()
        image = grab.GetOutput()
        width, height, _ = image.GetDimensions()
        pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1]
        drawn()
        seen.client.scene.set_background_image(pixels, format="jpeg", jpeg_quality=75)


if __name__ == "__main__":
    name, mesh, port, size = sys.argv[1:]
    width, height = map(int, size.split("x"))
    {"trame": serve_trame, "viser": serve_viser}[name](mesh, int(port), (width, height))
