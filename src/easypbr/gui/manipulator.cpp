// Handles drawn over the picture that move, turn and scale what is selected.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "easypbr/app/view_point.h"
#include "easypbr/core/error.h"
#include "easypbr/gui/panels.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::gui {
namespace {

constexpr ImU32 axis_colors[3] = {IM_COL32(230, 80, 75, 255), IM_COL32(110, 190, 70, 255),
                                  IM_COL32(75, 130, 240, 255)};
constexpr ImU32 hot_color = IM_COL32(255, 215, 80, 255);
constexpr float length_pixels = 90, grab_pixels = 8;
constexpr int ring_points = 64;

/// What the handles act on: where they stand, and how a change of the world is applied to it.
struct Subject {
    Vec3d centre{0, 0, 0};
    std::function<void(const Eigen::Affine3d& change)> apply;  ///< of what it was when the drag began
    std::function<void()> revert;                              ///< to what it was
    bool only_moves = false;
};

struct View {
    Camera camera;
    Vec2i size;

    std::optional<ImVec2> project(const Vec3d& point) const {
        const Vec3d p = pixel_of(camera, point, size);
        if (camera.projection == Projection::perspective && p.z() <= camera.near) return {};
        return ImVec2(float(p.x()), float(p.y()));
    }
    /// World length of a number of pixels at a point.
    double length_of(float pixels, const Vec3d& at) const {
        const double depth = pixel_of(camera, at, size).z();
        const Vec3d a = point_at(camera, {0, 0}, size, depth);
        return (point_at(camera, {double(pixels), 0}, size, depth) - a).norm();
    }
};

float distance_to_segment(Vec2 p, ImVec2 a, ImVec2 b) {
    const Vec2 ab(b.x - a.x, b.y - a.y), ap(p.x() - a.x, p.y() - a.y);
    const float t = std::clamp(ap.dot(ab) / std::max(ab.squaredNorm(), 1e-6f), 0.0f, 1.0f);
    return (ap - t * ab).norm();
}

/// The part of the world that a node's pose acts in.
Eigen::Affine3d parent_pose(const Scene& scene, const std::string& name) {
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    for (size_t at = name.find('/'); at != name.npos; at = name.find('/', at + 1))
        if (const auto node = app::node_named(scene, name.substr(0, at))) T = T * node->T_parent_mesh();
    return T;
}

Box3d bounds_of(const SceneSnapshot& scene, const std::string& name) {
    SceneSnapshot part = scene;
    std::erase_if(part.objects, [&](const SceneSnapshot::Object& object) {
        return object.name != name && !object.name.starts_with(name + "/");
    });
    return part.bounds();
}

std::optional<Subject> selected_object(GuiState& state) {
    const Scene& scene = state.session().scene();
    const std::optional<Mesh> node = app::node_named(scene, state.selection().object);
    if (!node) return {};
    const Box3d box = bounds_of(scene.snapshot(), state.selection().object);
    if (box.isEmpty()) return {};
    Subject subject;
    subject.centre = box.center();
    const Eigen::Affine3d parent = parent_pose(scene, state.selection().object), own = node->T_parent_mesh();
    subject.revert = [&state, name = state.selection().object, mesh = *node, own]() mutable {
        state.live.edits().will_move(name);
        mesh.set_T_parent_mesh(own);
    };
    subject.apply = [&state, name = state.selection().object, mesh = *node, parent,
                     own](const Eigen::Affine3d& change) mutable {
        state.live.edits().will_move(name);
        mesh.set_T_parent_mesh(parent.inverse(Eigen::Affine) * change * parent * own);
    };
    return subject;
}

std::optional<Subject> selected_light(GuiState& state) {
    Subject subject;
    subject.only_moves = true;
    if (StudioLight* light = state.selection().light == "key"    ? &state.settings().lights.key
                             : state.selection().light == "fill" ? &state.settings().lights.fill
                             : state.selection().light == "rim"  ? &state.settings().lights.rim
                                                                 : nullptr) {
        if (!light->position.value()) return {};
        const Vec3d position = *light->position;
        subject.centre = position;
        subject.revert = [light, kept = light->position] { light->position = kept; };
        subject.apply = [light, position](const Eigen::Affine3d& change) {
            light->position = Vec3d(change * position);
        };
        return subject;
    }
    const Scene& scene = state.session().scene();
    const auto names = scene.light_names();
    if (std::ranges::find(names, state.selection().light) == names.end()) return {};
    const Light light = scene.light(state.selection().light);
    subject.centre = light.position;
    subject.revert = [&state, light, name = state.selection().light] {
        state.live.edits().will_change_light(name);
        state.session().scene().set_light(name, light);
    };
    subject.apply = [&state, light, name = state.selection().light](const Eigen::Affine3d& change) {
        Light moved = light;
        moved.position = change * light.position;
        state.live.edits().will_change_light(name);
        state.session().scene().set_light(name, moved);
    };
    return subject;
}

/// The handles of what is selected, as they are seen in the picture that is shown.
struct Handles {
    View view;
    Subject subject;
    Handle handle;
    float scale;  ///< of the screen

    /// On the screen: a line for moving and scaling, a ring for turning.
    std::vector<ImVec2> points(int axis) const {
        const double length = view.length_of(length_pixels * scale, subject.centre);
        std::vector<ImVec2> points;
        const auto add = [&](const Vec3d& point) {
            if (const auto p = view.project(point)) points.push_back(*p);
        };
        if (handle != Handle::turn) {
            add(subject.centre);
            add(subject.centre + length * Vec3d::Unit(axis));
            return points;
        }
        const Vec3d u = Vec3d::Unit((axis + 1) % 3), v = Vec3d::Unit((axis + 2) % 3);
        for (int i = 0; i <= ring_points; ++i) {
            const double angle = 2 * pi * i / ring_points;
            add(subject.centre + length * (std::cos(angle) * u + std::sin(angle) * v));
        }
        return points;
    }
    /// The axis of the handle at a pixel; -1: none.
    int at(Vec2 pixel) const {
        int nearest = -1;
        float least = grab_pixels * scale;
        for (int axis = 0; axis < 3; ++axis) {
            const std::vector<ImVec2> p = points(axis);
            for (size_t i = 0; i + 1 < p.size(); ++i)
                if (const float d = distance_to_segment(pixel, p[i], p[i + 1]); d < least) {
                    least = d;
                    nearest = axis;
                }
        }
        return nearest;
    }
};

/// Nothing while nothing that can be moved is selected.
std::optional<Handles> handles_of(GuiState& state) {
    const auto& resolved = state.live.picture().resolved();
    if (!resolved) return {};
    const bool has_light = !state.selection().light.empty();
    const std::optional<Subject> subject = has_light ? selected_light(state) : selected_object(state);
    if (!subject) return {};
    const Handle handle = subject->only_moves ? Handle::move : state.manipulator.handle;
    return Handles{{resolved->camera, state.screen.size}, *subject, handle, state.screen.scale};
}

Eigen::Affine3d change_of(const View& view, const HandleDrag& drag, Handle handle, Vec2d pointer) {
    const Vec3d axis = Vec3d::Unit(drag.axis);
    const auto centre = view.project(drag.centre);
    Eigen::Affine3d change = Eigen::Affine3d::Identity();
    if (!centre) return change;
    if (handle == Handle::turn) {
        const auto angle = [&](const Vec2d& p) { return std::atan2(p.y() - centre->y, p.x() - centre->x); };
        // Seen against the axis, the screen's clockwise is the axis' own sense.
        const double towards = axis.dot(view.camera.position() - drag.centre) > 0 ? -1 : 1;
        const double turn = towards * (angle(pointer) - angle(drag.from));
        return Eigen::Translation3d(drag.centre) * Eigen::AngleAxisd(turn, axis) *
               Eigen::Translation3d(-drag.centre);
    }
    const double unit = view.length_of(length_pixels, drag.centre);
    const auto end = view.project(drag.centre + unit * axis);
    if (!end) return change;
    const Vec2d line(end->x - centre->x, end->y - centre->y);
    const double steps = (pointer - drag.from).dot(line) / std::max(line.squaredNorm(), 1.0);
    if (handle == Handle::move) {
        change.translation() = steps * unit * axis;
        return change;
    }
    const double factor = std::exp(std::clamp(steps, -6.0, 6.0));
    Vec3d scale = Vec3d::Ones();
    scale[drag.axis] = factor;
    return Eigen::Translation3d(drag.centre) * Eigen::Scaling(scale) * Eigen::Translation3d(-drag.centre);
}

void draw_handle(const std::vector<ImVec2>& points, ImU32 color, Handle handle, float scale) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float width = 2.5f * scale;
    if (handle == Handle::turn) {
        list.AddPolyline(points.data(), int(points.size()), color, 0, width);
        return;
    }
    list.AddLine(points[0], points[1], color, width);
    if (handle == Handle::scale) {
        const float side = 5 * scale;
        list.AddRectFilled(ImVec2(points[1].x - side, points[1].y - side),
                           ImVec2(points[1].x + side, points[1].y + side), color, 1);
        return;
    }
    const Vec2 line(points[1].x - points[0].x, points[1].y - points[0].y);
    if (line.norm() < 1) return;
    const Vec2 along = line.normalized() * 13 * scale, across(-along.y() * 0.45f, along.x() * 0.45f);
    const Vec2 tip(points[1].x + along.x() * 0.3f, points[1].y + along.y() * 0.3f), base = tip - along;
    list.AddTriangleFilled(ImVec2(tip.x(), tip.y()), ImVec2(base.x() + across.x(), base.y() + across.y()),
                           ImVec2(base.x() - across.x(), base.y() - across.y()), color);
}

/// Returns whether there is a handle at the pixel.
bool begin_drag(GuiState& state, Vec2d pixel) {
    const std::optional<Handles> handles = handles_of(state);
    const int axis = handles ? handles->at(pixel.cast<float>()) : -1;
    if (axis < 0) return false;
    const Subject& subject = handles->subject;
    state.manipulator.drag = {axis, pixel, subject.centre, subject.apply, subject.revert};
    return true;
}

}  // namespace

bool drag_handle(GuiState& state, const app::InputEvent& event) {
    using Kind = app::InputEvent::Kind;
    HandleDrag& drag = state.manipulator.drag;
    const bool left = event.button == app::MouseButton::left, drags = drag.axis >= 0;
    if (event.kind == Kind::focus_lost) drag = {};
    if (event.kind == Kind::press && left && !drags)
        return state.panels.shown && begin_drag(state, event.position);
    if (!drags || (event.kind != Kind::move && !(event.kind == Kind::release && left))) return false;
    try {
        const std::optional<Handles> handles = handles_of(state);
        if (handles && drag.apply)
            drag.apply(change_of(handles->view, drag, handles->handle, event.position));
        if (!handles || event.kind == Kind::release) drag = {};
    } catch (const Error& error) {
        state.notify(error.what(), true);
        drag = {};
    }
    return true;
}

bool cancel_drag(GuiState& state) {
    HandleDrag& drag = state.manipulator.drag;
    if (drag.axis < 0) return false;
    try {
        if (drag.revert) drag.revert();
    } catch (const Error& error) {
        state.notify(error.what(), true);
    }
    drag.apply = {};
    drag.revert = {};
    return true;
}

void draw_handles(GuiState& state) {
    HandleDrag& drag = state.manipulator.drag;
    const std::optional<Handles> handles = handles_of(state);
    // A button may come up unseen, in a program's handler or with the focus.
    if (!handles || !ImGui::IsMouseDown(0)) drag = {};
    if (!handles) return;
    const ImVec2 pointer = ImGui::GetIO().MousePos;
    const bool free = !ImGui::GetIO().WantCaptureMouse && ImGui::IsMousePosValid();
    const int hovered = free ? handles->at(Vec2(pointer.x, pointer.y)) : -1;
    const int hot = drag.axis >= 0 ? drag.axis : hovered;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<ImVec2> points = handles->points(axis);
        if (points.size() > 1)
            draw_handle(points, axis == hot ? hot_color : axis_colors[axis], handles->handle,
                        state.screen.scale);
    }
}

}  // namespace easypbr::gui
