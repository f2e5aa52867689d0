// Shadows of what lets light through: darkness and colour against the closed form, the product of what is
// crossed.
#include "shadow_test.h"

#include "easypbr/scene/settings.h"

namespace easypbr::tinted_shadow_test {
namespace {

Material blended(float opacity) {
    Material m = matt();
    m.opacity = opacity;
    return m;
}

Material thin_glass(const Vec3& color) {
    Material m;
    m.transmission = 1;
    m.base_color = color;
    m.roughness = 0;
    return m;
}

/// A square over the middle of the floor.
Mesh pane(const Material& m, float z = 0.5f) {
    return rectangle(-0.5f, -0.5f, 0.5f, 0.5f, z, m);
}

/// A floor under casters, lit from straight above and seen from below them.
app::Session under(const std::vector<Mesh>& casters, ShadowMode mode, const Light& light) {
    Scene scene;
    scene.show(rectangle(-1, -1, 1, 1, 0), "floor");
    for (size_t i = 0; i < casters.size(); ++i) scene.show(casters[i], "caster" + std::to_string(i));
    scene.set_light("lamp", light);
    app::Session session = shadow_session(scene, mode, 96);
    look_from(session, Vec3d(0, -4, 0.8), 25);
    return session;
}

/// Part of each channel of the light, mean over the floor of |y| < 0.3 and x0 < x < x1; `spread` is how far
/// the pixels' green parts lie from each other.
struct Lit {
    Vec3d mean{0, 0, 0};
    double x = 0;  ///< of the pixels, mean
    double spread = 0;
};

Lit lit_floor(app::Session& session, int samples, double x0 = -0.35, double x1 = 0.35, double z = 0) {
    session.settings().shadows.enabled = false;
    const Image without = render_linear(session, samples);
    session.settings().shadows.enabled = true;
    const Image with = render_linear(session, samples);
    const LitParts place{{}, session.render_layers({"depth"}).at("depth"), session.camera()};
    Lit lit;
    int count = 0;
    double least = 1, most = 0;
    for (int y = 0; y < with.height(); ++y)
        for (int x = 0; x < with.width(); ++x) {
            const Vec3d p = place.position(x, y);
            if (!(place.depth.at<float>(x, y)[0] > 0) || std::abs(p.z() - z) > 1e-3 ||
                std::abs(p.y()) > 0.3 || p.x() < x0 || p.x() > x1)
                continue;
            for (int c = 0; c < 3; ++c)
                lit.mean[c] += double(with.at<float>(x, y)[c] / without.at<float>(x, y)[c]);
            const double green = double(with.at<float>(x, y)[1] / without.at<float>(x, y)[1]);
            least = std::min(least, green);
            most = std::max(most, green);
            lit.x += p.x();
            ++count;
        }
    EXPECT_GT(count, 30);
    lit.mean /= count;
    lit.x /= count;
    lit.spread = most - least;
    return lit;
}

const Light sun = directional(Vec3(0, 0, -1));
constexpr ShadowMode modes[] = {ShadowMode::hard, ShadowMode::pcf, ShadowMode::soft};
/// Sums of logarithms in float32.
constexpr double rounding = 1e-4;

// Without noise, in a single frame as in a still.
TEST(TintedShadow, OfAnOpacity) {
    for (const ShadowMode mode : modes)
        for (const auto& [opacity, samples] : {std::pair(0.2f, 1), std::pair(0.7f, 1), std::pair(0.7f, 64)}) {
            app::Session session = under({pane(blended(opacity))}, mode, sun);
            const Lit lit = lit_floor(session, samples);
            EXPECT_NEAR(lit.mean.y(), 1 - opacity, rounding) << int(mode) << " " << samples;
            EXPECT_LE(lit.spread, 2 * rounding) << int(mode) << " " << samples;
        }
}

/// Square points over the middle of the floor, each as wide as `widths` of their distances.
Mesh wall_of_points(float opacity, bool by_color, int widths) {
    constexpr int side = 40;
    constexpr float spacing = 1.0f / side;
    MeshData data;
    Array3f::Dense V(side * side, 3);
    for (int i = 0; i < side * side; ++i)
        V.row(i) << spacing * (float(i % side) + 0.5f) - 0.5f, spacing * (float(i / side) + 0.5f) - 0.5f,
            0.5f;
    data.V = Array3f(V);
    if (by_color) data.C = ArrayXf(ArrayXf::Dense(ArrayXf::Dense::Constant(side * side, 4, opacity)));
    data.materials = {by_color ? matt() : blended(opacity)};
    data.style.mode = DrawMode::points;
    data.style.point_shape = PointShape::square;
    data.style.point_size = spacing * float(widths);
    data.style.point_size_unit = SizeUnit::world;
    return Mesh(data);
}

// Light crosses as many points as their squares lie over each other. A hundredth: some texels' centres lie on
// the edges of two squares, and vertices' opacities have 8 bits.
TEST(TintedShadow, OfPoints) {
    for (const ShadowMode mode : modes)
        for (const bool by_color : {false, true})
            for (const int widths : {1, 2}) {
                app::Session session = under({wall_of_points(0.4f, by_color, widths)}, mode, sun);
                // The map shows all of the floor: the narrow squares have one to four texels.
                session.scene().show(rectangle(-0.1f, -0.1f, 0.1f, 0.1f, -0.1f), "below");
                session.settings().shadows.resolution = 128;
                const Lit lit = lit_floor(session, 1);
                EXPECT_NEAR(lit.mean.y(), std::pow(0.6, widths * widths), 0.01)
                    << int(mode) << " " << by_color << " " << widths;
            }
}

// Two flat surfels over the middle of the floor: light crosses both.
TEST(TintedShadow, OfSurfels) {
    for (const ShadowMode mode : modes)
        for (const int count : {1, 2}) {
            MeshData data;
            Array3f::Dense V(count, 3), N(count, 3), T(count, 3);
            for (int i = 0; i < count; ++i) {
                V.row(i) << 0, 0, 0.5f + 0.2f * float(i);
                N.row(i) << 0, 0, 1;
                T.row(i) << 0.8f, 0, 0;
            }
            data.V = Array3f(V);
            data.N = Array3f(N);
            data.T = Array3f(T);
            data.materials = {blended(0.4f)};
            data.style.mode = DrawMode::surfels;
            app::Session session = under({Mesh(data)}, mode, sun);
            EXPECT_NEAR(lit_floor(session, 1).mean.y(), std::pow(0.6, count), rounding) << int(mode) << count;
        }
}

// Points that an alpha test leaves out cast nothing, those that it keeps all of their shadow.
TEST(TintedShadow, OfPointsWithAMask) {
    for (const float cutoff : {0.3f, 0.5f}) {
        Mesh wall = wall_of_points(0.4f, true, 1);
        Material masked = matt();
        masked.alpha_mode = AlphaMode::mask;
        masked.alpha_cutoff = cutoff;
        wall.set_material(masked);
        app::Session session = under({wall}, ShadowMode::hard, sun);
        EXPECT_NEAR(lit_floor(session, 1).mean.y(), cutoff < 0.4f ? 0 : 1, 0.01) << cutoff;
    }
}

// What thin glass does not reflect (F0 is 0.04) has its colour; under every kind of projection.
TEST(TintedShadow, OfColouredGlass) {
    const Vec3 color(0.9f, 0.5f, 0.1f);
    // A lamp above all is a perspective map, one between the casters a cube.
    for (const Light& light : {sun, point(Vec3(0, 0, 5)), point(Vec3(0, 0, 0.95f))}) {
        const bool between = light.type == LightType::point && light.position.z() < 1;
        const Mesh glass = pane(thin_glass(color)), above = pane(matt(), 1.2f);
        app::Session session = between ? under({glass, above}, ShadowMode::soft, light)
                                       : under({glass}, ShadowMode::soft, light);
        const Lit lit = lit_floor(session, 4);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(lit.mean[c], 0.96 * double(color[c]), 2 * rounding) << c;
    }
}

// Large meshes are rasterised natively, and of them the opaque parts alone: the glass tints all the same.
TEST(TintedShadow, OfALargeMeshWithAnOpaquePart) {
    const Vec3 color(0.9f, 0.5f, 0.1f);
    constexpr int n = 60;  // 7200 faces
    Array3f::Dense V((n + 1) * (n + 1), 3);
    Array3i::Dense F(2 * n * n, 3);
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) V.row(i * (n + 1) + j) << float(i) / n - 0.5f, float(j) / n - 0.5f, 0.5f;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * (n + 1) + j, b = a + n + 1;
            F.row(2 * (i * n + j)) << a, b, b + 1;
            F.row(2 * (i * n + j) + 1) << a, b + 1, a + 1;
        }
    MeshData data;
    data.V = Array3f(V);
    data.F = Array3i(F);
    data.materials = {thin_glass(color), matt()};
    data.parts = {{"glass", 0, n * n, 0}, {"matt", n * n, n * n, 1}};
    app::Session session = under({Mesh(data)}, ShadowMode::hard, sun);
    const Lit glass = lit_floor(session, 1, -0.35, -0.1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(glass.mean[c], 0.96 * double(color[c]), 2 * rounding) << c;
    EXPECT_NEAR(lit_floor(session, 1, 0.1, 0.35).mean.y(), 0, rounding);
}

// Behind two, the product; between them, the first alone. The two are of one mesh.
TEST(TintedShadow, MultipliesAlongTheWay) {
    for (const ShadowMode mode : modes) {
        const Mesh shelf = rectangle(0, -0.5f, 0.5f, 0.5f, 0.5f);
        app::Session session =
            under({pane(blended(0.4f), 1), shelf,
                   rectangle(-0.5f, -0.5f, 0.5f, 0.5f, 0.25f, thin_glass(Vec3(1, 0.5f, 0.25f)))},
                  mode, sun);
        const Vec3d behind = lit_floor(session, 1, -0.35, -0.1).mean;
        EXPECT_NEAR(behind.y(), 0.6 * 0.48, rounding);
        EXPECT_NEAR(behind.z(), 0.6 * 0.24, rounding);
        const Vec3d between = lit_floor(session, 1, 0.1, 0.4, 0.5).mean;
        EXPECT_NEAR(between.y(), 0.6, rounding);
        EXPECT_NEAR(between.z(), 0.6, rounding);
        EXPECT_EQ(lit_floor(session, 1, 0.1, 0.35).mean.y(), 0) << "under the shelf";
    }
}

TEST(TintedShadow, OfVerticesAndTextures) {
    Mesh mesh = pane(matt());
    ArrayXf::Dense C(4, 4);
    C << 1, 1, 1, 0, 1, 1, 1, 0.8f, 1, 1, 1, 0.8f, 1, 1, 1, 0;
    mesh.set_C(ArrayXf(C));
    app::Session session = under({mesh}, ShadowMode::pcf, sun);
    // Alpha 0.8 (x + 0.5); its mean over the range is the one in the middle. Colours have 8 bits.
    EXPECT_NEAR(lit_floor(session, 1, -0.3, 0.3).mean.y(), 1 - 0.4, 0.01);
    EXPECT_NEAR(lit_floor(session, 1, 0.2, 0.4).mean.y(), 1 - 0.64, 0.02);

    Material stained = thin_glass(Vec3(1, 1, 1));
    Image colors(2, 1, 3, PixelType::u8);
    colors.at<uint8_t>(0, 0)[0] = 255;
    colors.at<uint8_t>(1, 0)[2] = 255;
    stained.base_color_texture.image = std::make_shared<const Image>(colors);
    stained.base_color_texture.filter = Filter::nearest;
    app::Session window = under({pane(stained)}, ShadowMode::pcf, sun);
    EXPECT_TRUE(lit_floor(window, 1, -0.35, -0.1).mean.isApprox(Vec3d(0.96, 0, 0), 1e-3));
    EXPECT_TRUE(lit_floor(window, 1, 0.1, 0.35).mean.isApprox(Vec3d(0, 0, 0.96), 1e-3));
}

// A volume is crossed through two faces and counts once.
TEST(TintedShadow, OfAVolume) {
    Material m = thin_glass(Vec3(1, 0.5f, 1));
    m.thickness = 0.5f;
    m.attenuation_distance = 1;
    m.attenuation_color = Vec3(0.25f, 1, 1);
    Mesh box = make_box(Vec3(1, 1, 0.2f));
    box.set_material(m);
    box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.6)));
    app::Session session = under({box}, ShadowMode::pcf, sun);
    const Lit lit = lit_floor(session, 1);
    EXPECT_NEAR(lit.mean.x(), 0.96 * 0.5, rounding);
    EXPECT_NEAR(lit.mean.y(), 0.96 * 0.5, rounding);
    EXPECT_NEAR(lit.mean.z(), 0.96, rounding);
}

// Behind the pane's edge a part of a lamp's disc is behind the pane. Over so small a part of a penumbra,
// where the profile is all but straight, the mean is the value at the mean place.
TEST(TintedShadow, HasAPenumbra) {
    app::Session session = under({pane(blended(0.6f), 1)}, ShadowMode::soft, directional(Vec3(0, 0, -1), 8));
    const auto expected = [](double x) {
        const double u = (x - 0.5) / std::tan(radians(8));
        return 1 - 0.6 * (0.5 - (std::asin(u) + u * std::sqrt(1 - u * u)) / pi);
    };
    for (const double middle : {0.42, 0.5, 0.58}) {
        const Lit still = lit_floor(session, 64, middle - 0.05, middle + 0.05);
        EXPECT_NEAR(still.mean.y(), expected(still.x), 0.02) << middle;
        const Lit frame = lit_floor(session, 1, middle - 0.05, middle + 0.05);
        EXPECT_NEAR(frame.mean.y(), expected(frame.x), 0.05) << middle << " in a single frame";
    }
    EXPECT_NEAR(lit_floor(session, 64, 0, 0.3).mean.y(), 0.4, 0.002);
    EXPECT_NEAR(lit_floor(session, 64, 0.7, 0.9).mean.y(), 1, 0.002);
}

// A transparent thing that stands in nobody's light changes no bit of the others' shadows.
TEST(TintedShadow, LeavesOpaqueCastersAlone) {
    for (const ShadowMode mode : modes) {
        app::Session session =
            under({pane(matt()), rectangle(-1, -1, 1, 1, -1)}, mode, directional(Vec3(0.2f, 0, -1), 2));
        session.settings().shadows.enabled = true;
        session.allow_native_shading(false);  // tints are the driver's
        look_from(session, Vec3d(0, -1.5, 4));
        const Image before = render_linear(session, 3);
        session.scene().show(rectangle(-0.5f, -0.5f, 0.5f, 0.5f, -0.5f, blended(0.5f)), "below the floor");
        EXPECT_TRUE(std::ranges::equal(before.bytes(), render_linear(session, 3).bytes())) << int(mode);
    }
}

TEST(TintedShadow, MapsAreKept) {
    app::Session session = under({pane(blended(0.5f))}, ShadowMode::pcf, sun);
    session.settings().shadows.enabled = true;
    const auto drawn_by = [&](auto&& change) {
        const uint64_t before = session.shadow_maps_drawn();
        change();
        render_linear(session, 8);
        return session.shadow_maps_drawn() - before;
    };
    EXPECT_EQ(drawn_by([] {}), 1u);
    EXPECT_EQ(drawn_by([] {}), 0u);
    Mesh caster = session.scene().get("caster0");
    EXPECT_EQ(drawn_by([&] { caster.set_material(blended(0.6f)); }), 1u);
    EXPECT_EQ(drawn_by([&] { caster.set_material(thin_glass(Vec3(1, 0, 0))); }), 1u);
    EXPECT_EQ(drawn_by([&] { caster.set_material(thin_glass(Vec3(0, 1, 0))); }), 1u) << "another colour";
    EXPECT_EQ(drawn_by([&] { caster.set_material(matt()); }), 1u);
    EXPECT_EQ(drawn_by([&] { session.scene().set_light("second", point(Vec3(1, 1, 4))); }), 1u);
}

// More lights than tinted maps have room for at once.
TEST(TintedShadow, OfManyLights) {
    app::Session session = under({pane(blended(0.5f))}, ShadowMode::pcf, sun);
    for (int i = 0; i < 40; ++i) {
        Light light = sun;
        light.intensity = 0.1f;
        light.direction = Vec3(1e-4f * float(i), 0, -1);
        session.scene().set_light("sun" + std::to_string(i), light);
    }
    EXPECT_NEAR(lit_floor(session, 1).mean.y(), 0.5, rounding);
}

// The shadow on a transparent background keeps its darkness; it is grey.
TEST(TintedShadow, IsCaughtByAGround) {
    Scene scene;
    scene.show(pane(blended(0.3f), 1), "pane");
    scene.set_light("sun", sun);
    app::Session session = shadow_session(scene, ShadowMode::pcf, 96);
    session.settings().ground.mode = GroundMode::shadow;
    session.settings().ground.height = 0;
    session.settings().shadows.enabled = true;
    look_from(session, Vec3d(0, -4, 0.8), 25);
    const Image picture = render_linear(session);
    float most = 0;
    for (int y = 44; y < 54; ++y) most = std::max(most, picture.at<float>(48, y)[3]);
    EXPECT_NEAR(most, 0.3, 1e-3);
}

/// Black: without light it sends none to the floor either.
Material black() {
    Material m = matt();
    m.base_color = Vec3::Zero();
    return m;
}

Material black_pane() {
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
Mesh single_vertex(DrawMode mode) {
    Array3f::Dense V(1, 3), N(1, 3);
    V << 0, 0, 4;
    N << 0, 0, 1;
    Mesh mesh{Array3f(V), {}};
    mesh.set_N(Array3f(N));
    mesh.set_material(black_pane());
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

// What is drawn without light covers as much of the light of others as what is lit: its opacity, its holes.
TEST(TintedShadow, OfAnUnlitSurfaceIsThatOfItsOpacity) {
    struct Case {
        const char* name;
        Mesh caster;
        double light;
    };
    const Case cases[] = {{"pane", rectangle(-1, -1, 1, 1, 4, black_pane()), 0.6},
                          {"hole", rectangle(-1, -1, 1, 1, 4, masked()), 1},
                          {"opaque", rectangle(-1, -1, 1, 1, 4, black()), 0},
                          {"points", single_vertex(DrawMode::points), 0.6},
                          {"voxels", single_vertex(DrawMode::voxels), 0.36}};  // in and out
    // Paths are stopped by chance: of 16 x 16 pixels of 64 samples each, five standard deviations.
    for (const auto& [name, caster, light] : cases)
        for (const bool lit : {true, false}) {
            EXPECT_NEAR(part_of_light(caster, lit, true), light, 5 * 0.5 / std::sqrt(16 * 16 * 64))
                << name << lit;
            EXPECT_NEAR(part_of_light(caster, lit, false), light, 5e-3) << name << lit;
        }
}

}  // namespace
}  // namespace easypbr::tinted_shadow_test
