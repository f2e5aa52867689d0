#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "easypbr/core/error.h"
#include "easypbr/scene/light_table.h"

namespace easypbr::light_test {
namespace {

std::string message_of(const Light& light) {
    try {
        validate(light, "lamp");
    } catch (const ArgumentError& error) {
        return error.what();
    }
    return "accepted";
}

/// A value that no light has by default.
Value other_value(const FieldInfo& field) {
    switch (field.type) {
        case FieldType::boolean:
            return {false};
        case FieldType::choice:
            return {field.choices.back()};
        case FieldType::vector:
            return {field.sizes == std::vector<size_t>{2} ? std::vector<double>{0.25, 0.5}
                                                          : std::vector<double>{0.25, 0.5, 0.75}};
        default:
            return {12.0};
    }
}

TEST(Light, OfATypeThatThereIsNotIsRefused) {
    Light light;
    light.type = LightType(9);
    const std::string message = message_of(light);
    EXPECT_NE(message.find("type"), std::string::npos) << message;
    EXPECT_NE(message.find("9"), std::string::npos) << message;
}

// The fourteen members of Light, counted in light.h.
TEST(LightTable, EachMemberHasItsOwnRow) {
    std::set<std::string> names;
    for (const LightField& field : light_fields()) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
        EXPECT_FALSE(field.doc.empty()) << field.name;
        Light light;
        field.put(light, checked(field, other_value(field)));
        EXPECT_EQ(field.get(light), other_value(field)) << field.name;
        for (const LightField& other : light_fields())
            EXPECT_EQ(other.get(light) == other.get(Light()), other.name != field.name)
                << field.name << ", " << other.name;
    }
    EXPECT_EQ(names.size(), 14u);
}

TEST(LightTable, SaysWhatConcernsWhichLight) {
    const auto names_for = [](LightType type) {
        std::set<std::string> names;
        for (const LightField& field : light_fields())
            if (field.concerns(type)) names.insert(field.name);
        return names;
    };
    const std::set<std::string> point = names_for(LightType::point), spot = names_for(LightType::spot),
                                directional = names_for(LightType::directional);
    EXPECT_EQ(point, (std::set<std::string>{"type", "enabled", "position", "color", "intensity", "range",
                                            "casts_shadows", "radius"}));
    EXPECT_EQ(directional, (std::set<std::string>{"type", "enabled", "direction", "color", "intensity",
                                                  "casts_shadows", "angular_radius_deg"}));
    for (const std::string& name : point) EXPECT_TRUE(spot.contains(name)) << name;
    EXPECT_EQ(spot.size(), point.size() + 3) << "direction and two cones";
    const std::set<std::string> any{"type",  "enabled",   "position",     "direction",
                                    "color", "intensity", "casts_shadows"};
    std::set<std::string> rectangle = any, disc = any, sphere = any;
    rectangle.insert({"size", "width_axis"});
    disc.insert("radius");
    sphere.insert("radius");
    sphere.erase("direction");
    EXPECT_EQ(names_for(LightType::rectangle), rectangle);
    EXPECT_EQ(names_for(LightType::disc), disc);
    EXPECT_EQ(names_for(LightType::sphere), sphere);
}

TEST(Light, NumbersOutsideOfTheirRangeAreNamed) {
    for (const LightField& field : light_fields()) {
        if (field.type != FieldType::number) continue;
        for (const double bad : {std::nan(""), -std::numeric_limits<double>::infinity()}) {
            Light light;
            field.put(light, {bad});
            EXPECT_NE(message_of(light).find("light 'lamp': " + field.name + ": expected"), std::string::npos)
                << message_of(light);
        }
    }
    Light light;
    light.intensity = -1;
    EXPECT_EQ(message_of(light), "light 'lamp': intensity: expected a number of at least 0, got -1");
    light = {};
    light.angular_radius_deg = 46;
    EXPECT_EQ(message_of(light), "light 'lamp': angular_radius_deg: expected 0 to 45 degrees, got 46");
    light = {};
    light.position.x() = std::nanf("");
    EXPECT_EQ(message_of(light), "light 'lamp': position: expected finite numbers, got (nan, 0, 0)");
    light = {};
    light.direction = {0, 0, 0};
    EXPECT_EQ(message_of(light), "accepted") << "a point light has no direction";
    light.type = LightType::spot;
    EXPECT_EQ(message_of(light), "light 'lamp': direction: expected a vector with a length, got (0, 0, 0)");
    light.type = LightType::sphere;
    EXPECT_EQ(message_of(light), "accepted");
    light.radius = 0.0f;
    EXPECT_EQ(message_of(light), "light 'lamp': radius: expected more than 0 for a disc or a sphere, got 0");
}

}  // namespace
}  // namespace easypbr::light_test
