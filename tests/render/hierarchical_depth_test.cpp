// What is hidden is left out, and nothing else.
#include "easypbr/render/raster/hierarchical_depth.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "easypbr/geometry/primitives.h"
#include "easypbr/gl/context.h"
#include "easypbr/render/raster/visibility.h"
#include "easypbr/scene/scene.h"
#include "render_test.h"
#include "shuffled_mesh.h"
#include "view_of_center.h"

namespace easypbr::render::hierarchical_depth_test {
namespace {

const Vec2i size(320, 240);
const PixelRect whole{0, 0, size.x(), size.y()};

TEST(HierarchicalDepth, HidesWhatIsBehindAllPixels) {
    const PixelRect area{5, 3, 21, 13};  // blocks at the right and at the bottom are cut off
    std::vector<float> depths(size_t(area.width) * size_t(area.height), 0.0f);
    HierarchicalDepth hierarchy;
    hierarchy.clear(area);
    const auto hides = [&](const ScreenBounds& bounds) {
        return hierarchy.hides(bounds, [&](size_t pixel) { return depths[pixel]; });
    };
    const ScreenBounds all{5, 3, 25, 15, 0.25f}, corner{24, 14, 25, 15, 0.25f};
    EXPECT_FALSE(hides(all));
    std::ranges::fill(depths, 0.25f);
    EXPECT_FALSE(hides(all)) << "of the same depth another face may be seen";
    std::ranges::fill(depths, 0.3f);
    EXPECT_TRUE(hides(all));
    EXPECT_FALSE(hides({5, 3, 25, 15, 0.3f}));
    EXPECT_FALSE(hides({5, 3, 25, 15, std::numeric_limits<float>::infinity()}));
    EXPECT_TRUE(hides({6, 3, 5, 15, 1.0f})) << "no pixel is covered";
    for (const size_t hole : {size_t(0), depths.size() - 1, depths.size() / 2}) {
        hierarchy.clear(area);
        std::ranges::fill(depths, 0.3f);
        depths[hole] = 0;
        EXPECT_FALSE(hides(all)) << hole;
        EXPECT_EQ(hides(corner), hole != depths.size() - 1) << hole;
        depths[hole] = 0.5f;
        EXPECT_TRUE(hides(all)) << hole;
    }
}

TEST(NearToFar, KeepsAllThatIsNotDropped) {
    const std::vector<float> depths{0.5f, -1, 0.1f, 1, 0, 0.5f, -1, 0.99f};
    EXPECT_EQ(near_to_far(depths), (std::vector<uint32_t>{3, 7, 0, 5, 2, 4}));
    EXPECT_EQ(near_to_far(std::vector<float>{0.5f, 0.5f, -1}), (std::vector<uint32_t>{0, 1}));
    EXPECT_TRUE(near_to_far(std::vector<float>{-1}).empty());
}

// Points of spheres, rounded as rasterisers do, at all distances, before, around and beside the viewer.
TEST(SphereCulling, BoundsHoldWhatPointsCover) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::normal_distribution<float> normal;
    const PixelRect area{40, 30, 200, 150};
    int seen = 0;
    for (int i = 0; i < 4000; ++i) {
        const Camera camera = camera_at(Vec3d(unit(random), unit(random), 1.5 + unit(random)), i % 2 == 1);
        const Mat4 m = clip_from(camera, size);
        const Vec3 center = Vec3(unit(random), unit(random), unit(random)) * 2;
        const float radius = std::exp(4 * unit(random) - 3);
        const ScreenBounds bounds = SphereCulling(m, size, area).bounds(center, radius);
        for (int k = 0; k < 20; ++k) {
            const Vec3 p =
                center + Vec3(normal(random), normal(random), normal(random)).normalized() * radius;
            const Vec4 clip = m * p.homogeneous();
            const float depth = clip.z() / clip.w();
            if (!(clip.w() > 0 && depth > 0 && depth <= 1)) continue;
            const int x = int(std::floor((clip.x() / clip.w() + 1) * float(size.x()) / 2)),
                      y = int(std::floor((1 - clip.y() / clip.w()) * float(size.y()) / 2));
            if (x < area.x || x >= area.x + area.width || y < area.y || y >= area.y + area.height) continue;
            ++seen;
            ASSERT_LE(depth, bounds.nearest);
            ASSERT_TRUE(x >= bounds.left && x <= bounds.right && y >= bounds.top && y <= bounds.bottom)
                << x << ' ' << y;
        }
    }
    EXPECT_GT(seen, 5000);
}

// A ball before the viewer: its near pole's depth, and no more pixels than its tangent cone and the margin.
TEST(SphereCulling, BoundsAreTight) {
    const Camera camera = camera_at(Vec3d(0, 0, 4), false);
    const ScreenBounds bounds =
        SphereCulling(clip_from(camera, size), size, whole).bounds(Vec3::Zero(), 0.5f);
    const Vec4 pole = clip_from(camera, size) * Vec4(0, 0, 0.5f, 1);
    EXPECT_NEAR(bounds.nearest, pole.z() / pole.w(), 1e-5f * bounds.nearest);
    // From the centre of the picture, with the near pole's distance: 0.5 / 3.5 of the tangent of half the
    // angle of view.
    const double half_height = 0.5 / 3.5 / std::tan(radians(camera.fov_y_deg) / 2) * size.y() / 2;
    EXPECT_NEAR(bounds.bottom - bounds.top + 1, 2 * half_height, 4);
    EXPECT_NEAR(bounds.right - bounds.left + 1, 2 * half_height, 4);
}

/// Meshes as one, of at least so many vertices.
MeshData joined(const std::vector<MeshData>& meshes, Eigen::Index least = 0) {
    Eigen::Index vertices = 0, faces = 0;
    for (const MeshData& mesh : meshes) vertices += mesh.V.rows(), faces += mesh.F.rows();
    Array3f::Dense V = Array3f::Dense::Zero(std::max(vertices, least), 3);
    Array3i::Dense F(faces, 3);
    vertices = faces = 0;
    for (const MeshData& mesh : meshes) {
        V.middleRows(vertices, mesh.V.rows()) = mesh.V;
        F.middleRows(faces, mesh.F.rows()).array() = mesh.F.array() + int(vertices);
        vertices += mesh.V.rows(), faces += mesh.F.rows();
    }
    MeshData all;
    all.V = std::move(V);
    all.F = std::move(F);
    return all;
}

/// Balls one in another, the innermost one first.
MeshData nested_balls(int count) {
    std::vector<MeshData> balls;
    for (int i = count - 1; i >= 0; --i) balls.push_back(*make_sphere(1 - 0.05f * float(i), 150).snapshot());
    return joined(balls);
}

/// Keeps the nearest depths, and counts what is drawn.
struct CountedDepths {
    std::vector<float> depths = std::vector<float>(size_t(whole.width) * size_t(whole.height), 0.0f);
    HierarchicalDepth hierarchy;
    std::atomic<size_t> calls{0};

    bool hides(const ScreenBounds& bounds) {
        return hierarchy.hides(bounds, [&](size_t pixel) {
            return std::atomic_ref(depths[pixel]).load(std::memory_order_relaxed);
        });
    }
    void put(size_t pixel, float depth) {
        const std::atomic_ref cell(depths[pixel]);
        float seen = cell.load();
        while (depth > seen && !cell.compare_exchange_weak(seen, depth)) {
        }
        ++calls;
    }
};

/// Squares of 200 x 200 quads, one behind another, the farthest one first.
MeshData layers_of_quads(int count) {
    constexpr int n = 201;
    std::vector<MeshData> layers;
    for (int i = count - 1; i >= 0; --i) {
        Array3f::Dense V(n * n, 3);
        Array3i::Dense F(2 * (n - 1) * (n - 1), 3);
        for (int y = 0, at = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const int v = y * n + x;
                V.row(v) << 2 * float(x) / (n - 1) - 1, 2 * float(y) / (n - 1) - 1, -0.2f * float(i);
                if (x == n - 1 || y == n - 1) continue;
                F.row(at++) << v, v + 1, v + n + 1;
                F.row(at++) << v, v + n + 1, v + n;
            }
        MeshData layer;
        layer.V = std::move(V);
        layer.F = std::move(F);
        layers.push_back(layer);
    }
    return joined(layers);
}

// Seven of eight squares are hidden by the nearest. Its own edges pass through blocks of which pixels are
// empty.
TEST(HierarchicalDepth, HiddenClustersAreNotDrawn) {
    const auto calls = [&](const MeshData& drawn, bool culls, std::vector<float>& depths) {
        const MeshPart part{.name = {}, .first_face = 0, .face_count = int(drawn.F.rows())};
        const FaceClusters clusters(drawn.V, drawn.F, part);
        const Mat4 clip = clip_from(camera_at(Vec3d(0, 0, 4), false), size);
        const ScreenTriangles triangles{drawn.V, drawn.F, 0,    part.face_count, clip,
                                        true,    false,   true, &clusters};
        TriangleRaster raster;
        raster.set_area(size, whole);
        CountedDepths found;
        found.hierarchy.clear(whole);
        const auto put = [&](size_t pixel, float depth, uint32_t) { found.put(pixel, depth); };
        EXPECT_TRUE(culls ? raster.draw(triangles, put, found) : raster.draw(triangles, put));
        depths = found.depths;
        return double(found.calls);
    };
    const MeshData all_layers = layers_of_quads(8), nearest = layers_of_quads(1);
    for (const bool shuffles : {false, true}) {
        std::vector<float> all, culled, alone;
        const MeshData mesh = shuffles ? shuffled(all_layers, 1) : all_layers;
        const double drawn = calls(mesh, false, all), seen = calls(nearest, false, alone);
        calls(mesh, true, culled);
        EXPECT_EQ(all, culled);
        // With several threads it depends on their order how much is hidden in time.
        double kept = 0;
        tbb::task_arena(1).execute([&] { kept = calls(mesh, true, culled); });
        EXPECT_EQ(all, culled);
        EXPECT_EQ(all, alone);
        // By perspective the others are smaller: the sum of (4 / (4 + 0.2 i))^2. Edges are rounded to pixels.
        EXPECT_NEAR(drawn / seen, 5.964, 0.05);
        EXPECT_LT(kept, 1.5 * seen);
    }
}

// Whatever is left out: the pixels are those of faces drawn one by one.
TEST(HierarchicalDepth, ChangesNoPixel) {
    const MeshData balls = nested_balls(5);
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(-1, 1);
    MeshData slivers = balls;
    Array3f::Dense V = balls.V;
    // Long thin faces, whose planes are not known to the last bit.
    for (Eigen::Index i = 0; i < V.rows(); i += 97) V.row(i) = Vec3(unit(random), unit(random), unit(random));
    slivers.V = std::move(V);
    const PixelRect part{37, 21, 150, 101};
    for (const MeshData* mesh : {&balls, static_cast<const MeshData*>(&slivers)}) {
        const FaceClusters clusters(mesh->V, mesh->F,
                                    {.name = {}, .first_face = 0, .face_count = int(mesh->F.rows())});
        for (const Vec3d& eye : {Vec3d(0, 0, 4), Vec3d(1, 1.3, 0.9), Vec3d(0.1, 0.2, 0.3)})
            for (const bool orthographic : {false, true})
                for (const PixelRect& area : {whole, part}) {
                    const auto drawn = [&](const FaceClusters* in) {
                        VisibilityBuffer buffer;
                        buffer.clear(size, area);
                        EXPECT_TRUE(buffer.draw(
                            {mesh->V, mesh->F, 0, int(mesh->F.rows()),
                             clip_from(camera_at(eye, orthographic), size), true, false, true, in},
                            3));
                        return std::vector<uint64_t>(buffer.pixels().begin(), buffer.pixels().end());
                    };
                    ASSERT_EQ(drawn(&clusters), drawn(nullptr)) << eye.transpose() << orthographic;
                }
    }
}

// Slivers along lines through centres of pixels, 1/256 of a pixel wide: their planes are steep, and not known
// to the last bit.
TEST(HierarchicalDepth, NoPixelIsNearerThanItsTriangle) {
    constexpr int count = 2000;
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0, 1);
    Array3f::Dense V(3 * count, 3);
    Array3i::Dense F(count, 3);
    const auto below = [&](int n) { return int(unit(random) * float(n)); };
    const auto corner = [&](float x, float y) {
        return Vec3(2 * x / float(size.x()) - 1, 1 - 2 * y / float(size.y()), unit(random));
    };
    for (int i = 0; i < count; ++i) {
        const float x = float(below(100)) + 0.5f, y = float(below(40)) + 0.5f, dx = float(1 + below(20)),
                    dy = float(1 + below(18)), side = i % 2 == 0 ? 1 : -1;
        V.row(3 * i) = corner(x, y);
        V.row(3 * i + 1) = corner(x + 10 * dx, y + 10 * dy);
        V.row(3 * i + 2) = corner(x + 5 * dx, y + 5 * dy + side / 256);
        F.row(i) << 3 * i, 3 * i + 1, 3 * i + 2;
    }
    const Array3f vertices(V);
    const Array3i faces(F);
    TriangleRaster raster;
    raster.set_area(size, whole);
    std::atomic<int> covered{0}, nearer{0};
    const auto put = [&](size_t, float depth, uint32_t face) {
        ++covered;
        nearer += depth > V.col(2).segment(3 * Eigen::Index(face), 3).maxCoeff();
    };
    ASSERT_TRUE(raster.draw({vertices, faces, 0, count, Mat4::Identity(), true, false, true}, put));
    EXPECT_GT(covered, 1000);
    EXPECT_EQ(nearer, 0);
}

TEST(HierarchicalDepth, HidesNothingOfLayers) {
    const MeshData mesh = nested_balls(1);
    VisibilityBuffer buffer;
    buffer.clear(size, whole);
    const Mat4 clip = clip_from(camera_at(Vec3d(0, 0, 4), false), size);
    ASSERT_TRUE(buffer.draw({mesh.V, mesh.F, 0, int(mesh.F.rows()), clip, true, false, true}, 0));
    const ScreenBounds behind = SphereCulling(clip, size, whole).bounds(Vec3::Zero(), 0.3f);
    EXPECT_TRUE(buffer.hides(behind));
    PeelLimits limits;
    limits.depths.assign(buffer.pixels().size(), -1.0f);
    buffer.begin_layer(limits);
    EXPECT_FALSE(buffer.hides(behind));
}

// Many objects around the viewer, some behind a wall, some cut by the edges: the same surfaces as those of
// one mesh, which is too large to be left out.
TEST(HierarchicalDepth, HiddenObjectsAreNotMissed) {
    const auto context = gl::Context::create();
    if (!context->info().software) GTEST_SKIP() << "the driver draws";
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    const MeshData ball = *make_sphere(0.15f, 16).snapshot();
    std::vector<MeshData> balls(300, ball);
    Scene parts, one;
    for (MeshData& mesh : balls) {
        const Vec3 place = Vec3d(3 * unit(random), 2 * unit(random), 3 * unit(random)).cast<float>();
        Array3f::Dense V = ball.V;
        V.rowwise() += place.transpose();
        mesh.V = std::move(V);
        parts.show(Mesh(mesh.V, mesh.F), "ball " + std::to_string(&mesh - balls.data()));
    }
    const MeshData all = joined(balls, 1 << 17);
    one.show(Mesh(all.V, all.F), "balls");
    const auto depths_of = [&](Scene& scene) {
        scene.show(facing_square(0.5f), "wall");
        app::Session session = plain_session(scene, 256);
        look_from(session, Vec3d(0.3, 0.4, 1.5), 60);
        session.settings().camera.near = 0.1;
        return session.render_layers({"depth"}).at("depth");
    };
    const Image in_parts = depths_of(parts), in_one = depths_of(one);
    int covered = 0;
    for (int y = 0; y < in_one.height(); ++y)
        for (int x = 0; x < in_one.width(); ++x) {
            const float a = in_parts.at<float>(x, y)[0], b = in_one.at<float>(x, y)[0];
            covered += a > 0;
            ASSERT_EQ(a, b) << x << ' ' << y;
        }
    EXPECT_GT(covered, 256 * 256 / 4);
}

}  // namespace
}  // namespace easypbr::render::hierarchical_depth_test
