// Shading on the CPU against the driver's: one text, two compilers.
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>

#include "easypbr/app/session.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/gl/context.h"
#include "easypbr/native/shaders.h"
#include "easypbr/scene/settings.h"
#include "gpu_rounding.h"
#include "native_shading.h"
#include "render/render_test.h"

namespace easypbr::native_shading_test {
namespace {

/// Scenes and settings at random, of all that is shaded natively.
class Generator {
  public:
    explicit Generator(unsigned seed) : random_(seed) {}

    Scene scene() {
        Scene scene;
        if (chance(0.7)) scene.set_environment(sky());
        const int count = between(1, 3);
        has_layers_ = chance(0.3);
        has_over_ = !has_layers_ && chance(0.3);
        for (int i = 0; i < count; ++i) {
            Mesh mesh = chance(0.5) ? make_teapot(1, between(2, 12)) : make_sphere(1, between(8, 60));
            if (chance(0.3) && !has_layers_) mesh = cloud_of(mesh);
            Material material;
            material.base_color = color();
            material.roughness = chance(0.2) ? 0.0f : number(0, 1);
            material.metallic = chance(0.5) ? 0.0f : number(0, 1);
            if (chance(0.4)) extend(material);
            if (has_layers_ && chance(0.7)) blend(material);
            if (has_layers_ && chance(0.5)) transmit(material);
            mesh.set_material(material);
            Eigen::Affine3d pose = Eigen::Affine3d::Identity();
            pose.translate(Vec3d(1.5 * i, number(-1, 1), number(-1, 1)));
            pose.scale(double(number(0.5f, 1.5f)));
            mesh.set_T_world_mesh(pose);
            if (chance(0.3)) color(mesh);
            if (chance(0.3) && !has_over_) draw_lines(mesh);
            if (chance(0.5) && has_over_) mesh.edit([](MeshData& data) { data.style.overlay = true; });
            scene.show(mesh, "mesh" + std::to_string(i));
        }
        const int lights = between(0, 3);
        for (int i = 0; i < lights; ++i) scene.set_light("light" + std::to_string(i), light());
        return scene;
    }

    void change(Settings& s) {
        constexpr int sizes[][2] = {{1, 1}, {7, 3}, {33, 17}, {64, 64}, {121, 83}, {16, 200}};
        const auto& size = sizes[size_t(between(0, 5))];
        s.image.size = Vec2i(size[0], size[1]);
        s.image.samples = chance(0.7) ? 1 : between(2, 5);
        s.image.antialias = chance(0.5) ? Antialias::fxaa : Antialias::none;
        s.shadows.enabled = chance(0.6);
        s.transparency.max_layers = chance(0.5) ? 8 : between(1, 3);
        s.shadows.mode = ShadowMode(between(0, 2));
        s.shadows.resolution = chance(0.5) ? 256 : 1024;
        s.ssao.enabled = chance(0.5);
        s.ssao.method = chance(0.7) ? OcclusionMethod::horizon : OcclusionMethod::hemisphere;
        s.ssao.resolution = OcclusionResolution(between(0, 2));
        s.ssao.directions = between(1, 3);
        s.ssao.multi_bounce = chance(0.5);
        s.environment.enabled = chance(0.8);
        s.environment.intensity = number(0.2f, 2);
        s.background.mode =
            std::array{BackgroundMode::color, BackgroundMode::environment, BackgroundMode::blur,
                       BackgroundMode::transparent}[size_t(between(0, 3))];
        s.background.blur = number(0, 1);
        s.shading.brdf = Brdf(between(0, 2));
        s.shading.multiple_scattering = chance(0.5);
        s.tonemap.tone_operator = ToneOperator(between(0, 4));
        s.camera.projection = chance(0.7) ? Projection::perspective : Projection::orthographic;
        s.rays.enabled = false;
        s.ground.mode = GroundMode(chance(0.6) ? 0 : between(1, 2));
        s.edl.strength = number(0, 2);
        s.edl.radius = number(0.5f, 30);
        s.points.hole_filling = chance(0.5) ? 0 : between(1, 4);
        change_effects(s);
    }

    /// Of all meshes' wireframes and normals.
    Eigen::Index lines() const { return lines_; }

  private:
    void change_effects(Settings& s) {
        s.bloom.enabled = chance(0.3);
        s.bloom.intensity = number(0, 1);
        s.bloom.threshold = chance(0.5) ? 0.0f : number(0.1f, 2);
        s.depth_of_field.enabled = chance(0.3);
        s.depth_of_field.f_number = number(0.2f, 4);
        s.outline.enabled = chance(0.3);
        s.outline.width = number(0.5f, 6);
        s.outline.color = color();
        s.outline.silhouettes = chance(0.7);
        s.outline.creases = chance(0.7);
        s.outline.objects = chance(0.7);
    }
    /// Material extensions of opaque surfaces.
    void extend(Material& m) {
        m.clearcoat = chance(0.5) ? number(0, 1) : 0.0f;
        m.clearcoat_roughness = number(0, 1);
        if (chance(0.5)) m.sheen_color = color();
        m.sheen_roughness = number(0, 1);
        m.ior = chance(0.3) ? 1.5f : number(1, 2.5f);
        m.specular = chance(0.5) ? 1.0f : number(0, 1);
        if (chance(0.3)) m.specular_color = color();
        m.iridescence = chance(0.4) ? number(0, 1) : 0.0f;
        m.iridescence_thickness_max = number(100, 900);
        m.anisotropy = chance(0.4) ? number(0, 1) : 0.0f;
        m.anisotropy_rotation_deg = number(-180, 180);
        if (chance(0.3)) m.emissive = color();
    }
    void blend(Material& m) {
        m.alpha_mode = AlphaMode::blend;
        m.opacity = number(0, 1);
        m.unlit = chance(0.2);
    }
    /// Glass: thin or a volume, clear or rough.
    void transmit(Material& m) {
        m.transmission = number(0.2f, 1);
        m.metallic = chance(0.8) ? 0.0f : number(0, 1);
        m.roughness = chance(0.4) ? 0.0f : m.roughness;
        m.thickness = chance(0.5) ? number(0.1f, 2) : 0.0f;
        m.dispersion = chance(0.3) ? number(0, 10) : 0.0f;
        m.attenuation_color = color();
        m.attenuation_distance = number(0.5f, 3);
    }
    /// Points without normals: shaded by eye-dome lighting.
    Mesh cloud_of(const Mesh& mesh) {
        MeshData data;
        data.V = mesh.V();
        data.style.mode = DrawMode::points;
        data.style.point_size = number(1, 9);
        return Mesh(data);
    }
    void draw_lines(Mesh& mesh) {
        mesh.edit([&](MeshData& data) {
            const bool has_wireframe = chance(0.5), has_normals = chance(0.5) && !data.N.empty();
            data.style.show_wireframe = has_wireframe;
            data.style.show_normals = has_normals;
            data.style.line_width = number(0.3f, 6);
            data.style.line_dash = chance(0.7) ? 0.0f : number(1, 9);
            data.style.line_color = color();
            if (has_wireframe) lines_ += 3 * data.F.rows() / 2;
            if (has_normals) lines_ += data.V.rows();
        });
    }
    /// Colours of labels and of heights, lit or as they are.
    void color(Mesh& mesh) {
        mesh.edit([&](MeshData& data) {
            Array1i::Dense labels(data.V.rows());
            for (Eigen::Index i = 0; i < labels.size(); ++i) labels[i] = int32_t(i / 40 % 5);
            data.L = Array1i(labels);
            data.style.lit = chance(0.3);
            data.style.color_by =
                std::array{ColorBy::label, ColorBy::height, ColorBy::solid}[size_t(between(0, 2))];
        });
    }
    Environment sky() {
        // Coarse ones, and ones with more detail than the pictures show.
        const int height = chance(0.5) ? 16 : 256;
        Image image(2 * height, height, 3, PixelType::f32);
        for (float& value : image.pixels<float>()) value = number(0, 1.5f);
        return Environment(image);
    }
    double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    bool chance(double p) { return unit() < p; }
    int between(int a, int b) { return a + int(unit() * (b - a + 1)); }
    float number(float a, float b) { return a + float(unit()) * (b - a); }
    Vec3 color() { return Vec3(number(0, 1), number(0, 1), number(0, 1)); }
    Light light() {
        Light light;
        light.type = LightType(between(0, 5));
        light.position = Vec3d(number(-4, 4), number(2, 5), number(-4, 4));
        light.direction = -light.position.normalized().cast<float>();
        light.color = color();
        const bool small = light.type == LightType::point || light.type == LightType::spot;
        light.intensity = small ? 40.0f : 2.0f;
        light.size = Vec2(number(0.1f, 3), number(0.1f, 3));
        light.width_axis = Vec3(number(-1, 1), 1, number(-1, 1));
        light.radius = number(0.1f, 2);
        light.casts_shadows = chance(0.7);
        return light;
    }

    std::mt19937 random_;
    bool has_layers_ = false, has_over_ = false;
    Eigen::Index lines_ = 0;
};

/// 200 in `make check-long`.
unsigned scene_count() {
    const char* asked = std::getenv("EASYPBR_TEST_SCENES");
    return asked ? unsigned(std::atoi(asked)) : 60;
}

Image drawn(const Scene& scene, unsigned seed, bool native, const std::string& instruction_set = {}) {
    if (!instruction_set.empty()) native::use_instruction_set(instruction_set);
    Generator generator(seed);
    generator.scene();
    app::Session session(scene);
    generator.change(session.settings());
    session.allow_native_shading(native);
    return session.render();
}

/// Whether FXAA follows: in a cloud every pixel is an edge to it.
bool is_blurred(unsigned seed) {
    Generator generator(seed);
    generator.scene();
    Settings settings;
    generator.change(settings);
    return settings.image.antialias == Antialias::fxaa && settings.image.samples == 1;
}

// Both round the same values to 8 bits, in another order of operations: they differ by 1 where a value lies
// beside the middle of two. A texel of a shadow map that lies in the plane of a surface, to the last bit, is
// before it for one and behind it for the other, a normal's angle or a step of depth is beside the least of
// an outline, FXAA chooses between two blurs, and tone curves are steep where one channel is dark beside a
// bright one: few pixels differ by more, in all scenes one of 1000, in a single one of 200 nine of 3200.
// Where more lines are drawn than there are pixels, llvmpipe loses some of them: it truncates to a half after
// each one that is blended, and natively halves are rounded. There it is at most one of 20.
TEST(NativeShading, IsTheDrivers) {
    if (has_gpu()) GTEST_SKIP() << "this machine has a GPU: nothing is shaded natively";
    Difference all;
    for (unsigned seed = 0; seed < scene_count(); ++seed) {
        Generator generator(seed);
        const Scene scene = generator.scene();
        const Difference d = difference(drawn(scene, seed, true), drawn(scene, seed, false));
        all.pixels += d.pixels;
        all.by_one += d.by_one;
        all.by_more += d.by_more;
        all.most = std::max(all.most, d.most);
        const bool has_many_lines = size_t(generator.lines()) > d.pixels;
        const size_t part = has_many_lines ? 20 : is_blurred(seed) ? 100 : 400;
        EXPECT_LE(d.by_more, 2 + d.pixels / part) << "scene " << seed << ", largest " << d.most;
    }
    EXPECT_LE(all.by_more, all.pixels / 1000);
    RecordProperty("largest", all.most);
    RecordProperty("pixels", int(all.pixels));
    RecordProperty("by_one", int(all.by_one));
    RecordProperty("by_more", int(all.by_more));
}

// Under an orthographic camera all pixels are looked at from one direction, also those far from the middle.
TEST(NativeShading, SeesTheDriversSideOfFaces) {
    if (has_gpu()) GTEST_SKIP() << "this machine has a GPU: nothing is shaded natively";
    for (const bool flat : {true, false}) {
        Mesh mesh = make_teapot(1, 4);
        mesh.edit([&](MeshData& data) { data.style.flat = flat; });
        Material material;
        material.opacity = 0.5f;
        material.alpha_mode = AlphaMode::blend;
        mesh.set_material(material);
        Scene scene;
        scene.show(mesh, "teapot");
        const auto draw = [&](bool native) {
            app::Session session(scene);
            session.settings().image.size = Vec2i(160, 120);
            session.settings().image.samples = 1;
            session.settings().shadows.enabled = false;
            session.settings().camera.projection = Projection::orthographic;
            session.allow_native_shading(native);
            return session.render();
        };
        // Depths of two layers meet in single pixels.
        EXPECT_LE(difference(draw(true), draw(false)).by_more, 10u) << (flat ? "flat" : "smooth");
    }
}

TEST(NativeShading, IsTheSameForAllInstructionSets) {
    if (has_gpu()) GTEST_SKIP() << "this machine has a GPU: nothing is shaded natively";
    const std::vector<std::string_view> names = native::instruction_sets();
    if (names.size() == 1) GTEST_SKIP() << "only " << names[0] << " is built, or the processor has no more";
    const std::string before(native::instruction_set());
    for (unsigned seed = 0; seed < 40; ++seed) {
        const Scene scene = Generator(seed).scene();
        const Image first = drawn(scene, seed, true, std::string(names.back()));
        for (const std::string_view name : names) {
            const Image other = drawn(scene, seed, true, std::string(name));
            EXPECT_TRUE(std::ranges::equal(first.bytes(), other.bytes())) << name << ", scene " << seed;
        }
    }
    native::use_instruction_set(before);
}

// Of what is native nothing needs the driver.
TEST(NativeShading, LoadsNoDriver) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Scene scene = Generator(seed).scene();
        Generator generator(seed);
        generator.scene();
        app::Session session(scene);
        session.use_device(DrawDevice::cpu);
        generator.change(session.settings());
        session.render();
        session.render_layers({"depth", "object_id"});
        EXPECT_TRUE(session.context_info().version.empty()) << "scene " << seed;
    }
}

TEST(NativeShading, LoadsNoDriverForMotionBlur) {
    Mesh mesh = make_sphere(1, 20);
    Scene scene;
    scene.show(mesh, "ball");
    app::Session session(scene);
    session.use_device(DrawDevice::cpu);
    session.settings().image.size = Vec2i(48, 32);
    session.settings().image.samples = 4;
    session.settings().motion_blur.enabled = true;
    const Image still = session.render();
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0.3, 0, 0)));
    const Image moving = session.render();
    EXPECT_GT(difference(still, moving).by_more, 50u);
    EXPECT_TRUE(session.context_info().version.empty());
}

TEST(NativeShading, DevicesAreChosenBeforeTheFirstPicture) {
    app::Session session;
    session.use_device(DrawDevice::cpu);
    EXPECT_EQ(session.context_info().device, DrawDevice::cpu);
    session.use_device(DrawDevice::cpu);
    EXPECT_THROW(session.use_device(DrawDevice::gl), ArgumentError);
}

TEST(NativeShading, NamesUnknownInstructionSets) {
    EXPECT_THROW(native::use_instruction_set("mmx"), ArgumentError);
}

}  // namespace
}  // namespace easypbr::native_shading_test
