#include "easypbr/gpu/environment_maps.h"

#include <Eigen/Core>
#include <algorithm>

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/cube_map.h"

namespace easypbr::gpu {
namespace {

Eigen::half half_of_bits(uint16_t bits) {
    return Eigen::half_impl::raw_uint16_to_half(bits);
}

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

std::vector<uint16_t> halves_of(const Image& image, float scale) {
    const float inverse = 1 / scale;
    std::vector<uint16_t> halves(image.pixel_count() * 4);
    parallel_for(image.pixel_count(), 1 << 14, [&](size_t i) {
        const float* p = image.pixels<float>().data() + i * 3;
        for (int c = 0; c < 3; ++c)
            halves[i * 4 + c] = Eigen::half_impl::float_to_half_rtne(p[c] * inverse).x;
        halves[i * 4 + 3] = 0x3c00;
    });
    return halves;
}

gl::Texture equirect_texture(const Image& image, float scale) {
    const int levels = gl::full_levels(image.width(), image.height());
    gl::Texture texture(gl::Format::rgba16f, image.width(), image.height(), levels);
    Image level = image;
    for (int i = 0; i < levels; ++i) {
        const std::vector<uint16_t> halves = halves_of(level, scale);
        texture.upload(std::as_bytes(std::span(halves)), i);
        if (i + 1 < levels) level = half_size(level);
    }
    // Seen through one camera, the whole picture has the same level: one fetch instead of two.
    texture.sampling(gl::Filtering::linear_nearest_level, gl::Wrapping::repeat, gl::Wrapping::clamp);
    return texture;
}

std::vector<const std::vector<uint16_t>*> levels_of(const PrefilteredEnvironment& maps) {
    std::vector<const std::vector<uint16_t>*> levels;
    for (const auto& level : maps.radiance) levels.push_back(&level);
    return levels;
}

/// Adds the six faces of a level, each with a border of one texel from its neighbours.
void add_with_gutter(const std::vector<uint16_t>& faces, int size, std::vector<uint16_t>& texels) {
    // The gutter comes from the texels along the edges: the rest need not be decoded.
    CubeMap map(size);
    const auto row_of = [&](int face, int y) {
        return faces.data() + 4 * size_t(face * size + y) * size_t(size);
    };
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < size; ++y) {
            const bool is_edge = y == 0 || y == size - 1;
            for (int x = 0; x < size; x += is_edge ? 1 : std::max(size - 1, 1))
                for (int c = 0; c < 4; ++c)
                    map.at(face, x, y)[c] = float(half_of_bits(row_of(face, y)[4 * x + c]));
        }
    map.fill_gutter();
    const auto add_gutter = [&](int face, int x, int y) {
        for (int c = 0; c < 4; ++c) texels.push_back(Eigen::half(map.at(face, x, y)[c]).x);
    };
    for (int face = 0; face < 6; ++face) {
        for (int x = -1; x <= size; ++x) add_gutter(face, x, -1);
        for (int y = 0; y < size; ++y) {
            add_gutter(face, -1, y);
            texels.insert(texels.end(), row_of(face, y), row_of(face, y) + 4 * size_t(size));
            add_gutter(face, size, y);
        }
        for (int x = -1; x <= size; ++x) add_gutter(face, x, size);
    }
}

/// Adds the rows of a level, each with its first texel once more at the end.
void add_with_first_column(const std::vector<uint16_t>& rows, int width, std::vector<uint16_t>& texels) {
    const size_t row = 4 * size_t(width);
    for (size_t at = 0; at < rows.size(); at += row) {
        const auto first = rows.begin() + std::ptrdiff_t(at);
        texels.insert(texels.end(), first, first + std::ptrdiff_t(row));
        texels.insert(texels.end(), first, first + 4);
    }
}

}  // namespace

void EnvironmentMaps::prepare(const Environment& environment, const Environment& seen) {
    if (environment_.empty() || environment.hash() != environment_.hash()) {
        maps_ = {};
        environment_ = environment;
        prefiltered_ = gl::Texture();
        irradiance_ = gl::Texture();
        host_prefiltered_ = {};
        host_irradiance_ = {};
    }
    if (!seen.empty() && (seen_.empty() || seen_.hash() != seen.hash())) {
        seen_ = seen;
        seen_scale_ = 0;
        equirect_ = gl::Texture();
        host_equirect_ = {};
    }
}

const PrefilteredEnvironment& EnvironmentMaps::maps() const {
    if (maps_.radiance.empty()) maps_ = prefilter_cached(environment_);
    return maps_;
}

float EnvironmentMaps::scale() const {
    return maps().scale;
}

float EnvironmentMaps::seen_scale() const {
    if (seen_scale_ == 0) seen_scale_ = half_scale(seen_.image());
    return seen_scale_;
}

const gl::Texture& EnvironmentMaps::prefiltered() const {
    if (!prefiltered_) prefiltered_ = cube_texture(levels_of(maps()), PrefilteredEnvironment::base_size);
    return prefiltered_;
}

const gl::Texture& EnvironmentMaps::irradiance() const {
    if (!irradiance_)
        irradiance_ = cube_texture({&maps().irradiance}, PrefilteredEnvironment::irradiance_size);
    return irradiance_;
}

const gl::Texture& EnvironmentMaps::equirect() const {
    if (!equirect_) equirect_ = equirect_texture(seen_.image(), seen_scale());
    return equirect_;
}

const native::Cube& EnvironmentMaps::host_prefiltered() const {
    if (host_prefiltered_.texels.empty())
        host_prefiltered_ = host_cube(levels_of(maps()), PrefilteredEnvironment::base_size);
    return host_prefiltered_.cube;
}

const native::Cube& EnvironmentMaps::host_irradiance() const {
    if (host_irradiance_.texels.empty())
        host_irradiance_ = host_cube({&maps().irradiance}, PrefilteredEnvironment::irradiance_size);
    return host_irradiance_.cube;
}

const native::Panorama& EnvironmentMaps::host_equirect() const {
    if (host_equirect_.texels.empty()) host_equirect_ = host_panorama(seen_.image(), seen_scale());
    return host_equirect_.panorama;
}

EnvironmentMaps::HostCube EnvironmentMaps::host_cube(const std::vector<const std::vector<uint16_t>*>& levels,
                                                     int size) {
    HostCube host;
    host.cube = {.size = size, .levels = int(levels.size())};
    size_t count = 0;
    for (size_t level = 0; level < levels.size(); ++level)
        count += size_t(6 * 4) * ((size >> level) + 2) * ((size >> level) + 2);
    host.texels.reserve(count);
    for (size_t level = 0; level < levels.size(); ++level) {
        host.cube.offsets[level] = int(host.texels.size() / 4);
        add_with_gutter(*levels[level], size >> level, host.texels);
    }
    host.cube.data = host.texels.data();
    return host;
}

EnvironmentMaps::HostPanorama EnvironmentMaps::host_panorama(const Image& image, float scale) {
    HostPanorama host;
    Image level = image;
    const int levels =
        std::min(gl::full_levels(image.width(), image.height()), native::Panorama::most_levels);
    for (int i = 0; i < levels; ++i) {
        host.panorama.width[i] = level.width();
        host.panorama.height[i] = level.height();
        host.panorama.offsets[i] = host.texels.size() / 4;
        add_with_first_column(halves_of(level, scale), level.width(), host.texels);
        if (i + 1 < levels) level = half_size(level);
    }
    host.panorama.levels = levels;
    host.panorama.data = host.texels.data();
    return host;
}

float EnvironmentMaps::last_level() const {
    return float(PrefilteredEnvironment::level_count - 1);
}

}  // namespace easypbr::gpu
