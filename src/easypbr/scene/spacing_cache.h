// Spacings of clouds by the revision of their points.
#pragma once

#include <map>

#include "easypbr/scene/spacing.h"

namespace easypbr {

class SpacingCache {
  public:
    double get(const Array3f& V) {
        const auto [entry, is_new] = entries_.try_emplace(V.revision());
        if (is_new) entry->second.spacing = point_spacing(V);
        entry->second.used = true;
        return entry->second.spacing;
    }

    /// Drops what was not asked for since the last call.
    void evict_unused() {
        std::erase_if(entries_, [](const auto& item) { return !item.second.used; });
        for (auto& [revision, entry] : entries_) entry.used = false;
    }

  private:
    struct Entry {
        double spacing = 0;
        bool used = false;
    };
    std::map<uint64_t, Entry> entries_;
};

}  // namespace easypbr
