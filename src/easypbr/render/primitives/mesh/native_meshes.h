// Triangles without the driver's rasteriser: for machines without a GPU.
#pragma once

#include <span>
#include <tuple>

#include "easypbr/core/revision_cache.h"
#include "easypbr/gpu/closed_meshes.h"
#include "easypbr/render/primitives/mesh/mesh_surface.h"
#include "easypbr/render/primitives/primitive.h"

namespace easypbr::render {

class NativeMeshes {
  public:
    /// The cache is shared with others, must outlive this one, and is emptied by its owner.
    explicit NativeMeshes(gpu::ClosedMeshes& closed) : closed_(closed) {}

    // See Primitive. Native are plain surfaces, without textures, emission or alpha.
    static bool draws(DrawItems items);
    bool rasterise(const Frame& frame, DrawItems items, VisibleSurfaces& surfaces);
    bool cover(const Frame& frame, DrawItems items, std::span<uint8_t> covered);

    void evict_unused() { facts_.evict_unused(); }

  private:
    const MeshFacts& facts_of(const MeshData& mesh);

    RevisionCache<std::tuple<uint64_t, uint64_t, uint64_t>, MeshFacts> facts_;
    gpu::ClosedMeshes& closed_;
};

}  // namespace easypbr::render
