// A scene as it is drawn: what colours an object and what its voxels look like, as plain vertices, faces and
// colours.
#pragma once

#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "easypbr/core/revision_cache.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/scene/crease.h"
#include "easypbr/scene/element_colors.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr {
struct InferredSettings;
}

namespace easypbr::render {

/// How an object's colours are meant.
struct ColorMeaning {
    bool from_data = false;  ///< they stand for the material's base colour
    bool exact = false;      ///< they are those of a table
    bool labels = false;     ///< that of labels
    bool values = false;   ///< the base colour texture is a table of values, the first coordinate their place
    bool textured = true;  ///< the material's base colour texture counts
    bool vertex_colors = true;
};

/// Where what is drawn of an object came from, in the object's own data. Empty: the same.
struct ElementSources {
    Array1i faces;   ///< for each face its face, or, of voxels, the first vertex in the voxel
    Array1i points;  ///< for each vertex its vertex; where a cut made one, that with the largest part in it
    double voxel_size = 0;  ///< edge of the voxels that were made of the vertices; 0: none were

    /// What the element target holds (see GBuffer::element), as 1 + index in the object's own data.
    uint32_t own(uint32_t drawn) const {
        const Array1i& source = drawn & point_element ? points : faces;
        const uint32_t place = drawn & ~point_element;
        return source.empty() ? place : uint32_t(source(Eigen::Index(place) - 1)) + 1;
    }
};

/// What Style::show_points draws beside an object. Data that colour faces need not fit vertices.
struct PointsOnTop {
    std::shared_ptr<const MeshData> mesh;  ///< null: what the object itself is drawn of
    ColorMeaning meaning;
};

struct DrawableScene {
    SceneSnapshot scene;  ///< the same objects in the same order, their data replaced where that is needed
    std::vector<ColorMeaning> meanings;   ///< one for each object
    std::vector<ElementSources> sources;  ///< one for each object
    std::vector<PointsOnTop> points;      ///< one for each object
};

/// Makes and keeps what is as large as the data.
class DrawableCache {
  public:
    /// The cache is shared with other passes, must outlive this one, and is emptied by its owner.
    explicit DrawableCache(SpacingCache& spacings) : spacings_(spacings) {}

    /// Throws ArgumentError and NameError as plan_colors(), require_colors() and voxel_mesh() do.
    DrawableScene apply(const SceneSnapshot& scene, const InferredSettings& settings);

    /// Drops what was not asked for since the last call.
    void evict_unused();

  private:
    struct Entry {
        std::shared_ptr<const MeshData> arrays;
        ElementSources sources;  ///< of the arrays that they were made of
        Texture table;           ///< of values or texture coordinates; empty for colours
    };
    /// The entry's arrays as the current object's; where there is none, make(entry) gives its arrays.
    template <class Make>
    std::shared_ptr<const MeshData> get(const std::string& key, const MeshData& current,
                                        ElementSources& sources, Make&& make);
    void apply(DrawableScene& drawable, size_t index, const InferredSettings& settings);
    /// The object's data, coloured by a plan.
    std::shared_ptr<const MeshData> colored(const SceneSnapshot::Object& object, const ColorPlan& plan,
                                            ElementSources& sources);
    /// An object's data, split where those without normals have sharp edges or faces wound against each
    /// other.
    std::shared_ptr<const MeshData> creased(const SceneSnapshot::Object& object, float angle_deg,
                                            ElementSources& sources);
    /// What clip planes leave of data that a plan has coloured.
    std::shared_ptr<const MeshData> clipped(const std::shared_ptr<const MeshData>& whole,
                                            const std::vector<Eigen::Vector4d>& planes, bool by_vertex,
                                            bool labels, ElementSources& sources);
    std::shared_ptr<const MeshData> as_voxels(const std::shared_ptr<const MeshData>& centres, double size,
                                              ElementSources& sources);

    SpacingCache& spacings_;
    RevisionCache<std::string, Entry> entries_;
    using SharedCreases = std::shared_ptr<const Creases>;
    /// Of V, F and source_vertex at an angle.
    RevisionCache<std::tuple<uint64_t, uint64_t, uint64_t, float>, SharedCreases> creases_;
    /// Of a node with these F and source_vertex, without a shape at rest: those of its first V, so that edges
    /// of a mesh that deforms do not turn sharp and smooth from picture to picture.
    RevisionCache<std::tuple<uint64_t, uint64_t, uint64_t, float>, SharedCreases> kept_creases_;
};

}  // namespace easypbr::render
