// Lights of the scene in the panel and by their handles, and back by undo.
#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/scene/light_table.h"
#include "easypbr/scene/settings.h"

namespace easypbr::gui::lights_test {
namespace {

using app::InputEvent;
using Kind = InputEvent::Kind;

const Vec2i size(1100, 800);

class LightsPanel : public testing::Test {
  protected:
    LightsPanel() : session_(ball_scene()) {
        session_.settings().image.samples = 1;
        session_.set_view_point({Camera::look_at(Vec3d(0, 0, 6), Vec3d(0, 0, 0)), Vec3d(0, 0, 0)});
        for (const Panel panel :
             {Panel::effects, Panel::environment, Panel::camera, Panel::channels, Panel::statistics})
            view_.state().panels.is_open(panel) = false;
        view_.state().panels.unfold.insert(Panel::lights);
        settle();
    }
    static Scene ball_scene() {
        Scene scene;
        scene.show(make_sphere(1, 32), "ball");
        Light lamp;
        lamp.position = {0, 1.5, 0};
        lamp.intensity = 4;
        scene.set_light("lamp", lamp);
        return scene;
    }
    void step(const std::vector<InputEvent>& events = {}) { view_.update(events, size, 1, 0.05); }
    void settle() {
        for (int i = 0; i < 100 && (view_.is_busy() || i < 3); ++i) step();
    }
    void pointer(Kind kind, const Vec2d& position) {
        InputEvent event;
        event.kind = kind;
        event.position = position;
        step({event});
    }
    void click(const std::string& name) {
        const auto place = view_.places().find(name);
        ASSERT_NE(place, view_.places().end()) << name;
        const Vec2d at = place->second.center();
        for (const Kind kind : {Kind::move, Kind::press, Kind::release}) pointer(kind, at);
        pointer(Kind::move, {550, 780});
        settle();
    }
    void key(int code) {
        InputEvent event;
        event.kind = Kind::key_down;
        event.key = code;
        event.control = true;
        step({event});
        settle();
    }
    Light lamp() { return session_.scene().light("lamp"); }

    app::Session session_;
    LiveView view_{session_};
};

TEST_F(LightsPanel, ChangesAreUndoneAndRedone) {
    click("Lights/lamp");
    const Light before = lamp();
    click("Lights/enabled lamp");
    EXPECT_FALSE(lamp().enabled);
    key('Z');
    EXPECT_EQ(lamp(), before);
    key('Y');
    EXPECT_FALSE(lamp().enabled);
    key('Z');
    // What the program does to it meanwhile stays, where undo has nothing to say.
    Light brighter = lamp();
    brighter.intensity = 9;
    session_.scene().set_light("lamp", brighter);
    settle();
    session_.settings().tonemap.exposure_compensation = 1;
    settle();
    key('Z');
    EXPECT_EQ(session_.settings().tonemap.exposure_compensation, 0);
    EXPECT_EQ(lamp().intensity, 9);
}

// A point light has no cone and a spot has one: the rows are those of the table.
TEST_F(LightsPanel, ShowsEveryFieldThatConcernsTheLight) {
    click("Lights/lamp");
    for (const LightType type : {LightType::point, LightType::spot, LightType::directional}) {
        Light light = lamp();
        light.type = type;
        session_.scene().set_light("lamp", light);
        settle();
        step();
        for (const LightField& field : light_fields())
            EXPECT_EQ(view_.places().contains("Lights/" + field.name + " lamp"), field.concerns(type))
                << field.name << ", " << int(type);
    }
}

TEST_F(LightsPanel, RemovingIsUndone) {
    click("Lights/lamp");
    const Light before = lamp();
    click("Lights/remove lamp");
    EXPECT_TRUE(session_.scene().light_names().empty());
    key('Z');
    ASSERT_EQ(session_.scene().light_names(), std::vector<std::string>{"lamp"});
    EXPECT_EQ(lamp(), before);
    key('Y');
    EXPECT_TRUE(session_.scene().light_names().empty());
}

TEST_F(LightsPanel, AddedLightsShineAreChosenAndUndone) {
    const Image before = session_.render({Vec2i(64, 48), 1});
    click("Lights/Add a light");
    click("Lights/Add a light");
    EXPECT_EQ(session_.scene().light_names(), (std::vector<std::string>{"lamp", "light", "light-2"}));
    EXPECT_EQ(view_.drawing().selection().light, "light-2");
    // Beside, above and before the ball, seen from 6 away: (3, 3, 3), 27 away from it by the square root.
    EXPECT_LT((session_.scene().light("light").position - Vec3d(3, 3, 3)).norm(), 1e-5);
    EXPECT_NEAR(session_.scene().light("light").intensity, 3 * 27, 1e-3);
    const Image lit = session_.render({Vec2i(64, 48), 1});
    EXPECT_GT(int(lit.at<uint8_t>(32, 20)[0]), int(before.at<uint8_t>(32, 20)[0]) + 5);
    key('Z');
    EXPECT_EQ(session_.scene().light_names(), (std::vector<std::string>{"lamp", "light"}));
    key('Z');
    EXPECT_EQ(session_.scene().light_names(), std::vector<std::string>{"lamp"});
    key('Y');
    EXPECT_EQ(session_.scene().light_names(), (std::vector<std::string>{"lamp", "light"}));
}

TEST_F(LightsPanel, AMoveByTheHandlesIsOneStep) {
    click("Lights/lamp");
    click("Lights/move lamp");
    EXPECT_EQ(view_.drawing().selection().light, "lamp");
    const Light before = lamp();
    const Vec2d at =
        pixel_of(session_.view_point(size).camera, before.position.cast<double>(), size).head<2>();
    const Vec2d from = at + Vec2d(60, 0);
    pointer(Kind::move, from);
    pointer(Kind::press, from);
    for (int i = 1; i <= 4; ++i) pointer(Kind::move, from + i * Vec2d(10, 0));
    pointer(Kind::release, from + Vec2d(40, 0));
    settle();
    EXPECT_GT(lamp().position.x(), 0.1f);
    EXPECT_NEAR(lamp().position.y(), 1.5, 1e-6);
    key('Z');
    EXPECT_EQ(lamp(), before);
}

TEST_F(LightsPanel, PanelsAreAsLargeAsTheyAreAskedToBe) {
    const auto width = [&] { return view_.places().at("Lights").sizes().x(); };
    const double plain = width();
    view_.set_panel_scale(1.5f);
    settle();
    EXPECT_NEAR(width(), 1.5 * plain, 2);  // whole pixels
    EXPECT_EQ(view_.state().screen.scale, 1.5f);
    for (const float bad : {0.4f, 5.0f, -1.0f, std::nanf("")})
        EXPECT_THROW(view_.set_panel_scale(bad), ArgumentError);
    EXPECT_EQ(view_.state().screen.panel_scale, 1.5f);
}

}  // namespace
}  // namespace easypbr::gui::lights_test
