// The rows of the table for screen-space ambient occlusion, and what is inferred.
#include <algorithm>

#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

template <>
const std::vector<std::string>& enum_names<OcclusionMethod>() {
    static const std::vector<std::string> names = {"horizon", "hemisphere"};
    return names;
}

template <>
const std::vector<std::string>& enum_names<OcclusionResolution>() {
    static const std::vector<std::string> names = {"adaptive", "half", "full"};
    return names;
}

namespace {

/// The paper's radius.
constexpr double occlusion_radius = 0.05;

bool has_surfaces(const Content& content) {
    return std::ranges::any_of(content.scene().objects, [&](const SceneSnapshot::Object& object) {
        const MeshData& mesh = *object.mesh;
        return !mesh.F.empty() || !mesh.N.empty() ||
               (!mesh.V.empty() && resolve_style(mesh, content.overrides()).mode == DrawMode::voxels);
    });
}

}  // namespace

void add_ssao(Table& table) {
    table.push_back(make("ssao.enabled", EASYPBR_AT(ssao.enabled),
                         "Enables screen-space ambient occlusion of image-based lighting; automatic: on if "
                         "the scene has faces, normals or voxels."));
    table.push_back(make("ssao.method", EASYPBR_AT(ssao.method),
                         "Ambient occlusion algorithm: horizon-based (ground-truth ambient occlusion), or "
                         "point samples in the normal-oriented hemisphere."));
    table.push_back(make("ssao.resolution", EASYPBR_AT(ssao.resolution),
                         "Resolution of the ambient occlusion buffer: half, full, or adaptive (full from "
                         "48 samples on, else half)."));
    table.push_back(make(
        "ssao.radius", EASYPBR_AT(ssao.radius),
        "Maximum distance of occluders; automatic: 5 % of the diagonal of the bounding box of the content.",
        "world units", {positive, unlimited}));
    table.push_back(make("ssao.falloff", EASYPBR_AT(ssao.falloff),
                         "Outer fraction of the radius over which occlusion fades to zero.", "", {0.01, 1}));
    table.push_back(make("ssao.power", EASYPBR_AT(ssao.power),
                         "Exponent of the visibility; values above 1 darken.", "", {0, 16}));
    table.push_back(make("ssao.directions", EASYPBR_AT(ssao.directions),
                         "Slices (method horizon) or sets of points (hemisphere) per pixel in each sample.",
                         "", {1, 64}));
    table.push_back(
        make("ssao.steps", EASYPBR_AT(ssao.steps),
             "Depth-buffer samples per direction and side; method horizon takes more over long distances.",
             "", {1, 64}));
    table.push_back(make(
        "ssao.multi_bounce", EASYPBR_AT(ssao.multi_bounce),
        "Approximates multiple bounces between occluded surfaces, which lightens occlusion by the albedo."));
}

void infer(SsaoSettings& ssao, const EffectContext& context) {
    if (!ssao.enabled.value()) fill(ssao.enabled, has_surfaces(context.content));
    if (!ssao.radius.value())
        fill(ssao.radius, float(std::max(occlusion_radius * 2 * context.content.radius(), 1e-30)));
}

}  // namespace easypbr::detail
