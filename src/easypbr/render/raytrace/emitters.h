// Emissive triangles as light sources of next-event estimation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/render/raytrace/path_batch.h"
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

    /// Points of triangles that places have chosen, with an array for each number.
    struct Samples {
        explicit Samples(size_t count_);

        size_t count;
        PathVectors<3> direction;     ///< unit
        PathVectors<3> radiance;      ///< that the point sends
        std::vector<float> distance;  ///< in RayScene::unit()
        std::vector<float> density;   ///< per steradian; 0: nothing of them is seen

      private:
        friend class Emitters;
        std::vector<int32_t> triangle;
        std::vector<float> u, v, cosine;
    };
    /// A point for each of `count` places (RayScene's frame), by points of the unit square. There must be a
    /// triangle.
    Samples sample(const RayScene& scene, const PathVectors<3>& from, const PathVectors<2>& points,
                   size_t count) const;
    /// What a ray has met, in a sampled direction.
    struct Met {
        const RayHit& hit;
        Vec3 direction;
    };
    /// The density with which sample() chooses the directions of rays for what they have met; 0 for other
    /// surfaces.
    std::vector<float> densities(std::span<const Met> met) const;

  private:
    struct Triangle {
        Vec3 corner, edge1, edge2;
        Vec3 centre, normal;
        float area = 0;
        int surface = 0, element = 0;
        float weight = 0;  ///< chance per area
        Vec3 emission;
        bool is_uniform = false;  ///< it emits the same everywhere
    };
    void add_surface(const RayScene& scene, int surface);
    /// So many triangles are weighed against each other for each place.
    bool are_few() const { return triangles_.size() <= native::FewEmitters::room; }
    void make_few();
    void sample_many(const PathVectors<3>& from, const PathVectors<2>& points, Samples& samples) const;
    void find_radiance(const RayScene& scene, Samples& samples) const;
    /// The place in `triangles_` of what a ray has met; -1 where it is none of them.
    int triangle_of(const RayHit& hit) const;

    uint64_t generation_ = 0;
    std::vector<Triangle> triangles_;
    std::vector<float> ends_;  ///< CDF
    /// The elements of a surface that emits, and where theirs begin in `places_`.
    struct Elements {
        int first = 0, count = 0;
        size_t at = 0;
        /// Of a closed mesh: outside of it back faces are not seen. Empty for others.
        Eigen::AlignedBox3f solid;
    };
    std::vector<Elements> elements_;  ///< for each surface
    std::vector<int> places_;         ///< of the elements in `triangles_`; -1: it does not shine
    native::FewEmitters few_;
    float brightness_ = 0;
};

}  // namespace easypbr::render
