// The room that annotations take of a picture, and that an automatic camera leaves them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "easypbr/app/annotation.h"
#include "easypbr/app/recorder.h"
#include "easypbr/app/session.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::annotation_room_test {
namespace {

Mesh coloured_box(const Vec3& size, float largest = 1) {
    Mesh box = make_box(size);
    Array1f::Dense values(box.V().rows());
    for (Eigen::Index i = 0; i < values.rows(); ++i)
        values(i) = largest * float(i) / float(values.rows() - 1);
    box.add_scalar("t", Array1f(values));
    return box;
}

Session session_of(int bars, Vec2i size) {
    Session session;
    for (int i = 0; i < bars; ++i) {
        Mesh box = coloured_box(Vec3(2, 1, 1), float(i + 1));
        box.translate({0, float(2 * i), 0});
        session.scene().show(box, fmt::format("box {}", i));
    }
    session.settings().image.size = size;
    session.settings().image.samples = 1;
    return session;
}

/// Where the vertices are seen: of the part of the picture within the insets, -1 to 1 along each axis.
struct Extent {
    Eigen::Array2d low = Eigen::Array2d::Constant(1e30), high = -low;
};
Extent extent_of(const SceneSnapshot& scene, const Camera& camera, Vec2i size, const Insets& in) {
    const Mat4d P = camera.projection_matrix(double(size.x()) / size.y()) * camera.view();
    const Eigen::Array2d left(2 * in.left - 1, 2 * in.bottom - 1), right(1 - 2 * in.right, 1 - 2 * in.top);
    Extent extent;
    for (const auto& object : scene.objects)
        for (Eigen::Index i = 0; i < object.mesh->V.rows(); ++i) {
            const Vec3d world = object.T_world_mesh * Vec3d(object.mesh->V.row(i).transpose().cast<double>());
            const Vec3d ndc = (P * world.homogeneous()).hnormalized();
            const Eigen::Array2d at = (ndc.head<2>().array() - (left + right) / 2) / ((right - left) / 2);
            extent.low = extent.low.min(at);
            extent.high = extent.high.max(at);
        }
    return extent;
}

ColorBar plain_bar() {
    ColorBar bar;
    bar.title = "t";
    bar.range = {0, 1, 0, 1};
    bar.table.fill({200, 0, 0, 255});
    return bar;
}

Image grey(Vec2i size) {
    Image picture(size.x(), size.y(), 4, PixelType::u8);
    Canvas(picture).fill({0, 0, size.x(), size.y()}, {64, 64, 64});
    return picture;
}

/// The rectangle of pixels that an annotation changes.
PixelRect touched(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                  Vec2i size) {
    const Image before = grey(size);
    Image after = before;
    draw_annotation(annotation, settings, after);
    int left = size.x(), top = size.y(), right = -1, bottom = -1;
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x)
            if (!std::equal(before.at<uint8_t>(x, y), before.at<uint8_t>(x, y) + 4,
                            after.at<uint8_t>(x, y))) {
                left = std::min(left, x), right = std::max(right, x);
                top = std::min(top, y), bottom = std::max(bottom, y);
            }
    return {left, top, right - left + 1, bottom - top + 1};
}

}  // namespace

// All that is drawn lies in the strip, which ends 0.6 text sizes beyond it: less than 0.7 with both rounded.
TEST(AnnotationRoom, IsWhatIsDrawn) {
    BasicAnnotationSettings<Inferred> settings;
    const Annotation bars{{}, {plain_bar(), plain_bar()}};
    const Vec2i size(800, 500);
    const double em = 0.03 * size.y();
    for (const Corner corner :
         {Corner::top_left, Corner::top_right, Corner::bottom_left, Corner::bottom_right}) {
        settings.corner = corner;
        const PixelRect drawn = touched(bars, settings, size);
        const Insets strip = annotation_strip(bars, settings, size);
        const bool right = corner == Corner::top_right || corner == Corner::bottom_right;
        const double reach = right ? size.x() - drawn.x : drawn.x + drawn.width;
        const double taken = (right ? strip.right : strip.left) * size.x();
        EXPECT_GE(taken, reach);
        EXPECT_LE(taken, reach + 0.7 * em);
        EXPECT_EQ((right ? strip.left : strip.right) + strip.top + strip.bottom, 0);
    }
    // A legend that is wide and flat takes less above the content than beside it.
    Annotation legend{{{"", {{"a class of a very long name, longer than others", {200, 0, 0}}}}}, {}};
    settings.corner = Corner::bottom_left;
    const PixelRect drawn = touched(legend, settings, size);
    const Insets strip = annotation_strip(legend, settings, size);
    EXPECT_GE(strip.bottom * size.y(), size.y() - drawn.y);
    EXPECT_LE(strip.bottom * size.y(), size.y() - drawn.y + 0.7 * em);
    EXPECT_EQ(strip.left + strip.right + strip.top, 0);
    // Large text takes more than a third either way.
    settings.text_size = 0.2f;
    EXPECT_EQ(annotation_strip(bars, settings, {200, 200}), Insets());
    EXPECT_EQ(annotation_strip({}, settings, size), Insets());
}

// A swatch is 0.95 text sizes wide. Text of 11.4 pixels is 11 high, from capitals to descenders.
TEST(AnnotationRoom, TakesReadableTextWhereThatFits) {
    const auto swatch = [](const std::string& name, Vec2i size) {
        Image picture = grey(size);
        draw_annotation({{{"", {{name, {200, 0, 0}}}}}, {}}, {}, picture);
        int count = 0;
        for (int y = 0; y < size.y(); ++y)
            for (int x = 0; x < size.x(); ++x) {
                const uint8_t* p = picture.at<uint8_t>(x, y);
                count += p[0] == 200 && p[1] == 0 && p[2] == 0;
            }
        return count;
    };
    EXPECT_EQ(swatch("a", {1000, 800}), 23 * 23) << "0.03 times 800 pixels";
    EXPECT_EQ(swatch("a", {600, 240}), 11 * 11);
    // A third of 120 pixels: text of 10.4 takes 41 with border 8, padding 6 twice, row 15 and gap 6;
    // of 9.4, 39.
    EXPECT_EQ(swatch("a", {120, 120}), 9 * 9);
    EXPECT_EQ(swatch("a name that is wider than the picture", {120, 60}), 7 * 7) << "0.95 times 7";
}

// Beside the strip the content is framed as in a whole picture: its margin is 5 %, one axis fills the rest.
TEST(AnnotationRoom, IsLeftByAnAutomaticCamera) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic})
        for (const Vec2i& size : {Vec2i(600, 240), Vec2i(640, 480), Vec2i(480, 640), Vec2i(1920, 1080)})
            for (const int bars : {1, 2})
                for (const Corner corner : {Corner::top_right, Corner::bottom_left}) {
                    Session session = session_of(bars, size);
                    session.settings().camera.projection = projection;
                    session.settings().annotation.corner = corner;
                    const Camera plain = session.camera();
                    session.settings().annotation.colorbar = true;
                    const Insets strip = session.annotation_strip();
                    const bool fits = strip != Insets();
                    EXPECT_TRUE(fits || size.x() < size.y()) << size.transpose() << " " << bars;
                    const Camera camera = session.camera();
                    EXPECT_EQ(camera.T_world_cam.matrix() != plain.T_world_cam.matrix(), fits);
                    // The same direction, but for what is rounded in doubles on the way from another place.
                    EXPECT_LT((camera.T_world_cam.linear() - plain.T_world_cam.linear()).norm(), 1e-12);
                    EXPECT_FALSE(camera.intrinsics);
                    const Extent e = extent_of(session.scene().snapshot(), camera, size, strip);
                    // The float 0.05, and doubles' roundings.
                    EXPECT_NEAR(std::max(e.high.maxCoeff(), -e.low.minCoeff()), 0.95, 1e-6);
                    EXPECT_NEAR((e.high - e.low).maxCoeff(), 1.9, 1e-6);
                }
}

TEST(AnnotationRoom, IsLeftAnewWhenTheAnnotationChanges) {
    Session session = session_of(1, {320, 180});
    const auto position = [&] {
        session.render();
        return Vec3d(session.camera().position());
    };
    const Vec3d plain = position();
    session.settings().annotation.corner = Corner::top_left;
    EXPECT_EQ(position(), plain) << "there is no annotation";
    session.settings().annotation.colorbar = true;
    const Vec3d left = position();
    EXPECT_NE(left, plain);
    EXPECT_EQ(position(), left);
    session.settings().annotation.corner = Corner::top_right;
    EXPECT_NE(position(), left);
    session.settings().annotation.colorbar = false;
    EXPECT_EQ(position(), plain);
    session.set_camera(Camera::look_at(Vec3d(1, 2, 9), Vec3d::Zero()));
    session.settings().annotation.colorbar = true;
    EXPECT_EQ(position(), Vec3d(1, 2, 9)) << "a pinned camera stays";
}

TEST(AnnotationRoom, IsLeftByTurntables) {
    Session session = session_of(1, {160, 90});
    session.settings().annotation.colorbar = true;
    const Insets strip = session.annotation_strip();
    ASSERT_GT(strip.right, 0.1);
    const CameraPath path = turntable(session, 1);
    Extent all;
    for (const double t : path.times(24)) {
        const Extent e = extent_of(session.scene().snapshot(), path.camera(t, session.camera()),
                                   session.settings().image.size, strip);
        all.low = all.low.min(e.low);
        all.high = all.high.max(e.high);
    }
    // The margin, 5 % of both sides together, is kept; at 24 angles the box nearly reaches the cylinder
    // around it.
    const double farthest = std::max(all.high.maxCoeff(), -all.low.minCoeff());
    EXPECT_LE(farthest, 0.95 + 1e-6);
    EXPECT_GT(farthest, 0.94);
}

}  // namespace easypbr::app::annotation_room_test
