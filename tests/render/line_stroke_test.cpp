// Lines of many segments, and lines over each other: they cover as much as one stroke does.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/gpu/line_segments.h"
#include "easypbr/render/primitives/lines/screen_lines.h"
#include "easypbr/scene/merge.h"
#include "line_scenes.h"

namespace easypbr::render::line_stroke_test {
namespace {

/// A curve of `count` points from 0 to 1, row `i` of V being point(i / (count - 1)).
Mesh curve(int count, const std::function<Vec3(float)>& point) {
    Array3f::Dense V(count, 3);
    Array2i::Dense E(count - 1, 2);
    for (int i = 0; i < count; ++i) V.row(i) = point(float(i) / float(count - 1)).transpose();
    for (int i = 0; i + 1 < count; ++i) E.row(i) << i, i + 1;
    MeshData data;
    data.V = Array3f(V);
    data.E = Array2i(E);
    return Mesh(data);
}

Mesh circle(int count) {
    return curve(count, [](float t) {
        return Vec3(0.8f * std::cos(2 * float(pi) * t), 0.8f * std::sin(2 * float(pi) * t), 0);
    });
}

Image picture_of(const Mesh& mesh, bool native, const std::function<void(app::Session&)>& change) {
    Scene scene;
    scene.show(mesh, "line");
    app::Session session = looking_down(scene, 200);
    session.allow_native_shading(native);
    change(session);
    return render_linear(session);
}

TEST(Lines, DashesFillHalf) {
    Scene scene;
    scene.show(segment(Vec3(-0.9f, 0.1f, 0), Vec3(0.9f, 0.1f, 0)), "line");
    app::Session session = looking_down(scene, 200);
    session.settings().style.line_width = 4.0f;
    const double solid = sum_of_alpha(render_linear(session));
    session.settings().style.line_dash = 9.0f;
    // 180 pixels are ten dashes and ten gaps.
    EXPECT_NEAR(sum_of_alpha(render_linear(session)) / solid, 0.5, 0.03);
}

// Of curves too, whose segments are shorter than a pixel and stand in E in any order and direction: what is
// inked is as long as what is not. 0.05: the circle's length is not a multiple of both.
TEST(Lines, DashesGoOnFromSegmentToSegment) {
    for (const bool native : {true, false})
        for (const int count : {51, 2001}) {
            Mesh mesh = circle(count);
            mesh.edit([&](MeshData& data) {
                Array2i::Dense E = data.E;
                for (int i = 0; i + 1 < count; i += 3) E.row(i).reverseInPlace();
                for (int i = 0; i < count / 2; i += 2) E.row(i).swap(E.row(count - 2 - i));
                data.E = Array2i(E);
            });
            const auto ink = [&](float dash) {
                return sum_of_alpha(picture_of(mesh, native, [&](app::Session& session) {
                    session.settings().style.line_width = 6.0f;
                    session.settings().style.line_dash = dash;
                }));
            };
            EXPECT_NEAR(ink(10) / ink(0), 0.5, 0.05) << count << ' ' << native;
        }
}

// Where the first of two segments passes the near plane, 0.5 before the camera, nothing happens to the dashes
// of the second: they begin where the part of the first that is seen ends. At the plane a step of 1e-4 moves
// its start by 100 * 0.1 / 0.5^2 * 1e-4 = 0.004 pixels.
TEST(Lines, DashesDoNotJumpAtTheNearPlane) {
    constexpr float near = 0.5f;
    LineView view{.size = {200, 200}, .dash = 10};
    view.clip_from_mesh << 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, near, 0, 0, -1, 0;
    const std::array<gpu::ChainStep, 2> chain{gpu::ChainStep{0, false, true}, gpu::ChainStep{1, true, false}};
    view.chains = chain;
    const auto second = [&](float z) {
        const gpu::Segment segments[] = {{.a = {0.1f, 0, z}, .b = {0.3f, 0, -2}},
                                         {.a = {0.3f, 0.4f, -2}, .b = {0.3f, 0, -2}}};
        const std::vector<native::ScreenLine> lines = screen_lines(segments, view);
        EXPECT_EQ(lines.size(), 2u);
        EXPECT_EQ(lines.back().dash[1], -1);  // against the segment, which ends where the first one does
        return lines.back().dash[0];
    };
    EXPECT_NEAR(second(-near - 1e-4f), second(-near + 1e-4f), 0.01f);
    // From (20, 0) to (15, 0), and 20 pixels upwards: 25, of which dash and gap take 20.
    EXPECT_NEAR(second(-near), 5, 0.01f);
}

// The sum of coverages is length times width, whatever the segments: here of a circle of radius 80 pixels.
// 0.06: the ramp of the edge, and of 51 points the chords, which are 0.1 % shorter, at any angle.
TEST(Lines, OfManyPointsAreAsWideAsOfFew) {
    for (const bool native : {true, false})
        for (const float width : {0.3f, 1.5f, 6.0f})
            for (const int count : {51, 2001}) {
                const Image image = picture_of(circle(count), native, [&](app::Session& session) {
                    session.settings().style.line_width = width;
                });
                EXPECT_NEAR(sum_of_alpha(image) / (2 * pi * 80), width, 0.06) << count << ' ' << native;
            }
}

float most_alpha(const Image& image) {
    float most = 0;
    for (size_t i = 3; i < image.pixels<float>().size(); i += 4)
        most = std::max(most, image.pixels<float>()[i]);
    return most;
}

// The segments of a stroke are not blended over each other: joints are no darker. 0.001: halves.
TEST(Lines, HaveTheirOpacityAtJoints) {
    for (const bool native : {true, false})
        for (const int count : {4, 501}) {
            Mesh mesh = circle(count);
            Material material;
            material.opacity = 0.3f;
            material.alpha_mode = AlphaMode::blend;
            mesh.set_material(material);
            const Image image = picture_of(
                mesh, native, [](app::Session& session) { session.settings().style.line_width = 6.0f; });
            EXPECT_NEAR(most_alpha(image), 0.3f, 0.001f) << count << ' ' << native;
        }
}

double largest_difference(const Image& a, const Image& b) {
    double most = 0;
    for (size_t i = 0; i < a.pixels<float>().size(); ++i)
        most = std::max(most, double(std::abs(a.pixels<float>()[i] - b.pixels<float>()[i])));
    return most;
}

// Nearer segments reach over the next ones by half the width, and cut nothing off; each pixel has the colour
// of its own place. 2/255: vertices are rounded to floats, 1e-7 of 3 units or 1e-4 pixels, beside the camera,
// and colours to codes of 8 bits.
TEST(Lines, OfManyPointsIntoTheDepthAreAsOfTwo) {
    const auto straight = [](int count) {
        Mesh mesh = curve(count, [](float t) {
            return Vec3((1 - t) * Vec3(-0.8f, -0.5f, 1.5f) + t * Vec3(0.9f, 0.6f, -6));
        });
        ArrayXf::Dense C(count, 3);
        for (int i = 0; i < count; ++i) {
            const float t = float(i) / float(count - 1);
            C.row(i) << srgb_from_linear(t), srgb_from_linear(1 - t), 0;
        }
        mesh.set_C(ArrayXf(C));
        return mesh;
    };
    for (const bool native : {true, false})
        for (const bool colored : {true, false})
            for (const float width : {1.0f, 4.0f, 10.0f}) {
                const auto picture = [&](int count) {
                    return picture_of(straight(count), native, [&](app::Session& session) {
                        session.settings().camera.projection = Projection::perspective;
                        look_from(session, Vec3d(0, 0, 4), 40);
                        session.settings().style.line_width = width;
                        if (!colored) session.settings().style.line_color = Vec3(1, 0, 0);
                    });
                };
                const Image two = picture(2);
                for (const int count : {41, 161})
                    EXPECT_LT(largest_difference(picture(count), two), 2.0 / 255)
                        << count << ' ' << width << ' ' << colored << ' ' << native;
            }
}

// Beside the soft edge of the nearer of two lines the farther one is seen, not what is behind both, in any
// order of the scene, and within one stroke.
TEST(Lines, ThatCrossCutNothingOff) {
    const Mesh near = segment(Vec3(-0.9f, -0.03f, 0.2f), Vec3(0.9f, 0.05f, 0.2f)),
               far = segment(Vec3(0, -0.9f, -0.2f), Vec3(0, 0.9f, -0.2f));
    const std::array parts{*near.snapshot(), *far.snapshot()};
    const Mesh both{merged(parts)};
    for (const bool native : {true, false})
        for (const std::vector<Mesh>& meshes :
             {std::vector{near, far}, std::vector{far, near}, std::vector{both}}) {
            Scene scene;
            for (size_t i = 0; i < meshes.size(); ++i)
                scene.show(meshes[i], i == 0 ? std::string("a") : std::string("b"));
            app::Session session = looking_down(scene, 101);
            session.allow_native_shading(native);
            session.settings().style.line_width = 9.0f;
            const Image image = render_linear(session);
            for (int y = 20; y < 80; ++y)
                EXPECT_NEAR(image.at<float>(50, y)[3], 1, 0.001f) << y << ' ' << meshes.size() << native;
        }
}

// In a pixel that the nearer line covers half of, half is its colour and half that of the line behind it:
// the edge of the horizontal line, 8 pixels wide around row 50.5, is in the middle of a row 4 away.
TEST(Lines, AreBlendedWithThoseBehindThem) {
    for (const bool native : {true, false})
        for (const bool near_first : {true, false}) {
            Scene scene;
            const auto show = [&](const Vec3& a, const Vec3& b, const Vec3& color, const char* name) {
                Mesh mesh = segment(a, b);
                Style style;
                style.line_color = color;
                mesh.set_style(style);
                scene.show(mesh, name);
            };
            const auto show_near = [&] {
                show(Vec3(-0.9f, 0, 0.2f), Vec3(0.9f, 0, 0.2f), Vec3(1, 0, 0), "near");
            };
            if (near_first) show_near();
            show(Vec3(0, -0.9f, -0.2f), Vec3(0, 0.9f, -0.2f), Vec3(0, 1, 0), "far");
            if (!near_first) show_near();
            app::Session session = looking_down(scene, 101);
            session.allow_native_shading(native);
            session.settings().style.line_width = 8.0f;
            const Image image = render_linear(session);
            for (const int y : {46, 54}) {
                EXPECT_NEAR(image.at<float>(50, y)[0], 0.5f, 0.01f) << native << near_first;
                EXPECT_NEAR(image.at<float>(50, y)[1], 0.5f, 0.01f) << native << near_first;
            }
        }
}

}  // namespace
}  // namespace easypbr::render::line_stroke_test
