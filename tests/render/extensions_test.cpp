// glTF's material extensions: what they give back of light, against the formulas in lobe_reference.h.
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include "easypbr/core/color.h"
#include "easypbr/core/log.h"
#include "easypbr/scene/material_table.h"
#include "lobe_reference.h"
#include "render_test.h"

namespace easypbr {
namespace {

using namespace reference;

constexpr int size = 96;

Material with(const std::function<void(Material&)>& change) {
    Material m;
    m.base_color = Vec3::Ones();
    m.roughness = 0.4f;
    change(m);
    return m;
}

/// A pixel on the unit sphere, in the frame of its normal (z) and of the circle of latitude through it (x).
struct Point {
    Vec3 radiance;
    Vec3d normal, view;  ///< world
    Mat3d frame;         ///< columns: tangent, bitangent, normal

    Vec3d local(const Vec3d& world) const { return frame.transpose() * world; }
    double n_dot_v() const { return normal.dot(view); }
};

/// Pixels of a picture of the unit sphere, not at its outline, where a pixel's centre may lie on a facet's
/// back.
std::vector<Point> points_of(const Image& image, const Camera& camera, double least_n_dot_v) {
    std::vector<Point> points;
    const Mat4d p = camera.projection_matrix(1);
    for (int y = 0; y < size; y += 3)
        for (int x = 0; x < size; x += 3) {
            const double nx = (x + 0.5) / size * 2 - 1, ny = 1 - (y + 0.5) / size * 2;
            const Vec3d ray =
                (camera.T_world_cam.linear() * Vec3d(nx / p(0, 0), ny / p(1, 1), -1)).normalized();
            const Vec3d eye = camera.position();
            const double b = eye.dot(ray), c = b * b - eye.squaredNorm() + 1;
            if (c < 0) continue;
            const Vec3d n = eye + ray * (-b - std::sqrt(c));
            if (-ray.dot(n) < least_n_dot_v) continue;
            Point point{Vec3(image.at<float>(x, y)), n, -ray, Mat3d()};
            // Texture coordinates of the sphere run around +y: their tangent is the direction of growing u.
            const Vec3d tangent = Vec3d::UnitY().cross(n).normalized();
            point.frame << tangent, n.cross(tangent), n;
            points.push_back(point);
        }
    return points;
}

app::Session session_of(const Material& material, Scene& scene) {
    Mesh sphere = make_sphere(1, 256);
    sphere.set_material(material);
    scene.show(sphere, "sphere");
    app::Session session = plain_session(scene, size);
    look_from(session, Vec3d(0.5, 0.8, 4), 30);
    return session;
}

/// The sphere in an environment of radiance 1.
std::vector<Point> in_furnace(const Material& material, double least_n_dot_v = 0.2) {
    Scene scene;
    scene.set_environment(constant_environment(1));
    app::Session session = session_of(material, scene);
    session.settings().environment.enabled = true;
    const Image image = render_linear(session);
    return points_of(image, session.camera(), least_n_dot_v);
}

const Vec3d light_direction = Vec3d(0.3, 0.7, 0.6).normalized();  // towards the light

/// The sphere under one directional light of 1 lux.
std::vector<Point> under_light(const Material& material, double least_n_dot_v = 0.25) {
    Scene scene;
    Light sun;
    sun.type = LightType::directional;
    sun.direction = -light_direction.cast<float>();
    scene.set_light("sun", sun);
    app::Session session = session_of(material, scene);
    session.settings().shading.multiple_scattering = false;
    const Image image = render_linear(session);
    std::vector<Point> lit;
    for (const Point& point : points_of(image, session.camera(), least_n_dot_v))
        if (point.normal.dot(light_direction) > 0.05) lit.push_back(point);
    return lit;
}

const std::map<std::string, Material> white_materials = {
    {"clearcoat", with([](Material& m) { m.clearcoat = 1; })},
    {"rough clearcoat", with([](Material& m) { m.clearcoat = 0.6f, m.clearcoat_roughness = 0.6f; })},
    {"clearcoat on metal", with([](Material& m) { m.clearcoat = m.metallic = 1; })},
    {"sheen", with([](Material& m) { m.sheen_color = Vec3::Ones(), m.sheen_roughness = 0.4f; })},
    {"rough sheen", with([](Material& m) { m.sheen_color = Vec3::Ones(), m.sheen_roughness = 1; })},
    {"iridescence on metal", with([](Material& m) { m.iridescence = m.metallic = 1; })},
    {"iridescence", with([](Material& m) { m.iridescence = 1, m.iridescence_ior = 1.8f; })},
    {"anisotropy", with([](Material& m) { m.anisotropy = 0.8f, m.metallic = 1; })},
    {"anisotropy of a dielectric", with([](Material& m) { m.anisotropy = 1; })},
    {"index of refraction", with([](Material& m) { m.ior = 2.4f; })},
    {"no reflection", with([](Material& m) { m.specular = 0; })},
    {"all", with([](Material& m) {
         m.clearcoat = m.anisotropy = 1;
         m.iridescence = 0.4f;
         m.sheen_color = Vec3::Constant(0.6f);
         m.sheen_roughness = 0.4f;
     })}};

// A white surface gives back all it gets, neither more nor less: layers are combined by their albedos. 0.5 %,
// as for the core model: what 8 bits of the parameters and the halves of the tables leave. Iridescence may
// absorb, for its saturated colours are cut at Rec.709's borders, and what the film does not reflect goes
// into a white base; a metal has none.
TEST(Extensions, WhiteFurnace) {
    for (const auto& [name, material] : white_materials)
        for (const Point& point : in_furnace(material, 0.1))
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(point.radiance[c], 1, 0.005) << name << " at " << point.n_dot_v();
}

// The same from lights all around, one after the other, over the hemisphere: sums of BRDF times cosine. The
// layers of lights know no multiple scattering but the base's, so some is lost: never more than is there.
TEST(Extensions, LightsAllAroundAreNotExceeded) {
    for (const auto& [name, material] : white_materials) {
        Scene scene;
        constexpr int count = 900;
        for (int i = 0; i < count; ++i) {
            // Fibonacci's spiral: equal solid angles.
            const double z = 1 - 2 * (i + 0.5) / count, a = 2.39996322972865332 * i, s = std::sqrt(1 - z * z);
            Light light;
            light.type = LightType::directional;
            light.direction = Vec3(float(s * std::cos(a)), float(s * std::sin(a)), float(z));
            light.intensity = float(4 * pi / count);
            scene.set_light(std::to_string(i), light);
        }
        app::Session session = session_of(material, scene);
        const Image image = render_linear(session);
        double sum = 0;
        size_t number = 0;
        for (const Point& point : points_of(image, session.camera(), 0.3)) {
            // The spiral resolves a lobe of roughness 0.4 to 2 %, the albedo of a drawn out one is known to
            // 6 %, one of varnish without any roughness not at all.
            if (!name.starts_with("clearcoat") && name != "all") {
                ASSERT_LE(point.radiance.maxCoeff(), 1.08) << name << " at " << point.n_dot_v();
            }
            sum += point.radiance.mean();
            ++number;
        }
        EXPECT_LE(sum / double(number), 1.03) << name;
        // Iridescence loses what its base does not get back, layers what they scatter twice.
        EXPECT_GE(sum / double(number), 0.85) << name;
    }
}

// Varnish on nothing: the Fresnel reflectance where it is smooth, its lobe's albedo where it is rough.
TEST(Extensions, ClearcoatGivesBackItsFormula) {
    for (const float roughness : {0.0f, 0.6f}) {
        const Material m = with([&](Material& m) {
            m.base_color = Vec3::Zero();
            m.specular = 0;
            m.clearcoat = 0.8f;
            m.clearcoat_roughness = roughness;
        });
        Scene scene;
        scene.set_environment(constant_environment(1));
        app::Session session = session_of(m, scene);
        session.settings().environment.enabled = true;
        session.settings().shading.multiple_scattering = false;
        const Image image = render_linear(session);
        for (const Point& point : points_of(image, session.camera(), 0.2)) {
            const double alpha = roughness * roughness;
            const double expected =
                roughness == 0
                    ? schlick(point.n_dot_v(), 0.04)
                    : albedo(
                          point.n_dot_v(),
                          [&](const Vec3d& v, const Vec3d& l) {
                              return ggx(v, l, alpha, alpha) * schlick(v.dot((v + l).normalized()), 0.04);
                          },
                          100);
            ASSERT_NEAR(point.radiance.x(), 0.8 * expected, 0.003) << roughness << " at " << point.n_dot_v();
        }
    }
}

TEST(Extensions, SheenGivesBackItsAlbedo) {
    for (const float roughness : {0.4f, 0.8f}) {
        const Material m = with([&](Material& m) {
            m.base_color = Vec3::Zero();
            m.specular = 0;
            m.sheen_color = Vec3(1, 0.36f, 0.04f);  // squares of 255ths
            m.sheen_roughness = roughness;
        });
        for (const Point& point : in_furnace(m)) {
            const double expected = albedo(
                point.n_dot_v(), [&](const Vec3d& v, const Vec3d& l) { return charlie(v, l, roughness); },
                100);
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(point.radiance[c], m.sheen_color[c] * expected, 0.004) << roughness;
        }
    }
}

TEST(Extensions, DielectricReflectanceFollowsIndexAndSpecular) {
    for (const auto& [ior, specular, color] :
         {std::tuple(1.5f, 0.6f, 1.0f), std::tuple(2.0f, 1.0f, 1.0f), std::tuple(1.5f, 1.0f, 4.0f),
          std::tuple(3.0f, 0.4f, 9.0f), std::tuple(1.0f, 1.0f, 1.0f), std::tuple(0.0f, 1.0f, 0.5f)}) {
        const Material m = with([&](Material& m) {
            m.base_color = Vec3::Zero();
            m.roughness = 0;
            m.ior = ior;
            m.specular = specular;
            m.specular_color = Vec3::Constant(color);
        });
        const double from_ior = ior > 0 ? std::pow((ior - 1) / (ior + 1), 2) : 1;
        const double f0 = std::min(from_ior * color, 1.0) * specular;
        for (const Point& point : in_furnace(m))
            ASSERT_NEAR(point.radiance.x(), schlick(point.n_dot_v(), f0, specular), 0.004)
                << ior << " " << specular;
    }
}

TEST(Extensions, FilmReflectsInItsColours) {
    for (const auto& [thickness, ior, metallic] :
         {std::tuple(300.0f, 1.4f, 0.0f), std::tuple(550.0f, 1.8f, 0.0f), std::tuple(400.0f, 1.4f, 1.0f)}) {
        const Material m = with([&](Material& m) {
            m.base_color = Vec3::Constant(metallic * 0.5f);
            m.roughness = 0;
            m.metallic = metallic;
            m.iridescence = 1;
            m.iridescence_ior = ior;
            m.iridescence_thickness_max = thickness;
        });
        const double f0 = metallic > 0 ? 0.5 : 0.04;
        double spread = 0;
        for (const Point& point : in_furnace(m)) {
            const Vec3d expected = film(point.n_dot_v(), ior, thickness, f0);
            // The film's index has 8 bits: 0.002 of it turn the phase by up to 1 %.
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(point.radiance[c], expected[c], 0.008) << thickness;
            spread = std::max(spread, expected.maxCoeff() - expected.minCoeff());
        }
        EXPECT_GT(spread, 0.05);
    }
}

// A film is what physics says: reflectance at one wave length is that of two mirrors with a phase between
// them (Airy). The extension's sensitivities are a fit of the eye's; averaged over them the film must agree
// with wave by wave.
TEST(Extensions, FilmAgreesWithAirysFormula) {
    // Luminous efficiency as a Gaussian (CIE 1924, 2 degrees): 0.4202 of 1/um around 1.7953/um has the same
    // shape.
    const double film_ior = 1.33, base_ior = 1.5, f0 = 0.04;
    for (const double thickness : {150.0, 250.0, 350.0}) {
        double sum = 0, weight = 0;
        for (double nm = 380; nm <= 780; nm += 0.5) {
            const double x = (nm - 568.8) * (nm < 568.8 ? 0.0213 : 0.0247),
                         y = (nm - 530.9) * (nm < 530.9 ? 0.0613 : 0.0322);
            const double efficiency =
                0.821 * std::exp(-0.5 * x * x) + 0.286 * std::exp(-0.5 * y * y);  // Wyman et al. 2013
            const double r12 = (1 - film_ior) / (1 + film_ior),
                         r23 = (film_ior - base_ior) / (film_ior + base_ior);
            const double phase = 4 * pi * film_ior * thickness / nm;
            const double R = (r12 * r12 + r23 * r23 + 2 * r12 * r23 * std::cos(phase)) /
                             (1 + r12 * r12 * r23 * r23 + 2 * r12 * r23 * std::cos(phase));
            sum += efficiency * R;
            weight += efficiency;
        }
        const Vec3d rgb = film(1, film_ior, thickness, f0);
        const double luminance = rgb.dot(Vec3d(0.2126, 0.7152, 0.0722));
        EXPECT_NEAR(luminance, sum / weight, 0.004) << thickness;
    }
}

// Under one light, without multiple scattering: each lobe as its formula has it. 1 % of it, and 8 bits of the
// parameters.
TEST(Extensions, LobesUnderALight) {
    const auto check = [](const char* name, const Material& m, auto&& expected) {
        double largest = 0;
        const std::vector<Point> points = under_light(m);
        EXPECT_GT(points.size(), 150u) << name;
        for (const Point& point : points) {
            // Towards the poles the tangents of neighbouring vertices differ by more than a degree.
            if (std::abs(point.normal.y()) > 0.8) continue;
            const double value = expected(point, point.local(point.view), point.local(light_direction));
            largest = std::max(largest, value);
            ASSERT_NEAR(point.radiance.x(), value, 0.01 * value + 0.002) << name << " at " << point.n_dot_v();
        }
        EXPECT_GT(largest, 0.05) << name;
    };
    const auto black = [](Material& m) {
        m.base_color = Vec3::Zero();
        m.specular = 0;
    };
    check("clearcoat", with([&](Material& m) { black(m), m.clearcoat = 1, m.clearcoat_roughness = 0.4f; }),
          [](const Point&, const Vec3d& v, const Vec3d& l) {
              return ggx(v, l, 0.16, 0.16) * schlick(v.dot((v + l).normalized()), 0.04) * l.z();
          });
    check("sheen",
          with([&](Material& m) { black(m), m.sheen_color = Vec3::Ones(), m.sheen_roughness = 0.6f; }),
          [](const Point&, const Vec3d& v, const Vec3d& l) { return charlie(v, l, 0.6) * l.z(); });
    for (const float rotation : {0.0f, 90.0f}) {
        const double alpha = 0.16, drawn_out = alpha + (1 - alpha) * 0.36;
        const Material metal = with([&](Material& m) {
            m.metallic = 1;
            m.anisotropy = 0.6f;
            m.anisotropy_rotation_deg = rotation;
        });
        check("anisotropy", metal, [&](const Point&, const Vec3d& v, const Vec3d& l) {
            return (rotation == 0 ? ggx(v, l, drawn_out, alpha) : ggx(v, l, alpha, drawn_out)) * l.z();
        });
    }
    const Material film_on_metal = with([](Material& m) {
        m.base_color = Vec3::Constant(0.5f);
        m.metallic = m.iridescence = 1;
        m.iridescence_ior = 1.4f;
    });
    check("iridescence", film_on_metal, [](const Point&, const Vec3d& v, const Vec3d& l) {
        return ggx(v, l, 0.16, 0.16) * film(v.dot((v + l).normalized()), 1.4, 400, 0.5).x() * l.z();
    });
}

// What lies under varnish and sheen is dimmed by what they reflect: emission too.
TEST(Extensions, VarnishDimsWhatGlowsBelow) {
    const Material m = with([](Material& m) {
        m.base_color = Vec3::Zero();
        m.specular = 0;
        m.clearcoat = 1;
        m.emissive = Vec3(3, 2, 1);
    });
    for (const Point& point : under_light(m)) {
        const double keep = 1 - schlick(point.n_dot_v(), 0.04);
        // Away from the light's reflection, which is small: roughness 0.
        if ((point.view + light_direction).normalized().dot(point.normal) > 0.95) continue;
        ASSERT_NEAR(point.radiance.z(), keep, 0.004);
        ASSERT_NEAR(point.radiance.x(), 3 * keep, 0.012);
    }
}

// Lights of extended surfaces are added with two outputs of one shader, which a draw into several targets
// must not inherit: the layers of the same frame, and the geometry of the next.
TEST(Extensions, LeaveNothingBehindForLayersAndNextFrames) {
    Material varnished = with([](Material& m) { m.clearcoat = 1; });
    Material veil;
    veil.alpha_mode = AlphaMode::blend;
    veil.opacity = 0.5f;
    veil.unlit = true;
    veil.base_color = Vec3(1, 0, 0);
    Scene scene;
    app::Session session = session_of(varnished, scene);
    Mesh before = facing_square(0.5f, veil);
    before.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1.5)));
    scene.show(before, "veil");
    std::string logged;
    set_log_sink([&](LogLevel, std::string_view text) { logged += text; });
    const Image first = render_linear(session), second = render_linear(session);
    set_log_sink({});
    EXPECT_EQ(logged, "");  // OpenGL's errors come here.
    EXPECT_NEAR(first.at<float>(size / 2, size / 2)[0], 0.5f, 0.01f);
    EXPECT_EQ(std::memcmp(first.bytes().data(), second.bytes().data(), first.bytes().size()), 0);
}

// Exact colours are drawn once more at the end of a still, whatever its frames had beside them.
TEST(Extensions, LeaveNothingBehindForExactColors) {
    Scene scene;
    app::Session session = session_of(with([](Material& m) { m.clearcoat = 1; }), scene);
    Material veil;
    veil.alpha_mode = AlphaMode::blend;
    veil.opacity = 0.5f;
    veil.clearcoat = 1;
    scene.show(facing_square(0.2f, veil), "veil");
    Mesh labelled = facing_square(0.5f);
    labelled.set_L(Array1i(Array1i::Dense::Constant(4, 1)));
    labelled.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1.5)));
    scene.show(labelled, "labelled");
    std::string logged;
    set_log_sink([&](LogLevel, std::string_view text) { logged += text; });
    const Image one = session.render({std::nullopt, 1}), four = session.render({std::nullopt, 4});
    set_log_sink({});
    EXPECT_EQ(logged, "");
    for (int c = 0; c < 4; ++c)
        EXPECT_EQ(four.at<uint8_t>(size / 2, size / 2)[c], one.at<uint8_t>(size / 2, size / 2)[c]);
}

/// Mean difference of two pictures of a sphere in an environment that is not the same everywhere, and under a
/// light.
double difference(const Material& a, const Material& b) {
    Image images[2];
    for (const Material* m : {&a, &b}) {
        Scene scene;
        Light light;
        light.position = Vec3(2, 3, 4);
        light.intensity = 20;
        scene.set_light("light", light);
        app::Session session = session_of(*m, scene);
        session.settings().environment.enabled = true;
        images[m == &b] = render_linear(session);
    }
    double sum = 0;
    for (size_t i = 0; i < images[0].pixels<float>().size(); ++i)
        sum += std::abs(images[0].pixels<float>()[i] - images[1].pixels<float>()[i]);
    return sum / (size * size * 3);
}

/// All extensions at work, none at its limit.
Material extended() {
    return with([](Material& m) {
        m.base_color = Vec3(0.6f, 0.4f, 0.2f);
        m.metallic = 0.4f;
        m.clearcoat = 0.6f;
        m.clearcoat_roughness = 0.4f;
        m.sheen_color = Vec3::Constant(0.6f);
        m.sheen_roughness = 0.4f;
        m.specular = 0.6f;
        m.iridescence = 0.6f;
        m.anisotropy = 0.6f;
    });
}

// A texture of one value is a factor: each extension's texture is read, from its channel, and multiplied.
TEST(Extensions, TexturesAreFactors) {
    const auto flat_image = [](int channels, uint8_t value) {
        auto image = std::make_shared<Image>(4, 4, channels, PixelType::u8);
        for (uint8_t& v : image->pixels<uint8_t>()) v = value;
        return image;
    };
    for (const MaterialTexture& use : material_textures()) {
        const std::string name = use.name;
        if (name.ends_with("normal") || name == "occlusion" || name == "emissive" || name == "opacity" ||
            name == "transmission" || name == "thickness")
            continue;
        Material plain = extended(), textured = extended();
        (textured.*use.texture).image = flat_image(4, 128);
        (textured.*use.texture).channel = use.color ? 0 : 2;
        const float factor = use.color ? linear_from_srgb(128 / 255.0f) : 128 / 255.0f;
        for (const MaterialNumber& number : material_numbers())
            if (name == number.name) plain.*number.value *= factor;
        for (const MaterialColor& color : material_colors())
            if (name == color.name) plain.*color.value *= factor;
        if (name == "iridescence_thickness") plain.iridescence_thickness_max = 100 + 300 * factor;
        // Grey stands for (0, 0) as a direction as nearly as 8 bits can: (0.004, 0.004), so the strength
        // alone counts.
        if (name == "anisotropy") {
            plain.anisotropy_rotation_deg = 45;
        }
        EXPECT_LT(difference(plain, textured), 1e-3) << name;
        EXPECT_GT(difference(extended(), textured), 3e-3) << name;
    }
}

// The varnish's own normal texture bends the varnish's reflection and nothing else.
TEST(Extensions, VarnishHasItsOwnNormals) {
    Material m = with([](Material& m) { m.base_color = Vec3::Zero(), m.specular = 0, m.clearcoat = 1; });
    m.clearcoat_roughness = 0.4f;
    auto image = std::make_shared<Image>(4, 4, 3, PixelType::u8);
    const Vec3 tilted = Vec3(0.5f, 0, 1).normalized();
    for (size_t i = 0; i < 16; ++i)
        for (int c = 0; c < 3; ++c)
            image->pixels<uint8_t>()[3 * i + size_t(c)] =
                uint8_t(std::lround((tilted[c] * 0.5f + 0.5f) * 255));
    m.clearcoat_normal_texture.image = image;
    size_t compared = 0;
    for (const Point& point : under_light(m, 0.5)) {
        const Vec3d n = point.frame * tilted.cast<double>();
        if (n.dot(point.view) < 0.3 || n.dot(light_direction) < 0.1) continue;
        const Vec3d t = point.frame.col(1).cross(n).normalized();
        Mat3d frame;
        frame << t, n.cross(t), n;
        const Vec3d v = frame.transpose() * point.view, l = frame.transpose() * light_direction;
        const double expected = ggx(v, l, 0.16, 0.16) * schlick(v.dot((v + l).normalized()), 0.04) * l.z();
        // 8 bits of a normal are 0.4 degrees, and facets of the sphere turn its tangents by as much.
        ASSERT_NEAR(point.radiance.x(), expected, 0.04 * expected + 0.002);
        ++compared;
    }
    EXPECT_GT(compared, 80u);
}

// An extended surface without any effect looks like a plain one, and plain surfaces beside extended ones like
// alone. The extended one's reflectance has 11 bits.
TEST(Extensions, WithoutEffectTheyAreTheCoreModel) {
    const Material plain =
        with([](Material& m) { m.base_color = Vec3(0.7f, 0.3f, 0.1f), m.metallic = 0.4f; });
    Material extended = plain;
    extended.clearcoat = 1e-6f;
    extended.sheen_color = Vec3::Constant(1e-9f);
    extended.iridescence = extended.anisotropy = 1e-6f;
    ASSERT_TRUE(extended.is_extended());
    EXPECT_LT(difference(plain, extended), 1e-3);

    Scene scene;
    app::Session session = session_of(plain, scene);
    session.allow_native_geometry(false);  // it does not draw extended surfaces
    session.settings().environment.enabled = true;
    const Image alone = render_linear(session);
    Mesh other = make_sphere(0.2f, 32);
    other.set_material(
        with([](Material& m) { m.clearcoat = m.iridescence = 1, m.sheen_color = Vec3::Ones(); }));
    other.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -3)));  // hidden
    scene.show(other, "other");
    const Image beside = render_linear(session);
    for (size_t i = 0; i < alone.pixels<float>().size(); ++i)
        ASSERT_NEAR(alone.pixels<float>()[i], beside.pixels<float>()[i], 2e-5);
}

// Drawn over everything else, with nothing else there, an extended surface looks as it does anyway.
TEST(Extensions, StayWhatTheyAreInAnOverlay) {
    Scene scene;
    app::Session session = session_of(extended(), scene);
    session.settings().environment.enabled = true;
    const Image plain = render_linear(session);
    session.settings().style.overlay = true;
    const Image over = render_linear(session);
    ASSERT_TRUE(std::ranges::equal(plain.pixels<float>(), over.pixels<float>()));
}

// Layers of ground truth are of the core model: extended surfaces are in them like others.
TEST(Extensions, GroundTruthKnowsThem) {
    Scene scene;
    app::Session session = session_of(extended(), scene);
    const auto layers = session.render_layers({"id", "roughness", "albedo"});
    EXPECT_EQ(layers.at("id").at<float>(size / 2, size / 2)[0], 1.0f);
    EXPECT_NEAR(layers.at("roughness").at<float>(size / 2, size / 2)[0], 0.4f, 0.5f / 255);
    EXPECT_NEAR(layers.at("albedo").at<float>(size / 2, size / 2)[1], 0.4f, 1e-4);
}

}  // namespace
}  // namespace easypbr
