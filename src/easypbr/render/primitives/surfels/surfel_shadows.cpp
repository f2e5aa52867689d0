#include "easypbr/render/primitives/surfels/surfel_shadows.h"

#include <algorithm>
#include <cmath>

#include "easypbr/render/primitives/splat_casters.h"

namespace easypbr::render {
namespace {

/// Of all surfels, in the mesh's units.
double longest_axis(const MeshData& mesh) {
    double longest = 0;
    for (Eigen::Index i = 0; i < mesh.T.rows(); ++i) {
        longest = std::max(longest, double(Vec3(mesh.T.row(i)).norm()));
        if (!mesh.B.empty()) longest = std::max(longest, double(std::abs(mesh.B(i))));
    }
    return longest;
}

}  // namespace

double SurfelShadows::radius(const DrawItem& item) {
    return item.mesh().T.empty() ? spacings_.get(item.mesh().V) : 0;
}

double SurfelShadows::reach(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    const double scale =
        item.object->T_world_mesh.linear().colwise().norm().maxCoeff() * item.style.surfel_scale;
    if (mesh.T.empty()) return radius(item) * scale;
    return scale * reaches_.get({mesh.T.revision(), mesh.B.revision()}, [&] { return longest_axis(mesh); });
}

void SurfelShadows::draw(const ShadowLayer& layer, const Casters& casters) {
    for (const DrawItem* item : casters) {
        const SurfelBuffers& buffers = surfels_.get(item->mesh());
        const gl::Program& program = programs_.get(caster_defines(*item));
        program.use();
        program.set("u_clip_from_mesh", layer.clip_from_mesh(*item));
        program.set("u_light", light_in_mesh(layer.view, *item));
        program.set("u_surfel", Vec2(item->style.surfel_scale, float(radius(*item))));
        set_caster_alpha(program, *item);
        gl::draw_quads(layer.state(), buffers.array, int(item->mesh().V.rows()));
    }
}

}  // namespace easypbr::render
