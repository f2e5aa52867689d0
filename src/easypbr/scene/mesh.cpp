#include "easypbr/scene/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/mesh_shared.h"
#include "easypbr/scene/offset.h"
#include "easypbr/scene/polygon_values.h"
#include "easypbr/scene/rounding.h"

namespace easypbr {
namespace {

/// Meshes within whose functions of edit() this thread is, the innermost last.
thread_local std::vector<uint64_t> edited_meshes;

/// While one lives, this thread is within a function that edits a mesh. Throws ArgumentError when it is
/// within one of the same mesh already, whose data would never be the newest.
class EditScope {
  public:
    EditScope(uint64_t mesh, const std::string& name) {
        if (std::ranges::find(edited_meshes, mesh) != edited_meshes.end())
            throw ArgumentError(
                fmt::format("mesh '{}': edited within a function that edits it: change the data that the "
                            "function is given",
                            name));
        edited_meshes.push_back(mesh);
    }
    ~EditScope() { edited_meshes.pop_back(); }
    EditScope(const EditScope&) = delete;
    EditScope& operator=(const EditScope&) = delete;
};

using NodeVisitor = std::function<void(const std::shared_ptr<const MeshData>&, const Eigen::Affine3d&)>;

void visit_node(const Mesh& mesh, const Eigen::Affine3d& T_world_parent, const NodeVisitor& visit,
                int depth) {
    require_mesh_depth(depth);
    const auto data = mesh.snapshot();
    const Eigen::Affine3d T_world_mesh = T_world_parent * data->T_parent_mesh;
    visit(data, T_world_mesh);
    for (const Mesh& child : data->children) visit_node(child, T_world_mesh, visit, depth + 1);
}

}  // namespace

MeshList::MeshList() = default;
MeshList::MeshList(std::vector<Mesh> meshes) : std::vector<Mesh>(std::move(meshes)) {}
MeshList::MeshList(std::initializer_list<Mesh> meshes) : std::vector<Mesh>(meshes) {}
MeshList::MeshList(const MeshList& other) = default;
MeshList::MeshList(MeshList&& other) noexcept = default;
MeshList& MeshList::operator=(const MeshList& other) = default;
MeshList& MeshList::operator=(MeshList&& other) noexcept = default;
MeshList::~MeshList() = default;

void require_mesh_depth(int depth) {
    if (depth > max_mesh_depth)
        throw ArgumentError(fmt::format(
            "mesh hierarchy: expected at most {} levels; is a mesh its own descendant?", max_mesh_depth));
}

Mesh::Mesh() : Mesh(MeshData{}) {}

Mesh::Mesh(Array3f V, Array3i F)
    : Mesh([&] {
          MeshData data;
          data.V = V;
          data.F = F;
          return data;
      }()) {}

MeshData Mesh::recentred(const Array3d& V, const Array3i& F) {
    const LocalPositions local = local_positions(V);
    MeshData data;
    data.V = local.V;
    data.offset = local.offset;
    data.F = F;
    return data;
}

uint64_t Mesh::identity() const {
    return shared_->identity;
}

std::shared_ptr<const MeshData> Mesh::snapshot() const {
    std::lock_guard lock(shared_->mutex);
    return shared_->data;
}

void Mesh::edit(const std::function<void(MeshData&)>& change) {
    for (;;) {
        const std::shared_ptr<const MeshData> before = snapshot();
        MeshData next = *before;
        {
            const EditScope scope(shared_->identity, next.name);
            change(next);
        }
        drop_stale_tangents(next, *before);
        spread_polygon_values(next);
        validate(next, *before);
        if (replace(before, std::make_shared<const MeshData>(std::move(next)))) return;
    }
}

void Mesh::set_positions(
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>& positions) {
    const LocalPositions local = local_positions(positions);
    edit([&](MeshData& data) {
        data.V = local.V;
        data.offset += local.offset;
    });
}

Material Mesh::material(int index) const {
    const auto data = snapshot();
    if (index == 0 && data->materials.empty()) return Material{};
    if (index < 0 || size_t(index) >= data->materials.size())
        throw NameError(fmt::format("mesh '{}' has no material {}: it has {}", data->name, index,
                                    data->materials.size()));
    return data->materials[size_t(index)];
}

void Mesh::set_material(const Material& material, int index) {
    edit([&](MeshData& data) {
        if (index < 0 || size_t(index) > data.materials.size())
            throw NameError(fmt::format("mesh '{}': expected a material index from 0 to {}, got {}",
                                        data.name, data.materials.size(), index));
        if (size_t(index) == data.materials.size()) data.materials.emplace_back();
        data.materials[size_t(index)] = material;
    });
}

void Mesh::add_scalar(const std::string& name, Array1f values) {
    add_scalars({ScalarArray{name, values}});
}

void Mesh::add_doubles(const std::string& name, const Array1d& values) {
    add_scalar(name, Array1f(values));
    warn_of_rounding("", name, rounding_of({values.data(), size_t(values.rows())}));
}

void Mesh::add_scalars(const std::vector<ScalarArray>& scalars) {
    edit([&](MeshData& data) {
        for (const ScalarArray& scalar : scalars) {
            const auto found = std::ranges::find(data.scalars, scalar.name, &ScalarArray::name);
            if (found != data.scalars.end())
                found->values = scalar.values;
            else
                data.scalars.push_back(scalar);
        }
    });
}

void Mesh::remove_scalar(const std::string& name) {
    edit([&](MeshData& data) {
        const ScalarArray& scalar = scalar_named(data, name);
        data.scalars.erase(data.scalars.begin() + (&scalar - data.scalars.data()));
    });
}

void for_each_node(const Mesh& root, const NodeVisitor& visit) {
    visit_node(root, Eigen::Affine3d::Identity(), visit, 0);
}

}  // namespace easypbr
