// 3D Gaussian splats that lamps and sky light, and what is seen of a background at silhouettes before splats.
#include <cmath>
#include <functional>

#include "easypbr/core/color.h"
#include "shadow_test.h"
#include "splat_sheets.h"

namespace easypbr::gaussian_splat_relight_test {
namespace {

/// The radiance of opaque sheets in the plane z = 0 that are lit, seen straight on from before them.
Vec3 relit(const Vec3& color, const std::vector<Mesh>& casters,
           const std::function<void(Scene&, Settings&)>& light) {
    Scene scene;
    scene.show(sheets({0, -0.01f, -0.02f}, 0.99f, color), "sheets");
    for (size_t i = 0; i < casters.size(); ++i) scene.show(casters[i], "caster" + std::to_string(i));
    app::Session session = plain_session(scene, 32);
    session.settings().splats.relight = true;
    look_from(session, Vec3d(0, 0, 4), 5);
    light(scene, session.settings());
    const Image image = render_linear(session);
    return Eigen::Map<const Vec3>(image.at<float>(16, 16));
}

// Lambert's law: albedo / pi times the irradiance, intensity times the cosine. 0.003: light is kept in 9
// bits, the picture in half floats.
TEST(SplatsRelit, ReflectLampsAsMattSurfaces) {
    const Vec3 color(0.9f, 0.6f, 0.3f), albedo = linear_from_srgb(color);
    for (const double angle : {0.0, 30.0, 60.0}) {
        Light lamp = directional(Vec3(float(-std::sin(radians(angle))), 0, float(-std::cos(radians(angle)))));
        lamp.color = Vec3(1, 0.5f, 0.25f);
        lamp.intensity = 2;
        const auto light = [&](Scene& scene, Settings& s) {
            scene.set_light("lamp", lamp);
            s.shadows.enabled = true;
        };
        const Vec3 seen = relit(color, {}, light);
        const Vec3 expected = albedo.cwiseProduct(lamp.color) * float(2 * std::cos(radians(angle)) / pi);
        EXPECT_LT((seen - expected).cwiseAbs().maxCoeff(), 0.003f) << angle << " " << seen.transpose();
        // Behind a square that stands between the lamp and the middle, and beside the way into the camera.
        const Mesh square = rectangle(0.8f, -1, 4, 1, 1);
        const Vec3 hidden = relit(color, {square}, light);
        EXPECT_LT((hidden - (angle > 50 ? Vec3(Vec3::Zero()) : expected)).cwiseAbs().maxCoeff(), 0.003f)
            << angle;
    }
}

// An even sky: its radiance times the albedo; the other side of the sheets, from below, gets as much.
TEST(SplatsRelit, ReflectTheSky) {
    const Vec3 color(0.9f, 0.6f, 0.3f), albedo = linear_from_srgb(color);
    const Vec3 seen = relit(color, {}, [](Scene& scene, Settings& s) {
        scene.set_environment(constant_environment(0.7f));
        s.environment.enabled = true;
    });
    EXPECT_LT((seen - 0.7f * albedo).cwiseAbs().maxCoeff(), 0.003f) << seen.transpose();
}

// What is lit passes exposure and tone curve as surfaces do: an unlit square of the same radiance. A code,
// and 0.3 % of the light.
TEST(SplatsRelit, PassTheToneCurve) {
    const Vec3 color(0.9f, 0.6f, 0.3f), radiance = 0.7f * linear_from_srgb(color);
    for (const auto tone : {ToneOperator::aces, ToneOperator::reinhard, ToneOperator::agx,
                            ToneOperator::neutral, ToneOperator::none}) {
        const auto code = [&](const Mesh& mesh) {
            Scene scene;
            scene.show(mesh, "mesh");
            scene.set_environment(constant_environment(0.7f));
            app::Session session = plain_session(scene, 32);
            session.settings().splats.relight = true;
            session.settings().environment.enabled = true;
            session.settings().tonemap.tone_operator = tone;
            session.settings().tonemap.exposure = 1.7f;
            look_from(session, Vec3d(0, 0, 4), 5);
            const Image image = session.render({std::nullopt, 1, Encoding::srgb8});
            return Eigen::Vector3i(image.at<uint8_t>(16, 16)[0], image.at<uint8_t>(16, 16)[1],
                                   image.at<uint8_t>(16, 16)[2]);
        };
        Material unlit;
        unlit.unlit = true;
        unlit.base_color = radiance;
        const Eigen::Vector3i splats = code(sheets({0, -0.01f, -0.02f}, 0.99f, color)),
                              surface = code(facing_square(1, unlit));
        EXPECT_LE((splats - surface).cwiseAbs().maxCoeff(), 1)
            << int(tone) << ": " << splats.transpose() << ", " << surface.transpose();
    }
}

// A mirror shows the radiance itself, under any curve: as in AreSeenInMirrors.
TEST(SplatsRelit, AreSeenInMirrors) {
    const Vec3 color(0.9f, 0.4f, 0.2f), expected = linear_from_srgb(color);
    for (const bool paths : {true, false}) {
        app::Session session = before_mirror(paths, 0.99f, color, 6);
        session.settings().splats.relight = true;
        session.settings().tonemap.tone_operator = ToneOperator::aces;
        session.settings().environment.intensity = 1;
        const Image image = render_linear(session, 64);
        Vec3 sum = Vec3::Zero();
        for (int y = 8; y < 24; ++y)
            for (int x = 8; x < 24; ++x) sum += Eigen::Map<const Vec3>(image.at<float>(x, y)) / 256;
        EXPECT_LT((sum - expected).cwiseAbs().maxCoeff(), 0.02f) << paths << " " << sum.transpose();
    }
}

// A pixel at a silhouette before splats that hide the background shows the surface and the splats, in any
// part, but nothing of the white background: each sample's light counts by what is seen of it.
TEST(SplatsBehind, ShowNoBackgroundAtSilhouettes) {
    Material green;
    green.base_color = Vec3(0, 1, 0);
    for (const bool unlit : {true, false})
        for (const auto denoise : {Denoising::off, Denoising::filter}) {
            green.unlit = unlit;
            Mesh square = facing_square(0.5f, green);
            square.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(0.3, Vec3d::UnitZ())));
            Scene scene;
            scene.show(square, "square");
            scene.show(sheets({-0.5f, -0.51f, -0.52f}, 0.99f, Vec3(1, 0, 0)), "sheets");
            scene.set_environment(constant_environment(1));
            app::Session session = plain_session(scene, 32);
            Settings& s = session.settings();
            s.environment.enabled = true;
            s.shading.dielectric_f0 = 0;
            s.path.enabled = true;
            s.path.denoise = denoise;
            s.splats.receive = false;
            s.background.mode = BackgroundMode::color;
            s.background.color = Vec3(1, 1, 1);
            look_from(session, Vec3d(0, 0, 4), 20);
            const Image image = render_linear(session, 16);
            int mixed = 0;
            for (int y = 0; y < 32; ++y)
                for (int x = 0; x < 32; ++x) {
                    const float* p = image.at<float>(x, y);
                    // Half floats, and Schlick's rise at 10 degrees: 1e-7.
                    ASSERT_NEAR(p[2], 0, 0.002f) << x << " " << y << " " << unlit << int(denoise);
                    // 0.1: three deviations of the mean of 16 samples, each off by 0.13.
                    ASSERT_NEAR(p[0] + p[1], 1, 0.1f) << x << " " << y << " " << unlit << int(denoise);
                    mixed += p[0] > 0.1f && p[0] < 0.9f;
                }
            EXPECT_GT(mixed, 20);
        }
}

}  // namespace
}  // namespace easypbr::gaussian_splat_relight_test
