// How much of the light reaches splats: a darkening of their own colours by the surfaces around them.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "easypbr/core/revision_cache.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/primitives/place_light.h"

namespace easypbr::render {

/// The axis of a splat along which it is thinnest, unit, in the world, on the side of `towards`.
Vec3d splat_normal(const DrawItem& item, Eigen::Index i, const Vec3d& towards);

/// Parts of the light on both sides of splats, each found when it is first asked for.
class SplatLight {
  public:
    /// What was found for another light or other places is forgotten. The light must live until the next
    /// call; null: all arrives.
    void set(const PlaceLight* light);

    /// Of the splats of an item.
    class Parts {
      public:
        explicit Parts(size_t count) : sides_(2 * count) {}
        /// The colour, sRGB-encoded, of a splat that is seen from the side of `towards`; safe to call from
        /// several threads.
        Vec3 darkened(const PlaceLight& light, const DrawItem& item, Eigen::Index i, const Vec3d& towards,
                      const Vec3& color);

      private:
        static constexpr uint8_t unknown = 0;
        std::vector<std::atomic<uint8_t>> sides_;  ///< parts from 1 to 255
    };
    /// Null: all arrives.
    std::shared_ptr<Parts> parts_of(const DrawItem& item);
    const PlaceLight* light() const { return light_; }

  private:
    using Key = std::vector<double>;  ///< revisions and pose
    const PlaceLight* light_ = nullptr;
    uint64_t generation_ = 0;
    RevisionCache<Key, std::shared_ptr<Parts>> parts_;
};

}  // namespace easypbr::render
