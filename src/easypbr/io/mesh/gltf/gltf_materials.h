// Materials of a glTF file with their textures.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/scene/material.h"

namespace easypbr::io {

/// KHR_texture_transform: scaling first, then turning counter-clockwise, then shifting, where v goes down.
struct GltfTextureTransform {
    Vec2d offset{0, 0}, scale{1, 1};
    double rotation = 0;  ///< radians

    /// For our v, which goes up: both sides are flipped.
    Mat3 matrix() const;
};

/// Of a texture info's extension.
GltfTextureTransform read_texture_transform(const GltfDocument& document, const Json& json);

/// Where a material's JSON names its textures ("pbrMetallicRoughness/baseColorTexture"), and what they are
/// read into.
std::vector<std::pair<std::string, Texture Material::*>> gltf_texture_places();

class GltfMaterials {
  public:
    /// Reads all materials; each image that one of them names is decoded once, all in parallel. An image that
    /// is missing or damaged is a warning in the log, and the material goes without.
    explicit GltfMaterials(GltfDocument& document);

    /// The default material of glTF for no index. Throws FormatError when there is no such material.
    const Material& material(std::optional<size_t> index) const;
    /// The set of texture coordinates (TEXCOORD_n) that the material's textures are laid on.
    int uv_set(std::optional<size_t> index) const;

  private:
    struct Entry {
        Material material;
        int uv_set = 0;
    };
    const Entry& entry(std::optional<size_t> index) const;

    GltfDocument& document_;
    Entry default_;
    std::vector<Entry> entries_;
};

}  // namespace easypbr::io
