// A box of side 2 that falls from height 0 to -4 in 4 seconds.
#include "easypbr/app/recorded_content.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "easypbr/app/session.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::recorded_content_test {
namespace {

class RecordedContent : public testing::Test {
  protected:
    RecordedContent() {
        scene_.show(box_, "box");
        session_.settings().ground.mode = GroundMode::plane;
    }

    void put(double time_s) { box_.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, -time_s, 0))); }
    const PutAt put_ = [this](double time_s) { put(time_s); };
    ResolvedSettings resolved() { return session_.resolve(); }
    double height() { return resolved().settings.ground.height; }

    Mesh box_ = make_box({2, 2, 2});
    Scene scene_;
    Session session_{scene_};
    const std::vector<double> times_ = {0, 1, 2, 4};
    /// The ground is 5e-5 of the box's diagonal below it.
    const double gap_ = 5e-5 * std::sqrt(12.0);
};

TEST_F(RecordedContent, IsThatOfAllMoments) {
    const SceneSnapshot all = content_until(scene_, 4, put_);
    EXPECT_EQ(all.objects.size(), 16u);
    EXPECT_EQ(all.bounds().min(), Vec3d(-1, -5, -1));
    EXPECT_EQ(all.bounds().max(), Vec3d(1, 1, 1));
    EXPECT_EQ(box_.T_parent_mesh().translation().y(), 0) << "where it was at the beginning";
}

// An automatic camera that frames one pose is nearer than one that frames all, and looks higher. The middles
// of what they frame are at 0 and at -2; perspective moves the point they look at a little from these.
TEST_F(RecordedContent, IsFramedByAnAutomaticCamera) {
    const Vec2i size(64, 48);
    const SceneSnapshot all = content_until(scene_, 4, put_);
    const auto one = session_.resolve(size).settings.camera;
    const auto far = resolve_for(session_, all, size).settings.camera;
    EXPECT_NEAR(one.target.y(), 0, 0.5);
    EXPECT_NEAR(far.target.y(), -2, 0.5);
    // The height of 2 has become one of 6.
    EXPECT_GT((far.position - far.target).norm(), 1.5 * (one.position - one.target).norm());
    EXPECT_FALSE(session_.settings().camera.position.value()) << "nothing is latched";
}

TEST_F(RecordedContent, HasAGroundThatRests) {
    {
        const RestingGround ground(session_, resolved(), times_, put_);
        EXPECT_EQ(box_.T_parent_mesh().translation().y(), 0);
        for (const double time_s : times_) {
            put(time_s);
            EXPECT_NEAR(height(), -5 - gap_, 1e-12) << time_s;  // Roundings of doubles.
        }
        put(0);
    }
    EXPECT_EQ(session_.settings().ground.height, Auto<double>(automatic));
    EXPECT_NEAR(height(), -1 - gap_, 1e-12);
    // What is known before is lower, or is lowered, and is known again.
    for (const double latched : {-9.0, -2.0}) {
        Auto<double> known;
        known.latch(latched);
        session_.settings().ground.height = known;
        {
            const RestingGround ground(session_, resolved(), times_, put_);
            EXPECT_NEAR(height(), std::min(latched, -5 - gap_), 1e-12);
        }
        EXPECT_EQ(session_.settings().ground.height, known);
    }
}

TEST_F(RecordedContent, LeavesAGroundThatWasChosen) {
    const PutAt never = [](double) { FAIL() << "nothing has to be known"; };
    for (const Auto<double>& chosen : {Auto<double>(0.5), Auto<double>(follow)}) {
        session_.settings().ground.height = chosen;
        const RestingGround ground(session_, resolved(), times_, never);
        EXPECT_EQ(session_.settings().ground.height, chosen);
    }
    session_.settings().ground.height = automatic;
    session_.settings().ground.mode = GroundMode::none;
    const RestingGround ground(session_, resolved(), times_, never);
    EXPECT_EQ(session_.settings().ground.height, Auto<double>(automatic));
}

}  // namespace
}  // namespace easypbr::app::recorded_content_test
