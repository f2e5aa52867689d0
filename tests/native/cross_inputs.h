// What tests/native/cross_kernels.cpp gives kernels to read, and the hash of what they write. All numbers
// come from additions, multiplications, divisions and roots of whole numbers: each processor starts from the
// same bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "easypbr/native/kernels.h"

namespace easypbr::native {

inline constexpr int width = 61, height = 37;  // odd: the last lanes of a row are idle
/// Of features and numbers. In the strange ones some numbers are NaN, infinite or very large.
inline constexpr int sets = 15, first_strange_set = 12;
inline constexpr int shadow_size = 16, shadow_layers = 22;
inline constexpr float near_plane = 0.1f;

/// SplitMix64 (Steele et al. 2014).
class Random {
  public:
    explicit Random(uint64_t seed) : state_(seed) {}
    uint64_t bits() {
        uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    int below(int end) { return int(bits() % uint64_t(end)); }
    float unit() { return float(bits() >> 40) * 0x1p-24f; }
    float between(float low, float high) { return low + (high - low) * unit(); }
    /// The same; in a strange set now and then something that fits in no whole number.
    float number(float low, float high) {
        constexpr float nothing = std::numeric_limits<float>::quiet_NaN(),
                        infinite = std::numeric_limits<float>::infinity();
        constexpr float strange[] = {nothing, infinite, -infinite, 3e9f, -3e9f, 1e30f, -1e30f};
        return is_strange && below(24) == 0 ? one_of(strange) : between(low, high);
    }

    template <class T, size_t count>
    T one_of(const T (&values)[count]) {
        return values[below(int(count))];
    }

    bool is_strange = false;

  private:
    uint64_t state_;
};

inline uint64_t hash_of(const void* bytes, size_t count, uint64_t hash = 0xcbf29ce484222325u) {
    for (size_t i = 0; i < count; ++i)
        hash = (hash ^ static_cast<const unsigned char*>(bytes)[i]) * 0x100000001b3u;
    return hash;
}

inline uni::vec3 normalized(const uni::vec3& v) {
    const float scale = 1 / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return {v.x * scale, v.y * scale, v.z * scale};
}

/// What arrays hold. Of four words of `extensions` the second begins with a half, the third is a float.
enum class Kind { bits, floats, halves, extensions };

/// What one run of a kernel reads and writes.
class Case {
  public:
    Case(std::string_view kernel, int set)
        : set(set), random(hash_of(kernel.data(), kernel.size()) + uint64_t(set)), kernel_(kernel) {
        random.is_strange = set >= first_strange_set;
    }

    const int set;
    Random random;
    std::string features;

    template <class T>
    T* array(size_t count) {
        return reinterpret_cast<T*>(arrays_.emplace_back(count * sizeof(T)).data());
    }
    /// The value of each element is what `value` returns.
    template <class T, class Value>
    T* filled(size_t count, Value&& value) {
        T* to = array<T>(count);
        for (size_t i = 0; i < count; ++i) to[i] = T(value());
        return to;
    }
    float* floats(size_t count, float low = 0, float high = 1) {
        return filled<float>(count, [&] { return random.number(low, high); });
    }
    /// Something that is written, and holds numbers that are valid before.
    template <class T>
    T* output(size_t count, Kind kind) {
        T* to = array<T>(count);
        for (size_t i = 0; i < count * sizeof(T); i += sizeof(T)) {
            const float value = random.unit();
            const uint64_t bits = kind == Kind::halves ? random.bits() & 0x3bff3bff3bff3bffu : random.bits();
            std::memcpy(arrays_.back().data() + i, &bits, sizeof(T));
            if (kind == Kind::floats) std::memcpy(arrays_.back().data() + i, &value, sizeof value);
        }
        written_.push_back({arrays_.back(), &arrays_.back(), kind});
        return to;
    }
    uni::vec3 direction(const uni::vec3& around = {}, float spread = 1) {
        const auto part = [&] { return spread * random.between(-1, 1); };
        return normalized({around.x + part(), around.y + part(), around.z + part() + 1e-3f});
    }

    /// Prints the hash of what has been written.
    void report();
    /// Whether something was written, and not many of the floats are no numbers.
    static bool tells_something() { return changed_ > 0 && no_numbers_ * 4 < numbers_; }
    static void forget() { changed_ = numbers_ = no_numbers_ = 0; }

  private:
    struct Written {
        std::vector<std::byte> before;
        std::vector<std::byte>* now;
        Kind kind;
    };
    /// Which NaN an operation makes is the processor's: all become the same one.
    template <class T>
    static void unify(std::byte* at, T infinity) {
        T value;
        std::memcpy(&value, at, sizeof value);
        ++numbers_;
        if (T(value << 1) <= T(infinity << 1)) return;
        ++no_numbers_;
        value = T(infinity + 1);
        std::memcpy(at, &value, sizeof value);
    }
    static void unify(std::vector<std::byte>& bytes, Kind kind) {
        const bool extensions = kind == Kind::extensions;
        for (size_t i = 0; i < bytes.size(); i += 2) {
            if (kind == Kind::halves || (extensions && i % 16 == 4)) unify<uint16_t>(&bytes[i], 0x7c00u);
            if ((kind == Kind::floats && i % 4 == 0) || (extensions && i % 16 == 8))
                unify<uint32_t>(&bytes[i], 0x7f800000u);
        }
    }

    std::string_view kernel_;
    std::deque<std::vector<std::byte>> arrays_;
    std::vector<Written> written_;
    static inline size_t changed_, numbers_, no_numbers_;
};

inline void Case::report() {
    uint64_t hash = hash_of(nullptr, 0);
    for (Written& w : written_) {
        for (size_t i = 0; i < w.before.size(); ++i) changed_ += w.before[i] != (*w.now)[i];
        if (w.kind != Kind::bits) unify(*w.now, w.kind);
        hash = hash_of(w.now->data(), w.now->size(), hash);
    }
    std::printf("%.*s %d %016llx%s\n", int(kernel_.size()), kernel_.data(), set,
                static_cast<unsigned long long>(hash), features.c_str());
}

/// Switches features on and off: none, all, or each with a chance that differs between sets.
struct Chooser {
    Case& run;
    bool reads_textures = false;

    template <class T>
    void operator()(std::string_view, T&) {}
    void feature(std::string_view macro, bool& on) {
        on = run.set == 1 || (run.set > 1 && run.random.unit() < 0.25f * float(1 + run.set % 3));
        reads_textures = reads_textures || (on && macro.ends_with("TEXTURE"));
    }
};

/// Uniforms that mean something; others are random numbers between 0.1 and 1, or 1, 2 or 3.
inline constexpr struct {
    std::string_view name;
    float value[4];
} named[] = {{"u_size", {width, height}},
             {"u_half_size", {width, height}},
             {"u_surface_size", {width, height}},
             {"u_level_size", {width, height}},
             {"u_extent", {width - 0.5f, height - 0.25f}},
             {"u_glow_size", {4 * width, 4 * height}},
             {"u_covered_size", {2 * width, 2 * height}},
             {"u_picture", {0, 0, width, height}},
             {"u_depth", {near_plane}},
             {"u_unproject", {0.8f, 0.5f, 0.01f, -0.02f}},
             {"u_reach", {20}},
             {"u_last_level", {3}},
             {"u_behind_levels", {6}},
             {"u_behind_reach", {20}},
             {"u_shadow_resolution", {shadow_size}},
             {"u_inverse_falloff", {2}},
             {"u_focus", {6, 150}},
             {"u_bloom", {0.3f, 1.2f, 0.8f, 0.2f}},
             {"u_eye_dome", {0.01f, 1.5f}},
             {"u_film", {0.7f, 1.4f, 100, 700}},
             {"u_volume", {0.6f, 0.4f, 1.5f, 0.3f}},
             {"u_absorption", {0.5f, 1, 0.2f}},
             {"u_always", {0}}};
inline constexpr struct {
    std::string_view name;
    int value;
} named_counts[] = {
    {"u_plain_lights", 5}, {"u_single_lights", 9}, {"u_block_lights", 12}, {"u_light_count", 12}};

/// Fills in uniforms by their types and names.
class Filler {
  public:
    Filler(Case& run, bool orthographic) : run_(run), random_(run.random), orthographic_(orthographic) {}

    void operator()(std::string_view name, float& to) { set(name, &to, 1); }
    void operator()(std::string_view name, uni::vec2& to) { set(name, &to.x, 2); }
    void operator()(std::string_view name, uni::vec3& to) { set(name, &to.x, 3); }
    void operator()(std::string_view name, uni::vec4& to) { set(name, &to.x, 4); }
    void operator()(std::string_view name, int& to) {
        to = 1 + random_.below(3);
        for (const auto& n : named_counts)
            if (n.name == name) to = n.value;
    }
    /// A rotation, with its axes as columns.
    void operator()(std::string_view, mat3& to) {
        const uni::vec3 z = run_.direction(), a = run_.direction();
        const uni::vec3 x = normalized({z.y * a.z - z.z * a.y, z.z * a.x - z.x * a.z, z.x * a.y - z.y * a.x});
        to = {x.x, x.y, x.z, z.y * x.z - z.z * x.y, z.z * x.x - z.x * x.z, z.x * x.y - z.y * x.x,
              z.x, z.y, z.z};
    }
    template <class T, size_t count>
    void operator()(std::string_view name, T (&to)[count]) {
        for (size_t i = 0; i < count; ++i) element(name, to[i], int(i));
    }
    void feature(std::string_view macro, bool& on) {
        if (on) run_.features += (run_.features.empty() ? " " : ",") + std::string(macro);
    }

    void operator()(std::string_view name, R32f& to) {
        picture<float>(to, 1, [&](int x, int y, int) {
            return name == "u_confusion" ? random_.number(-9, 9) : depth(x, y);
        });
        cut(to);
    }
    void operator()(std::string_view, R32ui& to) {
        picture<uint32_t>(to, 1, [&](int x, int y, int) { return (x / 9 + y / 7) % 3; });
    }
    void operator()(std::string_view, Rg8& to) {
        picture<uint8_t>(to, 2, [&](int, int, int) { return 255 * (random_.below(4) / 3); });
    }
    void operator()(std::string_view, R16& to) { shorts(to, 1); }
    void operator()(std::string_view, Rg16& to) { shorts(to, 2); }
    void operator()(std::string_view, Rgba16& to) { shorts(to, 4); }
    void operator()(std::string_view, Rgba8& to) { bytes(to), cut(to); }
    void operator()(std::string_view, EncodedLinear& to) {
        bytes(to);
        to.pixel_bytes = 4;
    }
    void operator()(std::string_view, Rgba16f& to) { halves(to, 4), cut(to); }
    void operator()(std::string_view, R16fLinear& to) { halves(to, 1); }
    void operator()(std::string_view, Rg16fLinear& to) { halves(to, 2); }
    void operator()(std::string_view, Rgba16fLinear& to) { halves(to, 4); }
    void operator()(std::string_view name, Rgba32f& to) {
        picture<float>(to, 4, [&](int x, int y, int channel) {
            // Of half resolution: depth, x and y of the normal, which pixel.
            if (name == "u_surface" && channel != 3)
                return channel == 0 ? depth(x, y) : random_.between(-0.7f, 0.7f);
            if (name == "u_surface") return float(random_.below(8));
            return light(channel);
        });
        cut(to);
    }
    void operator()(std::string_view, Rgba32fLinear& to) {
        picture<float>(to, 4, [&](int, int, int channel) { return light(channel); });
    }
    /// The film's thickness is a half, the volume's a float.
    void operator()(std::string_view name, Rgba32ui& to) {
        picture<uint32_t>(to, 4, [&](int, int, int channel) {
            const auto bits = uint32_t(random_.bits());
            if (name != "u_extension1" || channel % 3 == 0) return bits;
            const float thickness = float(random_.below(2)) * random_.unit();
            uint32_t as_bits;
            std::memcpy(&as_bits, &thickness, sizeof as_bits);
            return channel == 1 ? (bits & 0xffff0fffu) | 0x5000u : as_bits;
        });
    }
    void operator()(std::string_view name, Cube& to) {
        to.size = 8;
        to.levels = name == "u_irradiance" ? 1 : 4;
        int texels = 0;
        for (int l = 0; l < to.levels; ++l) {
            to.offsets[l] = texels;
            texels += 6 * ((to.size >> l) + 2) * ((to.size >> l) + 2);
        }
        to.data = run_.filled<uint16_t>(4 * size_t(texels), [&] { return half(); });
    }
    void operator()(std::string_view, Panorama& to) {
        to.levels = 4;
        size_t texels = 0;
        for (int l = 0; l < to.levels; ++l) {
            to.width[l] = 16 >> l;
            to.height[l] = 8 >> l;
            to.offsets[l] = texels;
            texels += size_t(to.width[l] + 1) * size_t(to.height[l]);
        }
        to.data = run_.filled<uint16_t>(4 * texels, [&] { return half(); });
    }
    void operator()(std::string_view, MipPicture& to) {
        to.width = width;
        to.height = height;
        to.levels = 6;
        for (int l = 0; l < to.levels; ++l) {
            const int texels = side(width, l) * side(height, l);
            int channel = 0;
            to.data[l] = run_.filled<float>(4 * size_t(texels), [&] { return light(channel++ % 4); });
        }
    }
    void operator()(std::string_view, Layers& to) {
        to.size = shadow_size;
        to.data = run_.floats(shadow_size * shadow_size * shadow_layers);
        // A layer is one block.
        static_assert(shadow_size <= Layers::block_size);
        const float* layer = to.data;
        auto* const least = run_.array<float>(shadow_layers);
        auto* const largest = run_.array<float>(shadow_layers);
        for (int i = 0; i < shadow_layers; ++i, layer += shadow_size * shadow_size) {
            const auto [low, high] = std::minmax_element(layer, layer + shadow_size * shadow_size);
            least[i] = *low;
            largest[i] = *high;
        }
        to.least = least;
        to.largest = largest;
    }
    void operator()(std::string_view name, Layers4& to) {
        const float sign = name == "u_tint_moment" ? -1 : 1;
        int channel = 0;
        to.size = shadow_size;
        to.data = run_.filled<float>(4 * shadow_size * shadow_size * shadow_layers,
                                     [&] { return (channel++ % 4 == 3 ? sign : 1) * random_.unit(); });
    }
    void operator()(std::string_view, Texture& to) {
        constexpr Texture::Wrap wraps[] = {Texture::Wrap::repeat, Texture::Wrap::mirror,
                                           Texture::Wrap::clamp};
        to.width = 13;
        to.height = 7;
        to.levels = 4;
        to.is_16_bit = random_.below(2) == 1;
        to.nearest = random_.below(4) == 0;
        to.wrap_u = random_.one_of(wraps);
        to.wrap_v = random_.one_of(wraps);
        int texels = 0;
        for (int l = 0; l < to.levels; ++l) {
            to.offsets[l] = texels;
            texels += (side(to.width, l) + 1) * side(to.height, l);
        }
        const size_t bytes = (to.is_16_bit ? 8 : 4) * size_t(texels + 1);  // the last pair reads one more
        to.texels = run_.filled<std::byte>(bytes, [&] { return std::byte(random_.below(256)); });
    }

  private:
    static int side(int size, int level) { return size >> level > 1 ? size >> level : 1; }

    void set(std::string_view name, float* to, int count) {
        for (int i = 0; i < count; ++i) to[i] = random_.between(0.1f, 1);
        for (const auto& n : named)
            if (n.name == name) std::memcpy(to, n.value, size_t(count) * sizeof(float));
        if (name == "u_depth" && orthographic_) to[1] = 9, to[2] = 1;
        if (name == "u_dash" && run_.set % 2 == 0) *to = 0;
    }
    void set(uni::vec4& to, const uni::vec3& v, float w) { to = {v.x, v.y, v.z, w}; }

    /// Lights of all kinds one after the other; maps of theirs for one or six layers.
    template <class T>
    void element(std::string_view name, T& to, int i) {
        if constexpr (requires { to.cone; }) {
            const int kind = i % 6;
            set(to.position, {random_.between(-3, 3), random_.between(-3, 3), random_.between(-6, 1)},
                float(kind));
            set(to.color, {random_.unit(), random_.unit(), 2 * random_.unit()}, 0.01f * float(i % 2));
            // In two steps: the order of a call's arguments is the compiler's.
            const float area = random_.between(0.5f, 2);
            set(to.direction, run_.direction(), area);
            to.cone = {5, -3, 0.4f, 0.3f};
        } else if constexpr (requires { to.window; }) {
            mat3 axes;
            (*this)(name, axes);
            const float* m = axes.m;
            to.x = {m[0], m[3], m[6], 0.5f};
            to.y = {m[1], m[4], m[7], -0.25f};
            to.z = {m[2], m[5], m[8], 3};
            to.window = {0.3f, 0.35f, 0.5f, 0.5f};
            const int layer = i < 4 ? i : 4 + 6 * ((i - 4) % 3);
            to.depth = {-0.1f, random_.between(0.5f, 1), float(i % 2), float(layer)};
            to.size = {0.2f, 0.5f, 0.02f, 1};
        } else if constexpr (std::is_same_v<T, uni::vec4>) {  // places of a gather: x, y, distance, area
            const float x = random_.between(-9, 9), y = random_.between(-9, 9);
            to = {x, y, std::sqrt(x * x + y * y), random_.between(0.5f, 3)};
        } else {
            (*this)(name, to);
        }
    }

    /// Of blocks at different distances; 0, nothing, in one of eight.
    float depth(int x, int y) {
        Random block(uint64_t(x / 8 + 64 * (y / 8) + 4096 * run_.set));
        const float distance =
            2 + 2 * block.unit() + 0.01f * float(x) + 0.02f * float(y) + 0.02f * random_.number(0, 1);
        return block.below(8) == 0 ? 0 : near_plane / distance;
    }
    float light(int channel) {
        const float value = random_.number(0, 1);
        if (channel == 3) return value < 0.25f ? 0 : value > 0.75f ? 1 : value;
        return value * (random_.below(16) == 0 ? 40.0f : 2.0f);
    }
    /// Between 0.06 and 4; some are 0 or denormal.
    uint16_t half() {
        return uint16_t(random_.below(16) == 0 ? random_.below(0x400) : 0x2c00 + random_.below(0x1800));
    }
    template <class T, class Value>
    void picture(View& view, int channels, Value&& value) {
        auto* to = run_.array<T>(size_t{width} * height * size_t(channels));
        view = {reinterpret_cast<std::byte*>(to), width, height, 0, 0, width, height};
        for (int i = 0; i < width * height * channels; ++i)
            to[i] = T(value(i / channels % width, i / channels / width, i % channels));
    }
    /// Of what can be read texel by texel only a part is held.
    void cut(View& view) const {
        if (run_.set % 4 != 3) return;
        view.x = view.y = 1;
        view.held_height -= 3;
    }
    void shorts(View& view, int channels) {
        picture<uint16_t>(view, channels, [&](int, int, int) { return random_.below(0x10000); });
    }
    void halves(View& view, int channels) {
        picture<uint16_t>(view, channels, [&](int, int, int) { return half(); });
    }
    /// The fourth channel is a kind of surfaces.
    void bytes(View& view) {
        constexpr uint8_t kinds[] = {0, 0, 10, 20, 102, 153, 204, 255};
        picture<uint8_t>(view, 4, [&](int, int, int channel) {
            return channel == 3 ? random_.one_of(kinds) : uint8_t(random_.below(256));
        });
    }

    Case& run_;
    Random& random_;
    bool orthographic_;
};

/// Calls `body` with the run of each set.
template <class Body>
void all_sets(std::string_view kernel, Body&& body) {
    Case::forget();
    for (int set = 0; set < sets; ++set) {
        Case run(kernel, set);
        body(run);
        run.report();
    }
    if (Case::tells_something()) return;
    std::fprintf(stderr, "%.*s wrote nothing, or few numbers\n", int(kernel.size()), kernel.data());
    std::exit(1);
}

}  // namespace easypbr::native
