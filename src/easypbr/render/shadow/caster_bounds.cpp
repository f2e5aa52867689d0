#include "easypbr/render/shadow/caster_bounds.h"

#include <algorithm>

namespace easypbr::render {
namespace {

std::vector<Eigen::Index> without_faces(const MeshData& mesh) {
    std::vector<uint8_t> has_face(size_t(mesh.V.rows()), 0);
    for (Eigen::Index face = 0; face < mesh.F.rows(); ++face)
        for (int c = 0; c < 3; ++c) has_face[size_t(mesh.F(face, c))] = 1;
    std::vector<Eigen::Index> unused;
    for (size_t i = 0; i < has_face.size(); ++i)
        if (!has_face[i]) unused.push_back(Eigen::Index(i));
    return unused;
}

const std::shared_ptr<const MeshData>& mesh_of(const DrawItem& item) {
    return item.data ? item.data : item.object->mesh;
}

/// Calls visit(item, mode, reach) for items whose bounds differ: the parts of a mesh have the same.
template <class Visit>
void for_each_caster(const DrawList& casters, const Primitives& primitives, Visit&& visit) {
    for (const auto& kind : primitives) {
        const SceneSnapshot::Object* last = nullptr;  // the parts of a mesh follow each other
        for (const DrawItem& item : casters.of(kind->mode())) {
            if (!item.data && item.object == last) continue;
            last = item.data ? nullptr : item.object;
            visit(item, kind->mode(), kind->reach(item));
        }
    }
}

}  // namespace

std::shared_ptr<const MeshData> CasterBounds::used(const DrawItem& item, DrawMode kind) {
    const std::shared_ptr<const MeshData>& mesh = mesh_of(item);
    if (kind != DrawMode::mesh || mesh->F.empty()) return mesh;
    const Vertices& unused =
        unused_.get({mesh->F.revision(), mesh->V.rows()}, [&] { return without_faces(*mesh); });
    if (unused.empty()) return mesh;
    return meshes_.get({mesh->V.revision(), mesh->F.revision()}, [&] {
        // Those are moved to a vertex that has one.
        Array3f::Dense V = mesh->V;
        for (const Eigen::Index i : unused) V.row(i) = mesh->V.row(mesh->F(0, 0));
        MeshData moved;
        moved.V = Array3f(V);
        moved.F = mesh->F;
        return std::make_shared<const MeshData>(std::move(moved));
    });
}

CasterExtent CasterBounds::extent_of(const DrawItem& item, DrawMode kind, double reach) {
    SceneSnapshot one;
    one.objects = {*item.object};
    one.objects.front().mesh = used(item, kind);
    CasterExtent extent{one.bounds(), reach, {}};
    if (kind != DrawMode::mesh || item.data || extent.box.isEmpty()) return extent;
    const MeshData& mesh = *one.objects.front().mesh;
    const Eigen::Affine3d& T = item.object->T_world_mesh;
    const Mat3d normal_matrix = T.linear().inverse().transpose();
    for (const FacePlane& plane :
         planes_.get({mesh.V.revision(), mesh.F.revision()}, [&] { return convex_faces(mesh.V, mesh.F); })) {
        const Vec3d normal = (normal_matrix * plane.normal).normalized();
        if (normal.allFinite())
            extent.planes.push_back({normal, normal.dot(T * (plane.normal * plane.offset))});
    }
    return extent;
}

const CasterSet& CasterBounds::of(const DrawList& casters, const Primitives& primitives) {
    std::vector<Caster> now;
    objects_.clear();
    for_each_caster(casters, primitives, [&](const DrawItem& item, DrawMode kind, double reach) {
        const MeshData& mesh = *mesh_of(item);
        now.push_back(
            {mesh.V.revision(), mesh.F.revision(), kind, reach, item.object->T_world_mesh.matrix(), false});
        objects_.push_back(item.object);
    });
    note_what_is_seen_into(casters, now);
    if (now == casters_) return set_;
    casters_.clear();  // until all is there: it can be interrupted
    set_ = {};
    std::vector<CasterExtent> extents;
    for_each_caster(casters, primitives, [&](const DrawItem& item, DrawMode kind, double reach) {
        const bool may_be_left_out = !now[extents.size()].seen_into;
        extents.push_back(extent_of(item, kind, reach));
        if (!may_be_left_out) extents.back().planes.clear();
    });
    unused_.evict_unused();
    meshes_.evict_unused();
    planes_.evict_unused();
    set_ = CasterSet(std::move(extents));
    casters_ = std::move(now);
    return set_;
}

void CasterBounds::note_what_is_seen_into(const DrawList& casters, std::vector<Caster>& noted) const {
    // What an object draws besides its faces would be left out with them.
    std::vector<const SceneSnapshot::Object*> all = objects_, seen_into;
    std::ranges::sort(all);
    for (size_t i = 1; i < all.size(); ++i)
        if (all[i] == all[i - 1]) seen_into.push_back(all[i]);
    for (const DrawItem& item : casters.of(DrawMode::mesh))
        if (item.alpha != AlphaMode::opaque || item.casts_tint()) seen_into.push_back(item.object);
    if (seen_into.empty()) return;
    std::ranges::sort(seen_into);
    for (size_t i = 0; i < noted.size(); ++i)
        noted[i].seen_into = std::ranges::binary_search(seen_into, objects_[i]);
}

}  // namespace easypbr::render
