#include "easypbr/app/camera_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

using SettingNames = std::vector<std::string>;

const SettingNames pose_settings = {"camera.pose", "camera.position", "camera.target"};
const SettingNames lens_settings = {"camera.projection", "camera.fov_y_deg",  "camera.ortho_height",
                                    "camera.near",       "camera.intrinsics", "camera.distortion_model",
                                    "camera.distortion"};

bool is_one_of(const SettingNames& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

bool is_written(const CameraSettings& camera, const std::string& name) {
    return !camera.distortion.empty() || !name.starts_with("camera.distortion");
}

/// "camera.NAME" and its text, as they stand there.
std::vector<std::pair<std::string, std::string>> assignments(std::string_view text) {
    std::vector<std::pair<std::string, std::string>> found;
    std::istringstream words{std::string(text)};
    for (std::string word; words >> word;) {
        if (word == "--set") continue;
        const size_t equals = word.find('=');
        if (equals == word.npos || !word.starts_with("camera."))
            throw FormatError(fmt::format("no camera: expected lines such as camera.pose=..., got '{}'",
                                          word.substr(0, 40)));
        found.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    }
    if (found.empty()) throw FormatError("no camera: the text is empty");
    return found;
}

}  // namespace

std::string camera_text(const Settings& settings) {
    SettingNames names = {"camera.pose"};
    names.insert(names.end(), lens_settings.begin(), lens_settings.end());
    std::string text;
    for (const std::string& name : names) {
        const Value value = get(settings, name);
        if (value.state != Value::State::given || !is_written(settings.camera, name)) continue;
        const std::string shown = to_text(field(name), value);
        if (!shown.empty()) text += fmt::format("{}={}\n", name, shown);
    }
    return text;
}

std::string camera_text(Session& session, Vec2i size) {
    Settings settings = session.settings();
    CameraSettings& camera = settings.camera;
    const bool has_height = camera.projection == Projection::perspective || camera.ortho_height.is_pinned();
    if (!camera.pose.empty() && has_height) return camera_text(settings);
    const Camera resolved = session.resolve(size).camera;
    if (!has_height) camera.ortho_height = resolved.ortho_height;
    if (camera.pose.empty()) {
        const Mat4d T = resolved.T_world_cam.matrix();
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) camera.pose.push_back(T(row, column));
    }
    return camera_text(settings);
}

void apply_camera_text(std::string_view text, Settings& settings) {
    const auto given = assignments(text);
    Settings changed = settings;
    const Settings defaults;
    for (const SettingNames& part : {pose_settings, lens_settings}) {
        const bool is_named =
            std::ranges::any_of(given, [&](const auto& pair) { return is_one_of(part, pair.first); });
        if (!is_named) continue;
        for (const std::string& name : part) field(name).put(changed, get(defaults, name));
    }
    for (const auto& [name, value] : given) set_from_text(changed, name, value);
    if (!changed.camera.pose.empty()) {
        Camera::from_opengl(
            Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(changed.camera.pose.data()));
        changed.camera.position = changed.camera.target = Auto<Vec3d>(automatic);
    }
    settings = changed;
}

}  // namespace easypbr::app
