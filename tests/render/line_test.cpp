// Lines: their width, colour, dashes and what hides them.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
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
#include "line_scenes.h"

namespace easypbr::render::line_test {
namespace {

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
