#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "easypbr/core/error.h"
#include "easypbr/core/octahedral.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/suggest.h"
#include "easypbr/gl/context.h"
#include "easypbr/render/pipeline/renderer.h"

namespace easypbr::render {
namespace {

template <class T>
std::vector<T> read(const gl::Framebuffer& framebuffer, unsigned index, gl::Format format) {
    const size_t bytes = size_t(framebuffer.width()) * size_t(framebuffer.height()) * gl::pixel_bytes(format);
    std::vector<T> values(bytes / sizeof(T));
    framebuffer.read(index, format, 0, 0, framebuffer.width(), framebuffer.height(),
                     std::as_writable_bytes(std::span(values)));
    return values;
}

PixelType pixel_type(gl::Format format) {
    return format == gl::Format::rgba8    ? PixelType::u8
           : format == gl::Format::rgba16 ? PixelType::u16
                                          : PixelType::f32;
}

}  // namespace

const std::vector<std::string>& layer_names() {
    static const std::vector<std::string> names = {
        "albedo",    "normal_world",      "depth",     "roughness", "metallic",
        "occlusion", "ambient_occlusion", "object_id", "element_id"};
    return names;
}

std::string layer_formerly(const std::string& name) {
    return name == "normal"    ? "normal_world"
           : name == "id"      ? "object_id"
           : name == "element" ? "element_id"
                               : "";
}

Layer layer_named(const std::string& name) {
    const auto& names = layer_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (const std::string now = layer_formerly(name); !now.empty())
        throw NameError(fmt::format("there is no layer '{}': it is called '{}'", name, now));
    if (found == names.end())
        throw NameError(fmt::format("there is no layer '{}'{}: expected {}", name, did_you_mean(name, names),
                                    fmt::join(names, ", ")));
    return Layer(found - names.begin());
}

Image Renderer::read_picture() const {
    return read_picture(output_.picture().width(), output_.picture().height());
}

Image Renderer::read_picture(const PixelRect& area) const {
    Image image(area.width, area.height, 4, pixel_type(output_.format()));
    output_.picture().read(0, output_.format(), area.x, area.y, area.width, area.height, image.bytes());
    return image;
}

Image Renderer::begin_reading(gl::Readback& readback) const {
    const gl::Framebuffer& from = output_.picture();
    readback.begin(from, 0, output_.format(), 0, 0, from.width(), from.height());
    return {from.width(), from.height(), 4, pixel_type(output_.format())};
}

Image Renderer::read_layer(Layer layer) const {
    const std::vector<float> depth = read<float>(targets_.surface, 3, gl::Format::r32f);
    const int channels = layer == Layer::albedo ? 4 : layer == Layer::normal_world ? 3 : 1;
    Image image(targets_.size().x(), targets_.size().y(), channels, PixelType::f32);
    float* to = image.pixels<float>().data();
    const auto for_each_covered = [&](auto&& body) {
        parallel_for(depth.size(), 1 << 14, [&](size_t i) {
            if (depth[i] > 0) body(i);
        });
    };
    if (layer == Layer::depth) {
        const float near = float(camera_.near), far = float(camera_.far);
        const bool orthographic = camera_.projection == Projection::orthographic;
        for_each_covered(
            [&](size_t i) { to[i] = orthographic ? far + (near - far) * depth[i] : near / depth[i]; });
    } else if (layer == Layer::albedo) {
        const auto texels = read<uint16_t>(targets_.surface, 0, gl::Format::rgba16);
        for_each_covered([&](size_t i) {
            for (size_t c = 0; c < 3; ++c) to[4 * i + c] = float(texels[4 * i + c]) / 65535.0f;
            to[4 * i + 3] = 1;
        });
    } else if (layer == Layer::normal_world) {
        const auto texels = read<uint16_t>(targets_.surface, 1, gl::Format::rg16);
        for_each_covered([&](size_t i) {
            const Vec3 n = oct_decode(Vec2(texels[2 * i], texels[2 * i + 1]) / 32767.5f - Vec2(1, 1));
            std::copy_n(n.data(), 3, to + 3 * i);
        });
    } else if (layer == Layer::object_id || layer == Layer::element_id) {
        if (!targets_.id)
            throw ArgumentError(fmt::format("layer {}: the last picture was drawn without ids",
                                            layer_names()[size_t(layer)]));
        const auto texels =
            read<uint32_t>(targets_.surface_ids, layer == Layer::object_id ? 5 : 6, gl::Format::r32ui);
        if (layer == Layer::object_id) {
            for_each_covered([&](size_t i) { to[i] = float(texels[i]); });
        } else {
            // Elements of the user's own data, not of what was made of them to be drawn.
            const auto objects = read<uint32_t>(targets_.surface_ids, 5, gl::Format::r32ui);
            for_each_covered(
                [&](size_t i) { to[i] = float(element_sources_[objects[i] - 1].own(texels[i])); });
        }
    } else if (layer == Layer::ambient_occlusion) {
        if (!targets_.ambient_occlusion) {  // Nothing occludes anything.
            for_each_covered([&](size_t i) { to[i] = 1; });
            return image;
        }
        const auto texels = read<uint16_t>(targets_.occluded, 0, gl::Format::r16);
        for_each_covered([&](size_t i) { to[i] = float(texels[i]) / 65535.0f; });
    } else {
        const size_t channel = layer == Layer::metallic ? 0 : layer == Layer::roughness ? 1 : 2;
        const auto texels = read<uint8_t>(targets_.surface, 2, gl::Format::rgba8);
        for_each_covered([&](size_t i) { to[i] = float(texels[4 * i + channel]) / 255.0f; });
    }
    return image;
}

}  // namespace easypbr::render
