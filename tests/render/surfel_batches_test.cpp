// Surfels in batches: the same ellipses and pixels as one by one, whatever is looked at.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "easypbr/core/background.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/primitives/surfels/surfel_projection.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::surfel_batches_test {
namespace {

/// Overlapping surfels of a ball in no order; some of them lie at the same place.
MeshData ball(int count, unsigned seed, bool with_axes = true) {
    std::mt19937 random(seed);
    std::normal_distribution<float> direction;
    std::uniform_real_distribution<float> uniform(0, 1);
    Array3f::Dense N(count, 3), T(count, 3), C(count, 3);
    Array1f::Dense B(count);
    for (int i = 0; i < count; ++i) {
        N.row(i) << direction(random), direction(random), direction(random);
        N.row(i).normalize();
        if (i > 100 && i % 7 == 0) N.row(i) = N.row(i / 2);
        T.row(i) = (0.02f + 0.02f * uniform(random)) *
                   Vec3(N.row(i)).cross(Vec3(0.3f, 0.5f, 0.8f)).normalized().transpose();
        B[i] = 0.02f + 0.02f * uniform(random);
        C.row(i) << uniform(random), uniform(random), uniform(random);
    }
    MeshData data;
    data.V = Array3f(Array3f::Dense(N));
    data.N = Array3f(N);
    data.C = Array3f(C);
    data.style.mode = DrawMode::surfels;
    if (!with_axes) return data;
    data.T = Array3f(T);
    data.B = Array1f(B);
    return data;
}

TEST(SurfelBatches, HoldEachSurfelOnce) {
    const MeshData mesh = ball(1000, 1);
    const SurfelBatches made(mesh, 0.1f, 1.5f);
    ASSERT_EQ(made.count(), 4u);
    std::set<uint32_t> vertices;
    for (size_t i = 0; i < 1000; ++i) {
        const uint32_t vertex = made.vertex_of(i);
        vertices.insert(vertex);
        const native::EllipseVectors<float> vectors = made.vectors_of(i);
        const SurfelAxes axes = surfel_axes(mesh, vertex, Vec3::Zero(), 0.1f, 1.5f);
        const Vec3 p(vectors.p), t(vectors.t), b(vectors.b), n(vectors.n);
        ASSERT_EQ(p, Vec3(mesh.V.row(vertex)));
        ASSERT_EQ(t, axes.t);
        ASSERT_EQ(b, axes.b);
        ASSERT_EQ(n, Vec3(mesh.N.row(vertex)));
        const SurfelBatches::Sphere& sphere = made.sphere_of(i / SurfelBatches::most);
        for (int k = 0; k < 8; ++k) {
            const float angle = float(k) * float(pi) / 4;
            const Vec3 rim = p + std::cos(angle) * t + std::sin(angle) * b;
            ASSERT_LE((rim - sphere.center).norm(), sphere.radius * 1.0001f);
        }
    }
    EXPECT_EQ(vertices.size(), 1000u);
}

TEST(SurfelBatches, AreNotMadeOfSurfelsThatTurnWithTheViewer) {
    MeshData mesh = ball(1000, 2);
    EXPECT_FALSE(SurfelBatches(mesh, 0.1f, 1).empty());
    Array3f::Dense N = mesh.N;
    N.row(500).setZero();
    mesh.N = Array3f(N);
    EXPECT_TRUE(SurfelBatches(mesh, 0.1f, 1).empty());
}

/// A camera at (0.3, 0.2, z) that looks along -z.
native::EllipseView view_from(float z, bool orthographic) {
    Mat4 clip = Mat4::Zero(), away = Mat4::Identity();
    clip(0, 0) = 1.5f;
    clip(1, 1) = 2;
    clip(2, 3) = 0.1f;
    clip(3, orthographic ? 3 : 2) = orthographic ? 1.0f : -1.0f;
    away.col(3) << -0.3f, -0.2f, -z, 1;
    native::EllipseView view;
    Eigen::Map<Mat4>(view.clip_from_mesh[0]) = clip * away;
    Eigen::Map<Vec4>(view.axial) << 0, 0, -1, z;
    Eigen::Map<Vec3>(view.eye) << 0.3f, 0.2f, z;
    Eigen::Map<Vec3>(view.towards_viewer) << 0, 0, 1;
    Eigen::Map<Mat3>(view.normal_from_mesh[0]) << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    Eigen::Map<Mat3>(view.world_from_mesh[0]) << 2, 0, 0, 0, 2, 0, 0, 0, 2;
    view.orthographic = orthographic;
    view.width = 160;
    view.height = 120;
    view.near = 0.1f;
    view.world_scale = 2;
    return view;
}

TEST(SurfelBatches, AreProjectedAsOneByOne) {
    const std::string before(native::instruction_set());
    Array3f::Dense V = ball(5000, 3).V;
    MeshData mesh = ball(5000, 3);
    V(100, 1) = std::numeric_limits<float>::quiet_NaN();
    V(2000, 0) = std::numeric_limits<float>::infinity();
    mesh.V = Array3f(V);
    const SurfelBatches batches(mesh, 0.1f, 1);
    for (const std::string_view name : native::instruction_sets())
        for (const bool orthographic : {false, true})
            for (const float z : {4.0f, 1.2f, 0.9f, -3.0f}) {
                native::use_instruction_set(name);
                const native::EllipseView view = view_from(z, orthographic);
                size_t found = 0, in_batches = 0;
                for (size_t i = 0; i < batches.count(); ++i) {
                    native::EllipseBatch batch = batches.batch(i);
                    batch.view = &view;
                    native::EllipseScreen screen;
                    const int kept = native::set_up_ellipses(batch, screen);
                    in_batches += size_t(kept);
                    int next = 0;
                    for (int k = 0; k < batch.count; ++k) {
                        native::ProjectedEllipse<float> ellipse;
                        const auto vectors = batches.vectors_of(SurfelBatches::most * i + size_t(k));
                        if (!native::project_ellipse(view, vectors, ellipse)) continue;
                        ++found;
                        ASSERT_LT(next, kept);
                        ASSERT_EQ(screen.kept[next++], k) << name << z << orthographic;
                        const auto members = ellipse.all();
                        for (size_t m = 0; m < members.size(); ++m)
                            ASSERT_EQ(screen.ellipses[m][k], *members[m]) << name << z << " member " << m;
                    }
                }
                EXPECT_EQ(found, in_batches);
                EXPECT_EQ(found > 0, z > 0);
            }
    native::use_instruction_set(before);
}

bool equal(const Image& a, const Image& b) {
    const auto left = a.bytes(), right = b.bytes();
    return std::ranges::equal(left, right);
}

/// Pictures before there are batches, and with them.
void compare_pictures(const MeshData& mesh, TransparencyMode mode, const char* what) {
    Scene scene;
    MeshData data = mesh;
    Material material;
    if (mode == TransparencyMode::layers) {
        material.alpha_mode = AlphaMode::blend;
        material.opacity = 0.6f;
    }
    data.materials = {material};
    scene.show(Mesh(data), "ball");
    MeshData other = ball(3000, 9);
    Array3f::Dense V = other.V;
    V.rowwise() += Eigen::RowVector3f(0.7f, 0, 0.4f);
    other.V = Array3f(V);
    scene.show(Mesh(other), "other");
    const std::vector<std::string> names{"depth", "normal_world", "albedo", "element_id", "object_id"};
    for (const Vec3d& eye : {Vec3d(2, 1, 2.5), Vec3d(0.9, 0.3, 0.7)}) {
        app::Session session = plain_session(scene, 150);
        session.settings().transparency.mode = mode;
        look_from(session, eye, 40);
        const auto first = session.render_layers(names);
        look_from(session, -eye, 40);
        const Image picture = session.render();
        // What has been drawn twice is in batches from now on; what is looked at as before is not drawn
        // again.
        look_from(session, 2 * eye, 40);
        session.render();
        BackgroundWork::wait_for_all();
        look_from(session, -eye, 40);
        EXPECT_TRUE(equal(session.render(), picture)) << what;
        look_from(session, eye, 40);
        const auto later = session.render_layers(names);
        for (const std::string& name : names)
            EXPECT_TRUE(equal(first.at(name), later.at(name))) << what << name;
    }
}

TEST(SurfelBatches, DrawWhatSurfelsDraw) {
    compare_pictures(ball(20000, 4), TransparencyMode::layers, "layers ");
    compare_pictures(ball(20000, 5), TransparencyMode::stochastic, "opaque ");
    compare_pictures(ball(20000, 6, false), TransparencyMode::stochastic, "without axes ");
}

}  // namespace
}  // namespace easypbr::render::surfel_batches_test
