// Batches of what meshes hold, while they are drawn again and again.
#pragma once

#include <memory>
#include <utility>

#include "easypbr/core/background.h"
#include "easypbr/core/revision_cache.h"

namespace easypbr::render {

/// Batches by the revisions of what they are made from.
template <class Key, class Batches>
class BatchCache {
  public:
    /// Takes note that something is drawn. Its batches begin to be made, by make() in the background, when it
    /// is drawn for the second time: a single picture would not earn them back. Null until there are any.
    template <class Make>
    const Batches* draw(const Key& key, Make&& make) {
        Entry& entry = entries_.get(key, [] { return Entry(); });
        if (++entry.draws == 2)
            entry.batches = std::make_unique<BackgroundValue<Batches>>(std::forward<Make>(make));
        return entry.batches ? entry.batches->get() : nullptr;
    }
    void evict_unused() { entries_.evict_unused(); }

  private:
    struct Entry {
        int draws = 0;
        std::unique_ptr<BackgroundValue<Batches>> batches;
    };
    RevisionCache<Key, Entry> entries_;
};

}  // namespace easypbr::render
