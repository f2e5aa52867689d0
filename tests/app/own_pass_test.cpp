// Passes of a program's own, over a square that fills the picture.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "app/own_shader.h"
#include "easypbr/app/custom_pass.h"
#include "easypbr/core/error.h"
#include "easypbr/scene/settings.h"
#include "gpu_rounding.h"

namespace easypbr::app::own_pass_test {
namespace {

namespace fs = std::filesystem;

std::shared_ptr<Pass> pass_of(const std::string& body, Blend blend = Blend::over) {
    const std::string head =
        "#include \"common_camera.glsl\"\n#include \"common_encoding.glsl\"\n"
        "uniform sampler2D u_albedo, u_normal, u_material, u_depth_target, u_image;\n"
        "layout(location = 0) out vec4 o_color;\n"
        "vec4 at(sampler2D target) { return textureLod(target, gl_FragCoord.xy / u_size, 0.0); }\n";
    return std::make_shared<ShaderPass>("body", head + "void main() { " + body + " }", blend);
}

// Each target of the G-buffer is bound under its name.
TEST(OwnPass, ReadsTheGBuffer) {
    Material material;
    material.base_color = Vec3(0.25f, 0.5f, 0.75f);
    material.roughness = 0.4f;
    material.shader = {};
    Session session = square_session({}, material);
    const auto show = [&](const std::string& body) {
        session.add_pass("own", Stage::light, pass_of(body, Blend::replace));
        return middle_of(render_linear(session));
    };
    EXPECT_NEAR(show("o_color = at(u_albedo);").x(), 0.25, 0.5 / 65535);
    EXPECT_NEAR(show("o_color = at(u_material);").y(), 0.4, 0.5 / 255);
    EXPECT_NEAR(show("o_color = vec4(oct_decode(at(u_normal).rg * 2.0 - 1.0), 1.0);").z(), 1, 1e-4);
    const std::string position = "view_position(gl_FragCoord.xy, at(u_depth_target).r)";
    EXPECT_NEAR(show("o_color = vec4(" + position + ", 1.0);").z(), -5, 1e-5);
}

// In stage light the tone curve comes after the pass; in stage overlay it does not touch it.
TEST(OwnPass, DrawsBeforeOrPastTheToneCurve) {
    Session session = square_session({"void surface(inout Surface s) { s.emission = vec3(0.125); }"});
    session.settings().tonemap.exposure = 2.0f;
    session.add_pass("own", Stage::light, pass_of("o_color = vec4(0.25, 0.0, 0.0, 0.5);"));
    // 0.25 + (1 - 0.5) 0.125 = 0.3125, times the exposure.
    const auto encoded = [](double linear) {
        return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
    };
    const auto red = [&] { return double(session.render().at<uint8_t>(side / 2, side / 2)[0]); };
    EXPECT_NEAR(red(), encoded(0.625), 0.51);  // half a step of 8 bits
    session.add_pass("own", Stage::overlay, pass_of("o_color = vec4(0.25, 0.0, 0.0, 0.5);"));
    EXPECT_NEAR(red(), encoded(0.25 + 0.5 * 0.25), 0.51);
    session.add_pass("own", Stage::picture,
                     pass_of("o_color = vec4(1.0 - at(u_image).rgb, 1.0);", Blend::replace));
    EXPECT_NEAR(red(), 255 - encoded(0.25), 1.01);  // two roundings to 8 bits
    session.remove_pass("own");
    EXPECT_NEAR(red(), encoded(0.25), 0.51);
}

// A value stays until it is set anew; only another one is a new revision, so that a window rests.
TEST(OwnPass, TakesValuesOfUniforms) {
    Session session = square_session({});
    const auto pass = std::make_shared<ShaderPass>(
        "body",
        "uniform vec3 u_color;\nuniform float u_factor;\nlayout(location = 0) out vec4 o_color;\n"
        "void main() { o_color = vec4(u_factor * u_color, 1.0); }",
        Blend::replace);
    pass->shader.set("u_color", Vec3(0.25f, 0.5f, 1));
    pass->shader.set("u_factor", 0.5f);
    pass->shader.set("u_none", 1);
    session.add_pass("own", Stage::light, pass);
    EXPECT_EQ(middle_of(render_linear(session)), Vec4(0.125f, 0.25f, 0.5f, 1));
    const uint64_t revision = pass->revision(), version = session.picture_version();
    pass->shader.set("u_factor", 0.5f);
    EXPECT_EQ(pass->revision(), revision);
    EXPECT_EQ(session.picture_version(), version);
    pass->shader.set("u_factor", 1.0f);
    EXPECT_NE(pass->revision(), revision);
    EXPECT_GT(session.picture_version(), version);
    EXPECT_EQ(middle_of(render_linear(session)), Vec4(0.25f, 0.5f, 1, 1));
}

// What is drawn past the content's edges belongs to the picture too, also on a background that has no
// radiance.
TEST(OwnPass, DrawsWhereNothingIs) {
    Scene scene;
    scene.show(facing_square(0.1f), "square");
    Session session = plain_session(scene, side);
    look_from(session, Vec3d(0, 0, 5));
    for (const int samples : {1, 4})
        for (const Stage stage : {Stage::light, Stage::overlay}) {
            session.add_pass("own", stage, pass_of("o_color = vec4(0.0, 1.0, 0.0, 1.0);"));
            const Image picture = session.render({std::nullopt, samples});
            EXPECT_EQ(picture.at<uint8_t>(0, 0)[1], 255) << samples;
            EXPECT_EQ(picture.at<uint8_t>(0, 0)[3], 255) << samples;
        }
}

TEST(OwnPass, IsNotForLayers) {
    Session session = square_session({});
    const Vec4 before = middle_of(session.render_layers({"albedo"}).at("albedo"));
    session.add_pass("own", Stage::light, pass_of("o_color = vec4(1.0);"));
    session.render();
    EXPECT_EQ(middle_of(session.render_layers({"albedo"}).at("albedo")), before);
}

/// Leaves OpenGL in a state that would spoil whatever comes after.
class RudePass : public Pass {
  public:
    void draw(const PassInput& input) override {
        input.bind();
        glEnable(GL_SCISSOR_TEST);
        glScissor(0, 0, 1, 1);
        glEnable(GL_CULL_FACE);
        glCullFace(GL_FRONT_AND_BACK);
        glEnable(GL_BLEND);
        glBlendFunc(GL_ZERO, GL_ZERO);
        glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
        glDepthMask(GL_FALSE);
        glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
        glBindVertexArray(0);
        if (fails) throw std::runtime_error("not today");
    }
    bool fails = false;
};

TEST(OwnPass, FailsUnderItsNameAndLeavesTheSessionUsable) {
    Session session = square_session({"void surface(inout Surface s) { s.emission = vec3(0.5); }"});
    const Image before = session.render();
    const auto pass = std::make_shared<RudePass>();
    session.add_pass("rude", Stage::overlay, pass);
    pass->fails = true;
    try {
        session.render();
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()), "pass 'rude': not today");
    }
    pass->fails = false;
    for (int times = 0; times < 2; ++times)
        EXPECT_EQ(session.render().at<uint8_t>(3, 3)[0], before.at<uint8_t>(3, 3)[0]);
    EXPECT_THROW(session.remove_pass("ruse"), NameError);
    EXPECT_THROW(session.add_pass("none", Stage::light, nullptr), ArgumentError);
}

/// Leaves something behind, and draws nothing.
class LeavingPass : public Pass {
  public:
    explicit LeavingPass(std::function<void()> leave) : leave_(std::move(leave)) {}
    void draw(const PassInput&) override { leave_(); }

  private:
    std::function<void()> leave_;
};

/// A session of blended spheres by OpenGL, which asks whether a layer has drawn anything.
Session blended_session(Stage stage, std::function<void()> leave) {
    Scene scene;
    Material glass;
    glass.opacity = 0.5f;
    for (const double z : {0.0, 0.5}) {
        Mesh sphere = make_sphere(1, 16);
        sphere.set_material(glass);
        sphere.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, z)));
        scene.show(sphere, z > 0 ? "near" : "far");
    }
    Session session = plain_session(scene, side);
    session.settings().image.size = Vec2i(side + 1, side - 1);  // rows that no alignment above 1 divides
    session.use_device(DrawDevice::gl);
    look_from(session, Vec3d(0, 0, 5));
    session.add_pass("leaving", stage, std::make_shared<LeavingPass>(std::move(leave)));
    return session;
}

/// The picture after the pass has been drawn, and the same with a texture that is uploaded then.
std::vector<Image> pictures_after(Stage stage, const std::function<void()>& leave) {
    Session session = blended_session(stage, leave);
    std::vector<Image> pictures = {session.render(), session.render()};
    auto texels = std::make_shared<Image>(33, 17, 3, PixelType::u8);
    for (size_t i = 0; i < texels->bytes().size(); ++i) texels->bytes()[i] = std::byte(i * 7);
    Material material;
    material.base_color_texture.image = texels;
    session.scene().show(facing_square(10, material), "square");
    pictures.push_back(session.render());
    return pictures;
}

void expect_nothing_left(const std::function<void()>& leave) {
    for (const Stage stage : {Stage::light, Stage::overlay, Stage::picture}) {
        const std::vector<Image> expected = pictures_after(stage, [] {}), got = pictures_after(stage, leave);
        for (size_t i = 0; i < expected.size(); ++i)
            EXPECT_TRUE(std::ranges::equal(got[i].bytes(), expected[i].bytes()))
                << "picture " << i << ", stage " << int(stage);
    }
}

// How rows of pixels lie in memory: the library's own arrays have neither gaps nor room for them.
TEST(OwnPass, MayLeaveAnyLayoutOfPixels) {
    expect_nothing_left([] {
        glPixelStorei(GL_PACK_ALIGNMENT, 8);
        glPixelStorei(GL_PACK_ROW_LENGTH, 4096);
        for (const GLenum parameter : {GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_PACK_SWAP_BYTES})
            glPixelStorei(parameter, 1);
    });
    expect_nothing_left([] {
        glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
        for (const GLenum parameter : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT})
            glPixelStorei(parameter, 4096);
        for (const GLenum parameter :
             {GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES})
            glPixelStorei(parameter, 1);
    });
}

TEST(OwnPass, MayLeaveAQueryOpen) {
    for (const GLenum target :
         {GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED_CONSERVATIVE}) {
        SCOPED_TRACE(fmt::format("0x{:x}", target));
        expect_nothing_left([target] {
            GLuint query = 0;
            glGenQueries(1, &query);
            glBeginQuery(target, query);
        });
    }
}

// The outer picture is half drawn: of the same session nothing else can be drawn then, and it is not spoilt.
TEST(OwnPass, DrawsNoOtherPictureOfItsSession) {
    Session session = blended_session(Stage::overlay, [] {}), other = blended_session(Stage::light, [] {});
    const Image expected = session.render(), of_other = other.render();
    int calls = 0;
    const auto draw_others = [&] {
        ++calls;
        EXPECT_THROW(session.render({Vec2i(8, 8), 1}), ArgumentError);
        EXPECT_THROW(session.draw_frame(), ArgumentError);
        EXPECT_THROW(session.refine(), ArgumentError);
        EXPECT_THROW(session.render_layers({"depth"}), ArgumentError);
        EXPECT_THROW(session.pick(Vec2d(3, 3)), ArgumentError);
        EXPECT_THROW(session.beside().render(), ArgumentError) << "by the same device";
        EXPECT_TRUE(std::ranges::equal(other.render().bytes(), of_other.bytes()));
    };
    for (const Stage stage : {Stage::light, Stage::overlay, Stage::picture}) {
        session.add_pass("leaving", stage, std::make_shared<LeavingPass>(draw_others));
        EXPECT_TRUE(std::ranges::equal(session.render().bytes(), expected.bytes())) << int(stage);
        EXPECT_GT(std::exchange(calls, 0), 0);
        while (session.refine().frames < session.settings().image.samples) continue;
        EXPECT_GT(std::exchange(calls, 0), 0);
    }
    session.add_pass("leaving", Stage::light, std::make_shared<LeavingPass>([&] { session.render(); }));
    try {
        session.render();
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("pass 'leaving': this viewer is drawing"),
                  std::string::npos);
    }
    session.remove_pass("leaving");
    EXPECT_NO_THROW(session.render());
}

// The framebuffer that a pass is called with is its own.
TEST(OwnPass, MayLeaveItsFramebufferWithoutTargets) {
    expect_nothing_left([] { glDrawBuffer(GL_NONE); });
}

TEST(OwnPass, OfAFileIsReadAgainWhenItChanges) {
    ShaderFile file;
    const std::string head = "layout(location = 0) out vec4 o_color;\nvoid main() {\n";
    file.write(head + "o_color = vec4(1.0, 0.0, 0.0, 1.0); }");
    Session session = square_session({});
    session.add_pass("own", Stage::overlay, std::make_shared<ShaderPass>(file.path()));
    const auto first = [&] { return int(session.render().at<uint8_t>(3, 3)[0]); };
    EXPECT_EQ(first(), 255);
    const uint64_t version = session.picture_version();
    file.write(head + "o_color = vec4(nothing); }");
    EXPECT_GT(session.picture_version(), version);
    const std::string message = message_of(session);
    EXPECT_NE(message.find("pass 'own'"), message.npos) << message;
    EXPECT_NE(message.find("own.glsl:3"), message.npos) << message;
    file.write(head + "o_color = vec4(0.0, 0.0, 0.0, 1.0); }");
    EXPECT_EQ(first(), 0);
    EXPECT_THROW(ShaderPass(fs::path("/tmp/easypbr/no/such.frag")), FileError);
}

}  // namespace
}  // namespace easypbr::app::own_pass_test
