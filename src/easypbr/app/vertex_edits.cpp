#include "easypbr/app/vertex_edits.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {
namespace {

/// Of the box of the object's vertices: the largest ball.
constexpr double largest_ball = 0.5;

/// Where vertices are in the world, in the scene's frame.
Eigen::Affine3d world_from_vertices(const Scene& scene, const std::string& name) {
    const SceneSnapshot snapshot = scene.snapshot();
    const auto object = std::ranges::find(snapshot.objects, name, &SceneSnapshot::Object::name);
    if (object == snapshot.objects.end()) throw ArgumentError(fmt::format("'{}' is hidden", name));
    return object->T_world_mesh;
}

int32_t picked_vertex(LiveDrawing& live, const MeshData& mesh) {
    const Selection& selection = live.selection();
    if (!selection.picked || selection.picked->object != selection.object || selection.picked->is_face)
        throw ArgumentError("click a splat or a point of the object first");
    const int element = selection.picked->element;
    if (element < 0 || element >= mesh.V.rows())
        throw ArgumentError(fmt::format("'{}' has changed since it was clicked", selection.object));
    return element;
}

Box3d clip_box_of(const Settings& settings) {
    const std::vector<double>& box = settings.clip.box;
    if (box.size() != 6) throw ArgumentError("clip.box is not set: it is the box that counts");
    return {Vec3d(box[0], box[1], box[2]), Vec3d(box[3], box[4], box[5])};
}

/// 1 for the vertices of the filter's shape.
std::vector<char> in_shape(LiveDrawing& live, const MeshData& mesh, const VertexFilter& filter) {
    std::vector<char> flags(size_t(mesh.V.rows()), 0);
    const auto place = [&](size_t i) {
        return Vec3d(mesh.V.row(Eigen::Index(i)).transpose().cast<double>());
    };
    using Shape = VertexFilter::Shape;
    if (filter.shape == Shape::picked) {
        flags[size_t(picked_vertex(live, mesh))] = 1;
    } else if (filter.shape == Shape::ball) {
        const Vec3d center = place(size_t(picked_vertex(live, mesh)));
        for (size_t i = 0; i < flags.size(); ++i) flags[i] = (place(i) - center).norm() <= filter.radius;
    } else if (filter.shape == Shape::clip_box) {
        const Box3d box = clip_box_of(live.session().settings());
        const Eigen::Affine3d world = world_from_vertices(live.session().scene(), live.selection().object);
        for (size_t i = 0; i < flags.size(); ++i) flags[i] = box.contains(world * place(i));
    } else {
        if (mesh.splats.empty()) throw ArgumentError("opacities are those of splats: the object has none");
        for (size_t i = 0; i < flags.size(); ++i)
            flags[i] = double(mesh.splats.opacities(Eigen::Index(i))) < filter.opacity;
    }
    return flags;
}

}  // namespace

bool has_loose_vertices(const MeshData& mesh) {
    return !mesh.V.empty() && mesh.F.empty() && mesh.E.empty();
}

void remove_vertices(LiveDrawing& live, const VertexFilter& filter) {
    const std::string name = live.selection().object;
    const std::optional<Mesh> node = node_named(live.session().scene(), name);
    if (!node) throw ArgumentError("no object is selected");
    const auto data = node->snapshot();
    if (!has_loose_vertices(*data))
        throw ArgumentError(fmt::format("'{}': vertices are removed of clouds and splats alone", name));
    const std::vector<char> flags = in_shape(live, *data, filter);
    std::vector<int32_t> rows;
    for (size_t i = 0; i < flags.size(); ++i)
        if (bool(flags[i]) == filter.keeps) rows.push_back(int32_t(i));
    if (rows.empty()) throw ArgumentError(fmt::format("no vertex of '{}' would stay", name));
    if (rows.size() == flags.size()) return;
    live.edits().change_data(name, [&](MeshData& mesh) { choose_vertex_rows(mesh, rows); });
    live.selection().picked.reset();
}

namespace {

void filter_button(Widgets& ui, LiveDrawing& live, const char* name, const VertexFilter& filter) {
    if (!ui.button(name)) return;
    try {
        remove_vertices(live, filter);
    } catch (const Error& error) {
        live.notifications().add(error.what(), true);
    }
}

double extent_of(const MeshData& mesh) {
    return double((mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).maxCoeff());
}

}  // namespace

void vertex_tool(Widgets& ui, LiveDrawing& live) {
    const std::optional<Mesh> node = node_named(live.session().scene(), live.selection().object);
    if (!node) return;
    const auto data = node->snapshot();
    if (!has_loose_vertices(*data) || !ui.section("Remove", false)) return;
    using Shape = VertexFilter::Shape;
    VertexFilter& form = live.vertex_filter();
    const auto& picked = live.selection().picked;
    if (picked && picked->object == live.selection().object && !picked->is_face) {
        ui.text(fmt::format("{} {} was clicked", data->splats.empty() ? "point" : "splat", picked->element));
        const double most = std::max(largest_ball * extent_of(*data), 1e-30);
        if (!(form.radius > 0) || form.radius > most) form.radius = most / 10;
        ui.slider("radius", form.radius, 0, most);
        filter_button(ui, live, "Remove it", {Shape::picked});
        filter_button(ui, live, "Remove around it", {Shape::ball, false, form.radius});
        ui.same_line();
        filter_button(ui, live, "Keep around it", {Shape::ball, true, form.radius});
    } else {
        ui.text("Click a splat or a point.");
    }
    if (!live.session().settings().clip.box.empty()) {
        filter_button(ui, live, "Remove in the clip box", {Shape::clip_box, false});
        filter_button(ui, live, "Keep in the clip box", {Shape::clip_box, true});
    }
    if (data->splats.empty()) return;
    ui.slider("least opacity", form.opacity, 0, 1);
    filter_button(ui, live, "Remove the fainter", {Shape::faint, false, 0, form.opacity});
}

}  // namespace easypbr::app
