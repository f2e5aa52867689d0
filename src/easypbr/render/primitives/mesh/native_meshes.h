// Triangles without the driver's rasteriser: for machines without a GPU.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "easypbr/core/revision_cache.h"
#include "easypbr/gpu/closed_meshes.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/primitives/mesh/mesh_material.h"
#include "easypbr/render/primitives/mesh/mesh_surface.h"
#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/raster/face_clusters.h"

namespace easypbr::render {

class NativeMeshes {
  public:
    /// The caches are shared with others, must outlive this one, and are emptied by their owner.
    NativeMeshes(gpu::ClosedMeshes& closed, gpu::TextureCache& textures)
        : closed_(closed), textures_(textures) {}

    // See Primitive. Native are surfaces that are opaque or have a mask, without shaders of their own.
    static bool draws(DrawItems items);
    static bool draws_layers(DrawItems items);
    bool rasterise(const Frame& frame, DrawItems items, ExtensionSet extensions, VisibleSurfaces& surfaces);
    bool cover(const Frame& frame, DrawItems items, std::span<uint8_t> covered);

    /// Of the core model, whatever the material; without its own shader.
    std::unique_ptr<HitSurface> hit_surface(const ResolvedSettings& resolved, const DrawItem& item);

    /// Of vertices, linear r g b a.
    const float* colors_of(const MeshData& mesh);

    /// Of a part that has been drawn more than once; null where there are none.
    const FaceClusters* clusters_of(const MeshData& mesh, const MeshPart& part) const {
        return clusters_.find(mesh, part);
    }

    void evict_unused();

  private:
    const MeshFacts& facts_of(const DrawItem& item);
    /// What mesh_resolve reads, and with extensions mesh_extended.
    ShaderInputs inputs_of(const MaterialContext& context, const DrawItem& item, const MeshFacts& known);
    native::TriangleAttributes attributes_of(const DrawItem& item, const MeshFacts& known);
    std::unique_ptr<MeshSurface> surface_of(const Frame& frame, const DrawItem& item, ExtensionSet extensions,
                                            const MeshFacts& known, const Mat4d& clip_from_mesh);

    RevisionCache<std::tuple<uint64_t, uint64_t, uint64_t>, MeshFacts> facts_;
    /// Of vertices, linear r g b a.
    RevisionCache<uint64_t, std::vector<float>> colors_;
    /// Of corners, x y z w of 1/32767.
    RevisionCache<std::array<uint64_t, 5>, std::vector<int16_t>> tangents_;
    ClusteredMeshes clusters_;
    gpu::ClosedMeshes& closed_;
    gpu::TextureCache& textures_;
};

}  // namespace easypbr::render
