// Materials of a glTF file with their textures.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/scene/material.h"

namespace easypbr::io {

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
