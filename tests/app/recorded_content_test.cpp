// A box of side 2 that falls from height 0 to -4 in 4 seconds.
#include "easypbr/app/recorded_content.h"

#include <gtest/gtest.h>

#include "easypbr/app/session.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::recorded_content_test {
namespace {

class RecordedContent : public testing::Test {
  protected:
    RecordedContent() { scene_.show(box_, "box"); }

    void put(double time_s) { box_.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, -time_s, 0))); }
    const PutAt put_ = [this](double time_s) { put(time_s); };

    Mesh box_ = make_box({2, 2, 2});
    Scene scene_;
    Session session_{scene_};
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

}  // namespace
}  // namespace easypbr::app::recorded_content_test
