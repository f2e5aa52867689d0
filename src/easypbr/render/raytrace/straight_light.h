// Light of a lamp that passes surfaces straight, which a ray meets in any order.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "easypbr/render/raytrace/ray_surface.h"

namespace easypbr::render {

/// A face of a volume that light has passed. Lengths are RayScene's.
struct VolumeFace {
    const DrawItem* item = nullptr;
    float distance = 0;
    bool is_exit = false;    ///< the ray leaves the volume there
    bool is_closed = false;  ///< the volume's mesh has no holes
    float thickness = 0;
    Vec3 color{1, 1, 1};  ///< Passage::color()
};

/// Volumes absorb along the way between the faces where a ray enters and leaves them. A ray that starts or
/// ends in a closed volume meets one of the two. Faces of open meshes that have no counterpart stand for a
/// way of their thickness each.
class StraightLight {
  public:
    /// Without what volumes absorb.
    Vec3 left{1, 1, 1};

    /// Takes note of a face; false where it is known: rays along an edge meet both of its faces.
    bool add(const VolumeFace& face) {
        const auto begin = faces_.begin(), end = begin + std::ptrdiff_t(count_);
        const float rounding = 2e-6f * std::max(1.0f, face.distance);
        const bool is_known = std::any_of(begin, end, [&](const VolumeFace& other) {
            return is_same_volume(other, face) && other.is_exit == face.is_exit &&
                   std::abs(other.distance - face.distance) <= rounding;
        });
        if (is_known) return false;
        if (count_ < room)
            faces_[count_++] = face;
        else
            add_half(face);
        return true;
    }

    /// Of a ray that ends after `distance`. `unit`: RayScene::unit().
    Vec3 absorbed(float distance, float unit) const {
        Vec3 light = left.cwiseProduct((-beyond_ * unit).array().exp().matrix());
        for (size_t i = 0; i < count_; ++i) {
            const auto before = faces_.begin() + std::ptrdiff_t(i);
            const bool is_first = std::none_of(faces_.begin(), before, [&](const VolumeFace& other) {
                return is_same_volume(other, faces_[i]);
            });
            if (is_first) light = light.cwiseProduct(left_by(faces_[i], distance, unit));
        }
        return light;
    }

  private:
    static constexpr size_t room = 16;

    /// All parts of an object bound one volume.
    static bool is_same_volume(const VolumeFace& a, const VolumeFace& b) {
        return a.item->object == b.item->object;
    }

    /// Of faces that there is no room for.
    void add_half(const VolumeFace& face) {
        beyond_ += absorption_of(face.item->material) * (0.5f * face.thickness);
        overflows_ = true;
    }

    Vec3 left_by(const VolumeFace& of, float end, float unit) const {
        float way = 0, thickness = 0;
        int within = 0;  // volumes that the ray has entered and not left
        Vec3 colors = Vec3::Ones();
        const VolumeFace* nearest = nullptr;  // of the faces where it enters: the volume is what they bound
        for (size_t i = 0; i < count_; ++i) {
            const VolumeFace& face = faces_[i];
            if (!is_same_volume(face, of)) continue;
            way += face.is_exit ? face.distance : -face.distance;
            thickness += face.thickness;
            within += face.is_exit ? -1 : 1;
            colors = colors.cwiseProduct(face.color);
            if (!face.is_exit && (!nearest || face.distance < nearest->distance)) nearest = &face;
        }
        const Vec3 absorption = absorption_of((nearest ? *nearest : of).item->material);
        const auto after = [&](float length) { return Vec3((-absorption * (length * unit)).array().exp()); };
        if (overflows_) return after(thickness / 2);
        // It ends within.
        if (of.is_closed && std::isfinite(end) && (within > 0 || (within == 0 && way < 0)))
            return after(std::max(way + float(std::max(within, 1)) * end, 0.0f));
        if (within == 0) return after(std::abs(way));
        if (of.is_closed && within < 0) return after(std::max(way, 0.0f));
        // Sheets: each has the tint of both faces.
        return colors.cwiseProduct(after(thickness));
    }

    std::array<VolumeFace, room> faces_;
    size_t count_ = 0;
    Vec3 beyond_{0, 0, 0};  ///< absorbed by faces that there is no room for, logarithm
    bool overflows_ = false;
};

}  // namespace easypbr::render
