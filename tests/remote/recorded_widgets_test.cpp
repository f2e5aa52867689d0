// A program's panel as data: what clients change comes in once, what is shown goes out.
#include "easypbr/remote/recorded_widgets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "easypbr/core/error.h"

namespace easypbr::remote::recorded_widgets_test {
namespace {

using nlohmann::json;

/// Calls a panel once; returns what is shown.
json shown(PanelMemory& memory, const app::PanelFunction& panel) {
    RecordedWidgets widgets(memory);
    panel(widgets);
    return widgets.take();
}

TEST(RecordedWidgets, ValuesComeInOnceAndAreShown) {
    PanelMemory memory;
    double rate = 0.5;
    int count = 3, clicks = 0;
    bool flag = false, changed = false;
    std::string mode = "fast", note = "none";
    Vec3 color(1, 0, 0);
    const auto panel = [&](app::Widgets& ui) {
        ui.text("Hello");
        clicks += ui.button("Go");
        changed = ui.slider("rate", rate, 0, 1);
        ui.same_line();
        ui.checkbox("flag", flag);
        ui.slider("count", count, 1, 9);
        ui.combo("mode", mode, {"fast", "exact"});
        ui.text_field("note", note);
        ui.color("color", color);
        ui.progress(0.25, "done");
    };
    const json before = shown(memory, panel);
    EXPECT_EQ(before[2],
              json({{"type", "slider"}, {"name", "rate"}, {"value", 0.5}, {"min", 0}, {"max", 1}}));
    EXPECT_EQ(before[3]["beside"], true);
    EXPECT_EQ(before[4]["whole"], true);
    EXPECT_EQ(before[7]["value"], "#ff0000");
    memory.edits = {{{"Go", 0}, ""},          {{"rate", 0}, "0.75"},  {{"flag", 0}, "true"},
                    {{"count", 0}, "4.4"},    {{"mode", 0}, "exact"}, {{"note", 0}, "a b"},
                    {{"color", 0}, "#0080ff"}};
    const json after = shown(memory, panel);
    EXPECT_TRUE(changed);
    EXPECT_EQ(clicks, 1);
    EXPECT_EQ(rate, 0.75);
    EXPECT_EQ(count, 4);
    EXPECT_TRUE(flag);
    EXPECT_EQ(mode, "exact");
    EXPECT_EQ(note, "a b");
    EXPECT_NEAR(color.y(), 128 / 255.0, 1e-6);
    EXPECT_EQ(after[7]["value"], "#0080ff");
    shown(memory, panel);
    EXPECT_FALSE(changed);
    EXPECT_EQ(clicks, 1);
}

TEST(RecordedWidgets, WhatIsNoValueChangesNothing) {
    PanelMemory memory;
    double rate = 0.5, free = 2;
    bool flag = true;
    std::string mode = "fast";
    Vec3 color(1, 0, 0);
    memory.edits = {{{"rate", 0}, "7"},
                    {{"free", 0}, "nan"},
                    {{"flag", 0}, "yes"},
                    {{"mode", 0}, "other"},
                    {{"color", 0}, "#12345"}};
    shown(memory, [&](app::Widgets& ui) {
        EXPECT_TRUE(ui.slider("rate", rate, 0, 1));  // Brought inside.
        EXPECT_FALSE(ui.number("free", free));
        EXPECT_FALSE(ui.checkbox("flag", flag));
        EXPECT_FALSE(ui.combo("mode", mode, {"fast", "exact"}));
        EXPECT_FALSE(ui.color("color", color));
    });
    EXPECT_EQ(rate, 1);
    EXPECT_EQ(free, 2);
    EXPECT_TRUE(flag);
    EXPECT_EQ(mode, "fast");
    EXPECT_EQ(color, Vec3(1, 0, 0));
}

TEST(RecordedWidgets, NamesNeedNotDiffer) {
    PanelMemory memory;
    memory.edits = {{{"x", 1}, "5"}};
    double first = 1, second = 2;
    const json list = shown(memory, [&](app::Widgets& ui) {
        ui.number("x", first);
        ui.number("x", second);
    });
    EXPECT_EQ(first, 1);
    EXPECT_EQ(second, 5);
    EXPECT_EQ(list[1]["use"], 1);
}

TEST(RecordedWidgets, SectionsStayAsTheyWereFolded) {
    PanelMemory memory;
    const auto panel = [](app::Widgets& ui) {
        if (ui.section("More")) ui.text("inside");
    };
    EXPECT_EQ(shown(memory, panel).size(), 2u);
    memory.edits = {{{"More", 0}, "false"}};
    EXPECT_EQ(shown(memory, panel).size(), 1u);
    EXPECT_EQ(shown(memory, panel).size(), 1u);
}

TEST(RecordedWidgets, CurvesAreThinnedButKeepTheirExtremes) {
    PanelMemory memory;
    std::vector<float> values(10000, 0);
    values[1234] = 9;
    values[9999] = NAN;
    const json plot = shown(memory, [&](app::Widgets& ui) { ui.plot("loss", values); })[0];
    EXPECT_EQ(plot["values"].size(), RecordedWidgets::most_values);
    float highest = -1;
    for (const json& value : plot["values"]) highest = std::max(highest, value.get<float>());
    EXPECT_EQ(highest, 9);
    EXPECT_FALSE(plot.contains("last"));
    const json gap = shown(memory, [&](app::Widgets& ui) {
        ui.plot("gap", std::vector<float>{1, NAN, 2});
    })[0];
    EXPECT_EQ(gap["values"], json({1, nullptr, 2}));
    EXPECT_EQ(gap["last"], 2);
}

TEST(RecordedWidgets, ThereIsAnEndOfThem) {
    PanelMemory memory;
    const json list = shown(memory, [](app::Widgets& ui) {
        for (int i = 0; i < 5000; ++i) ui.text("x");
    });
    EXPECT_EQ(list.size(), RecordedWidgets::most_widgets);
}

TEST(RecordedWidgets, WhatAPanelThrowsIsTold) {
    app::UserPanels panels;
    panels.add("Broken", [](app::Widgets& ui) {
        ui.text("before");
        throw std::runtime_error("it \xff broke");  // No UTF-8.
    });
    std::map<std::string, PanelMemory> memories;
    memories["Broken"].edits = {{{"gone", 0}, "1"}};
    const json told = json::parse(panels_text(panels, memories));
    EXPECT_EQ(told["kind"], "panels");
    EXPECT_EQ(told["panels"][0]["widgets"].size(), 1u);
    EXPECT_NE(told["panels"][0]["error"].get<std::string>().find("broke"), std::string::npos);
    EXPECT_TRUE(memories["Broken"].edits.empty());
}

TEST(RecordedWidgets, FieldsAreRowsOfTheTable) {
    PanelMemory memory;
    FieldInfo info;
    info.name = "roughness";
    info.doc = "How rough.";
    info.min = 0;
    info.max = 1;
    Value value{0.5};
    std::vector<std::string> problems;
    const auto rows = [&] {
        RecordedWidgets widgets(memory);
        if (const auto chosen = widgets.field("rough", info, value)) value = *chosen;
        problems = widgets.problems();
        return widgets.take();
    };
    const json field = {
        {"name", "roughness"}, {"doc", "How rough."}, {"type", "number"}, {"min", 0}, {"max", 1}};
    EXPECT_EQ(rows()[0], json({{"type", "field"}, {"name", "rough"}, {"field", field}, {"value", "0.5"}}));
    memory.edits = {{{"rough", 0}, "0.25"}};
    EXPECT_EQ(rows()[0]["value"], "0.25");
    EXPECT_EQ(std::get<double>(value.data), 0.25);
    EXPECT_TRUE(problems.empty());
    for (const char* wrong : {"2", "-1", "nan", "much", ""}) {
        memory.edits = {{{"rough", 0}, wrong}};
        EXPECT_EQ(rows()[0]["value"], "0.25") << wrong;
        ASSERT_EQ(problems.size(), 1u) << wrong;
        EXPECT_NE(problems[0].find("roughness"), std::string::npos) << problems[0];
    }
}

TEST(RecordedWidgets, AutomaticFieldsSayWhatIsInForce) {
    PanelMemory memory;
    FieldInfo info;
    info.name = "radius";
    info.can_be_automatic = true;
    Value value{0.0, Value::State::automatic};
    RecordedWidgets first(memory);
    EXPECT_FALSE(first.field("radius", info, value, Value{2.0}));
    const json row = first.take()[0];
    EXPECT_EQ(row["value"], "auto");
    EXPECT_EQ(row["latched"], "2");
    memory.edits = {{{"radius", 0}, "auto"}};
    RecordedWidgets second(memory);
    const auto chosen = second.field("radius", info, Value{1.0});
    ASSERT_TRUE(chosen);
    EXPECT_EQ(chosen->state, Value::State::automatic);
}

}  // namespace
}  // namespace easypbr::remote::recorded_widgets_test
