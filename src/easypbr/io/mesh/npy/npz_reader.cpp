#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/archive/zip_reader.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/npy/npy_points.h"
#include "easypbr/io/tables/polygons.h"
#include "easypbr/io/tables/vertex_arrays.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/rounding.h"

namespace easypbr::io {
namespace {

using Names = std::vector<std::string_view>;
using Integers = Eigen::Matrix<int32_t, Eigen::Dynamic, 1>;

/// Columns of an array without a meaning that become scalars each.
constexpr size_t most_scalars = 16;

// Names of one letter count by case, as in dicts of Python: the others are scalars.
const Names npz_positions{"V",         "v",      "vertices", "points", "xyz", "pos",        "position",
                          "positions", "coords", "coord",    "pc",     "pcd", "pointcloud", "point_cloud"};
const Names face_names{"F", "f", "faces", "triangles"};
const Names edge_names{"E", "edges"};
const Names npz_labels{"L", "labels", "label"};

/// What an array for the points may be called, and what its columns are then.
struct Role {
    Names names;
    std::vector<std::string> columns;
    size_t least_columns;
};
const std::vector<Role> roles{
    {{"N", "normals", "normal"}, {"nx", "ny", "nz"}, 3},
    {{"C", "colors", "color", "colours", "rgb", "rgba"}, {"red", "green", "blue", "alpha"}, 3},
    {{"uv", "uvs", "texcoords"}, {"u", "v"}, 2},
    {{"T", "tangents"}, {"tx", "ty", "tz"}, 3},
    {{"B", "bitangent_lengths"}, {"bitangent_length"}, 1},
    {npz_labels, {"label"}, 1},
    {{"I", "intensity", "intensities"}, {"intensity"}, 1}};

struct NamedArray {
    std::string name, lower_name;
    Source source;
    NpyArray array;
};

bool is_called(const NamedArray& array, std::string_view name) {
    return (name.size() == 1 ? array.name : array.lower_name) == name;
}

bool is_called(const NamedArray& array, const Names& names) {
    return std::ranges::any_of(names, [&](std::string_view name) { return is_called(array, name); });
}

/// What the columns of an array without a role are called.
std::vector<std::string> names_of_columns(const NamedArray& array, size_t columns) {
    if (columns == 1 && array.name.size() == 1) return {scalar_field_name(array.name)};
    return names_of_parts(array.name, columns);
}

/// All values of a plain array, row by row. `rounding`: counts what float32 makes of those of one column.
template <class Values>
Values values_of(const NamedArray& named, Rounding* rounding = nullptr) {
    const NpyArray& array = named.array;
    Values values(Eigen::Index(array.rows() * array.columns()));
    const std::vector<Element> elements =
        array.elements(std::vector<std::string>(array.columns(), named.name));
    std::vector<ElementPlan> plans;
    size_t next = 0;
    for (const Element& element : elements) {
        plans.push_back({&element, std::vector<Column>(element.properties.size())});
        for (Column& column : plans.back().columns) {
            if constexpr (std::is_same_v<Values, Integers>)
                column.integers = values.data() + next++;
            else if constexpr (std::is_same_v<Values, Eigen::VectorXd>)
                column.doubles = values.data() + next++;
            else
                column.floats = values.data() + next++;
            column.stride = array.columns();
            column.rounding = rounding;
        }
    }
    read_binary_elements(named.source, array.data, array.endian, plans);
    return values;
}

class NpzReader {
    static constexpr std::string_view extension = ".npy";

  public:
    explicit NpzReader(const Source& source) : source_(source), entries_(read_zip(source, extension)) {
        for (const ZipEntry& entry : entries_) add_array(entry);
    }

    MeshData read() {
        const NamedArray* positions = find(npz_positions);
        if (!positions && arrays_.size() == 1) positions = &arrays_[0];
        if (!positions)
            fail(source_,
                 fmt::format("no array of positions; it would be called {}", fmt::join(npz_positions, ", ")));
        if (const NamedArray* faces = find(face_names)) read_faces(*faces);
        std::vector<BinaryTable> tables{point_table(positions->source, positions->array)};
        points_ = positions->array.rows();
        for (const NamedArray& array : arrays_)
            if (&array != positions) add_values(array, tables);
        mesh_ = read_binary_cloud(source_, tables);
        mesh_.offset += offset_;
        mesh_.voxel_size = voxel_size_;
        check_and_triangulate();
        add_face_values();
        return std::move(mesh_);
    }

  private:
    void add_array(const ZipEntry& entry) {
        const std::string name = entry.name.substr(0, entry.name.size() - extension.size());
        NamedArray array{name, ascii::to_lower(name), Source(entry.bytes, source_.path), {}};
        try {
            array.array = parse_npy(array.source, entry.bytes);
            arrays_.push_back(std::move(array));
        } catch (const FormatError& error) {
            if (is_called(array, npz_positions)) throw;
            log_warning(fmt::format("array '{}' is left out: {}", name, error.what()));
        }
    }

    const NamedArray* find(const Names& names) const {
        for (const std::string_view name : names)
            for (const NamedArray& array : arrays_)
                if (is_called(array, name)) return &array;
        return nullptr;
    }

    [[noreturn]] void refuse(const NamedArray& array, std::string_view expected) const {
        fail(source_, fmt::format("array '{}': expected {}, got shape {}", array.name, expected,
                                  array.array.shape_text()));
    }

    Integers indices_of(const NamedArray& array) const {
        const bool integers = !array.array.is_structured() && is_integer(array.array.fields[0].type);
        if (!integers) refuse(array, "integers");
        if (array.array.rows() > INT32_MAX) refuse(array, "less rows");
        return values_of<Integers>(array);
    }

    void read_faces(const NamedArray& array) {
        if (array.array.columns() < 3) refuse(array, "m x 3 or more vertices of faces");
        faces_.values = indices_of(array);
        faces_.rows = array.array.rows();
        faces_.width = array.array.columns();
    }

    /// An array of values for the points becomes a table, one for the faces is kept for later.
    void add_values(const NamedArray& named, std::vector<BinaryTable>& tables) {
        const NpyArray& array = named.array;
        const size_t rows = array.rows(), columns = array.columns();
        if (is_called(named, face_names)) return;
        if (is_called(named, edge_names)) return read_edges(named);
        if (named.lower_name == "offset") return read_offset(named);
        if (array.is_structured()) return leave_out(named);
        if (named.lower_name == "voxel_size" && array.size() == 1) return read_voxel_size(named);
        if (rows != points_ && rows == faces_.rows && columns == 1) {
            face_values_.push_back(&named);
            return;
        }
        const auto role =
            std::ranges::find_if(roles, [&](const Role& r) { return is_called(named, r.names); });
        std::vector<std::string> names;
        if (role != roles.end()) {
            if (rows != points_ || columns < role->least_columns || columns > role->columns.size())
                refuse(named, fmt::format("{} rows of {} numbers, one for each point", points_,
                                          role->least_columns));
            names.assign(role->columns.begin(), role->columns.begin() + long(columns));
        } else if (rows == points_ && columns <= most_scalars) {
            names = names_of_columns(named, columns);
        } else {
            return leave_out(named);
        }
        tables.push_back({named.source, array.data, array.endian, array.elements(names)});
    }

    void leave_out(const NamedArray& named) const {
        log_warning(fmt::format("{}: array '{}' of shape {} is left out: it has no values for the {} points",
                                source_.path.string(), named.name, named.array.shape_text(), points_));
    }

    void read_edges(const NamedArray& array) {
        if (array.array.columns() != 2) refuse(array, "k x 2 vertices of edges");
        edges_ = indices_of(array);
    }

    void read_offset(const NamedArray& array) {
        if (array.array.is_structured() || array.array.size() != 3) refuse(array, "3 numbers");
        offset_ = values_of<Eigen::VectorXd>(array);
        if (!offset_.allFinite()) refuse(array, "3 finite numbers");
    }

    /// One of a mesh with faces says how it was made, not what it is.
    void read_voxel_size(const NamedArray& array) {
        const float size = values_of<Eigen::VectorXf>(array)[0];
        if (faces_.rows == 0 && size > 0 && std::isfinite(size))
            voxel_size_ = size;
        else
            log_warning(
                fmt::format("{}: array '{}' is left out: expected a finite number above 0 beside points "
                            "without faces",
                            source_.path.string(), array.name));
    }

    void check_and_triangulate() {
        const size_t count = size_t(mesh_.V.rows());
        if (faces_.rows == 0 && edges_.size() == 0) return drop_points_without_position(source_, mesh_);
        check_positions(source_, mesh_.V);
        check_indices(source_, {faces_.values.data(), faces_.value_count()}, count, "a face");
        check_indices(source_, {edges_.data(), size_t(edges_.size())}, count, "an edge");
        if (edges_.size())
            mesh_.E = Array2i::Dense(Eigen::Map<Array2i::Dense>(edges_.data(), edges_.size() / 2, 2));
        if (faces_.rows) triangulate(std::move(faces_), mesh_);
    }

    template <class Values>
    Values of_triangles(const Values& values) const {
        if (mesh_.source_face.empty()) return values;
        Values result(mesh_.F.rows());
        for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = values[mesh_.source_face[i]];
        return result;
    }

    Eigen::VectorXf scalars_of(const NamedArray& named, const std::string& name) const {
        Rounding rounding;
        const bool is_fine = is_finer_than_float(named.array.fields[0].type);
        Eigen::VectorXf values = values_of<Eigen::VectorXf>(named, is_fine ? &rounding : nullptr);
        warn_of_rounding(source_.path.string(), name, rounding.counts());
        return values;
    }

    void add_face_values() {
        for (const NamedArray* named : face_values_) {
            const bool are_labels = is_called(*named, npz_labels) && mesh_.L.empty();
            const std::string name = scalar_name(named->name);
            const auto has_name = [&](const ScalarArray& scalar) { return scalar.name == name; };
            if (!are_labels && std::ranges::any_of(mesh_.scalars, has_name)) {
                warn_of_taken_name(source_, name);
                continue;
            }
            tell_faces_from_vertices(mesh_);
            if (are_labels)
                mesh_.L = of_triangles(values_of<Integers>(*named));
            else
                mesh_.scalars.push_back({name, of_triangles(scalars_of(*named, name))});
        }
    }

    const Source& source_;
    const std::vector<ZipEntry> entries_;
    std::vector<NamedArray> arrays_;
    std::vector<const NamedArray*> face_values_;
    size_t points_ = 0;
    Polygons faces_;
    Integers edges_;
    Vec3d offset_ = Vec3d::Zero();
    float voxel_size_ = 0;
    MeshData mesh_;
};

}  // namespace

MeshData read_npz(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    return NpzReader(source).read();
}

}  // namespace easypbr::io
