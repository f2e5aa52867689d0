#include "easypbr/cli/truth_layers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "easypbr/app/output.h"
#include "easypbr/cli/command.h"
#include "easypbr/core/file.h"
#include "easypbr/core/suggest.h"
#include "easypbr/dataset/ground_truth.h"
#include "easypbr/dataset/rle.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/render/pipeline/renderer.h"

namespace easypbr::cli {
namespace {

using nlohmann::json;

const std::string instances = "instances";

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

template <class Matrix>
json rows_of(const Matrix& matrix) {
    json rows = json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        json row = json::array();
        // JSON has no NaN, which a pixel behind the camera is.
        for (Eigen::Index k = 0; k < matrix.cols(); ++k)
            row.push_back(std::isfinite(matrix(i, k)) ? json(matrix(i, k)) : json());
        rows.push_back(std::move(row));
    }
    return rows;
}

json box_of(const dataset::PixelBox& box) {
    return {box.x, box.y, box.width, box.height};
}

json rle_of(const dataset::Bitmap& bitmap, Vec2i size) {
    std::vector<uint8_t> mask(size_t(size.x()) * size_t(size.y()));
    for (int y = 0; y < bitmap.area.height; ++y)
        std::copy_n(bitmap.pixels.begin() + long(y) * bitmap.area.width, bitmap.area.width,
                    mask.begin() + long(bitmap.area.y + y) * size.x() + bitmap.area.x);
    return {{"size", {size.y(), size.x()}},
            {"counts", dataset::rle_string(dataset::rle_counts(mask, size.x(), size.y()))}};
}

json json_of(const dataset::Instance& i) {
    const bool empty = i.box.isEmpty();
    const Vec3d center = empty ? Vec3d(Vec3d::Zero()) : Vec3d(i.box.center()),
                size = empty ? Vec3d(Vec3d::Zero()) : Vec3d(i.box.sizes());
    return {{"id", i.id},
            {"name", i.name},
            {"pixels_visible", i.pixels_visible},
            {"pixels_amodal", i.pixels_amodal},
            {"pixels_amodal_inside", i.pixels_amodal_inside},
            {"visible_fraction", i.visible_fraction},
            {"truncation", i.truncation},
            {"box_visible", box_of(i.box_visible)},
            {"box_amodal", box_of(i.box_amodal)},
            {"rle", rle_of(i.visible, i.picture)},
            {"amodal_rle", rle_of(i.amodal, i.picture)},
            {"T_world_obj", rows_of(i.T_world_obj.matrix())},
            {"T_cam_obj", rows_of(i.T_cam_obj.matrix())},
            {"box3d_center", {center.x(), center.y(), center.z()}},
            {"box3d_size", {size.x(), size.y(), size.z()}},
            {"corners_cam", rows_of(i.corners_cam)},
            {"corners_px", rows_of(i.corners_px)}};
}

/// EXR has one, three or four channels here.
Image image_of(const dataset::LayerArray& layer) {
    const int channels = layer.channels == 2 ? 3 : layer.channels;
    Image image(layer.width, layer.height, channels, PixelType::f32);
    const auto to = image.pixels<float>();
    std::visit(
        [&](const auto& values) {
            for (size_t i = 0; i < values.size(); ++i) {
                const size_t pixel = i / size_t(layer.channels), channel = i % size_t(layer.channels);
                to[pixel * size_t(channels) + channel] = float(values[i]);
            }
        },
        layer.values);
    return image;
}

std::vector<std::byte> exr_of(const dataset::LayerArray& layer) {
    // float32 has no room for all labels and faces.
    if (const auto* integers = std::get_if<std::vector<int32_t>>(&layer.values))
        return io::encode_exr(*integers, {layer.width, layer.height});
    return io::encode_exr(image_of(layer));
}

}  // namespace

std::vector<std::string> writable_layers() {
    std::vector<std::string> names = {instances};
    for (const std::string& name : dataset::truth_layer_names())
        if (name != "color" && name != "hdr" && !name.ends_with("ward")) names.push_back(name);
    for (const std::string& name : render::layer_names())
        if (!contains(names, name)) names.push_back(name);
    return names;
}

void check_layer(const std::string& name) {
    if (name.ends_with("ward") && contains(dataset::truth_layer_names(), name))
        throw UsageError(
            fmt::format("--layers: {} needs another frame: use render_layers() of the Python package", name));
    if (const std::string now = render::layer_formerly(name); !now.empty())
        throw UsageError(fmt::format("--layers: there is no layer '{}': it is called '{}'", name, now));
    const std::vector<std::string> known = writable_layers();
    if (!contains(known, name))
        throw UsageError(fmt::format("--layers: there is no layer '{}'{}: expected {}", name,
                                     did_you_mean(name, known), fmt::join(known, ", ")));
}

std::vector<std::string> truth_layers_of(const std::vector<std::string>& names) {
    std::vector<std::string> layers;
    for (const std::string& name : names)
        if (!contains(render::layer_names(), name)) layers.push_back(name);
    return layers;
}

fs::path truth_path(const fs::path& picture, const std::string& layer) {
    fs::path path = app::layer_path(picture, layer);
    return layer == instances ? path.replace_extension("json") : path;
}

void write_truth(app::Session& session, const fs::path& picture, const std::vector<std::string>& layers) {
    dataset::TruthOptions options;
    std::vector<std::string> arrays = layers;
    options.instances = std::erase(arrays, instances) > 0;
    const dataset::GroundTruth truth = dataset::ground_truth(session, arrays, options);
    for (const auto& [name, layer] : truth.layers) write_file(truth_path(picture, name), exr_of(layer));
    if (!options.instances) return;
    json list = json::array();
    for (const dataset::Instance& instance : truth.instances) list.push_back(json_of(instance));
    write_file(truth_path(picture, instances),
               list.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace easypbr::cli
