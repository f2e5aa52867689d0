// Maps of an environment, as textures and in host memory.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/gl/texture.h"
#include "easypbr/gpu/prefilter.h"
#include "easypbr/native/views.h"
#include "easypbr/scene/environment.h"

namespace easypbr::gpu {

/// Keeps the maps of the environment used last. Each is made when it is first asked for, those of the driver
/// and those in host memory: traced paths need none.
class EnvironmentMaps {
  public:
    /// From now on the maps are of this environment, and, unless it is empty, the picture is that of the one
    /// that is seen.
    void prepare(const Environment& environment, const Environment& seen);

    const gl::Texture& prefiltered() const;
    const gl::Texture& irradiance() const;
    /// The picture itself with all mip levels, once prepare() was given one.
    const gl::Texture& equirect() const;
    /// What the texels of prefiltered() and irradiance(), and of equirect(), are to be multiplied by.
    float scale() const;
    float seen_scale() const;
    int equirect_width() const { return seen_.image().width(); }
    float last_level() const;

    // The same for native shaders; valid until the next prepare().
    const native::Cube& host_prefiltered() const;
    const native::Cube& host_irradiance() const;
    const native::Panorama& host_equirect() const;

  private:
    struct HostCube {
        std::vector<uint16_t> texels;
        native::Cube cube;
    };
    struct HostPanorama {
        std::vector<uint16_t> texels;
        native::Panorama panorama;
    };
    static HostCube host_cube(const std::vector<const std::vector<uint16_t>*>& levels, int size);
    static HostPanorama host_panorama(const Image& image, float scale);

    const PrefilteredEnvironment& maps() const;

    Environment environment_, seen_;
    mutable PrefilteredEnvironment maps_;
    mutable float seen_scale_ = 0;  ///< 0: not known yet
    mutable gl::Texture prefiltered_, irradiance_, equirect_;
    mutable HostCube host_prefiltered_, host_irradiance_;
    mutable HostPanorama host_equirect_;
};

}  // namespace easypbr::gpu
