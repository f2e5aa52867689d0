#include "easypbr/render/raytrace/embree_scene.h"

#include <fmt/format.h>

#include <atomic>
#include <thread>

#include "easypbr/core/error.h"
#include "easypbr/core/interrupt.h"

namespace easypbr::render::embree {
namespace {

[[noreturn]] void fail(RTCError error) {
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw Error("rays: not enough memory for Embree's tree");
    throw Error(fmt::format("rays: Embree failed with error {}", int(error)));
}

/// Whether a tree is to be built on. Embree asks on all threads that build; only the one that has begun can
/// be interrupted, and nothing may be thrown through Embree.
struct Building {
    std::thread::id owner = std::this_thread::get_id();
    std::atomic<bool> stopped = false;

    static bool goes_on(void* pointer, double) {
        auto& self = *static_cast<Building*>(pointer);
        if (std::this_thread::get_id() == self.owner) try {
                check_interrupt();
            } catch (const Interrupted&) {
                self.stopped = true;
            }
        return !self.stopped;
    }
};

}  // namespace

Scene::Scene() : device_(rtcNewDevice(nullptr)) {
    if (!device_) fail(rtcGetDeviceError(nullptr));
    scene_.reset(rtcNewScene(device_.get()));
    check();
    rtcSetSceneFlags(get(), RTC_SCENE_FLAG_ROBUST);
}

Geometry Scene::make(RTCGeometryType type) {
    Geometry geometry(rtcNewGeometry(device_.get(), type));
    check();
    return geometry;
}

void* Scene::new_buffer(const Geometry& geometry, RTCBufferType type, RTCFormat format, size_t stride,
                        size_t count) {
    void* data = rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, stride, count);
    check();
    return data;
}

void Scene::set_own(const Geometry& geometry, const OwnPrimitives& primitives) {
    rtcSetGeometryUserPrimitiveCount(geometry.get(), primitives.count);
    rtcSetGeometryBoundsFunction(geometry.get(), primitives.bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), primitives.intersect);
    rtcSetGeometryOccludedFunction(geometry.get(), primitives.occluded);
    check();
}

void Scene::attach(const Geometry& geometry, unsigned id) {
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(get(), geometry.get(), id);
    check();
}

void Scene::build() {
    Building building;
    rtcSetSceneProgressMonitorFunction(get(), Building::goes_on, &building);
    rtcCommitScene(get());
    rtcSetSceneProgressMonitorFunction(get(), nullptr, nullptr);
    if (!building.stopped) return check();
    rtcGetDeviceError(device_.get());
    throw Interrupted();
}

Eigen::AlignedBox3f Scene::bounds() const {
    RTCBounds found;
    rtcGetSceneBounds(get(), &found);
    return {Vec3(found.lower_x, found.lower_y, found.lower_z),
            Vec3(found.upper_x, found.upper_y, found.upper_z)};
}

void Scene::check() {
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE) fail(error);
}

}  // namespace easypbr::render::embree
