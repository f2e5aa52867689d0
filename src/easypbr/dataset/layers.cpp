#include "easypbr/dataset/layers.h"

#include <algorithm>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/element_colors.h"

namespace easypbr::dataset {
namespace {

constexpr size_t grain = 1 << 13;

/// value(pixel) for each pixel that sees something, else `nothing`.
template <class T, class Value>
LayerArray scalars(const Surfaces& s, T nothing, const Value& value) {
    LayerArray layer = make_layer<T>(s.size, 1);
    auto& to = std::get<std::vector<T>>(layer.values);
    parallel_for(to.size(), grain, [&](size_t i) { to[i] = s.covered(i) ? T(value(i)) : nothing; });
    return layer;
}

template <int Channels, class Value>
LayerArray vectors(const Surfaces& s, const Value& value) {
    LayerArray layer = make_layer<float>(s.size, Channels);
    float* to = std::get<std::vector<float>>(layer.values).data();
    parallel_for(s.object.size(), grain, [&](size_t i) {
        if (!s.covered(i)) return;
        const Eigen::Matrix<float, Channels, 1> v = value(i);
        std::copy_n(v.data(), Channels, to + i * Channels);
    });
    return layer;
}

const Instance& instance_at(const Surfaces& s, const InstanceTable& table, size_t i) {
    return table.instances()[table.of(s.object[i] - 1, s.part[i])];
}

/// `of_vertices`: for each object the labels of its vertices, where points of it may be seen.
int semantic_id(const Surfaces& s, const InstanceTable& table, const std::vector<Array1i>& of_vertices,
                size_t i) {
    const MeshData& mesh = s.mesh_of(i);
    const auto element = Eigen::Index(s.element_of(i));
    if (mesh.L.empty()) return instance_at(s, table, i).semantic_id;
    if (!s.on_face(i)) return of_vertices[s.object[i] - 1](element);
    return face_label(mesh, element);
}

LayerArray semantic_ids(const Surfaces& s, const InstanceTable& table) {
    std::vector<Array1i> of_vertices;
    for (size_t o = 0; o < s.scene.objects.size(); ++o) {
        const MeshData& mesh = *s.scene.objects[o].mesh;
        of_vertices.push_back(s.only_faces[o] || mesh.L.empty() ? Array1i() : vertex_labels(mesh));
    }
    return scalars<int32_t>(s, 0, [&](size_t i) { return semantic_id(s, table, of_vertices, i); });
}

Vec2 uv(const Surfaces& s, size_t i) {
    const MeshData& mesh = s.mesh_of(i);
    const auto element = Eigen::Index(s.element_of(i));
    if (mesh.UV.empty()) return {0, 0};
    if (!s.on_face(i)) return element < mesh.UV.rows() ? Vec2(mesh.UV.row(element)) : Vec2(0, 0);
    Vec2 sum(0, 0);
    for (int k = 0; k < 3; ++k) sum += s.barycentrics[i][k] * Vec2(mesh.UV.row(mesh.F(element, k)));
    return sum;
}

LayerArray object_coordinates(const Surfaces& s, const InstanceTable& table) {
    std::vector<Eigen::Affine3d> T_obj_cv;
    std::vector<Box3d> boxes;  // of the coordinates
    const Eigen::Affine3d T_world_cv(s.camera.opencv_T_world_cam());
    for (const Instance& instance : table.instances()) {
        const double diagonal = instance.box.isEmpty() ? 0 : instance.box.diagonal().norm();
        Eigen::Affine3d to_unit = Eigen::Affine3d::Identity();
        const Vec3d centre = instance.box.isEmpty() ? Vec3d(Vec3d::Zero()) : Vec3d(instance.box.center());
        to_unit.translate(Vec3d::Constant(0.5)).scale(diagonal > 0 ? 1 / diagonal : 1).translate(-centre);
        T_obj_cv.push_back(to_unit * inverse_pose(instance.T_world_obj) * T_world_cv);
        const Vec3d half = instance.box.isEmpty() ? Vec3d(Vec3d::Zero())
                                                  : Vec3d((to_unit * instance.box.max()).array() - 0.5);
        boxes.emplace_back(Vec3d(Vec3d::Constant(0.5) - half), Vec3d(Vec3d::Constant(0.5) + half));
    }
    return vectors<3>(s, [&](size_t i) {
        const size_t place = table.of(s.object[i] - 1, s.part[i]);
        Vec3d p = T_obj_cv[place] * s.position[i].cast<double>();
        // What vertices are drawn as reaches beyond the box of their positions.
        if (!s.on_face(i)) p = p.cwiseMax(boxes[place].min()).cwiseMin(boxes[place].max());
        return Vec3(p.cast<float>());
    });
}

/// Channels of a drawn layer, in the picture's pixels.
template <int Channels>
LayerArray picked(const app::Drawn& picture, render::Layer layer, const Surfaces& s,
                  const Mat3& turn = Mat3::Identity()) {
    const Image drawn = app::pick_nearest(picture.layer(layer), picture.lens());
    const float* from = drawn.pixels<float>().data();
    const size_t stride = size_t(drawn.channels());
    return vectors<Channels>(s, [&](size_t i) {
        using Vector = Eigen::Matrix<float, Channels, 1>;
        const Vector v = Eigen::Map<const Vector>(from + i * stride);
        if constexpr (Channels == 3)
            return Vector(turn * v);
        else
            return v;
    });
}

}  // namespace

std::optional<LayerArray> surface_layer(const std::string& name, const Surfaces& s,
                                        const InstanceTable& table) {
    if (name == "depth") return scalars<float>(s, 0, [&](size_t i) { return s.position[i].z(); });
    if (name == "distance") {
        const bool orthographic = s.camera.projection == Projection::orthographic;
        return scalars<float>(
            s, 0, [&](size_t i) { return orthographic ? s.position[i].z() : s.position[i].norm(); });
    }
    if (name == "position") {
        const Eigen::Affine3d T_world_cv(s.camera.opencv_T_world_cam());
        return vectors<3>(
            s, [&](size_t i) { return Vec3((T_world_cv * s.position[i].cast<double>()).cast<float>()); });
    }
    if (name == "instance_id")
        return scalars<int32_t>(s, 0, [&](size_t i) { return instance_at(s, table, i).id; });
    if (name == "semantic_id") return semantic_ids(s, table);
    if (name == "face_id") return scalars<int32_t>(s, -1, [&](size_t i) { return int32_t(s.element_of(i)); });
    if (name == "barycentrics") return vectors<3>(s, [&](size_t i) { return s.barycentrics[i]; });
    if (name == "uv") return vectors<2>(s, [&](size_t i) { return uv(s, i); });
    if (name == "object_coordinates") return object_coordinates(s, table);
    return std::nullopt;
}

std::optional<LayerArray> drawn_layer(const std::string& name, const app::Drawn& drawn, const Surfaces& s) {
    if (name == "normal_world") return picked<3>(drawn, render::Layer::normal_world, s);
    if (name == "normal_camera") {
        const Mat4d T = s.camera.opencv_T_world_cam();
        return picked<3>(drawn, render::Layer::normal_world, s,
                         Mat3(T.topLeftCorner<3, 3>().transpose().cast<float>()));
    }
    if (name == "albedo") return picked<3>(drawn, render::Layer::albedo, s);
    if (name == "roughness") return picked<1>(drawn, render::Layer::roughness, s);
    if (name == "metallic") return picked<1>(drawn, render::Layer::metallic, s);
    return std::nullopt;
}

}  // namespace easypbr::dataset
