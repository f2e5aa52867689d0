// The accessors of a primitive's vertices, and what they hold.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/io/mesh/gltf/gltf_vertices.h"

namespace easypbr::io {

/// Primitives with the same share their vertices.
struct GltfBlockAccessors {
    using Accessor = std::optional<size_t>;

    Accessor position, normal, uv, color, tangent;
    std::vector<std::array<Accessor, 2>> influences;  ///< joints and weights, one for each set
    std::vector<Accessor> values;                     ///< one for each name that is asked for
    std::vector<std::array<Accessor, 2>> targets;     ///< positions and normals, one for each morph target
    /// The buffer view with the compressed vertices, of which there may be several for the same accessors.
    Accessor compressed;

    auto all() const {
        return std::tie(position, normal, uv, color, tangent, influences, values, targets, compressed);
    }
    bool operator<(const GltfBlockAccessors& other) const { return all() < other.all(); }
};

/// Those of a primitive. `uv_set`: the texture coordinates that its material asks for; without them those of
/// set 0. `value_names`: of application-specific attributes. Throws FormatError for what is no accessor.
GltfBlockAccessors block_accessors(const GltfDocument& document, const Json& primitive, int uv_set,
                                   const std::set<std::string>& value_names,
                                   std::optional<size_t> compressed);

/// Reads the vertices of a mesh's primitives.
class GltfBlockReader {
  public:
    /// `name`: of the mesh, for messages.
    GltfBlockReader(GltfDocument& document, std::string name, std::set<std::string> value_names)
        : document_(document), name_(std::move(name)), value_names_(std::move(value_names)) {}

    const std::set<std::string>& value_names() const { return value_names_; }

    /// `rows`: those that are read, ascending and below the number of positions; null: all. What is left out
    /// takes no memory. Throws FormatError for accessors that do not fit together; values that do not are
    /// left out with a warning.
    VertexBlock read(const GltfBlockAccessors& accessors, const std::vector<int32_t>* rows);

    /// What float32 made of the columns of an attribute in all that was read; empty where it has all values
    /// of its types.
    const std::vector<RoundingCounts>& rounding(const std::string& value_name) {
        return rounding_[value_name];
    }

  private:
    struct Vertices;

    void read_values(const GltfBlockAccessors& accessors, const Vertices& vertices, GltfValues& values);

    GltfDocument& document_;
    std::string name_;
    std::set<std::string> value_names_;
    std::map<std::string, std::vector<RoundingCounts>> rounding_;
};

}  // namespace easypbr::io
