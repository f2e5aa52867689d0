// Light that reaches splats: how much the surfaces around them darken their own colours, or how it lights
// them.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "easypbr/core/revision_cache.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/primitives/place_light.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {

/// The axis of a splat along which it is thinnest, unit, in the world, on the side of `towards`.
Vec3d splat_normal(const DrawItem& item, Eigen::Index i, const Vec3d& towards);

/// Light on both sides of splats, each found when it is first asked for.
class SplatLight {
  public:
    /// What was found for another light or other places is forgotten. The light must live until the next
    /// call; null: all arrives.
    void set(const PlaceLight* light);
    /// Whether splats are lit, in place of being darkened.
    static bool relights(const ResolvedSettings& resolved) { return resolved.settings.splats.relight; }

    /// Of the splats of an item.
    class Parts {
      public:
        Parts(size_t count, bool are_lit)
            : sides_(are_lit ? 0 : 2 * (count + count % 2)), lit_sides_(are_lit ? 2 * count : 0) {}
        /// The colour, sRGB-encoded, of a splat that is seen from the side of `towards`; safe to call from
        /// several threads.
        Vec3 darkened(const PlaceLight& light, const DrawItem& item, Eigen::Index i, const Vec3d& towards,
                      const Vec3& color);

        /// The radiance, scene-linear and before exposure, of a splat that is lit and seen from the side of
        /// `towards`, as if it were a matt surface.
        Vec3 lit(const PlaceLight& light, const DrawItem& item, Eigen::Index i, const Vec3d& towards);

        /// Both sides of all splats, two bytes each, in whole words of four: the part of the light, from 1,
        /// none, to 255, all. Found where nobody has asked for them. Not for those that are lit.
        std::span<const std::byte> all_sides(const PlaceLight& light, const DrawItem& item);
        /// Counts how often it is called.
        int count_frames() { return ++frames_; }

      private:
        static constexpr uint8_t unknown = 0;
        uint8_t part_of(const PlaceLight& light, const DrawItem& item, Eigen::Index i, const Vec3d& normal);
        int frames_ = 0;
        bool has_all_ = false;
        std::vector<std::atomic<uint8_t>> sides_;       ///< parts from 1 to 255
        std::vector<std::atomic<uint32_t>> lit_sides_;  ///< shared exponents, never 0
    };
    /// Null: all arrives.
    std::shared_ptr<Parts> parts_of(const DrawItem& item, bool are_lit);
    const PlaceLight* light() const { return light_; }

  private:
    using Key = std::vector<double>;  ///< revisions and pose
    const PlaceLight* light_ = nullptr;
    uint64_t generation_ = 0;
    RevisionCache<Key, std::shared_ptr<Parts>> parts_;
};

}  // namespace easypbr::render
