#include "easypbr/render/primitives/surfels/surfel_projection.h"

namespace easypbr::render {
namespace {

/// Radius of surfels without tangents, in spacings: neighbours overlap by half.
constexpr double radii_per_spacing = 1.0;

Vec3 any_perpendicular(const Vec3& n) {
    return n.unitOrthogonal();
}

}  // namespace

SurfelProjector::SurfelProjector(const DrawItem& item, const Frame& frame, double spacing) : item_(&item) {
    const Eigen::Affine3d& T = item.object->T_world_mesh;
    const Mat4d view_from_mesh = frame.camera.view() * T.matrix();
    view_from_mesh_ = view_from_mesh.cast<float>();
    clip_from_mesh_ = (frame.clip_from_view * view_from_mesh).cast<float>();
    const Mat3d inverse = T.linear().inverse();
    normal_from_mesh_ = inverse.transpose().cast<float>();
    world_from_mesh_ = T.linear().cast<float>();
    eye_ = (inverse * (frame.camera.position() - T.translation())).cast<float>();
    towards_viewer_ = (inverse * frame.camera.T_world_cam.linear().col(2)).cast<float>();
    orthographic_ = frame.orthographic();
    width_ = float(frame.size.x());
    height_ = float(frame.size.y());
    near_ = float(frame.camera.near);
    scale_ = item.style.surfel_scale;
    radius_ = float(spacing * radii_per_spacing);
}

SurfelAxes surfel_axes(const MeshData& mesh, Eigen::Index i, const Vec3& towards, float radius, float scale) {
    Vec3 n = mesh.N.row(i);
    const Vec3 t = mesh.T.empty() ? Vec3(0, 0, 0) : Vec3(mesh.T.row(i));
    float length = t.norm();
    // What has no direction faces the viewer; what has no size is as large as the points are apart.
    if (!(n.squaredNorm() > 0)) n = towards;
    n.normalize();
    Vec3 direction = t - n * n.dot(t);
    if (!(direction.squaredNorm() > 1e-12f * length * length)) direction = any_perpendicular(n);
    if (!(length > 0)) length = mesh.T.empty() ? radius : 0;
    const float other = mesh.B.empty() ? length : mesh.B(i);
    direction.normalize();
    return {direction * (length * scale), n.cross(direction) * (other * scale)};
}

std::optional<SurfelProjection> SurfelProjector::project(Eigen::Index i) const {
    const Vec3 p = item_->mesh().V.row(i);
    const auto [t, b] =
        surfel_axes(item_->mesh(), i, orthographic_ ? towards_viewer_ : Vec3(eye_ - p), radius_, scale_);
    const Mat4& m = clip_from_mesh_;
    const auto clip = [&](int row, const Vec3& v, float one) {
        return m(row, 0) * v.x() + m(row, 1) * v.y() + m(row, 2) * v.z() + m(row, 3) * one;
    };
    const auto axial = [&](const Vec3& v, float one) {
        const Mat4& view = view_from_mesh_;
        return -(view(2, 0) * v.x() + view(2, 1) * v.y() + view(2, 2) * v.z() + view(2, 3) * one);
    };
    SurfelProjection s;
    const Vec3 to_viewer = orthographic_ ? towards_viewer_ : Vec3(eye_ - p), n = item_->mesh().N.row(i);
    const float lengths = n.norm() * to_viewer.norm(), towards = n.dot(to_viewer);
    s.least = least_radius(lengths > 0 ? towards / lengths : 1);
    if (item_->with_colors) s.color = item_->mesh().C.row(i).head<3>();
    s.normal = n.squaredNorm() > 0 ? Vec3(normal_from_mesh_ * (towards < 0 ? Vec3(-n) : n))
                                   : Vec3(world_from_mesh_ * to_viewer);
    s.wc = clip(3, p, 1);
    const float wt = clip(3, t, 0), wb = clip(3, b, 0);
    s.z_c = axial(p, 1);
    s.z_t = axial(t, 0);
    s.z_b = axial(b, 0);
    const float q_ww = wt * wt + wb * wb - s.wc * s.wc;
    // All of it must lie beyond the near plane.
    if (!(s.wc > 0 && q_ww < 0 && s.z_c - std::sqrt(s.z_t * s.z_t + s.z_b * s.z_b) > near_ * 0.999f))
        return {};
    s.centre_x = (clip(0, p, 1) / s.wc + 1) * 0.5f * width_;
    s.centre_y = (1 - clip(1, p, 1) / s.wc) * 0.5f * height_;
    const auto pixel_x = [&](const Vec3& v, float w) {
        return 0.5f * width_ * (clip(0, v, 0) + w) - s.centre_x * w;
    };
    const auto pixel_y = [&](const Vec3& v, float w) {
        return 0.5f * height_ * (w - clip(1, v, 0)) - s.centre_y * w;
    };
    s.tx = pixel_x(t, wt);
    s.ty = pixel_y(t, wt);
    s.bx = pixel_x(b, wb);
    s.by = pixel_y(b, wb);
    s.qx = s.ty * wb - wt * s.by;
    s.qy = wt * s.bx - s.tx * wb;
    s.qz = s.tx * s.by - s.ty * s.bx;
    // Extent of the ellipse by its dual conic.
    const auto extent = [&](float tk, float bk, float centre, float& low, float& high) {
        const float q_kw = tk * wt + bk * wb, q_kk = tk * tk + bk * bk;
        const float root = std::sqrt(std::max(0.0f, q_kw * q_kw - q_ww * q_kk));
        low = centre + std::min((q_kw + root) / q_ww, -s.least);
        high = centre + std::max((q_kw - root) / q_ww, s.least);
    };
    extent(s.tx, s.bx, s.centre_x, s.x0, s.x1);
    extent(s.ty, s.by, s.centre_y, s.y0, s.y1);
    if (!(s.x1 > 0 && s.x0 < width_ && s.y1 > 0 && s.y0 < height_)) return {};
    s.band = std::max(t.norm(), b.norm()) * world_from_mesh_.col(0).norm();
    return s;
}

void SurfelProjector::prefetch(Eigen::Index i) const {
    const MeshData& mesh = item_->mesh();
    const auto of = [&](const auto& array) {
        if (!array.empty()) __builtin_prefetch(array.data() + i * array.cols());
    };
    of(mesh.V);
    of(mesh.N);
    of(mesh.T);
    of(mesh.B);
    if (item_->with_colors) of(mesh.C);
}

}  // namespace easypbr::render
