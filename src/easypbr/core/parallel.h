// Deterministic parallel loops: what is computed never depends on the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace easypbr {

/// Calls body(begin, end) for consecutive chunks of [0, count), each of `grain` items but the last, on all
/// cores, of EASYPBR_THREADS at most. The chunks depend on count and grain alone. Exceptions are passed on to
/// the caller. Throws Interrupted, and, as all below, ArgumentError for an EASYPBR_THREADS that is no number.
void parallel_chunks(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body);

/// Calls body(index) for every index in [0, count), on all cores, `grain` at a time.
template <class Body>
void parallel_for(size_t count, size_t grain, Body&& body) {
    parallel_chunks(count, grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) body(i);
    });
}

/// An index under the key that it is sorted by.
struct KeyedIndex {
    uint64_t key;
    uint32_t index;
};

/// Sorts by key, equal keys by index, on all cores.
void parallel_sort(std::vector<KeyedIndex>& items);

/// Number of threads used by the loops: EASYPBR_THREADS, else the cores that the process may use, or as many
/// as its control groups give time for (core/control_group.h).
int thread_count();

}  // namespace easypbr
