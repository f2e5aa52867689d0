// What a person changes by hand, and what undo and redo leave to the program.
#include "easypbr/app/edits.h"

#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::edits_test {
namespace {

class EditsTest : public testing::Test {
  protected:
    EditsTest() { session_.scene().show(make_sphere(1, 8), "ball"); }

    /// As a frame does.
    void note() {
        edits_.keep_chosen();
        edits_.note();
    }

    Session session_;
    Edits edits_{session_};
};

// The program sets them without telling, and between a person's edit and the next frame.
TEST_F(EditsTest, WhatDiffersFromTheSettingsBeforeIsTheProgramsWhereItIsSaid) {
    note();
    Settings& settings = session_.settings();
    settings.background.color = {1, 0, 0};
    note();
    edits_.undo();
    const Settings before = settings;
    settings.tonemap.exposure = 4;
    edits_.leave_to_program(before);
    note();
    EXPECT_TRUE(edits_.can_redo());
    edits_.redo();
    EXPECT_EQ(settings.background.color, Vec3(1, 0, 0));
    edits_.as_program([&] { settings.tonemap.exposure = 5; });
    EXPECT_THROW(edits_.as_program([&] {
        settings.image.samples = 3;
        throw ArgumentError("a function of the program");
    }),
                 ArgumentError);
    note();
    edits_.undo();
    EXPECT_NE(settings.background.color, Vec3(1, 0, 0));
    EXPECT_EQ(settings.tonemap.exposure, Auto<float>(5.0f));
    EXPECT_EQ(settings.image.samples, 3);
    EXPECT_FALSE(edits_.can_undo());
}

TEST_F(EditsTest, UndoTakesBackThePropertyThatWasChangedAlone) {
    note();
    Mesh ball = session_.scene().get("ball");
    const Vec3 before = ball.material().base_color;
    edits_.change_look("ball", "style.flat", {true});
    edits_.change_look("ball", "material.base_color", {std::vector<double>{1, 0, 0}});
    note();
    // The program changes other properties of the same material and style.
    ball.edit([](MeshData& data) {
        data.materials.at(0).roughness = 0.25f;
        data.style.colormap = Colormap::turbo;
    });
    note();
    for (const bool undone : {true, false, true}) {
        undone ? edits_.undo() : edits_.redo();
        EXPECT_EQ(ball.style().flat, undone ? Override<bool>() : Override<bool>(true));
        EXPECT_EQ(ball.material().base_color, undone ? before : Vec3(1, 0, 0));
        EXPECT_EQ(ball.material().roughness, 0.25f);
        EXPECT_EQ(ball.style().colormap, Override<Colormap>(Colormap::turbo));
    }
    // What the program has chosen since is what the next edit's undo goes back to.
    ball.edit([](MeshData& data) { data.style.flat = false; });
    edits_.change_look("ball", "style.flat", {true});
    note();
    edits_.undo();
    EXPECT_EQ(ball.style().flat, Override<bool>(false));
}

// A value between those of float: what is read again is not what was chosen.
TEST_F(EditsTest, WhatTheProgramHasSetInPlaceOfALookStays) {
    note();
    edits_.change_look("ball", "material.roughness", {0.85});
    note();
    edits_.change_look("ball", "material.metallic", {0.35});
    note();
    Mesh ball = session_.scene().get("ball");
    ball.edit([](MeshData& data) { data.materials.at(0).roughness = 0.25f; });
    note();
    const Material before;
    for (const bool undone : {true, false}) {
        for (int i = 0; i < 2; ++i) undone ? edits_.undo() : edits_.redo();
        EXPECT_EQ(ball.material().roughness, 0.25f);
        EXPECT_EQ(ball.material().metallic, undone ? before.metallic : 0.35f);
    }
    // The next choice is a person's again, and goes back to the program's.
    edits_.change_look("ball", "material.roughness", {0.5});
    note();
    edits_.undo();
    EXPECT_EQ(ball.material().roughness, 0.25f);
    edits_.redo();
    EXPECT_EQ(ball.material().roughness, 0.5f);
}

TEST_F(EditsTest, WhatTheProgramHasSetInPlaceOfAPoseStays) {
    note();
    Mesh ball = session_.scene().get("ball");
    const auto place = [&] { return ball.T_parent_mesh().translation().eval(); };
    edits_.will_move("ball");
    ball.translate(Vec3d(0.18, 0, 0));
    note();
    ball.translate(Vec3d(0, 0.5, 0));
    note();
    edits_.undo();
    EXPECT_EQ(place(), Vec3d(0.18, 0.5, 0));
    edits_.redo();
    EXPECT_EQ(place(), Vec3d(0.18, 0.5, 0));
    // A move of more frames than one is a person's.
    for (const int frames : {1, 2}) {
        for (int i = 0; i < frames; ++i) {
            edits_.keep_chosen();
            edits_.will_move("ball");
            ball.translate(Vec3d(0, 0, 1));
        }
        note();
    }
    EXPECT_EQ(place(), Vec3d(0.18, 0.5, 3));
    edits_.undo();
    EXPECT_EQ(place(), Vec3d(0.18, 0.5, 1));
    edits_.undo();
    EXPECT_EQ(place(), Vec3d(0.18, 0.5, 0));
}

TEST_F(EditsTest, WhatTheProgramHasSetInPlaceOfALightStays) {
    Scene& scene = session_.scene();
    const auto dim = [&](float intensity) {
        Light light = scene.light("lamp");
        light.intensity = intensity;
        scene.set_light("lamp", light);
    };
    scene.set_light("lamp", Light());
    note();
    edits_.will_change_light("lamp");
    dim(2);
    note();
    // What is inferred for a picture is no change.
    scene.latch_light_radius("lamp", 0.5f);
    note();
    edits_.undo();
    EXPECT_EQ(scene.light("lamp").intensity, 1);
    edits_.redo();
    EXPECT_EQ(scene.light("lamp").intensity, 2);
    dim(3);
    note();
    edits_.undo();
    EXPECT_EQ(scene.light("lamp").intensity, 3);
    edits_.redo();
    EXPECT_EQ(scene.light("lamp").intensity, 3);
}

/// A sphere of two materials, half of the faces each.
Mesh ball_of_two_materials() {
    Mesh ball = make_sphere(1, 12);
    ball.edit([](MeshData& data) {
        data.materials = {Material(), Material()};
        data.materials[0].roughness = 0.25f;
        data.materials[1].roughness = 0.75f;
        const int faces = int(data.F.rows()), half = faces / 2;
        data.parts = {{"m0", 0, half, 0}, {"m1", half, faces - half, 1}};
    });
    return ball;
}

TEST_F(EditsTest, UndoGoesBackToTheMaterialsOfWhatIsShownNow) {
    note();
    const auto roughness = [&] {
        std::vector<float> all;
        for (const Material& material : session_.scene().get("ball").snapshot()->materials)
            all.push_back(material.roughness);
        return all;
    };
    using Numbers = std::vector<float>;
    edits_.change_look("ball", "material.roughness", {0.125});
    note();
    session_.scene().show(ball_of_two_materials(), "ball");
    note();
    EXPECT_EQ(roughness(), Numbers({0.125f, 0.125f}));
    edits_.undo();
    EXPECT_EQ(roughness(), Numbers({0.25f, 0.75f}));
    edits_.redo();
    EXPECT_EQ(roughness(), Numbers({0.125f, 0.125f}));
    // A material less, in the same mesh: the other one is restored.
    session_.scene().get("ball").edit([](MeshData& data) {
        data.parts.clear();
        data.materials.resize(1);
    });
    edits_.undo();
    EXPECT_EQ(roughness(), Numbers({0.25f}));
}

TEST_F(EditsTest, PosesAreKeptWhenOtherDataAreShown) {
    note();
    const auto place = [&] { return session_.scene().get("ball").T_parent_mesh().translation().eval(); };
    edits_.will_move("ball");
    session_.scene().get("ball").translate(Vec3d(1, 0, 0));
    note();
    Mesh other = make_sphere(1, 12);
    other.translate(Vec3d(0, 2, 0));
    session_.scene().show(other, "ball");
    note();
    EXPECT_EQ(place(), Vec3d(1, 0, 0));
    edits_.undo();
    EXPECT_EQ(place(), Vec3d(0, 2, 0));
    edits_.redo();
    EXPECT_EQ(place(), Vec3d(1, 0, 0));
    // One that is undone is not kept.
    edits_.undo();
    session_.scene().show(make_sphere(1, 8), "ball");
    note();
    EXPECT_EQ(place(), Vec3d(0, 0, 0));
}

TEST_F(EditsTest, UnknownPropertiesAreRefused) {
    note();
    EXPECT_THROW(edits_.change_look("ball", "material.rough", {0.5}), NameError);
    EXPECT_THROW(edits_.change_look("ball", "roughness", {0.5}), NameError);
    EXPECT_THROW(edits_.change_look("ball", "style.visibel", {true}), NameError);
    EXPECT_THROW(edits_.change_look("ball", "style.point_size", {-1.0}), ArgumentError);
    note();
    EXPECT_FALSE(edits_.can_undo());
    edits_.change_look("nothing", "style.visible", {true});  // nor is there such an object
    EXPECT_FALSE(edits_.can_undo());
}

}  // namespace
}  // namespace easypbr::app::edits_test
