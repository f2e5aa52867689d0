// Arrays that are the same to the bit, for tests of what files hold.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

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

}  // namespace easypbr
