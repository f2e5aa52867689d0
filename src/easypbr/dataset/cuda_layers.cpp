#include "easypbr/dataset/cuda_layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/log.h"
#include "easypbr/gl/context.h"

namespace easypbr::dataset {
namespace {

/// Why the picture's targets are not the layers; empty when they are.
std::string obstacle(const app::Drawn& drawn, const InstanceTable& table) {
    if (!drawn.lens().is_identity()) return "the camera's lens distorts";
    if (drawn.is_annotated()) return "a legend or colour bar is drawn into the picture";
    if (table.has_parts()) return "instances are parts of objects";
    return "";
}

std::vector<std::string> targets_of(const std::vector<std::string>& layers) {
    static const std::map<std::string, std::string> targets = {
        {"depth", "depth"},          {"distance", "depth"},      {"position", "depth"},
        {"normal_camera", "normal"}, {"normal_world", "normal"}, {"albedo", "albedo"},
        {"roughness", "material"},   {"metallic", "material"},   {"instance_id", "id"},
        {"semantic_id", "id"}};
    std::vector<std::string> names;
    for (const std::string& layer : layers)
        if (const auto found = targets.find(layer); found != targets.end()) names.push_back(found->second);
    if (!names.empty()) names.emplace_back("depth");
    return names;
}

const gl::Texture& target(const render::GBuffer& targets, const std::string& name) {
    const render::Target& target = name == "normal"     ? targets.normal
                                   : name == "albedo"   ? targets.albedo
                                   : name == "material" ? targets.material
                                   : name == "id"       ? targets.id
                                                        : targets.depth;
    return target.texture();
}

}  // namespace

const std::vector<std::string>& cuda_layer_names() {
    static const std::vector<std::string> names = {
        "color",        "hdr",    "depth",     "distance", "position",    "normal_camera",
        "normal_world", "albedo", "roughness", "metallic", "instance_id", "semantic_id"};
    return names;
}

std::optional<CudaLayers> cuda_layers(app::Session& session, const std::vector<std::string>& layers,
                                      const TruthOptions& options) {
    const gl::ContextScope scope(session.context());
    const auto leave = [](const std::string& why) -> std::optional<CudaLayers> {
        log_warning(fmt::format("CUDA: {}: layers are made on the CPU and copied to the GPU", why));
        return std::nullopt;
    };
    if (!gl::cuda_device())
        return leave(fmt::format("OpenGL draws on '{}', which is no CUDA device",
                                 gl::Context::current().info().renderer));
    CudaLayers result;
    const app::Moment now = session.moment(options.size);
    const InstanceTable table(now.scene, options.instances_by, options.classes);
    app::PictureOptions picture{options.size, options.samples, app::Encoding::srgb8};
    std::optional<app::Drawn> drawn;
    for (const std::string name : {"hdr", "color"}) {
        if (std::ranges::find(layers, name) == layers.end()) continue;
        picture.encoding = name == "hdr" ? app::Encoding::scene_linear : app::Encoding::srgb8;
        drawn = session.draw_surfaces(picture, true);
        if (const std::string why = obstacle(*drawn, table); !why.empty()) return leave(why);
        result.targets.emplace(name, gl::copy_to_cuda(drawn->texture()));
    }
    if (!drawn) drawn = session.draw_surfaces(picture, false);
    if (const std::string why = obstacle(*drawn, table); !why.empty()) return leave(why);
    for (const std::string& name : targets_of(layers))
        if (!result.targets.contains(name))
            result.targets.emplace(name, gl::copy_to_cuda(target(drawn->targets(), name)));
    result.near = now.camera.near;
    result.far = now.camera.far;
    result.orthographic = now.camera.projection == Projection::orthographic;
    result.rays = ray_slopes(now.camera, drawn->targets().size());
    result.T_world_cam = now.camera.opencv_T_world_cam();
    result.instance_ids.push_back(0);
    result.semantic_ids.push_back(0);
    bool has_labels = false;
    for (size_t i = 0; i < now.scene.objects.size(); ++i) {
        const Instance& instance = table.instances()[table.of(i, 0)];
        result.instance_ids.push_back(instance.id);
        result.semantic_ids.push_back(instance.semantic_id);
        has_labels |= !now.scene.objects[i].mesh->L.empty();
    }
    if (has_labels) result.semantic_ids.clear();
    return result;
}

}  // namespace easypbr::dataset
