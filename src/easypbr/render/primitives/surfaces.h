// The surfaces of all kinds of primitives, into the G-buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/primitives/caches.h"
#include "easypbr/render/primitives/mesh/geometry_pass.h"
#include "easypbr/render/primitives/points/point_pass.h"
#include "easypbr/render/primitives/surfels/surfel_layers.h"
#include "easypbr/render/primitives/surfels/surfel_pass.h"
#include "easypbr/render/raster/software_geometry_pass.h"

namespace easypbr::render {

class SurfacePasses {
  public:
    /// The caches must outlive this.
    explicit SurfacePasses(DataCaches& caches);

    /// Fills the targets with the surfaces of the list, each kind by the faster way that can draw it:
    /// natively without a GPU, by the driver otherwise. What is drawn over everything else comes last.
    /// Returns the rectangle that all surfaces and lines are inside.
    PixelRect draw(const Frame& frame, const DrawList& list, const GBuffer& targets,
                   const SurfaceOutputs& outputs);
    /// The surfaces alone that are drawn over everything else, after draw(); those of layers may come later.
    GBuffer& over(const Frame& frame);

    /// Which pixels of a small frame the list covers: 1 or 0, row by row.
    std::vector<uint8_t> coverage(const Frame& frame, const DrawList& list);

    /// Layers: begin_layers() once, then draw_layer() for each that is peeled, and take_layer() for those
    /// that hold something. Nothing behind `opaque` (R32F, reversed depth) is drawn.
    void begin_layers(const Frame& frame, const DrawList& list, const gl::Texture& opaque);
    void draw_layer(const Frame& frame, const DrawList& list, const GBuffer& layer,
                    const SurfaceOutputs& outputs);
    void take_layer(const DrawList& list);
    /// The back faces of the meshes of a list.
    void draw_backs(const Frame& frame, const std::vector<DrawItem>& meshes, const GBuffer& targets,
                    const SurfaceOutputs& outputs);
    /// Points alone, into cleared targets.
    void draw_points(const Frame& frame, const std::vector<DrawItem>& points, const GBuffer& targets);

    /// Without a GPU, plain triangles are rasterised natively; false leaves them to the driver.
    void allow_native(bool allow) { allow_native_ = allow; }
    void evict_unused() { software_.evict_unused(); }

  private:
    bool is_native() const;
    PixelRect draw_kinds(const Frame& frame, const DrawList& list, const GBuffer& targets,
                         const SurfaceOutputs& outputs);

    GeometryPass meshes_;
    SoftwareGeometryPass software_;
    PointPass points_;
    SurfelSplats surfel_splats_;
    SurfelPass surfels_{surfel_splats_};
    SurfelLayers surfel_layers_{surfel_splats_};
    SurfaceComposite composite_;
    GBuffer over_;
    GBuffer coverage_;
    bool allow_native_ = true;
};

}  // namespace easypbr::render
