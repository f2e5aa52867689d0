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

Box3d CasterBounds::of(const DrawList& casters, const Primitives& primitives) {
    std::vector<Caster> now;
    for_each_caster(casters, primitives, [&](const DrawItem& item, DrawMode kind, double reach) {
        const MeshData& mesh = *mesh_of(item);
        now.push_back(
            {mesh.V.revision(), mesh.F.revision(), kind, reach, item.object->T_world_mesh.matrix()});
    });
    if (now == casters_) return bounds_;
    Box3d bounds;
    for_each_caster(casters, primitives, [&](const DrawItem& item, DrawMode kind, double reach) {
        SceneSnapshot one;
        one.objects = {*item.object};
        one.objects.front().mesh = used(item, kind);
        const Box3d box = one.bounds();
        if (box.isEmpty()) return;
        const Vec3d margin = Vec3d::Constant(reach);
        bounds.extend(Box3d(box.min() - margin, box.max() + margin));
    });
    unused_.evict_unused();
    meshes_.evict_unused();
    casters_ = std::move(now);
    return bounds_ = bounds;
}

}  // namespace easypbr::render
