// The embedded studio, computed at its first use: a dim room with soft boxes, for lighting that flatters any
// material.
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/environment.h"

namespace easypbr {

namespace {

/// A rectangular lamp seen from the centre: the directions within `half_width` and `half_height` (tangents of
/// angles) of its axis, fading out over `edge`.
struct SoftBox {
    Vec3 axis, right, up;
    float half_width, half_height, edge;
    Vec3 radiance;
    float least_cosine;  ///< between its axis and a direction that sees something of it
};

float smooth_step(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

/// `roll_up` is any direction that is not along the axis: the box's upper edge faces it.
SoftBox make_box(const Vec3& towards, const Vec3& roll_up, Vec2 size_deg, float edge_deg,
                 const Vec3& radiance) {
    const Vec3 axis = towards.normalized();
    const Vec3 right = axis.cross(roll_up).normalized();
    const auto tangent = [](float angle_deg) { return float(std::tan(radians(angle_deg))); };
    const float width = tangent(size_deg.x() / 2), height = tangent(size_deg.y() / 2),
                edge = tangent(edge_deg);
    const float corner =
        1 / std::sqrt(1 + (width + edge) * (width + edge) + (height + edge) * (height + edge));
    // A little less, for what is rounded.
    return {axis, right, right.cross(axis), width, height, edge, radiance, 0.999f * corner};
}

const std::array<SoftBox, 5>& soft_boxes() {
    static const std::array<SoftBox, 5> boxes{
        make_box({0.0f, 1.0f, 0.12f}, Vec3::UnitZ(), {46, 34}, 5, {4.7f, 4.6f, 4.45f}),  // overhead
        make_box({-1.0f, 0.32f, 0.42f}, Vec3::UnitY(), {25, 58}, 3.5f,
                 {11.8f, 11.3f, 10.6f}),                                                    // left, the key
        make_box({1.0f, 0.26f, 0.30f}, Vec3::UnitY(), {20, 56}, 3.5f, {4.6f, 4.9f, 5.3f}),  // right
        make_box({0.25f, 0.42f, -1.0f}, Vec3::UnitY(), {64, 7}, 2.5f, {8.4f, 8.2f, 7.8f}),  // strip behind
        make_box({0.15f, 0.10f, 1.0f}, Vec3::UnitY(), {56, 34}, 9,
                 {0.72f, 0.70f, 0.67f}),  // fill at the camera
    };
    return boxes;
}

/// The room: floor dark, walls brighter towards the horizon, ceiling in between; warm grey.
Vec3 room_radiance(float height) {
    const float wall =
        0.16f + 0.16f * std::exp(-6 * height * height) + 0.05f * smooth_step(0.0f, 1.0f, height);
    const float floor_shadow = 1 - 0.62f * smooth_step(0.04f, -0.35f, height);
    return wall * floor_shadow * Vec3(1.04f, 1.0f, 0.95f);
}

/// The part of the lamp's radiance that a direction sees.
float coverage(const SoftBox& box, const Vec3& direction) {
    const float forward = direction.dot(box.axis);
    if (forward <= box.least_cosine) return 0;
    const float x = std::abs(direction.dot(box.right)) / forward,
                y = std::abs(direction.dot(box.up)) / forward;
    return smooth_step(box.half_width + box.edge, box.half_width, x) *
           smooth_step(box.half_height + box.edge, box.half_height, y);
}

Vec3 with_lamps(Vec3 radiance, const Vec3& direction, const std::vector<const SoftBox*>& boxes) {
    for (const SoftBox* box : boxes)
        if (const float part = coverage(*box, direction); part > 0)
            radiance += part * (box->radiance - radiance);
    return radiance;
}

/// Those that a row of directions of one height sees.
std::vector<const SoftBox*> boxes_at(float height, float sine) {
    std::vector<const SoftBox*> boxes;
    for (const SoftBox& box : soft_boxes()) {
        const float nearest = height * box.axis.y() + sine * Vec2(box.axis.x(), box.axis.z()).norm();
        if (nearest > 0.999f * box.least_cosine) boxes.push_back(&box);
    }
    return boxes;
}

Image studio_image() {
    Image image(1024, 512, 3, PixelType::f32);
    std::vector<Vec3> horizon(size_t(image.width()));
    for (size_t x = 0; x < horizon.size(); ++x)
        horizon[x] = equirect_direction((float(x) + 0.5f) / float(image.width()), 0.5f);
    parallel_for(size_t(image.height()), 16, [&](size_t y) {
        const Vec3 meridian = equirect_direction(0.5f, (float(y) + 0.5f) / float(image.height()));
        const float height = meridian.y(), sine = -meridian.z();
        const Vec3 room = room_radiance(height);
        const std::vector<const SoftBox*> boxes = boxes_at(height, sine);
        float* pixel = image.at<float>(0, int(y));
        for (const Vec3& east : horizon) {
            Eigen::Map<Vec3>{pixel} = with_lamps(room, Vec3(sine * east.x(), height, sine * east.z()), boxes);
            pixel += 3;
        }
    });
    return image;
}

}  // namespace

const Environment& studio_environment() {
    // Isolated: while the loops inside wait, this thread must not take up a task that asks for the studio
    // again.
    static const Environment studio =
        tbb::this_task_arena::isolate([] { return Environment(studio_image(), "studio"); });
    return studio;
}

}  // namespace easypbr
