// What casts shadows as rays find it: triangles and discs in a tree of boxes, on the CPU.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/raytrace/path_vectors.h"

namespace easypbr::render {

struct CasterTree;

/// The ground under the casters, seen from above (GroundPass); world space.
struct RayGround {
    Vec3d up{0, 1, 0};
    double height = 0;    ///< along `up`
    double radius = 1;    ///< around the casters' centre; it fades towards it; infinity: endless
    Vec3 color{0, 0, 0};  ///< linear
    float roughness = 1;
    bool shadow_catcher =
        false;  ///< shows what lies behind it where it is open to the sky, in place of a colour
};

/// Faces of a mesh.
struct FaceRange {
    int first = 0, count = 0;
};

/// A place on an element of a surface.
struct SurfacePlace {
    int surface = -1;    ///< for RayScene::surface(); -1: the ground
    int element = 0;     ///< face or vertex of the mesh
    float u = 0, v = 0;  ///< barycentric coordinates of the face's second and third vertex
};

/// Where a ray ends.
struct RayHit {
    const DrawItem* item = nullptr;  ///< null: the ground
    int surface = -1;                ///< for RayScene::surface(); -1: the ground
    int element = 0;                 ///< face or vertex of the mesh
    float u = 0, v = 0;              ///< barycentric coordinates of the face's second and third vertex
    Vec3 position;                   ///< world, relative to RayScene::centre(), in RayScene::unit()
    Vec3 normal;                     ///< unit, of the element itself, towards where the ray came from
    float distance = 0;              ///< in RayScene::unit()

    SurfacePlace on() const { return {surface, element, u, v}; }
};

/// A ray from a place in a unit direction, as far as `distance` (RayScene's frame).
struct RaySegment {
    Vec3 from{0, 0, 0}, direction{0, 0, 1};
    float distance = 0;
};

/// Of rays that are traced together.
enum class Neighbours {
    similar,   ///< mostly start beside each other, in almost the same direction: they take a part of the time
    scattered  ///< in all directions
};

/// What surfaces that transmit light are to rays.
enum class Transmissive {
    passed,  ///< they stop the part of the rays that they take from light, chosen by a hash of the ray
    met,     ///< they are surfaces like others, but blended ones let a part of the rays through, as above
    opaque,  ///< they are surfaces like others; blended ones let all rays through
    layers   ///< all are surfaces like others, wherever anything of them is seen
};

/// Positions are relative to the casters' centre and in units of half their diagonal, so that single
/// precision holds them at any scale and place. Masked surfaces have their holes, by the nearest texel.
class RayScene {
  public:
    RayScene();
    ~RayScene();

    /// Takes note of the casters, which must live as long as rays are traced; the tree is made anew when
    /// `generation` is another one (ShadowMaps::casters_generation()). `bounds` are those of all casters.
    void update(const DrawList& casters, const Box3d& bounds, uint64_t generation,
                const Primitives& primitives, const std::optional<RayGround>& ground);

    /// Makes the surfaces of what update() was given; they live as long as its casters.
    void make_surfaces(const ResolvedSettings& resolved);
    const HitSurface& surface(int index) const;
    int surface_count() const;
    /// Another one each time that surfaces are made.
    uint64_t surfaces_generation() const { return surfaces_generation_; }
    const DrawItem& item_of(int surface) const;
    /// Of all surfaces together.
    ExtensionSet extensions() const { return extensions_; }
    /// The faces of a surface whose material emits; none of surfaces with holes, or that light passes.
    FaceRange emissive_faces(int surface) const;
    /// The corners of a face, relative to centre(), in unit().
    std::array<Vec3, 3> triangle(int surface, int face) const;

    /// Of a face of a volume that a ray in a unit direction has met: whether it stands for a way of its
    /// thickness alone. Its mesh has holes, and the ray meets no face of the same object next that looks the
    /// other way.
    bool is_sheet(const RayHit& hit, const Vec3& direction) const;

    bool empty() const { return scene_ == nullptr; }
    const Vec3d& centre() const { return centre_; }
    double unit() const { return unit_; }
    /// How far the element of a lit surface reaches around its vertex, so that rays that leave it start
    /// beyond its neighbours, which overlap it; 0 of faces and of the ground.
    float reach(const SurfacePlace& on) const;
    /// The same of what a ray has met, and what its position is off by besides after a ray longer than 2.
    float reach(const RayHit& hit) const {
        return reach(hit.on()) + std::max(0.0f, rounding(hit.distance) - rounding(2));
    }

    /// Holds all casters; RayScene's frame. Its radius is 0 where there are none.
    struct Ball {
        Vec3 centre{0, 0, 0};
        float radius = 0;

        /// Whether a ray from a place in a unit direction meets it.
        bool is_met(const Vec3& from, const Vec3& direction) const {
            const Vec3 way = centre - from;
            const float along = way.dot(direction), outside = way.squaredNorm() - radius * radius;
            return outside <= 0 || (along > 0 && along * along >= outside);
        }
    };
    const Ball& ball() const { return ball_; }

    /// What a place on a surface that a ray has met is off by at most, that far from the scene's centre: its
    /// coordinates, those of the ray and of the element are of 24 bits.
    static float rounding(float distance) { return std::max(1.0f, distance) * 2e-6f; }
    /// Where rays start that leave a place of a surface: beyond its roundings along `away`, of length 1 or 2,
    /// and beyond `reach`.
    static Vec3 off_surface(const Vec3& at, const Vec3& away, const Vec3& reach = Vec3::Zero());

    /// The same of what a ray has met, along a unit normal.
    Vec3 start_at(const RayHit& hit, const Vec3& normal) const {
        return off_surface(hit.position, normal, normal * reach(hit));
    }

    const std::optional<RayGround>& ground() const { return ground_; }

    /// From a place on a face of a mesh to the smooth surface that its normals tell of, on the side of the
    /// unit vector `face`: see smooth_surface.h. 0 of all else.
    Vec3 to_smooth(const SurfacePlace& on, const Vec3& face) const;

    /// The first surface in the direction (unit); safe to call from several threads, as are the others.
    /// Gaussians stop the part of the rays that their opacity is, by a hash of the ray; there the normal is
    /// opposite to the direction.
    std::optional<RayHit> trace(const Vec3& from, const Vec3& direction,
                                Transmissive transmissive = Transmissive::passed) const;
    /// Distance to the ground; infinity where it is not met, or passed where it fades, by a hash of the ray.
    float ground_distance(const Vec3& from, const Vec3& direction) const {
        return ground_distance(from, direction, true);
    }
    /// What a camera's pixel shows, as rays find it.
    struct Seen {
        Vec3 position;
        Vec3 face;    ///< normal of the element itself: the interpolated one lies above it or below
        Vec3 normal;  ///< the interpolated one, but for a surface that stands before the place
        /// Of the element; where none is found, of the nearest one along the view, but no less than
        /// Place::rounding().
        float reach = 0;
        SurfacePlace on;  ///< -1 where the normal is not interpolated
    };
    /// A pixel's surface as the rasteriser has it.
    struct Place {
        Vec3 position, normal, view;  ///< view: unit, towards the viewer
        float footprint = 0;          ///< width of the pixel there

        /// What the position may be off by: the rasteriser rounds vertices to 1/256 of a pixel, which is 16
        /// times as much along the view where the surface is that steep.
        float rounding() const { return std::max(RayScene::rounding(position.norm()), footprint / 16); }
        /// How far before it a face may stand that is seen in its stead.
        float before() const { return std::max(rounding(), footprint); }
    };
    /// What is seen at a place along its view. The rasteriser rounds vertices to a
    /// part of a pixel: a place that lies beyond an adjacent face by less than its footprint moves onto that
    /// face.
    Seen seen_at(const Place& place, Transmissive transmissive = Transmissive::passed) const;
    /// Many places, with an array for each number.
    struct Places {
        /// `capacity` places at most.
        explicit Places(size_t capacity)
            : position(whole_streams(capacity)),
              normal(position.room()),
              view(position.room()),
              face(position.room()),
              footprint(position.room()),
              reach(position.room()),
              on(position.room()) {}

        Place at(size_t i) const { return {position.at(i), normal.at(i), view.at(i), footprint[i]}; }

        size_t count = 0;
        PathVectors<3> position, normal, view;
        PathVectors<3> face;  ///< of what is seen
        std::vector<float> footprint;
        std::vector<float> reach;      ///< of what is seen
        std::vector<SurfacePlace> on;  ///< likewise
    };
    /// The same of many places: puts what is seen there in their stead. Of neighbours in a part of the time.
    void see(Places& places, Transmissive transmissive) const;
    /// The surface at a place that is seen along its view; none where its edges are rounded away.
    std::optional<RayHit> hit_at(const Place& place, Transmissive transmissive) const;
    /// Whether any caster lies nearer than `distance` (RayScene::unit()). The ground is none.
    bool blocked(const Vec3& from, const Vec3& direction, float distance,
                 Transmissive transmissive = Transmissive::passed) const;
    /// The same of many rays, 1 where one is blocked. Nothing blocks those of no length or less.
    std::vector<uint8_t> blocked(std::span<const RaySegment> rays, Neighbours neighbours,
                                 Transmissive transmissive = Transmissive::passed) const;
    /// What casters nearer than `distance` leave of light that passes them straight. Faces stop it that are
    /// as rough as `stopping` or more (Passage::roughness).
    Vec3 transmittance(const Vec3& from, const Vec3& direction, float distance,
                       float stopping = passes_all) const;
    static constexpr float passes_all = 2;

  private:
    /// `by_chance`: with Gaussians, and a ground that fades, which stop a part of the rays.
    std::optional<RayHit> first_hit(const RaySegment& ray, Transmissive transmissive, bool by_chance) const;
    float ground_distance(const Vec3& from, const Vec3& direction, bool fades) const;
    void place_ground();
    /// What is seen where no surface is found.
    Seen nothing_at(const Place& place) const {
        return {
            place.position, place.normal, place.normal, std::max(reach_beside(place), place.rounding()), {}};
    }
    /// The reach of the nearest element along the view that reaches as far as the place: between elements
    /// that overlap a pixel shows their mean. The largest of all surfaces where there is none.
    float reach_beside(const Place& place) const;
    /// What a ray to the place has met, after `distance`.
    Seen seen_by(const Place& place, const RaySegment& ray, float distance, const Vec3& face,
                 const SurfacePlace& on) const;
    /// Unit normals of the corners of a face of a mesh; none where it has no others than its own.
    std::optional<std::array<Vec3, 3>> corner_normals(const SurfacePlace& on) const;
    /// Whether a normal is one of the surface, and no other's that a pixel has by rounding. An interpolated
    /// one may lie on any side of its face, a mapped one anywhere above it.
    bool has_normal(const SurfacePlace& on, const Vec3& face, const Vec3& normal) const;
    SurfacePlace place_on(unsigned geometry, unsigned primitive, float u, float v) const;

    std::unique_ptr<CasterTree> scene_;
    std::optional<RayGround> ground_;
    /// The ground in RayScene's frame.
    struct Plane {
        Vec3 up{0, 1, 0};
        float height = 0, radius = 0;
    };
    Plane plane_;
    uint64_t generation_ = 0, surfaces_generation_ = 1;
    Vec3d centre_{0, 0, 0};
    double unit_ = 1;
    float reach_ = 0;  ///< the largest of all surfaces
    Ball ball_;
    ExtensionSet extensions_ = 0;
};

}  // namespace easypbr::render
