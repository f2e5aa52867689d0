// Session::picture_version() infers again only where something has changed: nothing that is drawn may be
// overlooked.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/app/custom_pass.h"
#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::picture_version_test {
namespace {

namespace fs = std::filesystem;

class TextureFile {
  public:
    TextureFile() { io::save_image(Image(2, 2, 3, PixelType::u8), path_); }
    ~TextureFile() { fs::remove(path_); }
    std::string name() const { return path_.string(); }

  private:
    fs::path path_ = fs::temp_directory_path() / ("easypbr_version_" + std::to_string(::getpid()) + ".png");
};

Session drawn_session() {
    Scene scene;
    scene.show(make_sphere(1, 8), "sphere");
    scene.show(make_sphere(1, 8), "hidden");
    scene.hide("hidden");
    scene.set_light("lamp", {});
    Session session(scene);
    session.settings().image.size = Vec2i(32, 24);
    session.settings().image.samples = 1;
    session.settings().annotation.colorbar = false;
    session.render();
    return session;
}

TEST(PictureVersion, RisesWithWhateverIsDrawn) {
    using Change = std::function<void(Session&)>;
    const TextureFile texture;
    const auto tint = std::make_shared<ShaderPass>("tint",
                                                   "uniform float u_part;\nlayout(location = 0) out vec4 "
                                                   "o_color;\nvoid main() { o_color = vec4(u_part); }");
    const std::vector<std::pair<const char*, Change>> changes = {
        {"number", [](Session& s) { s.settings().bloom.intensity = 0.3f; }},
        {"text", [](Session& s) { s.settings().annotation.title = "depth"; }},
        {"override", [](Session& s) { s.settings().material.roughness = 0.9f; }},
        {"pinned", [](Session& s) { s.settings().camera.target = Vec3d(0, 0.5, 0); }},
        {"released", [](Session& s) { s.settings().camera.position = Vec3d(0, 0, 9); }},
        {"unlatched",
         [](Session& s) {
             s.settings().camera.margin = 0.4f;
             s.refit();
         }},
        {"pose",
         [](Session& s) {
             Mesh mesh = s.scene().get("sphere");
             mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0.1, 0, 0)));
         }},
        {"material",
         [](Session& s) {
             Material metal;
             metal.metallic = 1;
             s.scene().get("sphere").set_material(metal);
         }},
        {"shown", [](Session& s) { s.scene().hide("hidden", false); }},
        {"removed", [](Session& s) { s.scene().remove("sphere"); }},
        {"light",
         [](Session& s) {
             Light light = s.scene().light("lamp");
             light.intensity = 7;
             s.scene().set_light("lamp", light);
         }},
        {"no light", [](Session& s) { s.scene().remove_light("lamp"); }},
        {"environment",
         [](Session& s) {
             Image image(8, 4, 3, PixelType::f32);
             image.pixels<float>()[0] = 3;
             s.scene().set_environment(Environment(image));
         }},
        {"pass", [](Session& s) { s.remove_pass("tint"); }},
        {"uniform", [&](Session&) { tint->shader.set("u_part", 0.5f); }},
        {"texture", [&](Session& s) { s.settings().material.base_color_texture = texture.name(); }},
        {"background", [](Session& s) { s.set_background(Image(4, 4, 3, PixelType::u8)); }},
    };
    for (const auto& [name, change] : changes) {
        Session session = drawn_session();
        session.add_pass("tint", Stage::overlay, tint);
        const uint64_t before = session.picture_version();
        EXPECT_EQ(session.picture_version(), before) << name;
        change(session);
        const uint64_t now = session.picture_version();
        EXPECT_GT(now, before) << name;
        EXPECT_EQ(session.picture_version(), now) << name;
    }
}

TEST(PictureVersion, StaysWhenWhatWasInferredIsLatched) {
    Scene scene;
    scene.show(make_sphere(1, 8), "sphere");
    scene.set_light("lamp", {});
    Session session(scene);
    const Vec2i size(32, 24);
    const uint64_t before = session.picture_version(size);
    session.render({size, 1});
    EXPECT_TRUE(session.settings().camera.position.value());
    EXPECT_EQ(session.picture_version(size), before);
    EXPECT_GT(session.picture_version(Vec2i(24, 32)), before);
}

// An automatic camera that is not latched yet leaves them free.
TEST(PictureVersion, RisesWithInsets) {
    Scene scene;
    scene.show(make_sphere(1, 8), "sphere");
    Session session(scene);
    const uint64_t before = session.picture_version(Vec2i(32, 24));
    session.set_insets({.top = 0.4});
    EXPECT_GT(session.picture_version(Vec2i(32, 24)), before);
}

// What cannot be drawn throws each time it is asked for, also after a picture that could be.
TEST(PictureVersion, ThrowsAsLongAsSettingsAreWrong) {
    Session session = drawn_session();
    const uint64_t before = session.picture_version();
    session.settings().bloom.intensity = -1;
    EXPECT_THROW(session.picture_version(), ArgumentError);
    EXPECT_THROW(session.picture_version(), ArgumentError);
    session.settings().bloom.intensity = Settings{}.bloom.intensity;
    EXPECT_EQ(session.picture_version(), before);
}

}  // namespace
}  // namespace easypbr::app::picture_version_test
