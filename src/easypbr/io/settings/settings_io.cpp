#include "easypbr/io/settings/settings_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/hash.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/fields.h"

namespace easypbr::io {
namespace {

/// Keeps the order of the reference.
using OrderedJson = nlohmann::ordered_json;

constexpr int format_version = 1;
const std::vector<std::string> light_types = {"point", "directional", "spot"};

OrderedJson json_of(const Field& field, double number) {
    return field.whole ? OrderedJson(int64_t(number)) : OrderedJson(number);
}

OrderedJson json_of(const Field& field, const Value::Data& data) {
    if (const auto* flag = std::get_if<bool>(&data)) return *flag;
    if (const auto* number = std::get_if<double>(&data)) return json_of(field, *number);
    if (const auto* text = std::get_if<std::string>(&data)) return *text;
    OrderedJson list = OrderedJson::array();
    for (const double number : std::get<std::vector<double>>(data)) list.push_back(json_of(field, number));
    return list;
}

OrderedJson json_of(const Field& field, const Value& value) {
    if (value.state == Value::State::follow) return "follow";
    if (value.state == Value::State::given) return json_of(field, value.data);
    return value.latched ? OrderedJson{{"auto", json_of(field, value.data)}} : OrderedJson("auto");
}

/// The place of "group.name" in nested objects.
OrderedJson& place_of(OrderedJson& settings, const std::string& name) {
    OrderedJson* place = &settings;
    size_t begin = 0;
    for (size_t dot = name.find('.'); dot != std::string::npos; begin = dot + 1, dot = name.find('.', begin))
        place = &(*place)[name.substr(begin, dot - begin)];
    return (*place)[name.substr(begin)];
}

/// A number with the fewest digits that give the same float again.
OrderedJson json_of(float number) {
    if (!std::isfinite(number))
        throw ArgumentError(fmt::format("cannot save a light: {} is not finite", number));
    return OrderedJson::parse(fmt::format("{}", number));
}

OrderedJson json_of(const Vec3& v) {
    return OrderedJson::array({json_of(v[0]), json_of(v[1]), json_of(v[2])});
}

OrderedJson json_of(const Auto<float>& setting) {
    if (setting.is_follow()) return "follow";
    if (setting.is_pinned()) return json_of(*setting);
    return setting.value() ? OrderedJson{{"auto", json_of(*setting)}} : OrderedJson("auto");
}

OrderedJson json_of(const Light& light) {
    return {{"type", light_types[size_t(light.type)]},
            {"enabled", light.enabled},
            {"position", json_of(light.position)},
            {"direction", json_of(light.direction)},
            {"color", json_of(light.color)},
            {"intensity", json_of(light.intensity)},
            {"inner_cone_deg", json_of(light.inner_cone_deg)},
            {"outer_cone_deg", json_of(light.outer_cone_deg)},
            {"range", json_of(light.range)},
            {"casts_shadows", light.casts_shadows},
            {"radius", json_of(light.radius)},
            {"angular_radius_deg", json_of(light.angular_radius_deg)}};
}

class SettingsParser {
  public:
    explicit SettingsParser(const std::string& name) : name_(name) {}

    SettingsFile parse(const std::string& text) {
        OrderedJson root;
        try {
            root = OrderedJson::parse(text);
        } catch (const OrderedJson::exception& error) {
            fail(error.what());
        }
        if (!root.is_object() || !root.contains("easypbr")) fail("expected an object with \"easypbr\": 1");
        if (root["easypbr"] != format_version)
            fail(fmt::format("expected \"easypbr\": {}, got {}", format_version, root["easypbr"].dump()));
        SettingsFile file;
        for (const auto& [key, value] : root.items()) section(key, value, file);
        return file;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw FormatError(fmt::format("cannot read settings from {}: {}", name_, what));
    }

    void require_object(const std::string& where, const OrderedJson& json) const {
        if (!json.is_object())
            fail(fmt::format("'{}': expected an object, got {}", where, json.dump().substr(0, 80)));
    }

    void section(const std::string& key, const OrderedJson& json, SettingsFile& file) const {
        if (key == "easypbr") return;
        if (key != "settings" && key != "lights" && key != "files")
            fail(fmt::format("unknown key '{}' (expected settings, lights, files)", key));
        require_object(key, json);
        if (key == "settings") {
            group("", json, file.settings);
            return;
        }
        for (const auto& [name, value] : json.items())
            if (key == "lights")
                file.lights[name] = light_of(name, value);
            else if (value.is_string())
                file.files[name] = value.get<std::string>();
            else
                fail(fmt::format("files '{}': expected a hash, got {}", name, value.dump().substr(0, 80)));
    }

    static bool is_field(const std::string& name) {
        const auto& all = fields();
        return std::any_of(all.begin(), all.end(), [&](const Field& field) { return field.name == name; });
    }

    void group(const std::string& prefix, const OrderedJson& json, Settings& settings) const {
        for (const auto& [key, value] : json.items()) {
            const std::string full = prefix + key;
            if (!is_field(full) && value.is_object())
                group(full + ".", value, settings);
            else
                assign(full, value, settings);
        }
    }

    void assign(const std::string& full, const OrderedJson& json, Settings& settings) const {
        try {
            const Field& target = field(full);
            set(settings, full, value_of(target, json));
        } catch (const NameError& error) {
            throw NameError(fmt::format("cannot read settings from {}: {}", name_, error.what()));
        } catch (const ArgumentError& error) {
            fail(error.what());
        }
    }

    Value value_of(const Field& target, const OrderedJson& json) const {
        Value value;
        if (json.is_object() && json.size() == 1 && json.contains("auto")) {
            value.data = data_of(target, json["auto"]);
            value.state = Value::State::automatic;
            value.latched = true;
        } else if (json == "auto" && target.can_be_automatic) {
            value.state = Value::State::automatic;
        } else if (json == "follow" && target.can_be_automatic) {
            value.state = Value::State::follow;
        } else {
            value.data = data_of(target, json);
        }
        return value;
    }

    Value::Data data_of(const Field& target, const OrderedJson& json) const {
        if (json.is_boolean()) return json.get<bool>();
        if (json.is_number()) return json.get<double>();
        if (json.is_string()) return json.get<std::string>();
        if (!json.is_array())
            fail(fmt::format("setting '{}': got {}", target.name, json.dump().substr(0, 80)));
        return numbers_of("setting '" + target.name + "'", json);
    }

    std::vector<double> numbers_of(const std::string& where, const OrderedJson& json) const {
        std::vector<double> numbers;
        for (const OrderedJson& entry : json) {
            if (!entry.is_number())
                fail(fmt::format("{}: expected numbers, got {}", where, entry.dump().substr(0, 80)));
            numbers.push_back(entry.get<double>());
        }
        return numbers;
    }

    Light light_of(const std::string& name, const OrderedJson& json) const {
        const std::string where = fmt::format("lights '{}'", name);
        require_object(where, json);
        Light light;
        for (const auto& [key, value] : json.items()) {
            const std::string place = fmt::format("{}, {}", where, key);
            if (key == "type")
                light.type = light_type_of(place, value);
            else if (key == "enabled")
                light.enabled = flag_of(place, value);
            else if (key == "position")
                light.position = vec3_of(place, value);
            else if (key == "direction")
                light.direction = vec3_of(place, value);
            else if (key == "color")
                light.color = vec3_of(place, value);
            else if (key == "intensity")
                light.intensity = float_of(place, value);
            else if (key == "inner_cone_deg")
                light.inner_cone_deg = float_of(place, value);
            else if (key == "outer_cone_deg")
                light.outer_cone_deg = float_of(place, value);
            else if (key == "range")
                light.range = float_of(place, value);
            else if (key == "casts_shadows")
                light.casts_shadows = flag_of(place, value);
            else if (key == "radius")
                light.radius = auto_float_of(place, value);
            else if (key == "angular_radius_deg")
                light.angular_radius_deg = float_of(place, value);
            else
                fail(fmt::format("{}: unknown key", place));
        }
        try {
            validate(light, name);
        } catch (const ArgumentError& error) {
            fail(error.what());
        }
        return light;
    }

    LightType light_type_of(const std::string& place, const OrderedJson& json) const {
        const std::string text = json.is_string() ? json.get<std::string>() : json.dump();
        for (size_t i = 0; i < light_types.size(); ++i)
            if (light_types[i] == text) return LightType(i);
        fail(fmt::format("{}: expected point, directional or spot, got '{}'{}", place, text,
                         did_you_mean(text, light_types)));
    }

    bool flag_of(const std::string& place, const OrderedJson& json) const {
        if (!json.is_boolean()) fail(fmt::format("{}: expected true or false", place));
        return json.get<bool>();
    }

    float float_of(const std::string& place, const OrderedJson& json) const {
        const double number = json.is_number() ? json.get<double>() : std::nan("");
        if (!(std::abs(number) <= std::numeric_limits<float>::max()))
            fail(fmt::format("{}: expected a number", place));
        return float(number);
    }

    Auto<float> auto_float_of(const std::string& place, const OrderedJson& json) const {
        if (json == "follow") return follow;
        if (json == "auto") return automatic;
        if (!json.is_object() || json.size() != 1 || !json.contains("auto")) return float_of(place, json);
        Auto<float> setting;
        setting.latch(float_of(place, json["auto"]));
        return setting;
    }

    Vec3 vec3_of(const std::string& place, const OrderedJson& json) const {
        if (!json.is_array() || json.size() != 3) fail(fmt::format("{}: expected 3 numbers", place));
        return {float_of(place, json[0]), float_of(place, json[1]), float_of(place, json[2])};
    }

    const std::string& name_;
};

}  // namespace

SettingsFile load_settings(const std::filesystem::path& path) {
    const FileBytes file(path);
    return parse_settings(std::string(file.text()), path.string());
}

SettingsFile parse_settings(const std::string& json, const std::string& name) {
    return SettingsParser(name).parse(json);
}

void save_settings(const SettingsFile& file, const std::filesystem::path& path) {
    write_file(path, to_json(file));
}

std::string to_json(const SettingsFile& file) {
    OrderedJson root;
    root["easypbr"] = format_version;
    root["settings"] = OrderedJson::object();
    for (const Field& field : fields())
        place_of(root["settings"], field.name) = json_of(field, field.get(file.settings));
    root["lights"] = OrderedJson::object();
    for (const auto& [name, light] : file.lights) root["lights"][name] = json_of(light);
    root["files"] = file.files;
    return root.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::string hash_file(const std::filesystem::path& path) {
    const FileBytes file(path);
    std::string hash = content_hash(file.bytes());
    file.check();
    return hash;
}

}  // namespace easypbr::io
