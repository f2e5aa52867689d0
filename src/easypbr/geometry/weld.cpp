#include "easypbr/geometry/weld.h"

#include <meshoptimizer.h>

#include "easypbr/core/parallel.h"

namespace easypbr::geometry {

Weld weld_positions(const Array3f& V) {
    const auto count = size_t(V.rows());
    // Bytes are compared: adding 0 makes -0 the same as 0.
    Array3f::Dense positions(V.rows(), 3);
    parallel_for(size_t(V.size()), size_t(1) << 16,
                 [&](size_t i) { positions.data()[i] = V.data()[i] + 0.0f; });
    std::vector<unsigned int> remap(count);
    const size_t unique =
        count ? meshopt_generateVertexRemap(remap.data(), nullptr, count, positions.data(), count, 12) : 0;
    Weld weld;
    weld.place.assign(remap.begin(), remap.end());
    weld.first.reserve(unique);
    // Numbers are given in the order of the vertices.
    for (size_t i = 0; i < count; ++i)
        if (remap[i] == weld.first.size()) weld.first.push_back(int32_t(i));
    return weld;
}

void remember_seams(MeshData& mesh) {
    const Weld weld = weld_positions(mesh.V);
    if (weld.count() == weld.place.size())
        mesh.source_vertex = {};
    else
        mesh.source_vertex = Array1i::Dense(
            Eigen::Map<const Array1i::Dense>(weld.place.data(), Eigen::Index(weld.place.size())));
}

}  // namespace easypbr::geometry
