// What is kept in the order of batches is what the cloud has.
#include "easypbr/render/primitives/points/point_order.h"

#include <random>

#include <gtest/gtest.h>

#include "easypbr/core/background.h"

namespace easypbr::render::point_order_test {
namespace {

MeshData cloud(int count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-1, 1);
    Array3f::Dense V(count, 3);
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) V(i, k) = place(random);
    MeshData mesh;
    mesh.V = Array3f(std::move(V));
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
    const PointBatches batches(cloud(count).V);
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
    const MeshData large = cloud(1 << 15), small = cloud(1000);
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
    MeshData mesh = cloud(1 << 15);
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
    EXPECT_EQ(known.draw(mesh, true).batches, before.batches);
    EXPECT_EQ(known.draw(mesh, true).colors, nullptr);
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
}  // namespace easypbr::render::point_order_test
