#include "easypbr/render/shadow/splat_shadows.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/parallel.h"
#include "easypbr/render/raster/point_splats.h"

namespace easypbr::render {
namespace {

/// Steepest surface, as a tangent, whose points are pushed behind it.
constexpr float steepest = 4;
/// Radii that a lit point's disc is pushed further: pixels of a splat lie beside their surface.
constexpr float push = 1;

double scale_of(const DrawItem& item) {
    return std::cbrt(std::abs(item.object->T_world_mesh.linear().determinant()));
}

/// Where the light is in an item's frame: a position, or (w = 0) the direction towards it.
Vec4 light_in_mesh(const ShadowView& view, const DrawItem& item) {
    const Eigen::Affine3d inverse = item.object->T_world_mesh.inverse();
    const Vec3d v = view.perspective ? Vec3d(inverse * view.position)
                                     : Vec3d(inverse.linear() * -view.R_light_world.row(2).transpose());
    return {float(v.x()), float(v.y()), float(v.z()), view.perspective ? 1.0f : 0.0f};
}

bool is_pushed(const DrawItem& item) {
    return item.kind == SurfaceKind::lit && !item.mesh().N.empty();
}

void set_alpha(const gl::Program& program, const DrawItem& item) {
    program.set("u_opacity", item.material.opacity);
    program.set("u_alpha_cutoff", item.material.alpha_cutoff);
}

std::vector<std::string> alpha_defines(const DrawItem& item) {
    std::vector<std::string> defines;
    if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (item.casts_tint()) defines.emplace_back("TINT");
    if (item.alpha != AlphaMode::opaque && item.with_colors) defines.emplace_back("VERTEX_COLOR");
    return defines;
}

Mat4 clip_from_mesh(const ShadowView& view, const DrawItem& item) {
    return (view.clip_from_world() * item.object->T_world_mesh.matrix()).cast<float>();
}

}  // namespace

double SplatShadows::point_radius(const DrawItem& item) {
    const DrawStyle& style = item.style;
    if (style.point_size && style.point_size_unit == SizeUnit::world) return 0.5 * double(*style.point_size);
    return 0.5 * spacings_per_splat * spacings_.get(item.mesh().V) * scale_of(item);
}

double SplatShadows::surfel_radius(const DrawItem& item) {
    return item.mesh().T.empty() ? spacings_.get(item.mesh().V) : 0;
}

double SplatShadows::reach(const DrawItem& item, bool surfels) {
    if (!surfels) return point_radius(item);
    const MeshData& mesh = item.mesh();
    const double scale =
        item.object->T_world_mesh.linear().colwise().norm().maxCoeff() * item.style.surfel_scale;
    if (mesh.T.empty()) return surfel_radius(item) * scale;
    Reach& known = reaches_[{mesh.T.revision(), mesh.B.revision()}];
    if (!known.used && known.radius == 0) {
        for (Eigen::Index i = 0; i < mesh.T.rows(); ++i) {
            known.radius = std::max(known.radius, double(Vec3(mesh.T.row(i)).norm()));
            if (!mesh.B.empty()) known.radius = std::max(known.radius, double(std::abs(mesh.B(i))));
        }
    }
    known.used = true;
    return known.radius * scale;
}

void SplatShadows::evict_unused() {
    std::erase_if(reaches_, [](const auto& item) { return !item.second.used; });
    for (auto& [key, known] : reaches_) known.used = false;
}

void SplatShadows::draw_points(const ShadowView& view, const DrawItem& item, int resolution,
                               const gl::DrawState& state) {
    const gpu::PointBuffers& buffers = points_.get(item.mesh());
    std::vector<std::string> defines = alpha_defines(item);
    if (is_pushed(item) && buffers.normals) defines.emplace_back("PUSHED");
    if (item.style.point_shape == PointShape::round) defines.emplace_back("ROUND");
    const gl::Program& program = point_programs_.get(defines);
    program.use();
    const double radius = point_radius(item);
    program.set("u_clip_from_mesh", clip_from_mesh(view, item));
    program.set("u_diameter", Vec2((2 * radius * resolution * view.scale).cast<float>()));
    program.set("u_light", light_in_mesh(view, item));
    program.set("u_push", Vec3(float(radius / scale_of(item)), steepest, push));
    set_alpha(program, item);
    gl::draw_points(state, buffers.array, int(item.mesh().V.rows()));
}

void SplatShadows::draw_surfels(const ShadowView& view, const DrawItem& item, const gl::DrawState& state) {
    const gpu::SurfelBuffers& buffers = surfels_.get(item.mesh());
    const gl::Program& program = surfel_programs_.get(alpha_defines(item));
    program.use();
    program.set("u_clip_from_mesh", clip_from_mesh(view, item));
    program.set("u_light", light_in_mesh(view, item));
    program.set("u_surfel", Vec2(item.style.surfel_scale, float(surfel_radius(item))));
    set_alpha(program, item);
    gl::draw_quads(state, buffers.array, int(item.mesh().V.rows()));
}

void SplatShadows::draw_points_natively(const ShadowView& view, const DrawItem& item,
                                        VisibilityBuffer& visibility) {
    const MeshData& mesh = item.mesh();
    const double radius = point_radius(item);
    PointSplats splats;
    splats.clip_from_mesh = clip_from_mesh(view, item);
    splats.world_pixels = float(2 * radius * view.scale.x() * visibility.area().width);
    splats.y_per_x = float(view.scale.y() / view.scale.x());
    splats.least_pixels = 1;
    splats.round = item.style.point_shape == PointShape::round;
    const auto same = [](uint32_t) -> uint64_t { return 0; };
    if (!is_pushed(item)) return visibility.draw_points(mesh.V, splats, 0, same);
    const Vec4 light = light_in_mesh(view, item);
    const float r = float(radius / scale_of(item));
    Array3f::Dense pushed(mesh.V.rows(), 3);
    parallel_for(size_t(mesh.V.rows()), 1 << 12, [&](size_t i) {
        const Vec3 p = mesh.V.row(Eigen::Index(i)), n = mesh.N.row(Eigen::Index(i));
        const Vec3 l = (light.head<3>() - light.w() * p).normalized();
        const float c = std::abs(n.dot(l)) / std::max(n.norm(), 1e-20f);
        const float tangent = std::sqrt(std::max(0.0f, 1 - c * c)) / std::max(c, 1e-3f);
        pushed.row(Eigen::Index(i)) = p - l * (r * (std::min(tangent, steepest) + push));
    });
    visibility.draw_points(Array3f(std::move(pushed)), splats, 0, same);
}

}  // namespace easypbr::render
