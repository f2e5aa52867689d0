// Keys that are held, and input that comes at once after a slow frame, without a window.
#include <gtest/gtest.h>

#include "easypbr/app/user_panels.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/scene/settings.h"

namespace easypbr::gui::input_test {
namespace {

using app::InputEvent;
using Kind = InputEvent::Kind;
namespace k = app::key;

const Vec2i size(900, 600);

class Input : public testing::Test {
  protected:
    Input() : session_(box_scene()) {
        session_.settings().image.samples = 1;
        session_.set_view_point({Camera::look_at(Vec3d(0, 0, 6), Vec3d(0, 0, 0)), Vec3d(0, 0, 0)});
        settle();
    }

    static Scene box_scene() {
        Scene scene;
        scene.show(make_box({1, 1, 1}), "box");
        return scene;
    }
    void step(const std::vector<InputEvent>& events = {}, double seconds = 0.02) {
        view_.update(events, size, 1, seconds);
    }
    void settle() {
        step();
        for (int i = 0; i < 100 && view_.is_busy(); ++i) step();
        EXPECT_FALSE(view_.is_busy());
    }
    static InputEvent at(Kind kind, Vec2d position) {
        InputEvent event;
        event.kind = kind;
        event.position = position;
        return event;
    }
    static InputEvent key(int code, bool repeat = false, Kind kind = Kind::key_down) {
        InputEvent event;
        event.kind = kind;
        event.key = code;
        event.repeat = repeat;
        return event;
    }
    static InputEvent up(int code) { return key(code, false, Kind::key_up); }
    static InputEvent text(char letter, bool repeat = false) {
        InputEvent event;
        event.kind = Kind::text;
        event.code = uint32_t(letter);
        event.repeat = repeat;
        return event;
    }
    Vec3d camera() { return session_.view_point(size).camera.position(); }

    app::Session session_;
    LiveView view_{session_};
};

TEST_F(Input, AKeyThatIsHeldActsOnce) {
    // An even number of repetitions and an odd one.
    for (const int repetitions : {2, 3}) {
        const PanelLayout before = view_.state().panels;
        std::vector<InputEvent> events = {key('H'), key(k::f1), key('K'), text('?')};
        for (int i = 0; i < repetitions; ++i)
            for (const InputEvent& event :
                 {key('H', true), key(k::f1, true), key('K', true), text('?', true)})
                events.push_back(event);
        step(events);
        EXPECT_NE(view_.state().panels.shown, before.shown);
        EXPECT_NE(view_.state().panels.open[0], before.open[0]);
        EXPECT_NE(view_.state().panels.keys, before.keys);
        step({up('H'), up(k::f1), up('K')});
    }
    EXPECT_EQ(view_.drawing().path().editor.keys().size(), 2u);
}

TEST_F(Input, EscapeThatIsHeldClosesTheListAndNotTheWindow) {
    step({text('?')});
    ASSERT_TRUE(view_.state().panels.keys);
    step({key(k::escape)});
    step({key(k::escape, true)});
    step({key(k::escape, true), up(k::escape)});
    EXPECT_FALSE(view_.state().panels.keys);
    EXPECT_FALSE(view_.wants_to_close());
    step({key(k::escape)});
    EXPECT_TRUE(view_.wants_to_close());
}

TEST_F(Input, UndoRepeats) {
    for (const int samples : {2, 3}) {
        session_.settings().image.samples = samples;
        settle();
    }
    InputEvent undo = key('Z'), again = key('Z', true);
    undo.control = again.control = true;
    step({undo, again});
    EXPECT_EQ(session_.settings().image.samples, 1);
}

TEST_F(Input, NothingIsHoveredWhenThePointerHasLeft) {
    step({at(Kind::move, {450, 300})});
    settle();
    ASSERT_TRUE(view_.drawing().picture().hovered());
    // The position of the event says nothing.
    step({at(Kind::leave, {450, 300})});
    settle();
    EXPECT_FALSE(view_.drawing().picture().hovered());
    // Keys come meanwhile: they move no pointer.
    InputEvent letter = key('J');
    letter.position = {450, 300};
    step({letter});
    settle();
    EXPECT_FALSE(view_.drawing().picture().hovered());
    step({at(Kind::move, {450, 300})});
    settle();
    EXPECT_TRUE(view_.drawing().picture().hovered());
}

class HandleInput : public Input {
  protected:
    HandleInput() {
        view_.drawing().selection().object = "box";
        settle();
    }
    Vec3d moved() { return session_.scene().get("box").T_parent_mesh().translation(); }
    /// What 60 pixels to the right are at the box.
    double sixty_pixels() {
        const Camera camera = session_.view_point(size).camera;
        return point_at(camera, {60, 0}, size, 6).x() - point_at(camera, {0, 0}, size, 6).x();
    }

    // The x handle goes 90 pixels to the right of the middle.
    const Vec2d on_{510, 300}, off_{480, 420}, by_{60, 0};
};

// After a slow frame the pointer has moved and a button is down before anything of it was drawn.
TEST_F(HandleInput, AHandleIsLookedForWhereTheButtonWentDown) {
    const Vec3d before = camera();
    step({at(Kind::move, off_)});
    step({at(Kind::move, on_), at(Kind::press, on_)});
    step({at(Kind::move, on_ + by_)});
    step({at(Kind::release, on_ + by_)});
    settle();
    EXPECT_NEAR(moved().x(), sixty_pixels(), 1e-6);  // positions of a few units, rounded to float once
    EXPECT_LT((camera() - before).norm(), 1e-12);
}

TEST_F(HandleInput, AButtonThatGoesDownBesideAHandleIsTheCameras) {
    const Vec3d before = camera();
    step({at(Kind::move, on_)});
    step({at(Kind::move, off_), at(Kind::press, off_)});
    step({at(Kind::move, off_ + by_)});
    step({at(Kind::release, off_ + by_)});
    EXPECT_EQ(moved(), Vec3d(0, 0, 0));
    EXPECT_GT((camera() - before).norm(), 0.5);
}

TEST_F(HandleInput, ADragThatIsOverWithinOneFrameEndsWhereTheButtonCameUp) {
    step({at(Kind::move, on_), at(Kind::press, on_), at(Kind::move, on_ + by_), at(Kind::release, on_ + by_),
          at(Kind::move, off_)});
    settle();
    EXPECT_NEAR(moved().x(), sixty_pixels(), 1e-6);  // positions of a few units, rounded to float once
    // No click: what is selected stays.
    EXPECT_EQ(view_.drawing().selection().object, "box");
}

TEST_F(HandleInput, EscapeTakesADragBack) {
    step({at(Kind::move, on_), at(Kind::press, on_)});
    step({at(Kind::move, on_ + by_)});
    ASSERT_GT(moved().x(), 0.1);
    step({key(k::escape), up(k::escape)});
    EXPECT_EQ(moved(), Vec3d(0, 0, 0));
    step({at(Kind::move, on_)});
    step({at(Kind::release, on_)});
    settle();
    EXPECT_EQ(moved(), Vec3d(0, 0, 0));
    EXPECT_FALSE(view_.wants_to_close());
    step({at(Kind::press, on_), at(Kind::move, on_ + by_), at(Kind::release, on_ + by_)});
    EXPECT_GT(moved().x(), 0.1);
}

class FieldInput : public Input {
  protected:
    FieldInput() {
        view_.add_panel("Training", [this](app::Widgets& ui) {
            ui.text_field("name", name_);
            ui.checkbox("first", first_);
            ui.checkbox("second", second_);
            ui.slider("rate", rate_, 0, 1);
        });
        settle();
        field_ = place("name");
    }
    Vec2d place(const std::string& widget) {
        const auto found = view_.places().find("Training/" + widget);
        EXPECT_NE(found, view_.places().end()) << widget;
        return found == view_.places().end() ? Vec2d(0, 0) : Vec2d(found->second.center());
    }
    void add_click(std::vector<InputEvent>& events, Vec2d where, bool control = false) {
        for (const Kind kind : {Kind::move, Kind::press, Kind::release}) {
            events.push_back(at(kind, where));
            events.back().control = control;
        }
    }
    void click(Vec2d where) {
        step({at(Kind::move, where)});
        step({at(Kind::press, where)});
        step({at(Kind::release, where)});
        settle();
    }

    std::string name_;
    bool first_ = false, second_ = false;
    double rate_ = 0.75;
    Vec2d field_{0, 0};
    const Vec2d background_{450, 560};
};

TEST_F(FieldInput, AFlightEndsWithItsKeyThoughAFieldIsTypedInto) {
    const Vec3d before = camera();
    step({key('W')});
    step();
    EXPECT_LT(camera().z(), before.z());
    step({at(Kind::move, field_), at(Kind::press, field_), at(Kind::release, field_)});
    step();
    step({up('W')});
    const Vec3d after = camera();
    settle();
    EXPECT_EQ(camera(), after);
    // And a key that goes down for the field never flies, whoever has it when it repeats and comes up.
    step({key('W'), text('w')});
    step();
    EXPECT_EQ(name_, "w");
    step({at(Kind::move, background_), at(Kind::press, background_), at(Kind::release, background_)});
    step();
    step({key('W', true)});
    step({up('W')});
    settle();
    EXPECT_EQ(camera(), after);
}

TEST_F(FieldInput, HandlersSeeAKeyComeUpThatTheySawGoDown) {
    std::vector<Kind> seen;
    view_.on_event([&](const InputEvent& event) {
        if (event.key == 'P') seen.push_back(event.kind);
        return false;
    });
    step({key('P')});
    click(field_);
    step({up('P')});
    EXPECT_EQ(seen, (std::vector<Kind>{Kind::key_down, Kind::key_up}));
    step({key('P'), up('P')});
    EXPECT_EQ(seen.size(), 2u);
}

TEST_F(FieldInput, LettersAfterAClickIntoAFieldAreItsOwnWithinOneFrame) {
    std::vector<InputEvent> events;
    add_click(events, field_);
    for (const InputEvent& event : {key('H'), text('h'), up('H'), key('K'), text('k'), up('K')})
        events.push_back(event);
    step(events);
    settle();
    EXPECT_EQ(name_, "hk");
    EXPECT_TRUE(view_.state().panels.shown);
    EXPECT_TRUE(view_.drawing().path().editor.keys().empty());
    // And after a click beside it they are the view's again.
    events.clear();
    add_click(events, background_);
    events.push_back(key('H'));
    step(events);
    settle();
    EXPECT_FALSE(view_.state().panels.shown);
    EXPECT_EQ(name_, "hk");
}

TEST_F(FieldInput, AClickCountsWhereItWasThoughThePointerHasMovedOn) {
    std::vector<InputEvent> events;
    add_click(events, place("first"));
    add_click(events, place("second"));
    events.push_back(at(Kind::move, background_));
    step(events);
    settle();
    EXPECT_TRUE(first_);
    EXPECT_TRUE(second_);
}

TEST_F(FieldInput, ControlAndAClickEditASlidersNumberWithinOneFrame) {
    // With Control's own events, and without: it may have gone down before the window had the focus.
    for (const bool own : {true, false}) {
        std::vector<InputEvent> events;
        if (own) events.push_back(key(k::left_control));
        if (own) events.back().control = true;
        add_click(events, place("rate"), true);
        events.push_back(up(k::left_control));
        for (const InputEvent& event :
             {text('0'), text('.'), text(own ? '2' : '4'), key(k::enter), up(k::enter)})
            events.push_back(event);
        step(events);
        settle();
        EXPECT_NEAR(rate_, own ? 0.2 : 0.4, 1e-6);  // as written, through float at most
    }
}

}  // namespace
}  // namespace easypbr::gui::input_test
