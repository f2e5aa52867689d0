// Lines, eye-dome lighting, exact colours and what is drawn over everything else, among surfaces that light
// passes.
#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::layer_order_test {
namespace {

/// Display colours are kept in halves (2^-11), opacities in 16 bits.
constexpr double tolerance = 2.0 / 255;

/// Shown as it is, in the plane z.
Mesh sheet(const Vec3& color, float opacity, double z, float half = 2) {
    Material m;
    m.base_color = color;
    m.opacity = opacity;
    Mesh mesh = facing_square(half, m);
    Style style;
    style.lit = false;
    mesh.set_style(style);
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, z)));
    return mesh;
}

/// A horizontal line through the picture's middle, opaque and some pixels wide.
Mesh line(const Vec3& color, double z, float y = 0) {
    Array3f::Dense V(2, 3);
    V << -2, y, float(z), 2, y, float(z);
    Array2i::Dense E(1, 2);
    E << 0, 1;
    MeshData data;
    data.V = Array3f(V);
    data.E = Array2i(E);
    data.style.line_color = srgb_from_linear(color);
    data.style.line_width = 9.0f;
    return Mesh(data);
}

app::Session looking_down(const Scene& scene, int size = 49) {
    app::Session session = plain_session(scene, size);
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 2.0;
    look_from(session, Vec3d(0, 0, 8));
    return session;
}

void expect_color(const float* seen, const Vec3& expected, const std::string& what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], expected[c], tolerance) << what << ", channel " << c;
}

const Vec3 red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1), white(1, 1, 1);

Vec3 over(const Vec3& color, float opacity, const Vec3& below) {
    return opacity * color + (1 - opacity) * below;
}

// A line at each place among three blended sheets is tinted by those before it and by no others; the sheets
// may be light or colours that are shown as they are, and what is beside the line does not change.
TEST(LayerOrder, LinesLieWhereTheyAre) {
    for (const bool unlit : {false, true})
        for (const double z : {-0.5, 0.5, 1.5, 2.5}) {
            Scene scene;
            scene.show(sheet(white, 1, -1), "wall");
            Vec3 on_line(1, 1, 0), beside = white;
            const std::pair<Vec3, float> sheets[] = {{red, 0.5f}, {green, 0.25f}, {blue, 0.4f}};
            for (int i = 0; i < 3; ++i) {
                Mesh mesh = sheet(sheets[i].first, sheets[i].second, i);
                if (unlit) {
                    Material m = mesh.material();
                    m.unlit = true;
                    mesh.set_material(m);
                    mesh.set_style({});
                }
                scene.show(mesh, std::to_string(i));
                beside = over(sheets[i].first, sheets[i].second, beside);
                if (i > z) on_line = over(sheets[i].first, sheets[i].second, on_line);
            }
            scene.show(line(Vec3(1, 1, 0), z), "line");
            app::Session session = looking_down(scene);
            const Image image = render_linear(session);
            const std::string what = fmt::format("unlit {}, z {}", unlit, z);
            expect_color(image.at<float>(24, 24), on_line, what);
            expect_color(image.at<float>(24, 4), beside, what + ", beside");
        }
}

// Each of many lines is drawn once, at its place; a wireframe lies on its own transparent surface; and where
// there is no layer at all, or they end, lines are whole.
TEST(LayerOrder, LinesAreDrawnOnceEach) {
    Scene scene;
    Mesh front = sheet(red, 0.5f, 1, 0.5f), back = sheet(green, 0.5f, 0, 0.5f);
    Style framed = front.style();
    framed.show_wireframe = true;
    framed.line_color = Vec3(0, 0, 1);
    framed.line_width = 5.0f;
    front.set_style(framed);
    scene.show(front, "front");
    scene.show(back, "back");
    // Half transparent lines would show what is drawn twice.
    Mesh veil = line(white, 0.5, 0.25f);
    ArrayXf::Dense C(2, 4);
    C << 1, 1, 1, 0.5f, 1, 1, 1, 0.5f;
    veil.set_C(ArrayXf(C));
    scene.show(veil, "veil");
    app::Session session = looking_down(scene);
    const Image image = render_linear(session);
    // Rows from the top: y = 0.25 is 18.4. Beside the sheets the line is alone.
    EXPECT_NEAR(image.at<float>(4, 18)[3], 0.5, tolerance);
    expect_color(image.at<float>(20, 18), over(red, 0.5f, over(white, 0.5f, over(green, 0.5f, Vec3::Zero()))),
                 "veil");
    expect_color(image.at<float>(20, 28), blue, "wireframe's diagonal");
}

// What is drawn over everything else is not hidden or tinted by what lies before it, opaque or blended; of
// its own kind the nearer lies over the farther, and it hides nothing of what is beside it.
TEST(LayerOrder, OverEverythingElse) {
    for (const bool solid : {false, true}) {
        Scene scene;
        scene.show(sheet(white, 1, 0), "opaque");
        scene.show(sheet(Vec3(0, 1, 1), 0.5f, 0.2), "blended before it");
        scene.show(line(green, 0.4), "line before it");
        for (const auto& [z, color] : {std::pair(-1.0, red), std::pair(-2.0, blue)}) {
            Mesh mesh = sheet(color, solid && z == -2 ? 1 : 0.25f, z, 0.5f);
            Style style = mesh.style();
            style.overlay = true;
            mesh.set_style(style);
            scene.show(mesh, z == -1 ? "near" : "far");
        }
        app::Session session = looking_down(scene);
        const Image image = render_linear(session);
        const Vec3 below = over(Vec3(0, 1, 1), 0.5f, white);
        const Vec3 far = solid ? blue : over(blue, 0.25f, below);
        const Vec3 far_line = solid ? blue : over(blue, 0.25f, green);
        expect_color(image.at<float>(24, 16), over(red, 0.25f, far), fmt::format("middle {}", solid));
        expect_color(image.at<float>(24, 24), over(red, 0.25f, far_line), fmt::format("line {}", solid));
        expect_color(image.at<float>(24, 4), below, fmt::format("beside {}", solid));
        expect_color(image.at<float>(4, 24), green, fmt::format("line beside {}", solid));
    }
}

/// Points on two squares, the left one nearer, all of a square's at one depth.
MeshData step_of_points(float opacity) {
    constexpr int side = 40;
    Array3f::Dense V(side * side, 3);
    for (int i = 0; i < side * side; ++i) {
        const float x = (float(i % side) + 0.5f) * 2 / side - 1, y = (float(i / side) + 0.5f) * 2 / side - 1;
        V.row(i) << x, y, (x < 0 ? 1.0f : 0.0f);
    }
    MeshData data;
    data.V = Array3f(V);
    data.materials.resize(1);
    data.materials[0].base_color = Vec3(0.8f, 0.6f, 0.4f);
    data.materials[0].opacity = opacity;
    data.style.point_shape = PointShape::square;
    data.style.point_size = 3.0f;
    return data;
}

// One layer of transparent points has the shade of opaque ones, times its opacity.
TEST(LayerOrder, EyeDomeLightingOfOneLayer) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        Image images[2];
        for (const float opacity : {1.0f, 0.5f}) {
            Scene scene;
            scene.show(Mesh(step_of_points(opacity)), "step");
            app::Session session = plain_session(scene, 64);
            session.allow_native_geometry(false);  // whose splats may have another pixel at their border
            session.settings().camera.projection = projection;
            session.settings().camera.ortho_height = 1.6;
            look_from(session, Vec3d(0, 0, 8), 11);
            images[opacity < 1] = render_linear(session);
        }
        float darkest = 1, lightest = 0;
        for (int y = 8; y < 56; ++y)
            for (int x = 8; x < 56; ++x) {
                const float *a = images[0].at<float>(x, y), *b = images[1].at<float>(x, y);
                // Where the splats of both squares lie at one pixel there are two layers.
                if (std::abs(b[3] - 0.5f) > 0.01f) continue;
                for (int c = 0; c < 4; ++c) ASSERT_NEAR(b[c], 0.5f * a[c], tolerance) << x << ' ' << y;
                darkest = std::min(darkest, a[0]);
                lightest = std::max(lightest, a[0]);
            }
        // The far square beside the step is dark, and the near one is not.
        EXPECT_LT(darkest, 0.5f);
        EXPECT_GT(lightest, 0.79f);
    }
}

// All layers of a pixel have the shade of the nearest, and opaque surfaces before the points shade them too.
TEST(LayerOrder, EyeDomeLightingBehindAnEdge) {
    MeshData data = step_of_points(0.5f);
    Array3f::Dense V = data.V;
    V.col(2).setZero();
    data.V = Array3f(V);
    Scene scene;
    scene.show(Mesh(data), "points");
    app::Session session = looking_down(scene, 64);
    const float open = render_linear(session).at<float>(36, 32)[0];
    EXPECT_NEAR(open, 0.4, tolerance);
    Mesh wall = sheet(white, 1, 1, 1);
    wall.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(-1, 0, 1)));
    scene.show(wall, "wall");  // up to x = 0, pixel 32
    EXPECT_LT(render_linear(session).at<float>(33, 32)[0], 0.8f * open);
    EXPECT_NEAR(render_linear(session).at<float>(60, 32)[0], open, tolerance);
}

Mesh labelled(double z, float opacity) {
    Mesh mesh = facing_square(0.6f);
    mesh.set_L(Array1i(Array1i::Dense::Constant(4, 3)));
    Style style;
    style.lit = false;
    mesh.set_style(style);
    Material m;
    m.opacity = opacity;
    mesh.set_material(m);
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, z)));
    return mesh;
}

// Colours of labels keep their value to the bit beside a line; on it they are mixed with it by its coverage,
// and a blended surface before the line, or between the two, is mixed in at its place: in one frame and in
// many.
TEST(LayerOrder, LinesOverExactColours) {
    for (const double veil : {0.0, 0.5, 1.5})
        for (const int samples : {1, 4}) {
            Scene scene;
            scene.show(labelled(0, 1), "labelled");
            scene.show(line(Vec3(1, 1, 0), 1), "line");
            if (veil > 0) scene.show(sheet(red, 0.5f, veil, 0.3f), "veil");
            app::Session session = looking_down(scene);
            const Image image = session.render({std::nullopt, samples, app::Encoding::srgb8});
            Scene bare;
            bare.show(labelled(0, 1), "labelled");
            app::Session alone = looking_down(bare);
            const Image exact = alone.render({std::nullopt, 1, app::Encoding::srgb8});
            Vec3 label;
            for (int c = 0; c < 3; ++c)
                label[c] = linear_from_srgb(float(exact.at<uint8_t>(24, 12)[c]) / 255);
            const std::string what = fmt::format("veil {}, {} samples", veil, samples);
            const auto expect = [&](int x, int y, const Vec3& linear, int tolerance_8) {
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(image.at<uint8_t>(x, y)[c], std::lround(255 * srgb_from_linear(linear[c])),
                                tolerance_8)
                        << what << " at " << x << ", " << y;
            };
            expect(12, 12, label, 0);
            expect(12, 24, Vec3(1, 1, 0), 0);
            const Vec3 below = veil > 0 && veil < 1 ? Vec3(1, 1, 0) : over(red, 0.5f, Vec3(1, 1, 0));
            expect(24, 24, veil > 0 ? below : Vec3(1, 1, 0), 1);
            if (veil > 0) expect(24, 18, over(red, 0.5f, label), 1);
        }
}

// Labels that light passes are layers like others, also where several frames are averaged.
TEST(LayerOrder, TransparentLabels) {
    Scene scene;
    scene.show(sheet(white, 1, 0), "wall");
    scene.show(labelled(1, 0.5f), "labelled");
    app::Session session = looking_down(scene);
    const Image one = session.render({std::nullopt, 1}), many = session.render({std::nullopt, 4});
    EXPECT_LT(one.at<uint8_t>(24, 24)[0] + one.at<uint8_t>(24, 24)[1] + one.at<uint8_t>(24, 24)[2], 3 * 250);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(one.at<uint8_t>(24, 24)[c], many.at<uint8_t>(24, 24)[c], 1);
}

}  // namespace
}  // namespace easypbr::render::layer_order_test
