// A session whose pictures change their size draws what a new one does: nothing is left of targets that were
// replaced.
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::resized_pictures_test {
namespace {

struct Case {
    std::string name;
    std::function<void(Settings&)> change;
    bool layered = false;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}

Material veil() {
    Material material;
    material.opacity = 0.5f;
    material.alpha_mode = AlphaMode::blend;
    return material;
}

Scene scene_of(const Case& c) {
    Scene scene;
    scene.show(make_sphere(0.7, 24), "ball");
    if (!c.layered) return scene;
    Mesh pane = facing_square(0.5f, veil());
    pane.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0.3, 0, 1)));
    scene.show(pane, "pane");
    return scene;
}

app::Session session_of(const Case& c, const Scene& scene) {
    app::Session session = plain_session(scene);
    session.settings().lights.key.enabled = true;
    look_from(session, Vec3d(1, 1, 4));
    session.use_device(DrawDevice::gl);
    session.allow_native_geometry(false);
    session.allow_native_shading(false);
    c.change(session.settings());
    return session;
}

Image picture(app::Session& session, Vec2i size) {
    session.settings().image.size = size;
    return session.render();
}

class ResizedPictures : public testing::TestWithParam<Case> {};

TEST_P(ResizedPictures, AreThoseOfANewSession) {
    const Case& c = GetParam();
    const Scene scene = scene_of(c);
    app::Session kept = session_of(c, scene);
    // A frame without what is looked at lies between: whoever keeps its own targets keeps them through it.
    app::Session other = session_of({"", [](Settings&) {}}, scene);
    const Settings with = kept.settings(), without = other.settings();
    for (int round = 0; round < 3; ++round)
        for (const Vec2i& size : {Vec2i(64, 48), Vec2i(48, 64), Vec2i(80, 80)}) {
            kept.settings() = without;
            if (c.layered) kept.scene().hide("pane");
            picture(kept, size);
            kept.settings() = with;
            if (c.layered) kept.scene().show(scene_of(c).get("pane"), "pane");
            for (const Vec2i& shown : {size, Vec2i(64, 48)}) {
                app::Session fresh = session_of(c, scene_of(c));
                const Image a = picture(kept, shown), b = picture(fresh, shown);
                EXPECT_TRUE(std::ranges::equal(a.bytes(), b.bytes()))
                    << shown.x() << 'x' << shown.y() << ", round " << round;
            }
        }
}

const std::vector<Case> cases = {
    {"outlined", [](Settings& s) { s.outline.enabled = true; }},
    {"lines", [](Settings& s) { s.style.show_wireframe = true; }},
    {"layers", [](Settings&) {}, true},
    {"lines_and_layers", [](Settings& s) { s.style.show_wireframe = true; }, true},
    {"caught",
     [](Settings& s) {
         s.shadows.enabled = true;
         s.ground.mode = GroundMode::shadow;
     }},
};

INSTANTIATE_TEST_SUITE_P(All, ResizedPictures, testing::ValuesIn(cases),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace easypbr::render::resized_pictures_test
