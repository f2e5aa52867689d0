// The axis that points up where the settings do not say: the convention of the files' formats, or the level
// surfaces of the content. See "Up axis" in docs/design/automatic_parameters.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "easypbr/scene/auto_parameters.h"

namespace easypbr::detail {
namespace {

constexpr size_t up_samples = 1 << 16, least_up_samples = 4000;
constexpr size_t slab_count = 20;
/// Slabs at one end of an axis.
constexpr size_t end_slabs = slab_count / 4;

using Triangle = std::array<Vec3d, 3>;

/// An object's own part of the samples: some of its faces, or of its points.
struct SampledObject {
    std::vector<Triangle> faces;
    std::vector<Vec3d> points;
    double area = 0;  ///< of all faces; of points: the square of their extent
};

double area_of(const Triangle& t) {
    return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2;
}

Vec3d position_of(const SceneSnapshot::Object& object, Eigen::Index vertex) {
    return object.T_world_mesh * Vec3d(object.mesh->V.row(vertex).transpose().cast<double>());
}

SampledObject sampled(const SceneSnapshot::Object& object, size_t count) {
    const MeshData& mesh = *object.mesh;
    SampledObject result;
    const Eigen::Index rows = mesh.F.empty() ? mesh.V.rows() : mesh.F.rows();
    const Eigen::Index step =
        std::max<Eigen::Index>(1, (rows + Eigen::Index(count) - 1) / Eigen::Index(count));
    Box3d box;
    for (Eigen::Index i = 0; i < rows; i += step) {
        if (mesh.F.empty()) {
            result.points.push_back(position_of(object, i));
            box.extend(result.points.back());
        } else {
            result.faces.push_back({position_of(object, mesh.F(i, 0)), position_of(object, mesh.F(i, 1)),
                                    position_of(object, mesh.F(i, 2))});
            result.area += area_of(result.faces.back()) * double(step);
        }
    }
    if (!result.points.empty()) result.area = box.diagonal().squaredNorm();
    return result;
}

/// A point of a surface with its normal, or of a cloud, without.
struct SurfacePoint {
    Vec3d position;
    Vec3d normal{0, 0, 0};
};

/// What std::fmod(x, 1) is for positive numbers, in a fraction of its time.
double fraction(double x) {
    return x - std::floor(x);
}

/// Points of the faces, evenly spread by area; the R2 sequence (Roberts 2018) says where in a face.
void spread(const SampledObject& object, size_t count, std::vector<SurfacePoint>& points) {
    std::vector<double> until;
    for (const Triangle& face : object.faces)
        until.push_back((until.empty() ? 0 : until.back()) + area_of(face));
    if (!(until.back() > 0)) return;
    size_t face = 0;
    for (size_t i = 0; i < count; ++i) {
        const double at = (double(i) + 0.5) / double(count) * until.back();
        while (face + 1 < until.size() && until[face] < at) ++face;
        double u = fraction(0.5 + 0.7548776662466927 * double(i)),
               v = fraction(0.5 + 0.5698402909980532 * double(i));
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Triangle& t = object.faces[face];
        const Vec3d a = t[1] - t[0], b = t[2] - t[0];
        points.push_back({t[0] + u * a + v * b, a.cross(b).stableNormalized()});
    }
}

void thin_out(const std::vector<Vec3d>& from, size_t count, std::vector<SurfacePoint>& points) {
    const size_t step = std::max<size_t>(1, from.size() / std::max<size_t>(1, count));
    for (size_t i = 0; i < from.size(); i += step) points.push_back({from[i]});
}

/// About `up_samples` points: of all faces, as many for an object as its share of the area; or of clouds.
std::vector<SurfacePoint> sampled(const SceneSnapshot& scene, bool of_faces) {
    const auto counts = [&](const SceneSnapshot::Object& object) {
        const MeshData& mesh = *object.mesh;
        return of_faces ? !mesh.F.empty() : mesh.F.empty() && mesh.E.empty() && !mesh.V.empty();
    };
    const size_t all = std::max<size_t>(1, size_t(std::ranges::count_if(scene.objects, counts)));
    std::vector<SampledObject> objects;
    double area = 0;
    for (const SceneSnapshot::Object& object : scene.objects) {
        if (!counts(object)) continue;
        objects.push_back(sampled(object, std::max<size_t>(256, up_samples / all)));
        area += objects.back().area;
    }
    std::vector<SurfacePoint> points;
    for (const SampledObject& object : objects) {
        const double share = area > 0 ? object.area / area : 0;
        const auto count = size_t(std::ceil(share * double(up_samples)));
        of_faces ? spread(object, count, points) : thin_out(object.points, count, points);
    }
    return points;
}

/// The box of all but a five hundredth of the points at either end of each axis.
Box3d bulk_of(const std::vector<SurfacePoint>& points) {
    Box3d box(Vec3d::Zero().eval());
    std::vector<double> values(points.size());
    const size_t low = points.size() / 500, high = points.size() - 1 - low;
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::transform(points, values.begin(),
                               [&](const SurfacePoint& point) { return point.position[axis]; });
        std::nth_element(values.begin(), values.begin() + long(low), values.end());
        box.min()[axis] = values[low];
        std::nth_element(values.begin(), values.begin() + long(high), values.end());
        box.max()[axis] = values[high];
    }
    return box;
}

/// What the content looks like along an axis.
struct AxisEvidence {
    double level = 0;   ///< part of the content's planes that is perpendicular to the axis
    double extent = 0;  ///< of the content, of its largest extent
    std::array<double, slab_count> slabs{};  ///< the part of `level` in each slab along the axis
    std::array<double, slab_count> mass{};   ///< part of all samples in each
    double thin = 0;    ///< part of the samples in columns along the axis that hold a thin layer
    double filled = 0;  ///< part of the columns over the rectangle of the content that hold samples

    double least_end() const { return *std::max_element(slabs.begin(), slabs.begin() + end_slabs); }
    /// The slab with the most level planes.
    size_t peak() const { return size_t(std::ranges::max_element(slabs) - slabs.begin()); }
    double mass_above(size_t slab) const {
        return std::accumulate(mass.begin() + long(slab) + 1, mass.end(), 0.0);
    }
    double mass_below(size_t slab) const {
        return std::accumulate(mass.begin(), mass.begin() + long(slab), 0.0);
    }
};
using UpEvidence = std::array<AxisEvidence, 3>;

/// A piece of a surface, and along which axes it is level: to about 10 degrees.
struct Plane {
    Vec3d centre;
    std::array<bool, 3> level;
};

Plane plane_of(const SurfacePoint& point) {
    constexpr double steep = 0.985;
    Plane plane{point.position, {}};
    for (int axis = 0; axis < 3; ++axis) plane.level[size_t(axis)] = std::abs(point.normal[axis]) > steep;
    return plane;
}

/// The points of one cell of a grid, as a patch of a surface.
struct Patch {
    Vec3d centre;
    Mat3d covariance;

    /// Variance across the patch; with the eigenvalues a << b, c of the covariance, det / minors is a, and
    /// minors / trace is b c / (b + c).
    double thickness() const { return covariance.determinant() / minors(); }
    bool is_planar() const {
        const double trace = covariance.trace();
        return minors() > 0.08 * trace * trace && thickness() < 0.05 * minors() / trace;
    }
    /// Within about 10 degrees.
    bool is_level(int axis) const {
        const double along = covariance(axis, axis);
        return along < 0.015 * (covariance.trace() - along) + thickness();
    }

  private:
    double minors() const {
        const Mat3d& c = covariance;
        return c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1) + c(0, 0) * c(2, 2) - c(0, 2) * c(0, 2) +
               c(1, 1) * c(2, 2) - c(1, 2) * c(1, 2);
    }
};

Patch patch_of(const std::vector<SurfacePoint>& points, const std::vector<std::pair<uint64_t, size_t>>& order,
               size_t begin, size_t end) {
    Patch patch{Vec3d::Zero(), Mat3d::Zero()};
    for (size_t i = begin; i < end; ++i) patch.centre += points[order[i].second].position;
    patch.centre /= double(end - begin);
    for (size_t i = begin; i < end; ++i) {
        const Vec3d from = points[order[i].second].position - patch.centre;
        patch.covariance += from * from.transpose();
    }
    patch.covariance /= double(end - begin);
    return patch;
}

Plane plane_of(const Patch& patch) {
    return {patch.centre, {patch.is_level(0), patch.is_level(1), patch.is_level(2)}};
}

/// Of the grids of samples: their cells along the longest side hold about 16 samples of a surface.
double cells_for(size_t samples) {
    return std::clamp(std::sqrt(double(samples) / 16), 8.0, 64.0);
}

/// Of clouds: what is planar in a grid whose cells hold about ten points of a surface.
std::vector<Plane> planes_of_cells(const std::vector<SurfacePoint>& points, const Box3d& bulk) {
    constexpr size_t least_points = 5;
    const double size = bulk.diagonal().norm() / cells_for(points.size());
    std::vector<std::pair<uint64_t, size_t>> order;
    for (size_t i = 0; i < points.size(); ++i) {
        const Vec3d& position = points[i].position;
        if (!bulk.contains(position)) continue;
        uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis)
            key = key << 16 | uint64_t((position[axis] - bulk.min()[axis]) / size);
        order.emplace_back(key, i);
    }
    std::ranges::sort(order);
    std::vector<Plane> planes;
    for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && order[end].first == order[begin].first) ++end;
        if (end - begin < least_points) continue;
        const Patch patch = patch_of(points, order, begin, end);
        if (patch.is_planar()) planes.push_back(plane_of(patch));
    }
    return planes;
}

std::vector<Plane> planes_of_faces(const std::vector<SurfacePoint>& points) {
    std::vector<Plane> planes;
    for (const SurfacePoint& point : points) planes.push_back(plane_of(point));
    return planes;
}

size_t slab_at(const Box3d& bulk, int axis, const Vec3d& point) {
    const double at = (point[axis] - bulk.min()[axis]) / bulk.sizes()[axis] * double(slab_count);
    return at > 0 ? std::min(slab_count - 1, size_t(at)) : 0;
}

/// What samples are in a column of a grid, and how high.
struct Column {
    size_t count = 0;
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
};

/// Of the samples within the bulk the heights along an axis, in the columns of a grid over the other axes.
std::vector<Column> columns_along(int axis, const std::vector<SurfacePoint>& points, const Box3d& bulk,
                                  double size) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto cells = [&](int across) {
        return std::max<size_t>(1, size_t(std::ceil(bulk.sizes()[across] / size - 1e-6)));
    };
    const size_t along_u = cells(u), along_v = cells(v);
    const auto cell = [&](const Vec3d& position, int across, size_t count) {
        return std::min(count - 1, size_t((position[across] - bulk.min()[across]) / size));
    };
    std::vector<Column> columns(along_u * along_v);
    for (const SurfacePoint& point : points) {
        if (!bulk.contains(point.position)) continue;
        const double height = point.position[axis];
        Column& column =
            columns[cell(point.position, u, along_u) * along_v + cell(point.position, v, along_v)];
        ++column.count;
        column.low = std::min(column.low, height);
        column.high = std::max(column.high, height);
    }
    return columns;
}

/// A layer is thin where it rises by less than three cells, 72 degrees, and a third of the content's height.
double thin_part(int axis, const std::vector<SurfacePoint>& points, const Box3d& bulk) {
    constexpr size_t least_points = 5;
    const double side = std::max(bulk.sizes()[(axis + 1) % 3], bulk.sizes()[(axis + 2) % 3]);
    const double size = side / cells_for(points.size());
    const double most = std::min(3 * size, bulk.sizes()[axis] / 3);
    size_t thin = 0, all = 0;
    for (const Column& column : columns_along(axis, points, bulk, size)) {
        if (column.count < least_points) continue;
        all += column.count;
        if (column.high - column.low <= most) thin += column.count;
    }
    return double(thin) / double(std::max<size_t>(1, all));
}

double filled_part(int axis, const std::vector<SurfacePoint>& points, const Box3d& bulk) {
    constexpr double cells = 16;
    const double side = std::max(bulk.sizes()[(axis + 1) % 3], bulk.sizes()[(axis + 2) % 3]);
    const std::vector<Column> columns = columns_along(axis, points, bulk, side / cells);
    const auto filled = std::ranges::count_if(columns, [](const Column& column) { return column.count > 0; });
    return double(filled) / double(columns.size());
}

/// Nothing where the content is too small or flat, or has too few planes to judge by.
std::optional<UpEvidence> evidence_of(const std::vector<SurfacePoint>& points, bool of_faces) {
    constexpr double flat = 0.03;
    constexpr size_t least_planes = 60;
    if (points.size() < least_up_samples) return {};
    const Box3d bulk = bulk_of(points);
    if (!(bulk.sizes().minCoeff() > flat * bulk.sizes().maxCoeff())) return {};
    const std::vector<Plane> planes = of_faces ? planes_of_faces(points) : planes_of_cells(points, bulk);
    if (planes.size() < least_planes) return {};
    UpEvidence evidence;
    for (int axis = 0; axis < 3; ++axis) {
        AxisEvidence& of = evidence[size_t(axis)];
        of.extent = bulk.sizes()[axis] / bulk.sizes().maxCoeff();
        for (const SurfacePoint& point : points)
            of.mass[slab_at(bulk, axis, point.position)] += 1 / double(points.size());
        for (const Plane& plane : planes)
            if (plane.level[size_t(axis)])
                of.slabs[slab_at(bulk, axis, plane.centre)] += 1 / double(planes.size());
        of.level = std::accumulate(of.slabs.begin(), of.slabs.end(), 0.0);
        of.thin = thin_part(axis, points, bulk);
        of.filled = filled_part(axis, points, bulk);
    }
    return evidence;
}

/// A sampled part of the content that is beyond the ground, as noise is.
constexpr double stray = 0.03;

/// Whether a plane lies at the upper end, with nothing like it below: the content hangs from it.
bool hangs(const AxisEvidence& axis) {
    const size_t peak = axis.peak();
    return peak >= slab_count - end_slabs && axis.mass_above(peak) <= stray &&
           axis.slabs[peak] >= 3 * axis.least_end();
}

bool stands(const AxisEvidence& axis) {
    const size_t peak = axis.peak();
    return peak < end_slabs && axis.mass_below(peak) <= stray;
}

/// Thin along z over a rectangle, without gaps along z: sheets one behind the other are none. Tells height
/// fields of points that are on no grid.
bool is_thin_layer(const UpEvidence& evidence) {
    constexpr double least_thin = 0.9, most_thin_beside = 0.5, least_filled = 0.95;
    const AxisEvidence &x = evidence[0], &y = evidence[1], &z = evidence[2];
    const auto empty_slabs = std::ranges::count(z.mass, 0.0);
    return z.thin >= least_thin && std::max(x.thin, y.thin) <= most_thin_beside && z.filled >= least_filled &&
           empty_slabs <= 2;
}

/// Scans have floors, terraces and ground. The axis of most level surfaces is up where it is clearly one.
std::string up_of_cloud(const UpEvidence& evidence) {
    constexpr double least_level = 0.15, clear = 1.5;
    for (const int axis : {2, 1, 0}) {
        const AxisEvidence& of = evidence[size_t(axis)];
        double others = 0;
        for (const int other : {(axis + 1) % 3, (axis + 2) % 3})
            others = std::max(others, evidence[size_t(other)].level);
        if (of.level < least_level || of.level < clear * others) continue;
        if (axis == 0 && !stands(of) && !hangs(of)) continue;  // as a wall that faces x
        return std::string(1, hangs(of) ? '-' : '+') + "xyz"[axis];
    }
    return "+y";
}

/// Meshes are mostly modelled with +y up, and many have flat sides. Only +z is inferred, where level surfaces
/// are few along y, and the content stands on one.
std::string up_of_mesh(const UpEvidence& evidence) {
    constexpr double least_base = 0.03, clear = 2.5, most_level = 0.8, least_height = 0.5;
    const AxisEvidence &x = evidence[0], &y = evidence[1], &z = evidence[2];
    const double base = z.slabs.front();
    const double other_ends =
        std::max({x.slabs.front(), x.slabs.back(), y.slabs.front(), y.slabs.back(), z.slabs.back()});
    if (z.extent < least_height || z.level > most_level)
        return "+y";  // a relief, or sheets one behind the other
    const bool is_clear = z.level >= 2 * y.level && z.level >= 1.2 * x.level && base >= clear * other_ends;
    return is_clear && base >= least_base ? "+z" : "+y";
}

/// The axis within 5 degrees of a direction; empty: none.
std::string axis_near(const Vec3d& direction) {
    int axis = 0;
    direction.cwiseAbs().maxCoeff(&axis);
    if (!(std::abs(direction[axis]) > 0.996 * direction.norm())) return {};
    return std::string(1, direction[axis] < 0 ? '-' : '+') + "xyz"[axis];
}

/// What the formats of the objects' files agree on.
std::string up_of_formats(const SceneSnapshot& scene) {
    std::string agreed;
    for (const SceneSnapshot::Object& object : scene.objects) {
        if (object.mesh->up.isZero()) continue;
        const std::string own = axis_near(object.T_world_mesh.linear() * object.mesh->up);
        if (own.empty()) continue;
        if (!agreed.empty() && agreed != own) return "+y";
        agreed = own;
    }
    return agreed;
}

}  // namespace

std::string inferred_up(const SceneSnapshot& scene) {
    if (const std::string agreed = up_of_formats(scene); !agreed.empty()) return agreed;
    if (is_height_field(scene)) return "+z";
    const bool has_faces = std::ranges::any_of(
        scene.objects, [](const SceneSnapshot::Object& object) { return !object.mesh->F.empty(); });
    const auto evidence = evidence_of(sampled(scene, has_faces), has_faces);
    if (!evidence) return "+y";
    if (is_thin_layer(*evidence)) return "+z";
    return has_faces ? up_of_mesh(*evidence) : up_of_cloud(*evidence);
}

}  // namespace easypbr::detail
