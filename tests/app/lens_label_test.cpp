// Labels through a lens: every pixel has a colour of the map, or shows none.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include "easypbr/app/session.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/render/pipeline/tiles.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::lens_label_test {
namespace {

const Vec2i size(96, 72);

/// Labels 0 to 2 in turn.
Mesh labelled(Mesh mesh, int count) {
    Array1i::Dense L(count);
    for (int i = 0; i < count; ++i) L[i] = i % 3;
    mesh.set_L(L);
    return mesh;
}

Mesh cloud() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-1, 1);
    Array3f::Dense V(400, 3);
    for (Eigen::Index i = 0; i < V.rows(); ++i)
        for (int c = 0; c < 3; ++c) V(i, c) = place(random);
    Mesh mesh;
    mesh.set_V(V);
    return labelled(mesh, 400);
}

Mesh ball() {
    Mesh mesh = make_sphere(1, 12);
    Style style = mesh.style();
    style.lit = false;
    mesh.set_style(style);
    return labelled(mesh, int(mesh.F().rows()));
}

Session session_of(const Mesh& mesh, bool through_lens) {
    Scene scene;
    scene.show(mesh, "labelled");
    Session session(scene);
    session.settings().image.size = size;
    session.settings().ground.mode = GroundMode::none;
    Camera camera = Camera::look_at(Vec3d(0, 0, 4), Vec3d(0, 0, 0));
    camera.intrinsics = Intrinsics{90, 90, 47.5, 35.5, size.x(), size.y()};
    if (through_lens)
        camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.2, 0.05, 0, 0});
    session.set_camera(camera);
    return session;
}

template <class T>
std::set<std::array<T, 4>> colors(const Image& picture) {
    std::set<std::array<T, 4>> found;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            std::array<T, 4> color;
            std::copy_n(picture.at<T>(x, y), 4, color.begin());
            found.insert(color);
        }
    return found;
}

TEST(LensLabels, HaveTheColoursThatTheyHaveWithoutALens) {
    for (const Mesh& mesh : {cloud(), ball()})
        for (const int samples : {1, 4}) {
            Session plain = session_of(mesh, false), bent = session_of(mesh, true);
            // In light a grey that is mixed with itself is rounded.
            for (Session* session : {&plain, &bent})
                session->settings().background.mode = BackgroundMode::transparent;
            const auto expected = colors<uint8_t>(plain.render({size, samples, Encoding::srgb8}));
            EXPECT_EQ(expected.size(), 4u);
            EXPECT_EQ(colors<uint8_t>(bent.render({size, samples, Encoding::srgb8})), expected);
            EXPECT_EQ(colors<uint16_t>(bent.render({size, samples, Encoding::srgb16})),
                      colors<uint16_t>(plain.render({size, samples, Encoding::srgb16})));
            EXPECT_EQ(colors<float>(bent.render({size, samples, Encoding::scene_linear})),
                      colors<float>(plain.render({size, samples, Encoding::scene_linear})));
        }
}

TEST(LensLabels, HaveThemWhileThePictureRefinesAndWithSurfaces) {
    Session session = session_of(cloud(), true);
    const auto expected = colors<uint8_t>(session.render({size, 4, Encoding::srgb8}));
    EXPECT_EQ(expected.size(), 4u);
    for (int frame = 0; frame < 4; ++frame)
        EXPECT_EQ(colors<uint8_t>(session.refine({size, 4, Encoding::srgb8}, true).drawn.picture()),
                  expected);
    const Drawn drawn = session.draw_surfaces({size, 4, Encoding::srgb8}, true);
    EXPECT_EQ(colors<uint8_t>(drawn.picture()), expected);
}

TEST(LensLabels, HaveThemInTiles) {
    const Vec2i large = 8 * size;
    Session session = session_of(cloud(), true);
    session.settings().ssao.enabled = false;
    const int guard = render::guard_of(session.scene().snapshot(), session.resolve(large), large).pixels;
    const int side = 2 * guard + 2 * render::tile_grid;
    const render::TileLimits limits{side, int64_t(side) * side};
    EXPECT_GT(render::tiles_of(large, guard, limits).size(), 1u);
    session.limit_tiles(limits);
    EXPECT_EQ(colors<uint8_t>(session.render({large, 1, Encoding::srgb8})).size(), 4u);
}

// What is no label is mixed as ever: a lit ball has many colours, and its border some of both sides.
TEST(LensLabels, LeaveTheRestSmooth) {
    Session session = session_of(make_sphere(1, 32), true);
    session.settings().background.mode = BackgroundMode::transparent;
    const Image picture = session.render({size, 4, Encoding::srgb8});
    std::set<int> alphas;
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) alphas.insert(picture.at<uint8_t>(x, y)[3]);
    // Without mixing there are those of 0 to 4 samples.
    EXPECT_GT(alphas.size(), 20u);
}

}  // namespace
}  // namespace easypbr::app::lens_label_test
