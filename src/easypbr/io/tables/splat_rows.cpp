#include "easypbr/io/tables/splat_rows.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/tables/splat_columns.h"

namespace easypbr::io {
namespace {

constexpr size_t splat_check_grain = 1 << 14;

bool is_splat(const SplatRows& rows, Eigen::Index i) {
    return rows.V.row(i).allFinite() && rows.scales.row(i).allFinite() &&
           rows.scales.row(i).minCoeff() >= 0 && rows.rotations.row(i).allFinite() &&
           !rows.rotations.row(i).isZero(0) && std::isfinite(rows.opacities(i)) && rows.sh.row(i).allFinite();
}

size_t first_bad(const SplatRows& rows) {
    std::atomic<size_t> first{rows.count()};
    parallel_for(rows.count(), splat_check_grain, [&](size_t i) {
        if (is_splat(rows, Eigen::Index(i))) return;
        for (size_t known = first; i < known && !first.compare_exchange_weak(known, i);) {
        }
    });
    return first;
}

}  // namespace

SplatRows::SplatRows(const Source& source, size_t count, int degree) {
    if (count == 0) fail(source, "there are no splats in it");
    if (count > INT32_MAX)
        fail(source, fmt::format("{} splats are more than the {} that are read", count, INT32_MAX));
    const int colors = 3 * (degree + 1) * (degree + 1);
    charge_memory(uint64_t(count) * uint64_t(11 + colors) * sizeof(float), "its splats");
    const auto rows = Eigen::Index(count);
    V.resize(rows, 3);
    scales.resize(rows, 3);
    rotations.resize(rows, 4);
    opacities.resize(rows);
    sh.resize(rows, colors);
}

void SplatRows::set_color(Eigen::Index row, const Vec3& encoded) {
    for (int k = 0; k < 3; ++k) sh(row, k) = constant_of_color(encoded[k]);
}

MeshData SplatRows::finish(const Source& source, const Vec3d& up) {
    if (const size_t bad = first_bad(*this); bad < count())
        fail(source,
             fmt::format("splat {} of {} has a value that is not finite, a scale below 0 or a rotation "
                         "of length 0",
                         bad, count()));
    MeshData mesh;
    mesh.V = std::move(V);
    mesh.splats = {std::move(scales), std::move(rotations), std::move(opacities), std::move(sh)};
    mesh.up = up;
    return mesh;
}

void complete_rotation(Array4f::Dense& rotations, Eigen::Index row, Eigen::Index largest,
                       const Vec3& others) {
    for (Eigen::Index k = 0, other = 0; k < 4; ++k)
        if (k != largest) rotations(row, k) = others[other++];
    rotations(row, largest) = std::sqrt(std::max(0.0f, 1 - others.squaredNorm()));
}

}  // namespace easypbr::io
