// Sliders of settings, dragged by events, without a window.
#include <gtest/gtest.h>

#include "easypbr/geometry/primitives.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/scene/settings.h"

namespace easypbr::gui::settings_rows_test {
namespace {

using app::InputEvent;
using Kind = InputEvent::Kind;

const Vec2i size(1100, 800);

class SettingsRows : public testing::Test {
  protected:
    SettingsRows() : session_(ball_scene()) {
        session_.settings().image.samples = 1;
        for (int i = 0; i < 100 && (view_.is_busy() || i < 3); ++i) step();
    }
    static Scene ball_scene() {
        Scene scene;
        scene.show(make_sphere(1, 32), "ball");
        return scene;
    }
    void step(const std::vector<InputEvent>& events = {}) { view_.update(events, size, 1, 0.05); }
    void send(Kind kind, Vec2d position) {
        InputEvent event;
        event.kind = kind;
        event.position = position;
        step({event});
        step();
    }

    app::Session session_;
    LiveView view_{session_};
};

// The range is 0.01 to 1; the float that is nearest to 0.01 lies below it.
TEST_F(SettingsRows, ASliderReachesBothEndsOfItsRange) {
    const float& falloff = session_.settings().ssao.falloff;
    ASSERT_TRUE(view_.places().contains("ssao.falloff"));
    const Vec2d at = view_.places().at("ssao.falloff").center();
    send(Kind::move, at);
    send(Kind::press, at);
    send(Kind::move, Vec2d(1, at.y()));
    EXPECT_EQ(falloff, 0.01f);
    send(Kind::move, Vec2d(size.x() - 1, at.y()));
    EXPECT_EQ(falloff, 1);
    send(Kind::move, Vec2d(1, at.y()));
    send(Kind::release, Vec2d(1, at.y()));
    EXPECT_EQ(falloff, 0.01f);
    EXPECT_TRUE(view_.drawing().notifications().list().empty());
}

}  // namespace
}  // namespace easypbr::gui::settings_rows_test
