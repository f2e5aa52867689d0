// Meshes as a hierarchy: parents and children.
#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/scene/mesh_shared.h"
#include "easypbr/scene/polygon_values.h"

namespace easypbr {
namespace {

/// Guards who is whose parent, in all hierarchies at once: that a mesh does not contain itself is a property
/// of many meshes. Taken before a mesh's own mutex.
std::mutex& hierarchies() {
    static std::mutex mutex;
    return mutex;
}

bool contains(const std::vector<Mesh>& meshes, const Mesh& mesh) {
    return std::ranges::find(meshes, mesh) != meshes.end();
}

[[noreturn]] void fail_as_circle(const std::string& child, const std::string& parent) {
    throw ArgumentError(fmt::format("mesh '{}' cannot become a child of '{}': it is that mesh or contains it",
                                    child, parent));
}

}  // namespace

Mesh::Mesh(MeshData data) : shared_(std::make_shared<Shared>()) {
    spread_polygon_values(data);
    validate(data);
    shared_->data = std::make_shared<const MeshData>(std::move(data));
    if (shared_->data->children.empty()) return;
    const std::lock_guard lock(hierarchies());
    adopt(shared_->data->children);
}

bool Mesh::exchange(const std::shared_ptr<const MeshData>& expected, std::shared_ptr<const MeshData> next) {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->data != expected) return false;
    shared_->data = std::move(next);
    return true;
}

bool Mesh::replace(const std::shared_ptr<const MeshData>& expected, std::shared_ptr<const MeshData> next) {
    // Those between what both lists begin and end with.
    const auto [gone, come] = std::ranges::mismatch(expected->children, next->children);
    auto gone_end = expected->children.end();
    auto come_end = next->children.end();
    while (gone_end != gone && come_end != come && gone_end[-1] == come_end[-1]) --gone_end, --come_end;
    if (gone == gone_end && come == come_end) return exchange(expected, std::move(next));
    const std::vector<Mesh> removed(gone, gone_end), added(come, come_end);
    const std::lock_guard lock(hierarchies());
    if (is_below(added)) fail_as_circle("a child", next->name);
    if (!exchange(expected, std::move(next))) return false;
    disown(removed);
    adopt(added);
    return true;
}

void Mesh::adopt(const std::vector<Mesh>& children) const {
    for (const Mesh& child : children) {
        auto& parents = child.shared_->parents;
        std::erase_if(parents, [](const std::weak_ptr<Shared>& parent) { return parent.expired(); });
        parents.push_back(shared_);
    }
}

void Mesh::disown(const std::vector<Mesh>& children) const {
    for (const Mesh& child : children) {
        auto& parents = child.shared_->parents;
        const auto own = std::ranges::find_if(
            parents, [&](const std::weak_ptr<Shared>& parent) { return parent.lock() == shared_; });
        if (own != parents.end()) parents.erase(own);
    }
}

bool Mesh::is_below(const std::vector<Mesh>& children, int depth) const {
    return depth > max_mesh_depth || std::ranges::any_of(children, [&](const Mesh& child) {
               return child == *this || is_below(child.children(), depth + 1);
           });
}

std::optional<Mesh> Mesh::parent() const {
    const std::lock_guard lock(hierarchies());
    for (const std::weak_ptr<Shared>& known : shared_->parents)
        if (std::shared_ptr<Shared> parent = known.lock()) return Mesh(std::move(parent));
    return {};
}

void Mesh::add_child(const Mesh& child, bool keep_world_pose) {
    if (child == *this || is_below(child.children())) fail_as_circle(child.name(), name());
    const std::optional<Mesh> current = child.parent();
    if (current && *current == *this) return;
    if (current)
        throw ArgumentError(fmt::format(
            "mesh '{}' cannot become a child of '{}': it is a child of '{}'; remove it there, or add a clone",
            child.name(), name(), current->name()));
    Mesh added = child;
    const Eigen::Affine3d T_world_child = child.T_world_mesh();
    edit([&](MeshData& data) { data.children.push_back(added); });
    if (keep_world_pose) added.set_T_world_mesh(T_world_child);
}

void Mesh::remove_child(const Mesh& child, bool keep_world_pose) {
    Mesh removed = child;
    const Eigen::Affine3d T_world_child = child.T_world_mesh();
    edit([&](MeshData& data) {
        if (!contains(data.children, child))
            throw ArgumentError(fmt::format("mesh '{}' is no child of '{}' and cannot be removed there",
                                            child.name(), data.name));
        std::erase(data.children, child);
    });
    if (keep_world_pose) removed.set_T_world_mesh(T_world_child);
}

Mesh Mesh::clone() const {
    // Refuses a hierarchy that contains itself before following it.
    for_each_node(*this, [](const auto&, const auto&) {});
    MeshData copy = *snapshot();
    for (Mesh& child : copy.children) child = child.clone();
    Mesh result;
    result.shared_->data = std::make_shared<const MeshData>(std::move(copy));
    const std::lock_guard lock(hierarchies());
    result.adopt(result.shared_->data->children);
    return result;
}

}  // namespace easypbr
