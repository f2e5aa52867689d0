// glTF's material extensions beside all else: textures, layers, overlays, exact colours, ground truth.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "easypbr/core/color.h"
#include "easypbr/core/log.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/settings.h"
#include "extension_sphere.h"
#include "lobe_reference.h"

namespace easypbr::extension_pictures_test {
namespace {

using namespace reference;
using namespace sphere;

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
    set_log_sink([&](LogLevel level, std::string_view text) {
        if (level == LogLevel::warning) logged += text;
    });
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
    set_log_sink([&](LogLevel level, std::string_view text) {
        if (level == LogLevel::warning) logged += text;
    });
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
        light.position = Vec3d(2, 3, 4);
        light.intensity = 20;
        scene.set_light("light", light);
        app::Session session = session_of(*m, scene);
        session.settings().environment.enabled = true;
        session.settings().environment.intensity = 1.0f;
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
        (textured.*use.texture).channel = use.use == TexelUse::color ? 0 : 2;
        const float factor = use.use == TexelUse::color ? linear_from_srgb(128 / 255.0f) : 128 / 255.0f;
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

/// Radiance of a square whose normals are bent, in its own frame, under light from a direction.
float seen_of_bent(const Vec2& bent, bool is_mirrored, const Vec3& from, bool by_paths) {
    Image normals(1, 1, 3, PixelType::u8);
    for (int c = 0; c < 2; ++c) normals.at<uint8_t>(0, 0)[c] = uint8_t(std::lround(127.5f * (1 + bent[c])));
    normals.at<uint8_t>(0, 0)[2] = uint8_t(std::lround(127.5f * (1 + std::sqrt(1 - bent.squaredNorm()))));
    Material m;
    m.roughness = 1;
    m.normal_texture.image = std::make_shared<Image>(normals);
    Mesh square = facing_square(1, m);
    if (is_mirrored) square.set_T_parent_mesh(Eigen::Affine3d(Eigen::Scaling(Vec3d(-1, 1, 1))));
    Scene scene;
    scene.show(square, "square");
    Light light;
    light.type = LightType::directional;
    light.direction = -from;
    scene.set_light("light", light);
    app::Session session = plain_session(scene, 8);
    session.settings().path.enabled = by_paths;
    look_from(session, Vec3d(0, 0, 4), 10);
    return render_linear(session, by_paths ? 4 : 1).at<float>(4, 4)[0];
}

// A mesh that its pose mirrors from left to right shows what the mesh shows under mirrored light: its normal
// textures are mirrored with it, and what they bend upwards stays so.
TEST(Extensions, MirroredPosesMirrorNormalTextures) {
    for (const bool by_paths : {false, true})
        for (const Vec2& bent : {Vec2(0.5f, 0), Vec2(0, 0.5f), Vec2(0.3f, 0.4f)}) {
            const Vec3 from = Vec3(0.4f, 0.5f, 0.8f).normalized(), mirrored(-from.x(), from.y(), from.z());
            const float expected = seen_of_bent(bent, false, from, by_paths);
            // 1e-3: normals have 16 bits.
            EXPECT_NEAR(seen_of_bent(bent, true, mirrored, by_paths), expected, 1e-3 * expected);
            EXPECT_GT(expected, 1.05f * seen_of_bent(-bent, false, from, by_paths));  // bending tells
        }
}

// Drawn over everything else, with nothing else there, an extended surface looks as it does anyway.
TEST(Extensions, StayWhatTheyAreInAnOverlay) {
    Scene scene;
    app::Session session = session_of(extended(), scene);
    session.allow_native_geometry(false);  // overlays are the driver's
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
    const auto layers = session.render_layers({"object_id", "roughness", "albedo"});
    EXPECT_EQ(layers.at("object_id").at<float>(size / 2, size / 2)[0], 1.0f);
    EXPECT_NEAR(layers.at("roughness").at<float>(size / 2, size / 2)[0], 0.4f, 0.5f / 255);
    EXPECT_NEAR(layers.at("albedo").at<float>(size / 2, size / 2)[1], 0.4f, 1e-4);
}

}  // namespace
}  // namespace easypbr::extension_pictures_test
