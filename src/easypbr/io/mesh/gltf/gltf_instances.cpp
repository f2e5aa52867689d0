#include "easypbr/io/mesh/gltf/gltf_instances.h"

#include <fmt/format.h>

#include "easypbr/core/memory_budget.h"
#include "easypbr/io/mesh/gltf/gltf_accessor.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {
namespace {

/// A mesh in the tree, with what the handle and its lists take.
constexpr uint64_t bytes_per_instance = 2 * sizeof(MeshData);

Eigen::Affine3d pose_of_row(const ArrayXf::Dense& T, const ArrayXf::Dense& R, const ArrayXf::Dense& S,
                            Eigen::Index row) {
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    if (T.rows()) pose.translation() = T.row(row).cast<double>().transpose();
    const Eigen::Quaterniond rotation(R.rows() ? Eigen::Vector4d(R.row(row).cast<double>().transpose())
                                               : Eigen::Vector4d(0, 0, 0, 1));
    if (rotation.norm() > 0) pose.rotate(rotation.normalized());
    if (S.rows()) pose.scale(Vec3d(S.row(row).cast<double>().transpose()));
    return pose;
}

}  // namespace

std::optional<std::vector<Eigen::Affine3d>> read_gltf_instances(GltfDocument& document, const Json& json,
                                                                size_t node) {
    const Json* instancing = extension(json, ext_mesh_gpu_instancing);
    if (!instancing) return std::nullopt;
    const auto fail = [&](const std::string& what) {
        document.fail(fmt::format("nodes[{}], {}: {}", node, ext_mesh_gpu_instancing, what));
    };
    const Json* attributes = member(*instancing, "attributes");
    if (!attributes) fail("there are no attributes");
    std::optional<Eigen::Index> count;
    const auto read = [&](const char* name, int columns) {
        const auto accessor = document.optional_integer(*attributes, name);
        if (!accessor) return ArrayXf::Dense(0, columns);
        ArrayXf::Dense rows = read_floats(document, *accessor, columns, columns);
        if (count.value_or(rows.rows()) != rows.rows())
            fail(fmt::format("{} has {} rows, another attribute {}", name, rows.rows(), *count));
        if (!rows.allFinite()) fail(fmt::format("{} is not finite", name));
        count = rows.rows();
        return rows;
    };
    const ArrayXf::Dense T = read("TRANSLATION", 3), R = read("ROTATION", 4), S = read("SCALE", 3);
    if (!count) fail("none of TRANSLATION, ROTATION and SCALE is given");
    charge_memory(uint64_t(*count) * bytes_per_instance, fmt::format("the copies of nodes[{}]", node));
    std::vector<Eigen::Affine3d> poses;
    for (Eigen::Index row = 0; row < *count; ++row) poses.push_back(pose_of_row(T, R, S, row));
    return poses;
}

}  // namespace easypbr::io
