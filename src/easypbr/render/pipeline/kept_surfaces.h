// What the pixels' centres see: surfaces that are kept so that they can be drawn, read and asked about alone.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "easypbr/render/pipeline/pipeline.h"
#include "easypbr/render/pipeline/surface_frame.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {

class KeptSurfaces {
  public:
    KeptSurfaces(const SceneSnapshot& scene, DrawableScene drawable, const ResolvedSettings& resolved,
                 Vec2i size, const Material& textures, const ShaderFiles& shader_files);
    KeptSurfaces(const KeptSurfaces&) = delete;
    KeptSurfaces& operator=(const KeptSurfaces&) = delete;

    /// Fills the pipeline's targets, ids too.
    void draw(Pipeline& pipeline) const;
    /// What the targets hold after draw(). Throws ArgumentError when they have no ids.
    SurfaceFrame read(const GBuffer& targets, Transfers& transfers) const;
    /// See Renderer::coverage().
    std::vector<uint8_t> coverage(Pipeline& pipeline, const PixelRect& area,
                                  const std::function<bool(size_t object, int first_face)>& wanted) const;

    /// See Renderer::reaches().
    std::vector<ScreenReach> reaches(Pipeline& pipeline) const;

    /// See Renderer::blended().
    const std::vector<bool>& blended() const { return blended_; }

    const std::vector<ElementSources>& sources() const { return drawable_.sources; }

  private:
    Shot shot() const;
    /// That of its object in the snapshot.
    size_t place_of(const DrawItem& item) const;

    SceneSnapshot scene_;
    DrawableScene drawable_;
    ResolvedSettings resolved_;
    DrawList list_, shapes_;  ///< as surfaces and as shapes; their items point into drawable_
    std::vector<bool> blended_;
    Vec2i size_;
};

}  // namespace easypbr::render
