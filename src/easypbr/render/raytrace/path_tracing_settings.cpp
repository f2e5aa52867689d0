// The rows of the table for path tracing, and what is inferred.
#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

template <>
const std::vector<std::string>& enum_names<Denoising>() {
    static const std::vector<std::string> names = {"best", "oidn", "filter", "off"};
    return names;
}

void add_path(Table& table) {
    table.push_back(not_kept(
        make("path.enabled", EASYPBR_AT(path.enabled),
             "Enables path tracing on the CPU, in place of shadow maps, ambient occlusion and the split sum; "
             "automatic: on in images of several samples if ssao.enabled, unless a setting of ssao, rays or "
             "shadows is given.")));
    table.push_back(make("path.bounces", EASYPBR_AT(path.bounces),
                         "Surfaces that a path meets after the one that is seen.", "", {0, 64}));
    table.push_back(make(
        "path.clamp", EASYPBR_AT(path.clamp),
        "Luminance, as exposed, that a path adds to its pixel beyond direct light while paths as bright are "
        "rare; what is above it is spread over the surfaces around, against bright single pixels. 0: none "
        "is spread, which is unbiased.",
        "", {0, unlimited}));
    table.push_back(make(
        "path.denoise", EASYPBR_AT(path.denoise),
        "Takes the noise out of path traced images: oidn by Intel Open Image Denoise, filter by a built-in "
        "edge-avoiding filter; best: oidn where it is installed, else filter, but not out of scene-linear "
        "images where path.enabled is on by choice."));
}

namespace {

/// Somebody asks for effects that paths take the place of, or for pictures without them.
bool asks_for_raster(const Settings& given) {
    return is_asked_for(given, "ssao.") || is_asked_for(given, "rays.") || is_asked_for(given, "shadows.");
}

}  // namespace

void infer(PathSettings& path, const EffectContext& context) {
    const Settings& settings = context.settings;
    context.resolved.asks_for_paths = path.enabled.is_pinned() && *path.enabled;
    fill(path.enabled, context.samples > 1 && *settings.ssao.enabled && !asks_for_raster(context.given));
    context.resolved.traces_paths = *path.enabled;
}

}  // namespace easypbr::detail
