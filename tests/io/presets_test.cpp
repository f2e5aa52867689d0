#include "easypbr/io/settings/presets.h"

#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/scene/fields.h"

namespace easypbr::presets_test {

namespace {

io::SettingsFile after(const std::vector<std::string>& presets) {
    io::SettingsFile file;
    for (const std::string& preset : presets) io::apply_preset(preset, file);
    return file;
}

}  // namespace

TEST(Presets, ReplaceEachOther) {
    EXPECT_EQ(io::preset_names(), (std::vector<std::string>{"dark", "flat", "paper", "studio"}));
    for (const std::string& first : io::preset_names())
        for (const std::string& second : io::preset_names())
            for (const Field& field : fields())
                EXPECT_EQ(field.get(after({first, second}).settings), field.get(after({second}).settings))
                    << first << ", " << second << ": " << field.name;
}

TEST(Presets, StudioIsTheDefault) {
    for (const Field& field : fields())
        EXPECT_EQ(field.get(after({"studio"}).settings), field.get(Settings())) << field.name;
}

TEST(Presets, LeaveWhatTheyDoNotSay) {
    io::SettingsFile file;
    file.settings.camera.azimuth_deg = 70;
    file.settings.ground.shadow_strength = 0.1f;
    file.lights["lamp"] = {};
    io::apply_preset("paper", file);
    EXPECT_EQ(file.settings.camera.azimuth_deg, 70);
    EXPECT_EQ(file.settings.ground.mode, GroundMode::shadow);
    EXPECT_EQ(file.lights.count("lamp"), 1u);
}

TEST(Presets, ThatAreNoneAreErrors) {
    io::SettingsFile file;
    EXPECT_THROW(io::apply_preset("papre", file), NameError);
    EXPECT_THROW(io::apply_preset("", file), NameError);
    EXPECT_THROW(io::apply_preset("missing.json", file), FileError);
    EXPECT_THROW(io::apply_preset("/", file), FileError);
}

}  // namespace easypbr::presets_test
