// Lights and cameras that animations move, change and hide.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"

namespace easypbr::gltf_placed_test {

namespace {

using Json = nlohmann::json;

constexpr const char* lamp_pointer = "/extensions/KHR_lights_punctual/lights/0/";

/// A triangle, and at (0, 1, 0) a spot light and a camera below a node at the origin; another lamp stands
/// apart. Nothing is animated.
GltfBuilder placed() {
    GltfBuilder builder;
    builder.triangle();
    const auto lamp = [](int light) { return Json{{"KHR_lights_punctual", {{"light", light}}}}; };
    builder.json["scenes"] = {{{"nodes", {0, 1, 3}}}};
    builder.json["nodes"] = {
        {{"mesh", 0}},
        {{"children", {2}}},
        {{"name", "eye"}, {"translation", {0, 1, 0}}, {"camera", 0}, {"extensions", lamp(0)}},
        {{"extensions", lamp(1)}}};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"name", "spot"},
                                                                    {"type", "spot"},
                                                                    {"intensity", 10},
                                                                    {"range", 5},
                                                                    {"spot", {{"outerConeAngle", 0.5}}}},
                                                                   {{"name", "apart"}, {"type", "point"}}};
    builder.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    return builder;
}

/// Adds an animation of two keys, at 0 and 2 seconds.
void animate(GltfBuilder& builder, const Json& target, const std::vector<float>& values,
             const std::string& interpolation = "LINEAR") {
    const size_t input = builder.floats({0, 2}, 1), output = builder.floats(values, int(values.size() / 2));
    builder.json["animations"].push_back(
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", target}}}}});
}

Json pointer_to(const std::string& pointer) {
    return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

/// The light after one second, halfway between two keys of what a pointer names.
Light spot_after(const std::string& property, const std::vector<float>& keys) {
    GltfBuilder builder = placed();
    animate(builder, pointer_to(lamp_pointer + property), keys);
    return decode(builder).animations.lights(0, 1).at("spot");
}

Camera camera_after(const std::string& property, const std::vector<float>& keys, const Json& camera = {}) {
    GltfBuilder builder = placed();
    if (!camera.empty()) builder.json["cameras"] = {camera};
    animate(builder, pointer_to("/cameras/0/" + property), keys);
    return decode(builder).animations.cameras(0, 1).at("eye");
}

}  // namespace

TEST(GltfPlaced, FollowsTheNodesAboveIt) {
    GltfBuilder builder = placed();
    animate(builder, {{"node", 1}, {"path", "translation"}}, {0, 0, 0, 6, 0, 0});
    const float half = float(std::sqrt(0.5));
    animate(builder, {{"node", 1}, {"path", "rotation"}}, {0, half, 0, half, 0, half, 0, half});
    const io::LoadedScene scene = decode(builder);
    EXPECT_EQ(scene.lights.at("spot").position, Vec3d(0, 1, 0));
    const auto lights = scene.animations.lights(0, 1);
    ASSERT_EQ(lights.size(), 1u);  // What stands apart is left alone.
    EXPECT_EQ(lights.at("spot").position, Vec3d(3, 1, 0));
    EXPECT_EQ(lights.at("spot").direction, Vec3(0, 0, -1));
    EXPECT_EQ(lights.at("spot").intensity, 10);
    EXPECT_EQ(scene.animations.cameras(0, 1).at("eye").position(), Vec3d(3, 1, 0));
    // A quarter of a turn to the left: from -z to -x.
    EXPECT_LT((scene.animations.lights(1, 0).at("spot").direction - Vec3(-1, 0, 0)).norm(), 1e-6f);
    const Camera turned = scene.animations.cameras(1, 0).at("eye");
    EXPECT_LT((turned.T_world_cam.linear() * Vec3d(0, 0, -1) - Vec3d(-1, 0, 0)).norm(), 1e-7);
}

TEST(GltfPlaced, ChangesLights) {
    EXPECT_EQ(spot_after("color", {1, 0, 0, 0, 0.5, 1}).color, Vec3(0.5f, 0.25f, 0.5f));
    EXPECT_EQ(spot_after("intensity", {10, 30}).intensity, 20);
    EXPECT_EQ(spot_after("range", {2, 4}).range, 3);
    EXPECT_NEAR(spot_after("spot/innerConeAngle", {0, 0.5}).inner_cone_deg, degrees(0.25), 1e-4);
    EXPECT_NEAR(spot_after("spot/outerConeAngle", {0.5, 1}).outer_cone_deg, degrees(0.75), 1e-4);
    EXPECT_EQ(spot_after("intensity", {10, 30}).position, Vec3d(0, 1, 0));
}

TEST(GltfPlaced, ChangesCameras) {
    EXPECT_NEAR(camera_after("perspective/yfov", {0.5, 1}).fov_y_deg, degrees(0.75), 1e-9);
    EXPECT_NEAR(camera_after("perspective/znear", {0.5, 1}).near, 0.75, 1e-9);
    const Json box = {{"type", "orthographic"},
                      {"orthographic", {{"xmag", 1}, {"ymag", 2}, {"znear", 0.5}, {"zfar", 9}}}};
    EXPECT_NEAR(camera_after("orthographic/ymag", {1, 2}, box).ortho_height, 3, 1e-9);
    EXPECT_NEAR(camera_after("orthographic/znear", {1, 2}, box).near, 1.5, 1e-9);
    const Camera far = camera_after("orthographic/zfar", {10, 20}, box);
    EXPECT_EQ(far.far, 15);
    EXPECT_EQ(far.near, 0.5);
    EXPECT_EQ(far.ortho_height, 4);
}

// What is out of range is at its end: nothing that a scene or a session would refuse.
TEST(GltfPlaced, StaysInRange) {
    EXPECT_EQ(spot_after("intensity", {-1, -5}).intensity, 0);
    EXPECT_EQ(spot_after("color", {-1, 0, 0, -1, 0, 0}).color, Vec3(0, 0, 0));
    EXPECT_EQ(spot_after("range", {-1, -1}).range, 0);
    const Light wide = spot_after("spot/innerConeAngle", {3, 3});
    EXPECT_EQ(wide.inner_cone_deg, wide.outer_cone_deg);
    EXPECT_EQ(spot_after("spot/outerConeAngle", {3, 3}).outer_cone_deg, 90);
    EXPECT_EQ(camera_after("perspective/yfov", {9, 9}).fov_y_deg, 179);
    EXPECT_GT(camera_after("perspective/znear", {-1, -1}).near, 0);
    for (const char* property : {"intensity", "range", "spot/innerConeAngle", "spot/outerConeAngle"})
        EXPECT_NO_THROW(validate(spot_after(property, {-9, -9}), "spot")) << property;
}

// A light that an animation shows is known from the start, and dark; one that stays hidden is left out.
TEST(GltfPlaced, HiddenLightsAreDark) {
    GltfBuilder builder = placed();
    for (const int node : {1, 3})
        builder.json["nodes"][node]["extensions"]["KHR_node_visibility"]["visible"] = false;
    animate(builder, pointer_to("/nodes/1/extensions/KHR_node_visibility/visible"), {0, 1}, "STEP");
    const io::LoadedScene scene = decode(builder);
    EXPECT_FALSE(scene.lights.contains("apart"));
    EXPECT_EQ(scene.lights.at("spot").intensity, 0);
    EXPECT_EQ(scene.animations.lights(0, 1, false).at("spot").intensity, 0);
    EXPECT_EQ(scene.animations.lights(0, 2, false).at("spot").intensity, 10);
}

TEST(GltfPlaced, SaysWhatIsNot) {
    for (const std::string pointer :
         {"/cameras/0/perspective/aspectRatio", "/cameras/0/orthographic/ymag", "/cameras/x/perspective/yfov",
          "/cameras/0", "/extensions/KHR_lights_punctual/lights/0/spot",
          "/extensions/KHR_lights_punctual/lights//color"}) {
        GltfBuilder builder = placed();
        animate(builder, pointer_to(pointer), {0, 1});
        const LogCapture log;
        decode(builder);
        EXPECT_NE(log.text.find(fmt::format("animates '{}', which cannot be animated", pointer)),
                  log.text.npos)
            << log.text;
    }
    const auto message_at = [](const std::string& pointer, const std::vector<float>& values) {
        GltfBuilder builder = placed();
        animate(builder, pointer_to(pointer), values);
        return message_of(builder);
    };
    EXPECT_NE(message_at("/cameras/7/perspective/yfov", {0, 1}).find("cameras[7] does not exist"),
              std::string::npos);
    EXPECT_NE(
        message_at("/extensions/KHR_lights_punctual/lights/9/range", {0, 1}).find("lights[9] does not exist"),
        std::string::npos);
    EXPECT_NE(message_at(std::string(lamp_pointer) + "color", {0, 1}), "accepted");
}

// Counting from 2 for each of 40,000 lights takes minutes.
TEST(GltfPlaced, ManyLightsOfOneNameAreNumberedInTurn) {
    GltfBuilder builder = placed();
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"name", "L"}, {"type", "point"}},
                                                                   {{"name", "L 3"}, {"type", "point"}}};
    Json nodes = {{{"mesh", 0}}, {{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}}};
    Json roots = {0, 1};
    constexpr size_t count = 40'000;
    for (size_t i = 0; i < count; ++i) {
        roots.push_back(nodes.size());
        nodes.push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    }
    builder.json["nodes"] = nodes;
    builder.json["scenes"][0]["nodes"] = roots;
    const auto lights = decode(builder).lights;
    EXPECT_EQ(lights.size(), count + 1);
    // "L 3" is the other light's own name: L, L 2, L 4, ...
    EXPECT_TRUE(lights.contains("L") && lights.contains("L 2") && lights.contains("L 4"));
    EXPECT_TRUE(lights.contains(fmt::format("L {}", count + 1)));
}

}  // namespace easypbr::gltf_placed_test
