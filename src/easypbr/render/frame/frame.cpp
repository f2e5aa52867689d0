#include "easypbr/render/frame/frame.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/recent_values.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/scene/resolve.h"

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

/// A permutation of 0 to count - 1: the rank of a number among all with its digits in this base reversed.
/// Another base than those of the pixel's offsets, so that what a frame samples has nothing to do with where
/// in the pixel it looks.
int rank_of(int index, int count, int base) {
    // Smaller are those with the same last digits, however many, before which stands a smaller one.
    int64_t rank = 0, last_digits = 0, step = 1;
    for (int64_t rest = index; step < count; rest /= base, step *= base) {
        for (int64_t digit = 0; digit < rest % base; ++digit) {
            const int64_t first = last_digits + digit * step, apart = step * base;
            if (first < count) rank += (count - 1 - first) / apart + 1;
        }
        last_digits += rest % base * step;
    }
    return int(rank);
}

using RecentMeans = RecentValues<int, Vec2d>;

/// So many pictures of different numbers of samples are drawn by turns.
constexpr size_t most_means = 16;

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
    static RecentMeans means(most_means);
    const auto point = [](int k) { return Vec2d(halton(k + 1, 2), halton(k + 1, 3)); };
    const Vec2d mean = means.get(count, [&] {
        Vec2d sum(0, 0);
        for (int k = 0; k < count; ++k) sum += point(k) / count;
        return sum;
    });
    return point(index) - mean;
}

Vec2d paired_jitter_of(int index, int count) {
    if (index == count - 1 && count % 2 == 1) return {0, 0};
    // From here on the first 4, 8, 16, ... points tell best what part of a pixel is on one side of a line.
    constexpr double first_x = 0.25, first_y = 0.075, plastic = 1.32471795724474602596;
    const int pair = index / 2;
    const auto wrapped = [](double x) { return x - std::floor(x + 0.5); };
    const Vec2d point(wrapped(first_x + pair / plastic), wrapped(first_y + pair / (plastic * plastic)));
    return index % 2 == 0 ? point : Vec2d(-point);
}

double shutter_time(int index, int count, double shutter) {
    return 1 - shutter * (1 - (rank_of(index, count, 7) + 0.5) / count);
}

Vec2d lens_position(int index, int count) {
    const auto point = [&](int k) {
        const double angle = k * pi * (3 - std::sqrt(5.0));
        return Vec2d(std::sqrt((k + 0.5) / count) * Vec2d(std::cos(angle), std::sin(angle)));
    };
    static RecentMeans means(most_means);
    const Vec2d mean = means.get(count, [&] {
        Vec2d sum(0, 0);
        for (int k = 0; k < count; ++k) sum += point(k) / count;
        return sum;
    });
    return point(rank_of(index, count, 5)) - mean;
}

namespace {

/// Moves the camera to the frame's place on the lens; what is in focus stays where it is in the picture.
void look_through_lens(Frame& frame) {
    const double focus = frame.resolved->settings.depth_of_field.focus_distance;
    const Vec2d place = frame.resolved->lens_radius * lens_position(frame.sample_index, frame.sample_count);
    frame.camera.T_world_cam.translate(Vec3d(place.x(), place.y(), 0));
    frame.clip_from_view(0, 2) -= frame.clip_from_view(0, 0) * place.x() / focus;
    frame.clip_from_view(1, 2) -= frame.clip_from_view(1, 1) * place.y() / focus;
}

/// Clip space of the frame's part of the picture.
Mat4d part_of_picture(const Frame& frame) {
    const Vec2d whole = frame.picture_size.cast<double>(), part = frame.size.cast<double>(),
                corner = frame.origin.cast<double>();
    const Vec2d scale = whole.cwiseQuotient(part);
    Mat4d T = Mat4d::Identity();
    T(0, 0) = scale.x();
    T(1, 1) = scale.y();
    T(0, 3) = scale.x() - 1 - 2 * corner.x() / part.x();
    T(1, 3) = 1 - scale.y() + 2 * corner.y() / part.y();
    return T;
}

}  // namespace

Camera camera_of(const Shot& shot, int sample_index) {
    const Camera& camera = shot.resolved->camera;
    if (!shot.motion) return camera;
    const double time =
        shutter_time(sample_index, shot.sample_count, shot.resolved->settings.motion_blur.shutter);
    return between(shot.motion->camera, camera, time);
}

Frame make_frame(const Shot& shot, int sample_index, const Camera& camera, const Box3d& bounds,
                 bool reaches_beyond) {
    Frame frame{shot};
    frame.camera = camera;
    frame.sample_index = sample_index;
    frame.time = shutter_time(sample_index, shot.sample_count, shot.resolved->settings.motion_blur.shutter);
    frame.clip_from_view = camera.projection_matrix(double(frame.picture_size.x()) / frame.picture_size.y());
    if (frame.through_lens) look_through_lens(frame);
    if (frame.size != frame.picture_size)
        frame.clip_from_view = part_of_picture(frame) * frame.clip_from_view;
    frame.covered = reaches_beyond
                        ? frame.whole()
                        : covered_rect(bounds, frame.clip_from_view * frame.camera.view(), frame.size);
    // Moving the picture by (dx, dy) pixels moves ndc by (2 dx / w, -2 dy / h): row 0 is the top.
    const auto jitter = frame.may_end_early ? paired_jitter_of : jitter_of;
    const Vec2d offset = frame.through_centres ? Vec2d(0, 0) : jitter(frame.sample_index, frame.sample_count);
    const Vec2d ndc(2 * offset.x() / frame.size.x(), -2 * offset.y() / frame.size.y());
    Mat4d shift = Mat4d::Identity();
    shift(0, 3) = ndc.x();
    shift(1, 3) = ndc.y();
    frame.clip_from_view = shift * frame.clip_from_view;
    return frame;
}

Vec3d view_position(const Frame& frame, Vec2i pixel, double depth) {
    const Vec2d ndc((pixel.x() + 0.5) / frame.size.x() * 2 - 1, 1 - (pixel.y() + 0.5) / frame.size.y() * 2);
    const Mat4d& p = frame.clip_from_view;
    if (frame.orthographic()) {
        const double z = frame.camera.far + (frame.camera.near - frame.camera.far) * depth;
        return {(ndc.x() - p(0, 3)) / p(0, 0), (ndc.y() - p(1, 3)) / p(1, 1), -z};
    }
    const double z = frame.camera.near / depth;
    return {(ndc.x() + p(0, 2)) / p(0, 0) * z, (ndc.y() + p(1, 2)) / p(1, 1) * z, -z};
}

void set_noise_uniforms(const gl::Program& program, const Frame& frame) {
    program.set("u_noise_origin", Vec2(frame.origin.cast<float>()));
}

void set_noise_uniforms(ShaderInputs& inputs, const Frame& frame) {
    inputs.set("u_noise_origin", Vec2(frame.origin.cast<float>()));
}

namespace {

template <class To>
void set_camera(To& to, const Frame& frame) {
    const Mat4d& p = frame.clip_from_view;
    const Camera& camera = frame.camera;
    const Vec2 shift =
        frame.orthographic() ? Vec2(float(-p(0, 3)), float(-p(1, 3))) : Vec2(float(p(0, 2)), float(p(1, 2)));
    to.set("u_size", Vec2(frame.size.cast<float>()));
    to.set("u_picture", Vec4(float(frame.origin.x()), float(frame.origin.y()), float(frame.picture_size.x()),
                             float(frame.picture_size.y())));
    to.set("u_reach", float(frame.reach));
    to.set("u_unproject", Vec4(float(1 / p(0, 0)), float(1 / p(1, 1)), shift.x(), shift.y()));
    to.set("u_depth", Vec3(float(camera.near), float(camera.far), frame.orthographic() ? 1.0f : 0.0f));
    to.set("u_world_from_view", Mat3(camera.T_world_cam.linear().cast<float>()));
}

}  // namespace

void set_camera_uniforms(const gl::Program& program, const Frame& frame) {
    set_camera(program, frame);
}

void set_camera_uniforms(ShaderInputs& inputs, const Frame& frame) {
    set_camera(inputs, frame);
}

std::vector<std::string> camera_defines(const Frame& frame) {
    return frame.orthographic() ? std::vector<std::string>{"ORTHOGRAPHIC"} : std::vector<std::string>{};
}

gl::DrawState geometry_state(const SurfaceOutputs& outputs) {
    const bool farthest = outputs.peel && outputs.peel->farthest;
    return {.depth_test = farthest ? gl::DepthTest::less : gl::DepthTest::greater, .write_depth = true};
}

gl::DrawState screen_state(const PixelRect& area, const gl::Blending& blending) {
    return {.blending = blending, .scissor = area};
}

void set_peel_uniforms(const gl::Program& program, const Peel& peel, unsigned unit) {
    program.set("u_peel_limit", int(unit));
    program.set("u_peel_mode", peel.backs ? -1.0f : peel.first ? 1.0f : 0.0f);
    peel.limit->bind(unit);
}

}  // namespace easypbr::render
