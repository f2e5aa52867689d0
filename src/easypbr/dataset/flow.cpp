// Optical flow: where the points of one frame are in another.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/dataset/flow.h"
#include "easypbr/dataset/layers.h"
#include "easypbr/scene/object_key.h"

namespace easypbr::dataset {
namespace {

/// How far a point's depth and that of a pixel beside its place may differ, as a part of it, where the two
/// are on faces that meet at an edge, or on what has no faces.
constexpr double depth_tolerance = 0.01;
/// A smooth surface leaves the plane of a pixel by no more than its points are apart across the view; facets
/// lean from it.
constexpr double slack = 1.5;
/// Of single precision, as a part of the depth.
constexpr double rounding = 1e-4, plane_rounding = 1e-5;

/// An object of this frame in the other one; none when it is not shown there, or with other arrays.
struct Motion {
    const SceneSnapshot::Object* there = nullptr;
    uint32_t there_number = 0;
    bool same_faces = false;               ///< vertices correspond, but they have moved
    Eigen::Affine3d T_mesh_cv, T_cv_mesh;  ///< of this frame back to the mesh, and on to the other's camera
    Eigen::Affine3d T_cv_mesh_here, T_mesh_cv_there;  ///< their inverses
};

/// Whether the indices of faces and vertices correspond: they are told apart by how many there are.
bool same_elements(const MeshData& a, const MeshData& b) {
    return a.F.rows() == b.F.rows() && a.V.rows() == b.V.rows();
}

std::vector<Motion> motions(const Surfaces& now, const Surfaces& other) {
    std::vector<Motion> all;
    const auto there = partners(object_keys(now.scene), object_keys(other.scene));
    for (size_t i = 0; i < there.size(); ++i) {
        const SceneSnapshot::Object& object = now.scene.objects[i];
        Motion motion;
        motion.T_cv_mesh_here = cv_from_mesh(now.camera, object);
        motion.T_mesh_cv = inverse_pose(motion.T_cv_mesh_here);
        const SceneSnapshot::Object* const found = there[i] ? &other.scene.objects[*there[i]] : nullptr;
        if (found && same_elements(*found->mesh, *object.mesh)) {
            motion.there = found;
            motion.there_number = uint32_t(*there[i]) + 1;
            motion.T_cv_mesh = cv_from_mesh(other.camera, *found);
            motion.T_mesh_cv_there = inverse_pose(motion.T_cv_mesh);
            motion.same_faces = found->mesh->V.revision() != object.mesh->V.revision();
        }
        all.push_back(motion);
    }
    return all;
}

/// The point in the other camera's frame.
Vec3d moved(const Surfaces& now, size_t i, const Motion& motion) {
    const MeshData& there = *motion.there->mesh;
    if (!motion.same_faces) return motion.T_cv_mesh * (motion.T_mesh_cv * now.position[i].cast<double>());
    const auto element = Eigen::Index(now.element_of(i));
    if (!now.on_face(i)) {
        // A splat moves with its point.
        const MeshData& here = now.mesh_of(i);
        if (element >= here.V.rows())
            return motion.T_cv_mesh * (motion.T_mesh_cv * now.position[i].cast<double>());
        const Vec3d shift = (Vec3(there.V.row(element)) - Vec3(here.V.row(element))).cast<double>();
        return motion.T_cv_mesh * (motion.T_mesh_cv * now.position[i].cast<double>() + shift);
    }
    Vec3d p = Vec3d::Zero();
    for (int k = 0; k < 3; ++k)
        p += double(now.barycentrics[i][k]) * Vec3(there.V.row(now.mesh_of(i).F(element, k))).cast<double>();
    return motion.T_cv_mesh * p;
}

/// The outward direction of the side of a voxel on which a point of the mesh's frame lies; 0 where it is on
/// none.
Vec3d side_of_voxel(const MeshData& mesh, size_t vertex, double size, const Vec3d& point) {
    const Vec3d origin = mesh.V.row(0).transpose().cast<double>();
    const Vec3d cell = (mesh.V.row(Eigen::Index(vertex)).transpose().cast<double>() - origin) / size;
    const Vec3d place = (point - origin) / size - Vec3d((cell.array() + 0.5).floor());
    Eigen::Index axis;
    const double farthest = place.cwiseAbs().maxCoeff(&axis);
    Vec3d side = Vec3d::Zero();
    if (std::abs(farthest - 0.5) < 0.01) side[axis] = place[axis] > 0 ? 1 : -1;
    return side;
}

/// The normal of what a pixel sees, in the frame of a camera: unit, 0 where there is none. Of a face that of
/// its corners' order, of voxels outward, else the vertex's. `mesh` has the vertices, `T_cv_mesh` moves them.
Vec3d normal_of(const Surfaces& s, size_t i, const MeshData& mesh, const Eigen::Affine3d& T_cv_mesh,
                const Vec3d& point_mesh) {
    const auto element = Eigen::Index(s.element_of(i));
    Vec3d normal = Vec3d::Zero();
    if (s.on_face(i)) {
        Vec3d corner[3];
        for (int k = 0; k < 3; ++k) corner[k] = Vec3(mesh.V.row(mesh.F(element, k))).cast<double>();
        normal = (T_cv_mesh.linear() * (corner[1] - corner[0]))
                     .cross(Vec3d(T_cv_mesh.linear() * (corner[2] - corner[0])));
    } else {
        const double voxel_size = s.voxel_sizes[s.object[i] - 1];
        if (voxel_size > 0 && element < mesh.V.rows())
            normal = side_of_voxel(mesh, size_t(element), voxel_size, point_mesh);
        else if (voxel_size == 0 && element < mesh.N.rows())
            normal = Vec3(mesh.N.row(element)).cast<double>();
        normal = T_cv_mesh.linear().inverse().transpose() * normal;
    }
    const double length = normal.norm();
    return length > 0 && std::isfinite(length) ? Vec3d(normal / length) : Vec3d(Vec3d::Zero());
}

/// Whether what a pixel sees are pieces of planes.
bool is_flat(const Surfaces& s, size_t i) {
    return s.on_face(i) || s.voxel_sizes[s.object[i] - 1] > 0;
}

/// Whether one side or the other of a surface faces the camera: its sign.
double facing(const Camera& camera, const Vec3d& normal, const Vec3d& point) {
    return camera.projection == Projection::orthographic ? normal.z() : normal.dot(point);
}

/// A point of this frame as it lies in the other one.
struct Target {
    Vec3d point, normal;  ///< in the other camera's frame
    bool turned;          ///< the camera faces the other side of its surface
};

Target target_of(const Surfaces& now, size_t i, const Motion& motion, const Surfaces& other) {
    Target target;
    target.point = moved(now, i, motion);
    const Vec3d here = now.position[i].cast<double>(), here_mesh = motion.T_mesh_cv * here;
    const MeshData& mesh = now.mesh_of(i);
    const MeshData& shape = motion.same_faces ? *motion.there->mesh : mesh;
    target.normal = normal_of(now, i, now.on_face(i) ? shape : mesh, motion.T_cv_mesh, here_mesh);
    const Vec3d before = normal_of(now, i, mesh, motion.T_cv_mesh_here, here_mesh);
    target.turned = facing(now.camera, before, here) * facing(other.camera, target.normal, target.point) < 0;
    return target;
}

/// Whether a pixel of the other frame, beside the target's place, shows the surface that the target is on.
bool shows(const Surfaces& other, size_t j, const Surfaces& now, size_t i, const Motion& motion,
           const Target& target) {
    if (other.object[j] != motion.there_number) return false;
    const bool flat = is_flat(now, i) && is_flat(other, j);
    const bool is_voxel = flat && !now.on_face(i);
    if (!is_voxel && now.on_face(i) == other.on_face(j) && now.element[i] == other.element[j]) return true;
    const Vec3d &p = target.point, q = other.position[j].cast<double>();
    const Vec3d normal =
        normal_of(other, j, *motion.there->mesh, motion.T_cv_mesh, motion.T_mesh_cv_there * q);
    const double off_seen = std::abs(normal.dot(p - q)), off_own = std::abs(target.normal.dot(p - q));
    const bool has_normals = !normal.isZero() && !target.normal.isZero();
    // What turned its back is hidden by its front, however thin it is, unless there is but one sheet of it.
    const bool same_side = facing(other.camera, normal, q) * facing(other.camera, target.normal, p) > 0;
    if (has_normals && target.turned && !same_side && off_seen > plane_rounding * p.z()) return false;
    const bool same_depth = std::abs(p.z() - q.z()) <= depth_tolerance * p.z();
    if (!flat || !has_normals) return same_depth;
    const double across = other.camera.projection == Projection::orthographic
                              ? (p - q).head<2>().norm()
                              : (p.head<2>() - q.head<2>() * (p.z() / q.z())).norm();
    const double tolerance = slack * across + rounding * p.z();
    // Within both planes at any slant; at an edge, within one.
    return std::max(off_seen, off_own) <= tolerance ||
           (same_depth && std::min(off_seen, off_own) <= tolerance);
}

bool is_seen(const Surfaces& other, const Vec2d& pixel, const Surfaces& now, size_t i, const Motion& motion,
             const Target& target) {
    const Vec2d end = other.size.cast<double>() - Vec2d(0.5, 0.5);
    if (!(pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < end.x() && pixel.y() < end.y())) return false;
    const int x0 = int(std::floor(pixel.x())), y0 = int(std::floor(pixel.y()));
    for (int y = std::max(0, y0); y <= std::min(other.size.y() - 1, y0 + 1); ++y)
        for (int x = std::max(0, x0); x <= std::min(other.size.x() - 1, x0 + 1); ++x)
            if (shows(other, size_t(y) * size_t(other.size.x()) + size_t(x), now, i, motion, target))
                return true;
    return false;
}

}  // namespace

void optical_flow(const Surfaces& now, const Surfaces& other, LayerArray& flow, LayerArray& occlusion) {
    flow = make_layer<float>(now.size, 2);
    occlusion = make_layer<uint8_t>(now.size, 1);
    float* f = std::get<std::vector<float>>(flow.values).data();
    uint8_t* o = std::get<std::vector<uint8_t>>(occlusion.values).data();
    const std::vector<Motion> all = motions(now, other);
    const double reach = lens_reach(other.camera);
    parallel_for(now.object.size(), 1 << 12, [&](size_t i) {
        if (!now.covered(i)) return;
        const Motion& motion = all[now.object[i] - 1];
        o[i] = 1;
        f[2 * i] = f[2 * i + 1] = std::numeric_limits<float>::quiet_NaN();
        if (!motion.there) return;
        const Target target = target_of(now, i, motion, other);
        const Vec3d& p = target.point;
        if (!is_projected(other.camera, reach, p)) return;
        const Vec2d place = project(other.camera, other.size, p);
        const size_t x = i % size_t(now.size.x()), y = i / size_t(now.size.x());
        f[2 * i] = float(place.x() - double(x));
        f[2 * i + 1] = float(place.y() - double(y));
        o[i] = !is_seen(other, place, now, i, motion, target);
    });
}

}  // namespace easypbr::dataset
