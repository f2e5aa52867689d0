// What is made of data and kept while somebody asks for it.
#pragma once

#include <map>
#include <utility>

namespace easypbr {

/// Values by what they were made from: a key holds the revisions of the arrays, and whatever else decides
/// about the value. A revision names its data for ever, so a value never becomes wrong; it is only no longer
/// asked for. One thread at a time.
template <class Key, class Value>
class RevisionCache {
  public:
    /// The value of a key, made by make() where there is none. Valid until the eviction that drops it. What
    /// make() throws passes through, and nothing is kept.
    template <class Make>
    Value& get(const Key& key, Make&& make) {
        auto found = entries_.find(key);
        if (found == entries_.end()) found = entries_.emplace(key, Entry{make()}).first;
        found->second.used = true;
        return found->second.value;
    }

    /// The value that is kept for a key, or null. Does not count as a use.
    const Value* find(const Key& key) const {
        const auto found = entries_.find(key);
        return found == entries_.end() ? nullptr : &found->second.value;
    }

    /// Drops the values that get() was not asked for since the last call.
    void evict_unused() {
        std::erase_if(entries_, [](const auto& item) { return !item.second.used; });
        for (auto& [key, entry] : entries_) entry.used = false;
    }

  private:
    struct Entry {
        Value value;
        bool used = true;
    };
    std::map<Key, Entry> entries_;
};

}  // namespace easypbr
