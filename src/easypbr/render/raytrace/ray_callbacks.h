// What Embree calls back while it traces rays: filters of holes and of what lets light through, and
// Gaussians.
#pragma once

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/raytrace/embree.h"
#include "easypbr/render/raytrace/ray_gaussians.h"
#include "easypbr/render/raytrace/ray_random.h"
#include "easypbr/render/raytrace/ray_scene.h"
#include "easypbr/render/raytrace/ray_surface.h"
#include "easypbr/render/raytrace/straight_light.h"

namespace easypbr::render {

/// Of a primitive among those of all geometries.
inline unsigned number_of(unsigned geometry, unsigned primitive) {
    return pcg_hash(geometry) ^ primitive;
}

/// Well-spread number in [0, 1) of a ray and the element it meets: number_of().
inline float hash_of(const RTCRay& ray, unsigned element) {
    uint32_t state = pcg_advance(element);
    for (const float value : {ray.dir_x, ray.dir_y, ray.dir_z, ray.org_x, ray.org_y, ray.org_z})
        state = pcg_hash(state ^ std::bit_cast<uint32_t>(value));
    return unit_number(state);
}

/// Where it is: copies of what has just been written in parts are slow.
inline void put_ray(const Vec3& from, const Vec3& direction, float farthest, RTCRay& ray) {
    ray.org_x = from.x();
    ray.org_y = from.y();
    ray.org_z = from.z();
    ray.tnear = 0;
    ray.dir_x = direction.x();
    ray.dir_y = direction.y();
    ray.dir_z = direction.z();
    ray.time = 0;
    ray.tfar = farthest;
    ray.mask = ~0u;
    ray.id = ray.flags = 0;
}

/// The fade of the ground, by the text that the shaders include.
struct GroundFade {
    static float smoothstep(float low, float high, float x) {
        const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
        return t * t * (3 - 2 * t);
    }
#include "ground_fade.glsl"
};

/// Whether a ray passes a ground that fades at this part of its radius: by a hash.
inline bool passes_ground(const Vec3& from, const Vec3& direction, float part) {
    const float gone = GroundFade().ground_fade(part);
    if (gone <= 0) return false;
    RTCRay ray;
    put_ray(from, direction, std::numeric_limits<float>::infinity(), ray);
    return hash_of(ray, ~0u) < gone;
}

/// What a filter needs to know.
struct RayElement {
    const DrawItem* item = nullptr;
    int first = 0;                                ///< element of the item
    int triangles = 1;                            ///< of each
    int faces = 0;                                ///< of a mesh; 0: the elements are no faces
    const std::vector<Vec3>* vertices = nullptr;  ///< of faces
    std::vector<float> reaches = {};              ///< of polygons: how far each reaches around its vertex
    const RayGaussians* gaussians = nullptr;
    float unit = 1;                              ///< RayScene::unit()
    Mat3 world_from_normals = Mat3::Identity();  ///< of faces: turns normals of the mesh, not to unit length
    float outwards = 1;      ///< -1: the normals of faces look into the volume that they bound
    bool is_closed = false;  ///< of faces that light passes: their mesh has no holes, and is wound one way
    bool is_open = false;    ///< likewise: their mesh has holes

    int of(unsigned triangle) const { return first + int(triangle) / triangles; }
};

/// Whether rays pass some places of it.
inline bool is_filtered(const DrawItem& item) {
    return item.alpha != AlphaMode::opaque || item.casts_tint();
}

/// What a ray asks of the surfaces that it passes. Embree hands it to the filter.
struct RayQuery {
    embree::Context context;
    Transmissive transmissive = Transmissive::passed;
    StraightLight* light = nullptr;         ///< that passes surfaces, where it is asked for
    float stopping = RayScene::passes_all;  ///< roughness of faces that stop that light
    bool meets_gaussians = true;

    explicit RayQuery(Transmissive transmissive_) : transmissive(transmissive_) { embree::begin(context); }
};

/// Light below this part is none.
inline constexpr float least_transmittance = 1e-3f;

/// Of the angle between a ray and the normal of the face that it meets, both of any length: negative where it
/// meets the front. 1 for elements without a normal.
inline float cosine_between(const RTCRay& ray, const RTCHit& hit) {
    const Vec3 direction(ray.dir_x, ray.dir_y, ray.dir_z), normal(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    const float lengths = direction.stableNorm() * normal.stableNorm();
    return lengths > 0 ? direction.dot(normal) / lengths : 1;
}

/// Takes from light what a surface takes that it passes straight; whether some is left.
inline bool passes(StraightLight& light, const RayElement& element, const RTCRay& ray, const RTCHit& hit,
                   float stopping) {
    const DrawItem& item = *element.item;
    Passage passage = passage_at(item, element.of(hit.primID), hit.u, hit.v);
    // Paths meet elements that are no faces as if these were opaque: no other way leads through them.
    if (element.faces > 0) passage.stop_from(stopping);
    const float cosine = cosine_between(ray, hit);
    if (passage.thickness > 0 && passage.coverage > 0) {
        const float thickness = passage.thickness / element.unit;
        const VolumeFace face{&item,     ray.tfar,       cosine * element.outwards > 0, element.is_closed,
                              thickness, passage.color()};
        if (!light.add(face)) return true;
    }
    light.left = light.left.cwiseProduct(passage.left(cosine));
    return light.left.maxCoeff() > least_transmittance;
}

/// Leaves out holes and what lets the ray through.
inline void filter(const RTCFilterFunctionNArguments* args) {
    const auto& element = *static_cast<const RayElement*>(args->geometryUserPtr);
    if (args->valid[0] != -1 || args->N != 1) return;
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& query = *reinterpret_cast<const RayQuery*>(args->context);
    const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
    if (query.light) {
        if (passes(*query.light, element, ray, hit, query.stopping)) args->valid[0] = 0;
        return;
    }
    const int index = element.of(hit.primID);
    if (query.transmissive == Transmissive::opaque && element.item->alpha == AlphaMode::blend) {
        args->valid[0] = 0;
        return;
    }
    const float stops =
        query.transmissive == Transmissive::passed
            ? opacity_at(*element.item, index, hit.u, hit.v, cosine_between(ray, hit), element.is_open)
            : coverage_at(*element.item, index, hit.u, hit.v);
    if (query.transmissive == Transmissive::layers && stops > 0) return;
    if (stops < 1 && (stops <= 0 || hash_of(ray, number_of(hit.geomID, hit.primID)) >= stops))
        args->valid[0] = 0;
}

inline Vec3 origin_of(const RTCRay& ray) {
    return {ray.org_x, ray.org_y, ray.org_z};
}
inline Vec3 direction_of(const RTCRay& ray) {
    return {ray.dir_x, ray.dir_y, ray.dir_z};
}

inline void bound_gaussian(const RTCBoundsFunctionArguments* args) {
    const auto& element = *static_cast<const RayElement*>(args->geometryUserPtr);
    Eigen::AlignedBox3f box = element.gaussians->bounds(args->primID);
    // Embree leaves out what has no extent.
    if (box.isEmpty()) box = Eigen::AlignedBox3f(Vec3::Constant(1), Vec3::Constant(-1));
    RTCBounds& to = *args->bounds_o;
    to.lower_x = box.min().x();
    to.lower_y = box.min().y();
    to.lower_z = box.min().z();
    to.upper_x = box.max().x();
    to.upper_y = box.max().y();
    to.upper_z = box.max().z();
}

/// Where a ray of a query meets a Gaussian; an opacity of 0 where it does not.
template <class Arguments>
RayGaussians::Meeting meeting_of(const Arguments* args, const RTCRay& ray) {
    if (args->valid[0] != -1 || args->N != 1) return {};
    if (!reinterpret_cast<const RayQuery*>(args->context)->meets_gaussians) return {};
    const auto& element = *static_cast<const RayElement*>(args->geometryUserPtr);
    const auto meeting = element.gaussians->meet(args->primID, origin_of(ray), direction_of(ray));
    return meeting.distance > ray.tnear && meeting.distance < ray.tfar ? meeting : RayGaussians::Meeting{};
}

template <class Arguments>
bool is_stopped(const Arguments* args, const RTCRay& ray, float opacity) {
    return opacity > 0 && hash_of(ray, number_of(args->geomID, args->primID)) < opacity;
}

inline void meet_gaussian(const RTCIntersectFunctionNArguments* args) {
    auto& found = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    const RayGaussians::Meeting meeting = meeting_of(args, found.ray);
    if (!is_stopped(args, found.ray, meeting.opacity)) return;
    found.ray.tfar = meeting.distance;
    found.hit.Ng_x = -found.ray.dir_x;
    found.hit.Ng_y = -found.ray.dir_y;
    found.hit.Ng_z = -found.ray.dir_z;
    found.hit.u = found.hit.v = 0;
    found.hit.primID = args->primID;
    found.hit.geomID = args->geomID;
    found.hit.instID[0] = args->context->instID[0];
}

inline void occlude_by_gaussian(const RTCOccludedFunctionNArguments* args) {
    auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
    const RayGaussians::Meeting meeting = meeting_of(args, ray);
    bool stops = false;
    if (StraightLight* light = reinterpret_cast<const RayQuery*>(args->context)->light) {
        light->left *= 1 - meeting.opacity;
        stops = light->left.maxCoeff() <= least_transmittance;
    } else {
        stops = is_stopped(args, ray, meeting.opacity);
    }
    if (stops) ray.tfar = -std::numeric_limits<float>::infinity();
}

}  // namespace easypbr::render
