// What was computed last, kept for whoever asks again.
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <unordered_map>
#include <utility>

namespace easypbr {

/// The last values by what they were made from, as many as `most`. From any thread.
template <class Key, class Value, class Hash = std::hash<Key>>
class RecentValues {
  public:
    explicit RecentValues(size_t most) : most_(most) {}

    /// The value of a key, made by make() where it is not kept. Two threads may make the same one.
    template <class Make>
    Value get(const Key& key, Make&& make) {
        if (!(key == key)) return make();  // Of NaN: it would never be found again.
        {
            const std::lock_guard lock(mutex_);
            if (const auto found = places_.find(key); found != places_.end()) {
                entries_.splice(entries_.begin(), entries_, found->second);
                return found->second->second;
            }
        }
        Value value = make();
        const std::lock_guard lock(mutex_);
        if (places_.contains(key)) return value;
        entries_.emplace_front(key, value);
        places_.emplace(key, entries_.begin());
        if (entries_.size() > most_) {
            places_.erase(entries_.back().first);
            entries_.pop_back();
        }
        return value;
    }

  private:
    using Entries = std::list<std::pair<Key, Value>>;

    const size_t most_;
    std::mutex mutex_;
    Entries entries_;  ///< the last first
    std::unordered_map<Key, typename Entries::iterator, Hash> places_;
};

}  // namespace easypbr
