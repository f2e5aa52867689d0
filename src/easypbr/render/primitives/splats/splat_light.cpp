#include "easypbr/render/primitives/splats/splat_light.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/parallel.h"
#include "easypbr/render/primitives/splats/splat_color.h"

namespace easypbr::render {
namespace {

constexpr float steps = 254;

Vec3d mean_of(const DrawItem& item, Eigen::Index i) {
    return item.object->T_world_mesh * Vec3d(item.mesh().V.row(i).transpose().cast<double>());
}

/// Colours as three mantissas of 9 bits and an exponent (OpenGL's RGB9_E5); black too is not 0.
uint32_t shared_exponent(const Vec3& color) {
    constexpr float most = 511.0f / 512 * 65536;
    const Vec3 c = color.cwiseMax(0.0f).cwiseMin(most);
    const int exponent = std::clamp(std::ilogb(std::max(c.maxCoeff(), 1e-6f)) + 2, -14, 16);
    uint32_t code = uint32_t(exponent + 15) << 27;
    for (int i = 0; i < 3; ++i)
        code |= std::min(511u, uint32_t(std::lround(std::ldexp(c[i], 9 - exponent)))) << (9 * i);
    return code;
}

Vec3 color_of_shared(uint32_t code) {
    Vec3 color;
    for (int i = 0; i < 3; ++i) color[i] = std::ldexp(float(code >> (9 * i) & 511u), int(code >> 27) - 24);
    return color;
}

/// Which of its sides, whatever the normal's sign in the data: that of its largest component.
size_t side_of(Eigen::Index i, const Vec3d& normal) {
    Eigen::Index largest;
    normal.cwiseAbs().maxCoeff(&largest);
    return 2 * size_t(i) + (normal[largest] < 0 ? 1 : 0);
}

Vec3 albedo_of(const DrawItem& item, Eigen::Index i) {
    if (item.with_colors) return linear_from_srgb(Vec3(item.mesh().C.row(i).head<3>().transpose()));
    const ArrayXf& sh = item.mesh().splats.sh;
    const Vec3 color = splat_color(sh.data() + i * sh.cols(), 0, Vec3(0, 0, 1));
    return linear_from_srgb(Vec3(color.cwiseMin(1.0f)));
}

}  // namespace

Vec3d splat_normal(const DrawItem& item, Eigen::Index i, const Vec3d& towards) {
    const SplatArrays& splats = item.mesh().splats;
    const auto q = splats.rotations.row(i).cast<double>();
    Eigen::Index thinnest;
    splats.scales.row(i).minCoeff(&thinnest);
    const Mat3d axes = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix();
    const Vec3d normal = item.object->T_world_mesh.linear().inverse().transpose() * axes.col(thinnest);
    return (normal.dot(towards) < 0 ? Vec3d(-normal) : normal).stableNormalized();
}

void SplatLight::set(const PlaceLight* light) {
    parts_.evict_unused();
    if (light && light->generation() != generation_) {
        parts_ = {};
        generation_ = light->generation();
    }
    light_ = light;
}

std::shared_ptr<SplatLight::Parts> SplatLight::parts_of(const DrawItem& item, bool are_lit) {
    if (!light_) return nullptr;
    const MeshData& mesh = item.mesh();
    Key key = {double(mesh.V.revision()), double(mesh.splats.scales.revision()),
               double(mesh.splats.rotations.revision()), are_lit ? 1.0 : 0.0};
    const Mat4d pose = item.object->T_world_mesh.matrix();
    key.insert(key.end(), pose.data(), pose.data() + pose.size());
    return parts_.get(key, [&] { return std::make_shared<Parts>(size_t(mesh.V.rows()), are_lit); });
}

uint8_t SplatLight::Parts::part_of(const PlaceLight& light, const DrawItem& item, Eigen::Index i,
                                   const Vec3d& normal) {
    std::atomic<uint8_t>& side = sides_[side_of(i, normal)];
    uint8_t part = side.load(std::memory_order_relaxed);
    if (part == unknown) {
        part = uint8_t(1 + std::lround(steps * light.part_at(mean_of(item, i), normal, uint32_t(i))));
        side.store(part, std::memory_order_relaxed);
    }
    return part;
}

std::span<const std::byte> SplatLight::Parts::all_sides(const PlaceLight& light, const DrawItem& item) {
    static_assert(sizeof(sides_[0]) == 1);
    if (!has_all_)
        parallel_for(size_t(item.mesh().V.rows()), 256, [&](size_t i) {
            const auto splat = Eigen::Index(i);
            const Vec3d normal = splat_normal(item, splat, Vec3d::UnitX());
            part_of(light, item, splat, normal);
            part_of(light, item, splat, -normal);
        });
    has_all_ = true;
    return std::as_bytes(std::span(sides_));
}

Vec3 SplatLight::Parts::darkened(const PlaceLight& light, const DrawItem& item, Eigen::Index i,
                                 const Vec3d& towards, const Vec3& color) {
    const uint8_t part = part_of(light, item, i, splat_normal(item, i, towards));
    if (part == uint8_t(1 + steps)) return color;
    return srgb_from_linear(Vec3(linear_from_srgb(color) * (float(part - 1) / steps)));
}

Vec3 SplatLight::Parts::lit(const PlaceLight& light, const DrawItem& item, Eigen::Index i,
                            const Vec3d& towards) {
    const Vec3d normal = splat_normal(item, i, towards);
    std::atomic<uint32_t>& side = lit_sides_[side_of(i, normal)];
    uint32_t code = side.load(std::memory_order_relaxed);
    if (code == unknown) {
        code = shared_exponent(light.light_at(mean_of(item, i), normal, uint32_t(i)));
        side.store(code, std::memory_order_relaxed);
    }
    return albedo_of(item, i).cwiseProduct(color_of_shared(code));
}

}  // namespace easypbr::render
