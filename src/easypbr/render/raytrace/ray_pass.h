// Light of the sky and of other surfaces on what is seen, by rays on the CPU.
#pragma once

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/raytrace/ray_light.h"
#include "easypbr/render/raytrace/traced_light.h"

namespace easypbr::render {

/// For the frames of an accumulated image: each sends a few rays from every pixel, evenly spread over all
/// frames.
class RayPass {
  public:
    /// Fills what light() gives, in host memory, from the G-buffer's surfaces that are lit.
    void draw(const Frame& frame, const GBuffer& targets, const RayScene& scene, Transfers& transfers);
    const TracedLight& light() const { return light_; }

  private:
    struct Pixels;
    void make_targets(Vec2i size);

    RayLight rays_;
    std::vector<float> visible_;  ///< for each pixel, of all around, summed over the frames so far
    TracedLight light_;
};

}  // namespace easypbr::render
