#include "easypbr/io/settings/settings_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/hash.h"
#include "easypbr/core/markup.h"
#include "easypbr/core/suggest.h"
#include "easypbr/io/source/json_text.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/light_table.h"

namespace easypbr::io {
namespace {

/// Keeps the order of the reference.
using OrderedJson = nlohmann::ordered_json;

constexpr int format_version = 1;

/// The text. Throws ArgumentError where JSON cannot hold it: with other bytes it would name another thing.
const std::string& checked_text(std::string_view what, const std::string& text) {
    if (valid_utf8(text) != text)
        throw ArgumentError(fmt::format(
            "{}: expected UTF-8, which settings are written in, got '{}': rename it", what, text));
    return text;
}

OrderedJson json_of(const FieldInfo& field, double number) {
    return field.whole ? OrderedJson(int64_t(number)) : OrderedJson(number);
}

OrderedJson json_of(const FieldInfo& field, const Value::Data& data) {
    if (const auto* flag = std::get_if<bool>(&data)) return *flag;
    if (const auto* number = std::get_if<double>(&data)) return json_of(field, *number);
    if (const auto* text = std::get_if<std::string>(&data))
        return checked_text(fmt::format("setting '{}'", field.name), *text);
    OrderedJson list = OrderedJson::array();
    for (const double number : std::get<std::vector<double>>(data)) list.push_back(json_of(field, number));
    return list;
}

OrderedJson json_of(const FieldInfo& field, const Value& value) {
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

/// Throws ArgumentError when the light cannot be read again.
OrderedJson json_of(const std::string& name, const Light& light) {
    validate(light, name);
    OrderedJson json = OrderedJson::object();
    for (const LightField& field : light_fields()) json[field.name] = json_of(field, field.get(light));
    return json;
}

class SettingsParser {
  public:
    explicit SettingsParser(const std::string& name) : name_(name) {}

    void parse(const std::string& text, SettingsFile& file) {
        OrderedJson root = parse_json<OrderedJson>(text, name_);
        if (!root.is_object() || !root.contains("easypbr")) fail("expected an object with \"easypbr\": 1");
        if (root["easypbr"] != format_version)
            fail(fmt::format("expected \"easypbr\": {}, got {}", format_version, root["easypbr"].dump()));
        for (const auto& [key, value] : root.items()) section(key, value, file);
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
            set(settings, full, value_of(target, json, {}));
        } catch (const NameError& error) {
            throw NameError(fmt::format("cannot read settings from {}: {}", name_, error.what()));
        } catch (const ArgumentError& error) {
            fail(error.what());
        }
    }

    static Value value_of(const FieldInfo& target, const OrderedJson& json, std::string_view owner) {
        Value value;
        if (json.is_object() && json.size() == 1 && json.contains("auto")) {
            value.data = data_of(target, json["auto"], owner);
            value.state = Value::State::automatic;
            value.latched = true;
        } else if (json == "auto" && target.can_be_automatic) {
            value.state = Value::State::automatic;
        } else if (json == "follow" && target.can_be_automatic) {
            value.state = Value::State::follow;
        } else {
            value.data = data_of(target, json, owner);
        }
        return value;
    }

    static Value::Data data_of(const FieldInfo& target, const OrderedJson& json, std::string_view owner) {
        if (json.is_boolean()) return json.get<bool>();
        if (json.is_number()) return json.get<double>();
        if (json.is_string()) return json.get<std::string>();
        const auto is_number = [](const OrderedJson& entry) { return entry.is_number(); };
        if (!json.is_array() || !std::ranges::all_of(json, is_number))
            reject_value(target, json.dump(), owner);
        return json.get<std::vector<double>>();
    }

    Light light_of(const std::string& name, const OrderedJson& json) const {
        const std::string where = fmt::format("lights '{}'", name);
        require_object(where, json);
        Light light;
        const std::string owner = fmt::format("light '{}': ", name);
        try {
            for (const auto& [key, value] : json.items()) {
                const auto found = std::ranges::find(light_fields(), key, &LightField::name);
                if (found == light_fields().end())
                    throw ArgumentError(fmt::format("{}unknown key '{}'", owner, key));
                found->put(light, checked(*found, value_of(*found, value, owner), owner));
            }
            validate(light, name);
        } catch (const ArgumentError& error) {
            fail(error.what());
        }
        return light;
    }

    const std::string& name_;
};

}  // namespace

SettingsFile load_settings(const std::filesystem::path& path) {
    const FileBytes file(path);
    return parse_settings(std::string(file.text()), path.string());
}

SettingsFile parse_settings(const std::string& json, const std::string& name) {
    SettingsFile file;
    apply_settings(json, name, file);
    return file;
}

void apply_settings(const std::string& json, const std::string& name, SettingsFile& file) {
    SettingsParser(name).parse(json, file);
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
    for (const auto& [name, light] : file.lights)
        root["lights"][checked_text("name of a light", name)] = json_of(name, light);
    root["files"] = OrderedJson::object();
    for (const auto& [name, hash] : file.files) root["files"][checked_text("name of a file", name)] = hash;
    return root.dump(2) + "\n";
}

std::string hash_file(const std::filesystem::path& path) {
    const FileBytes file(path);
    std::string hash = content_hash(file.bytes());
    file.check();
    return hash;
}

}  // namespace easypbr::io
