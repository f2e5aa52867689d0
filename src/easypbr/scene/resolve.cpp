#include "easypbr/scene/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/image.h"
#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/crease.h"
#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/fields.h"

namespace easypbr {
namespace {

/// A positive rotation turns what is seen in the environment counter-clockwise, seen from above.
Mat3 environment_rotation(const Vec3d& up, double rotation_deg) {
    const Mat3d R =
        Eigen::AngleAxisd(-radians(rotation_deg), Vec3d::UnitY()).toRotationMatrix() * up_frame(up);
    return R.cast<float>();
}

/// Whether an environment map is given, which is loaded later where only its file is named.
bool is_environment_given(const SceneSnapshot& scene, const EnvironmentSettings& environment) {
    return !scene.environment.empty() || !environment.file.empty();
}

/// Of the built-in studio: its soft boxes fill and rim, and leave half of the light to the key.
constexpr float studio_intensity = 0.2f;

void resolve_environment(const SceneSnapshot& scene, Settings& settings, ResolvedSettings& resolved) {
    EnvironmentSettings& environment = settings.environment;
    detail::fill(environment.enabled, true);
    if (!environment.intensity.value())
        detail::fill(environment.intensity,
                     is_environment_given(scene, environment) ? 1.0f : studio_intensity);
    if (*environment.enabled)
        resolved.environment = scene.environment.empty() ? studio_environment() : scene.environment;
    resolved.seen_environment = resolved.environment;
    resolved.R_env_world = environment_rotation(up_direction(settings.camera), environment.rotation_deg);
}

/// Makes the environment's sun a light.
void resolve_sun(const SceneSnapshot& scene, EnvironmentSettings& settings, ResolvedSettings& resolved) {
    const Environment whole = resolved.environment;
    if (!settings.sun.value())
        detail::fill(settings.sun, !whole.empty() && !scene.environment.empty() && whole.sun());
    if (!*settings.sun || whole.empty() || !whole.sun()) return;
    const Sun& sun = *whole.sun();
    resolved.environment = whole.without_sun();
    ResolvedLight light;
    light.type = LightType::directional;
    light.direction = -(resolved.R_env_world.transpose() * sun.towards);
    light.color = sun.irradiance / sun.irradiance.maxCoeff();
    light.intensity = sun.irradiance.maxCoeff() * *settings.intensity;
    light.angular_radius_deg = sun.angular_radius_deg;
    resolved.lights.push_back(light);
}

/// Whether a light's radius counts, and nobody has said or inferred it.
bool lacks_radius(const Light& light) {
    const bool is_round = light.type != LightType::directional && light.type != LightType::rectangle;
    return is_round && !light.radius.value();
}

std::map<std::string, float> inferred_radii(const detail::Content& content) {
    std::vector<std::string> names;
    std::vector<Light> lights;
    for (const auto& [name, light] : content.scene().lights) {
        if (!light.enabled || !lacks_radius(light)) continue;
        names.push_back(name);
        lights.push_back(light);
    }
    const std::vector<float> radii = detail::plain_light_radii(content, lights);
    std::map<std::string, float> inferred;
    for (size_t i = 0; i < names.size(); ++i) inferred[names[i]] = radii[i];
    return inferred;
}

bool uses_given_environment(const SceneSnapshot& scene, const EnvironmentSettings& environment) {
    return *environment.enabled && is_environment_given(scene, environment);
}

/// Closed content matters where a light or the exposure is still to be inferred, and the user has not said
/// what lights the content.
std::optional<detail::Enclosure> inferred_enclosure(const detail::Content& content, const Settings& settings,
                                                    const Camera& camera) {
    const StudioLight& key = settings.lights.key;
    const bool is_known = key.position.value() && key.intensity.value() && key.radius.value() &&
                          settings.tonemap.exposure.value();
    const bool has_lights =
        std::ranges::any_of(content.scene().lights, [](const auto& light) { return light.second.enabled; });
    if (is_known || has_lights || uses_given_environment(content.scene(), settings.environment)) return {};
    return detail::enclosure_of(content, camera);
}

void resolve_lights(const detail::Stage& stage, Settings& settings, ResolvedSettings& resolved) {
    const detail::Content& content = stage.content;
    for (const auto& [name, light] : content.scene().lights) validate(light, name);
    resolved.light_radii = inferred_radii(content);
    for (const auto& [name, light] : content.scene().lights) {
        if (!light.enabled) continue;
        const auto inferred = resolved.light_radii.find(name);
        resolved.lights.push_back(
            {light, inferred != resolved.light_radii.end() ? inferred->second : light.radius.value_or(0)});
    }
    const bool given = uses_given_environment(content.scene(), settings.environment);
    for (const ResolvedLight& light :
         detail::resolve_studio_lights(stage, !given, settings.lights, up_direction(settings.camera)))
        resolved.lights.push_back(light);
}

void resolve_exposure(const detail::Stage& stage, Settings& settings, ResolvedSettings& resolved) {
    TonemapSettings& tone = settings.tonemap;
    if (!tone.exposure.value())
        detail::fill(tone.exposure,
                     detail::metered_exposure(stage, resolved, *settings.environment.intensity));
    resolved.exposure = *tone.exposure * std::exp2(tone.exposure_compensation);
}

/// Whether the pictures' single precision holds where the camera and the lights are.
bool is_representable(const ResolvedSettings& resolved) {
    const auto holds = [](const ResolvedLight& light) {
        const bool has_place = light.type == LightType::directional ||
                               (light.position.cast<float>().allFinite() && std::isfinite(light.radius));
        return has_place && std::isfinite(light.intensity);
    };
    return resolved.camera.T_world_cam.matrix().cast<float>().allFinite() &&
           std::isfinite(float(resolved.camera.near)) && std::ranges::all_of(resolved.lights, holds);
}

/// Coordinates of at least this size make squares of lengths, as a light's intensity is one, leave single
/// precision.
constexpr double large_coordinate = 1e15;

/// The object that reaches farthest from the origin, and how far.
std::pair<std::string, double> farthest_object(const SceneSnapshot& scene) {
    std::pair<std::string, double> farthest{{}, 0};
    for (const SceneSnapshot::Object& object : scene.objects) {
        SceneSnapshot alone;
        alone.objects = {object};
        const Box3d box = alone.bounds();
        if (box.isEmpty()) continue;
        const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
        if (reach > farthest.second) farthest = {object.name, reach};
    }
    return farthest;
}

/// Says which mesh's pose nothing can be inferred from, for its numbers leave the picture's precision.
void require_poses(const SceneSnapshot& scene) {
    for (const SceneSnapshot::Object& object : scene.objects) {
        const double largest = object.T_world_mesh.matrix().cwiseAbs().maxCoeff();
        if (largest <= double(std::numeric_limits<float>::max())) continue;
        throw ArgumentError(fmt::format(
            "mesh '{}': its pose in the world has numbers up to {:.3g}, too large for single precision",
            object.name, largest));
    }
}

/// Says so at once where a mesh is too large, before anything that follows from it is kept.
void require_representable(const SceneSnapshot& scene, const ResolvedSettings& resolved) {
    if (is_representable(resolved)) return;
    const auto [name, reach] = farthest_object(scene);
    if (reach < large_coordinate) return;
    throw ArgumentError(
        fmt::format("mesh '{}' has coordinates up to {:.3g}: too large for the camera and the lights to be "
                    "placed in single precision; scale it down",
                    name, reach));
}

const Settings& default_settings() {
    static const Settings defaults;
    return defaults;
}

}  // namespace

bool detail::is_asked_for(const Settings& given, std::string_view group) {
    return std::ranges::any_of(fields(), [&](const Field& field) {
        if (!field.name.starts_with(group) || field.same(given, default_settings())) return false;
        const Value value = field.get(given);
        return value.state == Value::State::given && value != field.get(default_settings());
    });
}

ResolvedSettings resolve(const SceneSnapshot& scene, const Settings& given, Vec2i size,
                         std::optional<int> samples, const Insets& insets) {
    if (size.minCoeff() < 1 || size.maxCoeff() > max_image_side)
        throw ArgumentError(fmt::format("picture size: expected width and height from 1 to {}, got {}x{}",
                                        max_image_side, size.x(), size.y()));
    for (const Field& field : fields())
        if (!field.same(given, default_settings())) checked(field, field.get(given));
    require_poses(scene);
    const detail::Content content(scene, given.style);
    Settings settings = given;
    ResolvedSettings resolved;
    if (!settings.camera.up.value()) detail::fill(settings.camera.up, detail::inferred_up(scene));
    if (!settings.camera.azimuth_deg.value() || !settings.camera.elevation_deg.value()) {
        const detail::ViewAngles view = detail::inferred_view(scene, up_direction(settings.camera));
        detail::fill(settings.camera.azimuth_deg, view.azimuth_deg);
        detail::fill(settings.camera.elevation_deg, view.elevation_deg);
    }
    resolved.camera = detail::resolve_camera(content, settings.camera, {double(size.x()) / size.y(), insets});
    resolve_environment(scene, settings, resolved);
    const detail::Stage stage{content, resolved.camera,
                              inferred_enclosure(content, settings, resolved.camera)};
    resolve_lights(stage, settings, resolved);
    resolve_sun(scene, settings.environment, resolved);
    resolve_exposure(stage, settings, resolved);
    detail::fill(settings.annotation.legend, false);
    detail::fill(settings.annotation.colorbar, false);
    detail::fill(settings.load.crease_deg, automatic_crease_deg);
    const detail::EffectContext context{content, size,     samples.value_or(settings.image.samples),
                                        given,   settings, resolved};
#define EASYPBR_INFER(name, Type) detail::infer(settings.name, context);
    EASYPBR_EFFECTS(EASYPBR_INFER)
#undef EASYPBR_INFER
    for (const Field& field : fields()) field.copy(resolved.settings, settings);
    require_representable(scene, resolved);
    return resolved;
}

void latch(Settings& settings, const InferredSettings& all) {
    for (const Field& field : fields()) {
        if (!field.can_be_automatic || !field.is_kept) continue;
        const Value own = field.get(settings);
        if (own.state != Value::State::automatic || own.latched) continue;
        Value inferred = field.get_inferred(all);
        if (inferred.state != Value::State::given || !is_valid(field, inferred)) continue;
        inferred.state = Value::State::automatic;
        inferred.latched = true;
        field.put(settings, inferred);
    }
}

void release(Settings& settings) {
    for (const Field& field : fields())
        if (field.can_be_automatic && field.get(settings).latched)
            field.put(settings, {{}, Value::State::automatic});
}

Vec3d parse_up(const std::string& up) {
    const bool has_sign = !up.empty() && (up[0] == '+' || up[0] == '-');
    const std::string axis = ascii::to_lower(has_sign ? up.substr(1) : up);
    const double sign = has_sign && up[0] == '-' ? -1 : 1;
    if (axis == "x") return Vec3d(sign, 0, 0);
    if (axis == "y") return Vec3d(0, sign, 0);
    if (axis == "z") return Vec3d(0, 0, sign);
    throw ArgumentError(fmt::format("up direction: expected one of +x, -x, +y, -y, +z, -z, got '{}'", up));
}

}  // namespace easypbr
