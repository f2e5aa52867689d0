// Splats of packed files, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "easypbr/scene/mesh.h"
#include "io/bytes.h"

namespace easypbr::packed_splats {

/// Of the first spherical harmonic.
inline constexpr double constant = 0.28209479177387814;

inline bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline Bytes spz_header(uint32_t version, uint32_t count, int degree, int bits = 12, int flags = 0) {
    Bytes bytes;
    bytes.add_all<uint32_t>({0x5053474e, version, count});
    return bytes.add_all<uint8_t>({uint8_t(degree), uint8_t(bits), uint8_t(flags), 0});
}

inline void add24(Bytes& bytes, int value) {
    for (int k = 0; k < 3; ++k) bytes.add(uint8_t(value >> 8 * k));
}

/// Two splats of degree 1.
inline Bytes spz_content(uint32_t version, int flags = 0) {
    Bytes bytes = spz_header(version, 2, 1, 12, flags);
    for (const int code : {4096, -4096, 1, -1, 8388607, -8388608}) add24(bytes, code);
    bytes.add_all<uint8_t>({0, 255});
    bytes.add_all<uint8_t>({0, 128, 255, 10, 20, 30});
    bytes.add_all<uint8_t>({0, 160, 255, 80, 90, 100});
    if (version == 2) {
        bytes.add_all<uint8_t>({250, 127, 127, 64, 191, 100});
    } else {
        // y is the largest; x, z and w have 10 bits each, of which the first is the sign.
        bytes.add(uint32_t(1u << 30 | 100u << 20 | (512u + 200u) << 10 | 300u));
        // w is the largest: all others 0.
        bytes.add(uint32_t(3u << 30));
    }
    for (int k = 0; k < 18; ++k) bytes.add(uint8_t(k * 15));
    return bytes;
}

/// Splats of degree 3 whose values no code holds exactly.
inline MeshData various_splats(int count) {
    Array3f::Dense V(count, 3), scales(count, 3);
    Array4f::Dense rotations(count, 4);
    Array1f::Dense opacities(count);
    ArrayXf::Dense sh(count, 48);
    uint32_t state = 1;
    const auto random = [&] {
        state = state * 1664525 + 1013904223;
        return float(state >> 8) / float(1 << 24);
    };
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) V(i, k) = 20 * random() - 10;
        for (int k = 0; k < 3; ++k) scales(i, k) = std::exp(-6 * random());
        for (int k = 0; k < 4; ++k) rotations(i, k) = random() - 0.5f;
        opacities(i) = random();
        for (int k = 0; k < 48; ++k) sh(i, k) = k < 3 ? 4 * random() - 2 : random() - 0.5f;
    }
    MeshData mesh;
    mesh.V = std::move(V);
    mesh.splats = {std::move(scales), std::move(rotations), std::move(opacities), std::move(sh)};
    mesh.up = Vec3d(0, 1, 0);
    return mesh;
}

/// The largest difference of rotations, which are the same for q and -q.
inline float largest_turn(const Array4f& a, const Array4f& b) {
    float largest = 0;
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
        const Eigen::RowVector4f p = a.row(i).normalized(), q = b.row(i).normalized();
        largest = std::max(largest, std::min((p - q).cwiseAbs().maxCoeff(), (p + q).cwiseAbs().maxCoeff()));
    }
    return largest;
}

}  // namespace easypbr::packed_splats
