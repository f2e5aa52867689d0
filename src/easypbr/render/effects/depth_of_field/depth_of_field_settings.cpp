// The rows of the table for the thin lens, and what is inferred.
#include <algorithm>

#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

namespace {

/// The sensor's height as a part of the content's diagonal: a full-frame camera before a bust.
constexpr double sensor_part = 0.05;

}  // namespace

void add_depth_of_field(Table& table) {
    table.push_back(make("depth_of_field.enabled", EASYPBR_AT(depth_of_field.enabled),
                         "Enables depth of field of a thin lens; perspective cameras only."));
    table.push_back(make("depth_of_field.f_number", EASYPBR_AT(depth_of_field.f_number),
                         "Aperture in f-stops, focal length / aperture diameter; smaller values blur more.",
                         "", {0.1, 1000}));
    table.push_back(
        not_kept(make("depth_of_field.focus_distance", EASYPBR_AT(depth_of_field.focus_distance),
                      "Distance to the focal plane along the optical axis; automatic: the centre of the "
                      "content, evaluated for every image.",
                      "world units", {positive, unlimited})));
    table.push_back(make("depth_of_field.sensor_height", EASYPBR_AT(depth_of_field.sensor_height),
                         "Sensor height, 0.024 for a full-frame camera if the world unit is the metre; "
                         "automatic: 5 % of the diagonal of the bounding box of the content.",
                         "world units", {positive, unlimited}));
}

/// Thin lens: an image at distance v behind it, with the field of view that the camera has, of what is in
/// focus.
void infer(DepthOfFieldSettings& lens, const EffectContext& context) {
    ResolvedSettings& resolved = context.resolved;
    const Content& content = context.content;
    const Camera& camera = resolved.camera;
    if (!lens.sensor_height.value())
        fill(lens.sensor_height, std::max(sensor_part * 2 * content.radius(), 1e-30));
    const bool is_on = lens.enabled && camera.projection != Projection::orthographic;
    // The content's bounds are not worth their time where nothing is out of focus.
    const Vec3d centre = is_on ? content.centre() : *context.settings.camera.target;
    const double depth = -camera.T_world_cam.linear().col(2).dot(centre - camera.position());
    fill(lens.focus_distance, std::max(depth, 2 * camera.near));
    if (!is_on) return;
    const double aspect = double(context.size.x()) / context.size.y();
    const double half_slope = 1 / camera.projection_matrix(aspect)(1, 1);
    const double v = *lens.sensor_height / (2 * half_slope), z = *lens.focus_distance;
    const double focal_length = v * z / (v + z);
    resolved.lens_radius = focal_length / lens.f_number / 2;
}

}  // namespace easypbr::detail
