#include "easypbr/render/raytrace/ray_scene.h"

#include <embree3/rtcore.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/render/raytrace/ray_random.h"
#include "easypbr/render/raytrace/ray_surface.h"

namespace easypbr::render {
namespace {

/// Corners of the polygon that a surfel's ellipse is drawn as; its area is that of the ellipse.
constexpr int surfel_corners = 8;

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
    int first_face = 0;
};

/// Leaves out holes and what lets the ray through.
void filter(const RTCFilterFunctionNArguments* args) {
    const auto& element = *static_cast<const Element*>(args->geometryUserPtr);
    if (args->valid[0] != -1 || args->N != 1) return;
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const float stops = opacity_at(*element.item, element.first_face + int(hit.primID), hit.u, hit.v);
    const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
    if (stops < 1 && (stops <= 0 || hash_of(ray, hit.primID) >= stops)) args->valid[0] = 0;
}

}  // namespace

struct RayScene::Scene {
    Scene() : device(rtcNewDevice(nullptr)) {
        if (!device) throw Error("rays: Embree gives no device");
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    }
    ~Scene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    template <class T>
    std::span<T> buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, size_t count) {
        void* data = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count);
        if (!data) throw Error("rays: no memory for what casts shadows");
        return {static_cast<T*>(data), count};
    }

    void attach(RTCGeometry geometry, const DrawItem& item, int first_face) {
        elements.push_back(std::make_unique<Element>(Element{&item, first_face}));
        rtcSetGeometryUserData(geometry, elements.back().get());
        if (item.alpha != AlphaMode::opaque || item.casts_tint()) {
            rtcSetGeometryIntersectFilterFunction(geometry, filter);
            rtcSetGeometryOccludedFilterFunction(geometry, filter);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, unsigned(elements.size() - 1));
        rtcReleaseGeometry(geometry);
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

    void add_faces(const DrawItem& item, const Eigen::Affine3d& T) {
        const MeshData& mesh = item.mesh();
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto& V = vertices_of(item, T);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, V.data(), 0,
                                   sizeof(Vec3), size_t(mesh.V.rows()));
        const auto F = buffer<std::array<uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                                       size_t(item.part.face_count));
        for (size_t i = 0; i < F.size(); ++i)
            for (int c = 0; c < 3; ++c)
                F[i][size_t(c)] = uint32_t(mesh.F(item.part.first_face + Eigen::Index(i), c));
        attach(geometry, item, item.part.first_face);
    }

    void add_points(const DrawItem& item, const Eigen::Affine3d& T, float radius) {
        const MeshData& mesh = item.mesh();
        const bool oriented = !mesh.N.empty();
        RTCGeometry geometry = rtcNewGeometry(
            device, oriented ? RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT : RTC_GEOMETRY_TYPE_DISC_POINT);
        const auto V = buffer<std::array<float, 4>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                                    size_t(mesh.V.rows()));
        for (size_t i = 0; i < V.size(); ++i) {
            const Vec3 p = (T * Vec3d(mesh.V.row(Eigen::Index(i)).transpose().cast<double>())).cast<float>();
            V[i] = {p.x(), p.y(), p.z(), radius};
        }
        if (oriented) {
            const auto N = buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3,
                                                        size_t(mesh.V.rows()));
            const Mat3 normal_matrix = T.linear().inverse().transpose().cast<float>();
            for (size_t i = 0; i < N.size(); ++i) {
                const Vec3 n = (normal_matrix * mesh.N.row(Eigen::Index(i)).transpose()).normalized();
                N[i] = {n.x(), n.y(), n.z()};
            }
        }
        attach(geometry, item, 0);
    }

    void add_surfels(const DrawItem& item, const Eigen::Affine3d& T, float own_radius) {
        const MeshData& mesh = item.mesh();
        const auto count = size_t(mesh.V.rows());
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto V = buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                                    count * surfel_corners);
        const auto F = buffer<std::array<uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                                       count * (surfel_corners - 2));
        const double turn = 2 * std::numbers::pi / surfel_corners;
        const double same_area = std::sqrt(turn / std::sin(turn)) * item.style.surfel_scale;
        parallel_for(count, 1 << 10, [&](size_t i) {
            const auto row = Eigen::Index(i);
            const Vec3d centre = mesh.V.row(row).transpose().cast<double>(),
                        n = mesh.N.row(row).transpose().cast<double>().normalized();
            Vec3d t = mesh.T.empty() ? Vec3d(n.unitOrthogonal() * own_radius)
                                     : Vec3d(mesh.T.row(row).transpose().cast<double>());
            const double length = mesh.B.empty() ? t.norm() : double(mesh.B(row));
            const Vec3d b = n.cross(t).normalized() * length;
            for (int c = 0; c < surfel_corners; ++c) {
                const Vec3 p =
                    (T * Vec3d(centre + same_area * (std::cos(turn * c) * t + std::sin(turn * c) * b)))
                        .cast<float>();
                V[i * surfel_corners + size_t(c)] = {p.x(), p.y(), p.z()};
            }
            for (uint32_t c = 0; c + 2 < surfel_corners; ++c) {
                const auto first = uint32_t(i * surfel_corners);
                F[i * (surfel_corners - 2) + c] = {first, first + c + 1, first + c + 2};
            }
        });
        attach(geometry, item, -1);
    }

    RTCDevice device;
    RTCScene scene = nullptr;
    std::vector<std::unique_ptr<Element>> elements;
    std::map<const SceneSnapshot::Object*, std::vector<Vec3>> vertices;
};

RayScene::RayScene() = default;
RayScene::~RayScene() = default;

void RayScene::update(const DrawList& casters, const Box3d& bounds, uint64_t generation, SplatShadows& splats,
                      const std::optional<RayGround>& ground) {
    ground_ = ground;
    std::vector<const DrawItem*> items;
    for (const auto* list : {&casters.meshes, &casters.points, &casters.surfels})
        for (const DrawItem& item : *list) items.push_back(&item);
    if (scene_ && generation == generation_) {
        // The list may be another one of the same casters.
        for (size_t i = 0; i < items.size(); ++i) scene_->elements[i]->item = items[i];
        return;
    }
    generation_ = generation;
    scene_.reset();
    splat_reach_ = 0;
    if (items.empty() || bounds.isEmpty() || !(bounds.diagonal().norm() > 0)) return;
    centre_ = bounds.center();
    unit_ = bounds.diagonal().norm() / 2;
    scene_ = std::make_unique<Scene>();
    const auto placed = [&](const DrawItem& item) {
        return Eigen::Affine3d(Eigen::Scaling(1 / unit_) * Eigen::Translation3d(-centre_) *
                               item.object->T_world_mesh);
    };
    for (const DrawItem& item : casters.meshes) scene_->add_faces(item, placed(item));
    const auto note_reach = [&](const DrawItem& item, bool surfels) {
        const auto reach = float(splats.reach(item, surfels) / unit_);
        if (item.kind == SurfaceKind::lit) splat_reach_ = std::max(splat_reach_, reach);
        return reach;
    };
    for (const DrawItem& item : casters.points)
        scene_->add_points(item, placed(item), note_reach(item, false));
    for (const DrawItem& item : casters.surfels) {
        note_reach(item, true);
        scene_->add_surfels(item, placed(item), float(splats.surfel_radius(item)));
    }
    rtcCommitScene(scene_->scene);
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

std::optional<RayHit> RayScene::trace(const Vec3& from, const Vec3& direction) const {
    const float to_ground = ground_distance(from, direction);
    RTCRayHit found{};
    found.ray = ray_of(from, direction, to_ground);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_->scene, &context, &found);
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
    hit.element = element.first_face < 0 ? int(found.hit.primID) / (surfel_corners - 2)
                                         : element.first_face + int(found.hit.primID);
    hit.u = found.hit.u;
    hit.v = found.hit.v;
    const Vec3 n(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z);
    hit.normal = n.normalized() * (n.dot(direction) > 0 ? -1.0f : 1.0f);
    return hit;
}

bool RayScene::blocked(const Vec3& from, const Vec3& direction, float distance) const {
    RTCRay ray = ray_of(from, direction, distance);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_->scene, &context, &ray);
    return ray.tfar < 0;
}

}  // namespace easypbr::render
