// The rows of the table for outlines, and what is inferred.
#include <algorithm>

#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {
namespace {

/// Of the diagonal of the content's bounding box.
constexpr double depth_part = 0.01;

}  // namespace

void add_outline(Table& table) {
    table.push_back(make("outline.enabled", EASYPBR_AT(outline.enabled),
                         "Enables outlines: unlit lines along the edges of opaque surfaces in the image, "
                         "drawn after tone mapping."));
    table.push_back(
        make("outline.width", EASYPBR_AT(outline.width), "Width of outlines.", "pixels", {0.5, 16}));
    table.push_back(color("outline.color", EASYPBR_AT(outline.color), "Color of outlines."));
    table.push_back(make("outline.silhouettes", EASYPBR_AT(outline.silhouettes),
                         "Draws outlines at depth discontinuities."));
    table.push_back(make("outline.creases", EASYPBR_AT(outline.creases),
                         "Draws outlines where the normals of neighbouring pixels differ by more than "
                         "outline.crease_angle_deg."));
    table.push_back(make("outline.objects", EASYPBR_AT(outline.objects), "Draws outlines between objects."));
    table.push_back(make("outline.crease_angle_deg", EASYPBR_AT(outline.crease_angle_deg),
                         "Least angle between the normals of a crease.", "degrees", {1, 180}));
    table.push_back(make("outline.depth_step", EASYPBR_AT(outline.depth_step),
                         "Least depth discontinuity of a silhouette; automatic: 1 % of the diagonal of the "
                         "bounding box of the content.",
                         "world units", {positive, unlimited}));
}

void infer(OutlineSettings& outline, const EffectContext& context) {
    if (!outline.depth_step.value())
        fill(outline.depth_step, float(std::max(depth_part * 2 * context.content.radius(), 1e-30)));
}

}  // namespace easypbr::detail
