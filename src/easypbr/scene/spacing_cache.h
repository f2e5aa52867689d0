// Spacings of clouds by the revision of their points.
#pragma once

#include "easypbr/core/revision_cache.h"
#include "easypbr/scene/spacing.h"

namespace easypbr {

class SpacingCache {
  public:
    double get(const Array3f& V) {
        return spacings_.get(V.revision(), [&] { return point_spacing(V); });
    }

    const AutomaticDiscs& discs(const Array3f& V) {
        return discs_.get(V.revision(), [&] { return automatic_discs(V); });
    }

    /// Points that are a part of a cloud have discs of the whole's size.
    void share_discs(const Array3f& whole, const Array3f& part) {
        const AutomaticDiscs of_whole = discs(whole);
        discs_.get(part.revision(), [&] { return of_whole; });
    }

    /// Drops what was not asked for since the last call.
    void evict_unused() {
        spacings_.evict_unused();
        discs_.evict_unused();
    }

  private:
    RevisionCache<uint64_t, double> spacings_;
    RevisionCache<uint64_t, AutomaticDiscs> discs_;
};

}  // namespace easypbr
