// What texels of a shadow map hold of a mesh whose opacity or colour varies, natively.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "easypbr/gpu/facing.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/render/primitives/shadow_layer.h"

namespace easypbr::render {

/// Whether a caster's shadow follows from textures.
bool casts_by_texture(const DrawItem& item);
/// Features of shadow_depth.frag for an item without a shader of its own.
std::vector<std::string> mesh_caster_defines(const DrawItem& item);
/// The part of what a caster takes from light that each of its faces takes, as an exponent: light crosses the
/// faces of a volume twice, and those of thin surfaces and of open meshes once.
float share_of_face(const DrawItem& item, gpu::Winding winding);
/// Part of light that goes through what is covered, but for colours that vary over the surface.
Vec3 light_through(const DrawItem& item, float share);
/// What shadow_depth.frag reads, textures for the driver or for native shaders.
ShaderInputs caster_inputs(const DrawItem& item, gpu::Winding winding, gpu::TextureCache& textures,
                           bool native);

/// The texels of one item in one map.
class CasterSurface {
  public:
    /// `colors`: of vertices, linear r g b a; null where there are none.
    CasterSurface(const ShadowView& view, int resolution, const DrawItem& item, gpu::Winding winding,
                  gpu::TextureCache& textures, const float* colors);

    /// See native::casters_of_triangles().
    void shade(std::span<const native::VisiblePixel> texels, std::span<float> values) const;
    /// The same of opacities alone.
    void alpha(std::span<const native::VisiblePixel> texels, std::span<float> alpha) const;

  private:
    native::VisibleTriangles triangles_;
    std::shared_ptr<const void> shader_;
};

}  // namespace easypbr::render
