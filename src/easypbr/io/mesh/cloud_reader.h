// Point clouds out of tables: what the formats of clouds have in common.
#pragma once

#include <bit>
#include <memory>
#include <vector>

#include "easypbr/io/tables/element_table.h"
#include "easypbr/io/tables/vertex_arrays.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// Binary elements that lie one after the other from `body` on: one element with all properties (a point
/// after the other), or several with some of them and as many rows (a field after the other).
struct BinaryTable {
    Source source;
    const char* body;
    std::endian endian;
    std::vector<Element> elements;
};

/// Reads the points of tables that have as many rows. Fields get their meaning by their names (see
/// VertexArrays), those of the first table before others; positions are recentred. Throws FormatError when
/// there are no points, no positions, or less bytes than the elements take. Points without finite positions
/// are still there.
MeshData read_binary_cloud(const Source& source, const std::vector<BinaryTable>& tables);

/// Takes the bytes of a table as they come. push() is given what follows what it has used, and says how much
/// of it that are whole rows it uses; the rest is given again, with more behind it.
class CloudStream {
  public:
    CloudStream(const Source& source, std::vector<Element> elements);
    ~CloudStream();

    /// Positions of these fields lose nothing when they are recentred after reading.
    static bool can_read(const std::vector<Element>& elements);

    size_t push(const char* data, size_t size);

    /// When all bytes have come.
    MeshData finish();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The same for text, with one element.
MeshData read_text_cloud(const Source& source, const TextRows& rows, const Element& element);

}  // namespace easypbr::io
