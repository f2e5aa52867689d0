// Environment: an equirectangular HDR environment map for image-based lighting.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"

namespace easypbr {

/// Direction of a point (u, v) of an equirectangular map in [0, 1]^2, v = 0 on top: +Y is up, u = 0.5 is -Z,
/// u grows to the right (towards +X) for a viewer inside.
Vec3 equirect_direction(float u, float v);
/// The inverse: (u, v) of a unit direction.
Vec2 equirect_uv(const Vec3& direction);

/// What shines so brightly from so small a spot that it casts shadows.
struct Sun {
    Vec3 towards{0, 1, 0};     ///< unit, in the environment's frame
    Vec3 irradiance{0, 0, 0};  ///< on a surface that faces it
    float angular_radius_deg = 0;
};

/// Immutable, shared by handle. Empty when default-constructed: its image is empty, its name and hash are "",
/// nothing shines.
class Environment {
  public:
    Environment() = default;
    /// Takes a linear f32 picture with 3 channels (others are converted); the first row is straight up. NaN,
    /// infinite and negative values are replaced by 0 and reported to the log. Throws ArgumentError when it
    /// is empty.
    explicit Environment(Image equirect, std::string name = {});
    /// Reads HDR, EXR, PNG or JPEG (defined in io). Throws FileError, FormatError.
    explicit Environment(const std::filesystem::path& path);

    bool empty() const { return data_ == nullptr; }
    const Image& image() const;
    const std::string& name() const;
    /// Content hash of the pixels: the cache key of everything derived from them.
    const std::string& hash() const;

    /// Irradiance divided by pi on a surface with this unit normal, from spherical harmonics up to degree 2
    /// (Ramamoorthi and Hanrahan 2001), never negative. Good to a few percent: for exposure, not for shading.
    Vec3 irradiance_over_pi(const Vec3& normal) const;

    /// The sun, if there is one; detected at the first call.
    const std::optional<Sun>& sun() const;
    /// The environment map without the sun; the same map if there is none.
    Environment without_sun() const;

  private:
    struct Split;
    struct Data;
    const Data& data() const;
    const Split& split() const;
    std::shared_ptr<const Data> data_;
};

/// The built-in studio: a dim room with soft boxes above, left, right and behind, computed.
const Environment& studio_environment();

}  // namespace easypbr
