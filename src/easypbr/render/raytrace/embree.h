// Embree 3 or 4, whichever the build has found: queries are the part in which their interfaces differ.
#pragma once

#if EASYPBR_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace easypbr::render::embree {

/// Rays that are traced together, where no primitive calls back. Those that start beside each other in
/// similar directions take a part of the time.
inline constexpr int packet_size = 16;

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

/// The same of the rays of a packet whose `valid` is -1.
inline void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &rays, &arguments);
}

inline void occlude(RTCScene scene, const int* valid, RTCRay16& rays) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded16(valid, scene, &rays, &arguments);
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

inline void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
    Context context;
    begin(context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &context, &rays);
}

inline void occlude(RTCScene scene, const int* valid, RTCRay16& rays) {
    Context context;
    begin(context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded16(valid, scene, &context, &rays);
}

#endif

}  // namespace easypbr::render::embree
