// Arrays and images that are the same to the bit, for tests of what files hold.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "easypbr/core/image.h"

namespace easypbr {

template <class A, class B>
::testing::AssertionResult same_bits(const A& a, const B& b) {
    if (a.rows() != b.rows() || a.cols() != b.cols())
        return ::testing::AssertionFailure()
               << a.rows() << " x " << a.cols() << " and " << b.rows() << " x " << b.cols();
    if (a.size() && std::memcmp(a.data(), b.data(), size_t(a.size()) * sizeof(*a.data())) != 0)
        return ::testing::AssertionFailure() << "values differ";
    return ::testing::AssertionSuccess();
}

inline ::testing::AssertionResult same_bits(const Image& a, const Image& b) {
    if (a.width() != b.width() || a.height() != b.height())
        return ::testing::AssertionFailure()
               << a.width() << " x " << a.height() << " and " << b.width() << " x " << b.height();
    if (a.channels() != b.channels() || a.type() != b.type())
        return ::testing::AssertionFailure() << "channels or types differ";
    if (std::memcmp(a.bytes().data(), b.bytes().data(), a.bytes().size()) != 0)
        return ::testing::AssertionFailure() << "pixels differ";
    return ::testing::AssertionSuccess();
}

}  // namespace easypbr
