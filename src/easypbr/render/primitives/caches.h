// What is made of meshes and kept by revision, and shared by several kinds of primitives.
#pragma once

#include "easypbr/gpu/closed_meshes.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

struct DataCaches {
    gpu::TextureCache textures;
    SpacingCache spacings;
    gpu::ClosedMeshes closed_meshes;

    /// Forgets what has not been asked for since the last call.
    void evict_unused() {
        textures.evict_unused();
        spacings.evict_unused();
        closed_meshes.evict_unused();
    }
};

}  // namespace easypbr::render
