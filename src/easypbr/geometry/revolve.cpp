#include "easypbr/geometry/revolve.h"

namespace easypbr::geometry {
namespace {

bool same_place(const ProfilePoint& a, const ProfilePoint& b) {
    return a.radius == b.radius && a.y == b.y;
}

/// Two triangles per quad, one beside the axis. Columns run to the right, rows down, seen from outside.
Array3i::Dense faces_of(const std::vector<ProfilePoint>& profile, int segments) {
    std::vector<std::array<int32_t, 3>> faces;
    for (size_t ring = 0; ring + 1 < profile.size(); ++ring) {
        if (same_place(profile[ring], profile[ring + 1])) continue;
        const bool starts_at_axis = profile[ring].radius == 0, ends_at_axis = profile[ring + 1].radius == 0;
        for (int segment = 0; segment < segments; ++segment) {
            const int a = int(ring) * (segments + 1) + segment, b = a + 1, c = a + segments + 1, d = c + 1;
            if (!ends_at_axis) faces.push_back({a, c, d});
            if (!starts_at_axis) faces.push_back(ends_at_axis ? std::array{a, c, b} : std::array{a, d, b});
        }
    }
    return Eigen::Map<const Array3i::Dense>(faces.data()->data(), Eigen::Index(faces.size()), 3);
}

}  // namespace

void set_v_by_length(std::vector<ProfilePoint>& profile) {
    double length = 0;
    for (size_t i = 1; i < profile.size(); ++i) {
        length += std::hypot(profile[i].radius - profile[i - 1].radius, profile[i].y - profile[i - 1].y);
        profile[i].v = length;
    }
    for (ProfilePoint& point : profile) point.v = 1 - point.v / length;
}

MeshData revolve(const std::string& name, const std::vector<ProfilePoint>& profile, int segments) {
    const Eigen::Index count = Eigen::Index(profile.size()) * (segments + 1);
    Array3f::Dense V(count, 3), N(count, 3);
    Array2f::Dense UV(count, 2);
    Eigen::Index row = 0;
    for (const ProfilePoint& point : profile) {
        const double shift = point.radius == 0 ? 0.5 : 0;
        for (int segment = 0; segment <= segments; ++segment, ++row) {
            // The last column is where the first one is, to the last bit, so that the surface is closed.
            const double phi = 2 * pi * (segment % segments + shift) / segments;
            const Vec3d outwards(std::sin(phi), 0, std::cos(phi));
            V.row(row) = (point.radius * outwards + point.y * Vec3d::UnitY()).cast<float>().transpose();
            N.row(row) =
                (point.normal.x() * outwards + point.normal.y() * Vec3d::UnitY()).cast<float>().transpose();
            UV.row(row) << float((segment + shift) / segments), float(point.v);
        }
    }
    MeshData data;
    data.name = name;
    data.V = std::move(V);
    data.N = std::move(N);
    data.UV = std::move(UV);
    data.F = faces_of(profile, segments);
    return data;
}

}  // namespace easypbr::geometry
