// Whether content is a height field z = f(x, y) over a rectangle, told from its vertices and faces alone: at
// any scale of x, y and z, and for few vertices too. See "Up axis" in docs/design/automatic_parameters.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "easypbr/scene/auto_parameters.h"

namespace easypbr::detail {
namespace {

constexpr size_t most_field_faces = 1 << 14, most_field_points = 1 << 16;
/// Of an extent: numbers that differ by less are the same, rounded.
constexpr double rounding_part = 1e-6;

using FieldFace = std::array<Vec3d, 3>;

struct FieldSamples {
    std::vector<FieldFace> faces;
    std::vector<Vec3d> vertices;  ///< corners of the faces; of clouds the points
    std::vector<Vec3d> middles;   ///< of the faces' edges
    Box3d box;
    double count = 0;     ///< of vertices, sampled or not; of meshes as many as grids of as many faces have
    double per_face = 1;  ///< how many faces one sample stands for

    double extent(int axis) const { return box.sizes()[axis]; }
    double rounding(int axis) const { return rounding_part * extent(axis); }
};

void add_field_face(const SceneSnapshot::Object& object, Eigen::Index row, FieldSamples& samples) {
    const MeshData& mesh = *object.mesh;
    FieldFace face;
    for (int i = 0; i < 3; ++i)
        face[size_t(i)] = object.T_world_mesh * Vec3d(mesh.V.row(mesh.F(row, i)).transpose().cast<double>());
    for (size_t i = 0; i < 3; ++i) {
        samples.vertices.push_back(face[i]);
        samples.middles.push_back((face[i] + face[(i + 1) % 3]) / 2);
        samples.box.extend(face[i]);
    }
    samples.faces.push_back(face);
}

void add_field_point(const SceneSnapshot::Object& object, Eigen::Index row, FieldSamples& samples) {
    samples.vertices.push_back(object.T_world_mesh *
                               Vec3d(object.mesh->V.row(row).transpose().cast<double>()));
    samples.box.extend(samples.vertices.back());
}

/// All faces or points, or as many as are enough, without a step that the rows of a grid could be a multiple
/// of: multiples of the golden ratio modulo 1 are evenly spread.
FieldSamples field_samples(const SceneSnapshot& scene) {
    const bool of_faces = std::ranges::any_of(
        scene.objects, [](const SceneSnapshot::Object& object) { return !object.mesh->F.empty(); });
    const auto rows_of = [&](const SceneSnapshot::Object& object) {
        const MeshData& mesh = *object.mesh;
        if (of_faces) return mesh.F.rows();
        return mesh.E.empty() ? mesh.V.rows() : 0;
    };
    double all = 0;
    for (const SceneSnapshot::Object& object : scene.objects) all += double(rows_of(object));
    const double part = std::min(1.0, double(of_faces ? most_field_faces : most_field_points) / all);
    FieldSamples samples;
    samples.count = of_faces ? all / 2 : all;
    samples.per_face = 1 / part;
    for (const SceneSnapshot::Object& object : scene.objects) {
        const Eigen::Index rows = rows_of(object), count = Eigen::Index(std::ceil(double(rows) * part));
        for (Eigen::Index i = 0; i < count; ++i) {
            const double turns = 0.6180339887498949 * double(i);
            const Eigen::Index row =
                count == rows ? i : Eigen::Index((turns - std::floor(turns)) * double(rows));
            of_faces ? add_field_face(object, row, samples) : add_field_point(object, row, samples);
        }
    }
    return samples;
}

/// The values along an axis where they are few and about evenly spaced, as those of a grid are; else none.
std::vector<double> grid_lines(int axis, const FieldSamples& samples) {
    constexpr size_t least_lines = 5, least_per_line = 4;
    constexpr double most_uneven = 2.5;  // Where a line is left out the gap is twice as wide.
    std::vector<double> values, lines;
    for (const Vec3d& vertex : samples.vertices) values.push_back(vertex[axis]);
    std::ranges::sort(values);
    double last = -std::numeric_limits<double>::infinity();
    for (const double value : values) {
        if (value - last > samples.rounding(axis)) lines.push_back(value);
        last = value;
    }
    if (lines.size() < least_lines || lines.size() * least_per_line > values.size()) return {};
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (size_t i = 1; i < lines.size(); ++i) {
        least = std::min(least, lines[i] - lines[i - 1]);
        most = std::max(most, lines[i] - lines[i - 1]);
    }
    return most <= most_uneven * least ? lines : std::vector<double>();
}

using GridLines = std::array<std::vector<double>, 3>;

/// Whether vertices where the same lines cross are at the same height.
bool has_one_height(int axis, const FieldSamples& samples, const std::vector<double>& u_lines,
                    const std::vector<double>& v_lines) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto line_at = [](const std::vector<double>& lines, double value) {
        return size_t(std::ranges::upper_bound(lines, value) - lines.begin()) - 1;
    };
    std::vector<std::pair<size_t, double>> heights;
    for (const Vec3d& vertex : samples.vertices)
        heights.emplace_back(line_at(u_lines, vertex[u]) * v_lines.size() + line_at(v_lines, vertex[v]),
                             vertex[axis]);
    std::ranges::sort(heights);
    const double most = samples.rounding(axis);
    return std::ranges::adjacent_find(heights, [&](const auto& a, const auto& b) {
               return a.first == b.first && b.second - a.second > most;
           }) == heights.end();
}

/// Vertices on a regular grid of lines across an axis, at most one height where two lines cross. Of a large
/// cloud few samples share a place: there as many points as places tell that the grid is no rounding of what
/// was scanned.
bool is_grid(int axis, const FieldSamples& samples, const GridLines& lines) {
    constexpr double least_used = 0.25, most_used = 1.1;
    const std::vector<double>& u_lines = lines[size_t(axis + 1) % 3];
    const std::vector<double>& v_lines = lines[size_t(axis + 2) % 3];
    if (u_lines.empty() || v_lines.empty()) return false;
    const double used = samples.count / (double(u_lines.size()) * double(v_lines.size()));
    return used >= least_used && used <= most_used && has_one_height(axis, samples, u_lines, v_lines);
}

/// Faces across an axis, seen along it.
struct ProjectedFaces {
    double front = 0, back = 0;  ///< area of those of either winding, of the rectangle around all
    double along = 0;            ///< part of the faces that hold the axis

    double area() const { return front + back; }
};

ProjectedFaces projected_faces(int axis, const FieldSamples& samples) {
    constexpr double no_area = 1e-12;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    ProjectedFaces result;
    for (const FieldFace& face : samples.faces) {
        const Vec3d a = face[1] - face[0], b = face[2] - face[0];
        const double area = (a[u] * b[v] - a[v] * b[u]) / 2 / (samples.extent(u) * samples.extent(v));
        (area > 0 ? result.front : result.back) += std::abs(area) * samples.per_face;
        if (std::abs(area) <= no_area) result.along += 1 / double(samples.faces.size());
    }
    return result;
}

/// The longest part of the content's height that holds no face: cards at two depths have one.
double widest_gap(int axis, const FieldSamples& samples) {
    std::vector<std::pair<double, double>> spans;
    for (const FieldFace& face : samples.faces)
        spans.push_back(std::minmax({face[0][axis], face[1][axis], face[2][axis]}));
    std::ranges::sort(spans);
    double gap = 0, end = samples.box.min()[axis];
    for (const auto& [low, high] : spans) {
        gap = std::max(gap, low - end);
        end = std::max(end, high);
    }
    return gap / samples.extent(axis);
}

/// Faces of one side that cover the rectangle across an axis once, and are curved along both of its sides: a
/// curtain is curved along one.
bool is_surface(int axis, const FieldSamples& samples) {
    constexpr size_t least_faces = 32;
    constexpr double most_of_other_side = 1e-3, most_along = 0.02, least_area = 0.5, most_area = 1.1,
                     least_curved = 0.01, most_gap = 0.25;
    if (samples.faces.size() < least_faces) return false;
    const ProjectedFaces faces = projected_faces(axis, samples);
    if (std::min(faces.front, faces.back) > most_of_other_side * faces.area()) return false;
    if (faces.along > most_along || faces.area() < least_area || faces.area() > most_area) return false;
    for (const int side : {(axis + 1) % 3, (axis + 2) % 3})
        if (projected_faces(side, samples).area() < least_curved) return false;
    return widest_gap(axis, samples) <= most_gap;
}

/// What vertices and middles of edges touch of the rectangle around them, across an axis.
class Outline {
  public:
    /// `border`: part of a side within which points are at the other.
    Outline(int axis, const FieldSamples& samples, const std::array<size_t, 2>& cells, double border)
        : axis_(axis), border_(border), cells_(cells), inside_(cells[0] * cells[1]) {
        for (size_t side : {0, 1}) borders_[side].resize(2 * cells[1 - side]);
        for (const std::vector<Vec3d>* points : {&samples.vertices, &samples.middles})
            for (const Vec3d& point : *points) add(point, samples);
    }

    /// A face mask is round: it has no corners, and touches the border in some places. Holes are anywhere.
    bool is_rectangle() const {
        constexpr double least = 0.75;
        const auto touched = [](const std::vector<bool>& cells) {
            return double(std::ranges::count(cells, true));
        };
        const double border = touched(borders_[0]) + touched(borders_[1]);
        return std::ranges::count(corners_, true) >= 3 &&
               touched(inside_) >= least * double(inside_.size()) &&
               border >= least * double(borders_[0].size() + borders_[1].size());
    }

  private:
    void add(const Vec3d& point, const FieldSamples& samples) {
        constexpr double corner = 1.0 / 8;
        std::array<double, 2> at{};
        std::array<size_t, 2> cell{};
        for (size_t i : {0, 1}) {
            const int across = (axis_ + 1 + int(i)) % 3;
            at[i] = (point[across] - samples.box.min()[across]) / samples.extent(across);
            cell[i] = std::min(cells_[i] - 1, size_t(at[i] * double(cells_[i])));
        }
        inside_[cell[0] * cells_[1] + cell[1]] = true;
        const auto is_within = [&](size_t i, double part) { return std::min(at[i], 1 - at[i]) <= part; };
        for (size_t i : {0, 1})
            if (is_within(i, border_)) borders_[i][2 * cell[1 - i] + size_t(at[i] > 0.5)] = true;
        if (is_within(0, corner) && is_within(1, corner))
            corners_[2 * size_t(at[0] > 0.5) + size_t(at[1] > 0.5)] = true;
    }

    int axis_;
    double border_;
    std::array<size_t, 2> cells_;
    std::vector<bool> inside_;
    std::array<std::vector<bool>, 2> borders_;  ///< cells along the two sides across either direction
    std::array<bool, 4> corners_{};
};

/// Cells of an outline along as many vertices: each holds one at least.
size_t outline_cells(double vertices) {
    return size_t(std::clamp(0.7 * vertices, 4.0, 16.0));
}

bool is_rectangular_grid(int axis, const FieldSamples& samples, const GridLines& lines) {
    const auto cells = [&](int across) { return outline_cells(double(lines[size_t(across) % 3].size())); };
    return Outline(axis, samples, {cells(axis + 1), cells(axis + 2)}, 1.0 / 16).is_rectangle();
}

/// The border of what a depth camera sees is straight in its image, not in space: that of a surface has to be
/// as straight as that of a triangulation of points within a rectangle.
bool is_rectangular_surface(int axis, const FieldSamples& samples) {
    const double vertices = std::sqrt(samples.count);
    const size_t cells = outline_cells(vertices);
    return Outline(axis, samples, {cells, cells}, std::clamp(1 / vertices, 0.01, 1.0 / 16)).is_rectangle();
}

/// What says that content is a height field along an axis; the later the clearer.
enum class FieldSign { none, surface, grid };

FieldSign field_sign(int axis, const FieldSamples& samples, const GridLines& lines) {
    constexpr double flat = 1e-4;
    const double side = std::max(samples.extent((axis + 1) % 3), samples.extent((axis + 2) % 3));
    if (!(samples.box.sizes().minCoeff() > 0) || samples.extent(axis) < flat * side) return FieldSign::none;
    if (is_grid(axis, samples, lines) && is_rectangular_grid(axis, samples, lines)) return FieldSign::grid;
    return is_surface(axis, samples) && is_rectangular_surface(axis, samples) ? FieldSign::surface
                                                                              : FieldSign::none;
}

}  // namespace

bool is_height_field(const SceneSnapshot& scene) {
    // A depth camera looks along z, not down.
    if (std::ranges::any_of(scene.objects, [](const auto& object) { return !object.mesh->front.isZero(); }))
        return false;
    const FieldSamples samples = field_samples(scene);
    if (samples.vertices.empty()) return false;
    GridLines lines;
    for (int axis = 0; axis < 3; ++axis) lines[size_t(axis)] = grid_lines(axis, samples);
    const auto sign = [&](int axis) { return field_sign(axis, samples, lines); };
    const FieldSign z = sign(2);
    // A ramp is one along two axes.
    return z != FieldSign::none && z > std::max(sign(0), sign(1));
}

}  // namespace easypbr::detail
