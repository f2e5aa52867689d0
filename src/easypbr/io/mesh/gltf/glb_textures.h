// Textures and materials of a GLB file that is being written.
#pragma once

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/io/mesh/png_texels.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// JSON in the order it is written.
using OrderedJson = nlohmann::ordered_json;

/// The growing content of a GLB file.
struct GlbContent {
    OrderedJson json = OrderedJson::object();
    std::string binary;

    /// Appends bytes, aligned to 4, as a buffer view and returns its index.
    size_t add_view(const void* data, size_t size, int target = 0);
    /// The object of an extension of `object`, which is noted as used.
    OrderedJson& extend(OrderedJson& object, const char* extension);
};

/// glTF has one texture for metallic and roughness, and one for base colour and opacity. Names, for a
/// message, of those whose transform or wraps differ from those that the one has, and that cannot be
/// resampled into it: only where both repeat and a tile of one spans whole periods of the other.
std::vector<std::string> mappings_left_out_of_gltf(const MeshData& mesh);

class GlbMaterials {
  public:
    explicit GlbMaterials(GlbContent& content) : content_(content) {}

    /// Index of the material in the file, appended with its textures.
    /// `transparent_vertices`: what an automatic alpha mode depends on.
    size_t add(const Material& material, bool transparent_vertices);

  private:
    void add_surface(const Material& material, OrderedJson& json);
    void add_emission(const Material& material, OrderedJson& json);
    void add_layers(const Material& material, OrderedJson& json);
    void add_dielectric(const Material& material, OrderedJson& json);
    /// One texture of base colour and opacity.
    Texture base_color(const Material& material);
    /// A texture that is read from one channel, which the format fixes.
    void add_channel(OrderedJson& extension, const char* key, const Texture& texture, int channel);
    void add_colors(OrderedJson& extension, const char* key, const Texture& texture, std::string_view name);
    void add_vectors(OrderedJson& extension, const char* key, const Texture& texture);
    /// `name`: see PngTexels::of(); of colours.
    OrderedJson texture_info(const Texture& texture, TexelUse use, std::string_view name = {});
    size_t image_index(const std::shared_ptr<const Image>& image);
    size_t texture_index(const Texture& texture, TexelUse use, std::string_view name);

    GlbContent& content_;
    PngTexels texels_;
    std::map<std::shared_ptr<const Image>, size_t> images_;
};

}  // namespace easypbr::io
