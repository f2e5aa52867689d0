#include "easypbr/io/settings/camera_path_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/suggest.h"
#include "easypbr/io/source/json_text.h"

namespace easypbr::io {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* mark = "easypbr_camera_path";
const std::vector<std::string> mode_names{"smooth", "linear"}, ease_names{"none", "in", "out", "in_out"},
    axes_names{"opengl", "opencv"};

class PathReader {
  public:
    PathReader(const std::string& text, const std::string& name)
        : name_(name), root_(parse_json<Json>(text, name)) {
        if (root_.is_array()) root_ = Json{{"keys", root_}};
        if (!root_.is_object()) fail("expected an object or a list of keys");
        check_names(root_, {mark, "mode", "ease", "closed", "axes", "segment_s", "keys", "orbit"},
                    "the path");
    }

    CameraPath read() {
        if (const double version = number(root_, mark, 1, "the path"); version != 1)
            fail(fmt::format("expected version 1, got {}", version));
        CameraPathOptions options;
        options.mode = PathMode(choice("mode", mode_names));
        options.ease = PathEase(choice("ease", ease_names));
        opencv_ = choice("axes", axes_names) == 1;
        if (const auto closed = root_.find("closed"); closed != root_.end()) {
            if (!closed->is_boolean()) fail("closed: expected true or false");
            options.closed = *closed;
        }
        try {
            if (root_.contains("orbit")) return orbit(options.ease);
            return CameraPath(keys(), options);
        } catch (const ArgumentError& error) {
            fail(error.what());
        }
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw FormatError(fmt::format("{}: {}", name_, what));
    }

    void check_names(const Json& object, const std::vector<std::string>& known,
                     const std::string& where) const {
        for (const auto& [name, value] : object.items())
            if (std::ranges::find(known, name) == known.end())
                fail(fmt::format("{} has an unknown entry '{}'{}; expected one of {}", where, name,
                                 did_you_mean(name, known), fmt::join(known, ", ")));
    }

    size_t choice(const char* entry, const std::vector<std::string>& names) const {
        const auto found = root_.find(entry);
        if (found == root_.end()) return 0;
        const std::string text = found->is_string() ? found->get<std::string>() : found->dump();
        const auto at = std::ranges::find(names, text);
        if (at == names.end())
            fail(fmt::format("{}: expected {}, got '{}'", entry, fmt::join(names, " or "), text));
        return size_t(at - names.begin());
    }

    double number(const Json& object, const char* entry, double fallback, const std::string& where) const {
        const auto found = object.find(entry);
        if (found == object.end()) return fallback;
        if (!found->is_number()) fail(fmt::format("{}: {}: expected a number", where, entry));
        return found->get<double>();
    }

    Vec3d vector(const Json& object, const char* entry, const Vec3d& fallback,
                 const std::string& where) const {
        const auto found = object.find(entry);
        if (found == object.end()) return fallback;
        const std::vector<double> values = numbers(*found);
        if (values.size() != 3) fail(fmt::format("{}: {}: expected three numbers", where, entry));
        return Vec3d(values.data());
    }

    /// All numbers of nested lists; nothing for anything else.
    static std::vector<double> numbers(const Json& value) {
        std::vector<double> out;
        for (const Json& entry : value.is_array() ? value : Json::array()) {
            if (entry.is_number()) {
                out.push_back(entry.get<double>());
            } else if (entry.is_array()) {
                const std::vector<double> inner = numbers(entry);
                out.insert(out.end(), inner.begin(), inner.end());
            } else {
                return {};
            }
        }
        return out;
    }

    Eigen::Isometry3d pose(const Json& value, const std::string& where) const {
        const std::vector<double> values = numbers(value);
        if (values.size() != 16) fail(where + ": expected the 16 numbers of a 4 x 4 matrix T_world_cam");
        Mat4d T = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
        if (opencv_) T.block<3, 2>(0, 1) *= -1;
        Eigen::Isometry3d out;
        out.matrix() = T;
        return out;
    }

    CameraKey key(const Json& value, const std::string& where) const {
        CameraKey key;
        key.segment_s = number(root_, "segment_s", 1, "the path");
        if (!value.is_object()) {
            key.T_world_cam = pose(value, where);
            return key;
        }
        check_names(value, {"T_world_cam", "position", "target", "up", "segment_s", "fov_y_deg"}, where);
        if (value.contains("T_world_cam")) {
            key.T_world_cam = pose(value["T_world_cam"], where);
        } else {
            if (!value.contains("position") || !value.contains("target"))
                fail(where + ": expected T_world_cam, or position and target");
            key.T_world_cam = Camera::look_at(vector(value, "position", Vec3d::Zero(), where),
                                              vector(value, "target", Vec3d::Zero(), where),
                                              vector(value, "up", Vec3d::UnitY(), where))
                                  .T_world_cam;
        }
        key.segment_s = number(value, "segment_s", key.segment_s, where);
        if (value.contains("fov_y_deg")) key.fov_y_deg = number(value, "fov_y_deg", 0, where);
        return key;
    }

    std::vector<CameraKey> keys() const {
        const auto list = root_.find("keys");
        if (list == root_.end() || !list->is_array()) fail("expected a list of keys");
        std::vector<CameraKey> keys;
        for (size_t i = 0; i < list->size(); ++i) keys.push_back(key((*list)[i], fmt::format("key {}", i)));
        return keys;
    }

    CameraPath orbit(PathEase ease) const {
        const Json& entry = root_["orbit"];
        if (!entry.is_object()) fail("orbit: expected an object");
        check_names(entry, {"T_world_cam", "center", "axis", "angle_deg", "duration_s", "ortho_height"},
                    "orbit");
        if (!entry.contains("T_world_cam")) fail("orbit: expected T_world_cam");
        Camera start = Camera::from_opengl(pose(entry["T_world_cam"], "orbit").matrix());
        if (entry.contains("ortho_height")) {
            start.projection = Projection::orthographic;
            start.ortho_height = number(entry, "ortho_height", start.ortho_height, "orbit");
            if (!(start.ortho_height > 0)) fail("orbit: expected an ortho_height above 0");
        }
        return CameraPath::orbit(start, vector(entry, "center", Vec3d::Zero(), "orbit"),
                                 vector(entry, "axis", Vec3d::UnitY(), "orbit"),
                                 number(entry, "angle_deg", 360, "orbit"),
                                 number(entry, "duration_s", 4, "orbit"), ease);
    }

    std::string name_;
    Json root_;
    bool opencv_ = false;
};

OrderedJson list_of(const Vec3d& v) {
    return {v.x(), v.y(), v.z()};
}

OrderedJson matrix_rows(const Eigen::Isometry3d& T) {
    OrderedJson rows = OrderedJson::array();
    for (int row = 0; row < 4; ++row) rows.push_back({T(row, 0), T(row, 1), T(row, 2), T(row, 3)});
    return rows;
}

}  // namespace

CameraPath parse_camera_path(const std::string& json, const std::string& name) {
    return PathReader(json, name).read();
}

CameraPath load_camera_path(const std::filesystem::path& path) {
    const FileBytes file(path);
    return parse_camera_path(std::string(file.text()), path.string());
}

std::string to_json(const CameraPath& path) {
    OrderedJson root{{mark, 1},
                     {"mode", mode_names[size_t(path.options().mode)]},
                     {"ease", ease_names[size_t(path.options().ease)]},
                     {"axes", "opengl"}};
    if (path.circle()) {
        const CameraPath::Orbit& orbit = *path.circle();
        root["orbit"] = {{"T_world_cam", matrix_rows(orbit.T_world_cam)},
                         {"center", list_of(orbit.center)},
                         {"axis", list_of(orbit.axis)},
                         {"angle_deg", orbit.angle_deg},
                         {"duration_s", path.duration_s()}};
        if (orbit.ortho_height) root["orbit"]["ortho_height"] = *orbit.ortho_height;
        return root.dump(1) + "\n";
    }
    root["closed"] = path.is_closed();
    root["keys"] = OrderedJson::array();
    for (const CameraKey& key : path.keys()) {
        OrderedJson entry{{"T_world_cam", matrix_rows(key.T_world_cam)}, {"segment_s", key.segment_s}};
        if (key.fov_y_deg) entry["fov_y_deg"] = *key.fov_y_deg;
        root["keys"].push_back(entry);
    }
    return root.dump(1) + "\n";
}

void save_camera_path(const CameraPath& camera_path, const std::filesystem::path& path) {
    write_file(path, to_json(camera_path));
}

}  // namespace easypbr::io
