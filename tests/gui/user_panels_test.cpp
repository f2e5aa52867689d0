// Panels and callbacks of users, driven by events, without a window.
#include "easypbr/app/user_panels.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/io/settings/presets.h"
#include "easypbr/scene/settings.h"

namespace easypbr::gui::user_panels_test {
namespace {

using app::InputEvent;
using Kind = InputEvent::Kind;

const Vec2i size(900, 600);

class UserPanel : public testing::Test {
  protected:
    UserPanel() : session_(box_scene()) { session_.settings().image.samples = 1; }

    static Scene box_scene() {
        Scene scene;
        scene.show(make_box({1, 1, 1}), "box");
        return scene;
    }
    void step(const std::vector<InputEvent>& events = {}) { view_.update(events, size, 1, 0.1); }
    void settle() {
        for (int i = 0; i < 5; ++i) step();
    }
    /// Left and right quarter of a widget's place, and its middle.
    Vec2d place(const std::string& name, double x = 0.5) {
        const auto found = view_.places().find(name);
        EXPECT_NE(found, view_.places().end()) << name;
        if (found == view_.places().end()) return {0, 0};
        const Vec2d low = found->second.min(), high = found->second.max();
        return {low.x() + x * (high.x() - low.x()), (low.y() + high.y()) / 2};
    }
    static InputEvent at(Kind kind, Vec2d position) {
        InputEvent event;
        event.kind = kind;
        event.position = position;
        return event;
    }
    void click(Vec2d where) {
        step({at(Kind::move, where)});
        step({at(Kind::press, where)});
        step({at(Kind::release, where)});
        step();
    }

    app::Session session_;
    LiveView view_{session_};
};

TEST_F(UserPanel, WhatItSetsIsTheProgramsAndNotUndone) {
    session_.settings().background.color = {1, 0, 0};
    settle();
    session_.settings().background.color = {0, 1, 0};
    settle();
    view_.add_panel("Light", [&](app::Widgets&) { session_.settings().tonemap.exposure_compensation = 2; });
    settle();
    view_.drawing().edits().undo();
    EXPECT_EQ(session_.settings().background.color, Vec3(1, 0, 0));
    EXPECT_EQ(session_.settings().tonemap.exposure_compensation, 2);
    EXPECT_FALSE(view_.drawing().edits().can_undo());
}

TEST_F(UserPanel, WidgetsTakeWhatIsClicked) {
    double rate = 0.1;
    int count = 3, clicks = 0;
    bool on = false;
    std::string choice = "near", name = "run";
    view_.add_panel("Training", [&](app::Widgets& ui) {
        ui.text("A paragraph");
        ui.slider("rate", rate, 0, 1);
        ui.slider("count", count, 0, 10);
        ui.checkbox("on", on);
        ui.combo("choice", choice, {"near", "far"});
        ui.text_field("name", name);
        clicks += ui.button("reset");
    });
    settle();
    click(place("Training/on"));
    click(place("Training/reset"));
    // A slider's grab is centred at the pointer; its travel is the width but for the grab's own.
    click(place("Training/rate"));
    click(place("Training/count", 0.98));
    EXPECT_TRUE(on);
    EXPECT_EQ(clicks, 1);
    EXPECT_NEAR(rate, 0.5, 0.01);
    EXPECT_EQ(count, 10);
    click(place("Training/choice"));
    settle();  // The list finds its place.
    click(place("Training/choice/far"));
    EXPECT_EQ(choice, "far");
    click(place("Training/name", 0.9));
    for (const char letter : {'s', '1'}) {
        InputEvent typed = at(Kind::text, place("Training/name"));
        typed.code = uint32_t(letter);
        step({typed});
    }
    EXPECT_EQ(name, "runs1");
}

// As a quick click of a mouse, a touch pad or a program comes: both events lie ready for one frame.
TEST_F(UserPanel, AClickThatIsOverWithinOneFrameCounts) {
    bool on = false;
    std::string choice = "near";
    view_.add_panel("Training", [&](app::Widgets& ui) {
        ui.checkbox("on", on);
        ui.combo("choice", choice, {"near", "far"});
    });
    settle();
    const auto quick_click = [&](Vec2d where) {
        step({at(Kind::move, where)});
        step({at(Kind::press, where), at(Kind::release, where)});
        settle();
    };
    quick_click(place("Training/on"));
    EXPECT_TRUE(on);
    quick_click(place("Training/on"));
    EXPECT_FALSE(on);
    quick_click(place("Training/choice"));
    quick_click(place("Training/choice/far"));
    EXPECT_EQ(choice, "far");
    const std::string preset = "Menu/preset " + io::preset_names().at(0);
    EXPECT_FALSE(view_.places().contains(preset));
    quick_click(place("Menu/preset"));
    EXPECT_TRUE(view_.places().contains(preset));
}

class UserField : public UserPanel {
  protected:
    UserField() {
        view_.add_panel("Training", [this](app::Widgets& ui) { ui.text_field("name", name_); });
        settle();
        where_ = place("Training/name", 0.9);
        click(where_);
    }
    void press(int key, bool control = false) {
        for (const Kind kind : {Kind::key_down, Kind::key_up}) {
            events_.push_back(at(kind, where_));
            events_.back().key = key;
            events_.back().control = control;
        }
    }
    void type(char letter) {
        events_.push_back(at(Kind::text, where_));
        events_.back().code = uint32_t(letter);
    }
    /// Everything comes within one frame.
    void send() {
        step(std::exchange(events_, {}));
        for (int i = 0; i < 50 && view_.is_busy(); ++i) step();
        EXPECT_FALSE(view_.is_busy());
    }

    std::string name_ = "abc";
    Vec2d where_;
    std::vector<InputEvent> events_;
};

// As while a frame takes long, or when a program types.
TEST_F(UserField, KeysThatAreOverWithinOneFrameCountInTheirOrder) {
    press(app::key::end);
    press(app::key::backspace);
    press(app::key::backspace);
    type('x');
    type('y');
    press(app::key::backspace);
    type('z');
    send();
    EXPECT_EQ(name_, "axz");
}

TEST_F(UserField, CopiesToTheClipboardOfTheViewAndPastesFromIt) {
    std::string held = "from outside";
    view_.drawing().clipboard() = {[&] { return held; }, [&](const std::string& text) { held = text; }};
    press('A', true);
    press('V', true);
    send();
    EXPECT_EQ(name_, "from outside");
    type('!');
    press('A', true);
    press('C', true);
    send();
    EXPECT_EQ(held, "from outside!");
    view_.drawing().clipboard().read = []() -> std::string {
        throw ContextError("no clipboard: it is gone");
    };
    press('V', true);
    send();
    EXPECT_EQ(name_, "from outside!");
    ASSERT_FALSE(view_.drawing().notifications().list().empty());
    EXPECT_EQ(view_.drawing().notifications().list().back().text, "no clipboard: it is gone");
}

TEST_F(UserPanel, EscapeClosesListsAndMenusBeforeTheWindow) {
    double rate = 0.1;
    std::string choice = "near";
    view_.add_panel("Training", [&](app::Widgets& ui) {
        ui.combo("choice", choice, {"near", "far"});
        ui.slider("rate", rate, 0, 1);
    });
    settle();
    InputEvent escape;
    escape.kind = Kind::key_down;
    escape.key = app::key::escape;
    const std::string preset = "Menu/preset " + io::preset_names().at(0);
    for (const auto& [opener, item] :
         {std::pair<std::string, std::string>("Training/choice", "Training/choice/far"),
          {"Menu/preset", preset}}) {
        click(place(opener));
        settle();
        EXPECT_TRUE(view_.places().contains(item));
        step({escape});
        settle();
        EXPECT_FALSE(view_.places().contains(item));
        EXPECT_FALSE(view_.wants_to_close()) << opener;
    }
    step({at(Kind::move, place("Training/rate"))});
    step({at(Kind::press, place("Training/rate"))});
    step({escape});
    EXPECT_FALSE(view_.wants_to_close()) << "the slider is held";
    step({at(Kind::release, place("Training/rate"))});
    settle();
    step({escape});
    EXPECT_TRUE(view_.wants_to_close());
}

// An error that leaves the panels is met again in each frame.
TEST_F(UserPanel, WhatFailsInEveryFrameIsToldOnceAndTheViewComesToRest) {
    int calls = 0;
    view_.state().own_menu = [&] {
        ++calls;
        throw ArgumentError("no such line");
    };
    settle();
    click({15, 8});  // the first menu, View
    for (int i = 0; i < 20; ++i) step();
    EXPECT_GT(calls, 2);
    ASSERT_EQ(view_.drawing().notifications().list().size(), 1u);
    EXPECT_EQ(view_.drawing().notifications().list()[0].text, "no such line");
    EXPECT_FALSE(view_.is_busy());
}

TEST_F(UserPanel, ShowsWhatItsFunctionThrowsAndGoesOn) {
    int calls = 0;
    view_.add_panel("Broken", [&](app::Widgets& ui) {
        ++calls;
        ui.section("open");
        ui.slider("empty", *std::make_unique<double>(0.5), 1, 1);
    });
    settle();
    EXPECT_GT(calls, 2);
    EXPECT_NE(view_.panels().errors().at("Broken").find("slider 'empty'"), std::string::npos);
    EXPECT_TRUE(view_.drawing().notifications().list().empty());
    view_.add_panel("Broken", [](app::Widgets& ui) { ui.text("mended"); });
    settle();
    EXPECT_EQ(view_.panels().errors().at("Broken"), "");
    view_.add_panel("Other", [](app::Widgets&) { throw 1; });
    settle();
    EXPECT_NE(view_.panels().errors().at("Other"), "");
}

TEST_F(UserPanel, IsCalledWhileNothingHappensButDrawnOnlyWhenItChanges) {
    int shown = 0;
    view_.add_panel("Counter", [&](app::Widgets& ui) { ui.text(std::to_string(shown)); });
    settle();
    EXPECT_FALSE(view_.update({}, size, 1, 0.1));
    shown = 1;
    EXPECT_TRUE(view_.update({}, size, 1, 0.1));
    EXPECT_FALSE(view_.update({}, size, 1, 0.1));
    view_.state().panels.shown = false;
    view_.touch();
    settle();
    shown = 2;
    EXPECT_FALSE(view_.update({}, size, 1, 0.1));
}

TEST_F(UserPanel, MayChangePanelsAndSceneButNotDrawItself) {
    std::string refused;
    view_.add_panel("Adds", [&](app::Widgets&) {
        view_.add_panel("Added", [](app::Widgets& ui) { ui.text("here"); });
        session_.render({Vec2i(32, 24), 1});
        try {
            view_.update({}, size, 1, 0);
        } catch (const ArgumentError& error) {
            refused = error.what();
        }
        view_.remove_panel("Adds");
    });
    settle();
    EXPECT_EQ(view_.panels().names(), std::vector<std::string>{"Added"});
    EXPECT_NE(refused.find("screenshot()"), std::string::npos);
}

TEST_F(UserPanel, MayUseAnotherViewThatWaitsForItsOwnTurn) {
    app::Session other_session(box_scene());
    other_session.settings().image.samples = 1;
    LiveView other(other_session);
    std::atomic<bool> inside = false, drawn = false;
    view_.add_panel("Waits", [&](app::Widgets&) {
        inside = true;
        while (!drawn) std::this_thread::yield();
    });
    std::thread thread([&] {
        while (!inside) std::this_thread::yield();
        other.finished_screen({200, 100});
        drawn = true;
    });
    step();
    thread.join();
    EXPECT_TRUE(drawn);
}

TEST_F(UserPanel, WrongUseIsRefused) {
    EXPECT_THROW(view_.add_panel("", [](app::Widgets&) {}), ArgumentError);
    EXPECT_THROW(view_.add_panel("x", nullptr), ArgumentError);
    EXPECT_THROW(view_.remove_panel("x"), NameError);
    EXPECT_THROW(view_.on_event(nullptr), ArgumentError);
}

TEST_F(UserPanel, WidgetsRefuseWhatCannotBeShown) {
    std::vector<std::string> refused;
    const auto expect_refused = [&](const std::function<void()>& use) {
        try {
            use();
            ADD_FAILURE();
        } catch (const ArgumentError& error) {
            refused.push_back(error.what());
        }
    };
    view_.add_panel("Bad", [&](app::Widgets& ui) {
        refused.clear();
        double nan = std::nan(""), number = 1;
        std::string text;
        int whole = 0;
        expect_refused([&] { ui.slider("a", nan, 0, 1); });
        expect_refused([&] { ui.slider("b", number, 1, 0); });
        expect_refused([&] { ui.slider("c", whole, 0, 2000000000); });
        expect_refused([&] { ui.number("d", nan); });
        expect_refused([&] { ui.combo("e", text, {}); });
        expect_refused([&] { ui.plot("f", {}, Vec2(1, 1)); });
        expect_refused([&] { ui.progress(nan); });
        const float values[] = {1, std::nanf(""), HUGE_VALF, 2};
        ui.plot("gaps", values);
        ui.plot("nothing", {});
    });
    settle();
    EXPECT_EQ(refused.size(), 7u);
    EXPECT_EQ(view_.panels().errors().at("Bad"), "");
}

TEST_F(UserPanel, HandlersSeeEventsBeforeTheViewDoes) {
    std::vector<Kind> seen;
    bool take = false;
    const int number = view_.on_event([&](const InputEvent& event) {
        seen.push_back(event.kind);
        return take;
    });
    step();
    ASSERT_EQ(seen, std::vector<Kind>{Kind::resize});
    InputEvent h;
    h.kind = Kind::key_down;
    h.key = 'H';
    step({h});
    EXPECT_FALSE(view_.state().panels.shown);
    take = true;
    step({h});
    EXPECT_FALSE(view_.state().panels.shown);
    InputEvent drop;
    drop.kind = Kind::drop;
    drop.paths = {"/nowhere.ply"};
    step({drop});
    EXPECT_TRUE(view_.drawing().notifications().list().empty());
    EXPECT_EQ(seen.size(), 4u);
    view_.remove_event_handler(number);
    step({h});
    EXPECT_TRUE(view_.state().panels.shown);
    // A click on a panel is the panel's.
    settle();
    seen.clear();
    view_.on_event([&](const InputEvent& event) {
        seen.push_back(event.kind);
        return false;
    });
    click({60, 60});
    EXPECT_TRUE(seen.empty());
    view_.on_event([](const InputEvent&) -> bool { throw ArgumentError("oh no"); });
    step({at(Kind::move, {450, 300})});
    step({at(Kind::move, {451, 300})});
    ASSERT_EQ(view_.drawing().notifications().list().size(), 1u);
    EXPECT_EQ(view_.drawing().notifications().list()[0].text, "oh no");
}

}  // namespace
}  // namespace easypbr::gui::user_panels_test
