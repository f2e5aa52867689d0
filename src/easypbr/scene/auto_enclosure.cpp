// Whether content closes around the camera. See "Closed content" in docs/design/automatic_parameters.md.
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/world_elements.h"

namespace easypbr::detail {
namespace {

constexpr int probe_count = 64;
/// Probes that are cast first: those of open content mostly say enough.
constexpr int first_probes = 16;
/// Probes of closed content that may leave it, as through a window.
constexpr int most_open_probes = probe_count / 16;
/// Cosine of the angle to the camera's axis within which probes say how far away what it sees is.
constexpr double least_view_cosine = 0.5;
constexpr size_t faces_per_task = 4096;

using Probes = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, probe_count, 3>;
using Ways = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, probe_count, 1>;

/// Unit directions over the sphere (a Fibonacci lattice), in an order of which every part is spread out.
Probes sphere_probes() {
    constexpr int stride = 37;  // has no factor in common with the count
    Probes probes(probe_count, 3);
    for (int i = 0; i < probe_count; ++i) {
        const int k = i * stride % probe_count;
        const double z = 1 - (2 * k + 1.0) / probe_count, angle = k * pi * (3 - std::sqrt(5.0));
        const double radius = std::sqrt(1 - z * z);
        probes.row(i) << radius * std::cos(angle), radius * std::sin(angle), z;
    }
    return probes;
}

/// Shortens the ways of probes from a place to a face. The sides of the face are seen from the place as
/// planes, which neighbours have in common: no probe passes between them.
void shorten_to(const WorldElements::Corners& corners, const Vec3d& place, const Probes& probes, Ways& ways) {
    const Vec3d a = corners[0] - place, b = corners[1] - place, c = corners[2] - place;
    Mat3d sides;
    sides << a.cross(b), b.cross(c), c.cross(a);
    const Probes within = probes * sides;
    const double height = a.dot(sides.col(1));  // times twice the area, as the sum of `within` is
    for (Eigen::Index i = 0; i < probes.rows(); ++i) {
        if (within.row(i).minCoeff() < 0 && within.row(i).maxCoeff() > 0) continue;
        const double way = height / within.row(i).sum();
        if (way > 0 && way < ways[i]) ways[i] = way;
    }
}

/// How far probes from a place go until an opaque face; infinite where they leave the content.
Ways probe(const Content& content, const Vec3d& place, const Probes& probes) {
    const Ways open = Ways::Constant(probes.rows(), std::numeric_limits<double>::infinity());
    Ways ways = open;
    std::mutex mutex;
    for (const SceneSnapshot::Object& object : content.scene().objects) {
        const WorldElements faces(object);
        const bool transparent = has_transparent_colors(object.mesh->C);
        const auto add = [&](const Material& material, size_t first, size_t last) {
            if (material.transmits() || material.alpha_mode_for(transparent) != AlphaMode::opaque) return;
            parallel_chunks(last - first, faces_per_task, [&](size_t begin, size_t end) {
                Ways own = open;
                for (size_t i = begin; i < end; ++i) {
                    const WorldElements::Corners corners = faces.corners(first + i);
                    if (are_finite(corners)) shorten_to(corners, place, probes, own);
                }
                const std::lock_guard lock(mutex);
                ways = ways.min(own).eval();
            });
        };
        for_each_material(*object.mesh, content.overrides(), add);
    }
    return ways;
}

bool are_closed(const Ways& ways) {
    return (ways == std::numeric_limits<double>::infinity()).count() <= most_open_probes;
}

/// The median of the ways of probes that go where the camera looks.
double viewed_distance(const Probes& probes, const Ways& ways, const Vec3d& forward) {
    std::vector<double> viewed;
    for (Eigen::Index i = 0; i < ways.size(); ++i)
        if (probes.row(i).dot(forward) > least_view_cosine && std::isfinite(ways[i]))
            viewed.push_back(ways[i]);
    const auto median = viewed.begin() + long(viewed.size() / 2);
    std::nth_element(viewed.begin(), median, viewed.end());
    return *median;
}

}  // namespace

std::optional<Enclosure> enclosure_of(const Content& content, const Camera& camera) {
    const Vec3d place = camera.position();
    if (content.bounds().isEmpty() || !content.bounds().contains(place)) return {};
    const Probes all = sphere_probes();
    if (!are_closed(probe(content, place, all.topRows(first_probes)))) return {};
    const Ways ways = probe(content, place, all);
    if (!are_closed(ways)) return {};
    const Vec3d forward = -camera.T_world_cam.linear().col(2);
    const double distance = viewed_distance(all, ways, forward);
    return Enclosure{distance, place + distance * forward, clear_way(content, place, distance)};
}

}  // namespace easypbr::detail
