#include "easypbr/gpu/line_segments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace easypbr::gpu::line_segments_test {
namespace {

/// A square of two triangles, each with three vertices of its own; the second one is `apart` above the first.
MeshData split_square(float apart) {
    MeshData mesh;
    mesh.V =
        Array3f(Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, apart}, {1, 1, apart}, {0, 1, apart}});
    mesh.F = Array3i(Array3i::Dense{{0, 1, 2}, {3, 4, 5}});
    mesh.source_vertex = Array1i(Array1i::Dense{{0}, {1}, {2}, {0}, {2}, {3}});
    return mesh;
}

TEST(Wireframe, TakesVerticesThatWereSplitFromOneForOne) {
    MeshData mesh = split_square(0);
    EXPECT_EQ(wireframe_segments(mesh).size(), 5u) << "four sides and the diagonal";
    constexpr int32_t most = std::numeric_limits<int32_t>::max();
    MeshData far = mesh;
    far.source_vertex = Array1i(Array1i::Dense{{most}, {1}, {7}, {most}, {7}, {0}});
    EXPECT_EQ(wireframe_segments(far).size(), 5u) << "whatever the numbers are";
    mesh.source_face = Array1i(Array1i::Dense{{0}, {0}});
    EXPECT_EQ(wireframe_segments(mesh).size(), 4u) << "the diagonal is inside of the polygon";
    MeshData moved = split_square(1);
    moved.source_face = mesh.source_face;
    EXPECT_EQ(wireframe_segments(moved).size(), 6u) << "two triangles at different places";
}

TEST(Wireframe, HasTheColoursOfOneFaceAtEachEdge) {
    MeshData mesh = split_square(0);
    mesh.C = ArrayXf(ArrayXf::Dense{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}});
    const std::vector<Segment> segments = wireframe_segments(mesh);
    EXPECT_TRUE(std::ranges::all_of(segments, [](const Segment& s) { return s.color_a == s.color_b; }));
    // Two sides and the diagonal, at which the red face comes first.
    EXPECT_EQ(std::ranges::count(segments, Rgba8{255, 0, 0, 255}, &Segment::color_a), 3);
}

// A path 3-0-2 with its rows against each other, a ring of 4, 5 and 6, and three arms that meet at 7.
TEST(EdgeChains, GoFromEndToEnd) {
    MeshData mesh;
    mesh.V = Array3f(Array3f::Dense::Zero(11, 3));
    mesh.E = Array2i(Array2i::Dense{{3, 0}, {2, 0}, {5, 4}, {5, 6}, {4, 6}, {7, 8}, {9, 7}, {7, 10}});
    const std::vector<ChainStep> steps = edge_chains(mesh);
    ASSERT_EQ(steps.size(), 8u);
    const auto expect = [&](size_t i, uint32_t segment, bool reversed, bool first) {
        EXPECT_EQ(steps[i].segment, segment) << i;
        EXPECT_EQ(steps[i].reversed, reversed) << i;
        EXPECT_EQ(steps[i].first, first) << i;
    };
    expect(0, 1, false, true);  // 2-0-3, from the first end on
    expect(1, 0, true, false);
    expect(2, 5, false, true);  // the arms of 7
    expect(3, 6, true, true);
    expect(4, 7, false, true);
    expect(5, 2, false, true);  // 5-4-6-5
    expect(6, 4, false, false);
    expect(7, 3, true, false);
}

}  // namespace
}  // namespace easypbr::gpu::line_segments_test
