// Shaders of a program's own. A square that fills the picture, so that every pixel is known.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/own_shader.h"
#include "easypbr/core/error.h"
#include "easypbr/scene/settings.h"
#include "gpu_rounding.h"

namespace easypbr::app::own_shader_test {
namespace {

namespace fs = std::filesystem;

TEST(OwnShader, SetsWhatGoesIntoTheGBuffer) {
    Session session =
        square_session({"void surface(inout Surface s) {\n"
                        "    s.base_color = vec3(0.25, s.base_color.g * 0.5, 0.75);\n"
                        "    s.roughness = 0.2;\n"
                        "    s.metallic = 1.0;\n"
                        "    s.occlusion = 0.6;\n"
                        "}\n"});
    const auto layers = session.render_layers({"albedo", "roughness", "metallic", "occlusion"});
    // The material's green is 0.6. Albedo has 16 bits a channel, material 8: half a step each.
    const Vec4 albedo = middle_of(layers.at("albedo"));
    EXPECT_NEAR(albedo.x(), 0.25, 0.5 / 65535);
    EXPECT_NEAR(albedo.y(), 0.3, 0.5 / 65535);
    EXPECT_NEAR(albedo.z(), 0.75, 0.5 / 65535);
    EXPECT_NEAR(middle_of(layers.at("roughness"))[0], 0.2, 0.5 / 255);
    EXPECT_NEAR(middle_of(layers.at("metallic"))[0], 1, 0.5 / 255);
    EXPECT_NEAR(middle_of(layers.at("occlusion"))[0], 0.6, 0.5 / 255);
}

// Positions, directions and texture coordinates of a pixel follow from the camera: at distance 5 with 30
// degrees a pixel's centre half a pixel off the axis lies 5 tan(15) / side off it.
TEST(OwnShader, KnowsWhereItIs) {
    const float off = 5 * std::tan(radians(15.0f)) / side;
    Session session =
        square_session({"void surface(inout Surface s) {\n"
                        "    s.emission = s.position;\n"
                        "    s.base_color = vec3(s.uv, s.view.z);\n"
                        "}\n"});
    const Vec4 position = middle_of(render_linear(session));
    // Rounding of float32 at a distance of 5 from the eye: 5e-7, and that of the interpolation.
    const double rounding = 3e-6 + 2 * off * vertex_rounding();  // a pixel is 2 * off wide
    EXPECT_NEAR(position.x(), off, rounding);
    EXPECT_NEAR(position.y(), -off, rounding);
    EXPECT_NEAR(position.z(), 0, rounding);
    const Vec4 albedo = middle_of(session.render_layers({"albedo"}).at("albedo"));
    // The square is 20 wide.
    EXPECT_NEAR(albedo.x(), 0.5 + off / 20, 1.0 / 65535);
    EXPECT_NEAR(albedo.y(), 0.5 - off / 20, 1.0 / 65535);
    EXPECT_NEAR(albedo.z(), 5 / std::sqrt(25 + 2 * off * off), 1.0 / 65535);
}

// Shaders are for pixels: a ball beside the square is lit by what the square's material emits.
TEST(OwnShader, PathsMeetTheMaterialWithoutIt) {
    Material green;
    green.emissive = Vec3(0, 1, 0);
    Session session =
        square_session({"void surface(inout Surface s) { s.emission = vec3(s.uv, 0.0); }\n"}, green);
    Mesh ball = make_sphere(0.5f, 32);
    ball.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(1.5, 0, 0.9)));
    session.scene().show(ball, "ball");
    look_from(session, Vec3d(5, 0, 3), 10);
    session.settings().path.enabled = true;
    const Vec4 seen = middle_of(render_linear(session, 16));
    EXPECT_GT(seen.y(), 0.01f);
    EXPECT_LT(seen.x(), 1e-3f);
}

TEST(OwnShader, MovesWithTheMeshAndTurnsItsNormal) {
    Session session =
        square_session({"void surface(inout Surface s) {\n"
                        "    s.emission = s.own_position;\n"
                        "    s.normal = vec3(3.0, 0.0, 0.0);\n"
                        "}\n"});
    session.scene().get("square").set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(-2, 0, 0)));
    const float off = 5 * std::tan(radians(15.0f)) / side;
    EXPECT_NEAR(middle_of(render_linear(session)).x(), 2 + off, 3e-6 + 2 * off * vertex_rounding());
    const Vec4 normal = middle_of(session.render_layers({"normal_world"}).at("normal_world"));
    EXPECT_NEAR(normal.x(), 1, 1e-4);  // 16 bits of an octahedron: 0.004 degrees
}

TEST(OwnShader, ShowsColoursUnlitWhenAskedTo) {
    Session session =
        square_session({"void surface(inout Surface s) {\n"
                        "    s.unlit = true;\n"
                        "    s.base_color = vec3(0.125, 0.5, 1.0);\n"
                        "}\n"});
    session.settings().environment.enabled = true;
    session.scene().set_environment(constant_environment(3));
    const Vec4 shown = middle_of(render_linear(session));
    EXPECT_EQ(shown, Vec4(0.125f, 0.5f, 1, 1));
}

TEST(OwnShader, CutsHolesWhereTheAlphaModeIsMask) {
    Material material;
    material.alpha_mode = AlphaMode::mask;
    Session session = square_session(
        {"void surface(inout Surface s) { s.opacity = s.position.x < 0.0 ? 0.0 : 1.0; }"}, material);
    const Image picture = render_linear(session);
    EXPECT_EQ(picture.at<float>(side / 2 - 1, 3)[3], 0);
    EXPECT_EQ(picture.at<float>(side / 2, 3)[3], 1);
}

// Dense meshes are drawn natively without a GPU; with a shader of their own they are not.
TEST(OwnShader, ActsOnDenseMeshesToo) {
    Material material;
    material.shader.text = "void surface(inout Surface s) { s.base_color = vec3(0.5, 0.0, 1.0); }";
    Mesh ball = make_sphere(1, 128);
    ball.set_material(material);
    Scene scene;
    scene.show(ball, "ball");
    Session session = plain_session(scene, side);
    EXPECT_NEAR(middle_of(session.render_layers({"albedo"}).at("albedo")).x(), 0.5, 0.5 / 65535);
}

// A stripe that the shader cuts is a hole for light, picking and masks too: `discard`, an opacity below the
// cutoff, and a blended opacity of 0; from a light beside it and from one far away; of few faces and of many,
// which are drawn natively.
TEST(OwnShader, CutsHolesForLightAndPickingToo) {
    const char* cut = "void surface(inout Surface s) { if (abs(s.own_position.x) < 0.3) %; }";
    const auto with = [&](const std::string& what) {
        std::string text = cut;
        return text.replace(text.find('%'), 1, what);
    };
    for (const auto& [mode, text] :
         {std::pair(AlphaMode::opaque, with("discard")), std::pair(AlphaMode::mask, with("s.opacity = 0.2")),
          std::pair(AlphaMode::blend, with("s.opacity = 0.0"))})
        for (const bool directional : {true, false})
            for (const bool dense : {false, true}) {
                const std::string what =
                    fmt::format("mode {}, directional {}, dense {}", int(mode), directional, dense);
                Material matt;
                matt.base_color = Vec3::Ones();
                matt.roughness = 1;
                Scene scene;
                scene.show(facing_square(4, matt), "floor");
                Mesh caster = dense ? make_sphere(1, 64) : facing_square(1);
                if (dense)
                    caster.edit([](MeshData& data) {  // a disc
                        Array3f::Dense V = data.V;
                        V.col(2).setZero();
                        data.V = Array3f(V);
                        data.N = {};
                    });
                Material m;
                m.alpha_mode = mode;
                m.shader.text = text;
                caster.set_material(m);
                caster.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1)));
                scene.show(caster, "caster");
                Light light;
                light.type = directional ? LightType::directional : LightType::point;
                light.direction = Vec3(0, -0.8f, -1).normalized();
                light.position = 20 * Vec3d(0, 0.8, 1).normalized();
                light.intensity = directional ? 3 : 1200;
                scene.set_light("light", light);
                Session session = plain_session(scene, 64);
                session.settings().shadows.enabled = true;
                session.settings().shadows.mode = ShadowMode::pcf;
                session.settings().camera.projection = Projection::orthographic;
                session.settings().camera.ortho_height = 4.0;
                look_from(session, Vec3d(0, 0, 6));
                // The shadow's middle is at y = -0.8, row 44.8: below the caster's picture from row 48 on.
                const Image image = render_linear(session);
                const float lit = image.at<float>(4, 52)[0];
                EXPECT_GT(lit, 0.3f) << what;
                EXPECT_NEAR(image.at<float>(32, 52)[0], lit, 0.15f * lit) << what;
                EXPECT_LT(image.at<float>(40, 52)[0], 0.02f * lit) << what;
                const PickBuffer picks = session.pick_buffer(Vec2i(64, 64));
                EXPECT_EQ(picks.at({32.5, 32.5})->object, "floor") << what;
                EXPECT_EQ(picks.at({42.5, 32.5})->object, "caster") << what;
                session.render({std::nullopt, 1});
                // Alone: what ground truth measures amodal masks with.
                const Drawn drawn = session.draw_surfaces({Vec2i(64, 64), 1}, false);
                const std::vector<std::string> names = session.object_names();
                const auto covered = drawn.coverage(
                    {0, 32, 64, 1}, [&](size_t object, int) { return names[object] == "caster"; });
                EXPECT_FALSE(covered[32]) << what;
                EXPECT_TRUE(covered[42]) << what;
                // Another text, other holes: the map is drawn anew.
                m.shader.text = "void surface(inout Surface s) { if (abs(s.own_position.x) > 0.3) discard; }";
                session.scene().get("caster").set_material(m);
                const Image other = render_linear(session);
                EXPECT_LT(other.at<float>(32, 52)[0], 0.02f * lit) << what;
                EXPECT_NEAR(other.at<float>(40, 52)[0], lit, 0.15f * lit) << what;
            }
}

TEST(OwnShader, SaysInWhichLineItIsWrong) {
    Session session =
        square_session({"// the first line\n"
                        "void surface(inout Surface s) {\n"
                        "    s.base_color = colour;\n"
                        "}\n"});
    const std::string message = message_of(session);
    EXPECT_NE(message.find("material.shader:3"), message.npos) << message;
    EXPECT_NE(message.find("colour"), message.npos) << message;
}

TEST(OwnShader, SaysWhatIsMissing) {
    Session empty = square_session({"float unused = 1.0;"});
    EXPECT_NE(message_of(empty).find("void surface(inout Surface s)"), std::string::npos);
    Session lost = square_session({"", "/tmp/easypbr/there/is/no/such.glsl"});
    EXPECT_THROW(lost.render(), FileError);
}

TEST(OwnShader, IsReadAgainWhenTheFileChanges) {
    ShaderFile file;
    file.write("void surface(inout Surface s) { s.base_color = vec3(0.25); }");
    Session session = square_session({"", file.path().string()});
    const auto red = [&] { return middle_of(session.render_layers({"albedo"}).at("albedo")).x(); };
    EXPECT_NEAR(red(), 0.25, 0.5 / 65535);
    const uint64_t version = session.picture_version();
    EXPECT_EQ(session.picture_version(), version);
    file.write("void surface(inout Surface s) {\n s.base_color = vec3(0.5)\n}");
    EXPECT_GT(session.picture_version(), version);
    EXPECT_NE(message_of(session).find(file.path().string() + ":3"), std::string::npos);
    file.write("void surface(inout Surface s) { s.base_color = vec3(0.75); }");
    EXPECT_NEAR(red(), 0.75, 0.5 / 65535);
    // A file that is being replaced may be missing for a moment.
    fs::remove(file.path());
    EXPECT_NEAR(red(), 0.75, 0.5 / 65535);
}

TEST(OwnShader, OfTheSettingsIsForAllMaterials) {
    ShaderFile file;
    file.write("void surface(inout Surface s) { s.base_color = vec3(0.25, 0.5, 1.0); }");
    Session session = square_session({});
    session.settings().material.shader = file.path().string();
    EXPECT_NEAR(middle_of(session.render_layers({"albedo"}).at("albedo")).x(), 0.25, 0.5 / 65535);
}

TEST(OwnShader, MayHaveLongLines) {
    const std::string blanks(1'000'000, ' ');
    Session session = square_session({"//" + blanks + "\nvoid" + blanks + "surface" + blanks +
                                      "(inout Surface s) { s.base_color = vec3(0.25, 0.5, 1.0); }"});
    EXPECT_NEAR(middle_of(session.render_layers({"albedo"}).at("albedo")).x(), 0.25, 0.5 / 65535);
    for (const char* text : {"voidsurface(inout Surface s) {}", "avoid surface(inout Surface s) {}",
                             "void surface;", "surface(", "void surface"}) {
        Session without = square_session({text});
        EXPECT_NE(message_of(without).find("expected GLSL with the function"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace easypbr::app::own_shader_test
