// Real files for tests, outside the tree: the folder that the environment variable EASYPBR_TEST_DATA names.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

/// Path of a test file, or an empty path when EASYPBR_TEST_DATA is not set.
inline std::filesystem::path test_data(const std::string& name) {
    const char* folder = std::getenv("EASYPBR_TEST_DATA");
    return folder && *folder ? std::filesystem::path(folder) / name : std::filesystem::path();
}

/// Leaves the test out, and says so, when there is no test data.
#define REQUIRE_TEST_DATA() \
    if (test_data("").empty()) GTEST_SKIP() << "left out: EASYPBR_TEST_DATA is not set"
