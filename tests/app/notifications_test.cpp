// Messages to the person who looks.
#include "easypbr/app/notifications.h"

#include <gtest/gtest.h>

namespace easypbr::app::notifications_test {
namespace {

TEST(Notifications, AnErrorThatIsToldAgainIsShownOnceAndStaysFromThenOn) {
    Notifications messages;
    messages.add("too large", true);
    messages.add("Saved a.json");
    messages.advance(1);
    const uint64_t before = messages.revision();
    messages.add("too large", true);
    EXPECT_GT(messages.revision(), before);
    ASSERT_EQ(messages.list().size(), 2u);
    EXPECT_EQ(messages.list()[0].text, "Saved a.json");
    EXPECT_EQ(messages.list()[1].text, "too large");
    EXPECT_GT(messages.list()[1].seconds_left, messages.list()[0].seconds_left);
    const double whole = messages.list()[1].seconds_left;
    messages.add("too large", true);
    EXPECT_EQ(messages.list().back().seconds_left, whole);
    // What was done twice is told twice.
    messages.add("Saved a.json");
    EXPECT_EQ(messages.list().size(), 3u);
}

}  // namespace
}  // namespace easypbr::app::notifications_test
