#include "easypbr/io/mesh/gltf/gltf_placed.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace easypbr::io {
namespace {

constexpr const char* khr_lights = "KHR_lights_punctual";

/// What a pointer names below a light or camera, and where it stands among the parameters.
struct PlacedProperty {
    std::string_view path;
    int parameter, width;
};

// The order of parameters: color (3), intensity, range, innerConeAngle, outerConeAngle.
constexpr PlacedProperty light_properties[] = {{"color", 0, 3},
                                               {"intensity", 3, 1},
                                               {"range", 4, 1},
                                               {"spot/innerConeAngle", 5, 1},
                                               {"spot/outerConeAngle", 6, 1}};
// Field of view or half height, near, far.
constexpr PlacedProperty perspective_properties[] = {{"perspective/yfov", 0, 1}, {"perspective/znear", 1, 1}};
constexpr PlacedProperty orthographic_properties[] = {
    {"orthographic/ymag", 0, 1}, {"orthographic/znear", 1, 1}, {"orthographic/zfar", 2, 1}};

/// The node's axes as a rotation: scaling and shear are no part of a camera's or a light's pose.
Mat3d rigid(const Eigen::Affine3d& T) {
    Vec3d z = T.linear().col(2), y = T.linear().col(1);
    if (!(z.norm() > 0)) return Mat3d::Identity();
    z.normalize();
    y -= z * z.dot(y);
    if (!(y.norm() > 0)) y = z.unitOrthogonal();
    y.normalize();
    Mat3d out;
    out << y.cross(z), y, z;
    return out;
}

size_t light_count(const GltfDocument& document) {
    const Json* lists = extension(document.root(), khr_lights);
    const Json* list = lists ? member(*lists, "lights") : nullptr;
    return list && list->is_array() ? list->size() : 0;
}

const Json& light_json(const GltfDocument& document, size_t light) {
    if (light >= light_count(document))
        document.fail(fmt::format("{}.lights[{}] does not exist", khr_lights, light));
    return (*member(*extension(document.root(), khr_lights), "lights"))[light];
}

LightType light_type(const std::string& name) {
    if (name == "directional") return LightType::directional;
    return name == "spot" ? LightType::spot : LightType::point;
}

/// Splines may leave the range between two keys.
float not_negative(double value) {
    return float(std::max(value, 0.0));
}

Light light_from(LightType type, const std::vector<double>& p, const Eigen::Affine3d& T_world_node) {
    Light light;
    light.type = type;
    light.position = T_world_node.translation();
    light.direction = -rigid(T_world_node).col(2).cast<float>();
    light.color = Vec3(not_negative(p[0]), not_negative(p[1]), not_negative(p[2]));
    light.intensity = not_negative(p[3]);
    light.range = not_negative(p[4]);
    light.outer_cone_deg = float(std::clamp(degrees(p[6]), 0.01, 90.0));
    light.inner_cone_deg = std::clamp(float(degrees(p[5])), 0.0f, light.outer_cone_deg);
    return light;
}

AnimatedItem<Light> read_light(const GltfDocument& document, const Json& json) {
    const auto color = document.numbers(json, "color", 3).value_or(std::vector<double>{1, 1, 1});
    AnimatedItem<Light> light;
    light.parameters = color;
    light.parameters.push_back(document.number(json, "intensity", 1));
    light.parameters.push_back(document.number(json, "range", 0));
    const Json* spot = member(json, "spot");
    light.parameters.push_back(spot ? document.number(*spot, "innerConeAngle", 0) : 0);
    light.parameters.push_back(spot ? document.number(*spot, "outerConeAngle", pi / 4) : pi / 4);
    light.value = [type = light_type(document.text(json, "type"))](const std::vector<double>& parameters,
                                                                   const Eigen::Affine3d& T_world_node) {
        return light_from(type, parameters, T_world_node);
    };
    return light;
}

bool is_orthographic(const Json& camera) {
    return !member(camera, "perspective") && member(camera, "orthographic");
}

Camera camera_from(Projection projection, const std::vector<double>& p, const Eigen::Affine3d& T_world_node) {
    constexpr double smallest = 1e-6;
    Camera camera;
    camera.T_world_cam.translation() = T_world_node.translation();
    camera.T_world_cam.linear() = rigid(T_world_node);
    camera.projection = projection;
    camera.near = p[1];
    if (projection == Projection::perspective) {
        camera.fov_y_deg = std::clamp(degrees(p[0]), 0.01, 179.0);
        camera.near = std::max(camera.near, smallest);
    } else {
        camera.ortho_height = std::max(2 * p[0], smallest);
        camera.far = std::max(p[2], camera.near + smallest);
    }
    return camera;
}

AnimatedItem<Camera> read_camera(const GltfDocument& document, const Json& json) {
    const Camera defaults;
    AnimatedItem<Camera> camera;
    camera.parameters = {radians(defaults.fov_y_deg), defaults.near, defaults.far};
    const bool orthographic = is_orthographic(json);
    if (const Json* view = member(json, "perspective"))
        camera.parameters = {document.number(*view, "yfov", 0.5),
                             document.number(*view, "znear", defaults.near), defaults.far};
    else if (const Json* box = member(json, "orthographic"))
        camera.parameters = {document.number(*box, "ymag", 1), document.number(*box, "znear", defaults.near),
                             document.number(*box, "zfar", defaults.far)};
    camera.value = [projection = orthographic ? Projection::orthographic : Projection::perspective](
                       const std::vector<double>& parameters, const Eigen::Affine3d& T_world_node) {
        return camera_from(projection, parameters, T_world_node);
    };
    return camera;
}

/// "3/spot/innerConeAngle" as number and property.
std::optional<std::pair<size_t, std::string_view>> split_item(std::string_view pointer) {
    size_t item = 0;
    const char* end = pointer.data() + pointer.size();
    const auto read = std::from_chars(pointer.data(), end, item);
    if (read.ec != std::errc() || read.ptr == end || *read.ptr != '/') return {};
    return std::pair(item, std::string_view(read.ptr + 1, size_t(end - read.ptr - 1)));
}

template <class Properties>
std::optional<GltfPlacedTarget> target_in(const Properties& properties, AnimatedProperty property,
                                          const std::pair<size_t, std::string_view>& named) {
    const auto known = std::ranges::find(properties, named.second, &PlacedProperty::path);
    if (known == std::end(properties)) return {};
    return GltfPlacedTarget{property, int(named.first), known->parameter, known->width};
}

}  // namespace

std::optional<size_t> gltf_light_of_node(const GltfDocument& document, const Json& node) {
    const Json* reference = extension(node, khr_lights);
    if (!reference) return {};
    const size_t light = document.integer(*reference, "light");
    light_json(document, light);
    return light;
}

std::optional<size_t> gltf_camera_of_node(const GltfDocument& document, const Json& node) {
    const auto camera = document.optional_integer(node, "camera");
    if (camera) document.item("cameras", *camera);
    return camera;
}

std::string gltf_light_name(const GltfDocument& document, size_t light, const std::string& fallback) {
    return document.text(light_json(document, light), "name", fallback);
}

std::string gltf_camera_name(const GltfDocument& document, size_t camera, const std::string& fallback) {
    return document.text(document.item("cameras", camera), "name", fallback);
}

std::vector<AnimatedItem<Light>> read_gltf_lights(const GltfDocument& document) {
    std::vector<AnimatedItem<Light>> lights;
    for (size_t i = 0; i < light_count(document); ++i)
        lights.push_back(read_light(document, light_json(document, i)));
    return lights;
}

std::vector<AnimatedItem<Camera>> read_gltf_cameras(const GltfDocument& document) {
    std::vector<AnimatedItem<Camera>> cameras;
    for (size_t i = 0; i < document.count("cameras"); ++i)
        cameras.push_back(read_camera(document, document.item("cameras", i)));
    return cameras;
}

std::optional<GltfPlacedTarget> find_gltf_placed(const GltfDocument& document, std::string_view pointer) {
    constexpr std::string_view lights = "/extensions/KHR_lights_punctual/lights/", cameras = "/cameras/";
    const bool is_light = pointer.starts_with(lights);
    if (!is_light && !pointer.starts_with(cameras)) return {};
    const auto named = split_item(pointer.substr((is_light ? lights : cameras).size()));
    if (!named) return {};
    if (is_light) {
        light_json(document, named->first);
        return target_in(light_properties, AnimatedProperty::light, *named);
    }
    if (is_orthographic(document.item("cameras", named->first)))
        return target_in(orthographic_properties, AnimatedProperty::camera, *named);
    return target_in(perspective_properties, AnimatedProperty::camera, *named);
}

}  // namespace easypbr::io
