#include "easypbr/gpu/environment_maps.h"

#include <Eigen/Core>
#include <algorithm>

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/prefilter.h"

namespace easypbr::gpu {
namespace {

gl::Texture cube_texture(const std::vector<const std::vector<uint16_t>*>& levels, int size) {
    gl::Texture texture(gl::Format::rgba16f, size, size, int(levels.size()), gl::TextureKind::cube);
    for (size_t level = 0; level < levels.size(); ++level) {
        const auto bytes = std::as_bytes(std::span(*levels[level]));
        const size_t face_bytes = bytes.size() / 6;
        for (int face = 0; face < 6; ++face)
            texture.upload(bytes.subspan(size_t(face) * face_bytes, face_bytes), int(level), face);
    }
    texture.sampling(levels.size() > 1 ? gl::Filtering::trilinear : gl::Filtering::linear);
    return texture;
}

std::vector<uint16_t> halves_of(const Image& image) {
    std::vector<uint16_t> halves(image.pixel_count() * 4);
    parallel_for(image.pixel_count(), 1 << 14, [&](size_t i) {
        const float* p = image.pixels<float>().data() + i * 3;
        for (int c = 0; c < 3; ++c)
            halves[i * 4 + c] = Eigen::half_impl::float_to_half_rtne(std::min(p[c], 65504.0f)).x;
        halves[i * 4 + 3] = 0x3c00;
    });
    return halves;
}

gl::Texture equirect_texture(const Image& image) {
    const int levels = gl::full_levels(image.width(), image.height());
    gl::Texture texture(gl::Format::rgba16f, image.width(), image.height(), levels);
    Image level = image;
    for (int i = 0; i < levels; ++i) {
        const std::vector<uint16_t> halves = halves_of(level);
        texture.upload(std::as_bytes(std::span(halves)), i);
        if (i + 1 < levels) level = half_size(level);
    }
    // Seen through one camera, the whole picture has the same level: one fetch instead of two.
    texture.sampling(gl::Filtering::linear_nearest_level, gl::Wrapping::repeat, gl::Wrapping::clamp);
    return texture;
}

}  // namespace

void EnvironmentMaps::prepare(const Environment& environment, const Environment& seen) {
    if (environment.hash() != hash_) {
        const PrefilteredEnvironment maps = prefilter_cached(environment);
        std::vector<const std::vector<uint16_t>*> levels;
        for (const auto& level : maps.radiance) levels.push_back(&level);
        prefiltered_ = cube_texture(levels, PrefilteredEnvironment::base_size);
        irradiance_ = cube_texture({&maps.irradiance}, PrefilteredEnvironment::irradiance_size);
        hash_ = environment.hash();
    }
    if (!seen.empty() && equirect_hash_ != seen.hash()) {
        equirect_ = equirect_texture(seen.image());
        equirect_hash_ = seen.hash();
    }
}

float EnvironmentMaps::last_level() const {
    return float(PrefilteredEnvironment::level_count - 1);
}

}  // namespace easypbr::gpu
