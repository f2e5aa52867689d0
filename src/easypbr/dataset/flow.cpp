// Optical flow: where the points of one frame are in another.
#include <algorithm>
#include <cmath>

#include "easypbr/core/parallel.h"
#include "easypbr/dataset/flow.h"
#include "easypbr/dataset/layers.h"

namespace easypbr::dataset {
namespace {

/// A point is seen in the other frame when a pixel beside its place has the same object at this part of its
/// depth.
constexpr float depth_tolerance = 0.01f;

/// An object of this frame in the other one; none when it is not shown there.
struct Motion {
    const SceneSnapshot::Object* there = nullptr;
    uint32_t there_number = 0;
    bool same_faces = false;               ///< vertices correspond, even if they have moved
    Eigen::Affine3d T_mesh_cv, T_cv_mesh;  ///< of this frame back to the mesh, and on to the other's camera
};

std::vector<Motion> motions(const Surfaces& now, const Surfaces& other) {
    std::vector<Motion> all;
    for (const auto& object : now.scene.objects) {
        Motion motion;
        motion.T_mesh_cv = cv_from_mesh(now.camera, object).inverse();
        const auto found = std::ranges::find(other.scene.objects, object.name, &SceneSnapshot::Object::name);
        if (found != other.scene.objects.end()) {
            motion.there = &*found;
            motion.there_number = uint32_t(found - other.scene.objects.begin()) + 1;
            motion.T_cv_mesh = cv_from_mesh(other.camera, *found);
            motion.same_faces = found->mesh->F.rows() == object.mesh->F.rows() &&
                                found->mesh->V.rows() == object.mesh->V.rows() &&
                                found->mesh->V.revision() != object.mesh->V.revision();
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

bool is_seen(const Surfaces& other, const Vec2d& pixel, const Motion& motion, float depth) {
    const int x0 = int(std::floor(pixel.x())), y0 = int(std::floor(pixel.y()));
    for (int y = y0; y <= y0 + 1; ++y)
        for (int x = x0; x <= x0 + 1; ++x) {
            if (x < 0 || y < 0 || x >= other.size.x() || y >= other.size.y()) continue;
            const size_t i = size_t(y) * size_t(other.size.x()) + size_t(x);
            if (other.object[i] != motion.there_number) continue;
            if (std::abs(other.position[i].z() - depth) <= depth_tolerance * depth) return true;
        }
    return false;
}

}  // namespace

void optical_flow(const Surfaces& now, const Surfaces& other, LayerArray& flow, LayerArray& occlusion) {
    flow = make_layer<float>(now.size, 2);
    occlusion = make_layer<uint8_t>(now.size, 1);
    float* f = std::get<std::vector<float>>(flow.values).data();
    uint8_t* o = std::get<std::vector<uint8_t>>(occlusion.values).data();
    const std::vector<Motion> all = motions(now, other);
    const bool orthographic = other.camera.projection == Projection::orthographic;
    parallel_for(now.object.size(), 1 << 12, [&](size_t i) {
        if (!now.covered(i)) return;
        const Motion& motion = all[now.object[i] - 1];
        o[i] = 1;
        if (!motion.there) return;
        const Vec3d p = moved(now, i, motion);
        if (!orthographic && !(p.z() > 0)) return;
        const Vec2d place = project(other.camera, other.size, p);
        const size_t x = i % size_t(now.size.x()), y = i / size_t(now.size.x());
        f[2 * i] = float(place.x() - double(x));
        f[2 * i + 1] = float(place.y() - double(y));
        o[i] = !is_seen(other, place, motion, float(p.z()));
    });
}

}  // namespace easypbr::dataset
