#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <nlohmann/json.hpp>
#include <set>

#include "easypbr/cli/command.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/material_table.h"

namespace easypbr::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    std::string file, format;
    bool json = false;
};

void declare_info(CLI::App& command, InfoOptions& options) {
    command.add_option("FILE", options.file, "Mesh or image file; - is a mesh from standard input");
    declare_format(command, options.format);
    command.add_flag("--json", options.json, "Print JSON");
}

Json describe(const Image& image) {
    static const char* const types[] = {"u8", "u16", "f32"};
    return {{"width", image.width()},
            {"height", image.height()},
            {"channels", image.channels()},
            {"type", types[int(image.type())]}};
}

Json describe(const Vec3d& v) {
    return {v.x(), v.y(), v.z()};
}

std::vector<std::string> attributes_of(const MeshData& data) {
    std::vector<std::string> names;
    const auto add = [&](const char* name, bool present) {
        if (present) names.push_back(name);
    };
    add("normals", !data.N.empty());
    add("colors", !data.C.empty());
    add("uv", !data.UV.empty());
    add("tangents", !data.T.empty());
    add("edges", !data.E.empty());
    add("labels", !data.L.empty());
    add("intensities", !data.I.empty());
    if (!data.splats.empty()) names.push_back(fmt::format("splats of degree {}", data.splats.degree()));
    return names;
}

void add_texture(const char* use, const Texture& texture, Json& textures) {
    if (!texture) return;
    Json entry{{"use", use}, {"path", texture.path}};
    entry.update(describe(*texture.image));
    textures.push_back(std::move(entry));
}

Json describe(const Material& material) {
    Json textures = Json::array();
    for (const MaterialTexture& use : material_textures())
        add_texture(use.name, material.*use.texture, textures);
    Json json{{"name", material.name},
              {"base_color", describe(material.base_color.cast<double>())},
              {"metallic", material.metallic},
              {"roughness", material.roughness},
              {"textures", textures}};
    // Of the rest what is not as usual.
    const Material usual;
    for (const MaterialNumber& number : material_numbers())
        if (material.*number.value != usual.*number.value) json[number.name] = material.*number.value;
    for (const MaterialColor& color : material_colors())
        if (material.*color.value != usual.*color.value)
            json[color.name] = describe((material.*color.value).cast<double>());
    return json;
}

/// Extent of the finite values; empty (min > max) where there are none.
struct Extent {
    float min = std::numeric_limits<float>::infinity(), max = -std::numeric_limits<float>::infinity();

    void add(const Array1f& values) {
        for (Eigen::Index i = 0; i < values.rows(); ++i) {
            if (!std::isfinite(values(i))) continue;
            min = std::min(min, values(i));
            max = std::max(max, values(i));
        }
    }
};

/// Scalars by their name and what they belong to: nodes may have some of the same.
using ScalarExtents = std::map<std::pair<std::string, std::string>, Extent>;

void add_scalars(const MeshData& data, ScalarExtents& scalars) {
    for (const ScalarArray& scalar : data.scalars) {
        if (scalar.values.empty()) continue;
        const bool of_vertices = element_of(data, scalar.values.rows()) == PerElement::vertex;
        scalars[{scalar.name, of_vertices ? "vertices" : "faces"}].add(scalar.values);
    }
}

Json describe(const ScalarExtents& scalars) {
    Json json = Json::array();
    for (const auto& [scalar, extent] : scalars) {
        Json entry{{"name", scalar.first}, {"of", scalar.second}};
        if (extent.min <= extent.max) entry.update({{"min", extent.min}, {"max", extent.max}});
        json.push_back(std::move(entry));
    }
    return json;
}

/// Sums over all nodes of a file.
struct Summary {
    Eigen::Index vertices = 0, faces = 0;
    size_t nodes = 0, parts = 0;
    Box3d bounds;
    std::set<std::string> attributes;
    std::map<std::string, Json> materials;
    ScalarExtents scalars;

    void add(const MeshData& data, const Eigen::Affine3d& T_world_mesh) {
        ++nodes;
        vertices += data.V.rows();
        faces += data.F.rows();
        parts += data.parts.empty() && !data.F.empty() ? 1 : data.parts.size();
        for (Eigen::Index i = 0; i < data.V.rows(); ++i)
            bounds.extend(T_world_mesh * Vec3d(data.V.row(i).transpose().cast<double>() + data.offset));
        for (const std::string& name : attributes_of(data)) attributes.insert(name);
        add_scalars(data, scalars);
        for (const Material& material : data.materials) {
            Json entry = describe(material);
            const std::string key = entry.dump(-1, ' ', false, Json::error_handler_t::replace);
            materials.emplace(key, std::move(entry));
        }
    }
};

template <class Value>
Json names_of(const std::map<std::string, Value>& values) {
    Json names = Json::array();
    for (const auto& [name, value] : values) names.push_back(name);
    return names;
}

Json describe(const Animations& animations) {
    Json json = Json::array();
    const std::vector<std::string> names = animations.names();
    for (size_t i = 0; i < names.size(); ++i)
        json.push_back({{"name", names[i]}, {"duration_s", animations.duration_s(i)}});
    return json;
}

Json describe(const io::LoadedScene& loaded) {
    Summary sum;
    for_each_node(loaded.mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d& T) {
        sum.add(*data, T);
    });
    Json materials = Json::array();
    for (const auto& entry : sum.materials) materials.push_back(entry.second);
    Json json{{"vertices", sum.vertices}, {"faces", sum.faces},     {"nodes", sum.nodes},
              {"parts", sum.parts},       {"materials", materials}, {"attributes", sum.attributes}};
    json["scalars"] = describe(sum.scalars);
    if (!sum.bounds.isEmpty())
        json["bounds"] = {{"min", describe(sum.bounds.min())}, {"max", describe(sum.bounds.max())}};
    json["lights"] = loaded.lights.size();
    json["cameras"] = loaded.cameras.size();
    json["light_names"] = names_of(loaded.lights);
    json["camera_names"] = names_of(loaded.cameras);
    json["animations"] = describe(loaded.animations);
    json["variants"] = loaded.variants;
    return json;
}

std::string row(const Json& numbers) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", numbers[0].get<double>(), numbers[1].get<double>(),
                       numbers[2].get<double>());
}

std::string image_text(const Json& image) {
    return fmt::format("{}x{}, {} channels, {}", image["width"].get<int>(), image["height"].get<int>(),
                       image["channels"].get<int>(), image["type"].get<std::string>());
}

/// Corners with as many digits as tell places apart that are a hundred thousandth of the box's size from each
/// other: far from zero that takes more than the usual six.
std::string box_text(const Json& low, const Json& high) {
    double size = 0, farthest = 0;
    for (size_t k = 0; k < 3; ++k) {
        size = std::max(size, high[k].get<double>() - low[k].get<double>());
        farthest = std::max({farthest, std::abs(low[k].get<double>()), std::abs(high[k].get<double>())});
    }
    const double digits = size > 0 ? std::ceil(std::log10(farthest / size) + 5) : 6;
    const int precision = int(std::clamp(digits, 6.0, 17.0));
    const auto corner = [&](const Json& p) {
        return fmt::format("({:.{}g}, {:.{}g}, {:.{}g})", p[0].get<double>(), precision, p[1].get<double>(),
                           precision, p[2].get<double>(), precision);
    };
    return corner(low) + " to " + corner(high);
}

void print_scalars(const Json& scalars) {
    for (const Json& scalar : scalars) {
        const std::string range =
            scalar.contains("min")
                ? fmt::format("{:.6g} to {:.6g}", scalar["min"].get<double>(), scalar["max"].get<double>())
                : "no values";
        fmt::print("{:<12}'{}' of {}: {}\n", "scalar", scalar["name"].get<std::string>(),
                   scalar["of"].get<std::string>(), range);
    }
}

void print_mesh(const Json& mesh) {
    for (const char* count : {"vertices", "faces", "nodes", "parts"})
        fmt::print("{:<12}{}\n", count, mesh[count].get<size_t>());
    for (const auto& [count, names] : {std::pair("lights", "light_names"), {"cameras", "camera_names"}}) {
        const auto each = mesh[names].get<std::vector<std::string>>();
        fmt::print("{:<12}{}{}{}\n", count, each.size(), each.empty() ? "" : ": ", fmt::join(each, ", "));
    }
    for (const Json& animation : mesh["animations"])
        fmt::print("{:<12}'{}': {:.4g} s\n", "animation", animation["name"].get<std::string>(),
                   animation["duration_s"].get<double>());
    const auto attributes = mesh["attributes"].get<std::vector<std::string>>();
    fmt::print("{:<12}{}\n", "attributes",
               attributes.empty() ? "none" : fmt::format("{}", fmt::join(attributes, ", ")));
    print_scalars(mesh["scalars"]);
    if (const auto variants = mesh["variants"].get<std::vector<std::string>>(); !variants.empty())
        fmt::print("{:<12}{}\n", "variants", fmt::join(variants, ", "));
    if (mesh.contains("bounds"))
        fmt::print("{:<12}{}\n", "bounds", box_text(mesh["bounds"]["min"], mesh["bounds"]["max"]));
    for (const Json& material : mesh["materials"]) {
        fmt::print("{:<12}'{}': base colour {}, metallic {:.3g}, roughness {:.3g}\n", "material",
                   material["name"].get<std::string>(), row(material["base_color"]),
                   material["metallic"].get<float>(), material["roughness"].get<float>());
        for (const Json& texture : material["textures"])
            fmt::print("{:<12}  {}: {} ({})\n", "", texture["use"].get<std::string>(),
                       texture["path"].get<std::string>(), image_text(texture));
    }
}

int run_info(const InfoOptions& options) {
    require(!options.file.empty(), "info", "a FILE");
    check_input("info", {options.file});
    const bool is_image = is_image_file(options.file);
    const Json json = is_image ? describe(io::load_image(options.file))
                               : describe(load_input(options.file, {.format = options.format}));
    if (options.json)
        fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    else if (is_image)
        fmt::print("{}\n", image_text(json));
    else
        print_mesh(json);
    return 0;
}

}  // namespace

void add_info(CLI::App& app, Job& job) {
    set_job<InfoOptions>(*app.add_subcommand("info", "Print the contents of a mesh or image file"), job,
                         declare_info, run_info);
}

}  // namespace easypbr::cli
