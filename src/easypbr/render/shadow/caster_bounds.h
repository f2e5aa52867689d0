// How large what casts shadows is.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "easypbr/core/revision_cache.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/shadow/useful_casters.h"

namespace easypbr::render {

/// Keeps what it has found: of all casters while these stay the same, of meshes for as long as they cast.
class CasterBounds {
  public:
    /// Of the items of a list in world space, with what reaches beyond their vertices; of meshes by the
    /// vertices that faces have. Empty when there are none.
    const CasterSet& of(const DrawList& casters, const Primitives& primitives);

    /// The same of the last list, and of which objects they are: these live as long as it.
    const CasterSet& last() const { return set_; }
    const SceneSnapshot::Object* object(size_t caster) const { return objects_[caster]; }

  private:
    /// All that the bounds of an item depend on.
    struct Caster {
        uint64_t V, F;
        DrawMode kind;
        double reach;
        Eigen::Matrix4d pose;
        /// Some part of it is not opaque, so that what it hides light from within is seen; or it is drawn in
        /// several ways.
        bool seen_into;

        bool operator==(const Caster&) const = default;
    };

    /// What is drawn of an item; of a mesh without the vertices that no face has.
    std::shared_ptr<const MeshData> used(const DrawItem& item, DrawMode kind);
    void note_what_is_seen_into(const DrawList& casters, std::vector<Caster>& noted) const;
    CasterExtent extent_of(const DrawItem& item, DrawMode kind, double reach);

    using Vertices = std::vector<Eigen::Index>;
    std::vector<Caster> casters_;
    CasterSet set_;  ///< of these
    std::vector<const SceneSnapshot::Object*> objects_;
    RevisionCache<std::pair<uint64_t, uint64_t>, std::vector<FacePlane>>
        planes_;  ///< of meshes, in their frames
    RevisionCache<std::pair<uint64_t, Eigen::Index>, Vertices>
        unused_;  ///< by the faces, and how many vertices
    RevisionCache<std::pair<uint64_t, uint64_t>, std::shared_ptr<const MeshData>> meshes_;
};

}  // namespace easypbr::render
