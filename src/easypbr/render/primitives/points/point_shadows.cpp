#include "easypbr/render/primitives/points/point_shadows.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/parallel.h"
#include "easypbr/render/primitives/points/point_splats.h"
#include "easypbr/render/primitives/splat_casters.h"
#include "easypbr/render/primitives/vertex_alpha.h"

namespace easypbr::render {
namespace {

/// Steepest surface, as a tangent, whose points are pushed behind it.
constexpr float steepest = most_pushed - 1;
/// Radii that a lit point's disc is pushed further: pixels of a splat lie beside their surface.
constexpr float push = 1;
static_assert(steepest + push == most_pushed);

bool is_pushed(const DrawItem& item) {
    return item.kind == SurfaceKind::lit && !item.mesh().N.empty();
}

}  // namespace

double PointShadows::radius(const DrawItem& item) {
    const DrawStyle& style = item.style;
    if (style.point_size && style.point_size_unit == SizeUnit::world) return 0.5 * double(*style.point_size);
    return 0.5 * spacings_.discs(item.mesh().V).diameter * item.scale();
}

void PointShadows::draw(const ShadowLayer& layer, const Casters& casters) {
    for (const DrawItem* item : casters) draw(layer, *item);
}

void PointShadows::draw(const ShadowLayer& layer, const DrawItem& item) {
    const PointBuffers& buffers = points_.get(item.mesh());
    std::vector<std::string> defines = caster_defines(item);
    if (is_pushed(item) && buffers.normals) defines.emplace_back("PUSHED");
    if (item.style.point_shape == PointShape::round) defines.emplace_back("ROUND");
    const gl::Program& program = programs_.get(defines);
    program.use();
    const double r = radius(item);
    program.set("u_clip_from_mesh", layer.clip_from_mesh(item));
    program.set("u_diameter", Vec2((2 * r * layer.resolution * layer.view.scale).cast<float>()));
    program.set("u_light", light_in_mesh(layer.view, item));
    program.set("u_push", Vec3(float(r / item.scale()), steepest, push));
    set_caster_alpha(program, item);
    gl::draw_points(layer.state(), buffers.array, int(item.mesh().V.rows()));
}

void PointShadows::rasterise(const ShadowView& view, Casters& casters, ShadowDepths& depths) {
    const int size = depths.resolution();
    const auto same = [](uint32_t id) { return PointRank{0, id}; };
    visibility_.clear(Vec2i(size, size), {0, 0, size, size});
    for (const DrawItem* item : casters)
        visibility_.draw_points(centres_of(view, *item), splats_of({view, size}, *item), 0, same);
    depths.buffer().add(visibility_);
    casters.clear();
}

void PointShadows::rasterise_tints(const ShadowView& view, const Casters& casters, TintLayer& layer) {
    for (const DrawItem* item : casters)
        layer.draw_points(centres_of(view, *item), splats_of({view, layer.resolution()}, *item),
                          [&](size_t point) { return absorbed_by(vertex_alpha(*item, point)); });
}

PointSplats PointShadows::splats_of(const ShadowLayer& layer, const DrawItem& item) {
    const ShadowView& view = layer.view;
    PointSplats splats;
    splats.clip_from_mesh = layer.clip_from_mesh(item);
    splats.world_pixels = float(2 * radius(item) * view.scale.x() * layer.resolution);
    splats.y_per_x = float(view.scale.y() / view.scale.x());
    splats.least_pixels = 1;
    splats.round = item.style.point_shape == PointShape::round;
    splats.is_drawn = drawn_vertices(item);
    return splats;
}

Array3f PointShadows::centres_of(const ShadowView& view, const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    if (!is_pushed(item)) return mesh.V;
    const Vec4 light = light_in_mesh(view, item);
    const float in_mesh = float(radius(item) / item.scale());
    Array3f::Dense pushed(mesh.V.rows(), 3);
    parallel_for(size_t(mesh.V.rows()), 1 << 12, [&](size_t i) {
        const Vec3 p = mesh.V.row(Eigen::Index(i)), n = mesh.N.row(Eigen::Index(i));
        const Vec3 l = (light.head<3>() - light.w() * p).normalized();
        const float c = std::abs(n.dot(l)) / std::max(n.norm(), 1e-20f);
        const float tangent = std::sqrt(std::max(0.0f, 1 - c * c)) / std::max(c, 1e-3f);
        pushed.row(Eigen::Index(i)) = p - l * (in_mesh * (std::min(tangent, steepest) + push));
    });
    return Array3f(std::move(pushed));
}

}  // namespace easypbr::render
