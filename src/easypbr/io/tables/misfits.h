// Values of columns of integers that are none.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "easypbr/io/source/source.h"

namespace easypbr::io {

/// Whether a number is an integer of 32 bits. In columns of integers others become -1, which no index check
/// lets pass.
inline bool is_int32(double value) {
    return value >= INT32_MIN && value <= INT32_MAX && std::floor(value) == value;
}

/// How many values of a property are no integers of 32 bits, by the property's name.
using MisfitCounts = std::map<std::string, size_t>;

/// The counts of a table, joined by the threads that read its pieces.
class Misfits {
  public:
    void add(const std::string& name, size_t count) {
        if (count == 0) return;
        const std::lock_guard lock(mutex_);
        counts_[name] += count;
    }
    void add(const MisfitCounts& counts) {
        for (const auto& [name, count] : counts) add(name, count);
    }
    void clear() { counts_.clear(); }

    /// Logs a warning for each property that has some.
    void warn(const Source& source) const;

  private:
    std::mutex mutex_;
    MisfitCounts counts_;
};

}  // namespace easypbr::io
