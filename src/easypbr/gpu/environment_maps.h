// Textures of an environment.
#pragma once

#include <string>

#include "easypbr/gl/texture.h"
#include "easypbr/scene/environment.h"

namespace easypbr::gpu {

/// Keeps the textures of the environment used last.
class EnvironmentMaps {
  public:
    /// Makes the textures for this environment unless they are those already there, and, unless it is empty,
    /// the picture of the one that is seen.
    void prepare(const Environment& environment, const Environment& seen);

    const gl::Texture& prefiltered() const { return prefiltered_; }
    const gl::Texture& irradiance() const { return irradiance_; }
    /// The picture itself with all mip levels; there once prepare() was given one.
    const gl::Texture& equirect() const { return equirect_; }
    float last_level() const;

  private:
    std::string hash_, equirect_hash_;
    gl::Texture prefiltered_, irradiance_, equirect_;
};

}  // namespace easypbr::gpu
