#include "easypbr/geometry/adjacency.h"

#include <algorithm>

#include "easypbr/core/parallel.h"

namespace easypbr::geometry {

Adjacency::Adjacency(const MeshData& mesh) : weld_(weld_positions(mesh.V)) {
    const auto corner = [&](Eigen::Index f, int k) { return weld_.place[size_t(mesh.F(f, k))]; };
    const auto for_each_step = [&](auto&& visit) {
        for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
            for (int k = 0; k < 3; ++k) {
                const int32_t a = corner(f, k), b = corner(f, (k + 1) % 3);
                if (a == b) continue;
                visit(a, b);
                visit(b, a);
            }
    };
    begin_.assign(count() + 1, 0);
    for_each_step([&](int32_t from, int32_t) { ++begin_[size_t(from) + 1]; });
    for (size_t i = 0; i < count(); ++i) begin_[i + 1] += begin_[i];
    std::vector<size_t> next(begin_.begin(), begin_.end() - 1);
    neighbors_.resize(begin_.back());
    for_each_step([&](int32_t from, int32_t to) { neighbors_[next[size_t(from)]++] = to; });
    degree_.assign(count(), 0);
    faces_of_edge_.assign(neighbors_.size(), 0);
    is_border_.assign(count(), 0);
    parallel_for(count(), 4096, [&](size_t i) {
        int32_t* const first = neighbors_.data() + begin_[i];
        std::sort(first, neighbors_.data() + begin_[i + 1]);
        size_t unique = 0;
        for (size_t at = begin_[i]; at < begin_[i + 1]; ++at) {
            const bool is_new = unique == 0 || first[unique - 1] != neighbors_[at];
            if (is_new) first[unique++] = neighbors_[at];
            char& faces = faces_of_edge_[begin_[i] + unique - 1];
            faces = char(std::min(3, faces + 1));
        }
        degree_[i] = unique;
        for (size_t j = 0; j < unique; ++j) is_border_[i] |= char(faces_of_edge_[begin_[i] + j] == 1);
    });
}

bool Adjacency::is_border_edge(int32_t a, int32_t b) const {
    const auto neighbors = of(a);
    const auto found = std::lower_bound(neighbors.begin(), neighbors.end(), b);
    return found != neighbors.end() && *found == b &&
           faces_of_edge_[begin_[size_t(a)] + size_t(found - neighbors.begin())] == 1;
}

}  // namespace easypbr::geometry
