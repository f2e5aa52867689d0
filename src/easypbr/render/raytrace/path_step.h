// What one step of paths finds, from one surface to the next.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "easypbr/render/raytrace/path_tracer.h"
#include "easypbr/render/raytrace/path_vectors.h"

namespace easypbr::render {

/// What path_scatter reads and writes beyond the batch.
struct PathTracer::Scattered {
    explicit Scattered(size_t room)
        : random(room),
          chosen_direction(room),
          chosen_radiance(room),
          chosen_density(room),
          distance(room, std::numeric_limits<float>::infinity()),
          chosen_light(room),
          direction(room),
          weight(room),
          density(room),
          keep(room) {}

    template <class Stream>
    Stream stream(const PathBatch& batch) {
        Stream stream;
        batch.read_by(stream);
        random.read_by(stream.v_random);
        chosen_direction.read_by(stream.v_light_direction);
        chosen_radiance.read_by(stream.v_light);
        stream.v_light_density = chosen_density.data();
        chosen_light.written_by(stream.o_light);
        direction.written_by(stream.o_direction);
        weight.written_by(stream.o_weight);
        stream.o_density = density.data();
        if constexpr (requires { stream.o_keep; }) keep.written_by(stream.o_keep);
        return stream;
    }

    /// The direction of next-event estimation.
    void set_direction(size_t i, const Vec3& towards, const Vec3& arrives, float density_of_it) {
        chosen_direction.set(i, towards);
        chosen_radiance.set(i, arrives);
        chosen_density[i] = density_of_it;
    }

    PathVectors<3> random, chosen_direction, chosen_radiance;
    std::vector<float> chosen_density, distance;  ///< how far the light of the direction is
    PathVectors<3> chosen_light, direction, weight;
    std::vector<float> density;
    PathVectors<3> keep;  ///< of emission, where the surfaces have extensions
};

/// Paths that have left the scene.
struct PathTracer::Escaped {
    struct Path {
        Vec3 throughput;
        uint32_t index;
        Scattering scattered;
        bool by_both = true;  ///< next-event estimation may have found the same light
    };
    void add(const Vec3& direction, float density, const Path& path) {
        directions.push_back(direction);
        densities.push_back(density);
        paths.push_back(path);
    }

    std::vector<Vec3> directions;
    std::vector<float> densities;
    std::vector<Path> paths;
};

/// Paths that have met a ground that catches shadows, which ends them.
struct PathTracer::Caught {
    std::vector<GroundHit> hits;
    std::vector<Vec3> before_color;  ///< throughput of what sees the background's colour there
    Escaped before_sky;              ///< what sees the sky there
};

}  // namespace easypbr::render
