#include <cmath>

#include "render_test.h"

#include "easypbr/scene/settings.h"

namespace easypbr::lighting_test {
namespace {

Material diffuse(float albedo) {
    Material m;
    m.base_color = Vec3::Constant(albedo);
    m.roughness = 1;
    return m;
}

/// World position on the plane z = 0 that pixel (x, y) of a square picture sees from (0, 0, distance).
Vec3 plane_point(int x, int y, int size, double distance, double fov_deg) {
    const double t = std::tan(radians(fov_deg / 2)) * distance;
    return Vec3(float(((x + 0.5) / size * 2 - 1) * t), float((1 - (y + 0.5) / size * 2) * t), 0);
}

// Lambert: L = albedo I cos / (pi d^2). F0 = 0 leaves the diffuse part alone: kd = 1 - (F0 A + B) - ..., so
// B, the Fresnel part at grazing angles, is left out by switching multiple scattering off and comparing near
// the axis, where B < 0.001. 0.5 % is the required bound.
// At 2^33 squares of squared distances leave single precision.
TEST(Lighting, LambertUnderAPointLight) {
    for (const float scale : {1.0f, 0x1p33f}) {
        Scene scene;
        scene.show(facing_square(scale, diffuse(0.5f)), "square");
        Light light;
        light.position = double(scale) * Vec3d(0.3, 0.2, 2);
        light.intensity = 7 * scale * scale;
        scene.set_light("point", light);
        app::Session session = plain_session(scene);
        session.settings().shading.dielectric_f0 = 0;
        session.settings().shading.multiple_scattering = false;
        look_from(session, Vec3d(0, 0, 5) * scale, 20);
        const Image image = render_linear(session);
        for (int y = 8; y < 56; y += 8)
            for (int x = 8; x < 56; x += 8) {
                const Vec3d to_light =
                    light.position - plane_point(x, y, 64, 5 * double(scale), 20).cast<double>();
                const double d2 = to_light.squaredNorm(), cosine = to_light.z() / std::sqrt(d2);
                // What is left of the specular lobe at roughness 1 and F0 = 0 is below 0.1 % here:
                // (1 - VoH)^5.
                EXPECT_NEAR(image.at<float>(x, y)[0] / (0.5 * light.intensity * cosine / (pi * d2)), 1, 0.005)
                    << scale;
            }
    }
}

TEST(Lighting, DirectionalAndSpot) {
    Scene scene;
    scene.show(facing_square(2, diffuse(0.5f)), "square");
    Light sun;
    sun.type = LightType::directional;
    sun.direction = Vec3(0, 0, -3);
    sun.intensity = 2;
    scene.set_light("sun", sun);
    app::Session session = plain_session(scene);
    session.settings().shading.dielectric_f0 = 0;
    session.settings().shading.multiple_scattering = false;
    look_from(session, Vec3d(0, 0, 5), 20);
    EXPECT_NEAR(render_linear(session).at<float>(32, 32)[0], 0.5 * 2 / pi, 0.002);

    scene.remove_light("sun");
    Light spot;
    spot.type = LightType::spot;
    spot.position = Vec3d(0, 0, 2);
    spot.direction = Vec3(0, 0, -1);
    spot.intensity = 8;
    spot.inner_cone_deg = 5;
    spot.outer_cone_deg = 10;
    scene.set_light("spot", spot);
    const Image image = render_linear(session);
    EXPECT_NEAR(image.at<float>(32, 32)[0], 0.5 * 8 / (4 * pi), 0.002);
    // The cone of 10 degrees ends at 0.353 on the plane; the picture's edge sees 0.88.
    EXPECT_EQ(image.at<float>(2, 32)[0], 0.0f);
}

// More lights than one block holds: the sum of all.
TEST(Lighting, AnyNumberOfLights) {
    Scene scene;
    scene.show(facing_square(1, diffuse(0.8f)), "square");
    Light light;
    light.position = Vec3d(0, 0, 3);
    light.intensity = 0.5f;
    scene.set_light("0", light);
    app::Session session = plain_session(scene);
    look_from(session, Vec3d(0, 0, 5), 20);
    const float one = render_linear(session).at<float>(32, 32)[0];
    for (int i = 1; i < 150; ++i) scene.set_light(std::to_string(i), light);
    EXPECT_NEAR(render_linear(session).at<float>(32, 32)[0] / (150 * one), 1, 1e-4);
}

// At UTM coordinates a step of single precision is half a metre: a lamp 30 cm from a square must light it as
// it does at the origin. The camera, too, is placed in double precision; what is left are roundings of
// positions relative to it, far below 0.1 % of the light.
TEST(Lighting, LampsFarFromTheOrigin) {
    const auto lit_at = [](const Vec3d& place) {
        Mesh square = facing_square(0.2f, diffuse(0.8f));
        square.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(place)));
        Scene scene;
        scene.show(square, "square");
        Light lamp;
        lamp.position = place + Vec3d(0.13, -0.07, 0.3);
        lamp.intensity = 0.5f;
        lamp.radius = 0.0f;
        scene.set_light("lamp", lamp);
        app::Session session = plain_session(scene);
        look_from(session, place + Vec3d(0, 0, 1), 20);
        session.settings().camera.target = place;
        return render_linear(session);
    };
    const Image here = lit_at(Vec3d::Zero()), there = lit_at(Vec3d(500000.3, 4500000.2, 100.1));
    for (int y = 4; y < 64; y += 8)
        for (int x = 4; x < 64; x += 8)
            EXPECT_NEAR(there.at<float>(x, y)[0] / here.at<float>(x, y)[0], 1, 1e-3) << x << " " << y;
}

// White furnace: in a constant environment a surface that absorbs nothing disappears. The halves of the
// environment maps and the 16-bit albedo hold 0.05 %; the required bound is 0.5 %.
TEST(Lighting, WhiteFurnace) {
    for (const float metallic : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
        for (const float roughness : {0.1f, 0.25f, 0.5f, 0.75f, 1.0f}) {
            Material m;
            m.base_color = Vec3::Ones();
            m.metallic = metallic;
            m.roughness = roughness;
            Mesh sphere = make_sphere(1, 64);
            sphere.set_material(m);
            Scene scene;
            scene.show(sphere, "sphere");
            scene.set_environment(constant_environment(0.7f));
            app::Session session = plain_session(scene, 96);
            session.settings().environment.enabled = true;
            const Image image = render_linear(session);
            size_t covered = 0;
            for (int y = 0; y < 96; ++y)
                for (int x = 0; x < 96; ++x) {
                    const float* p = image.at<float>(x, y);
                    if (p[3] == 0) continue;
                    ++covered;
                    ASSERT_NEAR(p[1] / 0.7f, 1, 0.005)
                        << "metallic " << metallic << " roughness " << roughness;
                }
            EXPECT_GT(covered, 3000u);
        }
}

// The BRDF of a half metal is the mean of those of a metal and a dielectric (glTF 2.0, Appendix B): a sphere
// in a constant environment, which no channel exceeds. 0.002: the 16-bit albedo and halves of the
// environment.
TEST(Lighting, MixesMetalsWithDielectrics) {
    const auto picture = [](float metallic) {
        Material m;
        m.base_color = Vec3(0.2f, 0.5f, 0.9f);
        m.metallic = metallic;
        m.roughness = 0.4f;
        Mesh sphere = make_sphere(1, 64);
        sphere.set_material(m);
        Scene scene;
        scene.show(sphere, "sphere");
        scene.set_environment(constant_environment(1));
        app::Session session = plain_session(scene);
        session.settings().environment.enabled = true;
        return render_linear(session);
    };
    const Image dielectric = picture(0), metal = picture(1), half = picture(0.5f);
    for (size_t i = 0; i < half.pixel_count(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const auto at = [&](const Image& image) { return image.pixels<float>()[4 * i + c]; };
            EXPECT_LE(at(half), 1.002f);
            EXPECT_NEAR(at(half), (at(dielectric) + at(metal)) / 2, 0.002) << i << ", channel " << c;
        }
    EXPECT_LT(half.at<float>(32, 32)[0], half.at<float>(32, 32)[2]);
}

// Light k times as bright with exposure 1/k: the same picture. Powers of two are exact.
TEST(Lighting, ExposureUndoesIntensity) {
    Scene scene;
    scene.show(make_sphere(), "sphere");
    app::Session session = plain_session(scene);
    session.settings().tonemap.tone_operator = ToneOperator::aces;
    Light light;
    light.position = Vec3d(2, 3, 4);
    light.intensity = 20;
    scene.set_light("light", light);
    const Image a = session.render();
    light.intensity *= 8;
    scene.set_light("light", light);
    session.settings().tonemap.exposure = 1.0f / 8;
    const Image b = session.render();
    EXPECT_TRUE(std::ranges::equal(a.bytes(), b.bytes()));
}

// Exposed to 0.5, which is 188 in sRGB; 1 for roundings, of half precision among them.
TEST(Lighting, FaintEmissionIsSeen) {
    for (const float emission : {1.1e-5f, 0.9e-5f, 1e-6f}) {
        Material faint;
        faint.base_color = Vec3::Zero();
        faint.emissive = Vec3::Constant(emission);
        faint.specular = 0;
        Scene scene;
        scene.show(facing_square(20, faint), "wall");
        app::Session session = plain_session(scene, 16);
        look_from(session, Vec3d(0, 0, 4));
        session.settings().tonemap.exposure = 0.5f / emission;
        for (const bool paths : {false, true}) {
            session.settings().path.enabled = paths;
            EXPECT_NEAR(session.render({std::nullopt, 4}).at<uint8_t>(8, 8)[1], 188, 1) << emission << paths;
        }
    }
}

}  // namespace
}  // namespace easypbr::lighting_test
