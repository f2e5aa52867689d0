// Background images behind pictures of lenses: the lens took them, so it does not bend them again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "easypbr/app/session.h"
#include "easypbr/core/color.h"
#include "easypbr/core/image.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/render/pipeline/tiles.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::lens_background_test {
namespace {

const Vec2i size(96, 72);

/// Stripes, whose edges show whatever mixes them with others, over a gradient.
template <class T>
Image photo(PixelType type, T step) {
    Image image(size.x(), size.y(), 3, type);
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) {
            const T value[3] = {T(step * T(x)), T(step * T(y % 4 == 0 ? 250 : 20)), T(step * T(2 * y))};
            std::copy_n(value, 3, image.at<T>(x, y));
        }
    return image;
}

Image photo8() {
    return photo<uint8_t>(PixelType::u8, 1);
}

/// A ball, or, where it is to be an empty picture, one behind the camera.
Session session_of(bool seen) {
    Mesh ball = make_sphere(1, 32);
    ball.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0.2, 0.1, seen ? 0 : 20)));
    Scene scene;
    scene.show(ball, "ball");
    Session session(scene);
    session.settings().image.size = size;
    session.settings().image.samples = 4;
    session.settings().ground.mode = GroundMode::none;
    return session;
}

enum class Lens { none, skewed, brown_conrady, fisheye };

void look(Session& session, Lens lens) {
    Camera camera = Camera::look_at(Vec3d(0, 0, 4), Vec3d(0, 0, 0));
    camera.intrinsics = Intrinsics{90, 90, 47.5, 35.5, size.x(), size.y(), lens == Lens::skewed ? 7.0 : 0.0};
    if (lens == Lens::brown_conrady)
        camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.2, 0.05, 0, 0});
    if (lens == Lens::fisheye)
        camera.distortion = Distortion::from_coefficients(DistortionModel::fisheye, {0.05, -0.01, 0.002, 0});
    session.set_camera(camera);
}

const auto lenses = {Lens::skewed, Lens::brown_conrady, Lens::fisheye};

Image rendered(Session& session, Encoding encoding = Encoding::srgb8) {
    return session.render({size, std::nullopt, encoding});
}

/// Largest difference of the colours.
template <class T>
double difference(const Image& picture, const Image& expected) {
    double most = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < 3; ++c)
                most = std::max(most, std::abs(double(picture.at<T>(x, y)[c]) - expected.at<T>(x, y)[c]));
    return most;
}

TEST(LensBackground, IsShownAsItIs) {
    for (const Lens lens : lenses) {
        Session session = session_of(false);
        look(session, lens);
        session.set_background(photo8());
        const Image codes = rendered(session);
        EXPECT_EQ(codes.type(), PixelType::u8);
        EXPECT_EQ(difference<uint8_t>(codes, photo8()), 0) << int(lens);
        EXPECT_EQ(codes.at<uint8_t>(3, 5)[3], 255);
        // Codes are decoded and encoded again in single precision.
        const Image fine = photo<uint16_t>(PixelType::u16, 257);
        session.set_background(fine);
        EXPECT_LE(difference<uint16_t>(rendered(session, Encoding::srgb16), fine), 1) << int(lens);
        const Image light = photo<float>(PixelType::f32, 0.01f);
        session.set_background(light);
        const Image hdr = rendered(session, Encoding::scene_linear);
        EXPECT_EQ(hdr.type(), PixelType::f32);
        // Filtered in single precision at places that are rounded: 1e-5 of a step of 2.3.
        EXPECT_LE(difference<float>(hdr, light), 5e-5) << int(lens);
    }
}

// An image of another size and shape, partly transparent, halved, cropped and filtered as without a lens.
TEST(LensBackground, CoversThePictureAsWithoutALens) {
    Image image(300, 150, 4, PixelType::u8);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const uint8_t value[4] = {uint8_t(x % 256), uint8_t(y), uint8_t(x / 9 % 2 * 200),
                                      uint8_t(255 - y)};
            std::copy_n(value, 4, image.at<uint8_t>(x, y));
        }
    Session plain = session_of(false), bent = session_of(false);
    look(plain, Lens::none);
    look(bent, Lens::brown_conrady);
    for (Session* session : {&plain, &bent}) {
        session->set_background(image);
        session->settings().background.color = Vec3(1, 0.5f, 0);
    }
    // One code where the two round to different sides.
    EXPECT_LE(difference<uint8_t>(rendered(bent), rendered(plain)), 1);
}

// The transparent picture laid over the photo by hand, in linear light.
TEST(LensBackground, LiesBehindWhatTheLensShows) {
    for (const Lens lens : lenses) {
        Session session = session_of(true);
        look(session, lens);
        session.set_background(photo8());
        const Image codes = rendered(session), light = rendered(session, Encoding::scene_linear);
        session.settings().background.mode = BackgroundMode::transparent;
        const Image over = rendered(session, Encoding::srgb16),
                    light_over = rendered(session, Encoding::scene_linear);
        double most = 0, most_light = 0;
        int borders = 0;
        for (int y = 0; y < size.y(); ++y)
            for (int x = 0; x < size.x(); ++x)
                for (int c = 0; c < 3; ++c) {
                    const double alpha = over.at<uint16_t>(x, y)[3] / 65535.0;
                    borders += alpha > 0 && alpha < 1;
                    const double behind = linear_from_srgb(float(photo8().at<uint8_t>(x, y)[c]) / 255);
                    const double front = linear_from_srgb(float(over.at<uint16_t>(x, y)[c]) / 65535);
                    const auto expected = float(alpha * front + (1 - alpha) * behind);
                    most = std::max(
                        most, std::abs(codes.at<uint8_t>(x, y)[c] - 255.0 * srgb_from_linear(expected)));
                    const float* pixel = light_over.at<float>(x, y);
                    most_light = std::max(
                        most_light, std::abs(pixel[c] + (1 - pixel[3]) * behind - light.at<float>(x, y)[c]));
                }
        EXPECT_GT(borders, 100);
        // Rounding to codes of 8 bits, and those of 16 bits before: 1/257 of them.
        EXPECT_LE(most, 0.51) << int(lens);
        // Filtered at places that are rounded: 1e-5 of 1.
        EXPECT_LE(most_light, 2e-5) << int(lens);
    }
}

/// Of one colour, as a setting and as an image.
Image flat(const Vec3& color) {
    Image image(size.x(), size.y(), 3, PixelType::u8);
    const Rgb8 code = to_rgb8(color);
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) std::copy_n(code.data(), 3, image.at<uint8_t>(x, y));
    return image;
}

// What covers a part of a pixel is mixed with what is behind it in linear light, before and through the lens:
// a background is the same whether it is drawn with the scene or put behind it.
TEST(LensBackground, OfOneColourIsThatOfAnImageOfIt) {
    for (const Lens lens : lenses)
        for (const Vec3& color : {Vec3(1, 1, 1), Vec3(1, 0.2f, 0), Vec3(0, 0, 0)}) {
            Session session = session_of(true);
            Mesh ball = session.scene().get("ball");
            Material black;
            black.base_color = Vec3(0, 0, 0);
            ball.set_material(black);
            session.scene().show(ball, "ball");
            look(session, lens);
            session.settings().background.mode = BackgroundMode::color;
            session.settings().background.color = color;
            const Image drawn_with = rendered(session);
            session.set_background(flat(color));
            // Half a code of rounding before the lens, and half a code after it.
            EXPECT_LE(difference<uint8_t>(drawn_with, rendered(session)), 1) << int(lens);
        }
}

// A lens that does nothing: the picture is that without it. Glass shows the photo as it does there.
TEST(LensBackground, IsSeenThroughSurfacesAsWithoutALens) {
    Session plain = session_of(true), bent = session_of(true);
    for (Session* session : {&plain, &bent}) {
        Mesh ball = session->scene().get("ball");
        Material glass;
        glass.base_color = Vec3(0.6f, 0.8f, 1);
        glass.opacity = 0.5f;
        ball.set_material(glass);
        session->scene().show(ball, "ball");
        session->set_background(photo8());
        session->settings().shadows.enabled = false;
        session->settings().ssao.enabled = false;
        look(*session, Lens::none);
    }
    Camera camera = plain.camera();
    camera.intrinsics->skew = 1e-9;
    bent.set_camera(camera);
    EXPECT_GT(difference<uint8_t>(rendered(plain), photo8()), 50);
    // Positions of pixels are rounded otherwise in a picture that is wider by two pixels.
    EXPECT_LE(difference<uint8_t>(rendered(bent), rendered(plain)), 2);
}

TEST(LensBackground, IsThatOfTheStillWhileThePictureRefines) {
    Session session = session_of(true);
    look(session, Lens::brown_conrady);
    session.set_background(photo8());
    const Image still = rendered(session);
    Session::Refinement done;
    int began = 0;
    do {
        done = session.refine({}, true);
        began += done.began;
    } while (done.frames < done.total);
    EXPECT_EQ(began, 1);
    EXPECT_EQ(difference<uint8_t>(done.drawn.picture(), still), 0);
    EXPECT_EQ(done.drawn.picture().type(), PixelType::u8);
    EXPECT_EQ(difference<uint8_t>(session.draw().read_later().take(), still), 0);
    // Another image, and none, are seen at once.
    Image other = photo8();
    std::ranges::fill(other.bytes(), std::byte(7));
    session.set_background(other);
    EXPECT_EQ(session.refine().drawn.picture().at<uint8_t>(0, 0)[0], 7);
    session.settings().background.mode = BackgroundMode::color;
    session.settings().background.color = Vec3(1, 0, 0);
    EXPECT_EQ(session.refine().drawn.picture().at<uint8_t>(0, 0)[0], 255);
}

TEST(LensBackground, IsThatOfTheWholePictureInTiles) {
    const Vec2i large = 8 * size;
    Session whole = session_of(true), tiled = session_of(true);
    for (Session* session : {&whole, &tiled}) {
        session->settings().ssao.enabled = false;
        look(*session, Lens::brown_conrady);
        session->set_background(photo8());
    }
    const int guard = render::guard_of(tiled.scene().snapshot(), tiled.resolve(large), large).pixels;
    const int side = 2 * guard + 2 * render::tile_grid;
    const render::TileLimits limits{side, int64_t(side) * side};
    EXPECT_GT(render::tiles_of(large, guard, limits).size(), 1u);
    tiled.limit_tiles(limits);
    // As tiles of other pictures are.
    EXPECT_LE(difference<uint8_t>(tiled.render({large, 1, Encoding::srgb8}),
                                  whole.render({large, 1, Encoding::srgb8})),
              1);
}

}  // namespace
}  // namespace easypbr::app::lens_background_test
