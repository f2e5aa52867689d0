#include "easypbr/geometry/tubes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/disjoint_sets.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/require.h"
#include "easypbr/scene/merge.h"

namespace easypbr {
namespace {

/// Cosine of the turn beyond which a corner is a crease.
const double cos_crease = std::cos(radians(30));

/// An edge between two different places, each named by its vertex that comes first.
struct LineEdge {
    int32_t a, b;
    double length;

    int32_t other(int32_t place) const { return place == a ? b : a; }
};

/// Edges that follow each other, and the places along them, one more than edges; of a ring the last is the
/// first.
struct Chain {
    std::vector<int32_t> places;
    bool is_ring = false;
};

/// The edges of a mesh without those of length 0 and those that are there already.
class LineNetwork {
  public:
    explicit LineNetwork(const MeshData& mesh) : mesh_(mesh), at_(size_t(mesh.V.rows())) {
        const std::vector<int32_t> place = places();
        std::vector<KeyedIndex> pairs;
        for (Eigen::Index e = 0; e < mesh.E.rows(); ++e) {
            check_interrupt(size_t(e));
            const int32_t a = place[size_t(mesh.E(e, 0))], b = place[size_t(mesh.E(e, 1))];
            if (a != b)
                pairs.push_back({uint64_t(std::min(a, b)) << 32 | uint64_t(std::max(a, b)), uint32_t(e)});
        }
        parallel_sort(pairs);
        for (size_t i = 0; i < pairs.size(); ++i) {
            check_interrupt(i);
            if (i == 0 || pairs[i].key != pairs[i - 1].key)
                add(int32_t(pairs[i].key >> 32), int32_t(pairs[i].key & 0xffffffff));
        }
    }

    bool empty() const { return edges_.empty(); }

    /// Calls visit(place) for the places of edges, for some more than once.
    template <class Visit>
    void visit_places(Visit&& visit) const {
        for (const LineEdge& edge : edges_) {
            visit(edge.a);
            visit(edge.b);
        }
    }

    Vec3d point(int32_t place) const { return mesh_.V.row(place).transpose().cast<double>(); }

    bool is_end(int32_t place) const { return at_[size_t(place)].size() == 1; }

    /// The chains of edges; may_join(before, at, after, shorter edge) tells whether a tube goes on at a place
    /// of two edges.
    template <class MayJoin>
    std::vector<Chain> chains(MayJoin&& may_join) const {
        std::vector<char> is_joined(at_.size(), 0), is_used(edges_.size(), 0);
        for (size_t place = 0; place < at_.size(); ++place) {
            check_interrupt(place);
            if (at_[place].size() != 2) continue;
            const LineEdge &in = edges_[size_t(at_[place][0])], &out = edges_[size_t(at_[place][1])];
            is_joined[place] = may_join(in.other(int32_t(place)), int32_t(place), out.other(int32_t(place)),
                                        std::min(in.length, out.length));
        }
        std::vector<Chain> result;
        const auto follow = [&](size_t edge, int32_t start) {
            if (is_used[edge]) return;
            Chain chain{{start}, false};
            while (true) {
                check_interrupt(chain.places.size());
                is_used[edge] = 1;
                const int32_t place = edges_[edge].other(chain.places.back());
                chain.places.push_back(place);
                if (!is_joined[size_t(place)] || place == start) break;
                const std::vector<int32_t>& both = at_[size_t(place)];
                edge = size_t(both[size_t(both[0]) == edge ? 1 : 0]);
            }
            chain.is_ring = chain.places.back() == start && is_joined[size_t(start)];
            result.push_back(std::move(chain));
        };
        for (size_t edge = 0; edge < edges_.size(); ++edge)
            for (const int32_t end : {edges_[edge].a, edges_[edge].b})
                if (!is_joined[size_t(end)]) follow(edge, end);
        for (size_t edge = 0; edge < edges_.size(); ++edge) follow(edge, edges_[edge].a);
        return result;
    }

  private:
    void add(int32_t a, int32_t b) {
        at_[size_t(a)].push_back(int32_t(edges_.size()));
        at_[size_t(b)].push_back(int32_t(edges_.size()));
        edges_.push_back({a, b, (point(a) - point(b)).stableNorm()});
    }

    /// For each vertex the first of those at its place that edges of length 0 join it to.
    std::vector<int32_t> places() const {
        geometry::DisjointSets sets(at_.size());
        for (Eigen::Index e = 0; e < mesh_.E.rows(); ++e) {
            check_interrupt(size_t(e));
            if (mesh_.V.row(mesh_.E(e, 0)) == mesh_.V.row(mesh_.E(e, 1)))
                sets.unite(mesh_.E(e, 0), mesh_.E(e, 1));
        }
        std::vector<int32_t> first(at_.size(), -1), result(at_.size());
        for (size_t v = 0; v < result.size(); ++v) {
            int32_t& known = first[size_t(sets.find(int32_t(v)))];
            if (known < 0) known = int32_t(v);
            result[v] = known;
        }
        return result;
    }

    const MeshData& mesh_;
    std::vector<std::vector<int32_t>> at_;  ///< the edges at each place
    std::vector<LineEdge> edges_;
};

/// Two axes across a line and the line's direction, right-handed.
struct LineFrame {
    Vec3d u, v, along;

    explicit LineFrame(const Vec3d& direction)
        : u(direction.unitOrthogonal()), v(direction.cross(u)), along(direction) {}

    /// Turned the shortest way until `along` is the direction, which is not opposite.
    LineFrame turned_to(const Vec3d& direction) const {
        LineFrame result = *this;
        result.u -= (along + direction) * (u.dot(direction) / (1 + along.dot(direction)));
        result.u = (result.u - direction * result.u.dot(direction)).normalized();
        result.v = direction.cross(result.u);
        result.along = direction;
        return result;
    }
    /// Turned about `along`.
    LineFrame rolled(double angle) const {
        LineFrame result = *this;
        result.u = std::cos(angle) * u + std::sin(angle) * v;
        result.v = along.cross(result.u);
        return result;
    }

    Vec3d around(const Vec2d& turn) const { return turn.x() * u + turn.y() * v; }
};

/// The surface of tubes while it is made.
class TubeSurface {
  public:
    explicit TubeSurface(int sides) : sides_(sides) {
        for (int i = 0; i < sides; ++i)
            circle_.emplace_back(std::cos(2 * pi * i / sides), std::sin(2 * pi * i / sides));
    }

    /// A ring of vertices around `center` in the plane across `plane`, with the normals of a cone around the
    /// other frame's line whose normals lean by `slope` along it. Returns its first vertex.
    int32_t add_ring(const Vec3d& center, double radius, const LineFrame& frame, const Vec3d& plane,
                     const LineFrame& normals, double slope, int32_t source) {
        check_interrupt();
        const int32_t first = next(source, sides_);
        for (const Vec2d& turn : circle_) {
            const Vec3d across = frame.around(turn);
            const Vec3d slide = frame.along * (across.dot(plane) / frame.along.dot(plane));
            V_.push_back((center + radius * (across - slide)).cast<float>());
            N_.push_back((normals.around(turn) + slope * normals.along).normalized().cast<float>());
        }
        return first;
    }

    /// The same places again with normals of a cone, or with one normal.
    int32_t repeat_ring(int32_t ring, const LineFrame& normals, double slope) {
        const int32_t first = next(source_[size_t(ring)], sides_);
        for (int i = 0; i < sides_; ++i) {
            V_.push_back(Vec3(V_[size_t(ring) + size_t(i)]));
            N_.push_back(
                (normals.around(circle_[size_t(i)]) + slope * normals.along).normalized().cast<float>());
        }
        return first;
    }
    int32_t repeat_ring(int32_t ring, const Vec3d& normal) {
        const int32_t first = next(source_[size_t(ring)], sides_);
        for (int i = 0; i < sides_; ++i) {
            V_.push_back(Vec3(V_[size_t(ring) + size_t(i)]));
            N_.push_back(normal.cast<float>());
        }
        return first;
    }

    /// Faces from a ring to the next one along the line, whose vertex `shift` is beside the first one's 0.
    void add_band(int32_t from, int32_t to, int shift = 0) {
        for (int i = 0; i < sides_; ++i) {
            const int32_t a = from + i, b = from + (i + 1) % sides_;
            const int32_t c = to + (i + shift) % sides_, d = to + (i + 1 + shift) % sides_;
            F_.push_back({a, b, d});
            F_.push_back({a, d, c});
        }
    }

    /// Closes the tube at a ring; `side`: -1 at the begin of the line, 1 at its end.
    void add_round_end(int32_t ring, const Vec3d& center, double radius, const LineFrame& frame, int side) {
        const int32_t source = source_[size_t(ring)];
        const int steps = std::max(1, sides_ / 4);
        for (int step = 1; step < steps; ++step) {
            const double angle = pi / 2 * step / steps, lift = side * std::sin(angle);
            const int32_t next_ring = add_ring(center + lift * radius * frame.along, radius * std::cos(angle),
                                               frame, frame.along, frame, lift / std::cos(angle), source);
            if (side > 0)
                add_band(ring, next_ring);
            else
                add_band(next_ring, ring);
            ring = next_ring;
        }
        const int32_t pole = next(source, 1);
        V_.push_back((center + side * radius * frame.along).cast<float>());
        N_.push_back((side * frame.along).cast<float>());
        for (int i = 0; i < sides_; ++i) add_fan_face(pole, ring + i, ring + (i + 1) % sides_, side);
    }
    void add_flat_end(int32_t ring, const LineFrame& frame, int side) {
        const int32_t cap = repeat_ring(ring, Vec3d(side * frame.along));
        for (int i = 1; i + 1 < sides_; ++i) add_fan_face(cap, cap + i, cap + i + 1, side);
    }

    MeshData of(const MeshData& lines) const {
        MeshData mesh = geometry::gather_vertices(lines, source_);
        const auto rows = Eigen::Index(V_.size());
        mesh.V = Array3f::Dense(Eigen::Map<const Array3f::Dense>(V_.data()->data(), rows, 3));
        mesh.N = Array3f::Dense(Eigen::Map<const Array3f::Dense>(N_.data()->data(), rows, 3));
        mesh.F =
            Array3i::Dense(Eigen::Map<const Array3i::Dense>(F_.data()->data(), Eigen::Index(F_.size()), 3));
        mesh.T = {};
        mesh.B = {};
        mesh.uv_tangents = {};
        mesh.splats = {};
        mesh.voxel_size = 0;
        // Vertices of one source would count as one for normals.
        mesh.source_vertex = {};
        mesh.style.mode = {};
        mesh.style.flat = {};
        return mesh;
    }

  private:
    /// The number of the next vertex, after so many were made sure to fit.
    int32_t next(int32_t source, int count) {
        if (V_.size() > size_t(std::numeric_limits<int32_t>::max() - count))
            throw ArgumentError("make_tubes: expected fewer edges or sides, got more than 2^31 vertices");
        const auto first = int32_t(V_.size());
        source_.insert(source_.end(), size_t(count), source);
        return first;
    }
    void add_fan_face(int32_t a, int32_t b, int32_t c, int side) {
        F_.push_back(side > 0 ? std::array{a, b, c} : std::array{a, c, b});
    }

    int sides_;
    std::vector<Vec2d> circle_;  ///< of radius 1
    std::vector<Vec3> V_, N_;
    std::vector<std::array<int32_t, 3>> F_;
    std::vector<int32_t> source_;  ///< the line's vertex that each one belongs to
};

/// The vertices of a tube at a place: the ring that faces what comes before, and the one that faces what
/// comes after; the same one where there is no crease.
struct TubeJoint {
    int32_t in, out;
};

/// Makes the tubes of chains.
class TubeMaker {
  public:
    TubeMaker(const LineNetwork& lines, const Eigen::VectorXd& radii, const TubeOptions& options)
        : lines_(lines), radii_(radii), options_(options), surface_(options.sides) {}

    void add(const Chain& chain) {
        places_ = chain.places;
        set_frames(chain.is_ring);
        if (chain.is_ring)
            add_ring_tube();
        else
            add_open_tube();
    }

    const TubeSurface& surface() const { return surface_; }

  private:
    size_t edge_count() const { return frames_.size(); }
    Vec3d point(size_t i) const { return lines_.point(places_[i]); }
    double radius(size_t i) const { return radii_[places_[i]]; }

    /// Of each edge, carried along the line; slopes_: how far its normals lean forwards, as a tangent.
    void set_frames(bool is_ring) {
        frames_.clear();
        slopes_.clear();
        for (size_t i = 0; i + 1 < places_.size(); ++i) {
            check_interrupt(i);
            const Vec3d step = point(i + 1) - point(i);
            const Vec3d direction = step.stableNormalized();
            frames_.push_back(i == 0 ? LineFrame(direction) : frames_.back().turned_to(direction));
            slopes_.push_back((radius(i) - radius(i + 1)) / step.stableNorm());
        }
        shift_ = 0;
        if (is_ring) close_frames();
    }

    /// Rolls the frames of a ring until the last one meets the first, by half of a side at most: what is left
    /// is a shift of vertices.
    void close_frames() {
        const LineFrame &first = frames_.front(), last = frames_.back().turned_to(first.along);
        const double side = 2 * pi / options_.sides;
        const double angle = std::atan2(first.u.dot(last.v), first.u.dot(last.u));
        const int whole = int(std::round(angle / side));
        shift_ = (2 * options_.sides - whole) % options_.sides;
        std::vector<double> begins{0};  // along the ring, of the edges
        for (size_t i = 0; i < edge_count(); ++i)
            begins.push_back(begins.back() + (point(i + 1) - point(i)).stableNorm());
        for (size_t i = 0; i < edge_count(); ++i) {
            check_interrupt(i);
            frames_[i] = frames_[i].rolled((angle - whole * side) * begins[i] / begins.back());
        }
    }

    /// Between two edges; `before` and `after` are the same but for their directions.
    TubeJoint add_joint(size_t place, size_t before, size_t after) {
        const LineFrame& out = frames_[after];
        const Vec3d middle = (frames_[before].along + out.along).normalized();
        const bool is_crease = frames_[before].along.dot(out.along) < cos_crease;
        const LineFrame in = out.turned_to(frames_[before].along);
        if (!is_crease) {
            const double slope = (slopes_[before] + slopes_[after]) / 2;
            const int32_t ring = surface_.add_ring(point(place), radius(place), out, middle,
                                                   out.turned_to(middle), slope, places_[place]);
            return {ring, ring};
        }
        const int32_t ring =
            surface_.add_ring(point(place), radius(place), out, middle, in, slopes_[before], places_[place]);
        return {ring, surface_.repeat_ring(ring, out, slopes_[after])};
    }

    int32_t add_end(size_t place, size_t edge, int side) {
        const LineFrame& frame = frames_[edge];
        const int32_t ring = surface_.add_ring(point(place), radius(place), frame, frame.along, frame,
                                               slopes_[edge], places_[place]);
        if (options_.ends == TubeEnds::flat && lines_.is_end(places_[place]))
            surface_.add_flat_end(ring, frame, side);
        else
            surface_.add_round_end(ring, point(place), radius(place), frame, side);
        return ring;
    }

    void add_open_tube() {
        int32_t ring = add_end(0, 0, -1);
        for (size_t i = 1; i < edge_count(); ++i) {
            const TubeJoint joint = add_joint(i, i - 1, i);
            surface_.add_band(ring, joint.in);
            ring = joint.out;
        }
        surface_.add_band(ring, add_end(edge_count(), edge_count() - 1, 1));
    }

    void add_ring_tube() {
        const TubeJoint first = add_joint(0, edge_count() - 1, 0);
        int32_t ring = first.out;
        for (size_t i = 1; i < edge_count(); ++i) {
            const TubeJoint joint = add_joint(i, i - 1, i);
            surface_.add_band(ring, joint.in);
            ring = joint.out;
        }
        surface_.add_band(ring, first.in, shift_);
    }

    const LineNetwork& lines_;
    const Eigen::VectorXd& radii_;
    const TubeOptions& options_;
    TubeSurface surface_;
    std::vector<int32_t> places_;    ///< of the chain
    std::vector<LineFrame> frames_;  ///< of its edges
    std::vector<double> slopes_;
    int shift_ = 0;  ///< of the vertices of the first ring against those of the last
};

/// The radius at each vertex; 0 where there is no edge.
Eigen::VectorXd tube_radii(const MeshData& mesh, const LineNetwork& lines, const TubeOptions& options) {
    Eigen::VectorXd radii = Eigen::VectorXd::Zero(mesh.V.rows());
    if (options.radii.empty()) {
        Box3d box;
        lines.visit_places([&](int32_t place) { box.extend(lines.point(place)); });
        const double radius = options.radius.value_or(box.diagonal().stableNorm() / 200);
        geometry::require_positive("make_tubes: radius", radius);
        radii.setConstant(radius);
        return radii;
    }
    if (options.radius) throw ArgumentError("make_tubes: expected a radius or radii, got both");
    if (options.radii.rows() != mesh.V.rows())
        throw ArgumentError(fmt::format("make_tubes: radii: expected one for each of {} vertices, got {}",
                                        mesh.V.rows(), options.radii.rows()));
    lines.visit_places([&](int32_t place) {
        geometry::require_positive(fmt::format("make_tubes: radius of vertex {}", place).c_str(),
                                   options.radii[place]);
        radii[place] = options.radii[place];
    });
    return radii;
}

/// Whether a tube goes on from edge to edge: it turns by at most 90 degrees (but for rounding), and the mitre
/// takes at most half of the shorter edge.
bool may_go_on(const Vec3d& in, const Vec3d& out, double radius, double shorter_edge) {
    const double cosine = in.stableNormalized().dot(out.stableNormalized());
    if (cosine < -1e-4) return false;
    const double tangent_of_half = std::sqrt(std::max(0.0, 1 - cosine) / (1 + cosine));
    return radius * tangent_of_half <= shorter_edge / 2;
}

void warn_of_points(const MeshData& mesh) {
    geometry::Selection used = geometry::select_all(mesh);
    geometry::drop_unreferenced(used, mesh);
    const Eigen::Index count = mesh.V.rows() - Eigen::Index(used.vertices.size());
    if (count > 0)
        log_warning(fmt::format("mesh '{}': {} of its {} vertices belong to no edge and no face: left out",
                                mesh.name, count, mesh.V.rows()));
}

/// The faces of the mesh with what belongs to them, then the tubes.
MeshData joined_with_faces(const MeshData& mesh, MeshData tubes) {
    geometry::Selection selection = geometry::select_all(mesh);
    selection.edges.clear();
    geometry::drop_unreferenced(selection, mesh);
    MeshData faces = geometry::chosen(mesh, selection);
    // The whole is not drawn flat: faces that were get normals that shade them so. See add_drawn_normals().
    if (faces.style.flat.value_or(false)) faces.N = {};
    tubes.parts = {{"tubes", 0, int(tubes.F.rows()), 0}};
    MeshData whole = merged(std::array{std::move(faces), tubes});
    whole.children = tubes.children;
    whole.style.mode = {};
    whole.style.flat = {};
    return whole;
}

}  // namespace

Mesh make_tubes(const Mesh& mesh, const TubeOptions& options) {
    const auto data = mesh.snapshot();
    geometry::require_between("make_tubes: sides", options.sides, 3, 8192);
    const LineNetwork lines(*data);
    if (lines.empty())
        throw ArgumentError(
            fmt::format("make_tubes: expected a mesh with edges (E) of a length above 0, got '{}' with {} "
                        "vertices and {} edges{}",
                        data->name, data->V.rows(), data->E.rows(),
                        data->children.empty() ? "" : "; merge() makes its children part of it"));
    const Eigen::VectorXd radii = tube_radii(*data, lines, options);
    TubeMaker maker(lines, radii, options);
    for (const Chain& chain :
         lines.chains([&](int32_t before, int32_t place, int32_t after, double shorter_edge) {
             const Vec3d point = lines.point(place);
             return may_go_on(point - lines.point(before), lines.point(after) - point, radii[place],
                              shorter_edge);
         }))
        maker.add(chain);
    warn_of_points(*data);
    MeshData tubes = maker.surface().of(*data);
    return Mesh(data->F.empty() ? std::move(tubes) : joined_with_faces(*data, std::move(tubes)));
}

}  // namespace easypbr
