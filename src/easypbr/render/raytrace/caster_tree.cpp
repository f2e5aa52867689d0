#include "easypbr/render/raytrace/caster_tree.h"

#include <algorithm>
#include <array>
#include <utility>

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/facing.h"

namespace easypbr::render {

Eigen::Affine3d CasterTree::placed(const DrawItem& item) const {
    return Eigen::Affine3d(from_world * item.object->T_world_mesh);
}

void CasterTree::attach(const embree::Geometry& geometry, RayElement given) {
    RayElement& element = *elements.emplace_back(std::make_unique<RayElement>(std::move(given)));
    const DrawItem& item = *element.item;
    element.unit = float(1 / world_scale);
    element.world_from_normals = item.object->T_world_mesh.linear().inverse().transpose().cast<float>();
    if (element.faces > 0 && item.material.transmits()) set_winding(element);
    rtcSetGeometryUserData(geometry.get(), &element);
    calls_back |= is_filtered(item) || element.gaussians;
    if (is_filtered(item) && !element.gaussians) {
        rtcSetGeometryIntersectFilterFunction(geometry.get(), filter);
        rtcSetGeometryOccludedFilterFunction(geometry.get(), filter);
    }
    tree.attach(geometry, unsigned(elements.size() - 1));
}

void CasterTree::set_winding(RayElement& element) {
    const DrawItem& item = *element.item;
    const auto [found, is_new] = windings.try_emplace(item.object, gpu::Winding::unknown);
    if (is_new) found->second = gpu::winding_of(item.mesh().V, item.mesh().F);
    const bool is_mirrored = item.object->T_world_mesh.linear().determinant() < 0;
    element.is_closed = found->second == gpu::Winding::outward || found->second == gpu::Winding::inward;
    element.is_open = found->second == gpu::Winding::open;
    element.outwards = (found->second == gpu::Winding::inward) != is_mirrored ? -1.0f : 1.0f;
}

const std::vector<Vec3>& CasterTree::vertices_of(const DrawItem& item, const Eigen::Affine3d& T) {
    std::vector<Vec3>& V = vertices[item.object];
    if (!V.empty()) return V;
    const MeshData& mesh = item.mesh();
    V.resize(size_t(mesh.V.rows()) + 1);  // Embree reads whole vectors of four.
    parallel_for(size_t(mesh.V.rows()), 1 << 14, [&](size_t i) {
        V[i] = (T * Vec3d(mesh.V.row(Eigen::Index(i)).transpose().cast<double>())).cast<float>();
    });
    return V;
}

void CasterTree::add_faces(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    const embree::Geometry geometry = tree.make(RTC_GEOMETRY_TYPE_TRIANGLE);
    const auto& V = vertices_of(item, placed(item));
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, V.data(), 0,
                               sizeof(Vec3), size_t(mesh.V.rows()));
    const auto F = tree.buffer<std::array<uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                                        size_t(item.part.face_count));
    for (size_t i = 0; i < F.size(); ++i)
        for (int c = 0; c < 3; ++c)
            F[i][size_t(c)] = uint32_t(mesh.F(item.part.first_face + Eigen::Index(i), c));
    attach(geometry, {&item, item.part.first_face, 1, int(F.size()), &V});
}

void CasterTree::add_discs(const DrawItem& item, double world_radius) {
    const MeshData& mesh = item.mesh();
    const Eigen::Affine3d T = placed(item);
    const auto radius = float(world_radius * world_scale);
    const bool oriented = !mesh.N.empty();
    const embree::Geometry geometry =
        tree.make(oriented ? RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT : RTC_GEOMETRY_TYPE_DISC_POINT);
    const auto V = tree.buffer<std::array<float, 4>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                                     size_t(mesh.V.rows()));
    for (size_t i = 0; i < V.size(); ++i) {
        const Vec3 p = (T * Vec3d(mesh.V.row(Eigen::Index(i)).transpose().cast<double>())).cast<float>();
        V[i] = {p.x(), p.y(), p.z(), radius};
    }
    if (oriented) {
        const auto N = tree.buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3,
                                                         size_t(mesh.V.rows()));
        const Mat3 normal_matrix = T.linear().inverse().transpose().cast<float>();
        for (size_t i = 0; i < N.size(); ++i) {
            const Vec3 n = (normal_matrix * mesh.N.row(Eigen::Index(i)).transpose()).normalized();
            N[i] = {n.x(), n.y(), n.z()};
        }
    }
    attach(geometry, {&item});
}

void CasterTree::add_polygons(const DrawItem& item, int corners,
                              const std::function<void(Eigen::Index, std::span<Vec3d>)>& polygon) {
    const Eigen::Affine3d T = placed(item);
    const auto count = size_t(item.mesh().V.rows()), n = size_t(corners), triangles = n - 2;
    const embree::Geometry geometry = tree.make(RTC_GEOMETRY_TYPE_TRIANGLE);
    const auto V =
        tree.buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, count * n);
    const auto F = tree.buffer<std::array<uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                                        count * triangles);
    RayElement element{&item, 0, int(triangles)};
    element.reaches.resize(count);
    parallel_for(count, 1 << 10, [&](size_t i) {
        std::array<Vec3d, size_t(most_corners)> places;
        polygon(Eigen::Index(i), std::span(places.data(), n));
        const Vec3d vertex = item.mesh().V.row(Eigen::Index(i)).transpose().cast<double>();
        for (size_t c = 0; c < n; ++c) {
            const Vec3 p = (T * places[c]).cast<float>();
            V[i * n + c] = {p.x(), p.y(), p.z()};
            const auto reach = float((T.linear() * (places[c] - vertex)).norm());
            element.reaches[i] = std::max(element.reaches[i], reach);
        }
        const auto first = uint32_t(i * n);
        for (uint32_t c = 0; c < triangles; ++c) F[i * triangles + c] = {first, first + c + 1, first + c + 2};
    });
    attach(geometry, std::move(element));
}

void CasterTree::add_gaussians(const DrawItem& item,
                               const std::function<RayGaussian(Eigen::Index)>& gaussian) {
    const Eigen::Affine3d T = placed(item);
    const auto count = size_t(item.mesh().V.rows());
    RayGaussians& set = *gaussians.emplace_back(std::make_unique<RayGaussians>(count));
    parallel_for(count, 1 << 12, [&](size_t i) { set.set(i, gaussian(Eigen::Index(i)), T); });
    const embree::Geometry geometry = tree.make(RTC_GEOMETRY_TYPE_USER);
    tree.set_own(geometry, {unsigned(count), bound_gaussian, meet_gaussian, occlude_by_gaussian});
    attach(geometry, {.item = &item, .gaussians = &set});
}

}  // namespace easypbr::render
