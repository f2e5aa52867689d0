// Embree 3 or 4, whichever the build has found: queries are the part in which their interfaces differ.
#pragma once

#if EASYPBR_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace easypbr::render::embree {

#if EASYPBR_EMBREE >= 4

using Context = RTCRayQueryContext;

inline void begin(Context& context) {
    rtcInitRayQueryContext(&context);
}

/// The first hit of a ray.
inline void intersect(RTCScene scene, Context& context, RTCRayHit& ray) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &ray, &arguments);
}

/// Any hit of a ray: sets tfar to minus infinity.
inline void occlude(RTCScene scene, Context& context, RTCRay& ray) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    rtcOccluded1(scene, &ray, &arguments);
}

#else

using Context = RTCIntersectContext;

inline void begin(Context& context) {
    rtcInitIntersectContext(&context);
}

inline void intersect(RTCScene scene, Context& context, RTCRayHit& ray) {
    rtcIntersect1(scene, &context, &ray);
}

inline void occlude(RTCScene scene, Context& context, RTCRay& ray) {
    rtcOccluded1(scene, &context, &ray);
}

#endif

}  // namespace easypbr::render::embree
