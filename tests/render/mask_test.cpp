// Cut-outs that are smaller than a pixel.
#include <algorithm>
#include <cmath>
#include <memory>

#include "render_test.h"

namespace easypbr::mask_test {
namespace {

/// Opaque squares of `side` texels, one in each 8 x 8, `tiles` times 8 of them along a side.
Material squares(int side, float tiles) {
    auto image = std::make_shared<Image>(64, 64, 4, PixelType::u8);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 4; ++c)
                image->at<uint8_t>(x, y)[c] = c < 3 || (x % 8 < side && y % 8 < side) ? 255 : 0;
    Material m;
    m.base_color_texture.image = image;
    m.base_color_texture.uv_transform.diagonal() << tiles, tiles, 1;
    m.alpha_mode = AlphaMode::mask;
    m.unlit = true;
    return m;
}

// Bilinear opacity is 1 in the (k - 1)^2 cells between the centres of a square of k x k texels. In each of
// the 4 (k - 1) cells along its sides it passes 1/2 in the middle. In each of its 4 corner cells it is u v,
// which is 1/2 or more in an area of (1 - ln 2) / 2.
double coverage_of(int side) {
    const double inner = side - 1;
    return (inner * inner + 2 * inner + 2 * (1 - std::log(2.0))) / 64;
}

}  // namespace

// A pixel holds two squares in each direction, and a little more, so that pixels see all of a square. 0.02:
// of 64 samples in each of 576 pixels three standard deviations are 0.008, but pixels share their jitter.
TEST(Mask, MeanOfSamplesIsTheCoverage) {
    for (const bool paths : {false, true})
        for (const int side : {4, 6}) {
            Scene scene;
            scene.show(facing_square(1, squares(side, 8.37f)), "square");
            app::Session session = plain_session(scene, 32);
            Settings& s = session.settings();
            s.path.enabled = paths;
            s.camera.projection = Projection::orthographic;
            s.camera.ortho_height = 2.0;
            look_from(session, Vec3d(0, 0, 3));
            const Image picture = render_linear(session, 64);
            double sum = 0;
            for (int y = 4; y < 28; ++y)
                for (int x = 4; x < 28; ++x) sum += double(picture.at<float>(x, y)[3]);
            EXPECT_NEAR(sum / (24 * 24), coverage_of(side), 0.02) << "side " << side << ", paths " << paths;
        }
}

// Colours that alpha hides are not seen from anywhere, nor between texels: not natively, by the driver, or in
// paths.
TEST(Mask, HiddenColorsAreNotSeen) {
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend})
        for (const float tiles : {0.5f, 8.37f, 60.0f})
            for (const int way : {0, 1, 2}) {
                Material m = squares(4, tiles);
                auto image = std::make_shared<Image>(*m.base_color_texture.image);
                for (int y = 0; y < 64; ++y)
                    for (int x = 0; x < 64; ++x) {
                        uint8_t* texel = image->at<uint8_t>(x, y);
                        texel[texel[3] > 0 ? 0 : 1] = texel[2] = 0;
                    }
                m.base_color_texture.image = image;
                m.alpha_mode = mode;
                m.alpha_cutoff = 0.2f;
                m.base_color = Vec3::Ones();
                Scene scene;
                scene.show(facing_square(1, m), "square");
                app::Session session = plain_session(scene, 32);
                session.allow_native_shading(way != 1);
                session.allow_native_geometry(way != 1);
                session.settings().path.enabled = way == 2;
                look_from(session, Vec3d(0, 0, 3));
                const Image picture = render_linear(session, 4);
                float most_red = 0, green = 0, alpha = 0;
                for (int y = 8; y < 24; ++y)
                    for (int x = 8; x < 24; ++x) {
                        const float* pixel = picture.at<float>(x, y);
                        most_red = std::max(most_red, pixel[0]);
                        green += pixel[1];
                        alpha += pixel[3];
                    }
                SCOPED_TRACE(testing::Message() << int(mode) << ", " << tiles << " tiles, way " << way);
                EXPECT_EQ(most_red, 0);
                // 0.003: roundings to 8 and 16 bits.
                EXPECT_NEAR(green / alpha, 1, 0.003);
                EXPECT_GT(alpha, 32);
            }
}

// glTF 2.0, 3.9.4: what has an alpha of at least the cutoff is there, natively, by the driver and in paths.
TEST(Mask, WhatHasTheAlphaOfTheCutoffIsThere) {
    for (const int code : {0, 1, 51, 128, 153, 254})
        for (const int way : {0, 1, 2}) {
            Image image(4, 4, 4, PixelType::u8);
            for (uint8_t& value : image.pixels<uint8_t>()) value = uint8_t(code);
            Material m;
            m.base_color_texture.image = std::make_shared<Image>(image);
            m.alpha_mode = AlphaMode::mask;
            m.alpha_cutoff = code > 0 ? float(code) / 255 : 1e-7f;  // what is fully clear is a hole
            Scene scene;
            scene.show(facing_square(1, m), "square");
            app::Session session = plain_session(scene, 8);
            session.allow_native_shading(way != 1);
            session.allow_native_geometry(way != 1);
            session.settings().path.enabled = way == 2;
            look_from(session, Vec3d(0, 0, 3), 20);
            const float alpha = render_linear(session, way == 2 ? 8 : 1).at<float>(4, 4)[3];
            EXPECT_EQ(alpha, code > 0 ? 1 : 0) << code << ", way " << way;
        }
}

}  // namespace easypbr::mask_test
