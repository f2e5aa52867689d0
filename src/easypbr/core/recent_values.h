// What was computed last, kept for whoever asks again.
#pragma once

#include <cstddef>
#include <list>
#include <mutex>
#include <utility>

namespace easypbr {

/// The last values by what they were made from, as many as `most`. From any thread.
template <class Key, class Value>
class RecentValues {
  public:
    explicit RecentValues(size_t most) : most_(most) {}

    /// The value of a key, made by make() where it is not kept. Two threads may make the same one.
    template <class Make>
    Value get(const Key& key, Make&& make) {
        {
            const std::lock_guard lock(mutex_);
            for (auto it = entries_.begin(); it != entries_.end(); ++it)
                if (it->first == key) {
                    entries_.splice(entries_.begin(), entries_, it);
                    return it->second;
                }
        }
        Value value = make();
        const std::lock_guard lock(mutex_);
        entries_.emplace_front(key, value);
        if (entries_.size() > most_) entries_.pop_back();
        return value;
    }

  private:
    const size_t most_;
    std::mutex mutex_;
    std::list<std::pair<Key, Value>> entries_;  ///< the last first
};

}  // namespace easypbr
