// What reads bytes that come from anywhere, as functions of bytes: fuzzed by `make fuzz`, and run on the kept
// files of tests/fuzz/seeds by the tests.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace easypbr::fuzz {

struct Target {
    std::string name;  ///< of its folder of seeds too
    /// Reads the bytes. What they are refused with, an easypbr::Error, is caught; anything else is a fault.
    void (*run)(std::span<const std::byte> bytes);
};

const std::vector<Target>& targets();

}  // namespace easypbr::fuzz
