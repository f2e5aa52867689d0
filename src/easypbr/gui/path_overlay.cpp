// The camera path over the picture: its curve and its cameras; what lies behind a surface is faint.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "easypbr/app/view_point.h"
#include "easypbr/gui/panels.h"

namespace easypbr::gui {
namespace {

constexpr ImU32 curve_color = IM_COL32(255, 140, 40, 255), key_color = IM_COL32(255, 190, 90, 255),
                chosen_color = IM_COL32(255, 235, 130, 255), present_color = IM_COL32(95, 175, 255, 255);
constexpr int pieces_of_segment = 32, pieces_of_edge = 8;
/// Length of a camera's outline for the curve's extent, and how much farther than a surface a line may lie.
constexpr double outline_part = 0.1, slack = 1.01;
/// No piece is cut nearer than this part of the depth of its farther end: vertices are of single precision,
/// which holds pixels up to a million of them from the picture.
constexpr double least_part_of_depth = 1e-3;

class Overlay {
  public:
    explicit Overlay(const GuiState& state, Camera camera)
        : state_(state), camera_(std::move(camera)), list_(*ImGui::GetBackgroundDrawList()) {}

    /// A straight piece, short enough to be seen or hidden as a whole.
    void piece(Vec3d a, Vec3d b, ImU32 color, float width) const {
        if (!clip(a, b)) return;
        const Vec3d p = pixel_of(camera_, a, state_.screen.size),
                    q = pixel_of(camera_, b, state_.screen.size);
        const Vec3d middle = (p + q) / 2;
        if (is_hidden(middle)) color = (color & ~IM_COL32_A_MASK) | (60u << IM_COL32_A_SHIFT);
        list_.AddLine(ImVec2(float(p.x()), float(p.y())), ImVec2(float(q.x()), float(q.y())), color,
                      width * state_.screen.scale);
    }
    void edge(const Vec3d& a, const Vec3d& b, ImU32 color, float width) const {
        for (int i = 0; i < pieces_of_edge; ++i)
            piece(a + (b - a) * i / pieces_of_edge, a + (b - a) * (i + 1) / pieces_of_edge, color, width);
    }
    /// What a camera at a pose sees, `depth` far.
    void outline(const Eigen::Isometry3d& T_world_cam, double fov_y_deg, double depth, ImU32 color,
                 float width) const {
        const double y = depth * std::tan(radians(fov_y_deg) / 2),
                     x = y * state_.screen.size.x() / state_.screen.size.y();
        std::array<Vec3d, 4> corners = {Vec3d(-x, -y, -depth), Vec3d(x, -y, -depth), Vec3d(x, y, -depth),
                                        Vec3d(-x, y, -depth)};
        for (Vec3d& corner : corners) corner = T_world_cam * corner;
        for (size_t i = 0; i < 4; ++i) {
            edge(T_world_cam.translation(), corners[i], color, width);
            edge(corners[i], corners[(i + 1) % 4], color, width);
        }
        edge(corners[3], T_world_cam * Vec3d(0, 1.4 * y, -depth), color, width);
        edge(corners[2], T_world_cam * Vec3d(0, 1.4 * y, -depth), color, width);
    }

  private:
    double depth_of(const Vec3d& point) const { return (camera_.T_world_cam.inverse() * point).z() * -1; }
    /// Cuts what lies before the near plane or too near to be drawn; false when all of it does.
    bool clip(Vec3d& a, Vec3d& b) const {
        if (camera_.projection != Projection::perspective) return true;
        const double da = depth_of(a), db = depth_of(b);
        const double near = std::max({camera_.near, 1e-9, least_part_of_depth * std::max(da, db)});
        if (da < near && db < near) return false;
        if (da < near) a += (b - a) * (near - da) / (db - da);
        if (db < near) b += (a - b) * (near - db) / (da - db);
        return true;
    }
    bool is_hidden(const Vec3d& pixel) const {
        const app::PickBuffer* surfaces = state_.live.picture().known_surfaces();
        if (!surfaces) return false;
        const auto pick = surfaces->at(pixel.head<2>());
        return pick && pixel.z() > slack * pick->depth;
    }

    const GuiState& state_;
    Camera camera_;
    ImDrawList& list_;
};

double extent_of(const std::vector<Vec3d>& points) {
    Box3d box;
    for (const Vec3d& point : points) box.extend(point);
    return box.isEmpty() ? 0 : box.diagonal().norm();
}

std::vector<Vec3d> curve_of(const CameraPath& path) {
    const int pieces =
        pieces_of_segment * int(std::max<size_t>(path.key_times_s().size(), path.circle() ? 5 : 2) - 1);
    std::vector<Vec3d> points;
    for (int i = 0; i <= pieces; ++i) {
        // The end of a closed path is its start; the last moment before it is near enough.
        const double t = path.duration_s() * (path.is_closed() && i == pieces ? 0 : double(i) / pieces);
        points.push_back(path.pose(t).translation());
    }
    return points;
}

}  // namespace

void draw_path(GuiState& state) {
    const app::PathEditor& path = state.path().editor;
    if (!state.path_panel.shows_path || (path.keys().empty() && !path.path())) return;
    const Camera camera = state.session().view_point(state.screen.size).camera;
    const Overlay overlay(state, camera);
    std::vector<Vec3d> places;
    if (path.path()) places = curve_of(*path.path());
    for (size_t i = 0; i + 1 < places.size(); ++i) overlay.piece(places[i], places[i + 1], curve_color, 2.2f);
    double depth = outline_part * extent_of(places);
    if (depth <= 0) depth = outline_part * state.session().view_point(state.screen.size).distance();
    const double fov = camera.fov_y_deg;
    for (size_t i = 0; i < path.keys().size(); ++i) {
        const CameraKey& key = path.keys()[i];
        const bool chosen = state.path().key == i;
        overlay.outline(key.T_world_cam, key.fov_y_deg.value_or(fov), depth,
                        chosen ? chosen_color : key_color, chosen ? 2.2f : 1.4f);
    }
    if (path.path() && path.time() > 0)
        overlay.outline(path.path()->pose(path.time()), path.path()->fov_y_deg(path.time()).value_or(fov),
                        depth, present_color, 1.8f);
}

}  // namespace easypbr::gui
