// Which casters the shadow maps of a light leave out: floors, whose shadows fall on nothing.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "easypbr/render/shadow/convex_faces.h"
#include "easypbr/scene/resolved_light.h"

namespace easypbr::render {

/// Of an object that casts shadows.
struct CasterExtent {
    Box3d box;                      ///< world; of its vertices
    double reach = 0;               ///< of what it draws beyond them
    std::vector<FacePlane> planes;  ///< world: convex_faces()
};

/// Casters for the maps of a light.
struct UsefulCasters {
    Box3d bounds;                  ///< what the maps have to show
    std::vector<size_t> left_out;  ///< casters, by their indices, in rising order

    bool operator==(const UsefulCasters& other) const {
        return bounds.min() == other.bounds.min() && bounds.max() == other.bounds.max() &&
               left_out == other.left_out;
    }
};

/// Leaves out flat and convex casters with a face above which are the light and all others: they hide the
/// light from nothing, and maps of what stands on them are finer. Small others may sink in by 1/100 of their
/// size. `all`: the bounds of all casters. `penumbra`: the radius of the light's widest penumbrae within
/// `all`, world units, which the maps have room for. `ground`: the plane that receives shadows besides, which
/// casters that are left out lie on.
UsefulCasters useful_casters(const ResolvedLight& light, std::span<const CasterExtent> casters,
                             const Box3d& all, double penumbra, const std::optional<FacePlane>& ground);

}  // namespace easypbr::render
