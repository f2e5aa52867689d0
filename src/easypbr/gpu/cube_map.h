// A cube map of floats on the CPU, with one texel of gutter around each face, so that sampling has no seams.
#pragma once

#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/environment.h"

namespace easypbr::gpu {

/// Unit direction of the point (u, v) in [-1, 1]^2 of a face, in OpenGL's layout.
Vec3 cube_direction(int face, float u, float v);

class CubeMap {
  public:
    explicit CubeMap(int size) : size_(size), texels_(size_t(6) * (size + 2) * (size + 2), Vec4::Zero()) {}

    int size() const { return size_; }
    /// Texel (x, y) of a face, -1 and size included (the gutter).
    Vec4& at(int face, int x, int y) { return texels_[index(face, x, y)]; }
    const Vec4& at(int face, int x, int y) const { return texels_[index(face, x, y)]; }

    /// Direction through the centre of a texel.
    Vec3 direction(int face, int x, int y) const {
        return cube_direction(face, (float(x) + 0.5f) * 2 / float(size_) - 1,
                              (float(y) + 0.5f) * 2 / float(size_) - 1);
    }

    /// Bilinear value in a direction, which need not be of unit length.
    Vec4 sample(const Vec3& direction) const;

    /// Fills the gutter from the neighbouring faces. Call it once the inner texels are final.
    void fill_gutter();

    /// Area averages of an equirectangular picture.
    static CubeMap from_equirect(const Image& equirect, int size);
    /// Every 2x2 texels averaged by their solid angles, gutter filled.
    CubeMap half() const;

  private:
    size_t index(int face, int x, int y) const {
        return (size_t(face) * size_t(size_ + 2) + size_t(y + 1)) * size_t(size_ + 2) + size_t(x + 1);
    }

    int size_;
    std::vector<Vec4> texels_;
};

}  // namespace easypbr::gpu
