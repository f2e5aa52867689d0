#include "easypbr/scene/deformation.h"

#include <fmt/format.h>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/directions.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr {
namespace {

constexpr size_t morph_grain = 4096;

void add_targets(const Deformation& from, const std::vector<float>& weights, Deformed& out) {
    for (size_t k = 0; k < from.targets_V.size() && k < weights.size(); ++k) {
        if (weights[k] == 0) continue;
        parallel_for(size_t(out.V.rows()), morph_grain, [&](size_t i) {
            const auto r = Eigen::Index(i);
            out.V.row(r) += weights[k] * from.targets_V[k].row(r);
            if (out.N.rows() && !from.targets_N[k].empty())
                out.N.row(r) += weights[k] * from.targets_N[k].row(r);
        });
    }
}

void follow_joints(const Deformation& from, const std::vector<Eigen::Affine3d>& T_mesh_joints,
                   Deformed& out) {
    parallel_for(size_t(out.V.rows()), morph_grain, [&](size_t i) {
        const auto r = Eigen::Index(i);
        Eigen::Matrix<double, 3, 4> T = Eigen::Matrix<double, 3, 4>::Zero();
        double sum = 0;
        for (Eigen::Index k = 0; k < from.weights.cols(); ++k) {
            const double weight = double(from.weights(r, k));
            if (weight == 0) continue;
            T += weight * T_mesh_joints[size_t(from.joints(r, k))].matrix().topRows<3>();
            sum += weight;
        }
        if (!(sum > 0)) return;
        T /= sum;
        const Vec3d v = out.V.row(r).transpose().cast<double>();
        out.V.row(r) = (T.leftCols<3>() * v + T.col(3)).cast<float>().transpose();
        if (out.uv_tangents.rows()) {
            auto t = out.uv_tangents.row(r).head<3>();
            t = (T.leftCols<3>() * t.transpose().cast<double>()).stableNormalized().cast<float>().transpose();
        }
        if (!out.N.rows()) return;
        const Vec3d n = out.N.row(r).transpose().cast<double>();
        out.N.row(r) = (detail::cofactors(T.leftCols<3>()) * n).cast<float>().transpose();
    });
}

void put_face_normals(const Array3i& F, Deformed& out) {
    if (!out.N.rows()) return;
    parallel_for(size_t(F.rows()), morph_grain, [&](size_t i) {
        const auto face = F.row(Eigen::Index(i));
        const auto at = [&](int k) { return Vec3d(out.V.row(face[k]).transpose().cast<double>()); };
        const Vec3d n = detail::direction_or_z((at(1) - at(0)).cross(at(2) - at(0)));
        for (int k = 0; k < 3; ++k) out.N.row(face[k]) = n.cast<float>().transpose();
    });
}

void normalize(Array3f::Dense& N) {
    parallel_for(size_t(N.rows()), morph_grain, [&](size_t i) {
        auto n = N.row(Eigen::Index(i));
        if (const float length = n.norm(); length > 0) n /= length;
    });
}

}  // namespace

void check_deformation(const Deformation& d, size_t joints, bool has_skin) {
    const Eigen::Index n = d.V.rows();
    const auto fits = [&](const auto& array) { return array.empty() || array.rows() == n; };
    bool good = fits(d.N) && fits(d.uv_tangents) && fits(d.joints) && fits(d.weights) &&
                d.joints.rows() == d.weights.rows() && d.joints.cols() == d.weights.cols() &&
                d.targets_V.size() == d.targets_N.size();
    for (size_t k = 0; good && k < d.targets_V.size(); ++k)
        good = fits(d.targets_V[k]) && fits(d.targets_N[k]);
    if (!good) throw ArgumentError("animation rig: joints, weights or morph targets do not fit the vertices");
    require_faces(d.flat_F, n);
    if (!has_skin || d.joints.empty()) return;
    // NaN is neither.
    if (!(d.joints.array() >= 0 && d.joints.array() < float(joints)).all())
        throw ArgumentError(fmt::format("animation rig: vertices follow joints {} to {}, but the skin has {}",
                                        d.joints.minCoeff(), d.joints.maxCoeff(), joints));
}

Deformed deformed(const Deformation& from, const std::vector<float>& weights,
                  const std::vector<Eigen::Affine3d>& T_mesh_joints) {
    Deformed out{from.V, from.N.empty() ? Array3f::Dense(0, 3) : Array3f::Dense(from.N),
                 from.uv_tangents.empty() ? Array4f::Dense(0, 4) : Array4f::Dense(from.uv_tangents)};
    add_targets(from, weights, out);
    if (!T_mesh_joints.empty()) follow_joints(from, T_mesh_joints, out);
    normalize(out.N);
    put_face_normals(from.flat_F, out);
    return out;
}

}  // namespace easypbr
