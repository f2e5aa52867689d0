#include "easypbr/render/raster/culling.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "easypbr/render/raster/triangle_raster.h"

namespace easypbr::render {
namespace {

/// The point that projects to no pixel: where the camera is, homogeneous, so that the screen area of a face
/// has the sign of the point's place before or behind the face's plane.
Vec4 eye_of(const Mat4& clip_from_mesh) {
    const Mat4d m = clip_from_mesh.cast<double>();
    Mat4d rows;
    rows << m.row(0), m.row(1), m.row(3), Eigen::RowVector4d::Zero();
    Eigen::Vector4d eye;
    for (int i = 0; i < 4; ++i) {
        rows.row(3) = Eigen::RowVector4d::Unit(i);
        eye[i] = -rows.determinant();
    }
    const double size = eye.norm();
    return size > 0 && std::isfinite(size) ? Vec4((eye / size).cast<float>()) : Vec4(Vec4::Zero());
}

/// By so much the cone of normals is wider: what is seen from the side may turn when its corners are
/// rounded.
constexpr float margin = 0.05f;
/// The same for spheres around clusters, in parts of their radius.
constexpr float wider = 1.001f;

/// Where nothing has to be clipped, a pixel smaller.
constexpr int guard = int(native::ClusterFaces::guard_band) - 1;
constexpr PixelRect drawn_unclipped{-guard, -guard, 2 * guard, 2 * guard};

}  // namespace

Frustum::Frustum(const Mat4& m, Vec2i size, const PixelRect& area, float pixels, float pixels_times_w) {
    const Vec2 half = size.cast<float>() / 2;
    // In normalised device coordinates.
    const float left = (float(area.x) - pixels) / half.x() - 1,
                right = (float(area.x + area.width) + pixels) / half.x() - 1,
                top = 1 - (float(area.y) - pixels) / half.y(),
                bottom = 1 - (float(area.y + area.height) + pixels) / half.y();
    const Vec4 x = m.row(0), y = m.row(1), w = m.row(3);
    const Vec4 across = Vec4(Vec4::Unit(3)) * (pixels_times_w / half.x()),
               along = Vec4(Vec4::Unit(3)) * (pixels_times_w / half.y());
    const Vec4 planes[] = {x - left * w + across, right * w - x + across, y - bottom * w + along,
                           top * w - y + along,   w - Vec4(m.row(2)),     m.row(2)};
    for (size_t i = 0; i < planes_.size(); ++i) planes_[i] = {planes[i], planes[i].head<3>().norm()};
}

SphereCulling::SphereCulling(const Mat4& m, Vec2i size, const PixelRect& area, float pixels,
                             float pixels_times_w)
    : frustum_(m, size, area, pixels, pixels_times_w),
      clip_from_mesh_(m),
      magnitudes_(m.cwiseAbs()),
      lengths_(m.leftCols<3>().rowwise().norm()),
      half_size_(size.cast<float>() / 2),
      area_(area),
      pixels_(pixels),
      pixels_times_w_(pixels_times_w) {}

ScreenBounds SphereCulling::bounds(const Vec3& center, float radius) const {
    // A sum of four products is off by at most four roundings of 2^-24 of their magnitudes.
    constexpr float rounding = 1e-6f, rounded_up = 1 + rounding;
    const Vec4 at = clip_from_mesh_.leftCols<3>() * center + clip_from_mesh_.col(3);
    const Vec4 reach = lengths_ * (radius * rounded_up) +
                       rounding * (magnitudes_.leftCols<3>() * (center.cwiseAbs().array() + radius).matrix() +
                                   magnitudes_.col(3));
    const Vec4 least = at - reach, most = at + reach;
    const int right = area_.x + area_.width - 1, bottom = area_.y + area_.height - 1;
    const bool is_known = least.w() > 0 && (least.array() <= most.array()).all();
    if (!is_known) return {area_.x, area_.y, right, bottom, std::numeric_limits<float>::infinity()};
    const auto first = [&](int i) { return least[i] / (least[i] < 0 ? least.w() : most.w()); };
    const auto last = [&](int i) { return most[i] / (most[i] > 0 ? least.w() : most.w()); };
    const float wider = pixels_ + pixels_times_w_ / least.w();
    const auto pixel = [](float at, int low, int high) {
        return int(std::floor(std::clamp(at, float(low), float(high))));
    };
    return {pixel((first(0) + 1) * half_size_.x() - wider, area_.x, right + 1),
            pixel((1 - last(1)) * half_size_.y() - wider, area_.y, bottom + 1),
            pixel((last(0) + 1) * half_size_.x() + wider, area_.x - 1, right),
            pixel((1 - first(1)) * half_size_.y() + wider, area_.y - 1, bottom),
            std::max(least_depth, most.z() / least.w() * rounded_up)};
}

float SphereCulling::depth(const Vec3& center, float radius) const {
    if (drops(center, radius)) return -1;
    const Eigen::Vector2f depth_w =
        (clip_from_mesh_.bottomLeftCorner<2, 3>() * center) + clip_from_mesh_.bottomRightCorner<2, 1>();
    const float depth = depth_w.x() / depth_w.y();
    return depth_w.y() > 0 && depth < 1 ? std::max(depth, 0.0f) : 1.0f;
}

std::vector<uint32_t> near_to_far(std::span<const float> depths) {
    constexpr size_t bins = 16;
    float farthest = std::numeric_limits<float>::max(), nearest = 0;
    for (const float depth : depths) {
        if (depth < 0) continue;
        farthest = std::min(farthest, depth);
        nearest = std::max(nearest, depth);
    }
    const float scale = nearest > farthest ? float(bins) / (nearest - farthest) : 0.0f;
    const auto bin_of = [&](float depth) { return std::min(size_t((nearest - depth) * scale), bins - 1); };
    std::array<size_t, bins + 1> begins{};
    for (const float depth : depths)
        if (!(depth < 0)) ++begins[bin_of(depth) + 1];
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    std::vector<uint32_t> order(begins.back());
    for (size_t i = 0; i < depths.size(); ++i)
        if (!(depths[i] < 0)) order[begins[bin_of(depths[i])]++] = uint32_t(i);
    return order;
}

ClusterCulling::ClusterCulling(const ScreenTriangles& t, Vec2i size, const PixelRect& area)
    : spheres_(t.clip_from_mesh, size, area),
      unclipped_(t.clip_from_mesh, size, drawn_unclipped, 0),
      eye_(Vec4::Zero()) {
    if (t.both_sides) return;
    eye_ = t.mirrored ? Vec4(-eye_of(t.clip_from_mesh)) : eye_of(t.clip_from_mesh);
}

float ClusterCulling::depth(const FaceClusters::Cluster& cluster) const {
    const float radius = wider * cluster.radius;
    const float depth = spheres_.depth(cluster.center, radius);
    if (depth < 0 || !(cluster.spread < 1)) return depth;
    // From a face to the eye; its plane has the eye behind it where this is against the normal.
    const Vec3 towards = eye_.head<3>() - cluster.center * eye_.w();
    const bool is_turned_away =
        -towards.dot(cluster.axis) > (cluster.spread + margin) * towards.norm() + radius * std::abs(eye_.w());
    return is_turned_away ? -1.0f : depth;
}

ScreenBounds ClusterCulling::bounds(const FaceClusters::Cluster& cluster) const {
    return spheres_.bounds(cluster.center, wider * cluster.radius);
}

bool ClusterCulling::is_inside(const FaceClusters::Cluster& cluster) const {
    return unclipped_.holds(cluster.center, wider * cluster.radius);
}

}  // namespace easypbr::render
