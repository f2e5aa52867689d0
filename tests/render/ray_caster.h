// An independent oracle for shadows and occlusion: rays cast by Embree against the triangles of a snapshot.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/render/raytrace/embree.h"
#include "easypbr/scene/scene.h"

namespace easypbr {

class RayCaster {
  public:
    explicit RayCaster(const SceneSnapshot& snapshot) : device_(rtcNewDevice(nullptr)) {
        if (!device_) throw Error("Embree gives no device");
        scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        for (const auto& object : snapshot.objects) add(object);
        rtcCommitScene(scene_);
    }
    ~RayCaster() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    RayCaster(const RayCaster&) = delete;
    RayCaster& operator=(const RayCaster&) = delete;

    /// Distance to the first surface, in lengths of `direction`; infinity when nothing is met.
    float distance(const Vec3& from, const Vec3& direction, float nearest = 0) const {
        RTCRayHit hit{};
        hit.ray.org_x = from.x();
        hit.ray.org_y = from.y();
        hit.ray.org_z = from.z();
        hit.ray.dir_x = direction.x();
        hit.ray.dir_y = direction.y();
        hit.ray.dir_z = direction.z();
        hit.ray.tnear = nearest;
        hit.ray.tfar = std::numeric_limits<float>::infinity();
        hit.ray.mask = ~0u;
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        render::embree::Context context;
        render::embree::begin(context);
        render::embree::intersect(scene_, context, hit);
        return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity()
                                                         : hit.ray.tfar;
    }

    /// Whether anything lies between two points, their neighbourhoods (a part `margin` of the way) left out.
    bool blocked(const Vec3d& from, const Vec3d& to, float margin = 1e-4f) const {
        return distance(from.cast<float>(), (to - from).cast<float>(), margin) < 1 - margin;
    }

  private:
    void add(const SceneSnapshot::Object& object) {
        const MeshData& mesh = *object.mesh;
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* V = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                              RTC_FORMAT_FLOAT3, 12, size_t(mesh.V.rows())));
        for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
            const Vec3d p = object.T_world_mesh * Vec3d(mesh.V.row(i).transpose().cast<double>());
            for (int c = 0; c < 3; ++c) V[3 * i + c] = float(p[c]);
        }
        auto* F = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, size_t(mesh.F.rows())));
        for (Eigen::Index i = 0; i < mesh.F.size(); ++i) F[i] = uint32_t(mesh.F.data()[i]);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }

    RTCDevice device_;
    RTCScene scene_ = nullptr;
};

}  // namespace easypbr
