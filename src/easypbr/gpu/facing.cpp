#include "easypbr/gpu/facing.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"

namespace easypbr::gpu {
namespace {

constexpr size_t face_grain = 1 << 15;

/// Asks for what belongs to the corners of a face some steps ahead: neighbours may be far apart in memory.
template <class Value>
void prefetch(const Array3i& F, size_t face, size_t end, const Value* values, size_t values_each) {
    constexpr size_t ahead = 16;
    if (face + ahead >= end) return;
    for (size_t k = 0; k < 3; ++k)
        __builtin_prefetch(values + values_each * size_t(F.data()[3 * (face + ahead) + k]));
}

/// A random-looking number for a number (splitmix64's finaliser).
uint64_t scattered(uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/// The same for an undirected edge, negated for one of its directions.
uint64_t directed_edge(uint64_t a, uint64_t b) {
    const uint64_t edge = scattered(std::rotl(std::max(a, b), 32) + std::min(a, b)), sign = a < b ? 0 : ~0ull;
    return (edge ^ sign) - sign;
}

/// What the edges of all faces tell.
struct Edges {
    bool cancel = true;    ///< each is run through as often in one direction as in the other
    bool are_even = true;  ///< each has an even number of faces, whichever way they look
};

/// The sum of random numbers, negated for one direction, is zero where edges cancel, and otherwise with a
/// probability of 2^-64 only. So are the bits that differ between them where the number of faces is even.
/// `key` names a vertex.
template <class Key>
Edges edges_of(const Array3i& F, const Key& key) {
    std::atomic<uint64_t> total{0}, odd{0};
    parallel_chunks(size_t(F.rows()), face_grain, [&](size_t begin, size_t end) {
        uint64_t sum = 0, differing = 0;
        const auto add = [&](uint64_t a, uint64_t b) {
            const uint64_t edge = directed_edge(a, b);
            sum += edge;
            // An edge without length joins no faces.
            if (a != b) differing ^= a < b ? edge : uint64_t(0) - edge;
        };
        for (size_t i = begin; i < end; ++i) {
            const int32_t* f = F.data() + 3 * i;
            const uint64_t a = key(f[0]), b = key(f[1]), c = key(f[2]);
            add(a, b);
            add(b, c);
            add(c, a);
        }
        total += sum;
        odd ^= differing;
    });
    return {total == 0, odd == 0};
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

/// Sets of numbers that threads join at once. Each points at a smaller one of its set, the least of all at
/// itself, so that the sets do not depend on the order in which they were joined (Anderson and Woll,
/// Wait-free parallel algorithms for the union-find problem, 1991).
class JoinedSets {
  public:
    explicit JoinedSets(std::vector<int32_t> parent) : parent_(std::move(parent)) {}
    const int32_t* parents() const { return parent_.data(); }
    void join(int32_t a, int32_t b) {
        for (;;) {
            a = root_of(a), b = root_of(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            int32_t own = a;  // Unless another thread has given it a parent in the meantime.
            if (parent(a).compare_exchange_strong(own, b, std::memory_order_relaxed)) return;
        }
    }

    /// The least number of each number's set, when no thread joins any more.
    std::vector<int32_t> roots() && {
        for (int32_t& parent : parent_) parent = parent_[size_t(parent)];
        return std::move(parent_);
    }

  private:
    /// The least number of a number's set, so far.
    int32_t root_of(int32_t i) {
        for (;;) {
            const int32_t above = parent(i).load(std::memory_order_relaxed),
                          next = parent(above).load(std::memory_order_relaxed);
            if (above == next) return above;
            parent(i).store(next, std::memory_order_relaxed);
            i = next;
        }
    }
    std::atomic_ref<int32_t> parent(int32_t i) { return std::atomic_ref(parent_[size_t(i)]); }
    std::vector<int32_t> parent_;
};

Vec3d vertex(const Array3f& V, int32_t i) {
    return Eigen::Map<const Vec3>(V.data() + 3 * size_t(i)).cast<double>();
}

struct Volume {
    int32_t root;
    double value;
};

/// Of the faces of a chunk: a volume for each component in it, ordered by root.
std::vector<Volume> volumes_in(const Array3f& V, const Array3i& F, const std::vector<int32_t>& roots,
                               size_t begin, size_t end) {
    std::vector<Volume> volumes;
    Vec3d origin = Vec3d::Zero();
    for (size_t i = begin; i < end; ++i) {
        prefetch(F, i, end, V.data(), 3);
        const int32_t* const f = F.data() + 3 * i;
        const int32_t root = roots[size_t(f[0])];
        if (volumes.empty() || volumes.back().root != root) {
            volumes.push_back({root, 0});
            // Relative to the component's first vertex, so that nothing cancels far from the origin.
            origin = vertex(V, root);
        }
        const Vec3d a = vertex(V, f[0]) - origin, b = vertex(V, f[1]) - origin, c = vertex(V, f[2]) - origin;
        volumes.back().value += a.dot(b.cross(c));
    }
    std::ranges::stable_sort(volumes, {}, &Volume::root);
    size_t count = 0;
    for (const Volume& volume : volumes)
        if (count > 0 && volumes[count - 1].root == volume.root)
            volumes[count - 1].value += volume.value;
        else
            volumes[count++] = volume;
    volumes.resize(count);
    return volumes;
}

}  // namespace

Winding winding_of(const Array3f& V, const Array3i& F) {
    if (F.rows() == 0) return Winding::unknown;
    std::vector<int32_t> parent;
    if (edges_of(F, [](int32_t v) { return uint64_t(v); }).cancel) {
        parent.resize(size_t(V.rows()));
        std::iota(parent.begin(), parent.end(), 0);
    } else {
        // Creases and seams have several vertices at one place.
        const Edges edges = edges_of(F, [&](int32_t v) { return place_key(V, v); });
        if (!edges.cancel) return edges.are_even ? Winding::unknown : Winding::open;
        parent = first_at_place(V);
    }
    JoinedSets components(std::move(parent));
    parallel_chunks(size_t(F.rows()), face_grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            prefetch(F, i, end, components.parents(), 1);
            const int32_t* const f = F.data() + 3 * i;
            components.join(f[0], f[1]);
            components.join(f[0], f[2]);
        }
    });
    const std::vector<int32_t> roots = std::move(components).roots();
    std::vector<std::vector<Volume>> chunks((size_t(F.rows()) + face_grain - 1) / face_grain);
    parallel_chunks(size_t(F.rows()), face_grain, [&](size_t begin, size_t end) {
        chunks[begin / face_grain] = volumes_in(V, F, roots, begin, end);
    });
    std::unordered_map<int32_t, double> volumes;
    for (const auto& chunk : chunks)
        for (const Volume& volume : chunk) volumes[volume.root] += volume.value;
    const auto all_of_sign = [&](double sign) {
        return std::ranges::all_of(volumes, [&](const auto& volume) { return sign * volume.second > 0; });
    };
    return all_of_sign(1) ? Winding::outward : all_of_sign(-1) ? Winding::inward : Winding::unknown;
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
    Box3d box;
    for (int k = 0; k < 3; ++k) {
        box.min()[k] = double(V.col(k).minCoeff<Eigen::PropagateNumbers>());
        box.max()[k] = double(V.col(k).maxCoeff<Eigen::PropagateNumbers>());
    }
    return box;
}

bool beyond_near_plane(const Camera& camera, const Eigen::Affine3d& T_world_mesh, const Box3d& box) {
    const Eigen::Affine3d T_cam_mesh(camera.view() * T_world_mesh.matrix());
    for (int i = 0; i < 8; ++i)
        if (!((T_cam_mesh * box.corner(Box3d::CornerType(i))).z() < -camera.near)) return false;
    return true;
}

}  // namespace easypbr::gpu
