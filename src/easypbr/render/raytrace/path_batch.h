// Paths that are traced together, with an array for each number of theirs.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/raytrace/path_sampler.h"
#include "easypbr/render/raytrace/path_vectors.h"
#include "easypbr/render/raytrace/ray_scene.h"

namespace easypbr::render {

/// The radiance that paths bring, by PathState::index.
struct PathRadiance {
    explicit PathRadiance(size_t count) : within(count, Vec3::Zero()) {}

    void add(uint32_t index, const Vec3& found) { within[index] += found; }
    /// A part of it alone is within the limit.
    void add(uint32_t index, const Vec3& found, float part) {
        if (beyond.empty()) beyond.assign(within.size(), Vec3::Zero());
        within[index] += found * part;
        beyond[index] += found * (1 - part);
    }

    std::vector<Vec3> within;
    std::vector<Vec3> beyond;  ///< what exceeds the limit of PathTracer::prepare(); empty where nothing does
};

/// In place of one channel of red, green and blue.
inline constexpr int8_t all_channels = -1;

/// How the surfaces before the last one have reflected a path, or scattered it.
enum class Scattering : uint8_t {
    none,    ///< it is seen through clear surfaces at most
    narrow,  ///< as mirrors do
    wide     ///< one of them at least in a direction of low density
};

/// What has become of a path so far.
struct PathState {
    Vec3 throughput{1, 1, 1};
    PathSampler sampler;
    uint32_t index = 0;     ///< of the radiance that the path adds to
    uint16_t bounces = 0;   ///< surfaces that have reflected it
    uint16_t passages = 0;  ///< surfaces that it has passed, or whose volume it has not left
    /// Surfaces whose volumes the path is in, the innermost first; -1: none. The outermost of more is
    /// forgotten.
    std::array<int, 4> volumes{-1, -1, -1, -1};
    Scattering scattered = Scattering::none;
    bool reflected = false;         ///< by any surface: not transmitted alone
    bool found_lamps = false;       ///< a surface before is lit straight through what is nearly clear
    int8_t channel = all_channels;  ///< the only one that is left once a volume has dispersed the light
};

/// What glTF's material extensions add to surfaces, as shaders/path_extended.glsl names it.
struct PathExtensions {
    explicit PathExtensions(size_t room)
        : dielectric(room),
          coat(room),
          sheen(room),
          film(room),
          tangent(room),
          volume(room),
          absorption(room) {}

    template <class Stream>
    void read_by(Stream& stream) const {
        dielectric.read_by(stream.v_dielectric);
        coat.read_by(stream.v_coat);
        sheen.read_by(stream.v_sheen);
        film.read_by(stream.v_film);
        tangent.read_by(stream.v_tangent);
        volume.read_by(stream.v_volume);
        absorption.read_by(stream.v_absorption);
    }
    /// The arrays from one of them on.
    native::HitExtensions written_from(size_t first) {
        native::HitExtensions to;
        dielectric.written_by(to.dielectric, first);
        coat.written_by(to.coat, first);
        sheen.written_by(to.sheen, first);
        film.written_by(to.film, first);
        tangent.written_by(to.tangent, first);
        volume.written_by(to.volume, first);
        absorption.written_by(to.absorption, first);
        return to;
    }
    void copy(size_t to, const PathExtensions& from, size_t i) {
        dielectric.set(to, from.dielectric.at(i));
        coat.set(to, from.coat.at(i));
        sheen.set(to, from.sheen.at(i));
        film.set(to, from.film.at(i));
        tangent.set(to, from.tangent.at(i));
        volume.set(to, from.volume.at(i));
        absorption.set(to, from.absorption.at(i));
    }

    PathVectors<4> dielectric, coat, sheen, film, tangent;
    PathVectors<3> volume, absorption;
};

/// Of a path at a surface with extensions.
struct ExtendedPath {
    int surface = -1;               ///< of the ray scene
    int8_t channel = all_channels;  ///< of the index of refraction, where the volume disperses
    Vec3 emission{0, 0, 0};  ///< what the path adds of the surface's light, but for what its layers keep
};

/// The places of paths on surfaces, in RayScene's frame, and what has become of them so far. Vectors are in
/// world directions.
struct PathBatch {
    /// `capacity` paths at most; the surfaces of all have extensions, or none has.
    explicit PathBatch(size_t capacity, bool extended = false)
        : position(rounded_up(capacity)),
          start(rounded_up(capacity)),
          normal(rounded_up(capacity)),
          face(rounded_up(capacity)),
          view(rounded_up(capacity)),
          reach(rounded_up(capacity)),
          on(rounded_up(capacity)),
          albedo(rounded_up(capacity)),
          parameters(rounded_up(capacity)),
          state(rounded_up(capacity)),
          seeds(rounded_up(capacity)),
          reversed_samples(rounded_up(capacity)) {
        if (!extended) return;
        extensions.emplace(rounded_up(capacity));
        inside.assign(rounded_up(capacity), 0.0f);
        extended_paths.resize(rounded_up(capacity));
    }

    static constexpr size_t rounded_up(size_t count) { return whole_streams(count); }

    /// The surfaces as a stream of a shader names them (native/shader_streams.h).
    template <class Stream>
    void read_by(Stream& stream) const {
        position.read_by(stream.v_position);
        normal.read_by(stream.v_normal);
        face.read_by(stream.v_face);
        view.read_by(stream.v_view);
        albedo.read_by(stream.v_albedo);
        parameters.read_by(stream.v_parameters);
        if constexpr (requires { stream.v_inside; }) {
            extensions->read_by(stream);
            stream.v_inside = inside.data();
        }
    }

    void set_state(size_t path, const PathState& to) {
        state[path] = to;
        seeds[path] = to.sampler.seed();
        reversed_samples[path] = to.sampler.reversed_sample();
    }
    /// Whether a path goes through its surface in a direction.
    bool passes(size_t path, const Vec3& direction) const {
        return extensions && direction.dot(face.at(path)) < 0;
    }
    /// Whether a path's surface transmits it in a direction. Total internal reflection is a part of the way
    /// through a volume.
    bool transmits(size_t path, const Vec3& direction) const {
        if (passes(path, direction)) return true;
        if (!extensions) return false;
        const float relative = extensions->volume.at(path).y(),
                    index = inside[path] < 0.5f ? 1 / relative : relative;  // of the two sides
        if (inside[path] < 0.5f && index <= 1) return false;
        const Vec3 towards = view.at(path);
        const float cosine = (towards + direction).normalized().dot(towards);
        return index * index * (1 - cosine * cosine) >= 1;
    }
    /// PathSampler::pair() of all paths.
    PathVectors<2> points(uint32_t depth, uint32_t pair) const {
        PathVectors<2> points(rounded_up(count));
        native::sample_paths(seeds.data(), reversed_samples.data(), PathSampler::dimension_of(depth, pair),
                             int(count), points.component(0), points.component(1));
        return points;
    }

    /// Sets where rays start that leave the places: as RayScene::off_surface(), along the face's normal and
    /// back along the path too, so that they are on the right side of other surfaces that meet this one
    /// there.
    void find_starts() {
        constexpr size_t together = rounded_up(1);
        for (size_t first = 0; first < count; first += together) {
            std::array<float, together> rounding{};
            const float* beyond = reach.data() + first;
            for (int c = 0; c < 3; ++c) {
                const float* at = position.component(c) + first;
                for (size_t k = 0; k < together; ++k) rounding[k] += at[k] * at[k];
            }
            for (float& value : rounding) value = RayScene::rounding(std::sqrt(value));
            for (int c = 0; c < 3; ++c) {
                const float *at = position.component(c) + first, *back = view.component(c) + first,
                            *away = face.component(c) + first;
                float* to = start.component(c) + first;
                for (size_t k = 0; k < together; ++k)
                    to[k] = at[k] + (back[k] + away[k]) * rounding[k] + away[k] * beyond[k];
            }
        }
    }

    size_t count = 0;
    PathVectors<3> position;
    PathVectors<3> start;      ///< of rays that leave on the side that the path comes from: see find_starts()
    PathVectors<3> normal;     ///< interpolated and mapped
    PathVectors<3> face;       ///< of the element itself, towards where the path comes from
    PathVectors<3> view;       ///< unit, back along the path
    std::vector<float> reach;  ///< RayScene::reach() of the elements
    std::vector<SurfacePlace> on;
    PathVectors<3> albedo;
    PathVectors<2> parameters;  ///< metallic, roughness
    std::vector<PathState> state;
    std::vector<uint32_t> seeds, reversed_samples;  ///< of their samplers

    std::optional<PathExtensions> extensions;
    std::vector<float> inside;  ///< with extensions: 1 where the path comes from within the surface's volume
    std::vector<ExtendedPath> extended_paths;  ///< with extensions
};

}  // namespace easypbr::render
