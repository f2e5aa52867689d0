#include "easypbr/geometry/place.h"

#include <algorithm>

#include "easypbr/core/interrupt.h"
#include "easypbr/geometry/disjoint_sets.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/weld.h"

namespace easypbr {
namespace {

/// Numbers from 0 in the order in which values first occur.
template <class Of>
Array1i numbered(Eigen::Index count, size_t values, Of&& value_of) {
    std::vector<int32_t> number(values, -1);
    Array1i::Dense result(count);
    int32_t next = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
        check_interrupt(size_t(i));
        int32_t& known = number[size_t(value_of(i))];
        if (known < 0) known = next++;
        result[i] = known;
    }
    return result;
}

/// Connected positions of a mesh.
class Pieces {
  public:
    explicit Pieces(const MeshData& mesh) : weld_(geometry::weld_positions(mesh.V)), sets_(weld_.count()) {
        for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
            check_interrupt(size_t(f));
            sets_.unite(place(mesh.F(f, 0)), place(mesh.F(f, 1)));
            sets_.unite(place(mesh.F(f, 0)), place(mesh.F(f, 2)));
        }
        for (Eigen::Index e = 0; e < mesh.E.rows(); ++e) {
            check_interrupt(size_t(e));
            sets_.unite(place(mesh.E(e, 0)), place(mesh.E(e, 1)));
        }
    }

    int32_t of(Eigen::Index vertex) { return sets_.find(place(int32_t(vertex))); }
    size_t count() const { return weld_.count(); }

  private:
    int32_t place(int32_t vertex) const { return weld_.place[size_t(vertex)]; }

    geometry::Weld weld_;
    geometry::DisjointSets sets_;
};

/// Rows by the piece of their first index.
template <class Indices>
std::vector<std::vector<int32_t>> by_piece(const Indices& indices, const Array1i& piece_of, size_t pieces) {
    std::vector<std::vector<int32_t>> rows(pieces);
    for (Eigen::Index i = 0; i < indices.rows(); ++i)
        rows[size_t(piece_of[indices(i, 0)])].push_back(int32_t(i));
    return rows;
}

}  // namespace

Array1i vertex_components(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    Pieces pieces(*data);
    return numbered(data->V.rows(), pieces.count(), [&](Eigen::Index v) { return pieces.of(v); });
}

Array1i face_components(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    Pieces pieces(*data);
    return numbered(data->F.rows(), pieces.count(), [&](Eigen::Index f) { return pieces.of(data->F(f, 0)); });
}

std::vector<Mesh> split(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    if (data->E.empty()) geometry::require_faces("split", *data);
    const Array1i piece_of = vertex_components(mesh);
    const auto count = size_t(piece_of.maxCoeff()) + 1;
    auto faces = by_piece(data->F, piece_of, count), edges = by_piece(data->E, piece_of, count);
    std::vector<std::vector<int32_t>> vertices(count);
    for (Eigen::Index v = 0; v < piece_of.rows(); ++v) vertices[size_t(piece_of[v])].push_back(int32_t(v));
    geometry::Selection selection;
    selection.place.assign(size_t(data->V.rows()), -1);
    std::vector<Mesh> result;
    for (size_t piece = 0; piece < count; ++piece) {
        check_interrupt();
        if (faces[piece].empty() && edges[piece].empty()) continue;
        selection.vertices = vertices[piece];
        for (size_t i = 0; i < selection.vertices.size(); ++i)
            selection.place[size_t(selection.vertices[i])] = int32_t(i);
        selection.faces = std::move(faces[piece]);
        selection.edges = std::move(edges[piece]);
        MeshData own = geometry::chosen(*data, selection);
        own.children.clear();
        result.emplace_back(std::move(own));
    }
    return result;
}

}  // namespace easypbr
