// Emissive triangles as light sources of next-event estimation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "easypbr/render/raytrace/ray_scene.h"

namespace easypbr::render {

/// The emissive triangles of a scene: opaque meshes whose material emits. Each is chosen by its share of
/// their light: of few triangles, of that which falls on the place if nothing is in between. What emits and
/// is not among them (discs and polygons around vertices, surfaces with holes) is found by chance alone.
class Emitters {
  public:
    /// Keeps what it makes of a scene until its surfaces are made anew; the scene must outlive the other
    /// calls.
    void prepare(const RayScene& scene);

    bool empty() const { return triangles_.empty(); }
    /// Light that they send to a place that is as far away as the scene's radius, RGB's mean: the integral of
    /// radiance over directions.
    float brightness() const { return brightness_; }

    struct Sample {
        native::ElementHit hit;  ///< its footprint is not set
        int surface = 0;         ///< for RayScene::surface()
        Vec3 direction;          ///< unit
        float distance = 0;      ///< in RayScene::unit()
        float density = 0;       ///< per steradian; 0: nothing of them is seen
    };
    /// A point of a triangle by a point of the unit square. `from` in RayScene's frame. There must be one.
    Sample sample(const Vec3& from, const Vec2& u) const;
    /// Density of directions that sample() chooses for what a ray has met in one of them; 0 for other
    /// surfaces.
    float density(const RayHit& hit, const Vec3& direction) const;

  private:
    struct Triangle {
        Vec3 corner, edge1, edge2;
        Vec3 centre, normal;
        float area = 0;
        int surface = 0, element = 0;
        float weight = 0;  ///< chance per area
    };
    void add_surface(const RayScene& scene, int surface);
    bool are_few() const;
    /// So many triangles are weighed against each other for each place.
    static constexpr size_t few = 64;
    static constexpr size_t lane_count = 4;
    using Floats = float __attribute__((vector_size(lane_count * sizeof(float))));
    using Masks = int32_t __attribute__((vector_size(lane_count * sizeof(float))));
    /// Few triangles, several at once; those that fill up the last send nothing.
    struct Lanes {
        Floats centre[3] = {}, normal[3] = {};
        Floats least[3] = {}, most[3] = {};  ///< of the closed mesh that it belongs to, outside of which back
                                             ///< faces are not seen
        Floats area = Floats{} + 1.0f, light = {};
    };
    using Weights = std::array<float, few>;
    void make_lanes();
    /// What triangles send to a place, about and relative to each other; 0 where they are hidden by the mesh
    /// that they belong to. Each weight is the sum of itself and those before; returns the last.
    float weigh(const Vec3& from, Weights& ends) const;
    /// Sets what sample() returns for a point of a triangle that is chosen with a density per area.
    Sample sample_on(const Triangle& triangle, const Vec3& from, const Vec2& u, float density) const;

    uint64_t generation_ = 0;
    std::vector<Triangle> triangles_;
    std::vector<float> ends_;  ///< CDF
    /// The elements of a surface that emits, and where theirs begin in `chances_`.
    struct Elements {
        int first = 0, count = 0;
        size_t at = 0;
        /// Of a closed mesh: outside of it back faces are not seen. Empty for others.
        Eigen::AlignedBox3f solid;
    };
    std::vector<Elements> elements_;  ///< for each surface
    std::vector<float> chances_;      ///< chance per area
    std::vector<size_t> places_;      ///< in triangles_, of those that have a chance
    std::vector<Lanes> lanes_;
    float brightness_ = 0;
};

}  // namespace easypbr::render
