// Paths at surfaces with glTF's material extensions: closed forms, and the raster frame under a lamp.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "extension_sphere.h"

#include "easypbr/scene/material_table.h"

namespace easypbr::path_extensions_test {
namespace {

app::Session traced(app::Session session) {
    Settings& s = session.settings();
    s.path.enabled = true;
    s.path.clamp = 0;
    s.path.bounces = 64;
    return session;
}

Material white(const std::function<void(Material&)>& change) {
    return sphere::with([&](Material& m) {
        m.metallic = 0;
        change(m);
    });
}

/// Mean radiance of a sphere in an environment of radiance 1.
double furnace(const Material& material, bool multiple_scattering = true) {
    Scene scene;
    scene.set_environment(constant_environment(1));
    app::Session session = traced(sphere::session_of(material, scene));
    session.settings().environment.enabled = true;
    session.settings().shading.multiple_scattering = multiple_scattering;
    double sum = 0;
    const auto points = sphere::points_of(render_linear(session, 64), session.camera(), 0.2);
    for (const sphere::Point& point : points) sum += point.radiance.mean();
    return sum / double(points.size());
}

// What reflects or transmits all of an even environment disappears in it. 0.005: the table of albedos.
TEST(PathExtensions, WhiteFurnace) {
    const std::pair<const char*, Material> materials[] = {
        {"clearcoat", white([](Material& m) { m.clearcoat = 1; })},
        {"rough clearcoat",
         white([](Material& m) { m.clearcoat = m.clearcoat_roughness = 0.7f, m.roughness = 0.9f; })},
        {"sheen", white([](Material& m) { m.sheen_color = Vec3::Ones(), m.sheen_roughness = 0.5f; })},
        {"film on a metal", white([](Material& m) { m.iridescence = m.metallic = 1; })},
        {"thin", white([](Material& m) { m.transmission = 1, m.roughness = 0; })},
        {"rough thin", white([](Material& m) { m.transmission = 1, m.roughness = 0.6f; })},
        {"half transmissive", white([](Material& m) { m.transmission = 0.5f; })},
        {"volume", white([](Material& m) { m.transmission = m.thickness = 1, m.roughness = 0; })},
        {"rough volume", white([](Material& m) { m.transmission = m.thickness = 1; })},
        {"dense volume", white([](Material& m) { m.transmission = m.thickness = 1, m.ior = 2.4f; })},
        {"coated volume", white([](Material& m) { m.transmission = m.thickness = m.clearcoat = 1; })}};
    for (const auto& [name, material] : materials) EXPECT_NEAR(furnace(material), 1, 0.005) << name;
}

// Films on dielectrics: what facets reflect is what the base loses, at grazing angles, too. 0.01: the mean
// angle of facets stands for all of them.
TEST(PathExtensions, WhiteFurnaceOfFilms) {
    for (const float roughness : {0.1f, 0.3f, 0.5f, 0.8f})
        for (const float thickness : {100.0f, 400.0f})
            EXPECT_NEAR(furnace(white([&](Material& m) {
                            m.iridescence = 1;
                            m.roughness = roughness;
                            m.iridescence_thickness_min = m.iridescence_thickness_max = thickness;
                        })),
                        1, 0.01)
                << roughness << ", " << thickness << " nm";
}

// The albedo of an anisotropic lobe is taken for that of an isotropic one, which is off by up to 0.06.
TEST(PathExtensions, WhiteFurnaceOfAnisotropy) {
    const Material brushed = white([](Material& m) { m.anisotropy = 0.6f, m.metallic = 1; });
    EXPECT_NEAR(furnace(brushed), 1, 0.06);
}

// Without multiple scattering facets of rough glass lose what they hide, as those of other renderers do: the
// means are those of Mitsuba 3.7 (roughdielectric, GGX, alpha = roughness^2, index 1.5) over the same part of
// the sphere. 0.006: Schlick's reflectance in place of Fresnel's, 0.003, and the noise of 64 samples, 0.002.
TEST(PathExtensions, SingleScatteringOfRoughVolumes) {
    const std::pair<float, double> means[] = {
        {0.3f, 0.9516}, {0.45f, 0.8343}, {0.7f, 0.5595}, {1.0f, 0.3018}};
    for (const auto& [roughness, mean] : means) {
        const Material glass =
            white([&](Material& m) { m.transmission = m.thickness = 1, m.roughness = roughness; });
        EXPECT_NEAR(furnace(glass, false), mean, 0.006) << roughness;
    }
}

// A thin surface that scatters once: E + S (1 - E), where E is the part of light that facets reflect once if
// they reflect all, and S the same with Fresnel's part of index 1.5, which is taken out of what passes:
// integrals over the hemisphere of GGX and Smith's joint masking. 0.003: the tables of both, and the noise.
TEST(PathExtensions, SingleScatteringOfRoughThinSurfaces) {
    struct Case {
        float roughness;
        double angle_deg, mean;
    };
    for (const Case& c : {Case{0.3f, 0, 0.9909}, Case{0.3f, 70, 0.9613}, Case{0.6f, 0, 0.8303},
                          Case{0.6f, 70, 0.8032}, Case{1, 0, 0.3154}, Case{1, 70, 0.5455}}) {
        Scene scene;
        scene.set_environment(constant_environment(1));
        scene.show(
            facing_square(1, white([&](Material& m) { m.transmission = 1, m.roughness = c.roughness; })),
            "square");
        app::Session session = traced(plain_session(scene, 16));
        session.settings().environment.enabled = true;
        session.settings().shading.multiple_scattering = false;
        const double angle = radians(c.angle_deg);
        look_from(session, 20 * Vec3d(0, std::sin(angle), std::cos(angle)), 1);
        const Image image = render_linear(session, 256);
        double mean = 0;
        for (const float value : image.pixels<float>()) mean += value / double(image.pixels<float>().size());
        // One of the four channels is the coverage.
        EXPECT_NEAR((4 * mean - 1) / 3, c.mean, 0.003) << c.roughness << ", " << c.angle_deg << " degrees";
    }
}

/// Radiance 2 on one side, above or below.
Environment half_environment(bool above) {
    constexpr int height = 16;
    Image image(2, height, 3, PixelType::f32);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2; ++x)
            std::fill_n(image.at<float>(x, y), 3, (y < height / 2) == above ? 2.0f : 0.0f);
    return Environment(image);
}

// Of two halves of an even environment one is bright enough to be looked for, and found by chance as well:
// what both leave adds up to all. 0.008: the table of albedos, 0.005, and the noise of 256 samples.
TEST(PathExtensions, WhiteFurnaceOfTwoHalves) {
    const std::pair<const char*, Material> materials[] = {
        {"thin", white([](Material& m) { m.transmission = 1, m.roughness = 0.6f; })},
        {"rough volume", white([](Material& m) { m.transmission = m.thickness = 1; })},
        {"rougher volume", white([](Material& m) { m.transmission = m.thickness = 1, m.roughness = 0.8f; })},
        {"dense volume", white([](Material& m) { m.transmission = m.thickness = 1, m.ior = 2.4f; })},
        {"coated volume", white([](Material& m) { m.transmission = m.thickness = m.clearcoat = 1; })}};
    for (const auto& [name, material] : materials) {
        double sum = 0;
        for (const bool above : {false, true}) {
            Scene scene;
            scene.set_environment(half_environment(above));
            app::Session session = traced(sphere::session_of(material, scene));
            session.settings().environment.enabled = true;
            const auto points = sphere::points_of(render_linear(session, 256), session.camera(), 0.2);
            double half = 0;
            for (const sphere::Point& point : points) half += point.radiance.mean() / double(points.size());
            EXPECT_GT(half, 0.3) << name << " " << above;
            sum += half / 2;
        }
        EXPECT_NEAR(sum, 1, 0.008) << name;
    }
}

// An area light and a mesh that emits as much light a ball alike, through its rough surface. 0.02: the noise
// of 256 samples, 0.01, and what the mesh keeps from leaving.
TEST(PathExtensions, RoughVolumesSpreadAreaLights) {
    const Material frosted = white([](Material& m) { m.transmission = m.thickness = 1, m.roughness = 0.7f; });
    const auto seen = [&](const std::function<void(Scene&)>& add_light) {
        Scene scene;
        add_light(scene);
        app::Session session = traced(sphere::session_of(frosted, scene));
        session.settings().shadows.enabled = true;
        double sum = 0;
        for (const sphere::Point& point :
             sphere::points_of(render_linear(session, 256), session.camera(), 0.2))
            sum += point.radiance.mean();
        return sum;
    };
    const double of_light = seen([](Scene& scene) {
        Light lamp;
        lamp.type = LightType::rectangle;
        lamp.position = Vec3d(0, 2, -2);
        lamp.direction = Vec3(0, -1, 1);
        lamp.width_axis = Vec3(1, 0, 0);
        lamp.size = Vec2(2, 2);
        lamp.intensity = 5;
        scene.set_light("lamp", lamp);
    });
    const double of_mesh = seen([](Scene& scene) {
        Mesh square = facing_square();
        square.set_material(sphere::with([](Material& m) {
            m.base_color = Vec3::Zero();
            m.specular = 0;
            m.roughness = 1;
            m.emissive = Vec3::Constant(5);
        }));
        Eigen::Affine3d pose = Eigen::Affine3d::Identity();
        pose.translate(Vec3d(0, 2, -2)).rotate(Eigen::AngleAxisd(pi / 4, Vec3d::UnitX()));
        square.set_T_world_mesh(pose);
        scene.show(square, "lamp");
    });
    EXPECT_GT(of_light, 0);
    EXPECT_NEAR(of_mesh / of_light, 1, 0.02);
}

/// A sphere under one directional light, by paths and rasterised.
void expect_same_light(const std::string& name, const Material& material) {
    Scene scene;
    Light sun;
    sun.type = LightType::directional;
    sun.direction = -sphere::light_direction.cast<float>();
    scene.set_light("sun", sun);
    app::Session session = sphere::session_of(material, scene);
    // Two frames, so that textures are read alike.
    const auto raster = sphere::points_of(render_linear(session, 2), session.camera(), 0.25);
    session = traced(std::move(session));
    const auto paths = sphere::points_of(render_linear(session, 2), session.camera(), 0.25);
    double sum = 0, different = 0;
    for (size_t i = 0; i < raster.size(); ++i) {
        sum += raster[i].radiance.sum();
        different += (raster[i].radiance - paths[i].radiance).cwiseAbs().sum();
    }
    EXPECT_GT(sum, 0) << name;
    // The G-buffer rounds roughness, strengths and directions to 8 bits and less: 2 % of the light.
    EXPECT_LT(different, 0.02 * sum) << name;
}

TEST(PathExtensions, LampsAreThoseOfTheRaster) {
    const auto gold = [](const std::function<void(Material&)>& change) {
        return white([&](Material& m) {
            m.base_color = Vec3(0.8f, 0.5f, 0.2f);
            change(m);
        });
    };
    expect_same_light("clearcoat",
                      gold([](Material& m) { m.clearcoat = 0.8f, m.clearcoat_roughness = 0.3f; }));
    expect_same_light("specular", gold([](Material& m) {
                          m.specular = 0.7f, m.specular_color = Vec3(1, 0.4f, 0.1f), m.ior = 1.8f;
                      }));
    expect_same_light("film",
                      gold([](Material& m) { m.iridescence = 0.9f, m.iridescence_thickness_max = 420; }));
    expect_same_light("anisotropy", gold([](Material& m) {
                          m.anisotropy = 0.7f, m.anisotropy_rotation_deg = 30, m.metallic = 1;
                      }));
    // Paths keep the energy below a sheen in another way: here there is nothing below.
    expect_same_light("sheen", gold([](Material& m) {
                          m.base_color = Vec3::Zero(), m.specular = 0, m.sheen_roughness = 0.4f;
                          m.sheen_color = Vec3(0.9f, 0.7f, 0.5f);
                      }));
}

/// Texels that differ from one to the next; normals that lean by some 10 degrees.
std::shared_ptr<Image> patterned(bool of_normals) {
    auto image = std::make_shared<Image>(8, 8, 4, PixelType::u8);
    uint32_t state = 1;
    for (uint8_t& value : image->pixels<uint8_t>()) {
        state = state * 1664525u + 1013904223u;
        const uint32_t number = state >> 24;
        value = uint8_t(of_normals ? 112 + number / 8 : 64 + number * 3 / 4);
    }
    for (int i = 0; of_normals && i < 64; ++i) image->at<uint8_t>(i % 8, i / 8)[2] = 255;
    return image;
}

TEST(PathExtensions, TexturesAreThoseOfTheRaster) {
    for (const MaterialTexture& use : material_textures()) {
        const std::string name = use.name;
        if (name == "occlusion" || name == "emissive" || name == "opacity" || name == "transmission" ||
            name == "thickness" || name.starts_with("sheen"))
            continue;
        Material m = white([](Material& all) {
            all.base_color = Vec3(0.6f, 0.4f, 0.2f);
            all.metallic = 0.4f;
            all.clearcoat = 0.6f;
            all.clearcoat_roughness = 0.5f;
            all.specular = all.iridescence = all.anisotropy = 0.6f;
        });
        (m.*use.texture).image = patterned(use.use == TexelUse::vector);
        (m.*use.texture).channel = use.use == TexelUse::color ? 0 : 2;
        expect_same_light(name, m);
    }
}

/// What a slab of glass with two parallel faces shows at a right angle, of an environment of radiance 1:
/// `left` is what one way through leaves.
double slab_radiance(double left) {
    const double r = 0.04, t = 1 - r;
    const double reflected = r + t * t * r * left * left / (1 - r * r * left * left);
    const double transmitted = t * t * left / (1 - r * r * left * left);
    return reflected + transmitted;
}

// 0.004: the table of albedos at a right angle.
TEST(PathExtensions, SlabAbsorbs) {
    Mesh slab = make_box(Vec3(20, 20, 0.5));
    slab.set_material(white([](Material& m) {
        m.transmission = 1;
        m.roughness = 0;
        m.thickness = 0.1f;  // The way through is longer.
        m.attenuation_distance = 0.25f;
        m.attenuation_color = Vec3(0.8f, 0.5f, 0.2f);
    }));
    Scene scene;
    scene.show(slab, "slab");
    scene.set_environment(constant_environment(1));
    app::Session session = traced(plain_session(scene, 8));
    session.settings().environment.enabled = true;
    look_from(session, Vec3d(0, 0, 30), 1);
    const Vec3 seen(render_linear(session, 256).at<float>(4, 4));
    for (int c = 0; c < 3; ++c) {
        const double left = std::pow(double(Vec3(0.8f, 0.5f, 0.2f)[c]), 2);
        EXPECT_NEAR(seen[c], slab_radiance(left), 0.004) << c;
    }
}

// Of balls within each other, each a quarter smaller, which do not bend light: each shell absorbs its own
// part of the way, and the innermost ball that of its diameter. 0.004: the noise of 20736 paths, 4
// deviations.
TEST(PathExtensions, NestedVolumesAbsorbInTurn) {
    Scene scene;
    const Vec3 colors[] = {Vec3(0.9f, 0.8f, 1), Vec3(0.6f, 1, 0.9f), Vec3(1, 0.7f, 0.8f),
                           Vec3(0.8f, 0.9f, 0.6f)};
    Vec3 left = Vec3::Ones();
    for (int i = 0; i < 4; ++i) {
        Mesh ball = make_sphere(1 - 0.25 * i, 128);
        ball.set_material(white([&](Material& m) {
            m.transmission = m.thickness = m.ior = 1;
            m.specular = 0;
            m.roughness = 0;
            m.attenuation_distance = 0.5f;
            m.attenuation_color = colors[i];
        }));
        scene.show(ball, "ball " + std::to_string(i));
        left.array() *= colors[i].array();  // twice a quarter of the way, or the diameter of 1/2
    }
    scene.set_environment(constant_environment(1));
    app::Session session = traced(plain_session(scene, 9));
    session.settings().environment.enabled = true;
    look_from(session, Vec3d(0, 0, 2), 1);
    const Image image = render_linear(session, 256);
    Vec3 seen = Vec3::Zero();
    for (int i = 0; i < 81; ++i) seen += Vec3(image.at<float>(i % 9, i / 9)) / 81;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], left[c], 0.004) << c;
}

/// Radiance that grows with the height of the direction.
Environment tall_environment() {
    constexpr int height = 1024;
    Image image(2, height, 3, PixelType::f32);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2; ++x)
            for (int c = 0; c < 3; ++c)
                image.at<float>(x, y)[c] = float(1 + std::sin(pi / 2 - (y + 0.5) / height * pi));
    return Environment(image);
}

/// What a ball of glass shows of that environment at a height of its middle, from the side: the reflection,
/// and all that has been reflected within k times (the geometry of rainbows). `f0` is the reflectance at a
/// right angle.
double ball_radiance(double height, double ior, double f0) {
    const double incident = std::asin(height), refracted = std::asin(height / ior);
    const double r = f0 + (1 - f0) * std::pow(1 - std::cos(incident), 5);
    double sum = r * (1 + std::sin(2 * incident)), part = (1 - r) * (1 - r);
    for (int k = 0; k < 20; ++k, part *= r)
        sum += part * (1 - std::sin(2 * (incident - refracted) + k * (pi - 2 * refracted)));
    return sum;
}

/// A smooth solid ball of glass, seen in parallel.
app::Session session_of_glass_ball(const std::function<void(Material&)>& change) {
    Mesh ball = make_sphere(1, 512);
    ball.set_material(white([&](Material& m) {
        m.transmission = m.thickness = 1;
        m.roughness = 0;
        change(m);
    }));
    Scene scene;
    scene.show(ball, "ball");
    scene.set_environment(tall_environment());
    app::Session session = traced(plain_session(scene, 33));
    session.settings().environment.enabled = true;
    session.settings().camera.projection = Projection::orthographic;
    look_from(session, Vec3d(0, 0, 4));
    return session;
}

// 0.02 of up to 2: facets of the sphere, noise of 1024 samples, and the width of a pixel.
TEST(PathExtensions, BallRefracts) {
    for (const float ior : {1.1f, 1.5f, 2.0f}) {
        app::Session session = session_of_glass_ball([&](Material& m) { m.ior = ior; });
        const Image image = render_linear(session, 1024);
        const Camera camera = session.camera();
        const double half = 1 / camera.projection_matrix(1)(1, 1);
        int seen = 0;
        for (int y = 0; y < 33; ++y) {
            const double height = (1 - (y + 0.5) / 16.5) * half;
            if (std::abs(height) > 0.85) continue;
            const double f0 = std::pow((ior - 1) / (ior + 1), 2);
            EXPECT_NEAR(image.at<float>(16, y)[0], ball_radiance(height, ior, f0), 0.02)
                << ior << " " << height;
            ++seen;
        }
        EXPECT_GT(seen, 10);
    }
}

// Each colour has an index of its own, (n - 1) / V from red to blue. KHR_materials_dispersion leaves the
// reflectance alone. A path through the ball has three times the light of one colour at random, up to 2 of
// radiance: one sample's deviation is below 3, that of 1024 below 0.1 where they are not stratified, and that
// of the mean of 75 values below 0.012.
TEST(PathExtensions, BallDisperses) {
    app::Session session = session_of_glass_ball([](Material& m) { m.dispersion = 30; });
    const Image image = render_linear(session, 1024);
    const double half = 1 / session.camera().projection_matrix(1)(1, 1);
    double sum = 0, apart = 0;
    int count = 0;
    for (int y = 0; y < 33; ++y) {
        const double height = (1 - (y + 0.5) / 16.5) * half;
        if (std::abs(height) > 0.85) continue;
        const float* seen = image.at<float>(16, y);
        for (int c = 0; c < 3; ++c, ++count) {
            const double expected = ball_radiance(height, 1.5 + (c - 1) * 0.5 * 1.5 / 2, 0.04);
            EXPECT_NEAR(seen[c], expected, 0.1) << c << " " << height;
            sum += seen[c] - expected;
        }
        apart = std::max(apart,
                         std::abs(ball_radiance(height, 1.125, 0.04) - ball_radiance(height, 1.875, 0.04)));
    }
    EXPECT_NEAR(sum / count, 0, 0.012);
    EXPECT_GT(apart, 0.3);
}

// A thin pane passes what is behind it straight: a bright square beside the straight way is not seen.
TEST(PathExtensions, PanesPassStraight) {
    Material glass =
        white([](Material& m) { m.transmission = 1, m.roughness = 0, m.base_color = Vec3::Constant(0.5f); });
    Material bright;
    bright.base_color = Vec3::Zero();
    bright.emissive = Vec3::Constant(2);
    Mesh behind = facing_square(0.5f, bright);
    behind.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -1)));
    Scene scene;
    scene.show(facing_square(3, glass), "pane");
    scene.show(behind, "square");
    app::Session session = traced(plain_session(scene, 32));
    session.settings().camera.projection = Projection::orthographic;
    look_from(session, Vec3d(0, 0, 4));
    const Image image = render_linear(session, 64);
    const double half = 1 / session.camera().projection_matrix(1)(1, 1);
    const int inside = int(16 + 0.3 / half * 16), outside = int(16 + 0.8 / half * 16);
    EXPECT_NEAR(image.at<float>(inside, 16)[0], 2 * 0.5 * 0.96, 0.005);
    EXPECT_NEAR(image.at<float>(outside, 16)[0], 0, 1e-5);
}

// The light of a lamp goes straight through a pane, which takes its part of it.
TEST(PathExtensions, PanesTintLamps) {
    const auto floor_under = [](bool with_pane) {
        Material pane = white([](Material& m) {
            m.transmission = 0.9f, m.roughness = 0;
            m.base_color = Vec3(1, 0.5f, 0.25f);
        });
        Material matt;
        matt.base_color = Vec3::Constant(0.5f);
        matt.metallic = 0;
        matt.roughness = 1;
        Mesh above = facing_square(1, pane);
        above.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1)));
        Scene scene;
        scene.show(facing_square(1, matt), "floor");
        if (with_pane) scene.show(above, "pane");
        Light sun;
        sun.type = LightType::directional;
        sun.direction = Vec3(0, 0, -1);
        scene.set_light("sun", sun);
        app::Session session = traced(plain_session(scene, 16));
        session.settings().shadows.enabled = true;
        session.settings().path.bounces = 0;
        look_from(session, Vec3d(0, -4, 1), 20);
        return Vec3(render_linear(session, 16).at<float>(8, 8));
    };
    const Vec3 open = floor_under(false), tinted = floor_under(true);
    const Vec3 expected = Vec3(1, 0.5f, 0.25f) * (0.9f * 0.96f);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(tinted[c] / open[c], expected[c], 0.002);
}

// Light that surfaces send goes under their varnish. Straight on it keeps what a facet does not reflect.
TEST(PathExtensions, VarnishDimsWhatGlowsBelow) {
    Scene scene;
    scene.show(facing_square(1, white([](Material& m) {
                                 m.base_color = Vec3::Zero(), m.clearcoat = 1, m.emissive = Vec3::Ones();
                             })),
               "square");
    app::Session session = traced(plain_session(scene, 8));
    look_from(session, Vec3d(0, 0, 20), 2);
    EXPECT_NEAR(render_linear(session, 4).at<float>(4, 4)[0], 0.96, 0.003);
}

}  // namespace
}  // namespace easypbr::path_extensions_test
