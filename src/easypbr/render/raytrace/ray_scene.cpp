#include "easypbr/render/raytrace/ray_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "easypbr/render/raytrace/caster_tree.h"
#include "easypbr/render/raytrace/ray_packet.h"
#include "easypbr/render/raytrace/smooth_surface.h"

namespace easypbr::render {
namespace {

constexpr float endless = std::numeric_limits<float>::infinity();
/// An endless ground ends there, RayScene::unit(): single precision holds squares of places on it.
constexpr double ground_end = 1e6;

/// Of length 1, and on the side that a ray in this direction comes from.
Vec3 towards_start(const Vec3& normal, const Vec3& direction) {
    return normal.normalized() * (normal.dot(direction) > 0 ? -1.0f : 1.0f);
}

}  // namespace

RayScene::RayScene() = default;
RayScene::~RayScene() = default;

void RayScene::update(const DrawList& casters, const Box3d& bounds, uint64_t generation,
                      const Primitives& primitives, const std::optional<RayGround>& ground) {
    ground_ = ground;
    std::vector<std::pair<Primitive*, const DrawItem*>> items;
    for (const auto& kind : primitives)
        for (const DrawItem& item : casters.of(kind->mode())) items.emplace_back(kind.get(), &item);
    const auto reach_of = [&](const auto& of) {
        const auto& [kind, item] = of;
        return item->kind == SurfaceKind::lit ? float(kind->reach(*item) / unit_) : 0.0f;
    };
    if (scene_ && generation == generation_) {
        // The list may be another one of the same casters, which may be lit otherwise.
        reach_ = 0;
        for (size_t i = 0; i < items.size(); ++i) {
            scene_->elements[i]->item = items[i].second;
            scene_->reaches[i] = reach_of(items[i]);
            reach_ = std::max(reach_, scene_->reaches[i]);
        }
        return place_ground();
    }
    generation_ = generation;
    scene_.reset();
    reach_ = 0;
    ball_ = {};
    if (items.empty() || bounds.isEmpty() || !(bounds.diagonal().norm() > 0)) return place_ground();
    centre_ = bounds.center();
    unit_ = bounds.diagonal().norm() / 2;
    place_ground();
    auto made =
        std::make_unique<CasterTree>(centre_, unit_);  // kept once all is there: it can be interrupted
    for (const auto& each : items) {
        const auto& [kind, item] = each;
        const float reach = reach_of(each);
        reach_ = std::max(reach_, reach);
        kind->add_to(*made, *item);
        made->kinds.resize(made->elements.size(), kind);
        made->reaches.resize(made->elements.size(), reach);
    }
    made->tree.build();
    const Eigen::AlignedBox3f box = made->tree.bounds();
    constexpr float rounding = 1e-4f;  // of what rays meet
    if (!box.isEmpty()) ball_ = {box.center(), box.diagonal().norm() / 2 + rounding};
    scene_ = std::move(made);
}

void RayScene::place_ground() {
    if (!ground_) return;
    plane_ = {ground_->up.cast<float>(), float((ground_->height - ground_->up.dot(centre_)) / unit_),
              float(std::min(ground_->radius / unit_, ground_end))};
}

void RayScene::make_surfaces(const ResolvedSettings& resolved) {
    ++surfaces_generation_;
    extensions_ = 0;
    if (!scene_) return;
    scene_->surfaces.clear();
    for (size_t i = 0; i < scene_->elements.size(); ++i) {
        const RayElement& element = *scene_->elements[i];
        scene_->surfaces.push_back(scene_->kinds[i]->hit_surface(resolved, *element.item));
        if (element.faces > 0) extensions_ |= element.item->extensions();
    }
}

const HitSurface& RayScene::surface(int index) const {
    return *scene_->surfaces[size_t(index)];
}

float RayScene::reach(const SurfacePlace& on) const {
    if (on.surface < 0) return 0;
    const float most = scene_->reaches[size_t(on.surface)];
    const std::vector<float>& own = scene_->elements[size_t(on.surface)]->reaches;
    return own.empty() ? most : std::min(most, own[size_t(on.element)]);
}

float RayScene::reach_beside(const Place& place) const {
    if (!(reach_ > 0)) return 0;
    float nearest = reach_, found = reach_;
    for (const Vec3& way : {place.view, Vec3(-place.view)}) {
        const auto hit = first_hit({place.position, way, nearest}, Transmissive::layers, false);
        if (!hit || !(hit->distance <= reach(hit->on()) + place.rounding())) continue;
        nearest = hit->distance;
        found = reach(hit->on());
    }
    return found;
}

int RayScene::surface_count() const {
    return scene_ ? int(scene_->surfaces.size()) : 0;
}

const DrawItem& RayScene::item_of(int surface) const {
    return *scene_->elements[size_t(surface)]->item;
}

FaceRange RayScene::emissive_faces(int surface) const {
    const RayElement& element = *scene_->elements[size_t(surface)];
    const DrawItem& item = *element.item;
    const Material& material = item.material;
    const bool emits = item.kind == SurfaceKind::lit && !material.unlit && material.emissive.maxCoeff() > 0;
    return emits && !is_filtered(item) ? FaceRange{element.first, element.faces} : FaceRange{};
}

std::array<Vec3, 3> RayScene::triangle(int surface, int face) const {
    const RayElement& element = *scene_->elements[size_t(surface)];
    const auto corner = [&](int c) { return (*element.vertices)[size_t(element.item->mesh().F(face, c))]; };
    return {corner(0), corner(1), corner(2)};
}

Vec3 RayScene::to_smooth(const SurfacePlace& on, const Vec3& face) const {
    auto normals = corner_normals(on);
    if (!normals) return Vec3::Zero();
    for (Vec3& normal : *normals)
        if (normal.dot(face) < 0) normal = -normal;
    return to_smooth_surface(triangle(on.surface, on.element), *normals, on.u, on.v);
}

bool RayScene::is_sheet(const RayHit& hit, const Vec3& direction) const {
    if (hit.surface < 0 || !scene_->elements[size_t(hit.surface)]->is_open) return false;
    const auto looks_back = [&](const RayHit& met) {
        const std::array<Vec3, 3> corners = triangle(met.surface, met.element);
        return (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(direction) < 0;
    };
    const auto* const object = item_of(hit.surface).object;
    // Beyond so many other surfaces it is the same to the eye.
    constexpr int most = 32;
    std::optional<RayHit> met = hit;
    for (int i = 0; i < most; ++i) {
        met = first_hit({start_at(*met, -met->normal), direction, endless}, Transmissive::layers, false);
        if (!met || met->surface < 0) return true;
        if (item_of(met->surface).object == object) return looks_back(*met) == looks_back(hit);
    }
    return true;
}

std::optional<std::array<Vec3, 3>> RayScene::corner_normals(const SurfacePlace& on) const {
    if (on.surface < 0) return std::nullopt;
    const RayElement& element = *scene_->elements[size_t(on.surface)];
    const MeshData& mesh = element.item->mesh();
    if (element.faces == 0 || element.item->style.flat || mesh.N.empty()) return std::nullopt;
    std::array<Vec3, 3> normals;
    for (int c = 0; c < 3; ++c) {
        const Vec3 normal = element.world_from_normals * mesh.N.row(mesh.F(on.element, c)).transpose();
        normals[size_t(c)] = normal.normalized();
        if (!normals[size_t(c)].allFinite()) return std::nullopt;
    }
    return normals;
}

bool RayScene::has_normal(const SurfacePlace& on, const Vec3& face, const Vec3& normal) const {
    // The ground has no surface, nor a map.
    const bool is_mapped = on.surface >= 0 && item_of(on.surface).has_mapped_normals();
    const float least = is_mapped ? 0 : 0.3f;
    if (face.dot(normal) > least) return true;
    const auto corners = corner_normals(on);
    if (!corners) return false;
    const Vec3 mean = (1 - on.u - on.v) * (*corners)[0] + on.u * (*corners)[1] + on.v * (*corners)[2];
    return std::abs(mean.dot(normal)) > least * mean.norm();
}

SurfacePlace RayScene::place_on(unsigned geometry, unsigned primitive, float u, float v) const {
    return {int(geometry), scene_->elements[geometry]->of(primitive), u, v};
}

Vec3 RayScene::off_surface(const Vec3& at, const Vec3& away, const Vec3& reach) {
    return at + away * rounding(at.norm()) + reach;
}

float RayScene::ground_distance(const Vec3& from, const Vec3& direction, bool fades) const {
    if (!ground_) return endless;
    const Vec3& up = plane_.up;
    const float above = up.dot(from) - plane_.height, falls = -up.dot(direction);
    if (above <= 0 || falls <= 0) return endless;
    const Vec3 at = from + direction * (above / falls);
    const float part = (at - up * up.dot(at)).norm() / plane_.radius;
    if (!(part < 1)) return endless;
    return fades && passes_ground(from, direction, part) ? endless : above / falls;
}

std::optional<RayHit> RayScene::trace(const Vec3& from, const Vec3& direction,
                                      Transmissive transmissive) const {
    return first_hit({from, direction, endless}, transmissive, true);
}

std::optional<RayHit> RayScene::first_hit(const RaySegment& ray, Transmissive transmissive,
                                          bool by_chance) const {
    const Vec3 &from = ray.from, &direction = ray.direction;
    const float to_ground = ground_distance(from, direction, by_chance);
    RTCRayHit found;
    put_ray(from, direction, std::min(to_ground, ray.distance), found.ray);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RayQuery query(transmissive);
    query.meets_gaussians = by_chance;
    if (scene_) embree::intersect(scene_->tree.get(), query.context, found);
    RayHit hit;
    hit.distance = found.ray.tfar;
    hit.position = from + direction * found.ray.tfar;
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        if (!(to_ground <= ray.distance) || !std::isfinite(to_ground)) return std::nullopt;
        hit.normal = plane_.up;
        return hit;
    }
    const RayElement& element = *scene_->elements[found.hit.geomID];
    hit.item = element.item;
    hit.surface = int(found.hit.geomID);
    hit.element = element.of(found.hit.primID);
    hit.u = found.hit.u;
    hit.v = found.hit.v;
    hit.normal = towards_start({found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z}, direction);
    return hit;
}

namespace {

/// To a place from where it is looked for.
RaySegment ray_to(const RayScene::Place& place, float before) {
    return {place.position + before * place.view, -place.view, before + place.rounding()};
}

}  // namespace

RayScene::Seen RayScene::seen_by(const Place& place, const RaySegment& ray, float distance, const Vec3& face,
                                 const SurfacePlace& on) const {
    const Vec3 position = ray.from + ray.direction * distance;
    if (has_normal(on, face, place.normal)) return {position, face, place.normal, reach(on), on};
    const bool stands_before = distance < place.before() - rounding(place.position.norm());
    return stands_before ? Seen{position, face, face, reach(on), {}} : nothing_at(place);
}

RayScene::Seen RayScene::seen_at(const Place& place, Transmissive transmissive) const {
    if (transmissive == Transmissive::layers && place.footprint > 0) {
        // Within the footprint there may be other layers of the same pixel: the place's own counts.
        const RaySegment ray = ray_to(place, place.rounding());
        const auto hit = first_hit(ray, transmissive, false);
        if (hit && has_normal(hit->on(), hit->normal, place.normal))
            return seen_by(place, ray, hit->distance, hit->normal, hit->on());
    }
    const RaySegment ray = ray_to(place, place.before());
    const auto hit = first_hit(ray, transmissive, false);
    return hit ? seen_by(place, ray, hit->distance, hit->normal, hit->on()) : nothing_at(place);
}

void RayScene::see(Places& places, Transmissive transmissive) const {
    const auto put = [&](size_t i, const Seen& seen) {
        places.position.set(i, seen.position);
        places.face.set(i, seen.face);
        places.normal.set(i, seen.normal);
        places.reach[i] = seen.reach;
        places.on[i] = seen.on;
    };
    if (!scene_ || scene_->calls_back) {
        for (size_t i = 0; i < places.count; ++i) put(i, seen_at(places.at(i), transmissive));
        return;
    }
    for_each_packet(places.count, [&](const int* valid, size_t first, size_t count) {
        std::array<RaySegment, packet_size> segments;
        alignas(64) RTCRayHit16 rays;
        for (size_t i = 0; i < packet_size; ++i) {
            const Place place = places.at(first + std::min(i, count - 1));
            segments[i] = ray_to(place, place.before());
            set_ray(rays.ray, i, segments[i]);
            rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        embree::intersect(scene_->tree.get(), valid, rays);
        for (size_t i = 0; i < count; ++i) {
            const Place place = places.at(first + i);
            const RaySegment& ray = segments[i];
            const float to_ground = ground_distance(ray.from, ray.direction, false);
            if (to_ground < rays.ray.tfar[i])
                put(first + i, seen_by(place, ray, to_ground, plane_.up, {}));
            else if (rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID)
                put(first + i, nothing_at(place));
            else
                put(first + i,
                    seen_by(
                        place, ray, rays.ray.tfar[i],
                        towards_start({rays.hit.Ng_x[i], rays.hit.Ng_y[i], rays.hit.Ng_z[i]}, ray.direction),
                        place_on(rays.hit.geomID[i], rays.hit.primID[i], rays.hit.u[i], rays.hit.v[i])));
        }
    });
}

std::optional<RayHit> RayScene::hit_at(const Place& place, Transmissive transmissive) const {
    if (transmissive == Transmissive::layers) {
        auto own = first_hit(ray_to(place, place.rounding()), transmissive, false);
        if (own && own->surface >= 0) return own;
    }
    const float before = place.before();
    auto hit = first_hit({place.position + before * place.view, -place.view, endless}, transmissive, false);
    // At a silhouette the surface may go on behind the place, by more than a pixel.
    if (!hit || hit->surface < 0 || hit->distance > 16 * before) return std::nullopt;
    return hit;
}

bool RayScene::blocked(const Vec3& from, const Vec3& direction, float distance,
                       Transmissive transmissive) const {
    if (!scene_) return false;
    RTCRay ray;
    put_ray(from, direction, distance, ray);
    RayQuery query(transmissive);
    embree::occlude(scene_->tree.get(), query.context, ray);
    return ray.tfar < 0;
}

std::vector<uint8_t> RayScene::blocked(std::span<const RaySegment> rays, Neighbours neighbours,
                                       Transmissive transmissive) const {
    std::vector<uint8_t> found(rays.size(), 0);
    if (!scene_) return found;
    if (scene_->calls_back || neighbours == Neighbours::scattered) {
        for (size_t i = 0; i < rays.size(); ++i)
            found[i] = rays[i].distance > 0 &&
                       blocked(rays[i].from, rays[i].direction, rays[i].distance, transmissive);
        return found;
    }
    for_each_packet(rays.size(), [&](const int* valid, size_t first, size_t count) {
        alignas(64) RTCRay16 packet;
        for (size_t i = 0; i < packet_size; ++i) set_ray(packet, i, rays[first + std::min(i, count - 1)]);
        embree::occlude(scene_->tree.get(), valid, packet);
        for (size_t i = 0; i < count; ++i)
            found[first + i] = rays[first + i].distance > 0 && packet.tfar[i] < 0;
    });
    return found;
}

Vec3 RayScene::transmittance(const Vec3& from, const Vec3& direction, float distance, float stopping) const {
    if (!scene_) return Vec3::Ones();
    RTCRay ray;
    put_ray(from, direction, distance, ray);
    StraightLight light;
    RayQuery query(Transmissive::passed);
    query.light = &light;
    query.stopping = stopping;
    embree::occlude(scene_->tree.get(), query.context, ray);
    return ray.tfar < 0 ? Vec3(Vec3::Zero()) : light.absorbed(distance, float(unit_));
}

}  // namespace easypbr::render
