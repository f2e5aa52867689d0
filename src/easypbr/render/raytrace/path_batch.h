// Paths that are traced together, with an array for each number of theirs.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/native/kernels.h"
#include "easypbr/render/raytrace/path_sampler.h"

namespace easypbr::render {

/// Vectors, with an array for each component.
template <int components>
struct PathVectors {
    using Vector = Eigen::Vector<float, components>;

    explicit PathVectors(size_t room) {
        for (auto& of_one : component) of_one.assign(room, 0.0f);
    }
    Vector at(size_t i) const {
        Vector v;
        for (int c = 0; c < components; ++c) v[c] = component[size_t(c)][i];
        return v;
    }
    void set(size_t i, const Vector& v) {
        for (int c = 0; c < components; ++c) component[size_t(c)][i] = v[c];
    }
    /// The arrays as a stream (native/shader_streams.h) names them.
    void read_by(const float* (&arrays)[components]) const {
        for (int c = 0; c < components; ++c) arrays[c] = component[size_t(c)].data();
    }
    void written_by(float* (&arrays)[components]) {
        for (int c = 0; c < components; ++c) arrays[c] = component[size_t(c)].data();
    }

    std::array<std::vector<float>, size_t(components)> component;
};

/// The places of paths on surfaces, in RayScene's frame, and what has become of them so far. Vectors are in
/// world directions.
struct PathBatch {
    /// `capacity` paths at most.
    explicit PathBatch(size_t capacity)
        : position(rounded_up(capacity)),
          normal(rounded_up(capacity)),
          face(rounded_up(capacity)),
          view(rounded_up(capacity)),
          albedo(rounded_up(capacity)),
          parameters(rounded_up(capacity)),
          throughput(rounded_up(capacity), Vec3::Ones()),
          samplers(rounded_up(capacity)),
          index(rounded_up(capacity), 0) {}

    static size_t rounded_up(size_t count) {
        constexpr auto step = size_t(native::stream_alignment);
        return (count + step - 1) / step * step;
    }

    /// The surfaces as a stream of a shader names them (native/shader_streams.h).
    template <class Stream>
    void read_by(Stream& stream) const {
        position.read_by(stream.v_position);
        normal.read_by(stream.v_normal);
        face.read_by(stream.v_face);
        view.read_by(stream.v_view);
        albedo.read_by(stream.v_albedo);
        parameters.read_by(stream.v_parameters);
    }

    size_t count = 0;
    PathVectors<3> position;
    PathVectors<3> normal;  ///< interpolated and mapped
    PathVectors<3> face;    ///< of the element itself, towards where the path comes from
    PathVectors<3> view;    ///< unit, back along the path
    PathVectors<3> albedo;
    PathVectors<2> parameters;  ///< metallic, roughness
    std::vector<Vec3> throughput;
    std::vector<PathSampler> samplers;
    std::vector<uint32_t> index;  ///< of the radiance that the path adds to
};

}  // namespace easypbr::render
