#include "easypbr/render/primitives/surfels/surfel_shadows.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/parallel.h"
#include "easypbr/render/primitives/splat_casters.h"
#include "easypbr/render/primitives/surfels/surfel_projection.h"
#include "easypbr/render/primitives/vertex_alpha.h"

namespace easypbr::render {
namespace {

constexpr size_t surfel_grain = 1 << 12;
/// Parts of its longer semi-axis that a surfel is pushed away from the light: behind the surface that bends
/// within it, which must not shadow its neighbours.
constexpr float semi_axes_pushed = 0.25f;

Mat3 linear_of(const DrawItem& item) {
    return item.object->T_world_mesh.linear().cast<float>();
}

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

auto SurfelShadows::ellipses_of(const ShadowView& view, const DrawItem& item, int resolution) {
    const Mat4d clip_from_mesh = view.clip_from_world() * item.object->T_world_mesh.matrix();
    return [&mesh = item.mesh(), clip_from_mesh, linear = linear_of(item), light = light_in_mesh(view, item),
            resolution, radius = float(radius(item)), scale = item.style.surfel_scale](size_t i) {
        const Vec3 at = mesh.V.row(Eigen::Index(i));
        const Vec3 to_light = (light.head<3>() - light.w() * at).normalized();
        const auto [t, b] = surfel_axes(mesh, Eigen::Index(i), to_light, radius, scale);
        const float longer = std::max((linear * t).norm(), (linear * b).norm());
        const Vec3 p = at - to_light * (semi_axes_pushed * longer / (linear * to_light).norm());
        const auto clip = [&](const Vec3& v, double one) {
            return Eigen::Vector4d(clip_from_mesh * Eigen::Vector4d(v.x(), v.y(), v.z(), one));
        };
        return ScreenEllipse(clip(p, 1), clip(t, 0), clip(b, 0), resolution);
    };
}

void SurfelShadows::rasterise(const ShadowView& view, Casters& casters, ShadowDepths& depths) {
    const int size = depths.resolution();
    for (const DrawItem* item : casters) {
        const auto ellipse = ellipses_of(view, *item, size);
        const auto is_drawn = drawn_vertices(*item);
        DepthBuffer& buffer = depths.buffer();
        parallel_for(size_t(item->mesh().V.rows()), surfel_grain, [&](size_t i) {
            if (is_drawn && !is_drawn(i)) return;
            ellipse(i).cover({0, 0, size, size}, [&](int column, int row, float depth) {
                buffer.put(size_t(row) * size_t(size) + size_t(column), depth);
            });
        });
    }
    casters.clear();
}

void SurfelShadows::rasterise_tints(const ShadowView& view, const Casters& casters, TintLayer& layer) {
    const auto cover = [](const ScreenEllipse& ellipse, const PixelRect& part, const auto& put) {
        ellipse.cover(part, put);
    };
    for (const DrawItem* item : casters)
        layer.draw_splats(size_t(item->mesh().V.rows()), ellipses_of(view, *item, layer.resolution()), cover,
                          [&](size_t i) { return absorbed_by(vertex_alpha(*item, i)); });
}

void SurfelShadows::draw(const ShadowLayer& layer, const Casters& casters) {
    for (const DrawItem* item : casters) {
        const SurfelBuffers& buffers = surfels_.get(item->mesh());
        const gl::Program& program = programs_.get(caster_defines(*item));
        program.use();
        program.set("u_clip_from_mesh", layer.clip_from_mesh(*item));
        program.set("u_world_from_mesh", linear_of(*item));
        program.set("u_light", light_in_mesh(layer.view, *item));
        program.set("u_surfel", Vec2(item->style.surfel_scale, float(radius(*item))));
        set_caster_alpha(program, *item);
        gl::draw_quads(layer.state(), buffers.array, int(item->mesh().V.rows()));
    }
}

}  // namespace easypbr::render
