// How images are lit unless something else is asked for: by paths.
#include <algorithm>
#include <functional>
#include <set>

#include "easypbr/app/session.h"
#include "easypbr/render/raytrace/path_batch.h"
#include "easypbr/scene/resolve.h"
#include "render_test.h"

namespace easypbr::default_light_test {
namespace {

using render::PathSampler;

Scene with_box() {
    Scene scene;
    scene.show(make_box(), "box");
    return scene;
}

bool traces_paths(const Scene& scene, const Settings& settings = {}, int samples = 8) {
    return resolve(scene.snapshot(), settings, {64, 48}, samples).traces_paths;
}

bool traces_paths_with(const std::function<void(Settings&)>& change, int samples = 8) {
    Settings settings;
    change(settings);
    return traces_paths(with_box(), settings, samples);
}

}  // namespace

TEST(DefaultLight, AccumulatedImagesArePathTraced) {
    EXPECT_TRUE(traces_paths(with_box()));
    EXPECT_TRUE(traces_paths(with_box(), {}, 2));
    EXPECT_FALSE(traces_paths(with_box(), {}, 1));
    Settings asked;
    asked.path.enabled = true;
    EXPECT_TRUE(traces_paths(with_box(), asked, 1));
}

TEST(DefaultLight, WhatPathsReplaceIsDrawnWhenItIsAskedFor) {
    for (const bool on : {false, true}) {
        EXPECT_FALSE(traces_paths_with([&](Settings& s) { s.ssao.enabled = on; })) << on;
        EXPECT_FALSE(traces_paths_with([&](Settings& s) { s.rays.enabled = on; })) << on;
    }
    EXPECT_FALSE(traces_paths_with([](Settings& s) { s.ssao.radius = 0.1f; }));
    EXPECT_FALSE(traces_paths_with([](Settings& s) { s.shadows.enabled = false; }));
    EXPECT_FALSE(traces_paths_with([](Settings& s) { s.shadows.mode = ShadowMode::pcf; }));
    EXPECT_TRUE(traces_paths_with([](Settings& s) { s.ssao.enabled = follow; }));
    EXPECT_TRUE(traces_paths_with([](Settings& s) { s.shadows.mode = ShadowMode::soft; }));
    EXPECT_FALSE(traces_paths_with([](Settings& s) { s.path.enabled = false; }));
    EXPECT_TRUE(traces_paths_with([](Settings& s) { s.ssao.enabled = s.path.enabled = true; }));
    // A value that was inferred before is nobody's wish.
    const Scene scene = with_box();
    Settings latched;
    latch(latched, resolve(scene.snapshot(), latched, {64, 48}, 8).settings);
    EXPECT_TRUE(traces_paths(scene, latched));
    EXPECT_FALSE(traces_paths(scene, latched, 1));
}

TEST(DefaultLight, UnlitPointsAreRasterised) {
    Scene cloud;
    MeshData points;
    points.V = Array3f(Array3f::Dense::Random(50, 3));
    cloud.show(Mesh(std::move(points)), "cloud");
    EXPECT_FALSE(traces_paths(cloud));
}

// With nothing set: under a white sky a room of matt walls, seen from within, is black.
TEST(DefaultLight, NoSkyComesThroughWalls) {
    Mesh room = make_box(Vec3(2, 2, 2));
    Material matt;
    matt.metallic = 0;
    matt.roughness = 1;
    room.set_material(matt);
    Scene scene;
    scene.show(room, "room");
    scene.set_environment(constant_environment(1));
    app::Session session(scene);
    for (Auto<bool>* lamp : {&session.settings().lights.key.enabled, &session.settings().lights.fill.enabled,
                             &session.settings().lights.rim.enabled})
        *lamp = false;
    look_from(session, Vec3d(0.7, 0.5, 0.8), 80);
    const Image seen = session.render({Vec2i(64, 48), 8});
    const uint8_t* middle = seen.at<uint8_t>(32, 24);
    EXPECT_LE(int(*std::max_element(middle, middle + 3)), 1);
}

// What is written as scene-linear is denoised too, for nobody asked for noise.
TEST(DefaultLight, LinearImagesAreDenoised) {
    Scene scene = with_box();
    app::Session session(scene);
    const auto drawn = [&](Denoising denoise) {
        session.settings().path.denoise = denoise;
        return session.render({Vec2i(32, 24), 4, app::Encoding::scene_linear});
    };
    const Image off = drawn(Denoising::off);
    EXPECT_FALSE(std::ranges::equal(drawn(Denoising::best).bytes(), off.bytes()));
}

// The points of 2 x 2 pixels of 4 samples, of 4 x 4 pixels of 1 and of a pixel of 16 are (0, 4, 2)-nets: each
// of the 16 rectangles of area 1/16, whatever its shape, holds one.
TEST(PathSampler, NeighboursFillTheSquareTogether) {
    for (const auto& [side, samples] : {std::pair(1u, 16u), {2u, 4u}, {4u, 1u}})
        for (uint32_t pair = 0; pair < 4; ++pair)
            for (int shape = 0; shape <= 4; ++shape) {
                std::set<std::pair<int, int>> cells;
                for (uint32_t i = 0; i < 16; ++i) {
                    const uint32_t pixel = i / samples;
                    const PathSampler sampler(64 + pixel % side, 8 + pixel / side, i % samples, samples);
                    const Vec2 u = sampler.pair(1, pair);
                    ASSERT_TRUE(u.minCoeff() >= 0 && u.maxCoeff() < 1);
                    cells.emplace(int(u.x() * float(1 << shape)), int(u.y() * float(1 << (4 - shape))));
                }
                EXPECT_EQ(cells.size(), 16u) << side << " " << pair << " " << shape;
            }
}

// Kernels compute the points of many paths.
TEST(PathSampler, ManyPathsGetThePointsOfEach) {
    render::PathBatch batch(37);
    for (uint32_t i = 0; i < 37; ++i) {
        render::PathState state;
        state.sampler = PathSampler(i * 131, i, i % 8, 8);
        batch.set_state(batch.count++, state);
    }
    const render::PathVectors<2> points = batch.points(3, 2);
    for (size_t i = 0; i < 37; ++i) EXPECT_EQ(points.at(i), batch.state[i].sampler.pair(3, 2)) << i;
}

// Distant pixels, for which 32 bits have no room, do not repeat each other.
TEST(PathSampler, FarPixelsDiffer) {
    std::set<float> seen;
    for (uint32_t x = 0; x < 8; ++x) seen.insert(PathSampler(x << 8, 0, 0, 65536).pair(0, 0).x());
    EXPECT_EQ(seen.size(), 8u);
}

}  // namespace easypbr::default_light_test
