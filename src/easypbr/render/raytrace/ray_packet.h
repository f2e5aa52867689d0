// Rays that Embree traces together.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "easypbr/render/raytrace/embree_scene.h"
#include "easypbr/render/raytrace/ray_scene.h"

namespace easypbr::render {

inline constexpr size_t packet_size = embree::packet_size;

inline void set_ray(RTCRay16& rays, size_t i, const RaySegment& ray) {
    rays.org_x[i] = ray.from.x();
    rays.org_y[i] = ray.from.y();
    rays.org_z[i] = ray.from.z();
    rays.dir_x[i] = ray.direction.x();
    rays.dir_y[i] = ray.direction.y();
    rays.dir_z[i] = ray.direction.z();
    rays.tnear[i] = rays.time[i] = 0;
    rays.tfar[i] = ray.distance;
    rays.mask[i] = ~0u;
    rays.id[i] = rays.flags[i] = 0;
}

/// Calls `visit(valid, first, count)` for each packet of `rays` numbers. Embree asserts of idle lanes too
/// that they hold rays.
template <class Visit>
void for_each_packet(size_t rays, Visit&& visit) {
    for (size_t first = 0; first < rays; first += packet_size) {
        const size_t count = std::min(packet_size, rays - first);
        alignas(64) std::array<int, packet_size> valid{};
        std::fill_n(valid.begin(), count, -1);
        visit(valid.data(), first, count);
    }
}

}  // namespace easypbr::render
