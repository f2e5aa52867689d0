// Mutation fuzzing: a good file with some bytes changed, cut out or doubled must load or throw
// easypbr::Error.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include "easypbr/core/error.h"

/// Mutants per loader: the environment variable EASYPBR_FUZZ_COUNT, else 200.
inline int fuzz_count() {
    const char* text = std::getenv("EASYPBR_FUZZ_COUNT");
    return text ? std::max(1, std::atoi(text)) : 200;
}

/// One of the mutants of a file; the same for the same state of the generator.
inline std::string mutated(std::string bytes, std::mt19937& random) {
    const auto below = [&](size_t end) { return end ? size_t(random() % end) : 0; };
    const int changes = 1 + int(below(8));
    for (int i = 0; i < changes && !bytes.empty(); ++i) {
        // Half of the changes hit the first bytes, where sizes and counts stand.
        const size_t at = below(random() % 2 ? bytes.size() : std::min<size_t>(bytes.size(), 512));
        const size_t length = std::min(bytes.size() - at, 1 + below(16));
        switch (below(6)) {
            case 0:
                bytes[at] = char(random());
                break;
            case 1:
                bytes[at] = char(bytes[at] ^ (1 << below(8)));
                break;
            case 2:
                bytes.replace(at, length, length, random() % 2 ? '\xff' : '\0');
                break;
            case 3:
                bytes.erase(at, length);
                break;
            case 4:
                bytes.insert(at, bytes.substr(at, length));
                break;
            default:
                if (below(4) == 0)
                    bytes.resize(at);
                else
                    bytes[at] = "0123456789-+.eE[]{}\","[below(21)];
        }
    }
    return bytes;
}

/// Loads mutants; anything thrown that is no easypbr::Error fails the test, with the number of the mutant.
inline void fuzz(const std::string& good, const std::function<void(const std::string&)>& load) {
    ASSERT_NO_THROW(load(good)) << "the unchanged file must load";
    std::mt19937 random(20240229);
    for (int i = 0; i < fuzz_count(); ++i) try {
            load(mutated(good, random));
        } catch (const easypbr::Error&) {
        } catch (const std::exception& error) {
            ADD_FAILURE() << "mutant " << i << ": " << error.what();
        }
}
