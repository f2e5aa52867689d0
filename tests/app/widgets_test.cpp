// Panels of a program's own, drawn by a front end that knows no GUI library.
#include "easypbr/app/widgets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "easypbr/app/user_panels.h"
#include "easypbr/core/error.h"

namespace easypbr::app::widgets_test {
namespace {

/// Writes down what it is asked for; the person behind it moves every slider to its upper end.
class WrittenWidgets final : public Widgets {
  public:
    std::vector<std::string> lines;

    void text(const std::string& text) override { lines.push_back(text); }
    void separator() override { lines.emplace_back("--"); }
    void same_line() override {}
    bool section(const std::string& title, bool) override { return lines.push_back(title), true; }
    bool button(const std::string& name) override { return lines.push_back(name), true; }
    bool checkbox(const std::string& name, bool& value) override {
        lines.push_back(name);
        value = !value;
        return true;
    }
    bool text_field(const std::string& name, std::string&) override { return lines.push_back(name), false; }

  private:
    bool draw_slider(const std::string& name, double& value, double, double high) override {
        lines.push_back(name);
        value = high;
        return true;
    }
    bool draw_slider(const std::string& name, int& value, int, int high) override {
        lines.push_back(name);
        value = high;
        return true;
    }
    bool draw_number(const std::string& name, double&) override { return lines.push_back(name), false; }
    bool draw_combo(const std::string& name, std::string& value,
                    const std::vector<std::string>& choices) override {
        lines.push_back(name);
        value = choices.back();
        return true;
    }
    bool draw_color(const std::string& name, Vec3&) override { return lines.push_back(name), false; }
    void draw_plot(const std::string& name, std::span<const float>, const Vec2& range) override {
        lines.push_back(name + " " + std::to_string(int(range.x())) + " " + std::to_string(int(range.y())));
    }
    void draw_progress(double fraction, const std::string&) override {
        lines.push_back(std::to_string(int(100 * fraction)));
    }
};

TEST(UserPanelsTest, AreDrawnByAnyFrontEnd) {
    UserPanels panels;
    double rate = 0;
    int count = 1;
    bool on = false;
    std::string choice = "near";
    panels.add("Training", [&](Widgets& ui) {
        ui.text("hello");
        EXPECT_TRUE(ui.slider("rate", rate, 0, 0.5));
        ui.slider("count", count, 0, 7);
        ui.checkbox("on", on);
        ui.combo("choice", choice, {"near", "far"});
        ui.progress(7);
    });
    WrittenWidgets widgets;
    EXPECT_EQ(panels.call("Training", widgets), "");
    EXPECT_EQ(widgets.lines, (std::vector<std::string>{"hello", "rate", "count", "on", "choice", "100"}));
    EXPECT_EQ(rate, 0.5);
    EXPECT_EQ(count, 7);
    EXPECT_TRUE(on);
    EXPECT_EQ(choice, "far");
    EXPECT_EQ(panels.call("no such panel", widgets), "");
}

TEST(UserPanelsTest, KeepWhatTheirFunctionsThrow) {
    UserPanels panels;
    WrittenWidgets widgets;
    panels.add("Broken", [](Widgets&) { throw ArgumentError("oh no"); });
    const uint64_t first = panels.revision("Broken");
    EXPECT_EQ(panels.call("Broken", widgets), "oh no");
    EXPECT_EQ(panels.errors().at("Broken"), "oh no");
    panels.add("Broken", [](Widgets&) {});
    EXPECT_GT(panels.revision("Broken"), first);
    EXPECT_EQ(panels.call("Broken", widgets), "");
    EXPECT_EQ(panels.errors().at("Broken"), "");
    // A function may remove its own panel.
    panels.add("Once", [&](Widgets&) { panels.remove("Once"); });
    EXPECT_EQ(panels.call("Once", widgets), "");
    EXPECT_EQ(panels.names(), std::vector<std::string>{"Broken"});
    EXPECT_EQ(panels.revision("Once"), 0u);
    EXPECT_THROW(panels.remove("Brokem"), NameError);
    EXPECT_THROW(panels.add("", [](Widgets&) {}), ArgumentError);
    EXPECT_THROW(panels.add("x", nullptr), ArgumentError);
}

TEST(WidgetsTest, RefuseWhatCannotBeShownBeforeAFrontEndIsAsked) {
    WrittenWidgets ui;
    double nan = std::nan(""), number = 1;
    int whole = 0;
    std::string text;
    Vec3 color(0, nanf(""), 0);
    EXPECT_THROW(ui.slider("a", nan, 0, 1), ArgumentError);
    EXPECT_THROW(ui.slider("b", number, 1, 0), ArgumentError);
    EXPECT_THROW(ui.slider("c", number, 0, HUGE_VAL), ArgumentError);
    EXPECT_THROW(ui.slider("d", whole, 0, 2000000000), ArgumentError);
    EXPECT_THROW(ui.number("e", nan), ArgumentError);
    EXPECT_THROW(ui.combo("f", text, {}), ArgumentError);
    EXPECT_THROW(ui.color("g", color), ArgumentError);
    EXPECT_THROW(ui.plot("h", {}, Vec2(1, 1)), ArgumentError);
    EXPECT_THROW(ui.progress(nan), ArgumentError);
    EXPECT_TRUE(ui.lines.empty());
}

// The range of a plot is what occurs, gaps left out; a single value lies in the middle.
TEST(WidgetsTest, PlotsShowWhatOccurs) {
    WrittenWidgets ui;
    const float values[] = {3, std::nanf(""), HUGE_VALF, 9}, one[] = {5.5f};
    ui.plot("curve", values);
    ui.plot("one", one);
    ui.plot("nothing", {});
    ui.plot("given", values, Vec2(-2, 20));
    EXPECT_EQ(ui.lines, (std::vector<std::string>{"curve 3 9", "one 5 6", "nothing 0 1", "given -2 20"}));
}

}  // namespace
}  // namespace easypbr::app::widgets_test
