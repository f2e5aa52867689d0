// A mesh of random values, for tests of the files that hold it.
#pragma once

#include <cmath>
#include <cstring>
#include <random>

#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// A mesh with every array that PLY holds, of random values.
inline MeshData random_mesh(unsigned seed, int n) {
    std::mt19937 random(seed);
    // Raw bits with all exponents: also very large, very small and negative zero.
    const auto any_float = [&] {
        for (;;) {
            const uint32_t bits = uint32_t(random());
            float value;
            std::memcpy(&value, &bits, 4);
            if (std::isfinite(value)) return value;
        }
    };
    MeshData mesh;
    mesh.V = Array3f::Dense::NullaryExpr(n, 3, any_float);
    Array3f::Dense N = Array3f::Dense::NullaryExpr(n, 3, [&] { return float(random() % 2001) / 1000 - 1; });
    N.col(2).array() += 2;
    mesh.N = Array3f::Dense(N.rowwise().normalized());
    mesh.C = ArrayXf::Dense(ArrayXf::Dense::NullaryExpr(n, 4, [&] { return float(random() % 256) / 255; }));
    mesh.UV = Array2f::Dense::NullaryExpr(n, 2, any_float);
    mesh.L = Array1i::Dense::NullaryExpr(n, [&] { return int32_t(random()); });
    mesh.I = Array1f::Dense::NullaryExpr(n, any_float);
    mesh.T = Array3f::Dense::NullaryExpr(n, 3, any_float);
    mesh.B = Array1f::Dense::NullaryExpr(n, any_float);
    mesh.scalars = {{"curvature", Array1f::Dense::NullaryExpr(n, any_float)},
                    {"area", Array1f::Dense::NullaryExpr(2 * n, any_float)}};
    mesh.F = Array3i::Dense::NullaryExpr(2 * n, 3, [&] { return int32_t(random() % unsigned(n)); });
    mesh.E = Array2i::Dense::NullaryExpr(n, 2, [&] { return int32_t(random() % unsigned(n)); });
    return mesh;
}

}  // namespace easypbr
