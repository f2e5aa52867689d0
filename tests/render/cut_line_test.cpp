// Lines that reach behind the camera, wherever the near plane is.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "easypbr/gpu/line_segments.h"
#include "easypbr/render/primitives/lines/screen_lines.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::cut_line_test {
namespace {

constexpr int size = 101;
const Vec3d viewpoint(0.13, 0.02, 0.21);

/// Long lines along both axes of a floor below the viewpoint.
Mesh floor_grid() {
    constexpr int lines = 13;
    Array3f::Dense V(4 * lines, 3);
    Array2i::Dense E(2 * lines, 2);
    for (int i = 0; i < lines; ++i) {
        const float t = float(i) / 2 - 3;
        V.row(4 * i) << t, -1, -3;
        V.row(4 * i + 1) << t, -1, 3;
        V.row(4 * i + 2) << -3, -1, t;
        V.row(4 * i + 3) << 3, -1, t;
        E.row(2 * i) << 4 * i, 4 * i + 1;
        E.row(2 * i + 1) << 4 * i + 2, 4 * i + 3;
    }
    MeshData data;
    data.V = Array3f(V);
    data.E = Array2i(E);
    return Mesh(data);
}

app::Session session_within(const Scene& scene, Projection projection) {
    app::Session session = plain_session(scene, size);
    CameraSettings& camera = session.settings().camera;
    camera.projection = projection;
    camera.ortho_height = 3;
    camera.position = viewpoint;
    camera.target = Vec3d(0.4, -0.5, -2);
    return session;
}

/// Of what two pictures of the same size cover.
double largest_difference(const Image& a, const Image& b) {
    double largest = 0;
    for (size_t i = 3; i < a.pixels<float>().size(); i += 4) {
        const double difference = std::abs(double(a.pixels<float>()[i]) - double(b.pixels<float>()[i]));
        // A comparison with what is no number is false.
        if (!(difference <= largest)) largest = std::isnan(difference) ? 1e9 : difference;
    }
    return largest;
}

// No point of the floor is nearer than 1 in the picture: a near plane before that takes nothing from it.
// Places on the screen hold hundredths of pixels, and coverage changes by one from pixel to pixel.
TEST(CutLines, AreTheSameWhateverTheNearPlane) {
    Scene scene;
    scene.show(floor_grid(), "floor");
    for (const bool native : {true, false}) {
        app::Session session = session_within(scene, Projection::perspective);
        session.allow_native_shading(native);
        session.settings().camera.near = 0.1;
        const Image expected = render_linear(session);
        EXPECT_GT(std::ranges::count_if(expected.pixels<float>(), [](float v) { return v > 0.5f; }), size);
        session.settings().camera.near = automatic;
        EXPECT_LT(largest_difference(expected, render_linear(session)), 0.05) << native << " automatic";
        for (const double near : {1e-4, 1e-7, 1e-12}) {
            session.settings().camera.near = near;
            EXPECT_LT(largest_difference(expected, render_linear(session)), 0.05) << native << ' ' << near;
        }
    }
}

// Both devices cut lines themselves, and end them roundly at the near and the far plane.
TEST(CutLines, AreTheSameOnBothDevices) {
    Scene scene;
    scene.show(floor_grid(), "floor");
    for (const Projection projection : {Projection::perspective, Projection::orthographic})
        for (const std::optional<double>& near : {std::optional<double>(), std::optional(0.8)}) {
            app::Session session = session_within(scene, projection);
            session.settings().style.line_width = 4.0f;
            if (near) session.settings().camera.near = *near;
            const Image expected = render_linear(session);
            session.allow_native_shading(false);
            EXPECT_LT(largest_difference(expected, render_linear(session)), 0.05)
                << int(projection) << ' ' << near.value_or(0);
        }
}

/// Clip coordinates of a place in double precision.
Eigen::Vector4d clip_of(const Mat4d& clip_from_world, const float (&place)[3]) {
    return clip_from_world * Eigen::Vector4d(double(place[0]), double(place[1]), double(place[2]), 1);
}

/// How far the points of a segment that the picture shows lie beside its line, pixels.
double distance_beside(const native::ScreenLine& line, const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
    double farthest = 0;
    for (int i = 0; i <= 1000; ++i) {
        const Eigen::Vector4d p = a + i / 1000.0 * (b - a);
        if (!(p.w() > 0 && p.head<2>().cwiseAbs().maxCoeff() <= p.w())) continue;
        const double x = (0.5 + 0.5 * p.x() / p.w()) * size - double(line.start[0]),
                     y = (0.5 - 0.5 * p.y() / p.w()) * size - double(line.start[1]);
        farthest = std::max(farthest, std::abs(x * double(line.along[1]) - y * double(line.along[0])));
    }
    return farthest;
}

// Clip coordinates err by 1e-7 of 5, the largest |w|. At 1e-5 of that, where lines are cut, it is a
// hundredth.
TEST(CutLines, LieOnTheirProjection) {
    for (const double near : {1e-2, 1e-5, 1e-9, 1e-15}) {
        Camera camera = Camera::look_at(viewpoint, Vec3d(0.4, -0.5, -2), Vec3d(0, 1, 0));
        camera.near = near;
        const Mat4d clip_from_world = camera.projection_matrix(1) * camera.view();
        const LineView view{.clip_from_mesh = clip_from_world.cast<float>(),
                            .size = Vec2::Constant(float(size))};
        const auto data = floor_grid().snapshot();
        for (const gpu::Segment& segment : gpu::edge_segments(*data)) {
            const auto lines = screen_lines(std::span(&segment, 1), view);
            const Eigen::Vector4d a = clip_of(clip_from_world, segment.a),
                                  b = clip_of(clip_from_world, segment.b);
            EXPECT_EQ(lines.empty(), std::max(a.w(), b.w()) < near);
            if (lines.empty()) continue;
            const native::ScreenLine& line = lines.front();
            const double largest_w = std::max(std::abs(a.w()), std::abs(b.w()));
            for (const float w : line.ws) EXPECT_GT(double(w), 0.97 * std::max(near, 1e-5 * largest_w));
            // Both ends lie up to 1e5 pixels from the middle along both axes.
            EXPECT_LT(line.length, 2.1e5f * std::sqrt(2.0f));
            // Start and direction round to 6e-8 of 1e5 pixels each.
            EXPECT_LT(distance_beside(line, a, b), 0.05) << near;
        }
    }
}

}  // namespace
}  // namespace easypbr::render::cut_line_test
