// Material images with mip levels, on the device or in host memory.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "easypbr/core/memory_pool.h"
#include "easypbr/core/revision_cache.h"
#include "easypbr/gl/texture.h"
#include "easypbr/native/views.h"
#include "easypbr/scene/material.h"

namespace easypbr::gpu {

/// Textures by image, use (colour or data) and sampling.
class TextureCache {
  public:
    /// `color` images are sRGB (decoded before filtering), others are data.
    const gl::Texture& get(const Texture& texture, bool color);
    /// The same for native shaders.
    const native::Texture& host(const Texture& texture, bool color);

    /// Drops what was not asked for since the last call.
    void evict_unused() {
        entries_.evict_unused();
        host_entries_.evict_unused();
    }

  private:
    using Key = std::tuple<const Image*, bool, Wrap, Wrap, Filter>;
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
