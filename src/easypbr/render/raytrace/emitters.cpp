#include "easypbr/render/raytrace/emitters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "easypbr/render/raytrace/cdf.h"
#include "easypbr/render/raytrace/hit_surfaces.h"

namespace easypbr::render {
namespace {

/// Barycentric coordinates where a triangle's emission is looked at.
constexpr std::array<std::array<float, 2>, 4> looked_at{
    {{1.0f / 3, 1.0f / 3}, {0.6f, 0.2f}, {0.2f, 0.6f}, {0.2f, 0.2f}}};

}  // namespace

void Emitters::prepare(const RayScene& scene) {
    if (generation_ == scene.surfaces_generation()) return;
    generation_ = 0;  // until all is there: it can be interrupted
    triangles_.clear();
    ends_.clear();
    chances_.clear();
    brightness_ = 0;
    elements_.assign(size_t(scene.surface_count()), {});
    for (int surface = 0; surface < scene.surface_count(); ++surface) add_surface(scene, surface);
    double sum = 0;
    for (const Triangle& triangle : triangles_) {
        sum += double(triangle.weight) * triangle.edge1.cross(triangle.edge2).norm() / 2;
        ends_.push_back(float(sum));
    }
    // Half of the area, on average over the directions that it is seen from.
    brightness_ = float(sum / 2);
    for (float& end : ends_) end /= float(sum);
    for (Triangle& triangle : triangles_) triangle.weight /= float(sum);
    for (float& chance : chances_) chance /= float(sum);
    generation_ = scene.surfaces_generation();
}

void Emitters::add_surface(const RayScene& scene, int surface) {
    const FaceRange faces = scene.emissive_faces(surface);
    if (faces.count == 0) return;
    elements_[size_t(surface)] = {faces.first, faces.count, chances_.size()};
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
        const bool shines = emission > 0 && std::isfinite(emission) && edge1.cross(edge2).norm() > 0;
        chances_.push_back(shines ? emission : 0);
        if (shines) triangles_.push_back({corners[0], edge1, edge2, surface, faces.first + i, emission});
    }
}

Emitters::Sample Emitters::sample(const Vec3& from, const Vec2& u) const {
    float within = 0;
    const Triangle& triangle = triangles_[step_of(ends_, u.x(), within)];
    const float root = std::sqrt(within);
    Sample sample;
    sample.hit.element = uint32_t(triangle.element);
    sample.hit.u = root * (1 - u.y());
    sample.hit.v = root * u.y();
    sample.surface = triangle.surface;
    const Vec3 step = triangle.corner + sample.hit.u * triangle.edge1 + sample.hit.v * triangle.edge2 - from;
    sample.distance = step.norm();
    sample.direction = step / std::max(sample.distance, 1e-30f);
    Vec3 normal = triangle.edge1.cross(triangle.edge2).normalized();
    const float cosine = -normal.dot(sample.direction);
    if (cosine < 0) normal = -normal;
    std::copy_n(normal.data(), 3, sample.hit.normal);
    if (std::abs(cosine) > 1e-6f)
        sample.density = triangle.weight * sample.distance * sample.distance / std::abs(cosine);
    return sample;
}

float Emitters::density(const RayHit& hit, const Vec3& direction) const {
    if (empty() || hit.surface < 0) return 0;
    const Elements& elements = elements_[size_t(hit.surface)];
    const int element = hit.element - elements.first;
    if (element < 0 || element >= elements.count) return 0;
    const float chance = chances_[elements.at + size_t(element)];
    const float cosine = std::abs(hit.normal.dot(direction));
    return cosine > 1e-6f ? chance * hit.distance * hit.distance / cosine : 0;
}

}  // namespace easypbr::render
