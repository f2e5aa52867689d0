#include "easypbr/io/tables/face_polygons.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/tables/polygons.h"

namespace easypbr::io {
namespace {

constexpr size_t run_grain = 1 << 12;
/// With more corners it is not tried which of them a polygon was cut from.
constexpr size_t most_turns = 32;
/// Distance from a plane, in extents of the polygon: some hundred roundings of a float position.
constexpr double flatness = 1e-5;

using Triangle = std::array<int32_t, 3>;

/// Triangles in one order, each from its smallest corner on.
std::vector<Triangle> sorted_triangles(std::span<const int32_t> corners) {
    std::vector<Triangle> triangles(corners.size() / 3);
    for (size_t i = 0; i < triangles.size(); ++i) {
        Triangle& t = triangles[i];
        std::copy_n(corners.begin() + ptrdiff_t(3 * i), 3, t.begin());
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// Joins triangles; kept between polygons for its memory.
class TriangleJoiner {
  public:
    explicit TriangleJoiner(const MeshData& mesh) : mesh_(mesh) {}

    /// The polygon that the triangles are; empty: they are none.
    std::span<const int32_t> join(Eigen::Index begin, Eigen::Index end) {
        faces_ = {mesh_.F.data() + 3 * begin, size_t(3 * (end - begin))};
        if (end - begin < 2 || !have_one_value(begin, end) || !find_loop()) return {};
        const std::vector<Triangle> triangles = sorted_triangles(faces_);
        const size_t turns = loop_.size() <= most_turns ? loop_.size() : 1;
        for (size_t i = 0; i < turns; ++i) {
            cut_.resize(faces_.size());
            cut_polygon(mesh_.V, loop_.data(), loop_.size(), cut_.data());
            if (sorted_triangles(cut_) == triangles) return loop_;
            std::rotate(loop_.begin(), loop_.begin() + 1, loop_.end());
        }
        if (lie_in_a_plane()) return loop_;
        return {};
    }

  private:
    using Edge = std::pair<int32_t, int32_t>;

    template <class A>
    bool has_one_value(const A& values, Eigen::Index begin, Eigen::Index end) const {
        if (values.empty() || element_of(mesh_, values.rows()) == PerElement::vertex) return true;
        // NaN is a value, too.
        const auto bits = [&](Eigen::Index i) { return std::bit_cast<uint32_t>(values.data()[i]); };
        for (Eigen::Index i = begin + 1; i < end; ++i)
            if (bits(i) != bits(begin)) return false;
        return true;
    }

    bool have_one_value(Eigen::Index begin, Eigen::Index end) const {
        return has_one_value(mesh_.L, begin, end) &&
               std::ranges::all_of(mesh_.scalars, [&](const ScalarArray& scalar) {
                   return has_one_value(scalar.values, begin, end);
               });
    }

    /// Edges that no other triangle has in the other direction, in the order of their begin.
    void find_outer_edges() {
        edges_.clear();
        for (size_t i = 0; i < faces_.size(); ++i)
            edges_.emplace_back(faces_[i], faces_[i % 3 == 2 ? i - 2 : i + 1]);
        std::sort(edges_.begin(), edges_.end());
        outer_.clear();
        for (const Edge& edge : edges_)
            if (!std::binary_search(edges_.begin(), edges_.end(), Edge(edge.second, edge.first)))
                outer_.push_back(edge);
    }

    /// A loop through as many corners as n - 2 triangles without a corner inside have. It begins with the
    /// first corner of the first triangle.
    bool find_loop() {
        find_outer_edges();
        const size_t count = faces_.size() / 3 + 2;
        const auto same_begin = [](const Edge& a, const Edge& b) { return a.first == b.first; };
        if (outer_.size() != count || std::ranges::adjacent_find(edges_) != edges_.end() ||
            std::ranges::adjacent_find(outer_, same_begin) != outer_.end())
            return false;
        loop_.clear();
        int32_t corner = faces_[0];
        do {
            const auto edge = std::ranges::lower_bound(outer_, corner, {}, &Edge::first);
            if (edge == outer_.end() || edge->first != corner) return false;
            loop_.push_back(corner);
            corner = edge->second;
        } while (corner != faces_[0] && loop_.size() < count);
        return corner == faces_[0] && loop_.size() == count;
    }

    Vec3d at(int32_t vertex) const { return mesh_.V.row(vertex).transpose().cast<double>(); }

    /// Twice the area along the normal.
    Vec3d area(size_t triangle) const {
        const int32_t* const t = faces_.data() + 3 * triangle;
        return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
    }

    /// Whether the triangles lie in a plane and all face one side of it.
    bool lie_in_a_plane() const {
        Vec3d normal = Vec3d::Zero();
        for (size_t i = 0; i < faces_.size() / 3; ++i) normal += area(i);
        if (!(normal.norm() > 0)) return false;
        normal.normalize();
        const Vec3d origin = at(loop_[0]);
        double extent = 0;
        for (const int32_t corner : loop_) extent = std::max(extent, (at(corner) - origin).norm());
        for (const int32_t corner : loop_)
            if (std::abs((at(corner) - origin).dot(normal)) > flatness * extent) return false;
        for (size_t i = 0; i < faces_.size() / 3; ++i)
            if (area(i).dot(normal) < -flatness * extent * extent) return false;
        return true;
    }

    const MeshData& mesh_;
    std::span<const int32_t> faces_;  ///< three corners of each triangle
    std::vector<Edge> edges_, outer_;
    std::vector<int32_t> loop_, cut_;
};

/// The first triangle of each run of triangles of one polygon in one part, and at the end their number.
std::vector<int32_t> polygon_runs(const MeshData& mesh) {
    std::vector<int32_t> borders;
    for (const MeshPart& part : mesh.parts) {
        borders.push_back(part.first_face);
        borders.push_back(part.first_face + part.face_count);
    }
    std::sort(borders.begin(), borders.end());
    std::vector<int32_t> runs;
    const int32_t count = int32_t(mesh.F.rows());
    auto border = borders.begin();
    for (int32_t face = 0; face < count; ++face) {
        while (border != borders.end() && *border < face) ++border;
        const bool is_border = border != borders.end() && *border == face;
        if (face == 0 || is_border || mesh.source_face(face) != mesh.source_face(face - 1))
            runs.push_back(face);
    }
    runs.push_back(count);
    return runs;
}

/// Polygons of some runs.
struct PolygonPiece {
    std::vector<int32_t> corners, face;
    std::vector<size_t> size;

    void add(std::span<const int32_t> polygon, Eigen::Index first) {
        corners.insert(corners.end(), polygon.begin(), polygon.end());
        face.push_back(int32_t(first));
        size.push_back(polygon.size());
    }
};

}  // namespace

FacePolygons::FacePolygons(const MeshData& mesh) : F_(mesh.F) {
    if (mesh.source_face.empty()) return;
    const std::vector<int32_t> runs = polygon_runs(mesh);
    const size_t count = runs.size() - 1;
    std::vector<PolygonPiece> pieces((count + run_grain - 1) / run_grain);
    parallel_chunks(count, run_grain, [&](size_t begin, size_t end) {
        TriangleJoiner joiner(mesh);
        PolygonPiece& piece = pieces[begin / run_grain];
        for (size_t run = begin; run < end; ++run) {
            const std::span<const int32_t> joined = joiner.join(runs[run], runs[run + 1]);
            if (!joined.empty()) piece.add(joined, runs[run]);
            for (Eigen::Index i = runs[run]; joined.empty() && i < runs[run + 1]; ++i)
                piece.add({mesh.F.data() + 3 * i, 3}, i);
        }
    });
    first_.push_back(0);
    for (const PolygonPiece& piece : pieces) {
        for (const size_t size : piece.size) first_.push_back(first_.back() + size);
        corners_.insert(corners_.end(), piece.corners.begin(), piece.corners.end());
        face_.insert(face_.end(), piece.face.begin(), piece.face.end());
    }
}

std::span<const int32_t> FacePolygons::corners(size_t polygon) const {
    if (face_.empty()) return {F_.data() + 3 * polygon, 3};
    return {corners_.data() + first_[polygon], first_[polygon + 1] - first_[polygon]};
}

size_t FacePolygons::most_corners() const {
    size_t most = 3;
    for (size_t i = 0; i < face_.size(); ++i) most = std::max(most, corners(i).size());
    return most;
}

size_t FacePolygons::polygons_before(Eigen::Index face) const {
    if (face_.empty()) return size_t(face);
    return size_t(std::lower_bound(face_.begin(), face_.end(), face) - face_.begin());
}

}  // namespace easypbr::io
