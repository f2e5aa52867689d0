"""PyVista and VTK itself: https://docs.pyvista.org/api/core and https://vtk.org/doc/nightly/html/classvtkDataObject.html.

VTK is imported here only for objects that it made.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._easypbr import Mesh
from ..errors import ArgumentError
from .maker import Maker, colors, rows, separate_corners, triangles

#: An array of more values for each point or cell is not taken apart into scalars.
_MOST_COMPONENTS = 16
_COLOR_NAMES = ("rgb", "rgba", "colors", "colours")
#: What VTK and PyVista keep beside the data.
_OWN_NAMES = ("Normals", "Texture Coordinates", "vtkOriginalPointIds", "vtkOriginalCellIds", "vtkGhostType")


def is_vtk(what: Any) -> bool:
    return hasattr(what, "GetClassName") and hasattr(what, "IsA") and bool(what.IsA("vtkDataObject"))


def of_vtk(what: Any, make: Maker) -> Mesh:
    if what.IsA("vtkCompositeDataSet") or what.IsA("vtkDataObjectTree"):
        return _of_blocks(what, make)
    if not what.IsA("vtkDataSet"):
        raise ArgumentError(f"a {what.GetClassName()}: expected a data set with points, or blocks of them")
    active = _active(what)
    if what.IsA("vtkImageData") or what.IsA("vtkRectilinearGrid"):
        what = _of_volume(what, active, make)
    if what.IsA("vtkPolyData"):
        return _of_polydata(what, active, make)
    if what.GetNumberOfCells() == 0:
        return _cloud(what, active, make)
    return _of_polydata(_surface(what), active, make)


def _of_blocks(what: Any, make: Maker) -> Mesh:
    children, empty = [], 0
    for name, block in _blocks(what):
        if block is None or (hasattr(block, "GetNumberOfPoints") and block.GetNumberOfPoints() == 0):
            empty += 1
            continue
        child = make.any(block)
        child.name = name
        children.append(child)
    if not children:
        raise ArgumentError(f"a {what.GetClassName()} with {empty} blocks: expected points, got none")
    if empty:
        make.leave_out(f"{empty} blocks without points of a {what.GetClassName()}")
    return make.parts(children)


def _blocks(what: Any) -> list[tuple[str, Any]]:
    """Name and data of each block."""
    if hasattr(what, "GetNumberOfBlocks"):
        found = [(what.GetBlock(i), what.GetMetaData(i) if what.HasMetaData(i) else None) for i in range(what.GetNumberOfBlocks())]
    elif hasattr(what, "GetPartitionedDataSet"):
        numbers = range(what.GetNumberOfPartitionedDataSets())
        found = [(what.GetPartitionedDataSet(i), what.GetMetaData(i) if what.HasMetaData(i) else None) for i in numbers]
    else:
        found = [(what.GetPartition(i), None) for i in range(what.GetNumberOfPartitions())]
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet

    key = vtkCompositeDataSet.NAME()
    return [((about.Get(key) if about is not None and about.Has(key) else None) or f"block {i}", block)
            for i, (block, about) in enumerate(found)]


def _active(what: Any) -> tuple[str, str] | None:
    """The array that the data set is coloured by: ("point" or "cell", name)."""
    info = getattr(what, "active_scalars_info", None)
    if info is not None and info.name is not None:  # PyVista
        where = "cell" if "CELL" in str(info.association).upper() else "point"
        return where, str(info.name)
    for where, data in (("point", what.GetPointData()), ("cell", what.GetCellData())):
        if data.GetScalars() is not None and data.GetScalars().GetName():
            return where, data.GetScalars().GetName()
    return None


def _output(name: str, what: Any, **options: Any) -> Any:
    """What a filter of VTK makes of a data set."""
    from vtkmodules import vtkFiltersCore, vtkFiltersGeometry

    module = vtkFiltersGeometry if hasattr(vtkFiltersGeometry, name) else vtkFiltersCore
    made = getattr(module, name)()
    made.SetInputDataObject(what)
    for option, value in options.items():
        getattr(made, option)(value)
    made.Update()
    return made.GetOutput()


def _triangles(what: Any) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any] | None]:
    """m x 3 vertex indices of the polygons and strips, the number of each one's polygon or strip, and that of its polygon,
    where the triangles of a strip are polygons of their own; None: all are."""
    polys = _cells(what.GetPolys())
    if what.GetNumberOfStrips() == 0 and all(len(cell) == 3 for cell in polys):
        return np.array(polys, dtype=np.int64).reshape(-1, 3), np.arange(len(polys)), None
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    # Of cells of several kinds the filter mixes up the data.
    alone = vtkPolyData()
    alone.SetPoints(what.GetPoints())
    alone.SetPolys(what.GetPolys())
    alone.SetStrips(what.GetStrips())
    number = numpy_to_vtkIdTypeArray(np.arange(alone.GetNumberOfCells(), dtype=np.int64), deep=True)
    number.SetName("number")
    alone.GetCellData().AddArray(number)
    made = _output("vtkTriangleFilter", alone)
    F = np.array(_cells(made.GetPolys()), dtype=np.int64).reshape(-1, 3)
    cells = _numpy(made.GetCellData().GetArray("number"))
    return F, cells, np.where(cells < len(polys), cells, len(polys) + np.arange(len(F)))


def _surface(what: Any) -> Any:
    return _output("vtkGeometryFilter", what)


def _of_volume(what: Any, active: tuple[str, str] | None, make: Maker) -> Any:
    """A flat grid as it is; of a volume the three slices through its middle."""
    if active is None:
        make.leave_out(f"nothing shows the inside of this {what.GetClassName()}: it has no values, its surface is drawn")
        return _surface(what)
    low, high = np.reshape(what.GetBounds(), (3, 2)).T
    if (high - low).min() <= 0:
        return _surface(what)
    from vtkmodules.vtkCommonDataModel import vtkPlane
    from vtkmodules.vtkFiltersCore import vtkAppendPolyData

    joined = vtkAppendPolyData()
    for axis in range(3):
        plane = vtkPlane()
        plane.SetOrigin(*((low + high) / 2))
        plane.SetNormal(*np.eye(3)[axis])
        joined.AddInputData(_output("vtkCutter", what, SetCutFunction=plane))
    joined.Update()
    return joined.GetOutput()


def _numpy(array: Any) -> NDArray[Any]:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    return np.asarray(vtk_to_numpy(array))


def _points(what: Any) -> NDArray[Any]:
    if hasattr(what, "GetPoints") and what.GetPoints() is not None and hasattr(what.GetPoints(), "GetData"):
        return _numpy(what.GetPoints().GetData())
    return np.array([what.GetPoint(i) for i in range(what.GetNumberOfPoints())])


def _cells(array: Any) -> list[NDArray[Any]]:
    """Vertex indices of each cell."""
    if array is None or array.GetNumberOfCells() == 0:
        return []
    offsets, indices = _numpy(array.GetOffsetsArray()), _numpy(array.GetConnectivityArray())
    return np.split(indices, offsets[1:-1])


class _Fields:
    """Colours and scalars of points or cells."""

    def __init__(self, data: Any, where: str, active: tuple[str, str] | None, make: Maker) -> None:
        self.color: NDArray[Any] | None = None
        self.scalars: dict[str, NDArray[Any]] = {}
        self.shown = active[1] if active is not None and active[0] == where else None
        self._make = make
        attributes = data.GetNormals(), data.GetTCoords()
        own = {*_OWN_NAMES, *(array.GetName() for array in attributes if array is not None)} - {self.shown}
        for i in range(data.GetNumberOfArrays()):
            # Of texts and other objects there is only an abstract array.
            array, name = data.GetArray(i), data.GetAbstractArray(i).GetName() or f"array_{i}"
            if array is None:
                make.leave_out(f"the array '{name}', which holds no numbers")
            elif name not in own:
                self._take(name, _numpy(array))

    def _take(self, name: str, values: NDArray[Any]) -> None:
        is_shown = name == self.shown
        wide = values.ndim == 2 and values.shape[1] > 1
        if values.dtype.kind not in "biuf":
            self._make.leave_out(f"the array '{name}' of {values.dtype}")
        elif not wide:
            self.scalars[name] = values.reshape(-1)
        elif values.shape[1] in (3, 4) and (
            name.lower() in _COLOR_NAMES or is_shown and values.dtype == np.uint8
        ):
            self.color = colors(values, len(values))
            self.shown = None if is_shown else self.shown
        elif values.shape[1] > _MOST_COMPONENTS:
            self._make.leave_out(f"the array '{name}' of {values.shape[1]} values, more than {_MOST_COMPONENTS}")
        else:
            if is_shown:  # As PyVista colours by vectors.
                self.scalars[name] = np.linalg.norm(values, axis=1)
            self.scalars.update({f"{name}_{i}": values[:, i] for i in range(values.shape[1])})

    def of(self, chosen: Any) -> dict[str, NDArray[Any]]:
        return {name: values[chosen] for name, values in self.scalars.items()}


def _finish(mesh: Mesh, fields: tuple[_Fields, ...], make: Maker) -> Mesh:
    """Active scalars colour the mesh, others only when asked for."""
    mesh._keep_scalars_aside()
    for field in fields:
        if field.shown is not None and field.shown in mesh.scalars:
            make.show_scalars(mesh, field.shown)
    return mesh


def _cloud(what: Any, active: tuple[str, str] | None, make: Maker) -> Mesh:
    fields = _Fields(what.GetPointData(), "point", active, make)
    N = what.GetPointData().GetNormals()
    mesh = make.mesh(V=_points(what), N=None if N is None else _numpy(N), C=fields.color, scalars=fields.scalars)
    return _finish(mesh, (fields,), make)


def _of_polydata(what: Any, active: tuple[str, str] | None, make: Maker) -> Mesh:
    """Triangles, lines and vertices; what has several of them has a child for each."""
    points = _points(what)
    if len(points) == 0:
        raise ArgumentError(f"a {what.GetClassName()}: expected points, got none")
    verts, lines = _cells(what.GetVerts()), _cells(what.GetLines())
    if what.GetNumberOfCells() == 0:
        return _cloud(what, active, make)
    F, cell_of_F, polygon_of_F = _triangles(what)
    on_points = _Fields(what.GetPointData(), "point", active, make)
    on_cells = _Fields(what.GetCellData(), "cell", active, make)
    parts = _Parts(what, points, on_points, on_cells, make)
    first = len(verts)
    children = []
    if len(F):
        children.append(parts.triangles(F, first + len(lines) + cell_of_F, polygon_of_F))
    if lines:
        children.append(parts.lines(lines, slice(first, first + len(lines))))
    if verts:
        children.append(parts.points(verts, slice(0, first)))
    return make.parts(children)


class _Parts:
    """The meshes of one vtkPolyData."""

    def __init__(self, what: Any, points: NDArray[Any], on_points: _Fields, on_cells: _Fields, make: Maker) -> None:
        data, count = what.GetPointData(), len(points)
        self._points, self._on_points, self._on_cells, self._make = points, on_points, on_cells, make
        self._N = None if data.GetNormals() is None else rows(_numpy(data.GetNormals()), count)
        self._UV = None if data.GetTCoords() is None else rows(_numpy(data.GetTCoords())[:, :2], count)

    def triangles(self, F: NDArray[Any], cells: NDArray[Any], polygons: NDArray[Any] | None) -> Mesh:
        C = self._on_points.color
        values = self._on_cells.of(cells)
        cell_color = self._on_cells.color[cells] if self._on_cells.color is not None and C is None else None
        # As many faces as vertices would make values of faces those of vertices.
        if cell_color is not None or (values and len(F) == len(self._points)):
            return self._separate(F, polygons, values, cell_color)
        scalars = self._on_points.scalars | values
        mesh = self._make.mesh(V=self._points, F=F, source_face=polygons, N=self._N, UV=self._UV, C=C, scalars=scalars)
        return self._finished(mesh)

    def _separate(
        self, F: NDArray[Any], polygons: NDArray[Any] | None, values: dict[str, NDArray[Any]], cell_color: NDArray[Any] | None
    ) -> Mesh:
        """Each corner of a polygon a vertex of its own, with what belongs to its cell."""
        owner = np.arange(len(F)) if polygons is None else polygons
        _, first, split = np.unique(owner[:, None] * len(self._points) + F, return_index=True, return_inverse=True)
        corners, cell = F.ravel()[first], first // F.shape[1]
        C = self._on_points.color
        mesh = self._make.mesh(
            V=self._points[corners],
            F=split.reshape(F.shape),
            source_face=polygons,
            N=None if self._N is None else self._N[corners],
            UV=None if self._UV is None else self._UV[corners],
            C=cell_color[cell] if cell_color is not None else None if C is None else C[corners],
            scalars=self._on_points.of(corners) | {name: array[cell] for name, array in values.items()},
        )
        return self._finished(mesh)

    def lines(self, lines: list[NDArray[Any]], cells: slice) -> Mesh:
        E = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
        cell = np.repeat(np.arange(len(lines)), [len(line) - 1 for line in lines])
        values = self._on_cells.of(cells)
        on_cells = self._on_cells.color
        if not values and (on_cells is None or self._on_points.color is not None):
            V, C, scalars = self._points, self._on_points.color, self._on_points.scalars
        else:  # Values of lines need ends of their own.
            corners, E, cell = separate_corners(E, cell)
            V, C = self._points[corners], self._on_points.color
            C = C[corners] if C is not None else None if on_cells is None else on_cells[cells][cell]
            scalars = self._on_points.of(corners) | {name: array[cell] for name, array in values.items()}
        return self._finished(self._make.mesh(V=V, E=E, C=C, scalars=scalars))

    def points(self, verts: list[NDArray[Any]], cells: slice) -> Mesh:
        chosen = np.concatenate(verts)
        cell = np.repeat(np.arange(len(verts)), [len(vert) for vert in verts])
        on_cells = self._on_cells.color
        C = self._on_points.color
        mesh = self._make.mesh(
            V=self._points[chosen],
            N=None if self._N is None else self._N[chosen],
            C=C[chosen] if C is not None else None if on_cells is None else on_cells[cells][cell],
            scalars=self._on_points.of(chosen) | {name: array[cell] for name, array in self._on_cells.of(cells).items()},
        )
        return self._finished(mesh)

    def _finished(self, mesh: Mesh) -> Mesh:
        return _finish(mesh, (self._on_points, self._on_cells), self._make)


# What has PyVista's attributes and is no object of VTK.


def is_like_pyvista(what: Any) -> bool:
    return hasattr(what, "points") and hasattr(what, "point_data") and hasattr(what, "n_points")


def _polygons(faces: NDArray[Any]) -> Any:
    """Vertex indices of each polygon, from a list of its number of corners and its corners."""
    if len(faces) and len(faces) % (faces[0] + 1) == 0:
        rows_of_faces = faces.reshape(-1, faces[0] + 1)
        if (rows_of_faces[:, 0] == faces[0]).all():
            return rows_of_faces[:, 1:]
    found, at = [], 0
    while at < len(faces):
        found.append(faces[at + 1 : at + 1 + faces[at]])
        at += 1 + int(faces[at])
    return found or None


def of_like_pyvista(what: Any, make: Maker) -> Mesh:
    # Only surfaces have faces.
    if not hasattr(what, "is_all_triangles"):
        what = what.extract_surface()
    F, polygon_of_F = triangles(_polygons(np.asarray(what.faces)), what.points)
    data, count = what.point_data, what.n_points
    return make.mesh(
        V=what.points,
        F=F,
        source_face=polygon_of_F,
        N=rows(data["Normals"] if "Normals" in data else None, count),
        C=rows(data["RGB"] if "RGB" in data else None, count),
        UV=rows(getattr(what, "active_texture_coordinates", None), count),
    )


CONVERSIONS = [(is_vtk, of_vtk), (is_like_pyvista, of_like_pyvista)]
