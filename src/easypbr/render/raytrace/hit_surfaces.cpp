#include "easypbr/render/raytrace/hit_surfaces.h"

#include <algorithm>
#include <array>

#include "easypbr/render/frame/surface_kind.h"

namespace easypbr::render {
namespace {

void put_ground(const RayGround& ground, const native::ElementHit& hit, size_t at, HitSurfaces& to) {
    const Vec3 normal = Eigen::Map<const Vec3>(hit.normal);
    to.normal.set(at, normal);
    to.face.set(at, normal);
    to.albedo.set(at, ground.color);
    to.emission.set(at, Vec3::Zero());
    to.parameters.set(at, Vec2(0, ground.roughness));
    to.kind[at] = code_of(SurfaceKind::lit);
}

}  // namespace

HitSurfaces::HitSurfaces(size_t count, bool with_extensions)
    : normal(PathBatch::rounded_up(count) + native::stream_alignment),
      face(normal.room()),
      albedo(face.room()),
      emission(face.room()),
      parameters(face.room()),
      kind(face.room()) {
    if (with_extensions) extensions.emplace(face.room());
}

native::HitSurfaces HitSurfaces::from(size_t first) {
    native::HitSurfaces to;
    normal.written_by(to.normal, first);
    face.written_by(to.face, first);
    albedo.written_by(to.albedo, first);
    emission.written_by(to.emission, first);
    parameters.written_by(to.parameters, first);
    to.kind = kind.data() + first;
    if (extensions) to.extensions = extensions->written_from(first);
    return to;
}

native::ElementHit native_hit(const RayHit& hit, float footprint) {
    native::ElementHit element;
    element.element = uint32_t(hit.element);
    element.u = hit.u;
    element.v = hit.v;
    std::copy_n(hit.normal.data(), 3, element.normal);
    element.footprint = footprint;
    return element;
}

HitSurfaces evaluate(const RayScene& scene, std::span<const native::ElementHit> hits,
                     std::span<const int> surfaces) {
    HitSurfaces found(hits.size(), scene.extensions() != 0);
    // In this order: what a surface is padded with, the next one overwrites.
    for (size_t first = 0; first < hits.size();) {
        const int surface = surfaces[first];
        size_t end = first + 1;
        while (end < hits.size() && surfaces[end] == surface) ++end;
        if (surface < 0)
            for (size_t i = first; i < end; ++i) put_ground(*scene.ground(), hits[i], i, found);
        else
            scene.surface(surface).shade(hits.subspan(first, end - first), found.from(first));
        first = end;
    }
    return found;
}

Vec3 emission_at(const RayScene& scene, const RayHit& hit) {
    const native::ElementHit element = native_hit(hit, 0);
    constexpr size_t room = native::stream_alignment;
    std::array<std::array<float, room>, 15> values;
    size_t next = 0;
    const auto component = [&] { return values[next++].data(); };
    native::HitSurfaces to;
    for (auto* vector : {&to.normal, &to.face, &to.albedo, &to.emission})
        for (float*& array : *vector) array = component();
    for (float*& array : to.parameters) array = component();
    to.kind = component();
    scene.surface(hit.surface).shade({&element, 1}, to);
    return {*to.emission[0], *to.emission[1], *to.emission[2]};
}

}  // namespace easypbr::render
