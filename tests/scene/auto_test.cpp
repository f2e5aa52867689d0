#include "easypbr/scene/auto.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <type_traits>

namespace easypbr::auto_test {
namespace {

template <class To, class From>
constexpr bool is_taken = std::is_assignable_v<To&, From>&& std::is_constructible_v<To, From>;

// "auto" converts to true: it would pin the setting that is to be inferred.
static_assert(!is_taken<Auto<bool>, const char*> && !is_taken<Auto<bool>, const char (&)[5]>);
static_assert(!std::is_assignable_v<Auto<bool>&, const char (&)[5]>);
static_assert(!std::is_constructible_v<Auto<bool>, void*> &&
              !std::is_constructible_v<Auto<bool>, void (*)()>);
static_assert(!std::is_convertible_v<std::nullptr_t, Auto<bool>>);
static_assert(!std::is_assignable_v<Override<bool>&, const char (&)[5]>);
static_assert(!std::is_constructible_v<Override<bool>, const char*>);

// All else stays as it is.
static_assert(is_taken<Auto<bool>, bool> && is_taken<Auto<bool>, int> && is_taken<Override<bool>, bool>);
static_assert(is_taken<Auto<bool>, AutomaticTag> && is_taken<Auto<bool>, FollowTag>);
static_assert(is_taken<Auto<std::string>, const char (&)[5]> && is_taken<Auto<std::string>, std::string>);

TEST(Auto, TakesTruthValues) {
    Auto<bool> enabled;
    enabled = false;
    EXPECT_TRUE(enabled.is_pinned());
    EXPECT_FALSE(enabled.value_or(true));
    enabled = automatic;
    EXPECT_FALSE(enabled.value());
}

}  // namespace
}  // namespace easypbr::auto_test
