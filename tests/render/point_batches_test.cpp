// Points in batches: the same pixels as point by point, whatever is looked at.
#include "easypbr/render/raster/point_batches.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "easypbr/core/background.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/primitives/points/point_order.h"
#include "easypbr/render/raster/visibility.h"
#include "view_of_center.h"

namespace easypbr::render::point_batches_test {
namespace {

const Vec2i size(160, 120);

/// Points of a cube in no order, many of them at the same place.
Array3f cloud(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-1, 1);
    Array3f::Dense V(count, 3);
    for (int i = 0; i < count; ++i) {
        if (i > 100 && i % 7 == 0)
            V.row(i) = V.row(i / 2);
        else
            for (int k = 0; k < 3; ++k) V(i, k) = place(random);
    }
    return V;
}

PointSplats splats_from(const Vec3d& eye, bool orthographic) {
    PointSplats splats;
    splats.clip_from_mesh = clip_from(camera_at(eye, orthographic), size);
    return splats;
}

std::vector<uint64_t> drawn(const Array3f& V, PointSplats splats, const PointBatches* batches,
                            const PixelRect& area, const PeelLimits* layer = nullptr) {
    splats.batches = batches;
    VisibilityBuffer buffer;
    buffer.clear(size, area);
    if (layer) buffer.begin_layer(*layer);
    const auto vertex_of = [&](uint32_t id) { return batches ? batches->vertex_of(id - 7) : id - 7; };
    // Some of those at one place look the same.
    buffer.draw_points(V, splats, 7, [&](uint32_t id) {
        return PointRank{uint64_t(vertex_of(id) % 3), vertex_of(id)};
    });
    // Depths and vertices: points are numbered by batches.
    std::vector<uint64_t> seen(buffer.pixels().begin(), buffer.pixels().end());
    for (uint64_t& pixel : seen)
        if (pixel != 0) pixel = pixel >> 32 << 32 | vertex_of(VisibilityBuffer::id_of(pixel));
    return seen;
}

TEST(PointBatches, HoldEachPointOnce) {
    const Array3f V = cloud(1000, 1);
    const PointBatches made(V);
    std::vector<int> times(size_t(V.rows()), 0);
    ASSERT_EQ(made.count(), 4u);
    for (size_t batch = 0; batch < made.count(); ++batch) {
        const int own = made.size_of(batch);
        EXPECT_EQ(own, batch < 3 ? 256 : 1000 - 3 * 256);
        for (int i = 0; i < own; ++i) {
            const uint32_t id = made.ids_of(batch)[i];
            ++times.at(id);
            const float* const p = made.points_of(batch) + i;
            const Vec3 copy(p[0], p[own], p[2 * own]);
            ASSERT_EQ(copy, Vec3(V.row(id)));
            ASSERT_EQ(made.vertex_of(PointBatches::first_place(batch) + uint32_t(i)), id);
            EXPECT_LE((copy - made.sphere_of(batch).center).norm(), made.sphere_of(batch).radius * 1.0001f);
        }
    }
    EXPECT_TRUE(std::ranges::all_of(times, [](int count) { return count == 1; }));
}

TEST(PointBatches, AreOfNeighbours) {
    const PointBatches made(cloud(1 << 15, 2));
    // 128 batches in a cube of 8: each would be a cube with a sphere of 0.34 around it.
    double sum = 0;
    for (size_t batch = 0; batch < made.count(); ++batch) sum += double(made.sphere_of(batch).radius);
    EXPECT_LT(sum / double(made.count()), 0.6);
}

TEST(PointBatches, DrawWhatPointsDraw) {
    const Array3f V = cloud(20000, 3);
    const PointBatches batches(V);
    const PixelRect whole{0, 0, size.x(), size.y()}, part{37, 21, 64, 50};
    const std::string before(native::instruction_set());
    for (const std::string_view name : native::instruction_sets())
        for (const Vec3d& eye : {Vec3d(3, 2, 4), Vec3d(0.3, 0.2, 0.9), Vec3d(0, 0.4, 0)})
            for (const bool orthographic : {false, true})
                for (const bool round : {false, true})
                    for (const PixelRect& area : {whole, part}) {
                        native::use_instruction_set(name);
                        PointSplats splats = splats_from(eye, orthographic);
                        splats.round = round;
                        const auto compare = [&](const char* what) {
                            ASSERT_EQ(drawn(V, splats, &batches, area), drawn(V, splats, nullptr, area))
                                << what << splats.pixels << " " << name << " from " << eye.transpose()
                                << orthographic << round << area.width;
                        };
                        for (const float pixels : {0.4f, 1.0f, 1.5f, 1.99f, 2.0f, 5.3f}) {
                            splats.pixels = pixels;
                            compare("pixels ");
                        }
                        splats.world_pixels = 4;
                        compare("world ");
                        splats.y_per_x = 0.6f;
                        compare("flat ");
                        splats.is_drawn = [](size_t point) { return point % 2 == 0; };
                        compare("some ");
                    }
    native::use_instruction_set(before);
}

TEST(PointBatches, DrawLayersAndTakeWhatIsNotANumber) {
    Array3f::Dense V = cloud(5000, 4);
    V(100, 1) = std::numeric_limits<float>::quiet_NaN();
    V(2000, 0) = std::numeric_limits<float>::infinity();
    const Array3f points(V);
    const PointBatches batches(points);
    const PixelRect whole{0, 0, size.x(), size.y()};
    PeelLimits limits;
    limits.depths.assign(size_t(size.prod()), 0.02f);
    PointSplats splats = splats_from(Vec3d(2, 1, 2), false);
    splats.pixels = 1.7f;
    const auto expected = drawn(points, splats, nullptr, whole, &limits);
    EXPECT_EQ(drawn(points, splats, &batches, whole, &limits), expected);
    EXPECT_GT(std::ranges::count_if(expected, [](uint64_t pixel) { return pixel != 0; }), 1000);
}

// Batches beside the picture are not looked at.
TEST(PointBatches, AreDroppedAsAWhole) {
    const Array3f V = cloud(200000, 5);
    const PointBatches batches(V);
    const PointSplats splats = splats_from(Vec3d(0, 0, 4), false);
    const auto dropped = [&](const PixelRect& area) {
        const Frustum frustum(splats.clip_from_mesh, size, area);
        int count = 0;
        for (size_t i = 0; i < batches.count(); ++i)
            count += frustum.drops(batches.sphere_of(i).center, batches.sphere_of(i).radius);
        return double(count) / double(batches.count());
    };
    EXPECT_EQ(dropped({0, 0, size.x(), size.y()}), 0);
    EXPECT_GT(dropped({0, 0, 20, 120}), 0.8);
    // A third of the picture's height is a third of what the camera sees of the cube, a batch a tenth.
    EXPECT_GT(dropped({60, 40, 40, 40}), 0.4);
    EXPECT_LT(dropped({60, 40, 40, 40}), 0.9);
}

// A wall of points, and a cloud behind it.
TEST(PointBatches, AreLeftOutWhereTheyAreHidden) {
    constexpr int across = 200, behind = 100000;
    const Array3f hidden = cloud(behind, 8);
    Array3f::Dense V(behind + across * across, 3);
    for (int i = 0; i < behind; ++i) V.row(i) = 0.5f * hidden.row(i);
    for (int i = 0; i < across * across; ++i)
        V.row(behind + i) << 2 * float(i % across) / (across - 1) - 1,
            2 * float(i / across) / (across - 1) - 1, 1;
    const Array3f points(V);
    const PointBatches batches(points);
    const PixelRect whole{0, 0, size.x(), size.y()};
    PointSplats splats = splats_from(Vec3d(0, 0, 4), false);
    splats.pixels = 3;
    std::atomic<int> asked{0};
    splats.is_drawn = [&](size_t) { return ++asked > 0; };
    const auto expected = drawn(points, splats, nullptr, whole);
    EXPECT_GT(asked, behind);
    EXPECT_EQ(drawn(points, splats, &batches, whole), expected);
    // With several threads it depends on their order how much is hidden in time.
    asked = 0;
    tbb::task_arena(1).execute([&] { EXPECT_EQ(drawn(points, splats, &batches, whole), expected); });
    EXPECT_LT(asked, across * across + behind / 10);
}

MeshData cloud_mesh(int count) {
    MeshData mesh;
    mesh.V = cloud(count, 9);
    return mesh;
}

/// Colours of 8 bits, with an alpha.
ArrayXf::Dense colors(int count) {
    ArrayXf::Dense C(count, 4);
    for (int i = 0; i < count; ++i)
        C.row(i) << float(i & 255), float(i >> 8 & 255), float(255 - (i & 255)), 9;
    return C / 255;
}

void expect_equal(const PointBatches& batches, const ArrayXf& C) {
    const PointColors made(batches, C);
    for (uint32_t place = 0; place < uint32_t(C.rows()); ++place)
        ASSERT_EQ(made.at(place), Vec3(C.row(batches.vertex_of(place)).head<3>())) << place;
}

TEST(PointColors, AreThoseOfTheVerticesToTheSameBits) {
    constexpr int count = 70000;
    const PointBatches batches(cloud(count, 9));
    ArrayXf::Dense C = colors(count);
    expect_equal(batches, ArrayXf(C));
    // One that is between two codes.
    C(12345, 1) = std::nextafter(C(12345, 1), 1.0f);
    expect_equal(batches, ArrayXf(C));
    // Of files with a large range, and without an alpha.
    C(5, 0) = 3.5f, C(6, 2) = -1;
    expect_equal(batches, ArrayXf(C.leftCols(3)));
}

TEST(BatchedClouds, AreMadeWhenACloudIsDrawnAgain) {
    const MeshData large = cloud_mesh(1 << 15), small = cloud_mesh(1000);
    BatchedClouds known;
    EXPECT_EQ(known.draw(large, false).batches, nullptr);
    known.draw(large, false);
    BackgroundWork::wait_for_all();
    const PointOrder order = known.draw(large, false);
    EXPECT_NE(order.batches, nullptr);
    EXPECT_EQ(order.colors, nullptr);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(known.draw(small, false).batches, nullptr);
        BackgroundWork::wait_for_all();
    }
}

TEST(BatchedClouds, KeepTheirBatchesWhenTheirColorsChange) {
    MeshData mesh = cloud_mesh(1 << 15);
    mesh.C = ArrayXf(colors(1 << 15));
    BatchedClouds known;
    const auto settled = [&] {
        for (int i = 0; i < 4; ++i) {
            known.draw(mesh, true);
            BackgroundWork::wait_for_all();
        }
        return known.draw(mesh, true);
    };
    const PointOrder before = settled();
    ASSERT_NE(before.colors, nullptr);
    mesh.C = ArrayXf(ArrayXf::Dense(1 - mesh.C.array()));
    const PointOrder changed = known.draw(mesh, true);
    EXPECT_EQ(changed.batches, before.batches);
    EXPECT_EQ(changed.colors, nullptr);
    const PointOrder after = settled();
    EXPECT_EQ(after.batches, before.batches);
    ASSERT_NE(after.colors, nullptr);
    EXPECT_EQ(after.colors->at(77), Vec3(mesh.C.row(after.batches->vertex_of(77)).head<3>()));
    // Those that nobody asks for go first.
    known.evict_unused();
    known.draw(mesh, true);
    known.evict_unused();
    EXPECT_EQ(known.draw(mesh, true).colors, after.colors);
}

}  // namespace
}  // namespace easypbr::render::point_batches_test
