#include "easypbr/scene/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>

#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/scene/crease.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/offset.h"

namespace easypbr {
namespace {

using Meshes = std::span<const MeshData>;

Eigen::Index rows_for(const MeshData& mesh, PerElement element) {
    return element == PerElement::vertex ? mesh.V.rows() : mesh.F.rows();
}

/// Total rows; throws when 32-bit indices cannot count them.
Eigen::Index total(Meshes meshes, PerElement element) {
    Eigen::Index sum = 0;
    for (const MeshData& mesh : meshes) sum += rows_for(mesh, element);
    if (sum > std::numeric_limits<int32_t>::max())
        throw ArgumentError(fmt::format("merge: expected at most {} {}, got {}",
                                        std::numeric_limits<int32_t>::max(),
                                        element == PerElement::vertex ? "vertices" : "faces", sum));
    return sum;
}

/// One array over the other: of(mesh) or, where that is empty, `filler` for each vertex or face of the mesh.
template <class A, class Of>
A joined(Meshes meshes, PerElement element, typename A::Scalar filler, Of&& of) {
    std::vector<A> parts;
    for (const MeshData& mesh : meshes) parts.push_back(of(mesh));
    Eigen::Index cols = 0;
    for (const A& part : parts)
        if (!part.empty()) cols = std::max(cols, part.cols());
    if (cols == 0) return {};
    typename A::Dense result = A::Dense::Constant(total(meshes, element), cols, filler);
    Eigen::Index row = 0;
    for (size_t i = 0; i < parts.size(); ++i) {
        if (!parts[i].empty()) result.block(row, 0, parts[i].rows(), parts[i].cols()) = parts[i];
        row += rows_for(meshes[i], element);
    }
    return result;
}

template <class A>
A joined(Meshes meshes, A MeshData::*member, typename A::Scalar filler) {
    return joined<A>(meshes, PerElement::vertex, filler, [&](const MeshData& mesh) { return mesh.*member; });
}

/// Vertex indices of faces or edges, shifted by the vertices before.
template <class A>
A joined_indices(Meshes meshes, A MeshData::*member) {
    Eigen::Index count = 0, row = 0, shift = 0;
    for (const MeshData& mesh : meshes) count += (mesh.*member).rows();
    if (count == 0) return {};
    typename A::Dense result(count, A::ColsAtCompileTime);
    for (const MeshData& mesh : meshes) {
        const A& part = mesh.*member;
        if (!part.empty()) result.middleRows(row, part.rows()) = part.array() + int32_t(shift);
        row += part.rows();
        shift += mesh.V.rows();
    }
    return result;
}

/// source_vertex or source_face, shifted so that those of different meshes stay different.
Array1i joined_sources(Meshes meshes, Array1i MeshData::*member, PerElement element) {
    const auto is_empty = [&](const MeshData& mesh) { return (mesh.*member).empty(); };
    if (std::all_of(meshes.begin(), meshes.end(), is_empty)) return {};
    Array1i::Dense result(total(meshes, element));
    Eigen::Index row = 0;
    int32_t shift = 0;
    for (const MeshData& mesh : meshes) {
        const Eigen::Index count = rows_for(mesh, element);
        if (count == 0) continue;
        auto block = result.segment(row, count);
        if (is_empty(mesh))
            std::iota(block.begin(), block.end(), shift);
        else
            // So that the numbers of all that follow are of 32 bits, too.
            block = numbers_below(std::numeric_limits<int32_t>::max() - shift - (result.rows() - row - count),
                                  mesh.*member)
                        .array() +
                    shift;
        row += count;
        shift = block.maxCoeff() + 1;
    }
    return result;
}

/// Labels or scalars: of the vertices or of the faces as in the first mesh that has them. Those of faces go
/// to `of_faces`. `name` is for warnings.
template <class A, class Of>
A joined_either(Meshes meshes, const std::string& name, typename A::Scalar filler, A& of_faces, Of&& of) {
    const auto first =
        std::find_if(meshes.begin(), meshes.end(), [&](const MeshData& mesh) { return !of(mesh).empty(); });
    if (first == meshes.end()) return {};
    const PerElement element = element_of(*first, of(*first).rows());
    A values = joined<A>(meshes, element, filler, [&](const MeshData& mesh) -> A {
        const A values = of(mesh);
        if (values.empty() || values.rows() == rows_for(mesh, element)) return values;
        const bool of_vertices = element == PerElement::vertex;
        log_warning(fmt::format("mesh '{}': {} belong to its {} and those of '{}' to the {}: left out",
                                mesh.name, name, of_vertices ? "faces" : "vertices", first->name,
                                of_vertices ? "vertices" : "faces"));
        return {};
    });
    if (element == PerElement::face) std::swap(values, of_faces);
    return values;
}

std::vector<ScalarArray> joined_scalars(Meshes meshes, FaceValues& of_faces) {
    std::vector<std::string> names;
    for (const MeshData& mesh : meshes)
        for (const ScalarArray& scalar : mesh.scalars)
            if (std::find(names.begin(), names.end(), scalar.name) == names.end())
                names.push_back(scalar.name);
    std::vector<ScalarArray> result;
    for (const std::string& name : names) {
        const auto of = [&](const MeshData& mesh) -> Array1f {
            for (const ScalarArray& scalar : mesh.scalars)
                if (scalar.name == name) return scalar.values;
            return {};
        };
        Array1f& values = of_faces.scalars.emplace_back();
        result.push_back(
            {name, joined_either<Array1f>(meshes, "scalars '" + name + "'", std::nanf(""), values, of)});
    }
    return result;
}

std::shared_ptr<const LabelMap> first_label_map(Meshes meshes) {
    std::shared_ptr<const LabelMap> found;
    for (const MeshData& mesh : meshes) {
        if (!found) found = mesh.label_map;
        if (mesh.label_map && mesh.label_map != found)
            log_warning(
                fmt::format("mesh '{}': its parts have the label maps '{}' and '{}': the first is kept",
                            meshes.front().name, found->name(), mesh.label_map->name()));
    }
    return found;
}

/// Materials of several meshes, in their order: equal ones once.
class JoinedMaterials {
  public:
    explicit JoinedMaterials(std::vector<Material>& materials) : materials_(materials) {}

    int index_of(const Material& material) {
        // Materials that are alike otherwise tend to differ in these.
        const size_t key = std::hash<std::string>()(material.name) ^
                           std::hash<const Image*>()(material.base_color_texture.image.get()) ^
                           std::hash<float>()(material.base_color.dot(Vec3(1, 3, 5)));
        const auto [begin, end] = known_.equal_range(key);
        for (auto known = begin; known != end; ++known)
            if (materials_[size_t(known->second)] == material) return known->second;
        const int index = int(materials_.size());
        materials_.push_back(material);
        known_.emplace(key, index);
        return index;
    }

  private:
    std::vector<Material>& materials_;
    std::unordered_multimap<size_t, int> known_;
};

/// Where the materials of a mesh are in the joined ones; of a mesh without any, the default.
std::vector<int> join_materials(const MeshData& mesh, JoinedMaterials& joined) {
    std::vector<int> places;
    for (const Material& material : mesh.materials) places.push_back(joined.index_of(material));
    if (places.empty()) places.push_back(joined.index_of(Material()));
    return places;
}

Vec3 color_beside(const Material& material, bool with_coordinates) {
    const Vec3 alone = material.color_factor(false, with_coordinates);
    const bool stays = alone == material.color_factor(true, with_coordinates);
    return stays ? Vec3(1, 1, 1) : srgb_from_linear(alone);
}

/// The colours that vertices without any have beside others: a default material, which is white there, leaves
/// them its grey, unless it has a texture.
ArrayXf colors_beside(const MeshData& mesh) {
    const Material first = mesh.materials.empty() ? Material() : mesh.materials.front();
    const bool with_coordinates = !mesh.F.empty() && !mesh.UV.empty();
    ArrayXf::Dense C = color_beside(first, with_coordinates).transpose().replicate(mesh.V.rows(), 1);
    for (const MeshPart& part : mesh.parts) {
        const Vec3 color = color_beside(mesh.materials.at(size_t(part.material)), with_coordinates);
        for (int face = part.first_face; face < part.first_face + part.face_count; ++face)
            for (int corner = 0; corner < 3; ++corner)
                C.row(mesh.F(face, corner)).head<3>() = color.transpose();
    }
    return C;
}

ArrayXf joined_colors(Meshes meshes) {
    if (std::ranges::all_of(meshes, [](const MeshData& mesh) { return mesh.C.empty(); })) return {};
    return joined<ArrayXf>(meshes, PerElement::vertex, 1.0f, [](const MeshData& mesh) {
        return mesh.C.empty() ? colors_beside(mesh) : mesh.C;
    });
}

void join_parts(MeshData& whole, Meshes meshes) {
    JoinedMaterials joined(whole.materials);
    int faces = 0;
    for (const MeshData& mesh : meshes) {
        const std::vector<int> places = join_materials(mesh, joined);
        std::vector<MeshPart> parts = mesh.parts;
        if (parts.empty() && !mesh.F.empty()) parts = {{mesh.name, 0, int(mesh.F.rows()), 0}};
        for (MeshPart& part : parts) {
            part.first_face += faces;
            part.material = places.at(size_t(part.material));
            whole.parts.push_back(part);
        }
        faces += int(mesh.F.rows());
    }
}

/// Coefficients of higher degrees than a mesh has are 0.
SplatArrays joined_splats(Meshes meshes) {
    const auto join = [&](auto SplatArrays::*member) {
        return joined<std::remove_cvref_t<decltype(SplatArrays().*member)>>(
            meshes, PerElement::vertex, 0.0f, [&](const MeshData& mesh) { return mesh.splats.*member; });
    };
    return {join(&SplatArrays::scales), join(&SplatArrays::rotations), join(&SplatArrays::opacities),
            join(&SplatArrays::sh)};
}

template <class Of>
bool all_have(Meshes meshes, Of&& of) {
    return std::all_of(meshes.begin(), meshes.end(),
                       [&](const MeshData& mesh) { return mesh.V.empty() || of(mesh); });
}

/// A mesh whose rows from `own` on repeat vertices at sharp edges.
struct Part {
    MeshData mesh;
    Eigen::Index own;
};

Part as_it_is(const MeshData& mesh) {
    return {mesh, mesh.V.rows()};
}

struct Parts {
    std::vector<MeshData> meshes;
    std::vector<Eigen::Index> own;

    void add(Part part) {
        meshes.push_back(std::move(part.mesh));
        own.push_back(part.own);
    }
    Eigen::Index all_own() const { return std::accumulate(own.begin(), own.end(), Eigen::Index(0)); }
};

/// Puts the rows that repeat vertices behind those of all parts. Labels and scalars must be those of
/// vertices.
void put_repeated_last(MeshData& whole, const Parts& parts) {
    if (parts.all_own() == whole.V.rows()) return;
    std::vector<int32_t> rows, repeated;
    int32_t row = 0;
    for (size_t i = 0; i < parts.meshes.size(); ++i)
        for (Eigen::Index k = 0; k < parts.meshes[i].V.rows(); ++k)
            (k < parts.own[i] ? rows : repeated).push_back(row++);
    rows.insert(rows.end(), repeated.begin(), repeated.end());
    std::vector<int32_t> place(rows.size());
    for (size_t i = 0; i < rows.size(); ++i) place[size_t(rows[i])] = int32_t(i);
    const auto placed = [&](int32_t vertex) { return place[size_t(vertex)]; };
    choose_vertex_rows(whole, rows);
    whole.source_vertex = rows_of(whole.source_vertex, rows);
    whole.F = whole.F.unaryExpr(placed);
    whole.E = whole.E.unaryExpr(placed);
}

/// See merged(). Normals stay as they are.
Part joined_parts(const Parts& parts) {
    const Meshes meshes = parts.meshes;
    if (meshes.empty()) return {};
    if (meshes.size() == 1) return {meshes.front(), parts.own.front()};
    MeshData whole;
    whole.name = meshes.front().name;
    whole.source = meshes.front().source;
    whole.style = meshes.front().style;
    whole.T_parent_mesh = meshes.front().T_parent_mesh;
    whole.offset = meshes.front().offset;
    whole.V = joined<Array3f>(meshes, PerElement::vertex, 0.0f,
                              [&](const MeshData& mesh) { return positions_from(mesh, whole.offset); });
    whole.N = joined(meshes, &MeshData::N, 0.0f);
    whole.C = joined_colors(meshes);
    whole.UV = joined(meshes, &MeshData::UV, 0.0f);
    whole.uv_tangents = joined(meshes, &MeshData::uv_tangents, 0.0f);
    if (all_have(meshes, [](const MeshData& mesh) { return !mesh.T.empty() && !mesh.B.empty(); })) {
        whole.T = joined(meshes, &MeshData::T, 0.0f);
        whole.B = joined(meshes, &MeshData::B, 0.0f);
    }
    if (all_have(meshes, [](const MeshData& mesh) { return !mesh.splats.empty(); }))
        whole.splats = joined_splats(meshes);
    whole.I = joined(meshes, &MeshData::I, 0.0f);
    FaceValues of_faces;
    whole.L = joined_either<Array1i>(meshes, "labels", no_label, of_faces.L,
                                     [](const MeshData& mesh) { return mesh.L; });
    whole.label_map = first_label_map(meshes);
    whole.scalars = joined_scalars(meshes, of_faces);
    for (Vec3d MeshData::*direction : {&MeshData::up, &MeshData::front}) {
        const Vec3d first = meshes.front().*direction;
        if (all_have(meshes, [&](const MeshData& mesh) { return mesh.*direction == first; }))
            whole.*direction = first;
    }
    const float voxel_size = meshes.front().voxel_size;
    if (all_have(meshes, [&](const MeshData& mesh) { return mesh.voxel_size == voxel_size; }))
        whole.voxel_size = voxel_size;
    total(meshes, PerElement::face);
    whole.F = joined_indices(meshes, &MeshData::F);
    whole.E = joined_indices(meshes, &MeshData::E);
    whole.source_vertex = joined_sources(meshes, &MeshData::source_vertex, PerElement::vertex);
    whole.source_face = joined_sources(meshes, &MeshData::source_face, PerElement::face);
    join_parts(whole, meshes);
    put_repeated_last(whole, parts);
    of_faces.put_back(whole);
    return {std::move(whole), parts.all_own()};
}

bool has_normals(const MeshData& mesh) {
    return !mesh.N.empty();
}

/// What stands beside others that have normals.
Part with_normals(const MeshData& mesh) {
    Part part = as_it_is(mesh);
    if (mesh.N.empty() && !mesh.F.empty()) add_drawn_normals(part.mesh);
    return part;
}

/// Positions, faces and edges alone.
Part bare_shape(const MeshData& mesh) {
    MeshData shape;
    shape.name = mesh.name;
    shape.V = mesh.V;
    shape.offset = mesh.offset;
    shape.F = mesh.F;
    shape.E = mesh.E;
    return as_it_is(shape);
}

/// A node with vertices. T leads from its V to what is relative to the offset of the tree.
struct PlacedNode {
    std::shared_ptr<const MeshData> data;
    Eigen::Affine3d T;
};

std::vector<PlacedNode> placed_nodes(const Mesh& mesh, const Vec3d& base) {
    std::vector<PlacedNode> nodes;
    for_each_node(mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d& T) {
        if (!data->V.empty()) nodes.push_back({data, T * Eigen::Translation3d(data->offset - base)});
    });
    return nodes;
}

/// What is to be added to the offset of the tree, so that positions moved by poses lose nothing in float32.
/// Zero where none is moved: the arrays are float32 already.
Vec3d shift_of(const std::vector<PlacedNode>& nodes) {
    const auto stays = [](const PlacedNode& node) { return node.T.matrix().isIdentity(0); };
    if (std::ranges::all_of(nodes, stays)) return Vec3d::Zero();
    std::vector<size_t> ends;
    size_t count = 0;
    for (const PlacedNode& node : nodes) ends.push_back(count += size_t(node.data->V.rows()));
    return choose_offset(count, [&](size_t i) -> Vec3d {
        const auto k = size_t(std::ranges::upper_bound(ends, i) - ends.begin());
        const Array3f& V = nodes[k].data->V;
        const auto row = V.rows() - Eigen::Index(ends[k] - i);
        return nodes[k].T * V.row(row).transpose().cast<double>();
    });
}

bool tree_has_normals(const Mesh& mesh) {
    bool has_some = false;
    for_each_node(mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d&) {
        has_some = has_some || has_normals(*data);
    });
    return has_some;
}

/// `taken`: what is taken of each node, before poses distort its angles.
Part flattened(const Mesh& mesh, Part (*taken)(const MeshData&)) {
    const Vec3d base = offset_of_tree(mesh);
    const std::vector<PlacedNode> placed = placed_nodes(mesh, base);
    const Vec3d shift = shift_of(placed);
    Parts nodes;
    for (const PlacedNode& node : placed) {
        Part part = taken(*node.data);
        part.mesh = transformed(part.mesh, Eigen::Translation3d(-shift) * node.T);
        part.mesh.offset = base + shift;
        part.mesh.T_parent_mesh.setIdentity();
        part.mesh.children.clear();
        nodes.add(std::move(part));
    }
    Part whole = joined_parts(nodes);
    const auto root = mesh.snapshot();
    if (!root->up.isZero()) whole.mesh.up = root->T_parent_mesh.linear() * root->up;
    whole.mesh.name = placed.size() == 1 ? placed.front().data->name : mesh.name();
    return whole;
}

}  // namespace

Array3f positions_from(const MeshData& mesh, const Vec3d& offset) {
    if (mesh.V.empty() || mesh.offset == offset) return mesh.V;
    const Eigen::RowVector3d shift = (mesh.offset - offset).transpose();
    return Array3f::Dense((mesh.V.cast<double>().rowwise() + shift).cast<float>());
}

MeshData merged(Meshes meshes) {
    const bool some_have_normals = std::ranges::any_of(meshes, has_normals);
    Parts parts;
    for (const MeshData& mesh : meshes) parts.add(some_have_normals ? with_normals(mesh) : as_it_is(mesh));
    return joined_parts(parts).mesh;
}

Vec3d offset_of_tree(const Mesh& mesh) {
    std::optional<Vec3d> first;
    for_each_node(mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d&) {
        if (!first && !data->V.empty()) first = data->offset;
    });
    return first.value_or(Vec3d::Zero());
}

MeshData flatten(std::span<const Mesh> meshes) {
    const bool some_have_normals = std::ranges::any_of(meshes, tree_has_normals);
    Parts trees;
    for (const Mesh& mesh : meshes) trees.add(flattened(mesh, some_have_normals ? with_normals : as_it_is));
    return joined_parts(trees).mesh;
}

MeshData flatten(const Mesh& mesh) {
    return flatten(std::span(&mesh, 1));
}

MeshData flatten_shape(const Mesh& mesh) {
    return flattened(mesh, bare_shape).mesh;
}

}  // namespace easypbr
