// What denoisers are given.
#pragma once

#include <array>
#include <cstdint>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/native/kernels.h"
#include "easypbr/render/frame/target.h"
#include "easypbr/render/frame/tile_pixels.h"

namespace easypbr::render {

/// What guides denoisers: means over the frames that show a surface with noisy light at a pixel.
struct SurfaceMean {
    using Steps = std::array<uint16_t, 3>;

    float depth = 0;      ///< log2 of it; of an orthographic picture itself
    Steps normal{};       ///< world normal, half of 65535 for 0
    Steps reflectance{};  ///< linear, 65535 for 1
    uint32_t frames = 0;

    static Vec3 values(const Steps& steps) { return Vec3(steps[0], steps[1], steps[2]) / 65535; }
    Vec3 mean_normal() const { return 2 * values(normal) - Vec3::Ones(); }
    Vec3 mean_reflectance() const { return values(reflectance); }
};

/// Of what a pixel's light is taken note: that of its first frame with noise.
enum class Noisy : uint8_t { nothing, radiance, coverage };

/// Sums over the frames that have noisy light; see native::NoisyTile.
struct NoisyPixel {
    Vec3 light = Vec3::Zero();  ///< radiance, or the coverage in each channel
    float squares = 0;          ///< of the luminance
    float alpha = 0;            ///< weighted by the transmittance of overlays; 0 where coverage is noisy
    uint32_t frames = 0;
    Noisy noisy = Noisy::nothing;
};

inline NoisyPixel noisy_pixel_at(const native::NoisyTile& tile, size_t place) {
    return {{tile.light[0][place], tile.light[1][place], tile.light[2][place]},
            tile.squares[place],
            tile.alpha[place],
            tile.frames[place],
            Noisy(tile.noisy[place])};
}

inline SurfaceMean noisy_surface_at(const native::NoisyTile& tile, size_t place) {
    const auto steps = [&](const auto& of) {
        return SurfaceMean::Steps{of[0][place], of[1][place], of[2][place]};
    };
    return {tile.depth[place], steps(tile.normal), steps(tile.reflectance), tile.frames[place]};
}

/// Light of the surfaces that a picture shows, and what they are.
struct NoisyLight {
    /// In host memory, RGBA32F and whole: mean radiance; a: variance of that mean's luminance. 0 where no
    /// surface is.
    const Target& light;
    const TileValues<native::NoisyTile>& pixels;
    /// RGBA32F, undefined; for what denoisers write.
    const Target& scratch;
    bool is_white = false;  ///< nothing of the light is reflected: colours of surfaces do not matter
    float white = 1;        ///< radiance near that which is shown as white; a power of two

    Vec3 reflectance(const SurfaceMean& surface) const {
        return is_white ? Vec3(Vec3::Ones()) : surface.mean_reflectance();
    }

    /// Calls visit(index, surface, of what light is) for each pixel, by its index row by row, on all cores.
    template <class Visit>
    void each(Visit&& visit) const {
        const TileGrid& grid = pixels.grid();
        parallel_for(grid.count(), 64, [&](size_t tile) {
            const native::NoisyTile* of = pixels.of(tile);
            const PixelRect area = grid.area_of(tile);
            for (int y = area.y; y < area.y + area.height; ++y)
                for (int x = area.x; x < area.x + area.width; ++x) {
                    const size_t place = TileGrid::place_of(x, y);
                    visit(size_t(y) * size_t(grid.size().x()) + size_t(x),
                          of ? noisy_surface_at(*of, place) : SurfaceMean(),
                          of ? Noisy(of->noisy[place]) : Noisy::nothing);
                }
        });
    }
};

}  // namespace easypbr::render
