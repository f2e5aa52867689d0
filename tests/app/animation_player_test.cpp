// Animations by a clock: one box that goes 2 units along x in 4 seconds.
#include "easypbr/app/animation_player.h"

#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "scene/slide.h"

namespace easypbr::app::animation_player_test {
namespace {

class Player : public testing::Test {
  protected:
    Player() {
        clock_.set_fixed_step(0.5);
        clock_.tick();  // the first frame, at 0
        clock_.on_tick = [this] { player_.update(); };
        clock_.on_set = [this] { player_.follow_set_clock(); };
        AnimationNode node;
        node.mesh = box_;
        Animation rest = slide("rest");
        ArrayXf& values = rest.channels[0].values;
        values = ArrayXf::Dense::Zero(values.rows(), values.cols());
        animations_ = Animations({{node}, {}, {}, {slide("slide"), rest}});
    }
    double x() const { return box_.T_parent_mesh().translation().x(); }

    Mesh box_ = make_box({1, 1, 1});
    Clock clock_;
    AnimationPlayer player_{clock_};
    Animations animations_;
};

TEST_F(Player, FollowsTheClockFromWhereItBegan) {
    clock_.tick();
    player_.add("box", animations_);
    EXPECT_EQ(player_.names(), (std::vector<std::string>{"box: slide", "box: rest"}));
    EXPECT_FALSE(player_.is_playing());
    player_.play("box", "slide");
    EXPECT_EQ(x(), 0);
    clock_.tick();
    EXPECT_NEAR(x(), 0.25, 1e-12);
    for (int i = 0; i < 3; ++i) clock_.tick();
    EXPECT_NEAR(x(), 1, 1e-12);
    EXPECT_DOUBLE_EQ(player_.duration_s(), 4);
}

// A lamp that hangs on the box goes with it, under its file's name; what the scene's owner chose stays.
TEST_F(Player, MovesLights) {
    AnimationRig rig{{{}}, {}, {}, {slide("slide")}};
    rig.lights.resize(1);
    rig.lights[0].users = {{"lamp", 0}, {"removed", 0}};
    rig.lights[0].value = [](const std::vector<double>&, const Eigen::Affine3d& T_world_node) {
        Light light;
        light.position = T_world_node.translation();
        return light;
    };
    Scene scene;
    Light lamp;
    lamp.casts_shadows = false;
    lamp.radius = 0.5f;
    scene.set_light("box/lamp", lamp);
    scene.set_light("other", Light());
    player_.add("box", Animations(rig), scene);
    player_.play(0);
    clock_.tick();
    EXPECT_EQ(scene.light("box/lamp").position, Vec3d(0.25, 0, 0));
    EXPECT_FALSE(scene.light("box/lamp").casts_shadows);
    EXPECT_EQ(scene.light("box/lamp").radius.value(), 0.5f);
    EXPECT_EQ(scene.light("other").position, Vec3d(0, 0, 0));
    EXPECT_EQ(scene.light_names().size(), 2u);
    rig.lights[0].users = {{"lamp", 3}};
    EXPECT_THROW(Animations{rig}, ArgumentError);
}

TEST_F(Player, PausesScrubsAndGoesOn) {
    player_.add("box", animations_);
    player_.play(0);
    clock_.tick();
    player_.pause();
    clock_.tick();
    EXPECT_NEAR(x(), 0.25, 1e-12);
    EXPECT_DOUBLE_EQ(player_.time(), 0.5);
    player_.seek(3);
    EXPECT_NEAR(x(), 1.5, 1e-12);
    player_.resume();
    clock_.tick();
    EXPECT_NEAR(x(), 1.75, 1e-12);
}

TEST_F(Player, SpeedAndLoop) {
    player_.add("box", animations_);
    player_.set_speed(-1);
    player_.play(0);
    clock_.tick();
    EXPECT_NEAR(x(), 1.75, 1e-12);  // half a second before the end, going around
    player_.set_speed(4);
    clock_.tick();
    EXPECT_NEAR(x(), 0.75, 1e-12);  // -0.5 + 2 s
    player_.set_loop(false);
    EXPECT_TRUE(player_.is_playing());
    for (int i = 0; i < 4; ++i) clock_.tick();
    EXPECT_NEAR(x(), 2, 1e-12);
    EXPECT_FALSE(player_.is_playing()) << "it rests at its end";
    player_.resume();
    EXPECT_TRUE(player_.is_playing());
    clock_.tick();
    EXPECT_NEAR(x(), 1, 1e-12);  // 0.5 s at four times the speed, from the start
}

TEST_F(Player, BackwardsWithoutALoopItPlaysFromItsEnd) {
    player_.add("box", animations_);
    player_.set_loop(false);
    player_.set_speed(-2);
    player_.play(0);
    EXPECT_TRUE(player_.is_playing());
    EXPECT_NEAR(x(), 2, 1e-12);
    clock_.tick();
    EXPECT_NEAR(x(), 1.5, 1e-12);
    for (int i = 0; i < 9; ++i) clock_.tick();
    EXPECT_FALSE(player_.is_playing());
    EXPECT_EQ(player_.time(), 0) << "not -6 s";
}

TEST_F(Player, WithoutALoopTheTimeEndsWithIt) {
    player_.add("box", animations_);
    player_.play(0);
    for (int i = 0; i < 9; ++i) clock_.tick();
    EXPECT_DOUBLE_EQ(player_.time(), 4.5);
    EXPECT_DOUBLE_EQ(player_.shown_time(), 0.5);
    player_.set_loop(false);
    EXPECT_DOUBLE_EQ(player_.time(), 0.5) << "where it is shown";
    for (int i = 0; i < 9; ++i) clock_.tick();
    EXPECT_EQ(player_.time(), 4);
    EXPECT_EQ(player_.shown_time(), 4);
}

TEST_F(Player, ShowsTheEndAfterAWholeDuration) {
    player_.add("box", animations_);
    player_.play(0);
    player_.seek(8);
    EXPECT_EQ(player_.shown_time(), 4);
    player_.seek(0);
    EXPECT_EQ(player_.shown_time(), 0);
    player_.seek(-1);
    EXPECT_DOUBLE_EQ(player_.shown_time(), 3);
}

TEST_F(Player, ASetClockSetsItBackToWhereItBeganAtMost) {
    clock_.set_time(2);
    player_.add("box", animations_);
    player_.play(0);
    clock_.tick();
    EXPECT_EQ(x(), 0) << "the first frame, at 2 s";
    for (int i = 0; i < 4; ++i) clock_.tick();
    clock_.set_time(3);
    EXPECT_DOUBLE_EQ(player_.time(), 1);
    clock_.set_time(0);
    EXPECT_EQ(player_.time(), 0) << "it began to play at 2 s";
    clock_.tick();
    EXPECT_EQ(x(), 0);
    clock_.tick();
    EXPECT_NEAR(x(), 0.25, 1e-12);
}

TEST_F(Player, TellsHowThingsMoved) {
    EXPECT_TRUE(player_.motion(1).empty());
    player_.add("box", animations_);
    player_.play(0);
    const auto moved = [&](double seconds) {
        const auto motion = player_.motion(seconds);
        EXPECT_EQ(motion.size(), 1u);
        EXPECT_TRUE(motion[0].first == box_);
        return motion[0].second.translation().x();
    };
    player_.pause();
    player_.seek(2);
    EXPECT_NEAR(moved(1), -0.5, 1e-12);  // at half a unit a second
    player_.set_speed(0.5);
    EXPECT_NEAR(moved(1), -0.25, 1e-12);
    player_.set_speed(1);
    player_.seek(0.5);
    EXPECT_NEAR(moved(1), -0.25, 1e-12);  // It began half a second ago.
    player_.seek(4.5);
    EXPECT_NEAR(moved(1), -0.25, 1e-12);  // It went around: it began half a second ago.
    player_.set_speed(-1);
    player_.seek(-0.5);
    EXPECT_NEAR(moved(1), 0.25, 1e-12);  // It is at 1.75, and was at its end, at 2.
    player_.seek(4.5);
    EXPECT_NEAR(x(), 0.25, 1e-12);  // Nothing was moved by the question.
}

// Half a second a frame: the animation of 4 s goes around with the ninth.
TEST_F(Player, TellsWhatJumpsWhereItBeginsAndGoesAround) {
    std::vector<double> jumps;
    player_.on_jump = [&](const MovedMeshes& moved) {
        ASSERT_EQ(moved.size(), 1u);
        jumps.push_back(moved[0].second.translation().x());
    };
    player_.add("box", animations_);
    player_.play(0);
    EXPECT_EQ(jumps, std::vector<double>{0}) << "it begins at rest";
    for (int i = 0; i < 8; ++i) clock_.tick();
    EXPECT_EQ(jumps.size(), 1u);
    EXPECT_NEAR(x(), 2, 1e-12);
    clock_.tick();
    ASSERT_EQ(jumps.size(), 2u);
    EXPECT_NEAR(jumps[1], -0.25, 1e-12);  // from 0 to 0.25, not from 2
    clock_.tick();
    EXPECT_EQ(jumps.size(), 2u);
}

TEST_F(Player, KnowsOtherFilesAndRefusesWhatThereIsNot) {
    EXPECT_THROW(player_.resume(), ArgumentError);
    EXPECT_THROW(player_.seek(1), ArgumentError);
    EXPECT_THROW(player_.play(0), NameError);
    player_.add("box", animations_);
    player_.add("", animations_);
    EXPECT_EQ(player_.names()[2], "slide");
    EXPECT_THROW(player_.play("bax", "slide"), NameError);
    EXPECT_THROW(player_.play("box", "slid"), NameError);
    EXPECT_THROW(player_.set_speed(NAN), ArgumentError);
    player_.play("box", "1");
    EXPECT_EQ(player_.current(), 1u);
}

}  // namespace
}  // namespace easypbr::app::animation_player_test
