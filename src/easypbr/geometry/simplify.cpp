#include "easypbr/geometry/remesh.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/awaited.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/require.h"

namespace easypbr {
namespace {

void require(const DecimateOptions& options) {
    if (!options.faces && !options.error)
        throw ArgumentError("decimate: expected a number of faces or a largest error, got neither");
    if (options.faces && *options.faces < 0)
        throw ArgumentError(fmt::format("decimate: faces: expected a number >= 0, got {}", *options.faces));
    if (options.error) geometry::require_not_negative("decimate: error", *options.error);
}

/// What is left of a range of faces. `relative_error` is in units of the mesh's extent.
std::vector<unsigned int> simplified(const std::shared_ptr<const MeshData>& mesh, int first_face,
                                     int face_count, size_t target_faces, float relative_error,
                                     bool lock_borders) {
    return geometry::awaited(size_t(face_count), [=] {
        const auto* indices = reinterpret_cast<const unsigned int*>(mesh->F.data()) + 3 * size_t(first_face);
        std::vector<unsigned int> result(3 * size_t(face_count));
        const size_t count =
            meshopt_simplify(result.data(), indices, result.size(), mesh->V.data(), size_t(mesh->V.rows()),
                             3 * sizeof(float), 3 * std::min(target_faces, size_t(face_count)),
                             relative_error, lock_borders ? meshopt_SimplifyLockBorder : 0, nullptr);
        result.resize(count);
        return result;
    });
}

/// No face that is left is one of those that were.
void leave_out_values_of_faces(const MeshData& mesh, MeshData& simple) {
    const auto of_faces = [&](Eigen::Index rows) {
        return rows > 0 && element_of(mesh, rows) == PerElement::face;
    };
    std::vector<std::string> names;
    if (of_faces(mesh.L.rows())) {
        simple.L = {};
        names.emplace_back("labels");
    }
    std::erase_if(simple.scalars, [&](const ScalarArray& scalar) {
        const bool left_out = of_faces(scalar.values.rows());
        if (left_out) names.push_back("scalars '" + scalar.name + "'");
        return left_out;
    });
    if (!names.empty())
        log_warning(fmt::format("mesh '{}': {} belong to its faces, which decimate() replaces: left out",
                                mesh.name, fmt::join(names, ", ")));
}

}  // namespace

Mesh decimate(const Mesh& mesh, const DecimateOptions& options) {
    require(options);
    const auto data = mesh.snapshot();
    geometry::require_faces("decimate", *data);
    const size_t all = size_t(data->F.rows()), target = options.faces ? size_t(*options.faces) : 0;
    const float extent = meshopt_simplifyScale(data->V.data(), size_t(data->V.rows()), 3 * sizeof(float));
    // Its square must stay finite; the extent is the most that any face can move by.
    constexpr double unbounded = 1e10;
    const float error =
        float(options.error && extent > 0 ? std::min(*options.error / extent, unbounded) : unbounded);
    std::vector<MeshPart> parts = data->parts;
    const bool has_parts = parts.size() > 1;
    if (parts.empty()) parts = {{"", 0, int(all), 0}};

    std::vector<unsigned int> indices;
    for (MeshPart& part : parts) {
        const double share = double(part.face_count) / double(all);
        const auto part_target = has_parts ? size_t(std::llround(share * double(target))) : target;
        const auto left = simplified(data, part.first_face, part.face_count, part_target, error, has_parts);
        part.first_face = int(indices.size() / 3);
        part.face_count = int(left.size() / 3);
        indices.insert(indices.end(), left.begin(), left.end());
    }
    MeshData simple = *data;
    simple.F =
        Array3i::Dense(Eigen::Map<const Eigen::Matrix<unsigned int, Eigen::Dynamic, 3, Eigen::RowMajor>>(
                           indices.data(), Eigen::Index(indices.size() / 3), 3)
                           .cast<int32_t>());
    if (data->parts.empty()) parts.clear();
    simple.parts = std::move(parts);
    simple.E = {};
    simple.source_face = {};
    leave_out_values_of_faces(*data, simple);
    geometry::Selection selection = geometry::select_all(simple);
    geometry::drop_unreferenced(selection, simple);
    return Mesh(geometry::chosen(simple, selection));
}

}  // namespace easypbr
