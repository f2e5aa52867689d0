// Passes of a program's own in pictures that are drawn in tiles: the picture is that which is drawn at once.
#include <gtest/gtest.h>

#include "easypbr/app/custom_pass.h"
#include "easypbr/app/session.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::tiled_passes_test {
namespace {

/// Brightens by the place in the whole picture, and draws a line where the depth eight pixels away differs:
/// both go wrong at seams, the one without u_origin, the other without a guard band.
constexpr const char* shader = R"(
#include "common_camera.glsl"
uniform sampler2D u_depth_target;
uniform sampler2D u_image;
uniform vec2 u_origin;
uniform vec2 u_picture_size;
layout(location = 0) out vec4 color;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = (gl_FragCoord.xy + u_origin) / u_picture_size;
    vec4 old = texelFetch(u_image, pixel, 0);
    float edge = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i == 0 ? 8 : i == 1 ? -8 : 0, i == 2 ? 8 : i == 3 ? -8 : 0);
        ivec2 other = clamp(pixel + side, ivec2(0), textureSize(u_depth_target, 0) - 1);
        bool here = texelFetch(u_depth_target, pixel, 0).r > 0.0, there = texelFetch(u_depth_target, other, 0).r > 0.0;
        edge = max(edge, here != there ? 1.0 : 0.0);
    }
    color = vec4(mix(0.5 * old.rgb + 0.4 * place.x * place.y, vec3(1.0, 0.6, 0.0), edge), 1.0);
}
)";

class TiledPasses : public testing::TestWithParam<Stage> {
  protected:
    static Session session_with_pass(Stage stage) {
        Scene scene;
        scene.show(make_sphere(1, 32), "ball");
        Session session(scene);
        session.settings().image.size = Vec2i(700, 500);
        session.settings().image.samples = 1;
        session.settings().ssao.enabled = false;
        session.add_pass("own", stage, std::make_shared<ShaderPass>("own.frag", shader, Blend::replace));
        return session;
    }
};

TEST_P(TiledPasses, DrawWhatTheyDrawAtOnce) {
    Session whole = session_with_pass(GetParam()), parts = session_with_pass(GetParam());
    parts.limit_tiles({384, 384 * 384});
    for (const Encoding encoding : {Encoding::srgb8, Encoding::scene_linear}) {
        const Image at_once = whole.render({std::nullopt, std::nullopt, encoding});
        const Image in_tiles = parts.render({std::nullopt, std::nullopt, encoding});
        // One of 255 steps, or what float32 leaves of radiances up to 4: coordinates are rounded otherwise in
        // tiles.
        const double step = encoding == Encoding::srgb8 ? 1 : 1e-3;
        size_t different = 0;
        for (size_t i = 0; i < at_once.pixel_count() * 4; ++i) {
            const double a = encoding == Encoding::srgb8 ? at_once.pixels<uint8_t>()[i]
                                                         : double(at_once.pixels<float>()[i]);
            const double b = encoding == Encoding::srgb8 ? in_tiles.pixels<uint8_t>()[i]
                                                         : double(in_tiles.pixels<float>()[i]);
            different += std::abs(a - b) > step;
        }
        // Pixels of the silhouette whose centre the edge goes through, and the four lines that they make: a
        // seam of one pixel would be 500.
        EXPECT_LE(different, 100u);
    }
}

INSTANTIATE_TEST_SUITE_P(Stages, TiledPasses, testing::Values(Stage::light, Stage::overlay, Stage::picture),
                         [](const auto& info) { return stage_names()[size_t(info.param)]; });

}  // namespace
}  // namespace easypbr::app::tiled_passes_test
