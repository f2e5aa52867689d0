#include "easypbr/render/primitives/surfels/surfel_projection.h"

#include <limits>

#include "easypbr/render/raster/curve_order.h"

namespace easypbr::render {
namespace {

/// Radius of surfels without tangents, in spacings: neighbours overlap by half.
constexpr double radii_per_spacing = 1.0;

Vec3 any_perpendicular(const Vec3& n) {
    return n.unitOrthogonal();
}

void copy_to(const Vec3& from, float (&to)[3]) {
    std::copy_n(from.data(), 3, to);
}

/// Around the surfels of a batch.
SurfelBatches::Sphere sphere_of_batch(const native::EllipseBatch& batch) {
    SurfelBatches::Sphere sphere = sphere_around(batch.vectors, batch.count);
    float longest = 0;
    for (int i = 0; i < batch.count; ++i)
        for (int vector = 1; vector < 3; ++vector) {
            const float* const from = batch.vectors + 3 * vector * batch.count + i;
            const float length = Vec3(from[0], from[batch.count], from[2 * batch.count]).norm();
            if (!std::isfinite(length)) return {Vec3::Zero(), std::numeric_limits<float>::infinity()};
            longest = std::max(longest, length);
        }
    sphere.radius += longest;
    return sphere;
}

}  // namespace

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

SurfelBatches::SurfelBatches(const MeshData& mesh, float radius, float scale) {
    const auto all = size_t(mesh.V.rows());
    for (size_t i = 0; i < all; ++i)
        if (!(Vec3(mesh.N.row(Eigen::Index(i))).squaredNorm() > 0)) return;
    vertices_ = curve_order(mesh.V, all, [](size_t i) { return i; });
    vectors_.resize(components * all + most);
    spheres_.resize((all + most - 1) / most);
    parallel_for(spheres_.size(), 64, [&](size_t i) {
        const native::EllipseBatch own = batch(i);
        float* const to = vectors_.data() + components * most * i;
        for (int k = 0; k < own.count; ++k) {
            const auto vertex = Eigen::Index(vertices_[most * i + size_t(k)]);
            const SurfelAxes axes = surfel_axes(mesh, vertex, Vec3::Zero(), radius, scale);
            const std::array<Vec3, 4> vectors{mesh.V.row(vertex), axes.t, axes.b, mesh.N.row(vertex)};
            for (size_t c = 0; c < components; ++c)
                to[c * size_t(own.count) + size_t(k)] = vectors[c / 3][Eigen::Index(c % 3)];
        }
        spheres_[i] = sphere_of_batch(own);
    });
}

native::EllipseBatch SurfelBatches::batch(size_t i) const {
    const size_t first = most * i;
    return {vectors_.data() + components * first, int(std::min(most, vertices_.size() - first))};
}

native::EllipseVectors<float> SurfelBatches::vectors_of(size_t surfel) const {
    const native::EllipseBatch own = batch(surfel / most);
    const float* from = own.vectors + surfel % most;
    native::EllipseVectors<float> vectors;
    for (auto* const vector : {&vectors.p, &vectors.t, &vectors.b, &vectors.n})
        for (float& number : *vector) {
            number = *from;
            from += own.count;
        }
    return vectors;
}

const SurfelBatches* BatchedSurfels::draw(const DrawItem& item, float radius) {
    const MeshData& mesh = item.mesh();
    if (mesh.V.rows() < few_surfels || mesh.N.empty()) return nullptr;
    const float scale = item.style.surfel_scale;
    const Key key{{mesh.V.revision(), mesh.N.revision(), mesh.T.revision(), mesh.B.revision()},
                  {radius, scale}};
    const SurfelBatches* const batches =
        batches_.draw(key, [mesh, radius, scale] { return SurfelBatches(mesh, radius, scale); });
    return batches && !batches->empty() ? batches : nullptr;
}

SurfelProjector::SurfelProjector(const DrawItem& item, const Frame& frame, double spacing,
                                 BatchedSurfels& batches)
    : item_(&item), radius_(float(spacing * radii_per_spacing)) {
    batches_ = batches.draw(item, radius_);
    const Eigen::Affine3d& T = item.object->T_world_mesh;
    const Mat4d view_from_mesh = frame.camera.view() * T.matrix();
    const Mat3d inverse = T.linear().inverse();
    Eigen::Map<Mat3>(view_.normal_from_mesh[0]) = inverse.transpose().cast<float>();
    Eigen::Map<Mat3>(view_.world_from_mesh[0]) = T.linear().cast<float>();
    Eigen::Map<Mat4>(view_.clip_from_mesh[0]) = (frame.clip_from_view * view_from_mesh).cast<float>();
    Eigen::Map<Vec4>(view_.axial) = -view_from_mesh.row(2).transpose().cast<float>();
    copy_to((inverse * (frame.camera.position() - T.translation())).cast<float>(), view_.eye);
    copy_to((inverse * frame.camera.T_world_cam.linear().col(2)).cast<float>(), view_.towards_viewer);
    view_.orthographic = frame.orthographic();
    view_.width = float(frame.size.x());
    view_.height = float(frame.size.y());
    view_.near = float(frame.camera.near);
    view_.world_scale = T.linear().col(0).cast<float>().norm();
}

native::EllipseVectors<float> SurfelProjector::vectors_of(Eigen::Index vertex) const {
    const MeshData& mesh = item_->mesh();
    const Vec3 to_viewer = view_.orthographic ? Vec3(Eigen::Map<const Vec3>(view_.towards_viewer))
                                              : Eigen::Map<const Vec3>(view_.eye) - Vec3(mesh.V.row(vertex));
    const SurfelAxes axes = surfel_axes(mesh, vertex, to_viewer, radius_, item_->style.surfel_scale);
    native::EllipseVectors<float> vectors;
    copy_to(mesh.V.row(vertex), vectors.p);
    copy_to(axes.t, vectors.t);
    copy_to(axes.b, vectors.b);
    copy_to(mesh.N.row(vertex), vectors.n);
    return vectors;
}

std::optional<SurfelProjection> SurfelProjector::project(size_t surfel) const {
    SurfelProjection projection;
    const bool is_seen = native::project_ellipse(
        view_, batches_ ? batches_->vectors_of(surfel) : vectors_of(Eigen::Index(surfel)), projection);
    return is_seen ? std::optional(projection) : std::nullopt;
}

void SurfelProjector::prefetch(size_t surfel) const {
    if (batches_) return;
    const MeshData& mesh = item_->mesh();
    const auto of = [&](const auto& rows) {
        if (!rows.empty()) __builtin_prefetch(rows.data() + Eigen::Index(surfel) * rows.cols());
    };
    of(mesh.V);
    of(mesh.N);
    of(mesh.T);
    of(mesh.B);
}

}  // namespace easypbr::render
