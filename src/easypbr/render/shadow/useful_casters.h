// Which casters the shadow maps of a light leave out: floors, whose shadows fall on nothing.
#pragma once

#include <optional>
#include <vector>

#include "easypbr/render/shadow/convex_faces.h"
#include "easypbr/scene/resolved_light.h"

namespace easypbr::render {

/// Of an object that casts shadows.
struct CasterExtent {
    Box3d box;                      ///< world; of its vertices
    double reach = 0;               ///< of what it draws beyond them
    std::vector<FacePlane> planes;  ///< world: convex_faces(); none of what can be seen into

    /// With what it draws beyond its vertices; empty where these are none.
    Box3d drawn() const;
};

/// All casters of a scene.
struct CasterSet {
    CasterSet() = default;
    explicit CasterSet(std::vector<CasterExtent> casters);

    std::vector<CasterExtent> extents;
    std::vector<size_t> convex;  ///< the largest of those with planes, by their indices, in rising order
    Box3d others;                ///< bounds of the casters that are not in `convex`
    Box3d bounds;                ///< of all
    double reach = 0;            ///< the largest
};

/// Casters for the maps of a light.
struct UsefulCasters {
    Box3d bounds;                  ///< what the maps have to show
    std::vector<size_t> left_out;  ///< casters, by their indices, in rising order
};

/// Shadows are filtered this far around a place at most, as a part of a map: as
/// shaders/common_shadow_filter.glsl has it.
constexpr double widest_filter = 0.15;

/// Leaves out flat and convex casters with a face above which are the light and all others: they hide the
/// light from nothing, and maps of what stands on them are finer. Others of less than half their size may
/// sink in by 1/100 of their own, and any may be lower by 1/1000 of the size of the smaller one. `extent`:
/// the radius of the light, world units, or the tangent of a directional light's angular radius; 0 for hard
/// shadows. Maps have room for the penumbrae that it gives. `ground`: the plane that receives shadows
/// besides, which casters that are left out lie on.
UsefulCasters useful_casters(const ResolvedLight& light, const CasterSet& casters, double extent,
                             const std::optional<FacePlane>& ground);

}  // namespace easypbr::render
