#include "easypbr/render/raytrace/emitters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

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
    make_few();
    generation_ = scene.surfaces_generation();
}

void Emitters::add_surface(const RayScene& scene, int surface) {
    const FaceRange faces = scene.emissive_faces(surface);
    if (faces.count == 0) return;
    elements_[size_t(surface)] = {faces.first, faces.count, places_.size(), solid_of(scene, surface)};
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
    const bool has_texture = bool(scene.item_of(surface).material.emissive_texture);
    for (int i = 0; i < faces.count; ++i) {
        Vec3 emission = Vec3::Zero();
        for (size_t k = 0; k < looked_at.size(); ++k)
            emission += found.emission.at(size_t(i) * looked_at.size() + k) / float(looked_at.size());
        const auto corners = scene.triangle(surface, faces.first + i);
        const Vec3 edge1 = corners[1] - corners[0], edge2 = corners[2] - corners[0];
        const Vec3 normal = edge1.cross(edge2);
        const float size = normal.norm(), weight = emission.mean();
        const bool shines = weight > 0 && std::isfinite(weight) && size > 0;
        places_.push_back(shines ? int(triangles_.size()) : -1);
        if (!shines) continue;
        const Vec3 centre = (corners[0] + corners[1] + corners[2]) / 3;
        triangles_.push_back({corners[0], edge1, edge2, centre, normal / size, size / 2, surface,
                              faces.first + i, weight, emission, !has_texture});
    }
}

void Emitters::make_few() {
    constexpr float no_limit = std::numeric_limits<float>::infinity();
    few_ = {};
    if (!are_few()) return;
    few_.count = int(triangles_.size());
    for (size_t i = 0; i < triangles_.size(); ++i) {
        const Triangle& triangle = triangles_[i];
        Eigen::AlignedBox3f solid = elements_[size_t(triangle.surface)].solid;
        // Every place is within what has no inside.
        if (solid.isEmpty()) solid = {Vec3::Constant(-no_limit), Vec3::Constant(no_limit)};
        for (int c = 0; c < 3; ++c) {
            few_.centre[c][i] = triangle.centre[c];
            few_.normal[c][i] = triangle.normal[c];
            few_.least[c][i] = solid.min()[c];
            few_.most[c][i] = solid.max()[c];
            few_.corner[c][i] = triangle.corner[c];
            few_.edge1[c][i] = triangle.edge1[c];
            few_.edge2[c][i] = triangle.edge2[c];
        }
        few_.area[i] = triangle.area;
        few_.light[i] = triangle.weight * triangle.area;
    }
}

Emitters::Samples::Samples(size_t count_)
    : count(count_),
      direction(PathBatch::rounded_up(count)),
      radiance(direction.room()),
      distance(direction.room()),
      density(direction.room()),
      triangle(direction.room()),
      u(direction.room()),
      v(direction.room()),
      cosine(direction.room()) {}

Emitters::Samples Emitters::sample(const RayScene& scene, const PathVectors<3>& from,
                                   const PathVectors<2>& points, size_t count) const {
    Samples samples(count);
    if (are_few()) {
        native::EmitterPlaces places{{}, points.component(0), points.component(1)};
        from.read_by(places.from);
        native::EmitterPoints to{samples.triangle.data(), samples.u.data(),      samples.v.data(),      {},
                                 samples.distance.data(), samples.cosine.data(), samples.density.data()};
        samples.direction.written_by(to.direction);
        native::sample_emitters(few_, places, int(count), to);
    } else {
        sample_many(from, points, samples);
    }
    find_radiance(scene, samples);
    return samples;
}

void Emitters::sample_many(const PathVectors<3>& from, const PathVectors<2>& points, Samples& samples) const {
    for (size_t i = 0; i < samples.count; ++i) {
        const Vec2 u = points.at(i);
        float within = 0;
        const size_t chosen = step_of(ends_, u.x(), within);
        const Triangle& triangle = triangles_[chosen];
        const float root = std::sqrt(within);
        samples.triangle[i] = int32_t(chosen);
        samples.u[i] = root * (1 - u.y());
        samples.v[i] = root * u.y();
        const Vec3 step =
            triangle.corner + samples.u[i] * triangle.edge1 + samples.v[i] * triangle.edge2 - from.at(i);
        const float distance = step.norm();
        const Vec3 direction = step / std::max(distance, 1e-30f);
        samples.distance[i] = distance;
        samples.direction.set(i, direction);
        samples.cosine[i] = -triangle.normal.dot(direction);
        const float cosine = std::abs(samples.cosine[i]);
        samples.density[i] = cosine > 1e-6f ? triangle.weight * distance * distance / cosine : 0;
    }
}

void Emitters::find_radiance(const RayScene& scene, Samples& samples) const {
    std::vector<uint32_t> varied;
    for (size_t i = 0; i < samples.count; ++i) {
        const Triangle& triangle = triangles_[size_t(samples.triangle[i])];
        samples.radiance.set(i, triangle.emission);
        if (!triangle.is_uniform) varied.push_back(uint32_t(i));
    }
    if (varied.empty()) return;
    const auto surface_of = [&](uint32_t i) { return triangles_[size_t(samples.triangle[i])].surface; };
    std::ranges::stable_sort(varied, {}, surface_of);
    std::vector<native::ElementHit> hits;
    std::vector<int> surfaces;
    for (const uint32_t i : varied) {
        const Triangle& triangle = triangles_[size_t(samples.triangle[i])];
        native::ElementHit& hit = hits.emplace_back();
        hit.element = uint32_t(triangle.element);
        hit.u = samples.u[i];
        hit.v = samples.v[i];
        Eigen::Map<Vec3>(hit.normal) = triangle.normal * (samples.cosine[i] < 0 ? -1.0f : 1.0f);
        hit.footprint = samples.distance[i] * float(scene.unit()) * ray_widening;
        surfaces.push_back(triangle.surface);
    }
    const HitSurfaces found = evaluate(scene, hits, surfaces);
    for (size_t k = 0; k < varied.size(); ++k) samples.radiance.set(varied[k], found.emission.at(k));
}

int Emitters::triangle_of(const RayHit& hit) const {
    if (hit.surface < 0) return -1;
    const Elements& elements = elements_[size_t(hit.surface)];
    const int element = hit.element - elements.first;
    return element >= 0 && element < elements.count ? places_[elements.at + size_t(element)] : -1;
}

std::vector<float> Emitters::densities(std::span<const Met> met) const {
    std::vector<float> found(met.size(), 0.0f);
    if (empty()) return found;
    std::vector<uint32_t> of_triangles;
    for (size_t i = 0; i < met.size(); ++i)
        if (triangle_of(met[i].hit) >= 0) of_triangles.push_back(uint32_t(i));
    if (of_triangles.empty()) return found;
    const size_t room = PathBatch::rounded_up(of_triangles.size());
    PathVectors<3> from(room);
    std::vector<int32_t> chosen(room);
    std::vector<float> chances(room);
    for (size_t k = 0; k < of_triangles.size(); ++k) {
        const auto& [hit, direction] = met[of_triangles[k]];
        chosen[k] = triangle_of(hit);
        chances[k] = triangles_[size_t(chosen[k])].weight;
        from.set(k, hit.position - direction * hit.distance);
    }
    if (are_few()) {
        const float* places[3];
        from.read_by(places);
        native::chances_of_emitters(few_, places, chosen.data(), int(of_triangles.size()), chances.data());
    }
    for (size_t k = 0; k < of_triangles.size(); ++k) {
        const auto& [hit, direction] = met[of_triangles[k]];
        const float cosine = std::abs(hit.normal.dot(direction));
        if (cosine > 1e-6f) found[of_triangles[k]] = chances[k] * hit.distance * hit.distance / cosine;
    }
    return found;
}

}  // namespace easypbr::render
