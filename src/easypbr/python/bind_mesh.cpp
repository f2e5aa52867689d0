// Mesh: arrays as read-only views that own their numbers.
#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/own_process.h"
#include "easypbr/core/suggest.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_queue.h"
#include "easypbr/io/tables/polygons.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/handles.h"
#include "easypbr/python/mesh_fields.h"
#include "easypbr/python/mesh_pose.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

/// A queue of meshes, for the process that made it.
class OwnQueue {
  public:
    OwnQueue(std::vector<fs::path> paths, int workers, int prefetch)
        : queue_(new io::MeshQueue(std::move(paths), workers, prefetch)) {}
    /// Throws Error in a forked child.
    io::MeshQueue& get() const {
        if (!queue_.get_deleter().process.is_this())
            throw Error(
                "the files are read ahead in the process that this one was forked from: iterate over the "
                "MeshLoader anew");
        return *queue_;
    }

  private:
    std::unique_ptr<io::MeshQueue, DeleteInOwnProcess> queue_;
};

/// One of a mesh's arrays: how Python reads it and writes it.
struct MeshArray {
    const char* name;
    const char* doc;
    nb::object (*view)(const MeshData&);
    /// Reads the object (with the GIL) into a change of the data (made without it).
    std::function<void(MeshData&)> (*prepare)(nb::handle object);
};

template <class Scalar, int Cols, Array<Scalar, Cols> MeshData::*member>
std::function<void(MeshData&)> prepare(nb::handle object, const ArrayShape& shape) {
    Array<Scalar, Cols> array;
    if (!object.is_none()) array = to_array<Scalar, Cols>(object, shape);
    return [array](MeshData& data) { data.*member = array; };
}

std::function<void(MeshData&)> prepare_colors(nb::handle object) {
    ArrayXf C;
    if (!object.is_none()) C = to_colors(object, {"C", 3, 4});
    return [C](MeshData& data) { data.C = C; };
}

/// The same for what makes vertices splats.
template <int Cols, Array<float, Cols> SplatArrays::*member>
MeshChange prepare_splats(nb::handle object, const ArrayShape& shape) {
    Array<float, Cols> array;
    if (!object.is_none()) array = to_array<float, Cols>(object, shape);
    return [array](MeshData& data) { data.splats.*member = array; };
}

/// Harmonics may be n x (degree + 1)^2 x 3 too, as gsplat has them.
MeshChange prepare_sh(nb::handle object) {
    if (object.is_none()) return prepare_splats<Eigen::Dynamic, &SplatArrays::sh>(object, {"sh", 3, 48});
    const nb::object rows = numeric_object(nb::borrow(object), "mesh array sh");
    const size_t count = nb::len(rows);
    const nb::object flat = count ? rows.attr("reshape")(count, -1) : rows;
    const int columns = count ? nb::cast<int>(flat.attr("shape")[nb::int_(1)]) : 3;
    const bool is_known = columns == 3 || columns == 12 || columns == 27;
    return prepare_splats<Eigen::Dynamic, &SplatArrays::sh>(flat, {"sh", is_known ? columns : 3, 48});
}

template <int Cols, Array<float, Cols> SplatArrays::*member>
nb::object view_splats(const MeshData& data) {
    return view_of(data.splats.*member);
}

template <class Scalar, int Cols, Array<Scalar, Cols> MeshData::*member>
nb::object view(const MeshData& data) {
    return view_of(data.*member);
}

/// What is subtracted from positions far from zero is added to the offset: offset + V does not move.
std::function<void(MeshData&)> prepare_V(nb::handle object) {
    LocalPositions positions;
    if (!object.is_none()) positions = to_positions(object, {"V", 3, 3});
    return [positions](MeshData& data) {
        if (data.V.rows() != positions.V.rows()) data.source_vertex = {};
        data.V = positions.V;
        data.offset += positions.offset;
    };
}

std::function<void(MeshData&)> prepare_F(nb::handle object) {
    const auto assign = prepare<int32_t, 3, &MeshData::F>(object, {"F", 3, 3});
    return [assign](MeshData& data) {
        assign(data);
        data.parts.clear();
        data.source_face = {};
    };
}

const std::vector<MeshArray>& mesh_arrays() {
    static const std::vector<MeshArray> arrays = {
        {"V",
         "n x 3 float32 positions, local: offset + V are the coordinates given. A float64 array far from "
         "zero, as of UTM coordinates, is recentred when assigned: what is subtracted from it is added to "
         "the offset.",
         view<float, 3, &MeshData::V>, prepare_V},
        {"N", "n x 3 float32 unit normals; empty: computed when the mesh is drawn.",
         view<float, 3, &MeshData::N>,
         [](nb::handle o) {
             return prepare<float, 3, &MeshData::N>(o, {"N", 3, 3});
         }},
        {"C",
         "n x 3 or n x 4 float32 sRGB colours, 0 to 1. When assigned, uint8 and uint16 span their range; "
         "others are 0 to 1 if none is above 1, else 0 to 255, and what is neither is refused.",
         view<float, Eigen::Dynamic, &MeshData::C>, prepare_colors},
        {"UV", "n x 2 float32 texture coordinates, v upwards.", view<float, 2, &MeshData::UV>,
         [](nb::handle o) {
             return prepare<float, 2, &MeshData::UV>(o, {"UV", 2, 2});
         }},
        {"T", "n x 3 float32 tangents of surfels.", view<float, 3, &MeshData::T>,
         [](nb::handle o) {
             return prepare<float, 3, &MeshData::T>(o, {"T", 3, 3});
         }},
        {"B", "n float32 bitangent lengths of surfels.", view<float, 1, &MeshData::B>,
         [](nb::handle o) {
             return prepare<float, 1, &MeshData::B>(o, {"B", 1, 1});
         }},
        {"F", "m x 3 int32 vertex indices of triangles, counter-clockwise seen from outside.",
         view<int32_t, 3, &MeshData::F>, prepare_F},
        {"E", "k x 2 int32 vertex indices of line segments.", view<int32_t, 2, &MeshData::E>,
         [](nb::handle o) {
             return prepare<int32_t, 2, &MeshData::E>(o, {"E", 2, 2});
         }},
        {"source_face",
         "m int32 numbers, from 0 on, of the polygon that each triangle is of; empty: each triangle is one. "
         "Wireframes leave out the edges inside of a polygon, PLY and OBJ files are written with polygons, "
         "and labels and scalars may be given with one per polygon. Assigning F drops it.",
         view<int32_t, 1, &MeshData::source_face>,
         [](nb::handle o) {
             return prepare<int32_t, 1, &MeshData::source_face>(o, {"source_face", 1, 1});
         }},
        {"L",
         "int32 labels, one per vertex, per face or per polygon (per vertex if the numbers are equal); those "
         "of polygons are kept as one per face.",
         view<int32_t, 1, &MeshData::L>, prepare_labels},
        {"I", "n float32 intensities.", view<float, 1, &MeshData::I>, prepare_intensities},
        {"scales", "n x 3 float32 standard deviations of splats along their own axes.",
         view_splats<3, &SplatArrays::scales>,
         [](nb::handle o) {
             return prepare_splats<3, &SplatArrays::scales>(o, {"scales", 3, 3});
         }},
        {"rotations", "n x 4 float32 quaternions w, x, y, z of the axes of splats.",
         view_splats<4, &SplatArrays::rotations>,
         [](nb::handle o) {
             return prepare_splats<4, &SplatArrays::rotations>(o, {"rotations", 4, 4});
         }},
        {"opacities", "n float32 opacities of splats, 0 to 1.", view_splats<1, &SplatArrays::opacities>,
         [](nb::handle o) {
             return prepare_splats<1, &SplatArrays::opacities>(o, {"opacities", 1, 1});
         }},
        {"sh",
         "n x 3 (degree + 1)^2 float32 spherical harmonics of splats, degree 0 to 3: red, green, blue of the "
         "first, then of the second, ...",
         view_splats<Eigen::Dynamic, &SplatArrays::sh>, prepare_sh}};
    return arrays;
}

const MeshArray& mesh_array(const std::string& name) {
    std::vector<std::string> names;
    for (const MeshArray& array : mesh_arrays()) {
        if (name == array.name) return array;
        names.emplace_back(array.name);
    }
    throw NameError(fmt::format("a mesh has no array '{}'; it has {}", name, fmt::join(names, ", ")));
}

MeshChange prepare_member(const std::string& name, nb::handle value) {
    if (name == "scalars") return prepare_scalars(value);
    if (name == "label_map") return prepare_label_map(value);
    return mesh_array(name).prepare(value);
}

/// Several arrays at once: they need to fit together only afterwards.
void assign(Mesh& mesh, const nb::kwargs& values) {
    std::vector<MeshChange> changes;
    // It drops what belongs to the faces before, such as source_face.
    if (values.contains("F")) changes.push_back(prepare_F(values["F"]));
    if (values.contains("offset"))
        changes.push_back(
            [offset = to_vector3(values["offset"], "offset")](MeshData& data) { data.offset = offset; });
    for (auto [name, value] : values)
        if (const std::string text = nb::cast<std::string>(name); text != "offset" && text != "F")
            changes.push_back(prepare_member(text, value));
    released([&] {
        mesh.edit([&](MeshData& data) {
            for (const auto& change : changes) change(data);
        });
    });
}

/// The points of a cloud that have a finite position; those of a mesh are counted by its faces.
nb::object finite_points(const ArrayLike& V, bool has_faces, bool strict) {
    if (V.is_none() || has_faces) return nb::borrow(V);
    const nb::object array = numeric_object(V, "mesh array V");
    const nb::object kept =
        nb::module_::import_("easypbr.conversions.maker").attr("finite_rows")(array, strict);
    return kept.is_none() ? array : nb::object(array[kept]);
}

void construct_from_arrays(Mesh* self, const ArrayLike& V, const ArrayLike& F, bool strict) {
    const nb::object faces = F.is_none() ? nb::object(nb::none()) : numeric_object(F, "mesh array F");
    const bool has_faces = !F.is_none() && nb::cast<size_t>(faces.attr("size")) > 0;
    const auto set_V = prepare_V(finite_points(V, has_faces, strict)), set_F = prepare_F(faces);
    released([&] {
        MeshData data;
        set_V(data);
        set_F(data);
        new (self) Mesh(std::move(data));
    });
}

/// Polygons of these numbers of corners, which follow one another.
io::Polygons to_polygons(nb::handle corners, nb::handle sizes) {
    const Array1i::Dense counts = to_array<int32_t, 1>(sizes, {"F", 1, 1});
    io::Polygons polygons;
    polygons.values = to_array<int32_t, 1>(corners, {"F", 1, 1});
    polygons.rows = size_t(counts.size());
    const int64_t sum = counts.cast<int64_t>().sum();
    if ((counts.array() < 0).any() || sum != polygons.values.size() || sum > INT32_MAX)
        throw ArgumentError(fmt::format("faces: expected {} corners of {} polygons, up to {} in all, got {}",
                                        sum, polygons.rows, INT32_MAX, polygons.value_count()));
    polygons.first.assign(polygons.rows + 1, 0);
    std::partial_sum(counts.begin(), counts.end(), polygons.first.begin() + 1);
    return polygons;
}

void require_corners(const io::Polygons& polygons, Eigen::Index vertices) {
    for (size_t row = 0; row < polygons.rows; ++row)
        for (size_t i = polygons.begin_of(row); i < polygons.begin_of(row) + polygons.size_of(row); ++i)
            if (const int32_t index = polygons.values[Eigen::Index(i)]; index < 0 || index >= vertices)
                throw ArgumentError(
                    fmt::format("mesh array F: expected vertex indices from 0 to {}, got {} in row {} of {}",
                                vertices - 1, index, row, polygons.rows));
}

/// Triangles of polygons, and the polygon of each.
nb::tuple cut_polygons(const ArrayLike& V, const ArrayLike& corners, const ArrayLike& sizes) {
    io::Polygons polygons = to_polygons(corners, sizes);
    MeshData mesh;
    if (!V.is_none()) mesh.V = to_positions(V, {"V", 3, 3}).V;
    released([&] {
        require_corners(polygons, mesh.V.rows());
        io::triangulate(std::move(polygons), mesh);
    });
    return nb::make_tuple(view_of(mesh.F), view_of(mesh.source_face));
}

/// What `with mesh.edit("V") as v` holds: a writable copy, put in place when the block ends well.
struct ArrayEdit {
    Mesh mesh;
    const MeshArray* array;
    nb::object copy;

    nb::object enter() {
        if (!copy.is_none()) refuse("expected one block at a time, got __enter__() twice");
        copy = nb::module_::import_("numpy").attr("array")(array->view(*mesh.snapshot()));
        return copy;
    }
    void exit(const nb::object& type, const nb::object&, const nb::object&) {
        if (copy.is_none()) refuse("expected __enter__() first, got __exit__()");
        const nb::object edited = std::exchange(copy, nb::none());
        if (!type.is_none()) return;
        const auto change = array->prepare(edited);
        released([&] { mesh.edit(change); });
    }
    [[noreturn]] void refuse(const char* what) const {
        throw ArgumentError(fmt::format("mesh.edit(\"{}\"): {}", array->name, what));
    }
};

std::vector<MaterialHandle> materials(const Mesh& mesh) {
    std::vector<MaterialHandle> handles;
    const size_t count = std::max<size_t>(1, mesh.snapshot()->materials.size());
    for (size_t i = 0; i < count; ++i) handles.push_back({mesh, int(i), {}});
    return handles;
}

std::string mesh_text(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    return fmt::format("<easypbr.Mesh '{}': {} vertices, {} faces, {} children>", data->name, data->V.rows(),
                       data->F.rows(), data->children.size());
}

void bind_arrays(nb::class_<Mesh>& mesh) {
    for (const MeshArray& array : mesh_arrays())
        mesh.def_prop_rw(
            array.name, [&array](const Mesh& m) { return array.view(*m.snapshot()); },
            [&array](Mesh& m, const ArrayLike& value) {
                const auto change = array.prepare(value);
                released([&] { m.edit(change); });
            },
            nb::for_getter(nb::sig(fmt::format("def {}(self) -> numpy.ndarray", array.name).c_str())),
            nb::for_setter(nb::arg("value").none()),
            nb::for_setter(
                nb::sig(fmt::format("def {}(self, value: numpy.typing.ArrayLike | None) -> None", array.name)
                            .c_str())),
            array.doc);
    mesh.def("assign", assign, nb::sig("def assign(self, **arrays: object) -> None"),
             "Replaces several arrays at once, e.g. assign(V=v, F=f, N=None); also label_map and scalars. "
             "With offset=(0, 0, 0), V holds world coordinates, whatever the offset was.");
    mesh.def(
        "edit",
        [](const Mesh& m, const std::string& name) {
            return ArrayEdit{m, &mesh_array(name), nb::none()};
        },
        nb::arg("array"), "`with mesh.edit(\"V\") as v:` gives a writable copy and assigns it at the end.");
}

void bind_look(nb::class_<Mesh>& mesh) {
    mesh.def_prop_rw(
            "material",
            [](const Mesh& m) {
                return MaterialHandle{m, 0, {}};
            },
            [](Mesh& m, const MaterialHandle& material) { m.set_material(material.get()); },
            "The first material; assignments to its attributes change the mesh.")
        .def_prop_ro("materials", materials, "All materials, at least one.")
        .def(
            "add_material",
            [](Mesh& m, const MaterialHandle& material) {
                const int index = int(m.snapshot()->materials.size());
                m.set_material(material.get(), index);
                return MaterialHandle{m, index, {}};
            },
            nb::arg("material"))
        .def_prop_rw(
            "style",
            [](const Mesh& m) {
                return StyleHandle{m, {}};
            },
            [](Mesh& m, const StyleHandle& style) { m.set_style(style.get()); },
            "The style of the mesh; assignments to its attributes change the mesh.");
}

void bind_array_edit(nb::module_& module) {
    nb::class_<ArrayEdit>(module, "ArrayEdit", "An array of a mesh while it is edited.")
        .def("__enter__", &ArrayEdit::enter, nb::sig("def __enter__(self) -> numpy.ndarray"))
        .def("__exit__", &ArrayEdit::exit, nb::arg("type").none(), nb::arg("value").none(),
             nb::arg("traceback").none());
}

}  // namespace

void bind_mesh(nb::module_& module) {
    bind_array_edit(module);
    nb::class_<Mesh> mesh(
        module, "Mesh",
        "A handle to vertices, faces and attributes, materials, a pose and children. Copies of a "
        "handle share the mesh; clone() copies it.");
    mesh.def("__init__", [](Mesh* self) { new (self) Mesh(); })
        .def(
            "__init__", [](Mesh* self, const fs::path& path) { released([&] { new (self) Mesh(path); }); },
            nb::arg("path"),
            "Reads PLY, OBJ, STL, OFF, glTF, GLB, the formats of point clouds (PCD, XYZ, NPY, LAS, ...), "
            "and what assimp reads, in a process of its own.")
        .def("__init__", construct_from_arrays, nb::arg("V"), nb::arg("F").none() = nb::none(),
             nb::arg("strict") = false,
             "n x 3 positions and m x 3 vertex indices, of any numeric type; a cloud without faces, "
             "whose points without a finite position are left out with a warning, "
             "or raise ArgumentError if strict.");
    bind_arrays(mesh);
    bind_mesh_fields(mesh);
    bind_look(mesh);
    bind_mesh_pose(mesh);
    mesh.def_prop_rw(
            "name", [](const Mesh& m) { return m.name(); },
            [](Mesh& m, const std::string& name) { m.edit([&](MeshData& data) { data.name = name; }); })
        .def_prop_ro(
            "source", [](const Mesh& m) { return m.snapshot()->source.string(); },
            "The file it was read from, as an absolute path; empty for a mesh made in memory.")
        .def(
            "save", [](const Mesh& m, const fs::path& path) { released([&] { m.save(path); }); },
            nb::arg("path"), "Writes PLY, OBJ, GLB, PCD, XYZ, CSV, NPY or NPZ, by the extension.")
        .def(
            "__eq__", [](const Mesh& a, const Mesh& b) { return a == b; }, nb::is_operator(),
            "Whether both are handles to the same mesh.")
        .def("__repr__", mesh_text)
        .def("_repr_png_", [](const nb::object& self) {
            return nb::module_::import_("easypbr.rendering").attr("render_png")(self);
        });
    // Equal handles would need equal hashes; a mesh is no key.
    mesh.attr("__hash__") = nb::none();
    nb::class_<OwnQueue>(module, "MeshQueue")
        .def(nb::init<std::vector<fs::path>, int, int>(), nb::arg("paths"), nb::arg("workers"),
             nb::arg("prefetch"))
        .def("next", [](const OwnQueue& queue) { return released([&] { return queue.get().next(); }); })
        .def("__len__", [](const OwnQueue& queue) { return queue.get().size(); });
    module.def(
        "unit_colors",
        [](const ArrayLike& colors) {
            return view_of(to_colors(colors, {"C", 3, 4}));
        },
        nb::arg("colors"), nb::sig("def unit_colors(colors: numpy.typing.ArrayLike) -> numpy.ndarray"),
        "Colours as Mesh.C takes them, 0 to 1.");
    module.def("cut_polygons", cut_polygons, nb::arg("V").none(), nb::arg("corners"), nb::arg("sizes"),
               nb::sig("def cut_polygons(V: numpy.typing.ArrayLike | None, corners: numpy.typing.ArrayLike, "
                       "sizes: numpy.typing.ArrayLike) -> tuple[numpy.ndarray, numpy.ndarray]"),
               "m x 3 vertex indices of the triangles of polygons, and the polygon of each. `corners` holds "
               "the vertex indices of all polygons, `sizes` how many each has.");
    module.def("readable_mesh_extensions", [] { return released([] { return io::readable_extensions(); }); });
}

}  // namespace easypbr::python
