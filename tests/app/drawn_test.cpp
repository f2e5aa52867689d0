// What a session drew, as a value: read at once, later, or too late.
#include "easypbr/app/drawn.h"

#include <gtest/gtest.h>

#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::drawn_test {
namespace {

Session small_session() {
    Scene scene;
    scene.show(make_sphere(1, 16), "ball");
    Session session(scene);
    session.settings().image.size = Vec2i(48, 32);
    session.settings().image.samples = 2;
    return session;
}

bool equal_bytes(const Image& a, const Image& b) {
    return std::ranges::equal(a.bytes(), b.bytes());
}

std::string message_of(const std::function<void()>& use) {
    try {
        use();
    } catch (const ArgumentError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(DrawnTest, IsThePictureUntilAnotherOneIsDrawn) {
    Session session = small_session();
    const Image still = session.render();
    const Drawn drawn = session.draw();
    EXPECT_TRUE(drawn.is_plain());
    EXPECT_TRUE(equal_bytes(drawn.picture(), still));
    EXPECT_TRUE(equal_bytes(drawn.picture(), still)) << "may be read again";
    EXPECT_EQ(drawn.camera().position(), session.camera().position());
    session.settings().tonemap.exposure_compensation = 1;
    const Drawn brighter = session.draw();
    EXPECT_NE(message_of([&] { drawn.picture(); }).find("outdated"), std::string::npos);
    EXPECT_THROW(drawn.texture(), ArgumentError);
    EXPECT_FALSE(equal_bytes(brighter.picture(), still));
    EXPECT_THROW(Drawn().picture(), ArgumentError);
    EXPECT_THROW(Drawn().surfaces(), ArgumentError);
}

TEST(DrawnTest, SurfacesDrawnLaterLeaveThePicture) {
    Session session = small_session();
    const Image still = session.render();
    const Drawn picture = session.draw();
    EXPECT_NE(message_of([&] { picture.surfaces(); }).find("no surfaces"), std::string::npos);
    const Drawn surfaces = session.draw_surfaces({}, false);
    EXPECT_NE(message_of([&] { surfaces.picture(); }).find("no picture"), std::string::npos);
    const render::SurfaceFrame frame = surfaces.surfaces();
    EXPECT_EQ(frame.size, Vec2i(48, 32));
    EXPECT_EQ(frame.object[size_t(16 * 48 + 24)], 1u);
    EXPECT_EQ(surfaces.layer(render::Layer::depth).width(), 48);
    const std::vector<uint8_t> alone = surfaces.coverage({24, 16, 1, 1}, [](size_t, int) { return true; });
    EXPECT_EQ(alone, std::vector<uint8_t>{1});
    EXPECT_TRUE(equal_bytes(picture.picture(), still));
    session.pick({24, 16});
    EXPECT_NE(message_of([&] { surfaces.surfaces(); }).find("outdated"), std::string::npos);
    EXPECT_THROW(surfaces.layer(render::Layer::depth), ArgumentError);
    EXPECT_THROW(surfaces.coverage({0, 0, 1, 1}, [](size_t, int) { return true; }), ArgumentError);
    EXPECT_THROW(surfaces.targets(), ArgumentError);
    EXPECT_TRUE(equal_bytes(picture.picture(), still));
    const Drawn both = session.draw_surfaces({}, true);
    EXPECT_TRUE(equal_bytes(both.picture(), still));
    EXPECT_EQ(both.surfaces().object, frame.object);
    session.render_layers({"depth"});
    EXPECT_THROW(both.picture(), ArgumentError);
}

TEST(DrawnTest, WhatIsOnItsWayIsNotOutdated) {
    Session session = small_session();
    const Image still = session.render();
    PendingPicture pending = session.draw().read_later();
    session.settings().tonemap.exposure_compensation = 1;
    session.render();
    EXPECT_TRUE(equal_bytes(pending.take(), still));
}

TEST(DrawnTest, ARefinedPictureIsThereOnceItIsFinished) {
    Session session = small_session();
    const Image still = session.render();
    const Session::Refinement first = session.refine({}, false);
    EXPECT_NE(message_of([&] { first.drawn.picture(); }).find("no picture"), std::string::npos);
    const Session::Refinement second = session.refine();
    EXPECT_TRUE(equal_bytes(second.drawn.picture(), still));
    EXPECT_TRUE(equal_bytes(session.refine().drawn.picture(), still)) << "complete: nothing is drawn";
    // Frames of another picture take the place of this one, finished or not.
    session.refine({Vec2i(32, 32), 4}, false);
    EXPECT_THROW(second.drawn.picture(), ArgumentError);
}

TEST(DrawnTest, OutlivesItsSession) {
    Drawn drawn;
    Image still;
    {
        Session session = small_session();
        still = session.render();
        drawn = session.draw();
    }
    EXPECT_TRUE(equal_bytes(drawn.picture(), still));
}

}  // namespace
}  // namespace easypbr::app::drawn_test
