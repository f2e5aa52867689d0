// Triangles and points into the G-buffer without the driver's rasteriser: for machines without a GPU.
#pragma once

#include <map>
#include <optional>
#include <tuple>

#include "easypbr/gpu/closed_meshes.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/raster/mesh_surface.h"
#include "easypbr/render/raster/point_surface.h"
#include "easypbr/render/raster/visibility.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

/// Draws into the targets of GeometryPass, several times faster than a CPU rasteriser behind OpenGL: the
/// nearest triangle or point per pixel first, then the surface of each pixel once.
class SoftwareGeometryPass {
  public:
    /// The caches are shared with other passes, must outlive this one, and are emptied by their owner.
    SoftwareGeometryPass(SpacingCache& spacings, gpu::ClosedMeshes& closed)
        : spacings_(spacings), closed_(closed) {}

    /// Whether draw() can draw these meshes and points: plain ones, without textures, emission or alpha.
    static bool handles(const DrawList& list);
    /// The same of the points alone.
    static bool handles_points(const DrawList& list);

    /// Fills the G-buffer with the list's meshes and points and returns the rectangle that everything of the
    /// list is inside; nothing, with the G-buffer unchanged, when a mesh would have to be clipped.
    std::optional<PixelRect> draw(const Frame& frame, const DrawList& list, const GBuffer& targets,
                                  const SurfaceOutputs& outputs);

    /// Adds the list's points to what the G-buffer holds.
    void draw_points_over(const Frame& frame, const DrawList& list, const GBuffer& targets,
                          const SurfaceOutputs& outputs);

    /// Sets to 1 what meshes and points cover of the frame, row by row; false, with nothing set, when only
    /// the driver can draw them.
    bool cover(const Frame& frame, const DrawList& list, std::vector<uint8_t>& covered);

    void evict_unused();

  private:
    struct Surface;
    const MeshFacts& facts_of(const MeshData& mesh);
    bool add_meshes(const Frame& frame, const DrawList& list, std::vector<Surface>& surfaces);
    void add_points(const Frame& frame, const DrawList& list, std::vector<Surface>& surfaces);
    void resolve(const Frame& frame, const std::vector<Surface>& surfaces, bool ids);

    std::map<std::tuple<uint64_t, uint64_t, uint64_t>, MeshFacts> facts_;
    SpacingCache& spacings_;
    gpu::ClosedMeshes& closed_;
    VisibilityBuffer visibility_;
    NativePixels pixels_;
    SurfaceComposite composite_;
};

}  // namespace easypbr::render
