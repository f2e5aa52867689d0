#include "easypbr/gpu/prefilter.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "easypbr/core/cache.h"
#include "easypbr/core/parallel.h"
#include "easypbr/gpu/cube_map.h"

namespace easypbr::gpu {
namespace {

/// Raise it when anything here changes what is computed.
constexpr const char* cache_version = "env7-";

constexpr float largest_half = 65504.0f;
/// Halves below 2^-14 are read as zero: where the brightest is less than this, all are raised.
constexpr float least_brightest = 0x1p-6f;

/// Divides by a power of two: `inverse` is what it is multiplied by.
void append_halves(const Vec4& value, float inverse, uint16_t* to) {
    for (int c = 0; c < 3; ++c)
        to[c] = Eigen::half_impl::float_to_half_rtne(std::clamp(value[c] * inverse, 0.0f, largest_half)).x;
    to[3] = Eigen::half_impl::float_to_half_rtne(value[3]).x;
}

int level_size(int level) {
    return PrefilteredEnvironment::base_size >> level;
}

/// One direction of the lobe around +z, the same for every texel of a level.
struct LobeSample {
    Vec3 light;
    float weight;  ///< NoL
    float level;   ///< mip level of the source whose texel covers this sample's solid angle
};

double radical_inverse(uint32_t bits) {
    bits = (bits << 16) | (bits >> 16);
    bits = ((bits & 0x55555555u) << 1) | ((bits & 0xaaaaaaaau) >> 1);
    bits = ((bits & 0x33333333u) << 2) | ((bits & 0xccccccccu) >> 2);
    bits = ((bits & 0x0f0f0f0fu) << 4) | ((bits & 0xf0f0f0f0u) >> 4);
    bits = ((bits & 0x00ff00ffu) << 8) | ((bits & 0xff00ff00u) >> 8);
    return double(bits) * 2.3283064365386963e-10;
}

std::vector<LobeSample> lobe_samples(float roughness, int count) {
    const double alpha = double(roughness) * roughness, a2 = alpha * alpha;
    const double texel =
        4 * pi / (6.0 * PrefilteredEnvironment::base_size * PrefilteredEnvironment::base_size);
    std::vector<LobeSample> samples;
    for (int i = 0; i < count; ++i) {
        const double u1 = (i + 0.5) / count, phi = 2 * pi * radical_inverse(uint32_t(i));
        const double n_dot_h = std::sqrt((1 - u1) / (1 + (a2 - 1) * u1));
        const double sine = std::sqrt(std::max(0.0, 1 - n_dot_h * n_dot_h));
        const Vec3d h(sine * std::cos(phi), sine * std::sin(phi), n_dot_h);
        const Vec3d l = 2 * n_dot_h * h - Vec3d::UnitZ();
        if (l.z() <= 0) continue;
        // pdf of l: D NoH / (4 VoH) = D / 4 because V = N.
        const double f = n_dot_h * n_dot_h * (a2 - 1) + 1;
        const double pdf = a2 / (pi * f * f) / 4;
        const double level = 0.5 * std::log2(1.0 / (count * pdf) / texel);
        samples.push_back({l.cast<float>(), float(l.z()), float(std::max(0.0, level))});
    }
    return samples;
}

/// Any orthonormal frame with z = n (Duff et al. 2017).
Mat3 frame_around(const Vec3& n) {
    const float sign = std::copysign(1.0f, n.z());
    const float a = -1.0f / (sign + n.z()), b = n.x() * n.y() * a;
    Mat3 frame;
    frame.col(0) = Vec3(1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
    frame.col(1) = Vec3(b, sign + n.y() * n.y() * a, -n.y());
    frame.col(2) = n;
    return frame;
}

Vec4 sample_chain(const std::vector<CubeMap>& chain, const Vec3& direction, float level) {
    level = std::clamp(level, 0.0f, float(chain.size() - 1));
    const size_t low = std::min(size_t(level), chain.size() - 1), high = std::min(low + 1, chain.size() - 1);
    const float f = level - float(low);
    return chain[low].sample(direction) * (1 - f) + chain[high].sample(direction) * f;
}

std::vector<uint16_t> filter_level(const std::vector<CubeMap>& chain, int level, float inverse) {
    const int size = level_size(level);
    // Fewer texels have wider lobes and get more samples: about the same work for each level.
    const std::vector<LobeSample> lobe = lobe_samples(roughness_of_level(level), 64 << (level - 1));
    const CubeMap shape(size);
    std::vector<uint16_t> halves(size_t(6) * size * size * 4);
    parallel_for(size_t(6) * size, 2, [&](size_t row) {
        const int face = int(row) / size, y = int(row) % size;
        for (int x = 0; x < size; ++x) {
            const Mat3 frame = frame_around(shape.direction(face, x, y));
            Vec4 sum = Vec4::Zero();
            float weight = 0;
            for (const LobeSample& sample : lobe) {
                sum += sample.weight * sample_chain(chain, frame * sample.light, sample.level);
                weight += sample.weight;
            }
            append_halves(sum / weight, inverse, &halves[(row * size + x) * 4]);
        }
    });
    return halves;
}

std::vector<uint16_t> copy_level(const CubeMap& cube, float inverse) {
    const int size = cube.size();
    std::vector<uint16_t> halves(size_t(6) * size * size * 4);
    parallel_for(size_t(6) * size, 16, [&](size_t row) {
        for (int x = 0; x < size; ++x)
            append_halves(cube.at(int(row) / size, x, int(row) % size), inverse,
                          &halves[(row * size + x) * 4]);
    });
    return halves;
}

/// Exact cosine convolution of the 32x32 level, each texel weighted by its solid angle.
std::vector<uint16_t> convolve_irradiance(const CubeMap& source, float inverse) {
    struct Emitter {
        Vec3 direction;
        float solid_angle;
        Vec3 radiance;
    };
    const int n = source.size();
    std::vector<Emitter> emitters;
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const float u = (float(x) + 0.5f) * 2 / float(n) - 1,
                            v = (float(y) + 0.5f) * 2 / float(n) - 1;
                const float solid_angle = 4.0f / float(n * n) / std::pow(1 + u * u + v * v, 1.5f);
                emitters.push_back(
                    {source.direction(face, x, y), solid_angle, source.at(face, x, y).head<3>()});
            }
    const int size = PrefilteredEnvironment::irradiance_size;
    const CubeMap shape(size);
    std::vector<uint16_t> halves(size_t(6) * size * size * 4);
    parallel_for(size_t(6) * size * size, 32, [&](size_t i) {
        const Vec3 normal = shape.direction(int(i) / (size * size), int(i) % size, int(i) / size % size);
        Vec4 sum = Vec4::Zero();
        for (const Emitter& emitter : emitters) {
            const float weight = std::max(0.0f, normal.dot(emitter.direction)) * emitter.solid_angle;
            sum += weight * Vec4(emitter.radiance.x(), emitter.radiance.y(), emitter.radiance.z(), 1);
        }
        // The weights sum to pi up to the coarseness of the texels: a constant environment must stay
        // constant.
        append_halves(sum / sum.w(), inverse, &halves[i * 4]);
    });
    return halves;
}

std::vector<std::byte> serialize(const PrefilteredEnvironment& environment) {
    std::vector<std::byte> blob;
    const auto append = [&](const std::vector<uint16_t>& halves) {
        const auto bytes = std::as_bytes(std::span(halves));
        blob.insert(blob.end(), bytes.begin(), bytes.end());
    };
    for (const auto& level : environment.radiance) append(level);
    append(environment.irradiance);
    const auto scale = std::as_bytes(std::span(&environment.scale, 1));
    blob.insert(blob.end(), scale.begin(), scale.end());
    return blob;
}

bool deserialize(std::span<const std::byte> blob, PrefilteredEnvironment& environment) {
    const auto take = [&](int size, std::vector<uint16_t>& halves) {
        halves.resize(size_t(6) * size * size * 4);
        const size_t bytes = halves.size() * sizeof(uint16_t);
        if (blob.size() < bytes) return false;
        std::memcpy(halves.data(), blob.data(), bytes);
        blob = blob.subspan(bytes);
        return true;
    };
    environment.radiance.resize(PrefilteredEnvironment::level_count);
    for (int level = 0; level < PrefilteredEnvironment::level_count; ++level)
        if (!take(level_size(level), environment.radiance[size_t(level)])) return false;
    if (!take(PrefilteredEnvironment::irradiance_size, environment.irradiance)) return false;
    if (blob.size() != sizeof environment.scale) return false;
    std::memcpy(&environment.scale, blob.data(), blob.size());
    return true;
}

}  // namespace

float roughness_of_level(int level) {
    return 1.0f - std::sqrt(1.0f - float(level) / float(PrefilteredEnvironment::level_count - 1));
}

float half_scale(const Image& image) {
    const std::span<const float> values = image.pixels<float>();
    constexpr size_t grain = size_t(1) << 18;
    std::vector<float> brightest_of((values.size() + grain - 1) / grain);
    parallel_chunks(values.size(), grain, [&](size_t begin, size_t end) {
        brightest_of[begin / grain] = std::ranges::max(values.subspan(begin, end - begin));
    });
    const float brightest = brightest_of.empty() ? 0 : std::ranges::max(brightest_of);
    if (!(brightest > 0) || (brightest >= least_brightest && brightest <= largest_half)) return 1;
    const int exponent = std::ilogb(brightest);
    return std::ldexp(1.0f, brightest > largest_half ? exponent - 14 : exponent);
}

PrefilteredEnvironment prefilter(const Environment& environment) {
    std::vector<CubeMap> chain;
    chain.push_back(CubeMap::from_equirect(environment.image(), PrefilteredEnvironment::base_size));
    while (chain.back().size() > 2) chain.push_back(chain.back().half());
    PrefilteredEnvironment result;
    result.scale = half_scale(environment.image());
    const float inverse = 1 / result.scale;
    result.radiance.push_back(copy_level(chain[0], inverse));
    for (int level = 1; level < PrefilteredEnvironment::level_count; ++level)
        result.radiance.push_back(filter_level(chain, level, inverse));
    const auto small =
        std::find_if(chain.begin(), chain.end(), [](const CubeMap& c) { return c.size() == 32; });
    result.irradiance = convolve_irradiance(*small, inverse);
    return result;
}

PrefilteredEnvironment prefilter_cached(const Environment& environment) {
    const std::string key = cache_version + environment.hash();
    PrefilteredEnvironment result;
    if (const auto blob = cache_load(key); blob && deserialize(*blob, result)) return result;
    result = prefilter(environment);
    cache_store(key, serialize(result));
    return result;
}

}  // namespace easypbr::gpu
