#include "easypbr/drawing/occluders.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "easypbr/core/parallel.h"
#include "easypbr/render/raytrace/embree_scene.h"

namespace easypbr::drawing {
namespace {

namespace embree = render::embree;

Vec3d vertex(const Occluder& occluder, Eigen::Index i) {
    return occluder.T_world_mesh * Vec3d(occluder.mesh->V.row(i).transpose().cast<double>());
}

Box3d bounds_of(std::span<const Occluder> occluders) {
    Box3d bounds;
    for (const Occluder& occluder : occluders)
        for (Eigen::Index i = 0; i < occluder.mesh->V.rows(); ++i) bounds.extend(vertex(occluder, i));
    return bounds;
}

}  // namespace

/// Positions are relative to the middle and in units of half the diagonal, so that single precision holds
/// them.
struct Occluders::Tree {
    std::vector<std::vector<Eigen::Index>> faces;  ///< of each occluder, those in the tree
    Vec3d centre{0, 0, 0};
    double unit = 1;
    embree::Scene scene;

    Vec3d local(const Vec3d& world) const { return (world - centre) / unit; }

    void add(const Occluder& occluder) {
        const auto id = unsigned(faces.size());
        faces.push_back(occluder.faces);
        if (occluder.faces.empty()) return;
        const embree::Geometry geometry = scene.make(RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto V = scene.buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                                          size_t(occluder.mesh->V.rows()));
        parallel_for(V.size(), 1 << 14, [&](size_t i) {
            const Vec3 place = local(vertex(occluder, Eigen::Index(i))).cast<float>();
            V[i] = {place.x(), place.y(), place.z()};
        });
        const auto F = scene.buffer<std::array<uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX,
                                                             RTC_FORMAT_UINT3, occluder.faces.size());
        for (size_t i = 0; i < F.size(); ++i)
            for (int corner = 0; corner < 3; ++corner)
                F[i][size_t(corner)] = uint32_t(occluder.mesh->F(occluder.faces[i], corner));
        scene.attach(geometry, id);
    }
};

Occluders::Occluders(std::span<const Occluder> occluders) : tree_(std::make_unique<Tree>()) {
    const Box3d bounds = bounds_of(occluders);
    if (!bounds.isEmpty()) tree_->centre = bounds.center();
    if (bounds.diagonal().norm() > 0) tree_->unit = bounds.diagonal().norm() / 2;
    for (const Occluder& occluder : occluders) tree_->add(occluder);
    tree_->scene.build();
}

Occluders::~Occluders() = default;

bool Occluders::hide(const Vec3d& point, const Eye& eye, size_t occluder,
                     const std::array<Eigen::Index, 2>& faces) const {
    const Vec3d towards = eye.towards(point).normalized();
    const Vec3 from = tree_->local(point).cast<float>(), direction = towards.cast<float>();
    // The near plane ends the way to the eye.
    const double reach = (eye.depth(point) - eye.near) / eye.backward.dot(towards) / tree_->unit;
    RTCRayHit ray{};
    std::tie(ray.ray.org_x, ray.ray.org_y, ray.ray.org_z) = std::tuple(from.x(), from.y(), from.z());
    std::tie(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z) =
        std::tuple(direction.x(), direction.y(), direction.z());
    ray.ray.tnear = float(touch_part);
    ray.ray.mask = ~0u;
    for (;;) {
        ray.ray.tfar = float(reach);
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree::Context context;
        embree::begin(context);
        embree::intersect(tree_->scene.get(), context, ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
        const Eigen::Index face = tree_->faces[ray.hit.geomID][ray.hit.primID];
        if (ray.hit.geomID != occluder || std::ranges::find(faces, face) == faces.end()) return true;
        ray.ray.tnear = std::nextafter(ray.ray.tfar, std::numeric_limits<float>::infinity());
        if (!(ray.ray.tnear < float(reach))) return false;
    }
}

}  // namespace easypbr::drawing
