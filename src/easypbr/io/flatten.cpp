#include "easypbr/io/flatten.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "easypbr/core/log.h"
#include "easypbr/scene/normals.h"

namespace easypbr::io {
namespace {

struct Node {
    std::shared_ptr<const MeshData> data;
    Eigen::Affine3d T_world_mesh;
};

/// Directions turned by `M` and made unit again; (0, 0, 1) where nothing is left.
Array3f::Dense turned(const Array3f& directions, const Mat3d& M) {
    Array3f::Dense result(directions.rows(), 3);
    for (Eigen::Index i = 0; i < directions.rows(); ++i) {
        const Vec3d direction = M * directions.row(i).transpose().cast<double>();
        const double length = direction.norm();
        result.row(i) = (length > 0 ? Vec3d(direction / length) : Vec3d::UnitZ()).cast<float>().transpose();
    }
    return result;
}

MeshData transformed(const Node& node) {
    MeshData mesh = *node.data;
    mesh.children.clear();
    mesh.T_parent_mesh.setIdentity();
    if (node.T_world_mesh.matrix().isIdentity(0)) return mesh;
    const Mat3d linear = node.T_world_mesh.linear();
    const auto moved =
        (mesh.V.cast<double>() * linear.transpose()).rowwise() + node.T_world_mesh.translation().transpose();
    if (!mesh.N.empty()) mesh.N = turned(mesh.N, linear.inverse().transpose());
    if (!mesh.V.empty()) mesh.V = Array3f::Dense(moved.cast<float>());
    if (linear.determinant() < 0 && !mesh.F.empty()) mesh.F = Array3i::Dense(mesh.F.rowwise().reverse());
    return mesh;
}

/// `a` over `b`; the one that is missing is `filler`, with as many rows as its mesh has things.
template <class A>
A joined(const A& a, Eigen::Index a_rows, const A& b, Eigen::Index b_rows, typename A::Scalar filler) {
    if (a.empty() && b.empty()) return {};
    const Eigen::Index cols = std::max(a.cols(), b.cols());
    typename A::Dense result = A::Dense::Constant(a_rows + b_rows, cols, filler);
    if (!a.empty()) result.topLeftCorner(a_rows, a.cols()) = a;
    if (!b.empty()) result.bottomLeftCorner(b_rows, b.cols()) = b;
    return result;
}

/// Labels or scalars of vertices or faces; `name` is what a warning calls them. Those of the faces and those
/// of the vertices cannot become one array: the second ones are left out.
template <class A>
A joined_either(const MeshData& whole, const A& a, const MeshData& mesh, const A& b,
                typename A::Scalar filler, const std::string& name) {
    if (a.empty() && b.empty()) return {};
    const PerElement element = a.empty() ? element_of(mesh, b.rows()) : element_of(whole, a.rows());
    const auto rows_of = [&](const MeshData& data) {
        return element == PerElement::vertex ? data.V.rows() : data.F.rows();
    };
    const bool fits = b.empty() || b.rows() == rows_of(mesh);
    if (!fits)
        log_warning(fmt::format("mesh '{}': {} of '{}' belong to its {} and others to the {}: left out",
                                whole.name, name, mesh.name,
                                element == PerElement::vertex ? "faces" : "vertices",
                                element == PerElement::vertex ? "vertices" : "faces"));
    return joined(a, rows_of(whole), fits ? b : A(), rows_of(mesh), filler);
}

Array1f scalar_or_none(const MeshData& mesh, const std::string& name) {
    for (const ScalarArray& scalar : mesh.scalars)
        if (scalar.name == name) return scalar.values;
    return {};
}

std::vector<ScalarArray> joined_scalars(const MeshData& whole, const MeshData& mesh) {
    std::set<std::string> names;
    for (const auto* scalars : {&whole.scalars, &mesh.scalars})
        for (const ScalarArray& scalar : *scalars) names.insert(scalar.name);
    std::vector<ScalarArray> result;
    for (const std::string& name : names)
        result.push_back(
            {name, joined_either(whole, scalar_or_none(whole, name), mesh, scalar_or_none(mesh, name),
                                 std::nanf(""), "scalars '" + name + "'")});
    return result;
}

void join_labels(MeshData& whole, const MeshData& mesh) {
    whole.L = joined_either(whole, whole.L, mesh, mesh.L, no_label, "labels");
    if (!whole.label_map) whole.label_map = mesh.label_map;
    if (mesh.label_map && mesh.label_map != whole.label_map)
        log_warning(fmt::format("mesh '{}': its parts have the label maps '{}' and '{}': the first is kept",
                                whole.name, whole.label_map->name(), mesh.label_map->name()));
}

void fill_normals(MeshData& mesh) {
    if (mesh.N.empty() && !mesh.V.empty()) mesh.N = smooth_normals(mesh);
}

/// Parts that cover all faces also where the mesh has none.
std::vector<MeshPart> all_parts(const MeshData& mesh) {
    if (!mesh.parts.empty() || mesh.F.empty()) return mesh.parts;
    return {{mesh.name, 0, int(mesh.F.rows()), 0}};
}

void append(MeshData& whole, MeshData mesh) {
    if (whole.N.empty() != mesh.N.empty()) {
        fill_normals(whole);
        fill_normals(mesh);
    }
    if (mesh.materials.empty()) mesh.materials.emplace_back();
    const Eigen::Index n = whole.V.rows(), k = mesh.V.rows();
    const int faces = int(whole.F.rows()), materials = int(whole.materials.size());
    for (MeshPart part : all_parts(mesh)) {
        part.first_face += faces;
        part.material += materials;
        whole.parts.push_back(part);
    }
    whole.materials.insert(whole.materials.end(), mesh.materials.begin(), mesh.materials.end());
    join_labels(whole, mesh);
    whole.scalars = joined_scalars(whole, mesh);
    const Array3i F = Array3i::Dense(mesh.F.array() + int32_t(n));
    const Array2i E = Array2i::Dense(mesh.E.array() + int32_t(n));
    whole.F = joined(whole.F, whole.F.rows(), F, F.rows(), 0);
    whole.E = joined(whole.E, whole.E.rows(), E, E.rows(), 0);
    whole.N = joined(whole.N, n, mesh.N, k, 0.0f);
    whole.C = joined(whole.C, n, mesh.C, k, 1.0f);
    whole.UV = joined(whole.UV, n, mesh.UV, k, 0.0f);
    whole.I = joined(whole.I, n, mesh.I, k, 0.0f);
    whole.V = joined(whole.V, n, mesh.V, k, 0.0f);
}

}  // namespace

MeshData flatten(const Mesh& mesh) {
    std::vector<Node> nodes;
    for_each_node(mesh,
                  [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d& T_world_mesh) {
                      if (!data->V.empty()) nodes.push_back({data, T_world_mesh});
                  });
    if (nodes.size() == 1) return transformed(nodes[0]);
    MeshData whole;
    whole.name = mesh.name();
    for (const Node& node : nodes) append(whole, transformed(node));
    return whole;
}

}  // namespace easypbr::io
