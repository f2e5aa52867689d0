#include <cmath>

#include "easypbr/core/image.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::gbuffer_test {
namespace {

Vec3 unproject(const Camera& camera, int x, int y, int width, int height, float z) {
    const Mat4d p = camera.projection_matrix(double(width) / height);
    const double nx = (x + 0.5) / width * 2 - 1, ny = 1 - (y + 0.5) / height * 2;
    const Vec3d view((nx + p(0, 2)) / p(0, 0) * z, (ny + p(1, 2)) / p(1, 1) * z, -z);
    return (camera.T_world_cam * view).cast<float>();
}

// On a sphere the normal is the position: depth and normal of the same pixel must tell the same point.
TEST(GBuffer, DepthAndNormalsOfASphere) {
    Scene scene;
    // Fine enough that a facet's sagitta, 1 - cos(pi / 1024) = 5e-6, is below the bound.
    scene.show(make_sphere(1, 1024), "sphere");
    app::Session session = plain_session(scene, 128);
    session.settings().camera.azimuth_deg = 40;
    const auto layers = session.render_layers({"depth", "normal_world"});
    const Camera camera = session.camera();
    int tested = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const float z = layers.at("depth").at<float>(x, y)[0];
            if (z == 0) continue;
            const Vec3 p = unproject(camera, x, y, 128, 128, z);
            if (p.normalized().dot((camera.position().cast<float>() - p).normalized()) < 0.2f) continue;
            ++tested;
            // 1e-5 relative to the distance to the camera, which is about 4.
            ASSERT_NEAR(p.norm(), 1, 4e-5);
            const Vec3 n(layers.at("normal_world").at<float>(x, y));
            const double angle = degrees(std::atan2(double(n.cross(p).norm()), double(n.dot(p))));
            // 0.01 degrees: two octahedral encodings of 0.004 each.
            ASSERT_LT(angle, 0.01);
        }
    EXPECT_GT(tested, 5000);
}

TEST(GBuffer, PlaneAtKnownDepth) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        Scene scene;
        scene.show(facing_square(100), "square");
        app::Session session = plain_session(scene);
        session.settings().camera.projection = projection;
        session.settings().camera.ortho_height = 2.0;
        look_from(session, Vec3d(0, 0, 7));
        const auto layers = session.render_layers({"depth"});
        for (const float z : layers.at("depth").pixels<float>()) ASSERT_NEAR(z / 7, 1, 1e-5);
    }
}

// Every channel holds what the material says: 16-bit albedo, 8-bit metallic and roughness.
TEST(GBuffer, MaterialValues) {
    Material m;
    m.base_color = Vec3(0.1f, 0.5f, 0.9f);
    m.metallic = 0.25f;
    m.roughness = 0.6f;
    Scene scene;
    scene.show(facing_square(100, m), "square");
    app::Session session = plain_session(scene);
    look_from(session, Vec3d(0, 0, 7));
    const auto layers = session.render_layers({"albedo", "metallic", "roughness", "occlusion"});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(layers.at("albedo").at<float>(32, 32)[c], m.base_color[c], 1e-4);
    EXPECT_NEAR(layers.at("metallic").at<float>(32, 32)[0], 0.25f, 0.5f / 255);
    EXPECT_NEAR(layers.at("roughness").at<float>(32, 32)[0], 0.6f, 0.5f / 255);
    EXPECT_EQ(layers.at("occlusion").at<float>(32, 32)[0], 1.0f);
    EXPECT_THROW(session.render_layers({"rougness"}), NameError);
}

// Powers of two scale floats exactly: the picture must not change in a single bit.
TEST(GBuffer, ScaleDoesNotMatter) {
    const auto picture = [](float scale) {
        Scene scene;
        Mesh mesh = make_teapot(1, 6);
        mesh.set_N({});
        mesh.set_V(Array3f(Array3f::Dense(mesh.V() * scale)));
        scene.show(mesh, "mesh");
        app::Session session(scene);
        session.settings().image.size = Vec2i(200, 150);
        session.settings().image.samples = 4;
        return session.render();
    };
    const Image reference = picture(1);
    for (const float scale : {1024.0f, 1.0f / 1024}) {
        const ImageDifference difference = compare(reference, picture(scale));
        EXPECT_EQ(difference.different, 0u) << "scale " << scale << ", max " << difference.max;
    }
}

// Leaving out the back faces of a closed mesh changes nothing.
TEST(GBuffer, CullingClosedMeshesIsInvisible) {
    Scene scene;
    Mesh sphere = make_sphere(1, 32);
    scene.show(sphere, "sphere");
    app::Session session = plain_session(scene, 128);
    session.settings().environment.enabled = true;
    const Image automatic_ = session.render();
    session.settings().style.two_sided = false;
    EXPECT_EQ(compare(automatic_, session.render()).different, 0u);
}

// An open square seen from behind, or wound the wrong way, is lit like from the front.
TEST(GBuffer, BothSidesAreLit) {
    const auto centre = [](bool flip_winding, double z) {
        Mesh mesh = facing_square();
        if (flip_winding) mesh.set_F(Array3i(Array3i::Dense(mesh.F().rowwise().reverse())));
        Scene scene;
        scene.show(mesh, "square");
        app::Session session = plain_session(scene);
        Light light;
        light.position = Vec3d(0, 0, z);
        light.intensity = 10;
        scene.set_light("light", light);
        look_from(session, Vec3d(0, 0, z));
        return render_linear(session).at<float>(32, 32)[0];
    };
    const float front = centre(false, 5);
    EXPECT_GT(front, 0.01f);
    EXPECT_EQ(centre(true, 5), front);
    EXPECT_EQ(centre(false, -5), front);
    EXPECT_EQ(centre(true, -5), front);
}

// Wrong winding with right normals: the given normals decide, turned to the side that is seen.
TEST(GBuffer, GivenNormalsSurviveWrongWinding) {
    Mesh mesh = make_sphere(1, 64);
    mesh.set_F(Array3i(Array3i::Dense(mesh.F().rowwise().reverse())));
    Scene scene;
    scene.show(mesh, "sphere");
    app::Session session = plain_session(scene);
    const auto layers = session.render_layers({"normal_world"});
    const Vec3 n(layers.at("normal_world").at<float>(32, 32));
    const Vec3d to_camera = session.camera().position().normalized();
    EXPECT_GT(n.cast<double>().dot(to_camera), 0.99);
}

// Without normals of their own, faces that are wound the wrong way round look as their neighbours do.
TEST(GBuffer, InferredNormalsSurviveWrongWindingOfSomeFaces) {
    for (const bool native : {true, false}) {
        const auto normals = [&](int turned_of_seven) {
            Mesh mesh = make_sphere(1, 64);
            mesh.edit([&](MeshData& data) {
                Array3i::Dense F = data.F;
                for (Eigen::Index f = 0; f < F.rows(); ++f)
                    if (f % 7 < turned_of_seven) std::swap(F(f, 1), F(f, 2));
                data.F = std::move(F);
                data.N = {};
            });
            Scene scene;
            scene.show(mesh, "sphere");
            app::Session session = plain_session(scene);
            session.allow_native_shading(native);
            return session.render_layers({"normal_world"}).at("normal_world");
        };
        const Image right = normals(0), some = normals(1);
        ASSERT_EQ(right.pixel_count(), some.pixel_count());
        for (size_t i = 0; i < right.pixel_count(); ++i) {
            const Vec3 n(right.pixels<float>().data() + 3 * i), m(some.pixels<float>().data() + 3 * i);
            // Two octahedral encodings of a vertex and a pixel, of 0.004 degrees each.
            if (n.squaredNorm() == 0) continue;
            ASSERT_GT(n.dot(m), std::cos(radians(0.05))) << i << ' ' << native;
        }
    }
}

TEST(GBuffer, FlatShadingGivesOneNormalPerFace) {
    Scene scene;
    scene.show(make_sphere(1, 8), "sphere");
    app::Session session = plain_session(scene, 128);
    session.settings().style.flat = true;
    look_from(session, Vec3d(0.3, 1.3, 4));
    const Image normals = session.render_layers({"normal_world"}).at("normal_world");
    std::set<std::array<int, 3>> different;
    for (size_t i = 0; i < normals.pixel_count(); ++i) {
        const Vec3 n(normals.pixels<float>().data() + 3 * i);
        if (n.squaredNorm() > 0)
            different.insert({int(std::lround(n.x() * 100)), int(std::lround(n.y() * 100)),
                              int(std::lround(n.z() * 100))});
    }
    // An 8-segment sphere shows at most half of its 48 faces; neighbouring roundings may double a few.
    EXPECT_LT(different.size(), 60u);
    EXPECT_GT(different.size(), 10u);
}

TEST(Frame, JitterIsCentred) {
    for (const int count : {1, 2, 16, 64}) {
        Vec2d sum(0, 0);
        for (int i = 0; i < count; ++i) {
            const Vec2d j = render::jitter_of(i, count);
            EXPECT_LT(j.cwiseAbs().maxCoeff(), 0.75);
            sum += j;
        }
        EXPECT_LT(sum.norm(), 1e-12 * count);
    }
}

// After any even number of frames, and after all.
TEST(Frame, PairedJitterIsCentred) {
    for (const int count : {1, 2, 15, 64}) {
        Vec2d sum(0, 0);
        for (int i = 0; i < count; ++i) {
            const Vec2d j = render::paired_jitter_of(i, count);
            EXPECT_LE(j.cwiseAbs().maxCoeff(), 0.5);
            sum += j;
            const bool is_even = i % 2 == 1 || i == count - 1;
            EXPECT_LT(is_even ? sum.norm() : 0, 1e-12) << i << " of " << count;
        }
    }
}

double halton(int index, int base) {
    double value = 0, scale = 1;
    for (int i = index; i > 0; i /= base) {
        scale /= base;
        value += scale * (i % base);
    }
    return value;
}

int rank_of(int index, int count, int base) {
    int rank = 0;
    for (int i = 0; i < count; ++i) rank += halton(i, base) < halton(index, base);
    return rank;
}

// Ranks by digits are those of a search through all frames, and means that are kept are those of a sum.
TEST(Frame, PlacesAreThoseOfTheirDefinitions) {
    for (const int count : {1, 2, 7, 49, 50, 125, 300}) {
        Vec2d jitters(0, 0);
        for (int i = 1; i <= count; ++i) jitters += Vec2d(halton(i, 2), halton(i, 3)) / count;
        Vec2d places(0, 0);
        for (int i = 0; i < count; ++i) {
            EXPECT_EQ(render::jitter_of(i, count), Vec2d(halton(i + 1, 2), halton(i + 1, 3)) - jitters);
            EXPECT_EQ(render::shutter_time(i, count, 1), 1 - (1 - (rank_of(i, count, 7) + 0.5) / count));
            // The spiral's point of this rank, moved by a mean that all share.
            const double angle = rank_of(i, count, 5) * pi * (3 - std::sqrt(5.0));
            const double radius = std::sqrt((rank_of(i, count, 5) + 0.5) / count);
            const Vec2d moved = radius * Vec2d(std::cos(angle), std::sin(angle));
            const Vec2d first = std::sqrt(0.5 / count) * Vec2d(1, 0);
            EXPECT_LT(
                (render::lens_position(i, count) - render::lens_position(0, count) - (moved - first)).norm(),
                1e-12);
            places += render::lens_position(i, count);
        }
        EXPECT_LT(places.norm(), 1e-12 * count);
    }
}

}  // namespace
}  // namespace easypbr::gbuffer_test
