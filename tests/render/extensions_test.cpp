// glTF's material extensions: what they give back of light, against the formulas in lobe_reference.h.
#include <cmath>
#include <map>
#include <tuple>

#include "extension_sphere.h"
#include "lobe_reference.h"

#include "easypbr/scene/settings.h"

namespace easypbr::extensions_test {
namespace {

using namespace reference;
using namespace sphere;

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
    // Of 8 bits, n = 1 / sqrt(1 - code / 255): codes 176 and 240.
    const float dense = 1 / std::sqrt(79 / 255.0f), densest = std::sqrt(17.0f);
    for (const auto& [thickness, ior, metallic] :
         {std::tuple(300.0f, 1.4f, 0.0f), std::tuple(550.0f, dense, 0.0f), std::tuple(300.0f, densest, 0.0f),
          std::tuple(400.0f, 1.4f, 1.0f)}) {
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
            // The film's index 1.4 is off by 0.0003, of which the phase turns by 0.02 %. Roundings of the
            // picture.
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

}  // namespace
}  // namespace easypbr::extensions_test
