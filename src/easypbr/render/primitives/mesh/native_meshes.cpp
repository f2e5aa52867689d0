#include "easypbr/render/primitives/mesh/native_meshes.h"

#include <algorithm>

#include "easypbr/gpu/facing.h"
#include "easypbr/scene/normals.h"

namespace easypbr::render {
namespace {

Mat4d clip_from(const Frame& frame, const DrawItem& item) {
    return frame.clip_from_view * frame.camera.view() * item.object->T_world_mesh.matrix();
}

ScreenTriangles triangles_of(const Frame& frame, const DrawItem& item, const MeshFacts& known,
                             const Mat4d& clip_from_mesh) {
    const MeshData& mesh = item.mesh();
    const bool both_sides =
        item.two_sided && (item.style.flat || !known.closed_outward ||
                           !gpu::beyond_near_plane(frame.camera, item.object->T_world_mesh, known.box));
    const bool mirrored = item.object->T_world_mesh.linear().determinant() < 0;
    return {mesh.V,     mesh.F,  item.part.first_face, item.part.face_count, clip_from_mesh.cast<float>(),
            both_sides, mirrored};
}

}  // namespace

bool NativeMeshes::draws(DrawItems items) {
    return std::ranges::none_of(items, [](const DrawItem& item) {
        return item.textured() || item.emits() || item.extensions() || item.alpha != AlphaMode::opaque;
    });
}

const MeshFacts& NativeMeshes::facts_of(const MeshData& mesh) {
    MeshFacts& known = facts_.get({mesh.V.revision(), mesh.N.revision(), mesh.F.revision()}, [&] {
        MeshFacts made;
        made.N = mesh.N.empty() ? smooth_normals(mesh) : mesh.N;
        made.normals_agree = mesh.N.empty() || gpu::normals_agree_with_winding(mesh.V, made.N, mesh.F);
        return made;
    });
    known.closed_outward = closed_.draw(mesh);
    if (known.closed_outward && known.box.isEmpty()) known.box = gpu::box_of(mesh.V);
    return known;
}

bool NativeMeshes::rasterise(const Frame& frame, DrawItems items, VisibleSurfaces& surfaces) {
    for (const DrawItem& item : items) {
        if (!surfaces.has_room(item.part.face_count)) return false;
        const MeshFacts& known = facts_of(item.mesh());
        const Mat4d clip_from_mesh = clip_from(frame, item);
        const uint32_t first = surfaces.add(item, uint32_t(item.part.face_count),
                                            std::make_unique<MeshSurface>(item, known, clip_from_mesh));
        if (!surfaces.buffer().draw(triangles_of(frame, item, known, clip_from_mesh), first)) return false;
    }
    return true;
}

bool NativeMeshes::cover(const Frame& frame, DrawItems items, std::span<uint8_t> covered) {
    TriangleRaster raster;
    raster.set_area(frame.size, frame.whole());
    return std::ranges::all_of(items, [&](const DrawItem& item) {
        if (item.alpha != AlphaMode::opaque || item.material.shader) return false;
        return render::cover(raster, triangles_of(frame, item, facts_of(item.mesh()), clip_from(frame, item)),
                             covered);
    });
}

}  // namespace easypbr::render
