#include "easypbr/drawing/feature_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/weld.h"

namespace easypbr::drawing {
namespace {

class EdgeFinder {
  public:
    EdgeFinder(const MeshData& mesh, const Eigen::Affine3d& T, const Eye& eye, const FeatureKinds& kinds)
        : mesh_(mesh),
          T_(T),
          eye_(eye),
          kinds_(kinds),
          least_cosine_(std::cos(kinds.crease_angle_deg * std::numbers::pi / 180)),
          weld_(geometry::weld_positions(mesh.V)) {}

    std::vector<FeatureEdge> find() {
        const std::vector<KeyedIndex> sides = sorted_sides();
        std::vector<FeatureEdge> edges;
        for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
            while (end < sides.size() && sides[end].key == sides[begin].key) ++end;
            const std::span group(sides.data() + begin, end - begin);
            if (is_feature(group)) edges.push_back(edge_of(group));
        }
        return edges;
    }

  private:
    /// A side is numbered 3 * face + its first corner.
    uint32_t place(uint32_t face, uint32_t corner) const {
        return uint32_t(weld_.place[size_t(mesh_.F(face, corner))]);
    }
    uint32_t first_place(uint32_t side) const { return place(side / 3, side % 3); }
    uint32_t second_place(uint32_t side) const { return place(side / 3, (side % 3 + 1) % 3); }

    /// The sides of all faces, those between the same positions together.
    std::vector<KeyedIndex> sorted_sides() const {
        std::vector<KeyedIndex> sides(size_t(mesh_.F.rows()) * 3);
        parallel_for(sides.size(), 1 << 14, [&](size_t i) {
            const auto side = uint32_t(i);
            const uint32_t a = first_place(side), b = second_place(side);
            sides[i] = {uint64_t(std::min(a, b)) << 32 | std::max(a, b), side};
        });
        std::erase_if(sides,
                      [](const KeyedIndex& side) { return side.key >> 32 == (side.key & 0xffffffff); });
        parallel_sort(sides);
        return sides;
    }

    Vec3d position(uint32_t place) const {
        return T_ * Vec3d(mesh_.V.row(weld_.first[place]).transpose().cast<double>());
    }

    /// Zero for a face without area.
    Vec3d normal(uint32_t side) const {
        const auto corner = [&](uint32_t c) { return position(place(side / 3, c)); };
        return (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    }

    bool is_feature(std::span<const KeyedIndex> group) const {
        if (group.size() != 2) return kinds_.contours;
        const uint32_t a = group[0].index, b = group[1].index;
        const Vec3d n = normal(a);
        // Faces wound alike pass their edge in opposite directions.
        const Vec3d m = first_place(a) == first_place(b) ? Vec3d(-normal(b)) : normal(b);
        if (n.isZero() || m.isZero()) return false;
        if (kinds_.creases && n.dot(m) < least_cosine_) return true;
        const Vec3d towards = eye_.towards(position(first_place(a)));
        return kinds_.contours && (n.dot(towards) > 0) != (m.dot(towards) > 0);
    }

    FeatureEdge edge_of(std::span<const KeyedIndex> group) const {
        const uint32_t side = group[0].index;
        FeatureEdge edge;
        edge.places = {int32_t(first_place(side)), int32_t(second_place(side))};
        edge.ends = {position(first_place(side)), position(second_place(side))};
        edge.faces[0] = side / 3;
        if (group.size() == 2) edge.faces[1] = group[1].index / 3;
        return edge;
    }

    const MeshData& mesh_;
    const Eigen::Affine3d& T_;
    const Eye& eye_;
    const FeatureKinds& kinds_;
    double least_cosine_;
    geometry::Weld weld_;
};

}  // namespace

std::vector<FeatureEdge> feature_edges(const MeshData& mesh, const Eigen::Affine3d& T_world_mesh,
                                       const Eye& eye, const FeatureKinds& kinds) {
    return EdgeFinder(mesh, T_world_mesh, eye, kinds).find();
}

std::vector<FeatureEdge> line_segments(const MeshData& mesh, const Eigen::Affine3d& T_world_mesh) {
    std::vector<FeatureEdge> edges(size_t(mesh.E.rows()));
    for (size_t i = 0; i < edges.size(); ++i)
        for (int end = 0; end < 2; ++end) {
            const int vertex = mesh.E(Eigen::Index(i), end);
            edges[i].places[size_t(end)] = vertex;
            edges[i].ends[size_t(end)] = T_world_mesh * Vec3d(mesh.V.row(vertex).transpose().cast<double>());
        }
    return edges;
}

}  // namespace easypbr::drawing
