// What is drawn without light covers as much of the light of others as what is lit: its opacity, its holes.
#include "shadow_test.h"

#include "easypbr/scene/mesh.h"

namespace easypbr::unlit_shadow_test {
namespace {

/// Black: without light it sends none to the floor either.
Material black() {
    Material m = matt();
    m.base_color = Vec3::Zero();
    return m;
}

Material blended() {
    Material m = black();
    m.opacity = 0.4f;
    return m;
}

/// Of one texel that is below the cutoff.
Material masked() {
    Material m = black();
    Image texel(1, 1, 4, PixelType::u8);
    texel.pixels<uint8_t>()[3] = 100;
    m.base_color_texture.image = std::make_shared<const Image>(texel);
    m.alpha_mode = AlphaMode::mask;
    return m;
}

/// One vertex in the middle of the pane that is drawn as large as it.
Mesh vertex(DrawMode mode) {
    Array3f::Dense V(1, 3), N(1, 3);
    V << 0, 0, 4;
    N << 0, 0, 1;
    Mesh mesh{Array3f(V), {}};
    mesh.set_N(Array3f(N));
    mesh.set_material(blended());
    Style style;
    style.mode = mode;
    style.point_size = 2;
    style.point_size_unit = SizeUnit::world;
    style.voxel_size = 2;
    mesh.set_style(style);
    return mesh;
}

/// The part of the light that reaches the middle of a caster's shadow on a floor, seen from below the caster.
double part_of_light(Mesh caster, bool lit, bool paths) {
    Style style = caster.style();
    style.lit = lit;
    caster.set_style(style);
    Scene scene;
    scene.show(rectangle(-9, -9, 9, 9, 0), "floor");
    scene.show(caster, "caster");
    scene.set_light("lamp", directional(Vec3(1, 0, -1)));
    app::Session session = shadow_session(scene, ShadowMode::hard, 16);
    Settings& s = session.settings();
    s.path.enabled = paths;
    s.path.bounces = 0;
    s.path.denoise = Denoising::off;
    s.camera.up = "+y";
    s.camera.position = Vec3d(4, 0, 2);
    s.camera.target = Vec3d(4, 0, 0);
    s.camera.fov_y_deg = 10;
    const auto sum = [&](bool shadows) {
        s.shadows.enabled = shadows;
        const Image image = render_linear(session, 64);
        double all = 0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) all += double(image.at<float>(x, y)[1]);
        return all;
    };
    const double with = sum(true);
    return with / sum(false);
}

TEST(UnlitShadows, AreThoseOfTheOpacity) {
    struct Case {
        const char* name;
        Mesh caster;
        double light;
    };
    const Case cases[] = {{"pane", rectangle(-1, -1, 1, 1, 4, blended()), 0.6},
                          {"hole", rectangle(-1, -1, 1, 1, 4, masked()), 1},
                          {"opaque", rectangle(-1, -1, 1, 1, 4, black()), 0},
                          {"points", vertex(DrawMode::points), 0.6},
                          {"voxels", vertex(DrawMode::voxels), 0.36}};  // in and out
    // Paths are stopped by chance: of 16 x 16 pixels of 64 samples each, five standard deviations.
    for (const auto& [name, caster, light] : cases)
        for (const bool lit : {true, false}) {
            EXPECT_NEAR(part_of_light(caster, lit, true), light, 5 * 0.5 / std::sqrt(16 * 16 * 64))
                << name << lit;
            EXPECT_NEAR(part_of_light(caster, lit, false), light, 5e-3) << name << lit;
        }
}

}  // namespace
}  // namespace easypbr::unlit_shadow_test
