// Motion blur of the view at rest: it shows what a recording's frame shows at that time.
#include <algorithm>
#include <cstdlib>
#include <functional>

#include "easypbr/geometry/primitives.h"
#include "gui/motion_panels.h"
#include "scene/slide.h"

namespace easypbr::gui::blur_at_rest_test {
namespace {

class BlurAtRest : public MotionPanels {};

/// The still of the view's size that comes after a picture of what `before` has done, which `after` undoes.
Image still_after(app::Session& session, const Vec2i& size, const std::function<void()>& before,
                  const std::function<void()>& after) {
    before();
    session.render({size, 1});
    after();
    return session.render({size, session.settings().image.samples});
}

bool same(const Image& a, const Image& b) {
    return std::ranges::equal(a.bytes(), b.bytes());
}

/// To one step of 8 bits: near planes that differ round depths differently.
bool alike(const Image& a, const Image& b) {
    return std::ranges::equal(a.bytes(), b.bytes(), [](std::byte x, std::byte y) {
        return std::abs(std::to_integer<int>(x) - std::to_integer<int>(y)) <= 1;
    });
}

// At rest the view shows what a recording's frame shows at this time: what happened since the frame before.
TEST_F(BlurAtRest, AnAnimationAtRestIsBlurred) {
    view_.state().panels.shown = false;
    look_from({0, 1, 5});
    AnimationNode node;
    node.mesh = session_.scene().get("ball");
    player_.add("ball", Animations({{node}, {}, {}, {slide("slide")}}));
    session_.settings().motion_blur.enabled = true;
    session_.settings().motion_blur.shutter = 1;
    session_.settings().image.samples = 6;
    view_.drawing().recording_form().fps = 2;  // A frame before the ball was a quarter of a unit to the left.
    player_.play(0);
    player_.pause();
    player_.seek(2);
    settle();
    const Image shown = view_.drawing().picture().image();
    const auto put = [&](double time) { return [this, time] { player_.seek(time); }; };
    EXPECT_TRUE(same(shown, still_after(session_, size, put(1.5), put(2))));
    const Image sharp = still_after(session_, size, put(2), put(2));
    EXPECT_FALSE(same(shown, sharp));
    // Twice as fast is twice as far.
    player_.set_speed(2);
    step();
    settle();
    EXPECT_TRUE(same(view_.drawing().picture().image(), still_after(session_, size, put(1), put(2))));
    session_.settings().motion_blur.enabled = false;
    settle();
    const Image off = view_.drawing().picture().image();
    EXPECT_TRUE(same(off, session_.render({size, 6})));
}

// The animation moves the first of two children that share a name.
TEST_F(BlurAtRest, OnlyTheSiblingThatMovesIsBlurred) {
    view_.state().panels.shown = false;
    look_from({0, 1, 5});
    Mesh ball = session_.scene().get("ball"), twin = ball.clone(), parent;
    twin.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 1, 0)));
    session_.scene().remove("ball");
    parent.add_child(ball);
    parent.add_child(twin);
    session_.scene().show(parent, "pair");
    AnimationNode node;
    node.mesh = ball;
    player_.add("pair", Animations({{node}, {}, {}, {slide("slide")}}));
    session_.settings().motion_blur.enabled = true;
    session_.settings().image.samples = 4;
    view_.drawing().recording_form().fps = 2;
    player_.play(0);
    player_.pause();
    player_.seek(2);
    settle();
    const Image shown = view_.drawing().picture().image();
    EXPECT_TRUE(same(shown, still_after(
                                session_, size, [&] { player_.seek(1.5); }, [&] { player_.seek(2); })));
}

TEST_F(BlurAtRest, ACameraThatRestsOnItsPathIsBlurred) {
    session_.scene().show(make_box(), "ball");
    three_keys();
    session_.settings().motion_blur.enabled = true;
    session_.settings().image.samples = 4;
    // The cameras come by two ways, and differ in the last bit: so may courses of rays and texels of shadows.
    session_.settings().path.enabled = false;
    session_.settings().ground.mode = GroundMode::none;
    const CameraPath path = *view_.drawing().path().editor.path();
    view_.drawing().recording_form().fps = 4;
    view_.drawing().path().editor.seek(0.7);
    settle();
    const Image shown = view_.drawing().picture().image();
    const auto look = [&](double time) {
        return [this, time, &path] { session_.set_camera(path.camera(time, session_.camera())); };
    };
    EXPECT_TRUE(alike(shown, still_after(session_, size, look(0.45), look(0.7))));
    EXPECT_FALSE(alike(shown, still_after(session_, size, look(0.7), look(0.7))));
    // Elsewhere it has not come along the path.
    look_from({1, 1, 5});
    settle();
    const auto nothing = [] {};
    EXPECT_TRUE(same(view_.drawing().picture().image(), still_after(session_, size, nothing, nothing)));
}

}  // namespace
}  // namespace easypbr::gui::blur_at_rest_test
