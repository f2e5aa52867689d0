// What is made of meshes to draw them, kept by revision and shared by all passes.
#pragma once

#include "easypbr/gpu/closed_meshes.h"
#include "easypbr/gpu/mesh_buffers.h"
#include "easypbr/gpu/point_buffers.h"
#include "easypbr/gpu/surfel_buffers.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

struct DataCaches {
    gpu::MeshCache meshes;
    gpu::TextureCache textures;
    SpacingCache spacings;
    gpu::ClosedMeshes closed_meshes;
    gpu::PointCache points;
    gpu::SurfelCache surfels;

    /// Forgets what has not been asked for since the last call.
    void evict_unused() {
        meshes.evict_unused();
        textures.evict_unused();
        spacings.evict_unused();
        closed_meshes.evict_unused();
        points.evict_unused();
        surfels.evict_unused();
    }
};

}  // namespace easypbr::render
