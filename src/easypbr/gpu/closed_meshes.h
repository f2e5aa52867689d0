// Which meshes need no back faces, by the revisions of their geometry.
#pragma once

#include <utility>

#include "easypbr/core/revision_cache.h"
#include "easypbr/gpu/facing.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::gpu {

class ClosedMeshes {
  public:
    /// Takes note that a mesh is drawn and returns what is known of its winding. That is found out when it is
    /// drawn for the second time, unless it is small or `needed`: it takes passes over all faces, which a
    /// single picture would not earn back.
    Winding draw(const MeshData& mesh, bool needed) {
        Entry& entry = entries_.get(key_of(mesh), [] { return Entry(); });
        const int draws_before = needed || mesh.F.rows() <= small_mesh ? 0 : 1;
        if (entry.draws++ >= draws_before && !entry.is_known) {
            entry.winding = winding_of(mesh.V, mesh.F);
            entry.is_known = true;
        }
        return entry.winding;
    }

    /// The winding of a mesh, whatever it takes; no drawing is noted.
    Winding find(const MeshData& mesh) {
        Entry& entry = entries_.get(key_of(mesh), [] { return Entry(); });
        if (!entry.is_known) entry.winding = winding_of(mesh.V, mesh.F);
        entry.is_known = true;
        return entry.winding;
    }

    /// Whether a mesh is known to be closed and wound outward; it is not noted.
    bool is_known(const MeshData& mesh) const {
        const Entry* const entry = entries_.find(key_of(mesh));
        return entry && entry->winding == Winding::outward;
    }

    /// Drops what was not drawn since the last call.
    void evict_unused() { entries_.evict_unused(); }

  private:
    /// Faces that are looked through in less than a millisecond.
    static constexpr Eigen::Index small_mesh = 1 << 14;
    struct Entry {
        int draws = 0;
        bool is_known = false;
        Winding winding = Winding::unknown;
    };
    using Key = std::pair<uint64_t, uint64_t>;
    static Key key_of(const MeshData& mesh) { return {mesh.V.revision(), mesh.F.revision()}; }

    RevisionCache<Key, Entry> entries_;
};

}  // namespace easypbr::gpu
