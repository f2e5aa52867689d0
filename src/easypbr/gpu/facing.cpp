#include "easypbr/gpu/facing.h"

#include <atomic>
#include <numeric>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"

namespace easypbr::gpu {
namespace {

constexpr size_t face_grain = 1 << 15;

/// A random-looking number for an undirected edge (splitmix64's finaliser).
uint64_t edge_hash(uint32_t a, uint32_t b) {
    uint64_t x = (uint64_t(a) << 32 | b) + 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

uint64_t directed_edge(int32_t a, int32_t b) {
    return a < b ? edge_hash(uint32_t(a), uint32_t(b)) : -edge_hash(uint32_t(b), uint32_t(a));
}

/// Every edge is run through as often in one direction as in the other. The sum of random numbers, negated
/// for one direction, is zero then, and otherwise with a probability of 2^-64 only.
bool has_no_boundary(const Array3i& F) {
    std::atomic<uint64_t> total{0};
    parallel_chunks(size_t(F.rows()), face_grain, [&](size_t begin, size_t end) {
        uint64_t sum = 0;
        for (size_t i = begin; i < end; ++i) {
            const int32_t* f = F.data() + 3 * i;
            sum += directed_edge(f[0], f[1]) + directed_edge(f[1], f[2]) + directed_edge(f[2], f[0]);
        }
        total += sum;
    });
    return total == 0;
}

int32_t find_root(std::vector<int32_t>& parent, int32_t i) {
    while (parent[size_t(i)] != i) i = parent[size_t(i)] = parent[size_t(parent[size_t(i)])];
    return i;
}

}  // namespace

bool is_closed_outward(const Array3f& V, const Array3i& F) {
    if (F.rows() == 0 || !has_no_boundary(F)) return false;
    std::vector<int32_t> parent(size_t(V.rows()));
    std::iota(parent.begin(), parent.end(), 0);
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

}  // namespace easypbr::gpu
