// Faces in clusters: the same pixels as face by face, whatever is looked at.
#include "easypbr/render/raster/face_clusters.h"

#include <algorithm>
#include <bit>
#include <vector>

#include <gtest/gtest.h>

#include "easypbr/core/background.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/raster/visibility.h"
#include "easypbr/scene/mesh.h"
#include "shuffled_mesh.h"
#include "view_of_center.h"

namespace easypbr::render::face_clusters_test {
namespace {

const Vec2i size(160, 120);

MeshPart all_of(const MeshData& mesh) {
    return {.name = {}, .first_face = 0, .face_count = int(mesh.F.rows())};
}

Mat4 clip_from(const Vec3d& eye, bool orthographic) {
    return easypbr::clip_from(camera_at(eye, orthographic), size);
}

/// Keys of pixels, of all or of a part of the picture.
std::vector<uint64_t> drawn(ScreenTriangles triangles, const FaceClusters* clusters, const PixelRect& area) {
    triangles.clusters = clusters;
    VisibilityBuffer buffer;
    buffer.clear(size, area);
    EXPECT_TRUE(buffer.draw(triangles, 7));
    return {buffer.pixels().begin(), buffer.pixels().end()};
}

TEST(FaceClusters, HoldEachFaceOnce) {
    const MeshData own = *make_teapot(1, 60).snapshot();
    for (const MeshData& mesh : {own, shuffled(own, 1)}) {
        const MeshPart part{.name = {}, .first_face = 1000, .face_count = int(mesh.F.rows()) - 3000};
        const FaceClusters made(mesh.V, mesh.F, part);
        std::vector<int> times(size_t(part.face_count), 0);
        for (const FaceClusters::Cluster& cluster : made.clusters()) {
            const uint8_t* const corners = made.corners_of(cluster);
            for (int face = 0; face < cluster.face_count; ++face) {
                const uint32_t number = made.face_of(cluster, face);
                ++times.at(number);
                for (int k = 0; k < 3; ++k) {
                    const int at = corners[k * cluster.face_count + face];
                    ASSERT_LT(at, cluster.vertex_count);
                    const Vec3 copy(cluster.vertices[at], cluster.vertices[cluster.vertex_count + at],
                                    cluster.vertices[2 * cluster.vertex_count + at]);
                    const int vertex = mesh.F(part.first_face + int(number), k);
                    ASSERT_EQ(copy, Vec3(mesh.V.row(vertex)));
                    EXPECT_LE((copy - cluster.center).norm(), cluster.radius * 1.0001f);
                }
            }
        }
        EXPECT_TRUE(std::ranges::all_of(times, [](int count) { return count == 1; }));
    }
}

// A cluster with few faces costs as much as a full one.
TEST(FaceClusters, AreFullWhateverTheOrderOfTheFaces) {
    const MeshData own = *make_teapot(1, 60).snapshot();
    for (const MeshData& mesh : {own, shuffled(own, 2)}) {
        const FaceClusters made(mesh.V, mesh.F, all_of(mesh));
        size_t vertices = 0;
        for (const FaceClusters::Cluster& cluster : made.clusters()) vertices += size_t(cluster.vertex_count);
        EXPECT_LT(double(vertices), 0.9 * double(mesh.F.rows()));
        EXPECT_LT(double(made.clusters().size()), 1.5 * double(mesh.F.rows()) / 256);
    }
}

TEST(FaceClusters, DrawWhatFacesDraw) {
    const MeshData own = *make_teapot(1, 30).snapshot();
    const PixelRect whole{0, 0, size.x(), size.y()}, part{37, 21, 64, 50};
    // From afar, near, from within, and so near that faces cross the near plane and the edges of what is
    // drawn without being clipped.
    const Vec3d eyes[] = {{3, 2, 4}, {0.5, 0.6, 1}, {0, 0.4, 0}, {0.02, 0.1, 0.62}, {-2, -3, 1}};
    const std::string before(native::instruction_set());
    for (const MeshData& mesh : {own, shuffled(own, 3)}) {
        const FaceClusters clusters(mesh.V, mesh.F, all_of(mesh));
        for (const std::string_view name : native::instruction_sets())
            for (const Vec3d& eye : eyes)
                for (const bool orthographic : {false, true})
                    for (const bool mirrored : {false, true})
                        for (const bool both_sides : {false, true})
                            for (const PixelRect& area : {whole, part}) {
                                native::use_instruction_set(name);
                                const ScreenTriangles t{mesh.V,
                                                        mesh.F,
                                                        0,
                                                        int(mesh.F.rows()),
                                                        clip_from(eye, orthographic),
                                                        both_sides,
                                                        mirrored,
                                                        true};
                                ASSERT_EQ(drawn(t, &clusters, area), drawn(t, nullptr, area))
                                    << name << " from " << eye.transpose() << orthographic << mirrored
                                    << both_sides << area.width;
                            }
    }
    native::use_instruction_set(before);
}

// As shadow maps have it: nothing is drawn where something would have to be clipped.
TEST(FaceClusters, AreNotDrawnBeforeTheNearPlaneUnlessClipped) {
    const MeshData mesh = *make_teapot(1, 30).snapshot();
    const FaceClusters clusters(mesh.V, mesh.F, all_of(mesh));
    for (const Vec3d& eye : {Vec3d(3, 2, 4), Vec3d(0, 0.4, 0)}) {
        ScreenTriangles t{mesh.V, mesh.F, 0, int(mesh.F.rows()), clip_from(eye, false), false, false, false};
        DepthBuffer by_faces, by_clusters;
        by_faces.clear(size, -1);
        by_clusters.clear(size, -1);
        const bool is_drawn = by_faces.draw(t);
        t.clusters = &clusters;
        EXPECT_EQ(by_clusters.draw(t), is_drawn);
        EXPECT_TRUE(std::ranges::equal(by_clusters.bits(), by_faces.bits()));
    }
}

// Half of a ball is turned away, and one beside the picture is not looked at.
TEST(FaceClusters, AreDroppedAsAWhole) {
    const MeshData mesh = *make_sphere(1, 200).snapshot();
    const FaceClusters clusters(mesh.V, mesh.F, all_of(mesh));
    const auto dropped = [&](const Vec3d& shift, bool both_sides) {
        Mat4 clip = clip_from(Vec3d(0, 0, 8), false);
        clip.col(3) += clip.leftCols<3>() * shift.cast<float>();
        const ScreenTriangles t{mesh.V, mesh.F, 0, int(mesh.F.rows()), clip, both_sides, false, true};
        const ClusterCulling culling(t, size, {0, 0, size.x(), size.y()});
        const auto count = std::ranges::count_if(
            clusters.clusters(),
            [&](const FaceClusters::Cluster& cluster) { return culling.depth(cluster) < 0; });
        return double(count) / double(clusters.clusters().size());
    };
    EXPECT_EQ(dropped(Vec3d::Zero(), true), 0);
    // (1 + 1 / 8) / 2 of the ball is turned away; clusters at its rim have faces on both sides.
    EXPECT_GT(dropped(Vec3d::Zero(), false), 0.25);
    EXPECT_LT(dropped(Vec3d::Zero(), false), 0.57);
    EXPECT_EQ(dropped(Vec3d(9, 0, 0), true), 1);
    EXPECT_EQ(dropped(Vec3d(0, 0, 12), true), 1);
}

TEST(FaceClusters, TakeWhatIsNotANumber) {
    MeshData mesh = *make_teapot(1, 30).snapshot();
    Array3f::Dense V = mesh.V;
    V.row(100).setConstant(std::numeric_limits<float>::quiet_NaN());
    V(2000, 1) = std::numeric_limits<float>::infinity();
    mesh.V = std::move(V);
    for (const MeshData& m : {mesh, shuffled(mesh, 4)}) {
        const FaceClusters clusters(m.V, m.F, all_of(m));
        const ScreenTriangles t{m.V,  m.F,   0,   int(m.F.rows()), clip_from(Vec3d(3, 2, 4), false),
                                true, false, true};
        const PixelRect whole{0, 0, size.x(), size.y()};
        EXPECT_EQ(drawn(t, &clusters, whole), drawn(t, nullptr, whole));
    }
}

TEST(ClusteredMeshes, AreMadeWhenAPartIsDrawnAgain) {
    const Mesh handle = make_teapot(1, 60);
    const MeshData mesh = *handle.snapshot(), small = *make_teapot(1, 4).snapshot();
    ClusteredMeshes known;
    EXPECT_EQ(known.draw(mesh, all_of(mesh)), nullptr);
    EXPECT_EQ(known.find(mesh, all_of(mesh)), nullptr);
    known.draw(mesh, all_of(mesh));
    BackgroundWork::wait_for_all();
    EXPECT_NE(known.draw(mesh, all_of(mesh)), nullptr);
    EXPECT_EQ(known.find(mesh, all_of(mesh)), known.draw(mesh, all_of(mesh)));
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(known.draw(small, all_of(small)), nullptr);
        BackgroundWork::wait_for_all();
    }
}

}  // namespace
}  // namespace easypbr::render::face_clusters_test
