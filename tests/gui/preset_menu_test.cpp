// The menu of presets, and back by undo.
#include <gtest/gtest.h>

#include "easypbr/geometry/primitives.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/scene/settings.h"

namespace easypbr::gui::preset_menu_test {
namespace {

using app::InputEvent;
using Kind = InputEvent::Kind;

const Vec2i size(1100, 800);

class PresetMenu : public testing::Test {
  protected:
    PresetMenu() : session_(ball_scene()) {
        session_.settings().image.samples = 1;
        settle();
    }
    static Scene ball_scene() {
        Scene scene;
        scene.show(make_sphere(1, 32), "ball");
        return scene;
    }
    void step(const std::vector<InputEvent>& events = {}) { view_.update(events, size, 1, 0.05); }
    void settle() {
        for (int i = 0; i < 100 && (view_.is_busy() || i < 3); ++i) step();
    }
    void click(const std::string& name) {
        const auto place = view_.places().find(name);
        ASSERT_NE(place, view_.places().end()) << name;
        const Vec2d at = place->second.center();
        for (const Kind kind : {Kind::move, Kind::press, Kind::release}) {
            InputEvent event;
            event.kind = kind;
            event.position = at;
            step({event});
        }
        settle();
    }
    void undo() {
        InputEvent event;
        event.kind = Kind::key_down;
        event.key = 'Z';
        event.control = true;
        step({event});
        settle();
    }

    app::Session session_;
    LiveView view_{session_};
};

}  // namespace

TEST_F(PresetMenu, ChangesTheLookAndIsUndone) {
    const Settings& settings = session_.settings();
    const Vec3 before = settings.background.color;
    const std::optional<Vec3d> position = settings.camera.position.value();
    ASSERT_TRUE(position);
    click("Menu/preset");
    click("Menu/preset paper");
    EXPECT_EQ(settings.background.color, Vec3(1, 1, 1));
    EXPECT_EQ(settings.ground.mode, GroundMode::shadow);
    EXPECT_EQ(settings.camera.position.value(), position) << "the camera stays";
    undo();
    EXPECT_EQ(settings.background.color, before);
    EXPECT_FALSE(settings.ground.mode.is_pinned());
}

}  // namespace easypbr::gui::preset_menu_test
