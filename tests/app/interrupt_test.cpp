// A picture may be given up at every step: what comes after is as if it had never been begun.
#include "easypbr/core/interrupt.h"

#include <gtest/gtest.h>

#include "easypbr/app/session.h"
#include "easypbr/core/image.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"

namespace easypbr::interrupt_test {
namespace {

const app::PictureOptions options{Vec2i(320, 240), 8, app::Encoding::srgb8};

Scene teapot() {
    Scene scene;
    scene.show(make_teapot(1, 4), "teapot");
    return scene;
}

void turn_all_on(app::Session& session) {
    Settings& settings = session.settings();
    settings.bloom.enabled = true;
    settings.ground.mode = GroundMode::plane;
}

/// Draws until the n-th step; whether it was given up there.
bool interrupted_at(app::Session& session, int n) {
    int steps = 0;
    const InterruptScope scope([&] { return ++steps >= n; });
    try {
        session.render(options);
        return false;
    } catch (const Interrupted&) {
        return true;
    }
}

TEST(Interrupt, EveryStepOfAPictureCanBeTheLast) {
    const Scene scene = teapot();
    app::Session fresh(scene);
    turn_all_on(fresh);
    const Image expected = fresh.render(options);
    app::Session session(scene);
    turn_all_on(session);
    int n = 1;
    // Steps grow apart, so that a picture of thousands is given up some hundred times.
    for (; interrupted_at(session, n); n += 1 + n / 20) {
        // The next picture is drawn with what the last attempt left.
        if (n % 3 != 0) continue;
        ASSERT_EQ(compare(session.render(options), expected).max, 0) << "given up at " << n;
    }
    EXPECT_GE(n, 8);  // at least once a sample
    EXPECT_EQ(compare(session.render(options), expected).max, 0);
}

TEST(Interrupt, TheInnermostScopeCounts) {
    check_interrupt();
    EXPECT_FALSE(can_be_interrupted());
    const InterruptScope outer([] { return true; });
    EXPECT_THROW(check_interrupt(), Interrupted);
    {
        const InterruptScope inner{{}};
        EXPECT_NO_THROW(check_interrupt());
    }
    EXPECT_THROW(check_interrupt(), Interrupted);
}

}  // namespace
}  // namespace easypbr::interrupt_test
