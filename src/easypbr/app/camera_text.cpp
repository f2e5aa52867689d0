#include "easypbr/app/camera_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "easypbr/core/error.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

constexpr const char* written[] = {"camera.pose", "camera.projection", "camera.fov_y_deg",
                                   "camera.ortho_height", "camera.intrinsics"};

}  // namespace

std::string camera_text(const Settings& settings) {
    std::string text;
    for (const char* name : written) {
        const Value value = get(settings, name);
        if (value.state != Value::State::given) continue;
        const auto* numbers = std::get_if<std::vector<double>>(&value.data);
        if (numbers && numbers->empty()) continue;
        const std::string shown =
            numbers ? fmt::format("{}", fmt::join(*numbers, ",")) : to_text(field(name), value);
        text += fmt::format("{}={}\n", name, shown);
    }
    return text;
}

std::string camera_text(Session& session, Vec2i size) {
    Settings settings = session.settings();
    if (std::vector<double>& pose = settings.camera.pose; pose.empty()) {
        const Mat4d T = session.resolve(size).camera.T_world_cam.matrix();
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) pose.push_back(T(row, column));
    }
    return camera_text(settings);
}

void apply_camera_text(std::string_view text, Settings& settings) {
    Settings changed = settings;
    bool found = false;
    std::istringstream words{std::string(text)};
    for (std::string word; words >> word;) {
        if (word == "--set") continue;
        const size_t equals = word.find('=');
        if (equals == word.npos || !word.starts_with("camera."))
            throw FormatError(fmt::format("no camera: expected lines such as camera.pose=..., got '{}'",
                                          word.substr(0, 40)));
        set_from_text(changed, word.substr(0, equals), word.substr(equals + 1));
        found = true;
    }
    if (!found) throw FormatError("no camera: the text is empty");
    if (!changed.camera.pose.empty()) {
        Camera::from_opengl(
            Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(changed.camera.pose.data()));
        changed.camera.position = changed.camera.target = Auto<Vec3d>(automatic);
    }
    settings = changed;
}

}  // namespace easypbr::app
