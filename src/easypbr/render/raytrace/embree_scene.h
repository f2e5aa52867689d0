// Embree's device, scene and geometries, which report by a status what here are exceptions.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

#include "easypbr/core/math.h"
#include "easypbr/render/raytrace/embree.h"

namespace easypbr::render::embree {

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;
using Geometry = Owned<RTCGeometry>;

/// A tree of geometries that rays are traced against. Everything throws Error where Embree runs out of memory
/// or refuses an argument.
class Scene {
  public:
    Scene();

    /// To trace rays against, once it is built.
    RTCScene get() const { return scene_.get(); }

    Geometry make(RTCGeometryType type);
    /// The functions that bound and meet the primitives of a geometry of the type USER.
    struct OwnPrimitives {
        unsigned count;
        RTCBoundsFunction bounds;
        RTCIntersectFunctionN intersect;
        RTCOccludedFunctionN occluded;
    };
    void set_own(const Geometry& geometry, const OwnPrimitives& primitives);
    /// A new buffer of a geometry, which is to be filled.
    template <class T>
    std::span<T> buffer(const Geometry& geometry, RTCBufferType type, RTCFormat format, size_t count) {
        return {static_cast<T*>(new_buffer(geometry, type, format, sizeof(T), count)), count};
    }
    /// Adds a geometry whose buffers are filled; `id` is what hits name it by.
    void attach(const Geometry& geometry, unsigned id);
    /// Builds the tree. Throws Interrupted too; nothing may be traced then.
    void build();
    /// Of all primitives; empty where there are none.
    Eigen::AlignedBox3f bounds() const;

  private:
    void* new_buffer(const Geometry& geometry, RTCBufferType type, RTCFormat format, size_t stride,
                     size_t count);
    /// Throws Error when the last call failed.
    void check();

    Owned<RTCDevice> device_;
    Owned<RTCScene> scene_;
};

}  // namespace easypbr::render::embree
