#include "easypbr/render/primitives/splats/splat_light.h"

#include <cmath>

#include "easypbr/core/color.h"

namespace easypbr::render {
namespace {

constexpr float steps = 254;

Vec3d mean_of(const DrawItem& item, Eigen::Index i) {
    return item.object->T_world_mesh * Vec3d(item.mesh().V.row(i).transpose().cast<double>());
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

std::shared_ptr<SplatLight::Parts> SplatLight::parts_of(const DrawItem& item) {
    if (!light_) return nullptr;
    const MeshData& mesh = item.mesh();
    Key key = {double(mesh.V.revision()), double(mesh.splats.scales.revision()),
               double(mesh.splats.rotations.revision())};
    const Mat4d pose = item.object->T_world_mesh.matrix();
    key.insert(key.end(), pose.data(), pose.data() + pose.size());
    return parts_.get(key, [&] { return std::make_shared<Parts>(size_t(mesh.V.rows())); });
}

Vec3 SplatLight::Parts::darkened(const PlaceLight& light, const DrawItem& item, Eigen::Index i,
                                 const Vec3d& towards, const Vec3& color) {
    const Vec3d normal = splat_normal(item, i, towards);
    // Which of its sides, whatever the normal's sign in the data: that of its largest component.
    Eigen::Index largest;
    normal.cwiseAbs().maxCoeff(&largest);
    std::atomic<uint8_t>& side = sides_[2 * size_t(i) + (normal[largest] < 0 ? 1 : 0)];
    uint8_t part = side.load(std::memory_order_relaxed);
    if (part == unknown) {
        part = uint8_t(1 + std::lround(steps * light.part_at(mean_of(item, i), normal, uint32_t(i))));
        side.store(part, std::memory_order_relaxed);
    }
    if (part == uint8_t(1 + steps)) return color;
    return srgb_from_linear(Vec3(linear_from_srgb(color) * (float(part - 1) / steps)));
}

}  // namespace easypbr::render
