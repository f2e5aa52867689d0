#include "easypbr/render/raster/culling.h"

#include <cmath>

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

ClusterCulling::ClusterCulling(const ScreenTriangles& t, Vec2i size, const PixelRect& area)
    : frustum_(t.clip_from_mesh, size, area),
      unclipped_(t.clip_from_mesh, size, drawn_unclipped, 0),
      eye_(Vec4::Zero()) {
    if (t.both_sides) return;
    eye_ = t.mirrored ? Vec4(-eye_of(t.clip_from_mesh)) : eye_of(t.clip_from_mesh);
}

bool ClusterCulling::drops(const FaceClusters::Cluster& cluster) const {
    const float radius = wider * cluster.radius;
    if (frustum_.drops(cluster.center, radius)) return true;
    if (!(cluster.spread < 1)) return false;
    // From a face to the eye; its plane has the eye behind it where this is against the normal.
    const Vec3 towards = eye_.head<3>() - cluster.center * eye_.w();
    return -towards.dot(cluster.axis) >
           (cluster.spread + margin) * towards.norm() + radius * std::abs(eye_.w());
}

bool ClusterCulling::is_inside(const FaceClusters::Cluster& cluster) const {
    return unclipped_.holds(cluster.center, wider * cluster.radius);
}

}  // namespace easypbr::render
