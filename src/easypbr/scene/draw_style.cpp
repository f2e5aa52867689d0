#include "easypbr/scene/draw_style.h"

#include "easypbr/core/recent_values.h"
#include "easypbr/scene/enum_names.h"
#include "easypbr/scene/spacing.h"

namespace easypbr {
namespace {

/// Picks a field of the overrides, the object's own, or nothing.
class Choice {
  public:
    Choice(const Style& overrides, const Style& own) : overrides_(overrides), own_(own) {}

    template <class T>
    std::optional<T> operator()(Override<T> Style::*field) const {
        const std::optional<T>& given = (overrides_.*field).value();
        return given ? given : (own_.*field).value();
    }

    template <class T>
    T operator()(Override<T> Style::*field, T otherwise) const {
        return (*this)(field).value_or(otherwise);
    }

  private:
    const Style &overrides_, &own_;
};

/// Clouds whose spacing is kept.
constexpr size_t most_spacings = 1 << 10;

/// As they are drawn: by the spacing of the points where nobody says how large they are.
double voxel_size_of(const MeshData& mesh, const DrawStyle& style) {
    if (style.voxel_size) return double(*style.voxel_size);
    static RecentValues<uint64_t, double> known(most_spacings);
    const double spacing = known.get(mesh.V.revision(), [&] { return point_spacing(mesh.V); });
    return spacing > 0 ? spacing : 1;
}

}  // namespace

template <>
const std::vector<std::string>& detail::enum_names<DrawMode>() {
    static const std::vector<std::string> names = {"mesh", "points", "surfels", "lines", "voxels", "splats"};
    return names;
}

DrawMode natural_mode(const MeshData& mesh) {
    if (mesh.voxel_size > 0) return DrawMode::voxels;
    if (!mesh.splats.empty()) return DrawMode::splats;
    if (!mesh.F.empty()) return DrawMode::mesh;
    if (!mesh.N.empty() && !mesh.T.empty()) return DrawMode::surfels;
    return mesh.E.empty() ? DrawMode::points : DrawMode::lines;
}

bool draws_discs(DrawMode mode) {
    return mode == DrawMode::surfels;
}

DrawStyle resolve_style(const MeshData& mesh, const Style& overrides) {
    const Choice choice(overrides, mesh.style);
    DrawStyle style;
    style.mode = choice(&Style::mode, natural_mode(mesh));
    style.visible = choice(&Style::visible, true);
    style.point_size = choice(&Style::point_size);
    style.point_size_unit = choice(&Style::point_size_unit, SizeUnit::pixels);
    style.point_shape = choice(&Style::point_shape, PointShape::round);
    style.surfel_scale = choice(&Style::surfel_scale, 1.0f);
    style.splat_antialias = choice(&Style::splat_antialias, false);
    style.voxel_size = choice(&Style::voxel_size);
    if (!style.voxel_size && mesh.voxel_size > 0) style.voxel_size = mesh.voxel_size;
    style.line_width = choice(&Style::line_width, style.line_width);
    style.line_dash = choice(&Style::line_dash, 0.0f);
    style.line_color = choice(&Style::line_color);
    style.show_wireframe = choice(&Style::show_wireframe, false);
    style.show_normals = choice(&Style::show_normals, false);
    style.normal_length = choice(&Style::normal_length);
    style.show_points = choice(&Style::show_points, false);
    style.two_sided = choice(&Style::two_sided);
    style.flat = choice(&Style::flat, false);
    style.lit = choice(&Style::lit);
    style.overlay = choice(&Style::overlay, false);
    return style;
}

void set_reach(SceneSnapshot::Object& object, const Style& overrides) {
    const MeshData& mesh = *object.mesh;
    object.half_voxel = object.point_radius = 0;
    if (mesh.V.empty()) return;
    const DrawStyle style = resolve_style(mesh, overrides);
    if (style.mode == DrawMode::voxels) object.half_voxel = voxel_size_of(mesh, style) / 2;
    const bool has_points = style.show_points || primitive_of(mesh, style) == DrawMode::points;
    if (has_points && style.point_size && style.point_size_unit == SizeUnit::world)
        object.point_radius = double(*style.point_size) / 2;
}

bool changes_reach(const Style& overrides) {
    return overrides.mode.value() || overrides.voxel_size.value() || overrides.show_points.value() ||
           overrides.point_size.value() || overrides.point_size_unit.value();
}

DrawMode primitive_of(const MeshData& mesh, const DrawStyle& style) {
    if (style.mode == DrawMode::voxels) return DrawMode::mesh;
    if (style.mode == DrawMode::surfels && mesh.N.empty()) return DrawMode::points;
    if (style.mode == DrawMode::splats && mesh.splats.empty()) return DrawMode::points;
    return style.mode;
}

}  // namespace easypbr
