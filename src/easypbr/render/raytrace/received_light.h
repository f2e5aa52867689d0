// What surfaces leave of the light of lamps and sky, found by rays: of places that are no surfaces
// themselves.
#pragma once

#include <vector>

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/primitives/place_light.h"
#include "easypbr/render/raytrace/ray_scene.h"
#include "easypbr/scene/resolved_light.h"

namespace easypbr::render {

/// Lamps are weighed by the irradiance that they send, and the sky by its mean: what hides some of it hides
/// as much of its light. Rays are sent to points of each lamp, and into the part of the sky that the casters
/// may hide.
class ReceivedLight final : public PlaceLight {
  public:
    /// What hides light; it must live as long as parts are asked for.
    struct Surfaces {
        const DrawList& list;  ///< empty: nothing hides light
        uint64_t generation;   ///< ShadowMaps::casters_generation()
        const Primitives& primitives;
        bool hide_sky;  ///< else lamps alone
    };
    /// Takes note of them and of the lights of a frame.
    void update(const Frame& frame, const Surfaces& surfaces);

    float part_at(const Vec3d& place, const Vec3d& normal, uint32_t number) const override;
    Vec3 light_at(const Vec3d& place, const Vec3d& normal, uint32_t number) const override;
    uint64_t generation() const override { return generation_; }

  private:
    /// Light that a white matt surface reflects: all of a lamp or the sky, and what arrives.
    struct Sum {
        Vec3d all{0, 0, 0}, arrives{0, 0, 0};
    };
    /// Of a place in the frame of the rays.
    struct Place {
        Vec3d world;
        Vec3 at, normal;
        uint32_t number;
    };
    Sum from_lamp(const ResolvedLight& light, const Place& place) const;
    Sum from_sky(const Place& place) const;
    Sum from_all(const Vec3d& place, const Vec3d& normal, uint32_t number) const;
    /// The part of the sky's light that the casters hide.
    double hidden_sky(const Place& place) const;
    double left(const Place& place, const Vec3& direction, double distance) const;

    RayScene scene_;
    const ResolvedSettings* resolved_ = nullptr;
    Box3d bounds_;  ///< of the surfaces
    uint64_t casters_ = 0, generation_ = 0;
    // Of the last update: lights, and what the sky's light depends on.
    std::vector<ResolvedLight> lights_;
    std::vector<float> sky_;
    std::string environment_;
    bool hides_sky_ = true;
};

}  // namespace easypbr::render
