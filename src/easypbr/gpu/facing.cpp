#include "easypbr/gpu/facing.h"

#include <atomic>
#include <bit>
#include <numeric>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"

namespace easypbr::gpu {
namespace {

constexpr size_t face_grain = 1 << 15;

/// A random-looking number for a number (splitmix64's finaliser).
uint64_t scattered(uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/// The same for an undirected edge, negated for one of its directions.
uint64_t directed_edge(uint64_t a, uint64_t b) {
    return a < b ? scattered(scattered(a) + b) : -scattered(scattered(b) + a);
}

/// Every edge is run through as often in one direction as in the other. The sum of random numbers, negated
/// for one direction, is zero then, and otherwise with a probability of 2^-64 only. `key` names a vertex.
template <class Key>
bool has_no_boundary(const Array3i& F, const Key& key) {
    std::atomic<uint64_t> total{0};
    parallel_chunks(size_t(F.rows()), face_grain, [&](size_t begin, size_t end) {
        uint64_t sum = 0;
        for (size_t i = begin; i < end; ++i) {
            const int32_t* f = F.data() + 3 * i;
            const uint64_t a = key(f[0]), b = key(f[1]), c = key(f[2]);
            sum += directed_edge(a, b) + directed_edge(b, c) + directed_edge(c, a);
        }
        total += sum;
    });
    return total == 0;
}

/// The same for all vertices at one place.
uint64_t place_key(const Array3f& V, int32_t vertex) {
    const float* p = V.data() + 3 * size_t(vertex);
    uint64_t key = 0;
    for (int k = 0; k < 3; ++k) key = scattered(key + std::bit_cast<uint32_t>(p[k] + 0.0f));  // -0 is 0.
    return key;
}

/// For each vertex the first at its place.
std::vector<int32_t> first_at_place(const Array3f& V) {
    std::vector<KeyedIndex> sorted(size_t(V.rows()));
    parallel_for(sorted.size(), 1 << 14, [&](size_t i) {
        sorted[i] = {place_key(V, int32_t(i)), uint32_t(i)};
    });
    parallel_sort(sorted);
    std::vector<int32_t> first(sorted.size());
    for (size_t i = 0; i < sorted.size(); ++i)
        first[sorted[i].index] = i > 0 && sorted[i].key == sorted[i - 1].key ? first[sorted[i - 1].index]
                                                                             : int32_t(sorted[i].index);
    return first;
}

int32_t find_root(std::vector<int32_t>& parent, int32_t i) {
    while (parent[size_t(i)] != i) i = parent[size_t(i)] = parent[size_t(parent[size_t(i)])];
    return i;
}

}  // namespace

bool is_closed_outward(const Array3f& V, const Array3i& F) {
    if (F.rows() == 0) return false;
    std::vector<int32_t> parent(size_t(V.rows()));
    if (has_no_boundary(F, [](int32_t v) { return uint64_t(v); }))
        std::iota(parent.begin(), parent.end(), 0);
    else if (has_no_boundary(F, [&](int32_t v) { return place_key(V, v); }))
        parent = first_at_place(V);  // Creases and seams have several vertices at one place.
    else
        return false;
    for (Eigen::Index i = 0; i < F.rows(); ++i)
        for (const int k : {1, 2}) {
            const int32_t a = find_root(parent, F(i, 0)), b = find_root(parent, F(i, k));
            if (a != b) parent[size_t(std::max(a, b))] = std::min(a, b);
        }
    // Signed volume of each component, relative to its own first vertex so that nothing cancels far from the
    // origin.
    std::vector<double> volume(parent.size(), 0.0);
    for (Eigen::Index i = 0; i < F.rows(); ++i) {
        const int32_t root = find_root(parent, F(i, 0));
        const Vec3d origin = V.row(root).transpose().cast<double>();
        const auto corner = [&](int k) -> Vec3d {
            return V.row(F(i, k)).transpose().cast<double>() - origin;
        };
        volume[size_t(root)] += corner(0).dot(corner(1).cross(corner(2)));
    }
    for (Eigen::Index i = 0; i < F.rows(); ++i)
        if (!(volume[size_t(find_root(parent, F(i, 0)))] > 0)) return false;
    return true;
}

bool normals_agree_with_winding(const Array3f& V, const Array3f& N, const Array3i& F) {
    std::atomic<bool> agree{true};
    parallel_chunks(size_t(F.rows()), face_grain, [&](size_t begin, size_t end) {
        if (!agree) return;
        for (size_t i = begin; i < end; ++i) {
            const int32_t* f = F.data() + 3 * i;
            const Vec3 a = V.row(f[0]), b = V.row(f[1]), c = V.row(f[2]);
            const Vec3 n = (b - a).cross(c - a);
            for (int k = 0; k < 3; ++k)
                if (n.dot(N.row(f[k])) < 0) {
                    agree = false;
                    return;
                }
        }
    });
    return agree;
}

Box3d box_of(const Array3f& V) {
    if (V.empty()) return {};
    return {Vec3d(V.colwise().minCoeff().transpose().cast<double>()),
            Vec3d(V.colwise().maxCoeff().transpose().cast<double>())};
}

bool beyond_near_plane(const Camera& camera, const Eigen::Affine3d& T_world_mesh, const Box3d& box) {
    const Eigen::Affine3d T_cam_mesh(camera.view() * T_world_mesh.matrix());
    for (int i = 0; i < 8; ++i)
        if (!((T_cam_mesh * box.corner(Box3d::CornerType(i))).z() < -camera.near)) return false;
    return true;
}

}  // namespace easypbr::gpu
