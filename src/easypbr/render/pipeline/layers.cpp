#include "easypbr/render/pipeline/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>

#include "easypbr/core/error.h"
#include "easypbr/core/octahedral.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/suggest.h"

namespace easypbr::render {
namespace {

/// Where a parameter of the material stands in the G-buffer's.
size_t channel_of(Layer layer) {
    switch (layer) {
        case Layer::metallic:
            return 0;
        case Layer::roughness:
            return 1;
        case Layer::occlusion:
            return 2;
        default:
            throw std::logic_error("layer " + layer_names()[size_t(layer)] + " is not read");
    }
}

}  // namespace

const std::vector<std::string>& layer_names() {
    // In the order of Layer.
    static const auto names =
        std::to_array<std::string>({"albedo", "normal_world", "depth", "roughness", "metallic", "occlusion",
                                    "ambient_occlusion", "object_id", "element_id"});
    static_assert(std::tuple_size_v<decltype(names)> == size_t(Layer::element_id) + 1);
    static const std::vector<std::string> list(names.begin(), names.end());
    return list;
}

std::string layer_formerly(const std::string& name) {
    return name == "normal"    ? "normal_world"
           : name == "id"      ? "object_id"
           : name == "element" ? "element_id"
                               : "";
}

Layer layer_named(const std::string& name) {
    if (const std::string now = layer_formerly(name); !now.empty())
        throw NameError(fmt::format("there is no layer '{}': it is called '{}'", name, now));
    const auto& names = layer_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw NameError(fmt::format("there is no layer '{}'{}: expected {}", name, did_you_mean(name, names),
                                    fmt::join(names, ", ")));
    return Layer(found - names.begin());
}

Image read_layer(Layer layer, const GBuffer& targets, const Camera& camera,
                 const std::vector<ElementSources>& sources, Transfers& transfers) {
    const std::vector<float> depth = targets.depth.read<float>(transfers);
    const int channels = layer == Layer::albedo ? 4 : layer == Layer::normal_world ? 3 : 1;
    Image image(targets.size().x(), targets.size().y(), channels, PixelType::f32);
    float* to = image.pixels<float>().data();
    const auto for_each_covered = [&](auto&& body) {
        parallel_for(depth.size(), 1 << 14, [&](size_t i) {
            if (depth[i] > 0) body(i);
        });
    };
    if (layer == Layer::depth) {
        const float near = float(camera.near), far = float(camera.far);
        const bool orthographic = camera.projection == Projection::orthographic;
        for_each_covered(
            [&](size_t i) { to[i] = orthographic ? far + (near - far) * depth[i] : near / depth[i]; });
    } else if (layer == Layer::albedo) {
        const auto texels = targets.albedo.read<uint16_t>(transfers);
        for_each_covered([&](size_t i) {
            for (size_t c = 0; c < 3; ++c) to[4 * i + c] = float(texels[4 * i + c]) / 65535.0f;
            to[4 * i + 3] = 1;
        });
    } else if (layer == Layer::normal_world) {
        const auto texels = targets.normal.read<uint16_t>(transfers);
        for_each_covered([&](size_t i) {
            const Vec3 n = oct_decode(Vec2(texels[2 * i], texels[2 * i + 1]) / 32767.5f - Vec2(1, 1));
            std::copy_n(n.data(), 3, to + 3 * i);
        });
    } else if (layer == Layer::object_id || layer == Layer::element_id) {
        if (!targets.id)
            throw ArgumentError(fmt::format("layer {}: the last picture was drawn without ids",
                                            layer_names()[size_t(layer)]));
        const Target& target = layer == Layer::object_id ? targets.id : targets.element;
        const auto texels = target.read<uint32_t>(transfers);
        if (layer == Layer::object_id) {
            for_each_covered([&](size_t i) { to[i] = float(texels[i]); });
        } else {
            // Elements of the user's own data, not of what was made of them to be drawn.
            const auto objects = targets.id.read<uint32_t>(transfers);
            for_each_covered([&](size_t i) { to[i] = float(sources[objects[i] - 1].own(texels[i])); });
        }
    } else if (layer == Layer::ambient_occlusion) {
        if (!targets.ambient_occlusion) {  // Nothing occludes anything.
            for_each_covered([&](size_t i) { to[i] = 1; });
            return image;
        }
        const auto texels = targets.ambient_occlusion.read<uint16_t>(transfers);
        for_each_covered([&](size_t i) { to[i] = float(texels[i]) / 65535.0f; });
    } else {
        const size_t channel = channel_of(layer);
        const auto texels = targets.material.read<uint8_t>(transfers);
        for_each_covered([&](size_t i) { to[i] = float(texels[4 * i + channel]) / 255.0f; });
    }
    return image;
}

Image mask_of_kind(SurfaceKind kind, const GBuffer& targets, Transfers& transfers) {
    const std::vector<float> depth = targets.depth.read<float>(transfers);
    const auto material = targets.material.read<uint8_t>(transfers);
    Image pixels(targets.size().x(), targets.size().y(), 1, PixelType::u8);
    uint8_t* to = pixels.pixels<uint8_t>().data();
    parallel_for(depth.size(), 1 << 14, [&](size_t i) {
        if (depth[i] > 0 && material[4 * i + 3] == uint8_t(kind)) to[i] = 255;
    });
    return pixels;
}

}  // namespace easypbr::render
