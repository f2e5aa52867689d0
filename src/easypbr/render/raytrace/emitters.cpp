#include "easypbr/render/raytrace/emitters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "easypbr/gpu/facing.h"
#include "easypbr/render/raytrace/cdf.h"
#include "easypbr/render/raytrace/hit_surfaces.h"

namespace easypbr::render {
namespace {

/// Barycentric coordinates where a triangle's emission is looked at.
constexpr std::array<std::array<float, 2>, 4> looked_at{
    {{1.0f / 3, 1.0f / 3}, {0.6f, 0.2f}, {0.2f, 0.6f}, {0.2f, 0.2f}}};

/// Meshes with more faces are taken for open ones: looking takes time.
constexpr Eigen::Index most_faces = 1 << 14;

Eigen::AlignedBox3f solid_of(const RayScene& scene, int surface) {
    Eigen::AlignedBox3f box;
    const MeshData& mesh = scene.item_of(surface).mesh();
    const Eigen::Affine3d& T = scene.item_of(surface).object->T_world_mesh;
    const bool is_solid =
        mesh.F.rows() <= most_faces && T.linear().determinant() > 0 && gpu::is_closed_outward(mesh.V, mesh.F);
    if (!is_solid) return box;
    for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
        const Vec3d world = T * Vec3d(mesh.V.row(i).transpose().cast<double>());
        box.extend(Vec3(((world - scene.centre()) / scene.unit()).cast<float>()));
    }
    return box;
}

}  // namespace

void Emitters::prepare(const RayScene& scene) {
    if (generation_ == scene.surfaces_generation()) return;
    generation_ = 0;  // until all is there: it can be interrupted
    triangles_.clear();
    ends_.clear();
    chances_.clear();
    places_.clear();
    brightness_ = 0;
    elements_.assign(size_t(scene.surface_count()), {});
    for (int surface = 0; surface < scene.surface_count(); ++surface) add_surface(scene, surface);
    double sum = 0;
    for (const Triangle& triangle : triangles_) {
        sum += double(triangle.weight) * triangle.area;
        ends_.push_back(float(sum));
    }
    // Half of the area, on average over the directions that it is seen from.
    brightness_ = float(sum / 2);
    for (float& end : ends_) end /= float(sum);
    for (Triangle& triangle : triangles_) triangle.weight /= float(sum);
    for (float& chance : chances_) chance /= float(sum);
    make_lanes();
    generation_ = scene.surfaces_generation();
}

void Emitters::add_surface(const RayScene& scene, int surface) {
    const FaceRange faces = scene.emissive_faces(surface);
    if (faces.count == 0) return;
    elements_[size_t(surface)] = {faces.first, faces.count, chances_.size(), solid_of(scene, surface)};
    std::vector<native::ElementHit> hits;
    for (int i = 0; i < faces.count; ++i) {
        const auto corners = scene.triangle(surface, faces.first + i);
        const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        const float size = normal.norm();
        for (const auto& [u, v] : looked_at) {
            native::ElementHit& hit = hits.emplace_back();
            hit.element = uint32_t(faces.first + i);
            hit.u = u;
            hit.v = v;
            Eigen::Map<Vec3>(hit.normal) = size > 0 ? Vec3(normal / size) : Vec3(Vec3::UnitZ());
            // About a quarter of the triangle each.
            hit.footprint = std::sqrt(size / 8) * float(scene.unit());
        }
    }
    const HitSurfaces found = evaluate(scene, hits, std::vector<int>(hits.size(), surface));
    for (int i = 0; i < faces.count; ++i) {
        float emission = 0;
        for (size_t k = 0; k < looked_at.size(); ++k)
            emission += found.emission.at(size_t(i) * looked_at.size() + k).mean() / float(looked_at.size());
        const auto corners = scene.triangle(surface, faces.first + i);
        const Vec3 edge1 = corners[1] - corners[0], edge2 = corners[2] - corners[0];
        const Vec3 normal = edge1.cross(edge2);
        const float size = normal.norm();
        const bool shines = emission > 0 && std::isfinite(emission) && size > 0;
        chances_.push_back(shines ? emission : 0);
        places_.push_back(triangles_.size());
        if (!shines) continue;
        const Vec3 centre = (corners[0] + corners[1] + corners[2]) / 3;
        triangles_.push_back(
            {corners[0], edge1, edge2, centre, normal / size, size / 2, surface, faces.first + i, emission});
    }
}

namespace {

constexpr float no_limit = std::numeric_limits<float>::infinity();

/// Of each lane.
template <class Floats>
Floats square_root(Floats values) {
#if defined(__SSE__)
    return Floats(_mm_sqrt_ps(__m128(values)));
#else
    for (size_t k = 0; k < sizeof values / sizeof(float); ++k) values[k] = std::sqrt(values[k]);
    return values;
#endif
}

}  // namespace

bool Emitters::are_few() const {
    return triangles_.size() <= few;
}

void Emitters::make_lanes() {
    lanes_.clear();
    if (!are_few()) return;
    lanes_.resize((triangles_.size() + lane_count - 1) / lane_count);
    for (size_t i = 0; i < triangles_.size(); ++i) {
        const Triangle& triangle = triangles_[i];
        Eigen::AlignedBox3f solid = elements_[size_t(triangle.surface)].solid;
        // Every place is within what has no inside.
        if (solid.isEmpty()) solid = {Vec3::Constant(-no_limit), Vec3::Constant(no_limit)};
        Lanes& lanes = lanes_[i / lane_count];
        const size_t k = i % lane_count;
        for (int c = 0; c < 3; ++c) {
            lanes.centre[c][k] = triangle.centre[c];
            lanes.normal[c][k] = triangle.normal[c];
            lanes.least[c][k] = solid.min()[c];
            lanes.most[c][k] = solid.max()[c];
        }
        lanes.area[k] = triangle.area;
        lanes.light[k] = triangle.weight * triangle.area;
    }
}

float Emitters::weigh(const Vec3& from, Weights& ends) const {
    // The least is for what is seen of a triangle beside its centre.
    constexpr float least_cosine = 0.05f;
    float sum = 0;
    size_t place = 0;
    for (const Lanes& lanes : lanes_) {
        Floats apart = {}, facing = {};
        Masks inside = ~Masks{};
        for (int c = 0; c < 3; ++c) {
            const Floats offset = lanes.centre[c] - from[c], own = Floats{} + from[c];
            apart += offset * offset;
            facing -= lanes.normal[c] * offset;
            inside &= (own >= lanes.least[c]) & (own <= lanes.most[c]);
        }
        const Masks hidden = (facing < 0.0f) & ~inside;
        const Floats size = facing < 0.0f ? -facing : facing,
                     far = apart > 1e-30f ? apart : Floats{} + 1e-30f;
        const Floats cosine = size / square_root(far);
        const Floats shares =
            lanes.light * (least_cosine + cosine) / (apart > lanes.area ? apart : lanes.area);
        for (size_t k = 0; k < lane_count; ++k) ends[place++] = sum += hidden[k] ? 0.0f : shares[k];
    }
    return sum;
}

Emitters::Sample Emitters::sample(const Vec3& from, const Vec2& u) const {
    float within = 0;
    if (!are_few()) {
        const Triangle& triangle = triangles_[step_of(ends_, u.x(), within)];
        return sample_on(triangle, from, {within, u.y()}, triangle.weight);
    }
    Weights ends;
    const float sum = weigh(from, ends);
    if (!(sum > 0)) return {.hit = {}, .surface = triangles_.front().surface, .direction = Vec3::UnitZ()};
    const size_t chosen = step_of(std::span(ends).first(triangles_.size()), u.x() * sum, within);
    const float weight = ends[chosen] - (chosen > 0 ? ends[chosen - 1] : 0);
    const Triangle& triangle = triangles_[chosen];
    return sample_on(triangle, from, {within, u.y()}, weight / (sum * triangle.area));
}

Emitters::Sample Emitters::sample_on(const Triangle& triangle, const Vec3& from, const Vec2& u,
                                     float density) const {
    const float root = std::sqrt(u.x());
    Sample sample;
    sample.hit.element = uint32_t(triangle.element);
    sample.hit.u = root * (1 - u.y());
    sample.hit.v = root * u.y();
    sample.surface = triangle.surface;
    const Vec3 step = triangle.corner + sample.hit.u * triangle.edge1 + sample.hit.v * triangle.edge2 - from;
    sample.distance = step.norm();
    sample.direction = step / std::max(sample.distance, 1e-30f);
    Vec3 normal = triangle.normal;
    const float cosine = -normal.dot(sample.direction);
    if (cosine < 0) normal = -normal;
    std::copy_n(normal.data(), 3, sample.hit.normal);
    if (std::abs(cosine) > 1e-6f)
        sample.density = density * sample.distance * sample.distance / std::abs(cosine);
    return sample;
}

float Emitters::density(const RayHit& hit, const Vec3& direction) const {
    if (empty() || hit.surface < 0) return 0;
    const Elements& elements = elements_[size_t(hit.surface)];
    const int element = hit.element - elements.first;
    if (element < 0 || element >= elements.count) return 0;
    float chance = chances_[elements.at + size_t(element)];
    if (chance > 0 && are_few()) {
        const Vec3 from = hit.position - direction * hit.distance;
        Weights ends;
        const float sum = weigh(from, ends);
        const size_t place = places_[elements.at + size_t(element)];
        const float own = ends[place] - (place > 0 ? ends[place - 1] : 0);
        chance = sum > 0 ? own / (sum * triangles_[place].area) : 0;
    }
    const float cosine = std::abs(hit.normal.dot(direction));
    return cosine > 1e-6f ? chance * hit.distance * hit.distance / cosine : 0;
}

}  // namespace easypbr::render
