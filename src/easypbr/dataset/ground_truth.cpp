#include "easypbr/dataset/ground_truth.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "easypbr/core/suggest.h"
#include "easypbr/dataset/flow.h"
#include "easypbr/dataset/layers.h"

namespace easypbr::dataset {
namespace {

bool wants(const std::vector<std::string>& layers, const std::string& name) {
    return std::ranges::find(layers, name) != layers.end();
}

bool wants_flow(const std::vector<std::string>& layers, const std::string& direction) {
    return wants(layers, "flow_" + direction) || wants(layers, "occlusion_" + direction);
}

void check(const std::vector<std::string>& layers, const TruthOptions& options) {
    const auto& known = truth_layer_names();
    for (const std::string& name : layers)
        if (std::ranges::find(known, name) == known.end())
            throw NameError(fmt::format("there is no layer '{}'{}: expected {}", name,
                                        did_you_mean(name, known), fmt::join(known, ", ")));
    const auto need = [&](const char* direction, const app::Moment* moment, const char* which) {
        if (wants_flow(layers, direction) && !moment)
            throw ArgumentError(
                fmt::format("layer flow_{}: it needs the {} frame, which was not given", direction, which));
    };
    need("forward", options.next, "next");
    need("backward", options.previous, "previous");
}

LayerArray picture_layer(const Image& image) {
    LayerArray layer{image.width(), image.height(), image.channels(), {}};
    if (image.type() == PixelType::u8)
        layer.values = std::vector<uint8_t>(image.pixels<uint8_t>().begin(), image.pixels<uint8_t>().end());
    else
        layer.values = std::vector<float>(image.pixels<float>().begin(), image.pixels<float>().end());
    return layer;
}

Surfaces read(const app::Drawn& drawn) {
    return surfaces_of(drawn.surfaces(), drawn.camera(), drawn.lens());
}

}  // namespace

const std::vector<std::string>& truth_layer_names() {
    static const std::vector<std::string> names = {"color",
                                                   "hdr",
                                                   "depth",
                                                   "distance",
                                                   "position",
                                                   "normal_world",
                                                   "normal_camera",
                                                   "albedo",
                                                   "roughness",
                                                   "metallic",
                                                   "instance_id",
                                                   "semantic_id",
                                                   "object_coordinates",
                                                   "face_id",
                                                   "barycentrics",
                                                   "uv",
                                                   "flow_forward",
                                                   "occlusion_forward",
                                                   "flow_backward",
                                                   "occlusion_backward"};
    return names;
}

GroundTruth ground_truth(app::Session& session, const std::vector<std::string>& layers,
                         const TruthOptions& options) {
    check(layers, options);
    GroundTruth truth;
    app::PictureOptions picture{options.size, options.samples, app::Encoding::srgb8};
    const bool color = wants(layers, "color"), hdr = wants(layers, "hdr");
    std::optional<Surfaces> next, previous;
    if (wants_flow(layers, "forward")) next = read(session.draw_surfaces(picture, false, options.next));
    if (wants_flow(layers, "backward"))
        previous = read(session.draw_surfaces(picture, false, options.previous));
    if (color && hdr)
        truth.layers["hdr"] =
            picture_layer(session.render({options.size, options.samples, app::Encoding::scene_linear}));
    else if (hdr)
        picture.encoding = app::Encoding::scene_linear;
    const app::Drawn drawn = session.draw_surfaces(picture, color || hdr);
    const Surfaces now = read(drawn);
    truth.size = now.size;
    truth.camera = now.camera;
    if (color || hdr) truth.layers[color ? "color" : "hdr"] = picture_layer(drawn.picture());
    if (next) optical_flow(now, *next, truth.layers["flow_forward"], truth.layers["occlusion_forward"]);
    if (previous)
        optical_flow(now, *previous, truth.layers["flow_backward"], truth.layers["occlusion_backward"]);
    const InstanceTable table(now, options.instances_by, options.classes);
    for (const std::string& name : layers) {
        if (truth.layers.contains(name)) continue;
        std::optional<LayerArray> layer = surface_layer(name, now, table);
        if (!layer) layer = drawn_layer(name, drawn, now);
        truth.layers[name] = std::move(layer).value();
    }
    std::erase_if(truth.layers, [&](const auto& item) { return !wants(layers, item.first); });
    if (options.instances) truth.instances = annotate(drawn, now, table, options.amodal);
    return truth;
}

}  // namespace easypbr::dataset
