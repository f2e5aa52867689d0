#include "easypbr/render/raytrace/ray_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "easypbr/core/parallel.h"
#include "easypbr/render/raytrace/embree_scene.h"
#include "easypbr/render/raytrace/ray_gaussians.h"
#include "easypbr/render/raytrace/ray_random.h"
#include "easypbr/render/raytrace/ray_surface.h"

namespace easypbr::render {
namespace {

/// Well-spread number in [0, 1) of a ray and the element it meets.
float hash_of(const RTCRay& ray, unsigned element) {
    uint32_t state = pcg_advance(element);
    for (const float value : {ray.dir_x, ray.dir_y, ray.dir_z, ray.org_x, ray.org_y, ray.org_z})
        state = pcg_hash(state ^ std::bit_cast<uint32_t>(value));
    return unit_number(state);
}

RTCRay ray_of(const Vec3& from, const Vec3& direction, float farthest) {
    RTCRay ray{};
    ray.org_x = from.x();
    ray.org_y = from.y();
    ray.org_z = from.z();
    ray.dir_x = direction.x();
    ray.dir_y = direction.y();
    ray.dir_z = direction.z();
    ray.tfar = farthest;
    ray.mask = ~0u;
    return ray;
}

/// What a filter needs to know.
struct Element {
    const DrawItem* item = nullptr;
    int first = 0;                                ///< element of the item
    int triangles = 1;                            ///< of each
    int faces = 0;                                ///< of a mesh; 0: the elements are no faces
    const std::vector<Vec3>* vertices = nullptr;  ///< of faces
    const RayGaussians* gaussians = nullptr;

    int of(unsigned triangle) const { return first + int(triangle) / triangles; }
};

/// Whether rays pass some places of it.
bool is_filtered(const DrawItem& item) {
    return item.alpha != AlphaMode::opaque || item.casts_tint();
}

/// What a ray asks of the surfaces that it passes. Embree hands it to the filter.
struct RayQuery {
    embree::Context context;
    Transmissive transmissive = Transmissive::passed;
    Vec3* transmittance = nullptr;  ///< of what is passed straight, where it is asked for
    bool meets_gaussians = true;

    explicit RayQuery(Transmissive transmissive_) : transmissive(transmissive_) { embree::begin(context); }
};

/// Light below this part is none.
constexpr float least_transmittance = 1e-3f;

/// Leaves out holes and what lets the ray through.
void filter(const RTCFilterFunctionNArguments* args) {
    const auto& element = *static_cast<const Element*>(args->geometryUserPtr);
    if (args->valid[0] != -1 || args->N != 1) return;
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& query = *reinterpret_cast<const RayQuery*>(args->context);
    const int index = element.of(hit.primID);
    if (query.transmittance) {
        Vec3& left = *query.transmittance;
        left = left.cwiseProduct(transmittance_at(*element.item, index, hit.u, hit.v));
        if (left.maxCoeff() > least_transmittance) args->valid[0] = 0;
        return;
    }
    if (query.transmissive == Transmissive::opaque && element.item->alpha == AlphaMode::blend) {
        args->valid[0] = 0;
        return;
    }
    const float stops = query.transmissive == Transmissive::passed
                            ? opacity_at(*element.item, index, hit.u, hit.v)
                            : coverage_at(*element.item, index, hit.u, hit.v);
    if (query.transmissive == Transmissive::layers && stops > 0) return;
    const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
    if (stops < 1 && (stops <= 0 || hash_of(ray, hit.primID) >= stops)) args->valid[0] = 0;
}

Vec3 origin_of(const RTCRay& ray) {
    return {ray.org_x, ray.org_y, ray.org_z};
}
Vec3 direction_of(const RTCRay& ray) {
    return {ray.dir_x, ray.dir_y, ray.dir_z};
}

void bound_gaussian(const RTCBoundsFunctionArguments* args) {
    const auto& element = *static_cast<const Element*>(args->geometryUserPtr);
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
    const auto& element = *static_cast<const Element*>(args->geometryUserPtr);
    const auto meeting = element.gaussians->meet(args->primID, origin_of(ray), direction_of(ray));
    return meeting.distance > ray.tnear && meeting.distance < ray.tfar ? meeting : RayGaussians::Meeting{};
}

template <class Arguments>
bool is_stopped(const Arguments* args, const RTCRay& ray, float opacity) {
    return opacity > 0 && hash_of(ray, args->primID ^ (args->geomID << 24)) < opacity;
}

void meet_gaussian(const RTCIntersectFunctionNArguments* args) {
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

void occlude_by_gaussian(const RTCOccludedFunctionNArguments* args) {
    auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
    const RayGaussians::Meeting meeting = meeting_of(args, ray);
    bool stops = false;
    if (Vec3* left = reinterpret_cast<const RayQuery*>(args->context)->transmittance) {
        *left *= 1 - meeting.opacity;
        stops = left->maxCoeff() <= least_transmittance;
    } else {
        stops = is_stopped(args, ray, meeting.opacity);
    }
    if (stops) ray.tfar = -std::numeric_limits<float>::infinity();
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

    void attach(const embree::Geometry& geometry, const Element& element) {
        const DrawItem& item = *element.item;
        elements.push_back(std::make_unique<Element>(element));
        rtcSetGeometryUserData(geometry.get(), elements.back().get());
        if (is_filtered(item) && !element.gaussians) {
            rtcSetGeometryIntersectFilterFunction(geometry.get(), filter);
            rtcSetGeometryOccludedFilterFunction(geometry.get(), filter);
        }
        tree.attach(geometry, unsigned(elements.size() - 1));
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
        parallel_for(count, 1 << 10, [&](size_t i) {
            std::array<Vec3d, most_corners> places;
            polygon(Eigen::Index(i), std::span(places.data(), n));
            for (size_t c = 0; c < n; ++c) {
                const Vec3 p = (T * places[c]).cast<float>();
                V[i * n + c] = {p.x(), p.y(), p.z()};
            }
            const auto first = uint32_t(i * n);
            for (uint32_t c = 0; c < triangles; ++c)
                F[i * triangles + c] = {first, first + c + 1, first + c + 2};
        });
        attach(geometry, {&item, 0, int(triangles)});
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

    static constexpr size_t most_corners = 16;
    double world_scale;
    Eigen::Affine3d from_world;
    embree::Scene tree;
    std::vector<std::unique_ptr<Element>> elements;
    std::vector<std::unique_ptr<RayGaussians>> gaussians;
    std::vector<Primitive*> kinds;                      ///< of the elements
    std::vector<std::unique_ptr<HitSurface>> surfaces;  ///< likewise, once they are made
    std::map<const SceneSnapshot::Object*, std::vector<Vec3>> vertices;
};

RayScene::RayScene() = default;
RayScene::~RayScene() = default;

void RayScene::update(const DrawList& casters, const Box3d& bounds, uint64_t generation,
                      const Primitives& primitives, const std::optional<RayGround>& ground) {
    ground_ = ground;
    std::vector<std::pair<Primitive*, const DrawItem*>> items;
    for (const auto& kind : primitives)
        for (const DrawItem& item : casters.of(kind->mode())) items.emplace_back(kind.get(), &item);
    if (scene_ && generation == generation_) {
        // The list may be another one of the same casters.
        for (size_t i = 0; i < items.size(); ++i) scene_->elements[i]->item = items[i].second;
        return;
    }
    generation_ = generation;
    scene_.reset();
    reach_ = 0;
    ball_ = {};
    if (items.empty() || bounds.isEmpty() || !(bounds.diagonal().norm() > 0)) return;
    centre_ = bounds.center();
    unit_ = bounds.diagonal().norm() / 2;
    auto made = std::make_unique<Scene>(centre_, unit_);  // kept once all is there: it can be interrupted
    for (const auto& [kind, item] : items) {
        if (item->kind == SurfaceKind::lit) reach_ = std::max(reach_, float(kind->reach(*item) / unit_));
        kind->add_to(*made, *item);
        made->kinds.resize(made->elements.size(), kind);
    }
    made->tree.build();
    const Eigen::AlignedBox3f box = made->tree.bounds();
    constexpr float rounding = 1e-4f;  // of what rays meet
    if (!box.isEmpty()) ball_ = {box.center(), box.diagonal().norm() / 2 + rounding};
    scene_ = std::move(made);
}

void RayScene::make_surfaces(const ResolvedSettings& resolved) {
    ++surfaces_generation_;
    extensions_ = 0;
    if (!scene_) return;
    scene_->surfaces.clear();
    for (size_t i = 0; i < scene_->elements.size(); ++i) {
        const Element& element = *scene_->elements[i];
        scene_->surfaces.push_back(scene_->kinds[i]->hit_surface(resolved, *element.item));
        if (element.faces > 0) extensions_ |= element.item->extensions();
    }
}

const HitSurface& RayScene::surface(int index) const {
    return *scene_->surfaces[size_t(index)];
}

int RayScene::surface_count() const {
    return scene_ ? int(scene_->surfaces.size()) : 0;
}

const DrawItem& RayScene::item_of(int surface) const {
    return *scene_->elements[size_t(surface)]->item;
}

FaceRange RayScene::emissive_faces(int surface) const {
    const Element& element = *scene_->elements[size_t(surface)];
    const DrawItem& item = *element.item;
    const Material& material = item.material;
    const bool emits = item.kind == SurfaceKind::lit && !material.unlit && material.emissive.maxCoeff() > 0;
    return emits && !is_filtered(item) ? FaceRange{element.first, element.faces} : FaceRange{};
}

std::array<Vec3, 3> RayScene::triangle(int surface, int face) const {
    const Element& element = *scene_->elements[size_t(surface)];
    const auto corner = [&](int c) { return (*element.vertices)[size_t(element.item->mesh().F(face, c))]; };
    return {corner(0), corner(1), corner(2)};
}

Vec3 RayScene::off_surface(const Vec3& at, const Vec3& normal, float reach) {
    constexpr float rounding = 2e-5f;  // of positions
    return at + normal * (std::max(1.0f, at.norm()) * rounding + reach);
}

float RayScene::ground_distance(const Vec3& from, const Vec3& direction) const {
    constexpr float none = std::numeric_limits<float>::infinity();
    if (!ground_) return none;
    const Vec3 up = ground_->up.cast<float>();
    const auto height = float((ground_->height - ground_->up.dot(centre_)) / unit_);
    const float above = up.dot(from) - height, falls = -up.dot(direction);
    if (above <= 0 || falls <= 0) return none;
    const Vec3 at = from + direction * (above / falls);
    return (at - up * up.dot(at)).norm() * float(unit_) < float(ground_->radius) ? above / falls : none;
}

std::optional<RayHit> RayScene::trace(const Vec3& from, const Vec3& direction, Transmissive transmissive,
                                      bool meets_gaussians) const {
    const float to_ground = ground_distance(from, direction);
    RTCRayHit found{};
    found.ray = ray_of(from, direction, to_ground);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RayQuery query(transmissive);
    query.meets_gaussians = meets_gaussians;
    if (scene_) embree::intersect(scene_->tree.get(), query.context, found);
    RayHit hit;
    hit.distance = found.ray.tfar;
    hit.position = from + direction * found.ray.tfar;
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        if (!std::isfinite(to_ground)) return std::nullopt;
        hit.normal = ground_->up.cast<float>();
        return hit;
    }
    const Element& element = *scene_->elements[found.hit.geomID];
    hit.item = element.item;
    hit.surface = int(found.hit.geomID);
    hit.element = element.of(found.hit.primID);
    hit.u = found.hit.u;
    hit.v = found.hit.v;
    const Vec3 n(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z);
    hit.normal = n.normalized() * (n.dot(direction) > 0 ? -1.0f : 1.0f);
    return hit;
}

RayScene::Seen RayScene::seen_at(const Vec3& place, const Vec3& normal, const Vec3& view, float footprint,
                                 Transmissive transmissive) const {
    const float rounding = rounding_at(place), near = std::max(rounding, footprint);
    const auto hit = trace(place + near * view, -view, transmissive, false);
    if (!hit || hit->distance > near + rounding) return {place, normal, normal};
    if (hit->normal.dot(normal) > 0.3f) return {hit->position, hit->normal, normal};
    const bool stands_before = hit->distance < near - 0.02f * rounding;
    return stands_before ? Seen{hit->position, hit->normal, hit->normal} : Seen{place, normal, normal};
}

std::optional<RayHit> RayScene::hit_at(const Vec3& place, const Vec3& view, float footprint,
                                       Transmissive transmissive) const {
    const float near = std::max(rounding_at(place), footprint);
    auto hit = trace(place + near * view, -view, transmissive, false);
    // At a silhouette the surface may go on behind the place, by more than a pixel.
    if (!hit || hit->surface < 0 || hit->distance > 16 * near) return std::nullopt;
    return hit;
}

bool RayScene::blocked(const Vec3& from, const Vec3& direction, float distance,
                       Transmissive transmissive) const {
    if (!scene_) return false;
    RTCRay ray = ray_of(from, direction, distance);
    RayQuery query(transmissive);
    embree::occlude(scene_->tree.get(), query.context, ray);
    return ray.tfar < 0;
}

Vec3 RayScene::transmittance(const Vec3& from, const Vec3& direction, float distance) const {
    Vec3 left = Vec3::Ones();
    if (!scene_) return left;
    RTCRay ray = ray_of(from, direction, distance);
    RayQuery query(Transmissive::passed);
    query.transmittance = &left;
    embree::occlude(scene_->tree.get(), query.context, ray);
    return ray.tfar < 0 ? Vec3(Vec3::Zero()) : left;
}

}  // namespace easypbr::render
