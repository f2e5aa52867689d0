#include "easypbr/geometry/weld.h"

#include <meshoptimizer.h>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/awaited.h"

namespace easypbr::geometry {

std::vector<unsigned int> numbered_rows(std::shared_ptr<const void> rows, size_t count, size_t size) {
    return awaited(count, [rows = std::move(rows), count, size] {
        std::vector<unsigned int> numbers(count);
        if (count) meshopt_generateVertexRemap(numbers.data(), nullptr, count, rows.get(), count, size);
        return numbers;
    });
}

Weld weld_positions(const Array3f& V) {
    const auto count = size_t(V.rows());
    // Bytes are compared: adding 0 makes -0 the same as 0.
    const auto positions = std::make_shared<std::vector<float>>(3 * count);
    parallel_for(positions->size(), size_t(1) << 16, [&](size_t i) { (*positions)[i] = V.data()[i] + 0.0f; });
    const std::vector<unsigned int> remap =
        numbered_rows({positions, positions->data()}, count, 3 * sizeof(float));
    Weld weld;
    weld.place.assign(remap.begin(), remap.end());
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
