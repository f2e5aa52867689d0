// Light that goes through surfaces: against Fresnel's, Snell's and Beer's laws.
#include <cmath>

#include "easypbr/core/color.h"
#include "glass_scenes.h"
#include "lobe_reference.h"

namespace easypbr::transmission_test {
namespace {

using namespace reference;

/// Calls visit(radiance, ray, normal) for pixels of a picture of the unit sphere.
template <class Visit>
size_t for_each_point(const Image& image, const Camera& camera, double least_n_dot_v, Visit&& visit) {
    size_t count = 0;
    for (int y = 0; y < size; y += 2)
        for (int x = 0; x < size; x += 2) {
            const Ray ray = ray_of(camera, x, y);
            const double b = ray.origin.dot(ray.direction), c = b * b - ray.origin.squaredNorm() + 1;
            if (c < 0) continue;
            const Vec3d n = ray.origin + ray.direction * (-b - std::sqrt(c));
            if (-ray.direction.dot(n) < least_n_dot_v) continue;
            visit(Vec3(image.at<float>(x, y)), ray, n);
            ++count;
        }
    return count;
}

// White glass in a uniform environment disappears, whatever its thickness, roughness and index.
TEST(Transmission, WhiteFurnace) {
    const std::vector<Material> materials = {
        glass(), glass([](Material& m) { m.roughness = 0.5f; }),
        glass([](Material& m) { m.thickness = 1, m.ior = 1.8f; }),
        glass([](Material& m) { m.thickness = 1, m.roughness = 0.4f; }),
        glass([](Material& m) { m.transmission = 0.4f, m.clearcoat = 1; })};
    for (const Material& material : materials) {
        Scene scene;
        scene.show(ball(material), "ball");
        scene.set_environment(constant_environment(1));
        app::Session session = session_of(scene);
        session.settings().environment.enabled = true;
        const Image image = render_linear(session);
        // 0.5 %, as for the core model.
        EXPECT_GT(for_each_point(image, session.camera(), 0.1,
                                 [&](const Vec3& radiance, const Ray&, const Vec3d&) {
                                     for (int c = 0; c < 3; ++c)
                                         ASSERT_NEAR(radiance[c], 1, 0.005) << material.thickness;
                                 }),
                  200u);
    }
}

// A ball of half the size within a ball of glass is seen in its middle, and the glass absorbs on the way to
// it alone. 0.01: absorptions have 8 bits.
TEST(Transmission, WhatIsWithinIsSeen) {
    const Vec3 color(0.5f, 0.1f, 0.2f), tint(0.25f, 0.5f, 1);
    Scene scene;
    Mesh within = make_sphere(0.5, 64);
    within.set_material(glowing(color));
    scene.show(within, "within");
    scene.show(ball(glass([&](Material& m) {
                   m.thickness = 1;
                   m.attenuation_distance = 0.5f;
                   m.attenuation_color = tint;
               })),
               "ball");
    scene.set_environment(constant_environment(1));
    app::Session session = session_of(scene, Vec3d(0, 0, 4));
    session.settings().environment.enabled = true;
    const Image image = render_linear(session);
    const Vec3 seen(image.at<float>(size / 2, size / 2));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], 0.04 + 0.96 * color[c] * tint[c], 0.01) << c;
}

// What a volume absorbs on the way through it: Beer's law for the refracted chord of a sphere, whatever the
// thickness that only says that it is a volume.
TEST(Transmission, VolumesAbsorbAlongTheRefractedPath) {
    const std::pair<float, Vec3> volumes[] = {
        {1e-4f, {0.25f, 0.5f, 1}}, {0.01f, {0.25f, 0.5f, 1}}, {1, {0.25f, 0.5f, 1}},   {1, {0.25f, 0.5f, 0}},
        {1, {0.93f, 0.5f, 0}},     {100, {0.25f, 0.5f, 1}},   {1e4f, {0.25f, 0.5f, 1}}};
    for (const auto& volume : volumes) {
        const float thickness = volume.first;
        const Vec3& color = volume.second;
        Scene scene;
        scene.show(ball(glass([&](Material& m) {
                       m.thickness = thickness;
                       m.attenuation_color = color;
                       m.attenuation_distance = 2;
                   })),
                   "ball");
        scene.set_environment(constant_environment(1));
        app::Session session = session_of(scene);
        session.settings().environment.enabled = true;
        const Image image = render_linear(session);
        for_each_point(image, session.camera(), 0.3,
                       [&](const Vec3& radiance, const Ray& ray, const Vec3d& n) {
                           const double cosine = -ray.direction.dot(n), F = schlick(cosine, 0.04);
                           const double chord = 2 * std::sqrt(1 - (1 - cosine * cosine) / (1.5 * 1.5));
                           for (int c = 0; c < 2; ++c) {
                               const double through = std::pow(double(color[c]), chord / 2);
                               // Absorptions have 8 bits, and the back is found in the picture.
                               ASSERT_NEAR(radiance[c], F + (1 - F) * through, 0.02)
                                   << cosine << ", thickness " << thickness;
                           }
                       });
    }
}

// Whichever way its faces look, and whether or not it has normals: the front of a closed volume is its
// outside. 0.02, as above: interpolated normals of both are the same, but for their roundings.
TEST(Transmission, WindingOfVolumesDoesNotMatter) {
    const auto drawn = [](bool inward, bool with_normals, bool native) {
        MeshData data = *make_sphere(1, 256).snapshot();
        data.materials = {glass([](Material& m) {
            m.thickness = 1;
            m.attenuation_color = Vec3(0.25f, 0.5f, 1);
            m.attenuation_distance = 2;
        })};
        if (inward) data.F = Array3i(Array3i::Dense(data.F.rowwise().reverse()));
        if (!with_normals) data.N = {};
        Scene scene;
        scene.show(Mesh(data), "ball");
        scene.set_environment(constant_environment(1));
        app::Session session = session_of(scene);
        session.settings().environment.enabled = true;
        session.allow_native_geometry(native);
        return std::pair(render_linear(session), session.camera());
    };
    for (const bool with_normals : {true, false})
        for (const bool native : {true, false}) {
            const auto [outward, camera] = drawn(false, with_normals, native);
            const Image inward = drawn(true, with_normals, native).first;
            size_t same = 0;
            for (size_t i = 0; i < outward.pixels<float>().size(); ++i)
                same += std::abs(outward.pixels<float>()[i] - inward.pixels<float>()[i]) < 0.02f;
            // But for pixels of the silhouette.
            EXPECT_GT(same, outward.pixels<float>().size() * 98 / 100) << with_normals << native;
            EXPECT_LT(inward.at<float>(size / 2, size / 2)[0], 0.4f) << with_normals << native;
        }
}

// A thin wall has one colour, whatever the angle (base colour times 1 - F), and does not bend rays.
TEST(Transmission, ThinSurfacesTintWhatIsBehind) {
    Scene scene;
    scene.show(moved(facing_square(8, glowing(Vec3(0.9f, 0.5f, 0.2f))), Vec3d(0, 0, -2)), "wall");
    scene.show(facing_square(2, glass([](Material& m) { m.base_color = Vec3(0.25f, 0.5f, 1); })), "pane");
    app::Session session = session_of(scene, Vec3d(0, 0, 5));
    session.settings().shading.multiple_scattering = false;
    const Image image = render_linear(session);
    for (const int x : {20, 48, 70}) {
        const double F = schlick(-ray_of(session.camera(), x, 48).direction.z(), 0.04);
        const Vec3 expected = Vec3(0.9f * 0.25f, 0.5f * 0.5f, 0.2f) * float(1 - F);
        EXPECT_TRUE(Vec3(image.at<float>(x, 48)).isApprox(expected, 0.002f)) << image.at<float>(x, 48)[0];
        EXPECT_EQ(image.at<float>(x, 48)[3], 1.0f);
    }
}

// Without an environment nothing is behind but the background: glass covers what it does not let through.
TEST(Transmission, BackgroundShinesThrough) {
    Scene scene;
    scene.show(facing_square(2, glass([](Material& m) { m.base_color = Vec3::Constant(0.5f); })), "pane");
    app::Session session = session_of(scene, Vec3d(0, 0, 5));
    EXPECT_NEAR(render_linear(session).at<float>(48, 48)[3], 1 - 0.5 * 0.96, 0.003);
    session.settings().background.mode = BackgroundMode::color;
    session.settings().background.color = Vec3(1, 1, 1);
    const Image image = session.render();
    EXPECT_NEAR(linear_from_srgb(image.at<uint8_t>(48, 48)[0] / 255.0f), 0.48, 0.005);
    EXPECT_EQ(image.at<uint8_t>(48, 48)[3], 255);
}

// Layers of glass, and blended surfaces between them, in any order: a bubble is two layers, and so on.
TEST(Transmission, LayersMultiply) {
    const Vec3 tint(0.25f, 0.5f, 1), wall(0.8f, 0.6f, 0.4f), paint(0, 1, 0);
    Material painted = glowing(paint);
    painted.opacity = 0.5f;
    const std::vector<Mesh> meshes = {
        moved(facing_square(8, glowing(wall)), Vec3d(0, 0, -3)),
        moved(facing_square(4, glass([&](Material& m) { m.base_color = tint; })), Vec3d(0, 0, -2)),
        moved(facing_square(4, painted), Vec3d(0, 0, -1)), ball(glass())};
    for (const auto& order : {std::vector<size_t>{0, 1, 2, 3}, std::vector<size_t>{3, 2, 1, 0}}) {
        Scene scene;
        for (const size_t i : order) scene.show(meshes[i], std::to_string(i));
        app::Session session = session_of(scene, Vec3d(0, 0, 6));
        const Image image = render_linear(session);
        const Vec3 behind = 0.5f * paint + 0.5f * tint.cwiseProduct(wall) * 0.96f;
        const Vec3 expected = behind * 0.96f * 0.96f;
        EXPECT_TRUE(Vec3(image.at<float>(48, 48)).isApprox(expected, 0.004f));
    }
}

/// Radiance 0.5 + 0.4 d_x + 0.3 d_y: linear, so that no filter changes it.
Environment gradient() {
    Image image(256, 128, 3, PixelType::f32);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            const double theta = pi * (y + 0.5) / 128, phi = 2 * pi * (x + 0.5) / 256 - pi;
            const Vec3d d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
            for (int c = 0; c < 3; ++c) image.at<float>(x, y)[c] = float(0.5 + 0.4 * d.x() + 0.3 * d.y());
        }
    return Environment(image);
}

double gradient_at(const Vec3d& d) {
    return 0.5 + 0.4 * d.x() + 0.3 * d.y();
}

// A ball of glass turns the environment upside down: refracted at its front and at its back, ray by ray.
TEST(Transmission, ABallRefractsTwice) {
    for (const float ior : {1.2f, 1.5f, 2.0f}) {
        Scene scene;
        scene.show(ball(glass([&](Material& m) { m.thickness = 2, m.ior = ior; })), "ball");
        scene.set_environment(gradient());
        app::Session session = session_of(scene);
        session.settings().environment.enabled = true;
        const Image image = render_linear(session);
        double worst = 0, swing = 0;
        for_each_point(
            image, session.camera(), 0.35, [&](const Vec3& radiance, const Ray& ray, const Vec3d& n) {
                const Vec3d inside = refracted(ray.direction, n, 1 / ior);
                const Vec3d back = n - 2 * n.dot(inside) * inside;
                const Vec3d outside = refracted(inside, -back, ior);
                const Vec3d mirrored = ray.direction - 2 * ray.direction.dot(n) * n;
                const double F = schlick(-ray.direction.dot(n), std::pow((ior - 1) / (ior + 1), 2));
                const double expected = F * gradient_at(mirrored) + (1 - F) * gradient_at(outside);
                worst = std::max(worst, std::abs(radiance.x() - expected));
                swing = std::max(swing, std::abs(gradient_at(outside) - gradient_at(ray.direction)));
            });
        // The back is found in the picture, to about a pixel of its normals, and the index has 8 bits.
        EXPECT_LT(worst, 0.03) << ior;
        EXPECT_GT(swing, 0.15) << ior;
    }
}

// With dispersion each colour of the ball has the index that the Abbe number of 2 gives it.
TEST(Transmission, ABallDisperses) {
    Scene scene;
    scene.show(ball(glass([&](Material& m) { m.thickness = 2, m.dispersion = 10; })), "ball");
    scene.set_environment(gradient());
    app::Session session = session_of(scene);
    session.settings().environment.enabled = true;
    const Image image = render_linear(session);
    double worst = 0, apart = 0;
    for_each_point(image, session.camera(), 0.35, [&](const Vec3& radiance, const Ray& ray, const Vec3d& n) {
        Vec3d behind;
        for (int c = 0; c < 3; ++c) {
            const double ior = 1.5 + (c - 1) * 0.5 * 0.5 / 2;  // n_F - n_C = (n - 1) / V
            const Vec3d inside = refracted(ray.direction, n, 1 / ior);
            const Vec3d back = n - 2 * n.dot(inside) * inside;
            behind[c] = gradient_at(refracted(inside, -back, ior));
            const Vec3d mirrored = ray.direction - 2 * ray.direction.dot(n) * n;
            const double F = schlick(-ray.direction.dot(n), 0.04);
            worst = std::max(worst, std::abs(radiance[c] - F * gradient_at(mirrored) - (1 - F) * behind[c]));
        }
        apart = std::max(apart, std::abs(behind[2] - behind[0]));
    });
    // As without dispersion, which has 8 bits of its own.
    EXPECT_LT(worst, 0.03);
    EXPECT_GT(apart, 0.1);
}

// A tilted slab shifts what is behind by t sin(i - r) / cos r.
TEST(Transmission, ASlabShifts) {
    const double tilt = radians(40.0), t = 0.8, ior = 1.5;
    Mesh slab = make_box(Vec3(4, 4, float(t)));
    slab.set_material(glass([](Material& m) { m.thickness = 1; }));
    slab.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(tilt, Vec3d::UnitY())));
    Scene scene;
    scene.show(moved(facing_square(6, glowing(Vec3(1, 0, 0))), Vec3d(-6, 0, -4)), "left");
    scene.show(moved(facing_square(6, glowing(Vec3(0, 1, 0))), Vec3d(6, 0, -4)), "right");
    scene.show(slab, "slab");
    app::Session session = session_of(scene, Vec3d(0, 0, 10));
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 2.0;
    const Image image = render_linear(session);
    int edge = 0;
    while (edge < size && image.at<float>(edge, 48)[0] > image.at<float>(edge, 48)[1]) ++edge;
    const double r = std::asin(std::sin(tilt) / ior), shift = t * std::sin(tilt - r) / std::cos(r);
    // The slab's normal leans to +x: rays bend towards its opposite and leave to the left of where they came.
    EXPECT_NEAR((edge - size / 2.0) * 2.0 / size, shift, 1.5 * 2.0 / size);
}

// Rough glass blurs by its distance to what is behind: an edge becomes the distribution of GGX's slopes along
// one axis.
TEST(Transmission, RoughGlassBlursByDistance) {
    const double D = 1.5;
    const float roughness = 0.4f;
    Scene scene;
    scene.show(moved(facing_square(20, glowing(Vec3::Ones())), Vec3d(20, 0, -D)), "bright");
    scene.show(moved(facing_square(20, glowing(Vec3::Zero())), Vec3d(-20, 0, -D)), "dark");
    scene.show(facing_square(10, glass([&](Material& m) { m.roughness = roughness; })), "pane");
    app::Session session = session_of(scene, Vec3d(0, 0, 10));
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 6.0;
    session.settings().shading.multiple_scattering = false;
    for (const int samples : {1, 64}) {
        const Image image = render_linear(session, samples);
        const double full = image.at<float>(90, 48)[0];
        for (int x = 8; x < 88; x += 4) {
            const double u = ((x + 0.5) / size - 0.5) * 6 / (2 * roughness * roughness * D);
            const double far = ((90.5) / size - 0.5) * 6 / (2 * roughness * roughness * D);
            const double expected = (1 + u / std::sqrt(1 + u * u)) / (1 + far / std::sqrt(1 + far * far));
            // One frame is blurred by a pyramid, whose filter has no long tail.
            EXPECT_NEAR(image.at<float>(x, 48)[0] / full, expected, samples == 1 ? 0.13 : 0.05) << x;
        }
    }
}

// A light on the other side shows through rough glass as the lobe of the extension has it.
TEST(Transmission, LightsShineThrough) {
    Scene scene;
    scene.show(facing_square(4, glass([](Material& m) { m.roughness = 0.6f; })), "pane");
    Light sun;
    sun.type = LightType::directional;
    const Vec3d towards = Vec3d(0.2, 0.3, -1).normalized();
    sun.direction = -towards.cast<float>();
    scene.set_light("sun", sun);
    app::Session session = session_of(scene, Vec3d(0, 0, 5));
    session.settings().shading.multiple_scattering = false;
    const Image image = render_linear(session);
    double largest = 0;
    for (int y = 10; y < size; y += 12)
        for (int x = 10; x < size; x += 12) {
            const Vec3d v = -ray_of(session.camera(), x, y).direction,
                        l(towards.x(), towards.y(), -towards.z());
            const double expected = (1 - schlick(v.z(), 0.04)) * ggx(v, l, 0.36, 0.36) * l.z();
            largest = std::max(largest, expected);
            // The weight is the albedo's complement at the roughness, not the mirror's Fresnel: 2 %.
            EXPECT_NEAR(image.at<float>(x, y)[0], expected, 0.03 * expected) << x << " " << y;
        }
    EXPECT_GT(largest, 0.2);
}

TEST(Transmission, ColoursPastTheToneCurveAreSeenThroughGlass) {
    Mesh wall = moved(facing_square(8, glowing(Vec3(0, 0.5f, 0))), Vec3d(0, 0, -2));
    Material plain;
    plain.base_color = Vec3(0, 0.5f, 0);
    wall.set_material(plain);
    Style as_it_is;
    as_it_is.lit = false;
    wall.set_style(as_it_is);
    Scene scene;
    scene.show(wall, "wall");
    scene.show(facing_square(2, glass()), "pane");
    app::Session session = session_of(scene, Vec3d(0, 0, 5));
    session.settings().tonemap.exposure = 2.0f;
    const Image image = session.render();
    EXPECT_NEAR(linear_from_srgb(image.at<uint8_t>(48, 48)[1] / 255.0f), 0.5 * 0.96, 0.006);
    EXPECT_EQ(image.at<uint8_t>(48, 48)[3], 255);
}

// Textures of one value are factors.
TEST(Transmission, Textures) {
    const auto picture = [](const Material& material) {
        Scene scene;
        scene.show(ball(material), "ball");
        scene.set_environment(constant_environment(1));
        app::Session session = session_of(scene);
        session.settings().environment.enabled = true;
        return render_linear(session);
    };
    auto image = std::make_shared<Image>(4, 4, 3, PixelType::u8);
    for (uint8_t& v : image->pixels<uint8_t>()) v = 51;
    const auto absorbing = [](float transmission, float thickness) {
        return glass([&](Material& m) {
            m.base_color = Vec3::Constant(0.5f);
            m.transmission = transmission;
            m.thickness = thickness;
            m.attenuation_color = Vec3::Constant(0.25f);
            m.attenuation_distance = 1;
        });
    };
    Material textured = absorbing(1, 0.5f);
    textured.transmission_texture.image = image;
    const Vec3 a(picture(textured).at<float>(48, 48)), b(picture(absorbing(0.2f, 0.5f)).at<float>(48, 48));
    EXPECT_NEAR(a.x(), b.x(), 0.003);
    EXPECT_GT(a.x() - picture(absorbing(1, 0.5f)).at<float>(48, 48)[0], 0.1);
    // The thickness counts where no back face tells the path: on an open square.
    const auto square = [&](const Material& material) {
        Scene scene;
        scene.show(facing_square(2, material), "square");
        scene.set_environment(constant_environment(1));
        app::Session session = session_of(scene, Vec3d(0, 0, 5));
        session.settings().environment.enabled = true;
        return render_linear(session).at<float>(48, 48)[0];
    };
    Material thick = absorbing(1, 1);
    thick.thickness_texture.image = image;
    thick.thickness_texture.channel = 1;
    EXPECT_NEAR(square(thick), 0.04 + 0.96 * 0.5 * std::pow(0.25, 0.2), 0.005);
    EXPECT_NEAR(square(absorbing(1, 1)), 0.04 + 0.96 * 0.5 * 0.25, 0.005);
}

// Ground truth shows glass as the surface that it is.
TEST(Transmission, GlassHasAnId) {
    Scene scene;
    scene.show(ball(glass()), "ball");
    app::Session session = session_of(scene);
    EXPECT_EQ(session.render_layers({"object_id"}).at("object_id").at<float>(48, 48)[0], 1.0f);
}

}  // namespace
}  // namespace easypbr::transmission_test
