#include "easypbr/native/shaders.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <type_traits>

#include "easypbr/core/error.h"
#include "easypbr/core/memory_pool.h"
#include "easypbr/core/parallel.h"
#include "easypbr/native/flush_subnormals.h"
#include "native/instruction_sets.h"

namespace easypbr::native {

// clang-format off
#include "native/shader_uniforms.h"
// clang-format on

#define EASYPBR_DECLARE(name)     \
    namespace name {              \
    extern const Kernels kernels; \
    }
EASYPBR_INSTRUCTION_SETS(EASYPBR_DECLARE)
#undef EASYPBR_DECLARE

namespace {

struct InstructionSet {
    std::string_view name;
    const Kernels* kernels;
    bool is_there;
};

#if defined(__x86_64__)
/// What x86-64-v3 has beyond v2, as far as compilers know its names: processors have all of it or nothing.
bool has_v3() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
}
bool has_v4() {
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}
#endif

/// Whether this processor has it.
bool is_there(std::string_view name) {
#if defined(__x86_64__)
    if (name == "avx512") return has_v4();
    if (name == "avx2") return has_v3();
#endif
    return name == "v2" || name == "base";
}

/// The best first.
std::span<const InstructionSet> known_sets() {
#define EASYPBR_LIST(name) InstructionSet{#name, &name::kernels, is_there(#name)},
    static const std::array sets{EASYPBR_INSTRUCTION_SETS(EASYPBR_LIST)};
#undef EASYPBR_LIST
    return sets;
}

const InstructionSet& set_of(std::string_view name) {
    for (const InstructionSet& set : known_sets())
        if (set.is_there && (name.empty() || set.name == name)) return set;
    std::string there;
    for (std::string_view other : instruction_sets()) there += fmt::format(" {}", other);
    throw ArgumentError(fmt::format("instruction set: '{}' is not one of{}", name, there));
}

std::atomic<const InstructionSet*> chosen;

const InstructionSet& chosen_set() {
    if (const InstructionSet* set = chosen) return *set;
    const char* asked = std::getenv("EASYPBR_ISA");
    chosen = &set_of(asked ? asked : "");
    return *chosen;
}

/// The kernels in use, for one call.
class Kernel {
  public:
    const Kernels* operator->() const { return kernels_; }

  private:
    FlushSubnormals flush_;
    const Kernels* kernels_ = chosen_set().kernels;
};

/// Fills in the uniforms of a shader.
class Setter {
  public:
    explicit Setter(const Inputs& inputs) : inputs_(inputs) {}

    template <class T>
    void operator()(std::string_view name, T& uniform) {
        set(name, uniform);
    }
    /// A block of bytes, or a value for each element, NAME[i].
    template <class T, size_t size>
    void operator()(std::string_view name, T (&uniforms)[size]) {
        if (set(name, uniforms)) return;
        for (size_t i = 0; i < size; ++i) set(fmt::format("{}[{}]", name, i), uniforms[i]);
    }
    void feature(std::string_view macro, bool& on) {
        on = on || std::ranges::find(inputs_.features, macro) != inputs_.features.end();
    }

  private:
    /// Whether there is a value of this name.
    template <class T>
    bool set(std::string_view name, T& uniform) {
        const auto at = std::ranges::find(inputs_.values, name, [](const auto& v) { return v.first; });
        if (at == inputs_.values.end()) return false;
        const bool known = std::visit([&](const auto& value) { return assign(uniform, value); }, at->second);
        if (!known) throw Error(fmt::format("the value of {} is not of the uniform's type", name));
        return true;
    }
    template <class T, class Value>
    static bool assign(T& to, const Value& value) {
        if constexpr (std::is_base_of_v<View, T> && std::is_same_v<Value, View>) {
            static_cast<View&>(to) = value;
            return true;
        } else if constexpr (std::is_same_v<Value, Inputs::Bytes>) {
            if constexpr (!std::is_array_v<T>) return false;
            std::memcpy(&to, value.data(), std::min(sizeof to, value.size()));
            return true;
        } else if constexpr (std::is_same_v<T, Value>) {
            to = value;
            return true;
        } else if constexpr (is_same_shape<T, Value>) {
            static_assert(sizeof(T) == sizeof(float) * size_t(Value::SizeAtCompileTime));
            std::memcpy(static_cast<void*>(&to), value.data(), sizeof to);
            return true;
        }
        return false;
    }
    template <class T, class Value>
    static constexpr bool is_same_shape = (std::is_same_v<T, uni::vec2> && std::is_same_v<Value, Vec2>) ||
                                          (std::is_same_v<T, uni::vec3> && std::is_same_v<Value, Vec3>) ||
                                          (std::is_same_v<T, uni::vec4> && std::is_same_v<Value, Vec4>) ||
                                          (std::is_same_v<T, mat3> && std::is_same_v<Value, Mat3>);

    const Inputs& inputs_;
};

template <class Uniforms>
void shade_with(ShadeRows kernel, const Inputs& inputs, const Region& region, int y0, int y1) {
    Uniforms uniforms;
    uniforms.visit(Setter(inputs));
    constexpr size_t rows = 8;
    parallel_chunks(size_t(std::max(0, y1 - y0)), rows, [&](size_t begin, size_t end) {
        const FlushSubnormals flush;
        kernel(&uniforms, region, y0 + int(begin), y0 + int(end));
    });
}

template <class Uniforms>
std::shared_ptr<const void> filled(const Inputs& inputs) {
    auto uniforms = std::make_shared<Uniforms>();
    uniforms->visit(Setter(inputs));
    return uniforms;
}

/// Lines by the bands of rows that they may touch.
struct Bands {
    static constexpr int rows = 16;
    std::vector<uint32_t> first;   ///< of each band's lines, and past the last
    std::vector<uint32_t> chosen;  ///< lines, in their order

    Bands(std::span<const ScreenLine> lines, float reach, int y0, int y1) {
        const int count = (y1 - y0 + rows - 1) / rows;
        const auto each_band = [&](const ScreenLine& line, const auto& visit) {
            const float a = line.start[1], b = a + line.along[1] * line.length;
            const auto band = [&](float y) {
                return int(std::floor((std::clamp(y, float(y0) - 1, float(y1) + 1) - float(y0)) / rows));
            };
            const int last = std::min(band(std::max(a, b) + reach), count - 1);
            for (int i = std::max(band(std::min(a, b) - reach), 0); i <= last; ++i) visit(size_t(i));
        };
        first.assign(size_t(count) + 1, 0);
        for (const ScreenLine& line : lines) each_band(line, [&](size_t band) { ++first[band + 1]; });
        std::partial_sum(first.begin(), first.end(), first.begin());
        chosen.resize(first.back());
        std::vector<uint32_t> next(first.begin(), first.end() - 1);
        for (size_t i = 0; i < lines.size(); ++i)
            each_band(lines[i], [&](size_t band) { chosen[next[band]++] = uint32_t(i); });
    }
};

}  // namespace

std::vector<std::string_view> instruction_sets() {
    std::vector<std::string_view> names;
    for (const InstructionSet& set : known_sets())
        if (set.is_there) names.push_back(set.name);
    return names;
}

std::string_view instruction_set() {
    return chosen_set().name;
}

void use_instruction_set(std::string_view name) {
    chosen = &set_of(name);
}

std::shared_ptr<const void> surface_uniforms(const Inputs& inputs) {
    return filled<mesh_resolve_uniforms>(inputs);
}

std::shared_ptr<const void> extended_uniforms(const Inputs& inputs) {
    return filled<mesh_extended_uniforms>(inputs);
}

std::shared_ptr<const void> caster_uniforms(const Inputs& inputs) {
    return filled<shadow_depth_uniforms>(inputs);
}

void resolve_triangles(const VisibleTriangles& triangles, std::span<const VisiblePixel> pixels) {
    Kernel()->resolve_triangles(triangles, pixels.data(), int(pixels.size()));
}

void alpha_of_triangles(const VisibleTriangles& triangles, std::span<const VisiblePixel> pixels,
                        std::span<float> alpha) {
    Kernel()->alpha_of_triangles(triangles, pixels.data(), int(pixels.size()), alpha.data());
}

void casters_of_triangles(const VisibleTriangles& triangles, std::span<const VisiblePixel> texels,
                          std::span<float> values) {
    Kernel()->casters_of_triangles(triangles, texels.data(), int(texels.size()), values.data());
}

void shade_hits(const VisibleTriangles& triangles, std::span<const ElementHit> hits,
                const HitSurfaces& surfaces) {
    Kernel()->shade_hits(triangles, hits.data(), int(hits.size()), surfaces);
}

std::shared_ptr<const void> stream_uniforms(Stream shader, const Inputs& inputs) {
#define EASYPBR_CASE(name) \
    case Stream::name:     \
        return filled<name##_uniforms>(inputs);
    switch (shader) { EASYPBR_STREAMS(EASYPBR_CASE) }
#undef EASYPBR_CASE
    return nullptr;
}

#define EASYPBR_RUN(name)                                                    \
    void run(const void* uniforms, const name##_stream& stream, int count) { \
        Kernel()->stream[size_t(Stream::name)](uniforms, &stream, count);    \
    }
EASYPBR_STREAMS(EASYPBR_RUN)
#undef EASYPBR_RUN

void draw_lines(std::span<const Stroke> strokes, const Region& region, int y1) {
    std::vector<overlay_lines_uniforms> uniforms(strokes.size());
    std::vector<Bands> bands;
    bands.reserve(strokes.size());
    for (size_t i = 0; i < strokes.size(); ++i) {
        uniforms[i].visit(Setter(strokes[i].inputs));
        bands.emplace_back(strokes[i].lines, uniforms[i].u_half_width + 1, region.y, y1);
    }
    const DrawLines kernel = chosen_set().kernels->draw_lines;
    const size_t row = size_t(std::max(0, region.x1 - region.x0) + stream_alignment);
    parallel_for(size_t((y1 - region.y + Bands::rows - 1) / Bands::rows), 1, [&](size_t band) {
        std::vector<LineStroke> drawn;
        for (size_t i = 0; i < strokes.size(); ++i) {
            const uint32_t begin = bands[i].first[band], count = bands[i].first[band + 1] - begin;
            if (count > 0)
                drawn.push_back(
                    {&uniforms[i], strokes[i].lines.data(), bands[i].chosen.data() + begin, int(count)});
        }
        if (drawn.empty()) return;
        const FlushSubnormals flush;
        const int top = region.y + int(band) * Bands::rows;
        PooledVector<float> work(size_t(line_arrays * Bands::rows) * row);
        kernel(drawn.data(), int(drawn.size()), region, top, std::min(top + Bands::rows, y1), work.data());
    });
}

void blend_splats(const SplatPixels& tile, std::span<const ScreenSplat> splats,
                  std::span<const uint32_t> places) {
    Kernel()->blend_splats(tile, splats.data(), places.data(), places.size());
}

bool project_cluster(const ClusterFaces& faces, ClusterScreen& screen) {
    return Kernel()->project_cluster(faces, screen);
}

int set_up_cluster(const ClusterFaces& faces, ClusterScreen& screen) {
    return Kernel()->set_up_cluster(faces, screen);
}

int set_up_points(const PointBatch& points, PointScreen& screen) {
    return Kernel()->set_up_points(points, screen);
}

int set_up_ellipses(const EllipseBatch& ellipses, EllipseScreen& screen) {
    return Kernel()->set_up_ellipses(ellipses, screen);
}

void find_map_places(const float (&rotation)[3][3], const float* const (&directions)[3], int count, float* u,
                     float* v) {
    Kernel()->find_map_places(rotation, directions, count, u, v);
}

void find_map_directions(const float (&rotation)[3][3], const float* u, const float* cosines,
                         const float* sines, int count, float* const (&directions)[3]) {
    Kernel()->find_map_directions(rotation, u, cosines, sines, count, directions);
}

bool add_noisy_row(const NoisyRow& row, int y, NoisyTile& tile, BesideNoisy& beside) {
    return Kernel()->add_noisy_row(row, y, tile, beside);
}

void find_places(const CameraRays& rays, const PixelSurfaces& pixels, int count, const CameraPlaces& places) {
    Kernel()->find_places(rays, pixels, count, places);
}

void sample_paths(const uint32_t* seeds, const uint32_t* reversed_samples, uint32_t dimension, int count,
                  float* xs, float* ys) {
    Kernel()->sample_paths(seeds, reversed_samples, dimension, count, xs, ys);
}

void sample_emitters(const FewEmitters& emitters, const EmitterPlaces& places, int count,
                     const EmitterPoints& points) {
    Kernel()->sample_emitters(emitters, places, count, points);
}

void chances_of_emitters(const FewEmitters& emitters, const float* const (&from)[3], const int32_t* chosen,
                         int count, float* chances) {
    Kernel()->chances_of_emitters(emitters, from, chosen, count, chances);
}

void shade(Shader shader, const Inputs& inputs, const Region& region, int y0, int y1) {
    const Kernels& k = *chosen_set().kernels;
#define EASYPBR_CASE(name) \
    case Shader::name:     \
        return shade_with<name##_uniforms>(k.shade[size_t(shader)], inputs, region, y0, y1);
    switch (shader) { EASYPBR_SHADERS(EASYPBR_CASE) }
#undef EASYPBR_CASE
}

}  // namespace easypbr::native
