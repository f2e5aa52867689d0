#include "easypbr/render/frame.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "easypbr/gl/context.h"

namespace easypbr::render {
namespace {

double halton(int index, int base) {
    double value = 0, scale = 1;
    for (int i = index; i > 0; i /= base) {
        scale /= base;
        value += scale * (i % base);
    }
    return value;
}

/// Screen rectangle of the bounds' corners, one pixel of margin; the whole picture when a corner is behind
/// the camera.
PixelRect covered_rect(const Box3d& bounds, const Mat4d& clip_from_world, Vec2i size) {
    if (bounds.isEmpty()) return {};
    Eigen::AlignedBox2d box;
    for (int i = 0; i < 8; ++i) {
        const Vec3d corner = bounds.corner(Box3d::CornerType(i));
        const Eigen::Vector4d clip = clip_from_world * corner.homogeneous();
        if (!(clip.w() > 0)) return {0, 0, size.x(), size.y()};
        box.extend(Vec2d((clip.x() / clip.w() + 1) / 2 * size.x(), (1 - clip.y() / clip.w()) / 2 * size.y()));
    }
    const auto pixel = [](double v, int limit) { return int(std::clamp(v, 0.0, double(limit))); };
    const int x0 = pixel(std::floor(box.min().x()) - 1, size.x()),
              x1 = pixel(std::ceil(box.max().x()) + 1, size.x());
    const int y0 = pixel(std::floor(box.min().y()) - 1, size.y()),
              y1 = pixel(std::ceil(box.max().y()) + 1, size.y());
    return {x0, y0, x1 - x0, y1 - y0};
}

}  // namespace

Vec2d jitter_of(int index, int count) {
    Vec2d mean(0, 0);
    for (int i = 1; i <= count; ++i) mean += Vec2d(halton(i, 2), halton(i, 3)) / count;
    return Vec2d(halton(index + 1, 2), halton(index + 1, 3)) - mean;
}

void prepare_frame(Frame& frame, const Box3d& bounds, bool reaches_beyond) {
    const Camera& camera = frame.camera;
    frame.clip_from_view = camera.projection_matrix(double(frame.size.x()) / frame.size.y());
    frame.covered = reaches_beyond ? PixelRect{0, 0, frame.size.x(), frame.size.y()}
                                   : covered_rect(bounds, frame.clip_from_view * camera.view(), frame.size);
    // Moving the picture by (dx, dy) pixels moves ndc by (2 dx / w, -2 dy / h): row 0 is the top.
    const Vec2d offset = jitter_of(frame.sample_index, frame.sample_count);
    const Vec2d ndc(2 * offset.x() / frame.size.x(), -2 * offset.y() / frame.size.y());
    Mat4d shift = Mat4d::Identity();
    shift(0, 3) = ndc.x();
    shift(1, 3) = ndc.y();
    frame.clip_from_view = shift * frame.clip_from_view;
}

void set_camera_uniforms(const gl::Program& program, const Frame& frame) {
    const Mat4d& p = frame.clip_from_view;
    const Camera& camera = frame.camera;
    const Vec2 shift =
        frame.orthographic() ? Vec2(float(-p(0, 3)), float(-p(1, 3))) : Vec2(float(p(0, 2)), float(p(1, 2)));
    program.set("u_size", Vec2(frame.size.cast<float>()));
    program.set("u_unproject", Vec4(float(1 / p(0, 0)), float(1 / p(1, 1)), shift.x(), shift.y()));
    program.set("u_depth", Vec3(float(camera.near), float(camera.far), frame.orthographic() ? 1.0f : 0.0f));
    program.set("u_world_from_view", Mat3(camera.T_world_cam.linear().cast<float>()));
}

std::vector<std::string> camera_defines(const Frame& frame) {
    return frame.orthographic() ? std::vector<std::string>{"ORTHOGRAPHIC"} : std::vector<std::string>{};
}

void test_geometry_depth(const Frame& frame) {
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(frame.peel && frame.peel->farthest ? GL_LESS : GL_GREATER);
}

void set_peel_uniforms(const gl::Program& program, const Peel& peel, unsigned unit) {
    program.set("u_peel_limit", int(unit));
    program.set("u_peel_mode", peel.backs ? -1.0f : peel.first ? 1.0f : 0.0f);
    peel.limit->bind(unit);
}

void draw_screen_triangle() {
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace easypbr::render
