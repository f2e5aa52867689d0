// Pictures that are read back while the next ones are drawn.
#include "easypbr/app/picture_ring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/label_map.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::picture_ring_test {
namespace {

class PictureRings : public testing::Test {
  protected:
    PictureRings() {
        Mesh ball = make_sphere(1, 16);
        const Eigen::Index faces = ball.F().rows();
        ball.set_labels(Array1i(Array1i::Dense::Constant(faces, 1, 10)),
                        built_in_label_map("semantic_kitti"));
        scene_.show(ball, "ball");
        session_.settings().image.size = Vec2i(64, 48);
        session_.settings().image.samples = 2;
    }
    void look_from(double x) {
        Camera camera = Camera::look_at(Vec3d(x, 1, 4), Vec3d::Zero());
        if (distorted_) {
            camera.intrinsics = Intrinsics{60, 60, 32, 24, 64, 48};
            camera.distortion =
                Distortion::from_coefficients(DistortionModel::brown_conrady, {0.1 + 0.1 * x, 0, 0, 0});
        }
        session_.set_camera(camera);
        session_.settings().annotation.legend = legend_ && x == 1;
    }
    /// The same three pictures through the ring and one by one.
    void expect_the_stills(const PictureOptions& options) {
        std::vector<Image> taken;
        PictureRing ring(session_, [&](Image picture, int) { taken.push_back(std::move(picture)); });
        for (int i = 0; i < 3; ++i) {
            look_from(i);
            ring.draw(options);
        }
        EXPECT_EQ(ring.count(), 3);
        ring.drain();
        ASSERT_EQ(taken.size(), 3u);
        for (int i = 0; i < 3; ++i) {
            look_from(i);
            const Image still = session_.render(options);
            EXPECT_TRUE(std::ranges::equal(taken[size_t(i)].bytes(), still.bytes())) << "picture " << i;
        }
        // So that the comparison means something.
        EXPECT_FALSE(std::ranges::equal(taken[0].bytes(), taken[1].bytes()));
    }

    Scene scene_;
    Session session_{scene_};
    bool distorted_ = false, legend_ = false;
};

TEST_F(PictureRings, GiveTheStillsBitForBitInEveryEncoding) {
    for (const Encoding encoding : {Encoding::srgb8, Encoding::srgb16, Encoding::scene_linear})
        expect_the_stills({std::nullopt, std::nullopt, encoding});
}

TEST_F(PictureRings, GiveTheStillsWithLegends) {
    legend_ = true;
    expect_the_stills({Vec2i(320, 240), 1});
}

TEST_F(PictureRings, GiveTheStillsOfLensesAndTiles) {
    distorted_ = true;
    expect_the_stills({});
    distorted_ = false;
    session_.settings().ssao.enabled = false;
    session_.limit_tiles({384, 384 * 384});
    expect_the_stills({Vec2i(520, 390), 1});
}

TEST_F(PictureRings, KeepTheOrderAndTheirBounds) {
    std::vector<int> taken;
    PictureRing ring(session_, [&](const Image&, int times) { taken.push_back(times); });
    for (int i = 1; i <= 20; ++i) {
        ring.draw({}, i);
        // Never more than fit, each counted as often as it is meant.
        EXPECT_LE(ring.count(), int(PictureRing::most_pending) * i);
        EXPECT_GE(int(taken.size()), i - int(PictureRing::most_pending));
        if (i % 7 == 0) ring.take_read();
    }
    ring.drain();
    EXPECT_EQ(ring.count(), 0);
    ASSERT_EQ(taken.size(), 20u);
    EXPECT_TRUE(std::ranges::is_sorted(taken));
}

TEST_F(PictureRings, KeepTheOthersWhenOneCannotBeTaken) {
    int taken = 0;
    PictureRing ring(session_, [&](const Image&, int) {
        if (++taken == 2) throw std::runtime_error("no");
    });
    for (int i = 0; i < 3; ++i) ring.draw({});
    EXPECT_THROW(ring.drain(), std::runtime_error);
    EXPECT_EQ(ring.count(), 1);
    ring.drain();
    EXPECT_EQ(taken, 3);
}

TEST_F(PictureRings, MayBeDroppedWithPicturesOnTheirWay) {
    int taken = 0;
    {
        PictureRing ring(session_, [&](const Image&, int) { ++taken; });
        ring.draw({});
        ring.draw({});
    }
    EXPECT_EQ(taken, 0);
    EXPECT_EQ(session_.render().width(), 64);
}

}  // namespace
}  // namespace easypbr::app::picture_ring_test
