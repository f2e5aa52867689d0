#include "easypbr/render/raytrace/ray_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/facing.h"
#include "easypbr/render/raytrace/embree_scene.h"
#include "easypbr/render/raytrace/ray_callbacks.h"
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

/// What a place that comes from a pixel may be off by.
float rounding_at(const Vec3& place) {
    return 1e-4f * std::max(1.0f, place.norm());
}

}  // namespace

struct RayScene::Scene final : RayGeometry {
    Scene(const Vec3d& centre, double unit_)
        : world_scale(1 / unit_), from_world(Eigen::Scaling(1 / unit_) * Eigen::Translation3d(-centre)) {}

    Eigen::Affine3d placed(const DrawItem& item) const {
        return Eigen::Affine3d(from_world * item.object->T_world_mesh);
    }

    void attach(const embree::Geometry& geometry, RayElement given) {
        RayElement& element = *elements.emplace_back(std::make_unique<RayElement>(std::move(given)));
        const DrawItem& item = *element.item;
        element.unit = float(1 / world_scale);
        element.world_from_normals = item.object->T_world_mesh.linear().inverse().transpose().cast<float>();
        if (element.faces > 0 && item.material.transmits()) set_winding(element);
        rtcSetGeometryUserData(geometry.get(), &element);
        calls_back |= is_filtered(item) || element.gaussians;
        if (is_filtered(item) && !element.gaussians) {
            rtcSetGeometryIntersectFilterFunction(geometry.get(), filter);
            rtcSetGeometryOccludedFilterFunction(geometry.get(), filter);
        }
        tree.attach(geometry, unsigned(elements.size() - 1));
    }

    /// Of faces that light passes.
    void set_winding(RayElement& element) {
        const DrawItem& item = *element.item;
        const auto [found, is_new] = windings.try_emplace(item.object, gpu::Winding::unknown);
        if (is_new) found->second = gpu::winding_of(item.mesh().V, item.mesh().F);
        const bool is_mirrored = item.object->T_world_mesh.linear().determinant() < 0;
        element.is_closed = found->second == gpu::Winding::outward || found->second == gpu::Winding::inward;
        element.is_open = found->second == gpu::Winding::open;
        element.outwards = (found->second == gpu::Winding::inward) != is_mirrored ? -1.0f : 1.0f;
    }

    /// Of the parts of an object the same.
    const std::vector<Vec3>& vertices_of(const DrawItem& item, const Eigen::Affine3d& T) {
        std::vector<Vec3>& V = vertices[item.object];
        if (!V.empty()) return V;
        const MeshData& mesh = item.mesh();
        V.resize(size_t(mesh.V.rows()) + 1);  // Embree reads whole vectors of four.
        parallel_for(size_t(mesh.V.rows()), 1 << 14, [&](size_t i) {
            V[i] = (T * Vec3d(mesh.V.row(Eigen::Index(i)).transpose().cast<double>())).cast<float>();
        });
        return V;
    }

    void add_faces(const DrawItem& item) override {
        const MeshData& mesh = item.mesh();
        const embree::Geometry geometry = tree.make(RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto& V = vertices_of(item, placed(item));
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, V.data(), 0,
                                   sizeof(Vec3), size_t(mesh.V.rows()));
        const auto F = tree.buffer<std::array<uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                                            size_t(item.part.face_count));
        for (size_t i = 0; i < F.size(); ++i)
            for (int c = 0; c < 3; ++c)
                F[i][size_t(c)] = uint32_t(mesh.F(item.part.first_face + Eigen::Index(i), c));
        attach(geometry, {&item, item.part.first_face, 1, int(F.size()), &V});
    }

    void add_discs(const DrawItem& item, double world_radius) override {
        const MeshData& mesh = item.mesh();
        const Eigen::Affine3d T = placed(item);
        const auto radius = float(world_radius * world_scale);
        const bool oriented = !mesh.N.empty();
        const embree::Geometry geometry =
            tree.make(oriented ? RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT : RTC_GEOMETRY_TYPE_DISC_POINT);
        const auto V = tree.buffer<std::array<float, 4>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                                         size_t(mesh.V.rows()));
        for (size_t i = 0; i < V.size(); ++i) {
            const Vec3 p = (T * Vec3d(mesh.V.row(Eigen::Index(i)).transpose().cast<double>())).cast<float>();
            V[i] = {p.x(), p.y(), p.z(), radius};
        }
        if (oriented) {
            const auto N = tree.buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_NORMAL,
                                                             RTC_FORMAT_FLOAT3, size_t(mesh.V.rows()));
            const Mat3 normal_matrix = T.linear().inverse().transpose().cast<float>();
            for (size_t i = 0; i < N.size(); ++i) {
                const Vec3 n = (normal_matrix * mesh.N.row(Eigen::Index(i)).transpose()).normalized();
                N[i] = {n.x(), n.y(), n.z()};
            }
        }
        attach(geometry, {&item});
    }

    void add_polygons(const DrawItem& item, int corners,
                      const std::function<void(Eigen::Index, std::span<Vec3d>)>& polygon) override {
        const Eigen::Affine3d T = placed(item);
        const auto count = size_t(item.mesh().V.rows()), n = size_t(corners), triangles = n - 2;
        const embree::Geometry geometry = tree.make(RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto V =
            tree.buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, count * n);
        const auto F = tree.buffer<std::array<uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                                            count * triangles);
        RayElement element{&item, 0, int(triangles)};
        element.reaches.resize(count);
        parallel_for(count, 1 << 10, [&](size_t i) {
            std::array<Vec3d, size_t(most_corners)> places;
            polygon(Eigen::Index(i), std::span(places.data(), n));
            const Vec3d vertex = item.mesh().V.row(Eigen::Index(i)).transpose().cast<double>();
            for (size_t c = 0; c < n; ++c) {
                const Vec3 p = (T * places[c]).cast<float>();
                V[i * n + c] = {p.x(), p.y(), p.z()};
                const auto reach = float((T.linear() * (places[c] - vertex)).norm());
                element.reaches[i] = std::max(element.reaches[i], reach);
            }
            const auto first = uint32_t(i * n);
            for (uint32_t c = 0; c < triangles; ++c)
                F[i * triangles + c] = {first, first + c + 1, first + c + 2};
        });
        attach(geometry, std::move(element));
    }

    void add_gaussians(const DrawItem& item,
                       const std::function<RayGaussian(Eigen::Index)>& gaussian) override {
        const Eigen::Affine3d T = placed(item);
        const auto count = size_t(item.mesh().V.rows());
        RayGaussians& set = *gaussians.emplace_back(std::make_unique<RayGaussians>(count));
        parallel_for(count, 1 << 12, [&](size_t i) { set.set(i, gaussian(Eigen::Index(i)), T); });
        const embree::Geometry geometry = tree.make(RTC_GEOMETRY_TYPE_USER);
        tree.set_own(geometry, {unsigned(count), bound_gaussian, meet_gaussian, occlude_by_gaussian});
        attach(geometry, {.item = &item, .gaussians = &set});
    }

    double world_scale;
    Eigen::Affine3d from_world;
    embree::Scene tree;
    bool calls_back = false;  ///< some primitive does, for each ray alone
    std::vector<std::unique_ptr<RayElement>> elements;
    std::vector<std::unique_ptr<RayGaussians>> gaussians;
    std::vector<Primitive*> kinds;                      ///< of the elements
    std::vector<float> reaches;                         ///< likewise
    std::vector<std::unique_ptr<HitSurface>> surfaces;  ///< likewise, once they are made
    std::map<const SceneSnapshot::Object*, std::vector<Vec3>> vertices;
    std::map<const SceneSnapshot::Object*, gpu::Winding> windings;  ///< of those that light passes
};

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
    auto made = std::make_unique<Scene>(centre_, unit_);  // kept once all is there: it can be interrupted
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
        if (!hit || !(hit->distance <= reach(hit->on()) + rounding_at(place.position))) continue;
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

/// Before a place, from where it is looked for.
float start_before(const RayScene::Place& place) {
    return std::max(rounding_at(place.position), place.footprint);
}

RaySegment ray_to(const RayScene::Place& place) {
    const float near = start_before(place);
    return {place.position + near * place.view, -place.view, near + rounding_at(place.position)};
}

}  // namespace

RayScene::Seen RayScene::seen_by(const Place& place, const RaySegment& ray, float distance, const Vec3& face,
                                 const SurfacePlace& on) const {
    const Vec3 position = ray.from + ray.direction * distance;
    if (has_normal(on, face, place.normal)) return {position, face, place.normal, reach(on), on};
    const bool stands_before = distance < start_before(place) - 0.02f * rounding_at(place.position);
    return stands_before ? Seen{position, face, face, reach(on), {}} : nothing_at(place);
}

RayScene::Seen RayScene::seen_at(const Place& place, Transmissive transmissive) const {
    if (transmissive == Transmissive::layers && place.footprint > 0) {
        // Within the footprint there may be other layers of the same pixel: the place's own counts.
        Place exact = place;
        exact.footprint = 0;
        const RaySegment ray = ray_to(exact);
        const auto hit = first_hit(ray, transmissive, false);
        if (hit && has_normal(hit->on(), hit->normal, place.normal))
            return seen_by(exact, ray, hit->distance, hit->normal, hit->on());
    }
    const RaySegment ray = ray_to(place);
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
            segments[i] = ray_to(places.at(first + std::min(i, count - 1)));
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

std::optional<RayHit> RayScene::hit_at(const Vec3& place, const Vec3& view, float footprint,
                                       Transmissive transmissive) const {
    const float rounding = rounding_at(place), near = std::max(rounding, footprint);
    if (transmissive == Transmissive::layers) {
        auto own = first_hit({place + rounding * view, -view, 2 * rounding}, transmissive, false);
        if (own && own->surface >= 0) return own;
    }
    auto hit = first_hit({place + near * view, -view, endless}, transmissive, false);
    // At a silhouette the surface may go on behind the place, by more than a pixel.
    if (!hit || hit->surface < 0 || hit->distance > 16 * near) return std::nullopt;
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
