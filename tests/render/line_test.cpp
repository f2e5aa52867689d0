// Lines: their width, colour, dashes and what hides them.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/gpu/line_segments.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/primitives/lines/screen_lines.h"
#include "easypbr/scene/label_colors.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::line_test {
namespace {

Mesh segment(const Vec3& a, const Vec3& b) {
    Array3f::Dense V(2, 3);
    V << a.transpose(), b.transpose();
    Array2i::Dense E(1, 2);
    E << 0, 1;
    MeshData data;
    data.V = Array3f(V);
    data.E = Array2i(E);
    return Mesh(data);
}

app::Session looking_down(const Scene& scene, int size) {
    app::Session session = plain_session(scene, size);
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 2.0;
    look_from(session, Vec3d(0, 0, 4));
    return session;
}

double sum_of_alpha(const Image& image) {
    double sum = 0;
    for (size_t i = 3; i < image.pixels<float>().size(); i += 4) sum += double(image.pixels<float>()[i]);
    return sum;
}

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

// Coverage summed over the picture is width times length, and the two round ends together a disc. The edge
// falls linearly over one pixel, so that the sum is exact up to the sampling of the ends.
TEST(Lines, HaveTheirWidthAtAnyAngle) {
    constexpr int size = 200;
    for (const float width : {1.0f, 1.5f, 3.0f, 8.0f})
        for (int degrees = 0; degrees < 180; degrees += 15) {
            const float c = float(std::cos(radians(degrees))), s = float(std::sin(radians(degrees)));
            Scene scene;
            scene.show(segment(0.7f * Vec3(c, s, 0), -0.7f * Vec3(c, s, 0)), "line");
            app::Session session = looking_down(scene, size);
            session.settings().style.line_width = width;
            const double length = 1.4 * size / 2;
            const double measured = (sum_of_alpha(render_linear(session)) - pi * width * width / 4) / length;
            // Pixel centres sample the edge's ramp: every 0.71 pixels at 45 degrees, which errs by an eighth.
            EXPECT_NEAR(measured, width, 0.15) << width << " px, " << degrees << " degrees";
        }
}

// A line thinner than a pixel covers as much of the pixels' rows as it is wide, wherever it lies between
// them.
TEST(Lines, ThinOnesCoverAsMuchAsTheyAreWide) {
    constexpr int size = 100;
    for (const float width : {0.1f, 0.5f, 1.0f})
        for (const float offset : {0.0f, 0.3f, 0.5f}) {
            const float y = 2 * offset / size;
            Scene scene;
            scene.show(segment(Vec3(-0.9f, y, 0), Vec3(0.9f, y, 0)), "line");
            app::Session session = looking_down(scene, size);
            session.settings().style.line_width = width;
            const Image image = render_linear(session);
            double sum = 0;
            for (int row = 0; row < size; ++row) sum += double(image.at<float>(size / 2, row)[3]);
            EXPECT_NEAR(sum, width, 0.002) << offset;  // the overlay holds halves
        }
}

TEST(Lines, BlendTheColoursOfTheirEnds) {
    Mesh mesh = segment(Vec3(-0.9f, 0, 0), Vec3(0.9f, 0, 0));
    ArrayXf::Dense C(2, 3);
    C << 1, 0, 0, 0, 0, 1;
    mesh.set_C(ArrayXf(C));
    Scene scene;
    scene.show(mesh, "line");
    app::Session session = looking_down(scene, 101);
    session.settings().style.line_width = 5.0f;
    const Image image = render_linear(session);
    for (const float u : {0.1f, 0.5f, 0.8f}) {
        const float* p = image.at<float>(int(50.5f + (u - 0.5f) * 0.9f * 101), 50);
        EXPECT_NEAR(p[0], 1 - u, 0.02) << u;
        EXPECT_NEAR(p[2], u, 0.02) << u;
    }
}

// Opacities of the material and of the ends multiply.
TEST(Lines, HaveTheOpacityOfTheirMaterial) {
    for (const bool native : {true, false}) {
        Mesh mesh = segment(Vec3(-0.9f, 0, 0), Vec3(0.9f, 0, 0));
        ArrayXf::Dense C(2, 4);
        C << 1, 0, 0, 0.5f, 1, 0, 0, 0.5f;
        mesh.set_C(ArrayXf(C));
        Material material;
        material.opacity = 0.25f;
        mesh.set_material(material);
        Scene scene;
        scene.show(mesh, "line");
        app::Session session = looking_down(scene, 101);
        session.allow_native_shading(native);
        session.settings().style.line_width = 5.0f;
        const Image image = render_linear(session);
        EXPECT_NEAR(image.at<float>(50, 50)[3], 0.25 * 0.5, 0.001);  // codes of 8 bits
    }
}

/// The picture of a line from (-0.9, 0, 0) to (0.9, 0, 0), 5 pixels wide, as sRGB codes.
Image codes_of(const std::function<void(MeshData&)>& change, bool native, double turn_deg = 0) {
    Mesh mesh = segment(Vec3(-0.9f, 0, 0), Vec3(0.9f, 0, 0));
    mesh.edit(change);
    Scene scene;
    scene.show(mesh, "line");
    app::Session session = plain_session(scene, 101);
    session.allow_native_shading(native);
    session.settings().style.line_width = 5.0f;
    const double turn = radians(turn_deg);
    look_from(session, 3 * Vec3d(std::sin(turn), 0, std::cos(turn)), 45);
    return session.render({std::nullopt, 1, app::Encoding::srgb8});
}

/// Where a part of the way along that line is seen, in pixels of the middle row.
double column_of(double part, double turn_deg = 0) {
    const double turn = radians(turn_deg), x = 1.8 * part - 0.9;
    const double slope = x * std::cos(turn) / (3 - x * std::sin(turn));
    return 50.5 * (1 + slope / std::tan(radians(22.5)));
}

Array1f pair(float a, float b) {
    Array1f::Dense both(2);
    both << a, b;
    return Array1f(both);
}

int difference(const uint8_t* pixel, const Rgb8& color) {
    int most = 0;
    for (size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(int(pixel[c]) - int(color[c])));
    return most;
}

// A pixel of a line has the colour of its own value, which changes evenly along the line in space, not in the
// picture. 73 pixels have 256 colours: those that lie within the pixel count. 1: the overlay holds halves.
TEST(Lines, HaveTheColoursOfTheirValues) {
    const ColorTable& table = color_table(Colormap::turbo);
    for (const bool native : {true, false})
        for (const double turn : {0.0, 50.0}) {
            const Image image = codes_of(
                [](MeshData& d) {
                    d.scalars = {{"h", pair(0, 1)}};
                    d.style.colormap = Colormap::turbo;
                },
                native, turn);
            for (const double part : {0.1, 0.3, 0.5, 0.7, 0.9}) {
                const int x = int(column_of(part, turn));
                int nearest = 255;
                for (int i = 0; i < 256; ++i) {
                    const double column = column_of((i + 0.5) / 256, turn);
                    if (std::abs(column - x - 0.5) > 0.75) continue;
                    nearest = std::min(nearest, difference(image.at<uint8_t>(x, 50), table[size_t(i)]));
                }
                EXPECT_LE(nearest, 1) << native << ' ' << turn << ' ' << part;
            }
        }
}

TEST(Lines, WithAnEndWithoutValueHaveNone) {
    for (const bool native : {true, false}) {
        const Image image = codes_of(
            [](MeshData& d) {
                d.scalars = {{"h", pair(0, std::numeric_limits<float>::quiet_NaN())}};
                d.style.nan_color = Vec3(1, 0, 1);
            },
            native);
        for (const double part : {0.1, 0.5, 0.9})
            EXPECT_LE(difference(image.at<uint8_t>(int(column_of(part)), 50), {255, 0, 255}), 1) << part;
    }
}

TEST(Lines, HaveTheLabelOfTheNearerEnd) {
    const GeneratedColors generated(1);
    for (const bool native : {true, false}) {
        const Image image = codes_of(
            [&](MeshData& d) {
                Array1i::Dense labels(2);
                labels << 0, 1;
                d.L = Array1i(labels);
            },
            native, 50);
        for (const double part : {0.1, 0.4, 0.6, 0.9})
            EXPECT_LE(difference(image.at<uint8_t>(int(column_of(part, 50)), 50),
                                 generated.color_of(part < 0.5 ? 0 : 1)),
                      1)
                << part;
    }
}

// Edges of faces that are drawn as lines are coloured by the data as lines of E are.
TEST(Lines, OfFacesHaveTheColoursOfTheData) {
    for (const bool native : {true, false}) {
        Mesh mesh = facing_square(0.8f);
        ArrayXf::Dense C(4, 3);
        C.rowwise() = Eigen::RowVector3f(0, 0, 1);
        mesh.set_C(ArrayXf(C));
        Scene scene;
        scene.show(mesh, "square");
        app::Session session = looking_down(scene, 100);
        session.allow_native_shading(native);
        session.settings().style.mode = DrawMode::lines;
        session.settings().style.line_width = 5.0f;
        const auto color = [&] {
            const Image image = render_linear(session);
            return Vec3(
                Vec4(image.at<float>(30, 10)).head<3>());  // the upper edge: 40 pixels above the middle
        };
        EXPECT_LT((color() - Vec3(0, 0, 1)).norm(), 0.01f) << native;
        // A chosen colour stands in the place of the data's.
        session.settings().style.line_color = Vec3(1, 0, 0);
        EXPECT_LT((color() - Vec3(1, 0, 0)).norm(), 0.01f) << native;
    }
}

// Without colours of their own lines are as dark as wireframes; a material's colour is one.
TEST(Lines, AreDarkByDefault) {
    const Vec3 dark = linear_from_srgb(Vec3(0.1f, 0.1f, 0.12f)), red(1, 0, 0);
    Mesh mesh = segment(Vec3(-0.9f, 0, 0), Vec3(0.9f, 0, 0));
    for (const bool has_material : {false, true}) {
        Material material;
        if (has_material) material.base_color = red;
        mesh.set_material(material);
        Scene scene;
        scene.show(mesh, "line");
        app::Session session = looking_down(scene, 101);
        session.settings().style.line_width = 5.0f;
        const Image image = render_linear(session);
        EXPECT_LT((Vec3(Vec4(image.at<float>(50, 50)).head<3>()) - (has_material ? red : dark)).norm(),
                  1e-3f);
    }
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

TEST(Lines, AreHiddenBySurfacesUnlessOverlaid) {
    for (const float z : {-0.2f, 0.2f}) {
        Scene scene;
        scene.show(facing_square(0.5f), "square");
        scene.show(segment(Vec3(-0.9f, 0, z), Vec3(0.9f, 0, z)), "line");
        app::Session session = looking_down(scene, 101);
        session.settings().style.line_width = 5.0f;
        session.settings().style.line_color = Vec3(0, 1, 0);
        const auto green_in_the_middle = [&] { return render_linear(session).at<float>(50, 50)[1] > 0.9f; };
        EXPECT_EQ(green_in_the_middle(), z > 0);
        EXPECT_GT(render_linear(session).at<float>(10, 50)[1], 0.9f);
        session.settings().style.overlay = true;
        EXPECT_TRUE(green_in_the_middle());
    }
}

// The nearer of two crossing lines is seen, whichever is drawn first.
TEST(Lines, HideEachOther) {
    for (const float z : {-0.2f, 0.2f}) {
        Scene scene;
        Mesh a = segment(Vec3(-0.9f, 0, 0), Vec3(0.9f, 0, 0)),
             b = segment(Vec3(0, -0.9f, z), Vec3(0, 0.9f, z));
        Style red, green;
        red.line_color = Vec3(1, 0, 0);
        green.line_color = Vec3(0, 1, 0);
        a.set_style(red);
        b.set_style(green);
        scene.show(a, "a");
        scene.show(b, "b");
        app::Session session = looking_down(scene, 101);
        session.settings().style.line_width = 9.0f;
        const Image image = render_linear(session);
        const float* p = image.at<float>(50, 50);
        EXPECT_GT(p[z > 0 ? 1 : 0], 0.99f);
        EXPECT_LT(p[z > 0 ? 0 : 1], 0.01f);
    }
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

/// A square with a normal texture that turns all shading normals, components in [-1, 1].
Mesh leaning_square(float half, const Vec3& normal) {
    Image normals(1, 1, 3, PixelType::u8);
    for (int c = 0; c < 3; ++c)
        normals.at<uint8_t>(0, 0)[c] = uint8_t(std::lround((normal[c] * 0.5f + 0.5f) * 255));
    Material material;
    material.normal_texture.image = std::make_shared<Image>(normals);
    return facing_square(half, material);
}

float most_green(const Image& image) {
    float most = 0;
    for (size_t i = 1; i < image.pixels<float>().size(); i += 4)
        most = std::max(most, image.pixels<float>()[i]);
    return most;
}

// What hides a line is where a surface is, not how its shading normal is turned: here across the view, as if
// the square were seen edge-on. The line is far from the square's borders, and nothing is lit.
TEST(Lines, AreHiddenWhateverTheShadingNormal) {
    const Vec3 normal(0.98f, 0, 0.2f);
    for (const bool native : {true, false}) {
        Scene scene;
        scene.show(leaning_square(0.5f, normal), "square");
        scene.show(segment(Vec3(-0.2f, 0, -0.3f), Vec3(0.2f, 0, -0.3f)), "line");
        app::Session session = plain_session(scene, 101);
        session.allow_native_shading(native);
        session.settings().style.line_color = Vec3(0, 1, 0);
        session.settings().style.line_width = 5.0f;
        look_from(session, 4 * Vec3d(-0.2, 0, 0.98));
        EXPECT_EQ(most_green(render_linear(session)), 0.0f) << native;
    }
}

// Beside a surface's edge the depth changes by far more than its slope: that hides no less.
TEST(Lines, AreHiddenUpToSilhouettes) {
    for (const bool native : {true, false}) {
        Scene scene;
        scene.show(facing_square(0.5f), "square");
        scene.show(segment(Vec3(-0.9f, 0, -0.2f), Vec3(0.9f, 0, -0.2f)), "line");
        app::Session session = looking_down(scene, 101);
        session.allow_native_shading(native);
        session.settings().style.line_color = Vec3(0, 1, 0);
        session.settings().style.line_width = 5.0f;
        const Image image = render_linear(session);
        // The square's border is at 25.25 pixels from either side, the line's ends at 5.05. 1e-3: halves.
        for (int x = 6; x < 95; ++x)
            EXPECT_NEAR(image.at<float>(x, 50)[1], x >= 25 && x < 76 ? 0 : 1, 1e-3f) << x << ' ' << native;
    }
}

/// The least green of the pixels that points of a way from `a` to `b` fall into.
float least_green(app::Session& session, int size, const Vec3d& a, const Vec3d& b) {
    const Image image = render_linear(session);
    const Camera camera = session.camera();
    const Mat4d clip = camera.projection_matrix(1) * camera.view();
    float least = 1;
    for (double t = 0; t <= 1; t += 0.01) {
        const Eigen::Vector4d p = clip * (a + t * (b - a)).homogeneous();
        const int x = int((p.x() / p.w() + 1) * size / 2), y = int((1 - p.y() / p.w()) * size / 2);
        least = std::min(least, image.at<float>(x, y)[1]);
    }
    return least;
}

// A wireframe lies in its surface: no edge may be cut by the surface's slope, at any view angle, wherever
// shading normals lean.
TEST(Lines, WireframesAreWholeOnSlopes) {
    for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0.98f, 0.2f), Vec3(0, -0.98f, 0.2f)})
        for (const double elevation : {5.0, 20.0, 45.0, 80.0}) {
            Scene scene;
            scene.show(leaning_square(0.5f, normal), "square");
            app::Session session = plain_session(scene, 200);
            session.settings().style.show_wireframe = true;
            session.settings().style.line_color = Vec3(0, 1, 0);
            session.settings().style.line_width = 3.0f;
            const double e = radians(90 - elevation);
            look_from(session, Vec3d(0, 4 * std::sin(e), 4 * std::cos(e)));
            // Along the diagonal the middle pixel of the line is green, if only by the fringe of a nearer
            // edge.
            EXPECT_GT(least_green(session, 200, Vec3d(-0.45, -0.45, 0), Vec3d(0.45, 0.45, 0)), 0.8f)
                << elevation << ' ' << normal.y();
        }
}

// At the bottom of a valley the depth hardly changes from one side to the other, however steep both are.
TEST(Lines, WireframesAreWholeInCreases) {
    Array3f::Dense V(6, 3);
    V << -0.5f, 0.3f, 0.5f, 0.5f, 0.3f, 0.5f, 0.5f, 0, 0, -0.5f, 0, 0, 0.5f, -0.3f, 0.5f, -0.5f, -0.3f, 0.5f;
    Array3i::Dense F(4, 3);
    F << 0, 3, 2, 0, 2, 1, 3, 5, 4, 3, 4, 2;
    for (const bool native : {true, false})
        for (const double y : {-0.5, -0.1, 0.0, 0.3}) {
            Scene scene;
            scene.show(Mesh{Array3f(V), Array3i(F)}, "valley");
            app::Session session = plain_session(scene, 200);
            session.allow_native_shading(native);
            session.settings().style.show_wireframe = true;
            session.settings().style.line_color = Vec3(0, 1, 0);
            session.settings().style.line_width = 3.0f;
            look_from(session, Vec3d(0, y, 4));
            // The line covers the pixel that its middle runs through, and is behind the surface there.
            EXPECT_GT(least_green(session, 200, Vec3d(-0.3, 0, 0), Vec3d(0.3, 0, 0)), 0.99f)
                << y << ' ' << native;
        }
}

TEST(Lines, BehindTheCameraAreCut) {
    Scene scene;
    scene.show(segment(Vec3(0, -0.1f, -3), Vec3(0, -0.1f, 9)), "line");
    for (const bool native : {true, false})
        for (const Auto<double>& near : {Auto<double>(0.01), Auto<double>(automatic)}) {
            app::Session session = plain_session(scene, 101);
            session.allow_native_shading(native);
            look_from(session, Vec3d(0, 0, 4));
            session.settings().camera.near = near;
            const Image image = render_linear(session);
            // It runs from the vanishing point's neighbourhood straight down and out of the picture.
            EXPECT_GT(image.at<float>(50, 95)[3], 0.5f) << native;
            EXPECT_EQ(image.at<float>(50, 5)[3], 0.0f) << native;
        }
}

TEST(Lines, OfAWireframeAreEachDrawnOnce) {
    const Mesh box = make_box();
    // The sides share no vertex, so each has four edges and a diagonal.
    EXPECT_EQ(gpu::wireframe_segments(*box.snapshot()).size(), 6u * 5);
    Mesh quads = box;
    quads.edit([](MeshData& data) {
        Array1i::Dense polygon(data.F.rows());
        for (int i = 0; i < polygon.size(); ++i) polygon[i] = i / 2;
        data.source_face = Array1i(polygon);
    });
    EXPECT_EQ(gpu::wireframe_segments(*quads.snapshot()).size(), 6u * 4);
    // Two triangles of one quad with shared corners, of which the diagonal is inside once they are a polygon.
    EXPECT_EQ(gpu::wireframe_segments(*facing_square().snapshot()).size(), 5u);
}

// Lines take no part in what surfaces are drawn, shadowed and traced by.
TEST(Lines, AreOverlaysAndNoSurfaces) {
    SpacingCache spacings;
    DrawableCache drawables(spacings);
    const auto counts = [&](const Mesh& mesh, const std::function<void(Style&)>& change) {
        Scene scene;
        scene.show(mesh, "mesh");
        app::Session session = plain_session(scene, 8);
        change(session.settings().style);
        const ResolvedSettings resolved = session.resolve();
        const DrawableScene drawable = drawables.apply(scene.snapshot(), resolved.settings);
        const DrawList list = draw_list(drawable, resolved.settings, Material());
        size_t surfaces = 0;
        for (const auto& [kind, items] : list.items) surfaces += items.size();
        const size_t lines = items_of(list.overlays, DrawMode::lines).size();
        EXPECT_EQ(list.overlays.empty(), lines == 0);
        EXPECT_EQ(list.needs_overlay(), lines > 0);
        EXPECT_EQ(list.reaches_beyond_vertices(), lines > 0);
        return std::pair(surfaces, lines);
    };
    using Counts = std::pair<size_t, size_t>;
    const Mesh line = segment(Vec3(0, 0, 0), Vec3(1, 0, 0)), square = facing_square();
    EXPECT_EQ(counts(line, [](Style&) {}), Counts(0, 1));
    EXPECT_EQ(counts(square, [](Style&) {}), Counts(1, 0));
    EXPECT_EQ(counts(square, [](Style& s) { s.show_wireframe = s.show_normals = true; }), Counts(1, 1));
    EXPECT_EQ(counts(square, [](Style& s) { s.mode = DrawMode::lines; }), Counts(0, 1));
    // No faces that could have a wireframe.
    EXPECT_EQ(counts(line, [](Style& s) { s.show_wireframe = true; }), Counts(0, 1));
    EXPECT_EQ(counts(line, [](Style& s) { s.mode = DrawMode::mesh, s.show_wireframe = true; }), Counts(0, 0));
}

}  // namespace
}  // namespace easypbr::render::line_test
