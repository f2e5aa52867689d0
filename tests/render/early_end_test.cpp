// Pictures that end before they have all their samples.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "render_test.h"

namespace easypbr::early_end_test {
namespace {

app::Session path_session(const Scene& scene, Vec2i size) {
    app::Session session = plain_session(scene);
    Settings& s = session.settings();
    s.image.size = size;
    s.path.enabled = true;
    s.path.denoise = Denoising::off;
    s.shadows.enabled = true;
    s.background.mode = BackgroundMode::color;
    s.background.color = Vec3::Zero();
    return session;
}

/// The picture that refinement ends with, and its number of frames.
std::pair<Image, int> refined(app::Session& session, int samples) {
    for (;;) {
        const auto done = session.refine({std::nullopt, samples});
        if (done.frames == done.total) return {done.drawn.picture(), done.frames};
    }
}

/// 25 white balls, 5 pixels wide and 18 apart in a picture of 96 x 96.
struct SmallBalls {
    SmallBalls() {
        Material white;
        white.base_color = Vec3::Ones();
        white.roughness = 1;
        Mesh ball = make_sphere(0.06f, 16);
        ball.set_material(white);
        for (int i = 0; i < 25; ++i) {
            Eigen::Affine3d pose = Eigen::Affine3d::Identity();
            pose.translation() = Vec3d(i % 5 - 2, i / 5 - 2, 0) * 0.5;
            ball.set_T_world_mesh(pose);
            scene.show(ball, std::to_string(i));
        }
        scene.set_environment(constant_environment(0.7f));
    }
    app::Session session() const {
        app::Session session = path_session(scene, {96, 96});
        session.settings().environment.enabled = true;
        look_from(session, Vec3d(0, 0, 6), 25);
        return session;
    }
    Scene scene;
};

/// Mean distance, from 0 to 1, over the pixels of which `reference` shows something.
double mean_error(const Image& picture, const Image& reference) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const int seen = reference.at<uint8_t>(x, y)[1];
            if (seen == 0) continue;
            sum += std::abs(int(picture.at<uint8_t>(x, y)[1]) - seen) / 255.0;
            ++count;
        }
    return sum / count;
}

// No square of 16 x 16 pixels has 32 of surfaces: they count together. The error that is asked for is a
// deviation, of which the mean distance is 0.8; the rest is for the balls' edges, whose coverage is not
// counted as noise.
TEST(EarlyEnd, SmallSurfacesAreAsGoodAsAsked) {
    const SmallBalls balls;
    app::Session session = balls.session();
    const Image reference = refined(session, 512).first;
    for (const float asked : {0.05f, 0.02f}) {
        session.settings().image.noise = asked;
        const auto [picture, frames] = refined(session, 512);
        EXPECT_LE(mean_error(picture, reference), asked);
        EXPECT_GE(frames, 16) << "of silhouettes";
        EXPECT_LT(frames, 512);
    }
}

// A wall that fills a picture of 25 pixels: fewer than a square needs, and all that there are.
TEST(EarlyEnd, TinyPicturesAreAsGoodAsAsked) {
    Scene scene;
    scene.show(facing_square(20), "wall");
    Light light;
    light.position = Vec3d(4, 0, 4);
    light.radius = 2;
    light.intensity = 80;
    scene.set_light("lamp", light);
    Mesh ball = make_sphere(0.5f, 32);
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    pose.translation() = Vec3d(2, 0, 2);
    ball.set_T_world_mesh(pose);
    scene.show(ball, "ball");
    app::Session session = path_session(scene, {5, 5});
    look_from(session, Vec3d(0, 0, 4));
    const Image reference = refined(session, 2048).first;
    int before = 0;
    for (const float asked : {0.05f, 0.01f, 0.005f}) {
        session.settings().image.noise = asked;
        const auto [picture, frames] = refined(session, 2048);
        // The error of 25 pixels is known to a tenth of itself; its mean distance is 0.8 deviations.
        EXPECT_LE(mean_error(picture, reference), asked);
        EXPECT_GE(frames, std::max(16, before));
        before = frames;
    }
    EXPECT_GT(before, 16);
}

// Their light has no noise that tells when they are smooth.
TEST(EarlyEnd, UnlitSilhouettesAndBlurAreSmooth) {
    const SmallBalls balls;
    for (const bool lens : {false, true}) {
        app::Session session = balls.session();
        session.settings().style.lit = false;
        session.settings().depth_of_field.enabled = lens;
        session.settings().image.noise = 0.1f;
        EXPECT_EQ(refined(session, 64).second, 16) << "lens " << lens;
    }
    // What fills the picture is smooth but for the lens.
    Scene scene;
    scene.show(facing_square(20), "wall");
    app::Session session = path_session(scene, {32, 32});
    look_from(session, Vec3d(0, 0, 4));
    session.settings().depth_of_field.enabled = true;
    session.settings().image.noise = 0.1f;
    EXPECT_EQ(refined(session, 64).second, 16);
}

TEST(EarlyEnd, PicturesOfNothingEndAtOnce) {
    Scene scene;
    scene.show(make_sphere(1, 16), "ball");
    app::Session session = path_session(scene, {32, 32});
    session.settings().camera.position = Vec3d(0, 0, 5);
    session.settings().camera.target = Vec3d(0, 0, 10);
    session.settings().image.noise = 0.01f;
    EXPECT_EQ(refined(session, 64).second, 4);
}

/// Where the middle of what is seen lies, in pixels.
Vec2d centroid(const Image& image) {
    Vec2d sum(0, 0);
    double all = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const double alpha = image.at<uint8_t>(x, y)[3];
            sum += alpha * Vec2d(x, y);
            all += alpha;
        }
    return sum / all;
}

// Wherever a picture ends it is in its place. 0.05 of a pixel: edges of 20 pixels are crossed by few rows of
// samples.
TEST(EarlyEnd, DoesNotShiftPictures) {
    Scene scene;
    scene.show(make_box(), "box");
    app::Session session = plain_session(scene);
    look_from(session, Vec3d(2.1, 1.3, 3.2), 40);
    session.settings().image.time_budget = 1e6f;
    std::map<int, Vec2d> centroids;
    for (int frames = 0; frames < 1024;) {
        const auto done = session.refine({std::nullopt, 1024});
        frames = done.frames;
        if (frames == 4 || frames == 8 || frames == 16 || frames == 1024)
            centroids[frames] = centroid(done.drawn.picture());
    }
    for (const int frames : {4, 8, 16})
        EXPECT_LT((centroids.at(frames) - centroids.at(1024)).cwiseAbs().maxCoeff(), 0.05) << frames;
}

}  // namespace
}  // namespace easypbr::early_end_test
