#include "easypbr/geometry/orientation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "easypbr/core/parallel.h"

namespace easypbr::geometry {
namespace {

constexpr size_t orientation_grain = 4096;

/// A relation of two neighbours: how uncertain it is, in `levels` steps, and whether one is to be turned.
struct Relation {
    uint16_t uncertainty;
    bool opposite;
};
constexpr size_t levels = size_t(1) << 14;

Relation relation(const Vec3& a, const Vec3& b, const Vec3& step) {
    const float length = step.squaredNorm();
    const Vec3 mirrored = length > 0 ? Vec3(a - step * (2 * step.dot(a) / length)) : a;
    const float agreement = std::clamp(mirrored.dot(b), -1.0f, 1.0f);
    return {uint16_t((1 - std::abs(agreement)) * float(levels - 1)), agreement < 0};
}

/// Sets of points (union by size, path halving) that also know whether a point is opposite to its set's root.
class OrientedSets {
  public:
    explicit OrientedSets(size_t count) : parent_(count), size_(count, 1), opposite_(count, 0) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    struct Place {
        int32_t root;
        bool opposite;
    };

    Place find(int32_t i) {
        bool opposite = false;
        while (parent_[size_t(i)] != i) {
            const auto at = size_t(i), above = size_t(parent_[at]);
            // The point now hangs below its grandparent; the root is not opposite to itself.
            opposite_[at] ^= opposite_[above];
            parent_[at] = parent_[above];
            opposite ^= opposite_[at] != 0;
            i = parent_[at];
        }
        return {i, opposite};
    }

    void unite(int32_t a, int32_t b, bool opposite) {
        Place at_a = find(a), at_b = find(b);
        if (at_a.root == at_b.root) return;
        if (size_[size_t(at_a.root)] < size_[size_t(at_b.root)]) std::swap(at_a, at_b);
        parent_[size_t(at_b.root)] = at_a.root;
        opposite_[size_t(at_b.root)] = char(at_a.opposite ^ at_b.opposite ^ opposite);
        size_[size_t(at_a.root)] += size_[size_t(at_b.root)];
    }

  private:
    std::vector<int32_t> parent_, size_;
    std::vector<char> opposite_;
};

/// Places (point * k + j) of the relations of all points with their neighbours, the most certain first,
/// equally certain ones in order: a counting sort.
class SortedRelations {
  public:
    SortedRelations(const std::vector<Vec3>& normals, const Neighborhoods& neighborhoods)
        : relations_(neighborhoods.neighbors.size()), places_(relations_.size()) {
        parallel_for(neighborhoods.count(), orientation_grain, [&](size_t i) {
            const Vec3 origin = neighborhoods.points.row(Eigen::Index(i)).transpose();
            const auto of = neighborhoods.of(i);
            for (size_t j = 0; j < of.size(); ++j)
                relations_[i * of.size() + j] = relation(
                    normals[i], normals[size_t(of[j])], neighborhoods.points.row(of[j]).transpose() - origin);
        });
        std::vector<size_t> next(levels + 1, 0);
        for (const Relation& relation : relations_) ++next[relation.uncertainty + 1u];
        std::partial_sum(next.begin(), next.end(), next.begin());
        for (size_t place = 0; place < relations_.size(); ++place)
            places_[next[relations_[place].uncertainty]++] = uint32_t(place);
    }

    template <class Visit>
    void visit(Visit&& visit) const {
        for (const uint32_t place : places_) visit(place, relations_[place].opposite);
    }

  private:
    std::vector<Relation> relations_;
    std::vector<uint32_t> places_;
};

/// What decides which side of a piece is outside; points count by the area that they stand for.
struct Piece {
    double area = 0;
    Vec3d center = Vec3d::Zero();
    Vec3d normal = Vec3d::Zero();
    double volume = 0;

    bool is_inside_out() const {
        // The normals of a closed surface add up to nothing, those of a flat one to its area; those of a half
        // sphere, whose outside is known as well, to half of it.
        if (normal.norm() < 0.7 * area) return volume < 0;
        Eigen::Index axis = 0;
        normal.cwiseAbs().maxCoeff(&axis);
        return normal[axis] < 0;
    }
};

void turn_pieces_outwards(std::vector<Vec3>& normals, const Neighborhoods& neighborhoods,
                          const std::vector<int32_t>& root) {
    std::vector<Piece> pieces(normals.size());
    const auto area_of = [&](size_t i) { return double(neighborhoods.reach[i]) * neighborhoods.reach[i]; };
    for (size_t i = 0; i < normals.size(); ++i) {
        Piece& piece = pieces[size_t(root[i])];
        piece.area += area_of(i);
        piece.center += area_of(i) * neighborhoods.point(i);
        piece.normal += area_of(i) * normals[i].cast<double>();
    }
    for (size_t i = 0; i < normals.size(); ++i) {
        Piece& piece = pieces[size_t(root[i])];
        piece.volume +=
            area_of(i) * normals[i].cast<double>().dot(neighborhoods.point(i) - piece.center / piece.area);
    }
    for (size_t i = 0; i < normals.size(); ++i)
        if (pieces[size_t(root[i])].is_inside_out()) normals[i] = -normals[i];
}

}  // namespace

void orient_consistently(std::vector<Vec3>& normals, const Neighborhoods& neighborhoods) {
    OrientedSets sets(normals.size());
    const auto k = size_t(neighborhoods.k);
    SortedRelations(normals, neighborhoods).visit([&](uint32_t place, bool opposite) {
        sets.unite(int32_t(place / k), neighborhoods.neighbors[place], opposite);
    });
    std::vector<int32_t> root(normals.size());
    for (size_t i = 0; i < normals.size(); ++i) {
        const OrientedSets::Place place = sets.find(int32_t(i));
        root[i] = place.root;
        if (place.opposite) normals[i] = -normals[i];
    }
    turn_pieces_outwards(normals, neighborhoods, root);
}

void orient_towards(std::vector<Vec3>& normals, const Neighborhoods& neighborhoods, const Vec3d& viewpoint) {
    parallel_for(normals.size(), orientation_grain, [&](size_t i) {
        if (normals[i].cast<double>().dot(viewpoint - neighborhoods.point(i)) < 0) normals[i] = -normals[i];
    });
}

}  // namespace easypbr::geometry
