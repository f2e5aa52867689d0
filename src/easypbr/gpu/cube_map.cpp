#include "easypbr/gpu/cube_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "easypbr/core/parallel.h"

namespace easypbr::gpu {
namespace {

struct FacePoint {
    int face;
    float u, v;
};

/// The table of section 8.13 of the OpenGL 4.5 specification.
FacePoint project(const Vec3& d) {
    const Vec3 a = d.cwiseAbs();
    if (a.x() >= a.y() && a.x() >= a.z())
        return {d.x() >= 0 ? 0 : 1, (d.x() >= 0 ? -d.z() : d.z()) / a.x(), -d.y() / a.x()};
    if (a.y() >= a.z()) return {d.y() >= 0 ? 2 : 3, d.x() / a.y(), (d.y() >= 0 ? d.z() : -d.z()) / a.y()};
    return {d.z() >= 0 ? 4 : 5, (d.z() >= 0 ? d.x() : -d.x()) / a.z(), -d.y() / a.z()};
}

/// Bilinear value of an equirectangular picture: it wraps around in u and ends at the poles.
Vec4 sample_equirect(const Image& image, const Vec2& uv) {
    const float x = uv.x() * float(image.width()) - 0.5f;
    const float y = std::clamp(uv.y() * float(image.height()) - 0.5f, 0.0f, float(image.height() - 1));
    const int x0 = int(std::floor(x)), y0 = std::min(int(y), image.height() - 1);
    const int y1 = std::min(y0 + 1, image.height() - 1);
    const float fx = x - float(x0), fy = y - float(y0);
    const auto texel = [&](int column, int row) {
        const float* p = image.at<float>((column + image.width()) % image.width(), row);
        return Vec4(p[0], p[1], p[2], 1);
    };
    return (texel(x0, y0) * (1 - fx) + texel(x0 + 1, y0) * fx) * (1 - fy) +
           (texel(x0, y1) * (1 - fx) + texel(x0 + 1, y1) * fx) * fy;
}

}  // namespace

Vec3 cube_direction(int face, float u, float v) {
    switch (face) {
        case 0:
            return Vec3(1, -v, -u).normalized();
        case 1:
            return Vec3(-1, -v, u).normalized();
        case 2:
            return Vec3(u, 1, v).normalized();
        case 3:
            return Vec3(u, -1, -v).normalized();
        case 4:
            return Vec3(u, -v, 1).normalized();
        default:
            return Vec3(-u, -v, -1).normalized();
    }
}

Vec4 CubeMap::sample(const Vec3& direction) const {
    const FacePoint p = project(direction);
    const float x = (p.u + 1) * 0.5f * float(size_) - 0.5f, y = (p.v + 1) * 0.5f * float(size_) - 0.5f;
    const int x0 = std::clamp(int(std::floor(x)), -1, size_ - 1),
              y0 = std::clamp(int(std::floor(y)), -1, size_ - 1);
    const float fx = x - float(x0), fy = y - float(y0);
    const Vec4* row0 = &at(p.face, x0, y0);
    const Vec4* row1 = &at(p.face, x0, y0 + 1);
    return (row0[0] * (1 - fx) + row0[1] * fx) * (1 - fy) + (row1[0] * (1 - fx) + row1[1] * fx) * fy;
}

void CubeMap::fill_gutter() {
    const auto neighbour = [&](int face, int x, int y) {
        const FacePoint p = project(direction(face, x, y));
        const auto nearest = [&](float c) {
            return std::clamp(int(std::floor((c + 1) * 0.5f * float(size_))), 0, size_ - 1);
        };
        return at(p.face, nearest(p.u), nearest(p.v));
    };
    for (int face = 0; face < 6; ++face)
        for (int i = -1; i <= size_; ++i) {
            at(face, i, -1) = neighbour(face, i, -1);
            at(face, i, size_) = neighbour(face, i, size_);
            at(face, -1, i) = neighbour(face, -1, i);
            at(face, size_, i) = neighbour(face, size_, i);
        }
}

CubeMap CubeMap::from_equirect(const Image& equirect, int size) {
    CubeMap cube(size);
    // As many samples per texel as the picture has pixels there, so that none is left out.
    const int n = std::clamp(int(std::ceil(float(equirect.width()) / (4.0f * float(size)))), 1, 16);
    const float step = 2.0f / float(size * n);
    parallel_for(size_t(6) * size, 4, [&](size_t row) {
        const int face = int(row) / size, y = int(row) % size;
        for (int x = 0; x < size; ++x) {
            Vec4 sum = Vec4::Zero();
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const float u = (float(x * n + i) + 0.5f) * step - 1,
                                v = (float(y * n + j) + 0.5f) * step - 1;
                    sum += sample_equirect(equirect, equirect_uv(cube_direction(face, u, v)));
                }
            cube.at(face, x, y) = sum / float(n * n);
        }
    });
    cube.fill_gutter();
    return cube;
}

CubeMap CubeMap::half() const {
    CubeMap smaller(size_ / 2);
    // Solid angle of a texel, up to a factor: 1 / (1 + u^2 + v^2)^(3/2).
    const auto weight = [&](int x, int y) {
        const float u = (float(x) + 0.5f) * 2 / float(size_) - 1,
                    v = (float(y) + 0.5f) * 2 / float(size_) - 1;
        const float r2 = 1 + u * u + v * v;
        return 1 / (r2 * std::sqrt(r2));
    };
    parallel_for(size_t(6) * smaller.size(), 8, [&](size_t row) {
        const int face = int(row) / smaller.size(), y = int(row) % smaller.size();
        for (int x = 0; x < smaller.size(); ++x) {
            Vec4 sum = Vec4::Zero();
            float total = 0;
            for (const auto& [i, j] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
                const float w = weight(2 * x + i, 2 * y + j);
                sum += w * at(face, 2 * x + i, 2 * y + j);
                total += w;
            }
            smaller.at(face, x, y) = sum / total;
        }
    });
    smaller.fill_gutter();
    return smaller;
}

}  // namespace easypbr::gpu
