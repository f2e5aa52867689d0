// What the rasteriser finds in each pixel.
#include "easypbr/render/raster/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "easypbr/geometry/primitives.h"

namespace easypbr::render::visibility_test {
namespace {

// Every pixel of a quad belongs to exactly one of its two triangles, and shared edges leave no gap.
TEST(VisibilityBuffer, EdgesAreWatertight) {
    Array3f::Dense V(4, 3);
    V << -0.5f, -0.5f, 0.5f, 0.51f, -0.47f, 0.5f, 0.5f, 0.5f, 0.5f, -0.49f, 0.48f, 0.5f;
    Array3i::Dense both(2, 3);
    both << 0, 1, 2, 0, 2, 3;
    const auto count = [&](const Array3i::Dense& F) {
        VisibilityBuffer buffer;
        buffer.clear(Vec2i(101, 77), {0, 0, 101, 77});
        const Array3f vertices(V);
        const Array3i faces(F);
        EXPECT_TRUE(buffer.draw({vertices, faces, 0, int(F.rows()), Mat4::Identity(), true, false}, 0));
        return std::ranges::count_if(buffer.pixels(), [](uint64_t p) { return p != 0; });
    };
    const auto whole = count(both);
    EXPECT_EQ(whole, count(both.topRows(1)) + count(both.bottomRows(1)));
    // 101 x 77 pixels, the quad covers 0.99^2 / 4 of them; each edge may round by half a pixel.
    EXPECT_NEAR(double(whole), 101 * 77 * 0.2450, 60);
}

/// A ball whose triangles are half a pixel to four pixels wide in the pictures below. Its back is drawn too.
struct Ball {
    MeshData mesh = *make_sphere(0.9f, 128).snapshot();
    ScreenTriangles triangles() const {
        Mat4 clip = Mat4::Identity();
        clip(2, 2) = 0.5f;
        clip(2, 3) = 0.5f;
        return {mesh.V, mesh.F, 0, int(mesh.F.rows()), clip, true, false};
    }
};

// What is kept of a pixel does not change which triangles cover it or how near they are.
TEST(VisibilityBuffer, DepthsAndCoverageAreThoseOfTheWholeBuffer) {
    const Ball ball;
    for (const Vec2i& size : {Vec2i(61, 47), Vec2i(403, 380)}) {
        const PixelRect all{0, 0, size.x(), size.y()};
        VisibilityBuffer whole;
        whole.clear(size, all);
        ASSERT_TRUE(whole.draw(ball.triangles(), 0));
        DepthBuffer depths;
        depths.clear(size, -1);
        ASSERT_TRUE(depths.draw(ball.triangles()));
        std::vector<uint8_t> covered(whole.pixels().size());
        TriangleRaster raster;
        raster.set_area(size, all);
        ASSERT_TRUE(cover(raster, ball.triangles(), covered));
        int seen = 0;
        for (size_t i = 0; i < covered.size(); ++i) {
            const uint64_t pixel = whole.pixels()[i];
            ASSERT_EQ(covered[i], pixel != 0) << i;
            ASSERT_EQ(std::bit_cast<float>(depths.bits()[i]), pixel ? VisibilityBuffer::depth_of(pixel) : -1);
            seen += covered[i];
        }
        // An ellipse of 0.9 of the picture's halves, inscribed by polygons: half a pixel of its perimeter.
        const double exact = pi * 0.45 * 0.45 * size.x() * size.y();
        EXPECT_NEAR(seen, exact, pi * 0.9 * size.x() / 2);
    }
}

// A part of the picture holds the same as the whole there, also where its edge cuts the smallest triangles.
TEST(VisibilityBuffer, APartHoldsWhatTheWholeHolds) {
    const Ball ball;
    const Vec2i size(61, 47);
    VisibilityBuffer whole, part;
    whole.clear(size, {0, 0, size.x(), size.y()});
    ASSERT_TRUE(whole.draw(ball.triangles(), 7));
    for (const PixelRect& area :
         {PixelRect{14, 10, 1, 27}, PixelRect{9, 21, 40, 1}, PixelRect{15, 12, 20, 23}}) {
        part.clear(size, area);
        ASSERT_TRUE(part.draw(ball.triangles(), 7));
        for (int y = 0; y < area.height; ++y)
            for (int x = 0; x < area.width; ++x)
                ASSERT_EQ(part.pixels()[size_t(y * area.width + x)],
                          whole.pixels()[size_t((area.y + y) * size.x() + area.x + x)]);
    }
}

}  // namespace
}  // namespace easypbr::render::visibility_test
