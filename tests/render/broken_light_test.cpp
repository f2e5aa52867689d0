// Values that are no numbers in what lights and covers things: replaced, counted, reported, and never spread.
#include <cmath>
#include <filesystem>
#include <limits>

#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::broken_light_test {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();

/// Everything that is logged while it lives.
struct Log {
    std::string text;
    Log() {
        set_log_sink([this](LogLevel, std::string_view message) { text += std::string(message) + "\n"; });
    }
    ~Log() { set_log_sink({}); }
};

/// 16 x 16 pixels of 0.5 with one NaN and one infinity.
std::shared_ptr<const Image> broken_image() {
    Image image(16, 16, 3, PixelType::f32);
    for (float& v : image.pixels<float>()) v = 0.5f;
    image.at<float>(3, 3)[1] = nan;
    image.at<float>(12, 9)[1] = infinity;
    return std::make_shared<const Image>(std::move(image));
}

void turn_on_effects(Settings& settings) {
    settings.bloom.enabled = true;
    settings.bloom.threshold = 0;
    settings.bloom.intensity = 0.5f;
    settings.depth_of_field.enabled = true;
    settings.depth_of_field.focus_distance = 3.0;
    settings.ssao.enabled = true;
}

/// Far from what is broken the picture is as if nothing were: 0.5 everywhere, 2 of 256 texels aside.
void expect_contained(const Image& picture, float expected) {
    for (float v : picture.pixels<float>()) ASSERT_TRUE(std::isfinite(v));
    EXPECT_NEAR(picture.at<float>(picture.width() / 2, picture.height() / 2)[1], expected, 0.1f * expected);
}

TEST(BrokenLight, OfATextureIsContained) {
    Material material;
    material.base_color = Vec3::Zero();
    material.emissive = Vec3::Ones();
    material.emissive_texture.image = broken_image();
    material.emissive_texture.path = "broken.exr";
    Scene scene;
    scene.show(facing_square(3, material), "square");
    for (int samples : {1, 4}) {
        app::Session session = plain_session(scene, 64);
        look_from(session, {0, 0, 5});
        turn_on_effects(session.settings());
        Log log;
        const Image picture = render_linear(session, samples);
        EXPECT_NE(log.text.find("broken.exr': 2 values"), std::string::npos) << log.text;
        expect_contained(picture, 0.5f);
    }
}

TEST(BrokenLight, OfAnEnvironmentIsContained) {
    Log log;
    Image sky(32, 16, 3, PixelType::f32);
    for (float& v : sky.pixels<float>()) v = 0.5f;
    sky.at<float>(3, 3)[0] = nan;
    sky.at<float>(20, 9)[1] = infinity;
    sky.at<float>(9, 12)[2] = -1;
    Material white;
    white.base_color = Vec3::Ones();
    Mesh ball = make_sphere(1);
    ball.set_material(white);
    Scene scene;
    scene.show(ball, "ball");
    scene.set_environment(Environment(sky, "broken.hdr"));
    EXPECT_NE(log.text.find("broken.hdr': 3 values"), std::string::npos) << log.text;
    app::Session session = plain_session(scene, 64);
    session.settings().environment.enabled = true;
    session.settings().background.mode = BackgroundMode::environment;
    turn_on_effects(session.settings());
    expect_contained(render_linear(session, 1), 0.5f);
    expect_contained(render_linear(session, 4), 0.5f);
}

TEST(BrokenLight, OfABackgroundImageIsContained) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / "easypbr_broken_background.exr";
    io::save_image(*broken_image(), file);
    Scene scene;
    scene.show(facing_square(0.1f), "square");
    app::Session session = plain_session(scene, 64);
    session.settings().background.mode = BackgroundMode::image;
    session.settings().background.image = file.string();
    turn_on_effects(session.settings());
    Log log;
    const Image picture = render_linear(session, 1);
    std::filesystem::remove(file);
    EXPECT_NE(log.text.find("2 values"), std::string::npos) << log.text;
    for (float v : picture.pixels<float>()) ASSERT_TRUE(std::isfinite(v));
}

}  // namespace
}  // namespace easypbr::broken_light_test
