// The surface of a pixel that the native rasteriser found a triangle in.
#pragma once

#include <memory>

#include "easypbr/gpu/facing.h"
#include "easypbr/render/primitives/hit_surface.h"
#include "easypbr/render/raster/visible_surfaces.h"

namespace easypbr::render {

/// What is known of a mesh beyond its data.
struct MeshFacts {
    Array3f N;
    bool normals_agree = true;  ///< the winding tells the normals' side
    gpu::Winding winding = gpu::Winding::unknown;
    Box3d box;  ///< of the vertices, when it is closed or small; else empty
};

/// What shaders read of an item's triangles, whatever sees them.
native::VisibleTriangles shading_triangles(const DrawItem& item, const MeshFacts& facts);

/// A mesh item with all that its pixels need.
class MeshSurface final : public VisibleItem {
  public:
    MeshSurface(const Frame& frame, const DrawItem& item, const MeshFacts& facts,
                const Mat4d& clip_from_mesh);

    /// Surfaces vary by a shader that reads the attributes too: native::surface_uniforms(), or with
    /// extensions native::extended_uniforms().
    void vary(std::shared_ptr<const void> shader, bool extended,
              const native::TriangleAttributes& attributes);

    /// The opacity of pixels, for what varies.
    void alpha(std::span<const native::VisiblePixel> pixels, std::span<float> alpha) const;

    void resolve(const Frame& frame, const DrawItem& item, std::span<const native::VisiblePixel> pixels,
                 SurfaceWriter& writer) const override;

  private:
    native::VisibleTriangles triangles_;  ///< without targets
    std::shared_ptr<const void> shader_;
};

/// The same for rays.
class MeshHits final : public HitSurface {
  public:
    /// See MeshSurface::vary(); of items with extensions the shader is native::extended_uniforms().
    MeshHits(const DrawItem& item, const MeshFacts& facts, std::shared_ptr<const void> shader,
             const native::TriangleAttributes& attributes);
    void shade(std::span<const native::ElementHit> hits, const native::HitSurfaces& surfaces) const override;

  private:
    native::VisibleTriangles triangles_;
    std::shared_ptr<const void> shader_;
};

}  // namespace easypbr::render
