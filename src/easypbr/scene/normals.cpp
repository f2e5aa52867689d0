#include "easypbr/scene/normals.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/directions.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/normal_sums.h"

namespace easypbr {

constexpr size_t normals_grain = 1 << 15;

namespace {

constexpr int lanes = 16;
using Lanes = std::array<float, lanes>;

/// Per face: normal times twice the area, and the angles at the three corners. Laid out for SIMD.
struct FaceBlock {
    std::array<Lanes, 3> normal, angle;
};

/// What one corner adds to its vertex.
struct Contribution {
    int32_t vertex;
    float x, y, z;
};

/// The power of two that brings the largest coordinate to about 2^16: squares of areas then neither overflow
/// nor underflow, and a mesh scaled by a power of two gives the very same numbers.
float scale_of(const Array3f& V) {
    const size_t count = size_t(V.size()), grain = size_t(1) << 18;
    std::vector<float> largest((count + grain - 1) / grain, 0.0f);
    parallel_chunks(count, grain, [&](size_t begin, size_t end) {
        float largest_here = 0;
        for (size_t i = begin; i < end; ++i) largest_here = std::max(largest_here, std::abs(V.data()[i]));
        largest[begin / grain] = largest_here;
    });
    const float extent = largest.empty() ? 0.0f : *std::max_element(largest.begin(), largest.end());
    return extent > 0 ? std::ldexp(1.0f, std::clamp(16 - std::ilogb(extent), -126, 127)) : 1.0f;
}

/// Angle between two vectors from y = |cross product|, its square, and x = dot product: pi/2 -+ (pi/2 - 2
/// atan(t)) with t = y / (hypot(x, y) + |x|) in [0, 1]. Arctangent: Abramowitz and Stegun 4.4.47, error below
/// 1e-5. No branches.
Lanes angles(const float* y_squared, const float* y, const float* x) {
    Lanes angle;
    constexpr float half_pi = float(pi / 2);
    for (int k = 0; k < lanes; ++k) {
        const float hypotenuse = std::sqrt(y_squared[k] + x[k] * x[k]);
        const float t = y[k] / std::max(hypotenuse + std::abs(x[k]), std::numeric_limits<float>::min());
        const float s = t * t;
        const float arctangent =
            t * (0.9998660f + s * (-0.3302995f + s * (0.1801410f + s * (-0.0851330f + s * 0.0208351f))));
        angle[k] = half_pi - std::copysign(half_pi - 2 * arctangent, x[k]);
    }
    return angle;
}

/// Faces first .. first + count - 1; lanes beyond repeat the last one.
FaceBlock face_block(const Array3f& V, const Array3i& F, float scale, size_t first, int count) {
    std::array<Lanes, 9> p;
    for (int k = 0; k < lanes; ++k) {
        const int32_t* face = F.data() + 3 * (first + std::min(k, count - 1));
        for (int corner = 0; corner < 3; ++corner) {
            const float* position = V.data() + 3 * size_t(face[corner]);
            p[3 * corner][k] = position[0] * scale;
            p[3 * corner + 1][k] = position[1] * scale;
            p[3 * corner + 2][k] = position[2] * scale;
        }
    }
    FaceBlock block;
    Lanes area, area_squared, dot0, dot1;
    for (int k = 0; k < lanes; ++k) {
        const float ux = p[3][k] - p[0][k], uy = p[4][k] - p[1][k], uz = p[5][k] - p[2][k];
        const float vx = p[6][k] - p[0][k], vy = p[7][k] - p[1][k], vz = p[8][k] - p[2][k];
        const float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
        block.normal[0][k] = nx;
        block.normal[1][k] = ny;
        block.normal[2][k] = nz;
        area_squared[k] = nx * nx + ny * ny + nz * nz;
        area[k] = std::sqrt(area_squared[k]);
        dot0[k] = ux * vx + uy * vy + uz * vz;
        dot1[k] = ux * (ux - vx) + uy * (uy - vy) + uz * (uz - vz);
    }
    block.angle[0] = angles(area_squared.data(), area.data(), dot0.data());
    block.angle[1] = angles(area_squared.data(), area.data(), dot1.data());
    for (int k = 0; k < lanes; ++k) block.angle[2][k] = float(pi) - block.angle[0][k] - block.angle[1][k];
    return block;
}

/// Adds the faces' contributions to their vertices, slab by slab of faces. Within a slab, chunks of faces are
/// computed in parallel and sorted by the owner of each vertex; then each owner adds up what is its own, in
/// the order of the faces. That order, and so the sum, is the same for any number of owners and threads,
/// without an adjacency in memory.
class Accumulator {
  public:
    Accumulator(const Array3f& V, const Array3i& F, float* sums)
        : V_(V),
          F_(F),
          scale_(scale_of(V)),
          sums_(sums),
          owners_(std::min(most_owners, std::bit_ceil(size_t(thread_count())))),
          chunks_(std::max<size_t>(32, 2 * owners_)),
          bins_(chunks_ * owners_) {}

    void add_all() {
        const size_t faces = size_t(F_.rows());
        for (size_t first = 0; first < faces; first += chunks_ * chunk_faces) {
            parallel_for(chunks_, 1, [&](size_t chunk) {
                const size_t begin = std::min(faces, first + chunk * chunk_faces);
                compute(chunk, begin, std::min(faces, begin + chunk_faces));
            });
            parallel_for(owners_, 1, [&](size_t owner) { collect(owner); });
        }
    }

  private:
    static constexpr size_t chunk_faces = 4096, most_owners = 16;
    using Cursors = std::array<Contribution*, most_owners>;

    struct Bin {
        std::vector<Contribution> items;
        size_t count = 0;
    };

    Bin& bin(size_t chunk, size_t owner) { return bins_[chunk * owners_ + owner]; }

    /// Runs of vertices go round the owners: even shares, and neighbours in memory stay together.
    size_t owner_of(int32_t vertex) const { return (size_t(vertex) >> 12) & (owners_ - 1); }

    void compute(size_t chunk, size_t begin, size_t end) {
        Cursors cursors;
        for (size_t owner = 0; owner < owners_; ++owner) {
            bin(chunk, owner).items.resize(3 * chunk_faces);
            cursors[owner] = bin(chunk, owner).items.data();
        }
        for (size_t first = begin; first < end; first += lanes) {
            const int count = int(std::min<size_t>(lanes, end - first));
            distribute(face_block(V_, F_, scale_, first, count), first, count, cursors);
        }
        for (size_t owner = 0; owner < owners_; ++owner)
            bin(chunk, owner).count = size_t(cursors[owner] - bin(chunk, owner).items.data());
    }

    void distribute(const FaceBlock& block, size_t first, int count, Cursors& cursors) const {
        const int32_t* vertex = F_.data() + 3 * first;
        for (int k = 0; k < count; ++k) {
            const float x = block.normal[0][k], y = block.normal[1][k], z = block.normal[2][k];
            for (int corner = 0; corner < 3; ++corner, ++vertex) {
                const float angle = block.angle[corner][k];
                *cursors[owner_of(*vertex)]++ = {*vertex, angle * x, angle * y, angle * z};
            }
        }
    }

    void collect(size_t owner) {
        for (size_t chunk = 0; chunk < chunks_; ++chunk) {
            const Bin& source = bin(chunk, owner);
            for (size_t i = 0; i < source.count; ++i) {
                const Contribution& part = source.items[i];
                float* sum = sums_ + 3 * size_t(part.vertex);
                sum[0] += part.x;
                sum[1] += part.y;
                sum[2] += part.z;
            }
        }
    }

    const Array3f& V_;
    const Array3i& F_;
    const float scale_;
    float* const sums_;
    const size_t owners_, chunks_;
    std::vector<Bin> bins_;
};

}  // namespace

Array3f::Dense detail::normal_sums(const Array3f& V, const Array3i& F) {
    require_faces(F, V.rows());
    constexpr size_t grain = size_t(1) << 16;
    Array3f::Dense sums(V.rows(), 3);
    parallel_chunks(size_t(sums.size()), grain, [&](size_t begin, size_t end) {
        std::fill(sums.data() + begin, sums.data() + end, 0.0f);
    });
    Accumulator(V, F, sums.data()).add_all();
    return sums;
}

Array3f detail::directions(Array3f::Dense vectors) {
    constexpr size_t grain = size_t(1) << 16;
    // In double precision, so that no area is too small.
    parallel_for(size_t(vectors.rows()), grain, [&](size_t v) {
        vectors.row(Eigen::Index(v)) =
            direction_or_z(vectors.row(Eigen::Index(v)).transpose().cast<double>()).cast<float>().transpose();
    });
    return Array3f(std::move(vectors));
}

Array3f vertex_normals(const Array3f& V, const Array3i& F) {
    return detail::directions(detail::normal_sums(V, F));
}

Array3f face_normals(const Array3f& V, const Array3i& F) {
    require_faces(F, V.rows());
    Array3f::Dense N(F.rows(), 3);
    parallel_for(size_t(N.rows()), size_t(1) << 14, [&](size_t f) {
        const auto corner = [&](int k) -> Vec3d {
            return V.row(F(Eigen::Index(f), k)).transpose().cast<double>();
        };
        const Vec3d origin = corner(0);
        N.row(Eigen::Index(f)) =
            detail::direction_or_z((corner(1) - origin).cross(corner(2) - origin)).cast<float>().transpose();
    });
    return N;
}

detail::UnitedMesh::UnitedMesh(const MeshData& mesh) : V(mesh.V), F(mesh.F) {
    if (mesh.source_vertex.empty()) return;
    // Of a file of many more vertices the numbers are too large to be rows.
    rows = numbers_below(2 * mesh.source_vertex.rows(), mesh.source_vertex);
    require_faces(mesh.F, rows.rows());
    Array3f::Dense places = Array3f::Dense::Zero(Eigen::Index(rows.maxCoeff()) + 1, 3);
    for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) places.row(rows[i]) = mesh.V.row(i);
    Array3i::Dense faces(mesh.F.rows(), 3);
    parallel_for(size_t(faces.size()), normals_grain,
                 [&](size_t i) { faces.data()[i] = rows[mesh.F.data()[i]]; });
    V = std::move(places);
    F = std::move(faces);
}

Array3f smooth_normals(const MeshData& mesh) {
    require_shapes(mesh);
    require_sources("source_vertex", mesh.source_vertex, "vertices");
    const detail::UnitedMesh united(mesh);
    const Array3f normals = vertex_normals(united.V, united.F);
    const Array1i& rows = united.rows;
    return rows.empty() ? normals : rows_of(normals, {rows.data(), size_t(rows.size())});
}

}  // namespace easypbr
