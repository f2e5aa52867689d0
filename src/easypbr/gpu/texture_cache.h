// Material images with mip levels, on the device or in host memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <tuple>
#include <vector>

#include "easypbr/core/memory_pool.h"
#include "easypbr/core/revision_cache.h"
#include "easypbr/gl/texture.h"
#include "easypbr/native/views.h"
#include "easypbr/scene/material.h"

namespace easypbr::gpu {

/// What the channels of an image hold, by which its mip levels are made.
enum class TexelKind : uint8_t {
    data,
    color,           ///< sRGB, averaged as light
    covering_color,  ///< the same, weighted by alpha: colours that alpha hides do not show at other levels
};

/// Textures by image, kind and sampling. Warnings about texels come when a texture is made: `slot` names it
/// there, as "roughness_texture".
class TextureCache {
  public:
    const gl::Texture& get(const Texture& texture, TexelKind kind, std::string_view slot = "texture");
    /// The same for native shaders.
    const native::Texture& host(const Texture& texture, TexelKind kind, std::string_view slot = "texture");

    /// Drops what was not asked for since the last call.
    void evict_unused() {
        entries_.evict_unused();
        host_entries_.evict_unused();
    }

  private:
    using Key = std::tuple<const Image*, TexelKind, Wrap, Wrap, Filter>;
    struct Entry {
        std::shared_ptr<const Image> image;  ///< keeps the address from being used again
        gl::Texture texture;
    };
    struct HostEntry {
        std::shared_ptr<const Image> image;
        PooledVector<std::byte> texels;
        native::Texture texture;
    };
    RevisionCache<Key, Entry> entries_;
    RevisionCache<Key, HostEntry> host_entries_;
};

}  // namespace easypbr::gpu
