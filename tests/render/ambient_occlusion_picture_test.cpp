// What ambient occlusion does to pictures: borders, sizes, noise, light, clouds.
#include "easypbr/core/error.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/resolve.h"
#include "occlusion_test.h"

namespace easypbr::ambient_occlusion_picture_test {
namespace {

// A sphere far before a wall: neither occludes the other, and the pixels of both sides of the silhouette stay
// on their own side when the half resolution is magnified. The normals of facets lean by up to 1.4 degrees
// from the sphere's, which costs less than 0.03 where it is seen from the side.
TEST(AmbientOcclusion, SilhouettesHaveNoSpecks) {
    Scene scene;
    scene.show(make_sphere(1, 128), "sphere");
    scene.show(quad({-9, -9, -9}, {9, -9, -9}, {9, 9, -9}, {-9, 9, -9}), "wall");
    for (const auto method : {OcclusionMethod::horizon, OcclusionMethod::hemisphere}) {
        app::Session session = occlusion_session(scene, 203);
        session.settings().ssao.method = method;
        session.settings().ssao.radius = 0.5f;
        place(session, Vec3d(0, 0, 5), Vec3d(0, 0, 0), 30);
        const Difference d = difference(Occlusion(session), [](int, int) { return 1.0; });
        EXPECT_EQ(d.count, 203 * 203);
        EXPECT_LT(d.max, 0.03) << int(method);
    }
}

// Sizes down to one pixel, odd ones too, and the same picture at any: the means of a teapot's visibility at
// half and at twice the size differ by what its outline covers.
TEST(AmbientOcclusion, WorksAtAnySize) {
    const Scene scene = teapot_on_floor();
    for (const Vec2i& size : {Vec2i(1, 1), Vec2i(2, 1), Vec2i(1, 3), Vec2i(5, 7), Vec2i(33, 65)}) {
        app::Session session = occlusion_session(scene);
        session.settings().image.size = size;
        const Occlusion o(session);
        for (const float v : o.visibility.pixels<float>()) {
            EXPECT_GE(v, 0);
            EXPECT_LE(v, 1);
        }
    }
    const auto mean = [&](int size) {
        app::Session session = occlusion_session(scene, size);
        return 1 + difference(Occlusion(session), [](int, int) { return 1.0; }).mean;
    };
    const double middle = mean(200);
    EXPECT_LT(middle, 0.99);
    EXPECT_NEAR(mean(101), middle, 0.01);
    EXPECT_NEAR(mean(401), middle, 0.01);
}

// Only the environment's light is occluded: with lights alone the picture is the same, bit for bit.
TEST(AmbientOcclusion, LeavesDirectLightAlone) {
    const Scene scene = teapot_on_floor();
    Light light;
    light.position = Vec3d(1, 3, 2);
    light.intensity = 20;
    Scene lit = scene;
    lit.set_light("light", light);
    app::Session session = plain_session(lit, 128);
    const Image without = render_linear(session);
    session.settings().ssao.enabled = true;
    const Image with = render_linear(session);
    EXPECT_TRUE(std::ranges::equal(with.bytes(), without.bytes()));
}

// White furnace on an open plane: nothing is lost, at one frame and at many.
TEST(AmbientOcclusion, FurnaceHoldsOnAnOpenPlane) {
    Material white;
    white.base_color = Vec3::Ones();
    white.roughness = 0.5f;
    Scene scene;
    scene.show(facing_square(1, white), "square");
    scene.set_environment(constant_environment(0.7f));
    for (const int samples : {1, 8}) {
        app::Session session = occlusion_session(scene, 64);
        session.settings().environment.enabled = true;
        place(session, Vec3d(1.5, 1, 2), Vec3d(0, 0, 0), 30);
        const Image image = render_linear(session, samples);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const float* p = image.at<float>(x, y);
                if (p[3] == 1) {
                    ASSERT_NEAR(p[1] / 0.7f, 1, 0.005);
                }
            }
    }
}

/// A normal map whose texels are tilted by 45 degrees, neighbours in different directions.
Texture steep_normals() {
    Image image(8, 8, 3, PixelType::u8);
    for (int i = 0; i < 64; ++i) {
        const double side = 2.4 * i;  // the golden angle, nearly
        const Vec3d n = Vec3d(std::cos(side), std::sin(side), 1).normalized();
        for (int c = 0; c < 3; ++c)
            image.at<uint8_t>(i % 8, i / 8)[c] = uint8_t(std::lround((n[c] * 0.5 + 0.5) * 255));
    }
    Texture texture;
    texture.image = std::make_shared<Image>(std::move(image));
    return texture;
}

// A plane does not hide what its mapped normals face: light that the map's own relief would throw on is not
// lost.
TEST(AmbientOcclusion, FurnaceHoldsWithSteepNormalMaps) {
    for (const bool metal : {true, false})
        for (const float roughness : {0.2f, 0.8f}) {
            Material white;
            white.base_color = Vec3::Ones();
            white.metallic = metal ? 1.0f : 0.0f;
            white.roughness = roughness;
            white.normal_texture = steep_normals();
            Scene scene;
            scene.show(facing_square(1, white), "square");
            scene.set_environment(constant_environment(0.7f));
            for (const OcclusionMethod method : {OcclusionMethod::horizon, OcclusionMethod::hemisphere})
                for (const int samples : {1, 8}) {
                    app::Session session = occlusion_session(scene, 64);
                    session.settings().environment.enabled = true;
                    session.settings().ssao.method = method;
                    place(session, Vec3d(1.5, 1, 2), Vec3d(0, 0, 0), 30);
                    const Image image = render_linear(session, samples);
                    int seen = 0;
                    double sum = 0;
                    for (int y = 0; y < 64; ++y)
                        for (int x = 0; x < 64; ++x) {
                            const float* p = image.at<float>(x, y);
                            if (p[3] != 1) continue;
                            ++seen;
                            sum += p[1] / 0.7f;
                            // 0.5 % as without a map; GPUs blend texels in steps of 1/256. Where rounding
                            // lifts a neighbour from the plane, one of 8 frames may lose a sector of one
                            // side's 32.
                            const double sector = samples > 1 ? 1.0 / (2 * 32 * samples) : 0;
                            ASSERT_NEAR(p[1] / 0.7f, 1, (has_gpu() ? 0.006 : 0.005) + sector)
                                << "metal " << metal << ", roughness " << roughness << ", samples "
                                << samples;
                        }
                    EXPECT_GT(seen, 400);
                    EXPECT_NEAR(sum / seen, 1, 0.003);
                }
        }
}

/// Visibility as the mean of many frames shows it, from the light on a white matt scene.
Image averaged_visibility(const Scene& scene, int samples) {
    Image ratio;
    for (const bool enabled : {false, true}) {
        app::Session session = occlusion_session(scene, 192);
        Settings& s = session.settings();
        s.environment.enabled = true;
        s.shading.dielectric_f0 = 0;
        s.material.roughness = 1.0f;
        s.ssao.enabled = enabled;
        s.ssao.multi_bounce = false;
        place(session, Vec3d(1.2, 1.8, 2.4), Vec3d(-0.1, 0.3, 0), 40);
        Image image = render_linear(session, samples);
        if (enabled)
            for (size_t i = 0; i < image.pixels<float>().size(); ++i)
                ratio.pixels<float>()[i] = image.pixels<float>()[i] / ratio.pixels<float>()[i];
        else
            ratio = std::move(image);
    }
    return ratio;
}

// Frames of a still look in different directions, so noise averages out: between 16 and 64 frames it must
// have halved at least (evenly spread points do better than the root of the count), and 64 frames agree with
// rays within 0.04. 0.002 of each are the Fresnel reflection of the matt floor.
TEST(AmbientOcclusion, NoiseAveragesOut) {
    Scene scene = corner_with_objects();
    scene.set_environment(constant_environment(1));
    const Image few = averaged_visibility(scene, 16), many = averaged_visibility(scene, 64),
                most = averaged_visibility(scene, 512);
    app::Session session = occlusion_session(scene, 192);
    place(session, Vec3d(1.2, 1.8, 2.4), Vec3d(-0.1, 0.3, 0), 40);
    const Occlusion o(session);
    const RayCaster caster(scene.snapshot());
    const auto ssao = session.resolve().settings.ssao;
    double noise_few = 0, noise_many = 0, error = 0;
    int count = 0;
    for (int y = 0; y < 192; y += 2)
        for (int x = 0; x < 192; x += 2) {
            if (!o.covered(x, y) || !o.off_silhouettes(x, y, 3)) continue;
            const auto at = [&](const Image& image) { return double(image.at<float>(x, y)[1]); };
            noise_few += std::pow(at(few) - at(most), 2);
            noise_many += std::pow(at(many) - at(most), 2);
            error += std::pow(at(many) - ray_cast_visibility(caster, o.world(x, y).cast<float>(),
                                                             o.normal_at(x, y), ssao.radius, ssao.falloff),
                              2);
            ++count;
        }
    EXPECT_GT(count, 1000);
    EXPECT_LT(std::sqrt(noise_many / count), 0.003);
    EXPECT_LT(noise_many, noise_few / 4);
    EXPECT_LT(std::sqrt(error / count), 0.04);
}

/// A box on the ground, and maybe a large one far below, which is not seen.
Image on_ground(OcclusionMethod method, int samples, bool with_large) {
    Scene scene;
    Mesh box = make_box(Vec3(1, 1, 1));
    box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0.5, 0)));
    scene.show(box, "box");
    if (with_large) {
        Mesh large = make_box(Vec3(200, 1, 200));
        large.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, -50, 0)));
        scene.show(large, "large");
    }
    scene.set_environment(constant_environment(1));
    app::Session session = occlusion_session(scene, 160);
    Settings& settings = session.settings();
    settings.ssao.method = method;
    settings.ssao.radius = 0.5f;
    settings.environment.enabled = true;
    settings.ground.mode = GroundMode::plane;
    settings.ground.height = 0;
    settings.ground.radius = 1000;
    settings.camera.near = 0.1;
    place(session, Vec3d(2, 3, 4), Vec3d(0, 0, 0), 40);
    return render_linear(session, samples);
}

// Where the content's box is farther than the radius the ground is open, and nothing is looked up. A large
// object out of sight widens that box to all of the ground: the picture must be the same. 0.002 is some steps
// of the targets' half floats.
TEST(AmbientOcclusion, GroundIsOpenBeyondTheRadius) {
    for (const auto method : {OcclusionMethod::horizon, OcclusionMethod::hemisphere})
        for (const int samples : {1, 4}) {
            const Image known = on_ground(method, samples, false), unknown = on_ground(method, samples, true);
            int differs = 0, dark = 0;
            for (size_t i = 0; i < known.pixels<float>().size(); ++i) {
                differs += std::abs(known.pixels<float>()[i] - unknown.pixels<float>()[i]) > 2e-3f;
                dark += known.pixels<float>()[i] < 0.98f * known.pixels<float>()[4 * 159 * 160];
            }
            EXPECT_EQ(differs, 0) << int(method) << " " << samples;
            EXPECT_GT(dark, 1000);
        }
}

// Interreflection: the brighter the surface, the less its recesses darken; black ones are occluded as they
// are.
TEST(AmbientOcclusion, BrightRecessesAreLighter) {
    const auto darkest = [](float albedo, bool multi_bounce) {
        Scene scene = teapot_on_floor();
        scene.set_environment(constant_environment(1));
        float least = 1;
        Image open;
        for (const bool enabled : {false, true}) {
            app::Session session = occlusion_session(scene, 96);
            session.settings().environment.enabled = true;
            session.settings().ssao.enabled = enabled;
            session.settings().ssao.multi_bounce = multi_bounce;
            session.settings().material.color = Vec3(albedo, albedo, albedo);
            const Image image = render_linear(session);
            for (size_t i = 0; enabled && i < image.pixel_count(); ++i)
                if (image.pixels<float>()[4 * i + 3] > 0)
                    least = std::min(least, image.pixels<float>()[4 * i] / open.pixels<float>()[4 * i]);
            open = image;
        }
        return least;
    };
    EXPECT_LT(darkest(0.9f, false), 0.7f);
    EXPECT_GT(darkest(0.9f, true), darkest(0.9f, false) + 0.05f);
    EXPECT_GT(darkest(0.9f, true), darkest(0.3f, true) + 0.05f);
}

TEST(AmbientOcclusion, PowerDarkens) {
    const Scene scene = teapot_on_floor();
    app::Session session = occlusion_session(scene, 64);
    session.settings().ssao.resolution = OcclusionResolution::full;
    const auto mean = [&](float power) {
        session.settings().ssao.power = power;
        return difference(Occlusion(session), [](int, int) { return 1.0; }).mean;
    };
    EXPECT_LT(mean(2), 1.3 * mean(1));
    EXPECT_EQ(mean(0), 0);
}

/// n x n points each of a floor and of a wall, 2 * scale wide.
Mesh cloud_of_corner(int n, float scale) {
    Array3f::Dense V(2 * n * n, 3);
    const auto count = float(n);
    for (int i = 0; i < n * n; ++i) {
        const int column = i % n, row = i / n;
        const float u = float(column) / count * 2 - 1, v = float(row) / count;
        V.row(2 * i) << u, 0, v;
        V.row(2 * i + 1) << u, v, 0;
    }
    Mesh cloud;
    cloud.set_V(Array3f(Array3f::Dense(V * scale)));
    return cloud;
}

// Points without normals are shaded by eye-dome lighting, and occlusion on top of it when it is asked for.
TEST(AmbientOcclusion, DarkensRecessesOfClouds) {
    Scene scene;
    scene.show(cloud_of_corner(200, 1), "corner");
    app::Session session = plain_session(scene, 128);
    session.settings().ssao.enabled = automatic;
    place(session, Vec3d(0, 2, 2), Vec3d(0, 0.3, 0.3), 40);
    EXPECT_FALSE(session.resolve().settings.ssao.enabled);
    const Image plain = session.render();
    session.settings().ssao.enabled = true;
    session.settings().ssao.radius = 0.3f;
    const Image occluded = session.render();
    const Occlusion o(session);
    double in_corner = 0, elsewhere = 0;
    int corner_count = 0, elsewhere_count = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            if (!o.covered(x, y)) continue;
            const Vec3d p = o.world(x, y);
            const int before = plain.at<uint8_t>(x, y)[0], after = occluded.at<uint8_t>(x, y)[0];
            EXPECT_LE(after, before);
            const double distance = std::max(p.y(), p.z());
            if (distance < 0.05) in_corner += o.at(x, y), ++corner_count;
            if (distance > 0.4 && distance < 0.6) elsewhere += o.at(x, y), ++elsewhere_count;
        }
    ASSERT_GT(corner_count, 100);
    ASSERT_GT(elsewhere_count, 100);
    EXPECT_LT(in_corner / corner_count, elsewhere / elsewhere_count - 0.1);
}

// Normals of points are estimated alike in any unit of length: micrometres in metres, and kilometres.
// Coordinates are rounded anew by each scale, which turns a normal of 16 bits by a step: less than 0.02 of
// the light.
TEST(AmbientOcclusion, OfCloudsIsTheSameAtAnyScale) {
    const auto visibility = [&](double scale) {
        Scene scene;
        scene.show(cloud_of_corner(60, float(scale)), "corner");
        app::Session session = plain_session(scene, 64);
        session.settings().ssao.enabled = true;
        session.settings().ssao.radius = float(0.3 * scale);
        place(session, Vec3d(0, 2, 2) * scale, Vec3d(0, 0.3, 0.3) * scale, 40);
        return Occlusion(session).visibility;
    };
    const Image of_metres = visibility(1);
    for (const double scale : {1e-9, 1e-6, 1e6}) {
        const Image scaled = visibility(scale);
        float largest = 0;
        for (size_t i = 0; i < scaled.pixels<float>().size(); ++i)
            largest = std::max(largest, std::abs(scaled.pixels<float>()[i] - of_metres.pixels<float>()[i]));
        EXPECT_LT(largest, 0.02f) << scale;
    }
}

// A tilted plane of points is as open as one of faces, though its splats face the viewer like stairs.
TEST(AmbientOcclusion, LeavesTiltedCloudsOpen) {
    const int n = 300;
    Array3f::Dense V(n * n, 3);
    for (int i = 0; i < n * n; ++i) V.row(i) << float(i % n) / n * 2 - 1, 0, float(i / n) / n * 2 - 1;
    Mesh cloud;
    cloud.set_V(Array3f(V));
    Scene scene;
    scene.show(cloud, "plane");
    app::Session session = plain_session(scene, 160);
    session.settings().ssao.enabled = true;
    session.settings().ssao.radius = 0.2f;
    for (const double elevation_deg : {20.0, 45.0, 80.0}) {
        const double a = radians(elevation_deg);
        place(session, 3 * Vec3d(0, std::sin(a), std::cos(a)), Vec3d::Zero(), 40);
        const Occlusion o(session);
        double sum = 0;
        int count = 0;
        for (int y = 0; y < 160; ++y)
            for (int x = 0; x < 160; ++x) {
                if (!o.covered(x, y) || o.world(x, y).cwiseAbs().maxCoeff() > 0.7) continue;
                sum += o.at(x, y);
                ++count;
            }
        ASSERT_GT(count, 300) << elevation_deg;
        EXPECT_GT(sum / count, 0.9) << elevation_deg;
    }
}

TEST(AmbientOcclusion, SaysWhatItExpected) {
    Settings settings;
    for (const char* radius : {"0", "-1", "nan", "inf"})
        EXPECT_THROW(set_from_text(settings, "ssao.radius", radius), ArgumentError) << radius;
    EXPECT_THROW(set_from_text(settings, "ssao.steps", "0"), ArgumentError);
    EXPECT_THROW(set_from_text(settings, "ssao.falloff", "0"), ArgumentError);
    Scene scene;
    scene.show(make_sphere(), "sphere");
    app::Session session = plain_session(scene);
    // Switched off, nothing occludes anything, whatever a picture before has found.
    session.settings().ssao.enabled = true;
    session.render();
    session.settings().ssao.enabled = false;
    const Image layer = session.render_layers({"ambient_occlusion"}).at("ambient_occlusion");
    EXPECT_EQ(*layer.at<float>(32, 32), 1.0f);
    EXPECT_EQ(*layer.at<float>(0, 0), 0.0f);
}

}  // namespace
}  // namespace easypbr::ambient_occlusion_picture_test
