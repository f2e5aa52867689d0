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

}  // namespace

std::shared_ptr<const MeshData> CasterBounds::used(const DrawItem& item, DrawMode kind) {
    std::shared_ptr<const MeshData> mesh = item.data ? item.data : item.object->mesh;
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
    Box3d bounds;
    for (const auto& kind : primitives) {
        const SceneSnapshot::Object* last = nullptr;  // the parts of a mesh follow each other
        for (const DrawItem& item : casters.of(kind->mode())) {
            if (!item.data && item.object == last) continue;
            last = item.data ? nullptr : item.object;
            SceneSnapshot one;
            one.objects = {*item.object};
            one.objects.front().mesh = used(item, kind->mode());
            const Box3d box = one.bounds();
            if (box.isEmpty()) continue;
            const Vec3d reach = Vec3d::Constant(kind->reach(item));
            bounds.extend(Box3d(box.min() - reach, box.max() + reach));
        }
    }
    unused_.evict_unused();
    meshes_.evict_unused();
    return bounds;
}

}  // namespace easypbr::render
