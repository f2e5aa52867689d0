#include "easypbr/render/denoise/radiance_mean.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "easypbr/core/luminance.h"
#include "easypbr/core/octahedral.h"
#include "easypbr/core/parallel.h"
#include "easypbr/render/frame/held_pixels.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Pixels of one task of parallel loops.
constexpr size_t grain = size_t(1) << 14;

/// A ground that has faded further is as good as not there.
constexpr float least_coverage = 1.0f / 64;

/// Less than this of a frame is as good as nothing.
constexpr float least_open = 1e-4f;

/// Light of the scene falls on the pixel: its radiance is an estimate.
bool is_noisy(uint8_t kind) {
    return is_lit_by_scene(kind) || kind == uint8_t(SurfaceKind::ground_catcher);
}

/// What part of the light a surface sends back, about, by its base colour and metallic: diffuse and at normal
/// incidence.
Vec3 reflectance(const Vec3& base, float metallic) {
    constexpr float dielectric = 0.04f;
    return (base + Vec3::Constant(dielectric * (1 - metallic))).cwiseMin(1.0f);
}

/// Of a mean's luminance, from a pixel of RadianceMean's `seen_`, by the sample variance; of one frame its
/// own square.
float variance_of(const Vec4& seen, float count) {
    const float bright = luminance(seen.head<3>()) / count, squares = seen.w() / count;
    return count > 1 ? std::max(0.0f, squares - bright * bright) / (count - 1) : squares;
}

/// By how much what is displayed differs where radiance, after exposure, does by a little.
float display_slope(float radiance) {
    constexpr float gamma = 2.2f, darkest = 0.02f;
    return std::pow(std::max(radiance, darkest), 1 / gamma - 1) / gamma;
}

/// Tiles end after 4, 6, 8, 12, 16, 24, ... frames, where Sobol's points are even.
bool may_end(int frames) {
    return frames >= 4 && std::popcount(unsigned(frames) & ~(std::bit_floor(unsigned(frames)) >> 1)) == 1;
}

/// A silhouette is smooth with so many.
constexpr int frames_of_silhouettes = 16;

/// Of fewer pixels of a tile the noise is not known: they are of a silhouette.
constexpr int least_pixels = 32;

void clear(const Target& target) {
    target.write(target.whole());
    std::ranges::fill(target.pixels<Vec4>(), Vec4::Zero());
}

}  // namespace

void RadianceMean::begin(Vec2i size, bool with_surfaces) {
    frames_ = 0;
    is_last_ = false;
    tiles_.begin(size);
    overlay_sum_.clear();
    coverage_.clear();
    open_.clear();
    weights_.clear();
    notes_surfaces_ = with_surfaces;
    const auto make = [&](Target& target) {
        if (target.size() != size) target = Target(gl::Format::rgba32f, size);
    };
    make(sum_);
    make(sample_);
    make(light_);
    clear(sum_);
    if (!with_surfaces) return;
    noisy_.assign(size_t(size.prod()), Noisy::nothing);
    for (Target* target : {&seen_, &surface_, &color_}) {
        make(*target);
        clear(*target);
    }
}

void RadianceMean::add(const Frame& frame, const PixelRect& area, const GBuffer& surfaces, bool see_through,
                       Transfers& transfers) {
    begin_weights();
    ++frames_;
    light_.release();
    sample_.download(area, transfers);
    const HeldPixels<Vec4> sample(sample_), sum(sum_);
    parallel_for(size_t(area.height), 16, [&](size_t row) {
        const int y = area.y + int(row);
        for (int x = area.x; x < area.x + area.width; ++x) {
            if (tiles_.has_ended(tiles_.tile_at(x, y))) continue;
            const size_t i = index_of(x, y);
            *sum.at(x, y) += open_part(i) * *sample.at(x, y);
            if (!weights_.empty()) weights_[i].x() += open_part(i);
        }
    });
    if (notes_surfaces_) {
        for (const Target* target : {&surfaces.albedo, &surfaces.normal, &surfaces.material, &surfaces.depth})
            target->download(area, transfers);
        if (see_through && !frame.resolved->settings.background.shows_environment())
            coverage_.resize(noisy_.size(), Vec2::Zero());
        add_surfaces(frame, area, surfaces);
    }
    open_.clear();
    sample_.release();
}

void RadianceMean::begin_weights() {
    if (open_.empty() || !weights_.empty()) return;
    // Nothing was over the frames before.
    weights_.assign(open_.size(), Vec2(float(frames_), 0));
    if (!notes_surfaces_) return;
    const auto color = color_.pixels<Vec4>();
    for (size_t i = 0; i < weights_.size(); ++i) weights_[i].y() = color[i].w();
}

void RadianceMean::add_surfaces(const Frame& frame, const PixelRect& area, const GBuffer& surfaces) {
    const HeldPixels<Vec4> sample(sample_), seen(seen_), surface(surface_), color(color_);
    const HeldPixels<std::array<uint16_t, 4>> albedo(surfaces.albedo);
    const HeldPixels<std::array<uint16_t, 2>> normal(surfaces.normal);
    const HeldPixels<std::array<uint8_t, 4>> material(surfaces.material);
    const HeldPixels<float> depth(surfaces.depth);
    // The depth of orthographic pictures is linear in [0, 1]: what is logarithmic elsewhere.
    const bool orthographic = frame.orthographic();
    const bool over_nothing = !frame.resolved->settings.background.shows_environment();
    parallel_for(size_t(area.height), 16, [&](size_t row) {
        const int y = area.y + int(row);
        for (int x = area.x; x < area.x + area.width; ++x) {
            const float* d = depth.at(x, y);
            if (!d || *d <= 0 || tiles_.has_ended(tiles_.tile_at(x, y))) continue;
            const std::array<uint8_t, 4>& m = *material.at(x, y);
            if (!is_noisy(m[3])) continue;
            const Vec4& of_frame = *sample.at(x, y);
            const bool is_caught = !is_lit_by_scene(m[3]);
            if (!is_caught && of_frame.w() < least_coverage) continue;
            const Noisy kind = is_caught && over_nothing ? Noisy::coverage : Noisy::radiance;
            const size_t i = index_of(x, y);
            Noisy& noted = noisy_[i];
            if (noted == Noisy::nothing) noted = kind;
            if (noted != kind) continue;
            const Vec3 light =
                kind == Noisy::coverage ? Vec3(Vec3::Constant(of_frame.w())) : Vec3(of_frame.head<3>());
            const float bright = luminance(light);
            const std::array<uint16_t, 4>& a = *albedo.at(x, y);
            const std::array<uint16_t, 2>& n = *normal.at(x, y);
            const Vec3 direction = oct_decode(Vec2(n[0], n[1]) / 32767.5f - Vec2(1, 1));
            // Where a ground fades its radiance does, as if it reflected less.
            const Vec3 reflects =
                is_caught ? Vec3(Vec3::Ones())
                          : Vec3(reflectance(Vec3(a[0], a[1], a[2]) / 65535.0f, float(m[0]) / 255) *
                                 std::clamp(of_frame.w(), 0.0f, 1.0f));
            if (!coverage_.empty() && kind == Noisy::radiance)
                coverage_[i] += Vec2(of_frame.w(), of_frame.w() * of_frame.w());
            if (!weights_.empty()) weights_[i].y() += open_part(i);
            *seen.at(x, y) += Vec4(light.x(), light.y(), light.z(), bright * bright);
            *surface.at(x, y) +=
                Vec4(direction.x(), direction.y(), direction.z(), orthographic ? *d : std::log2(*d));
            *color.at(x, y) += Vec4(reflects.x(), reflects.y(), reflects.z(), 1);
        }
    });
}

void RadianceMean::add_overlay(const Frame& frame, const Target& overlay, Transfers& transfers) {
    overlay.download(frame.whole(), transfers);
    overlay_sum_.resize(size_t(frame.size.prod()), Vec4::Zero());
    open_.assign(overlay_sum_.size(), 1.0f);
    const auto pixels = overlay.pixels<Eigen::Vector4<Eigen::half>>();
    const PixelRect& area = overlay.area();
    parallel_for(size_t(area.height), 16, [&](size_t y) {
        const size_t from = y * size_t(area.width),
                     to = (y + size_t(area.y)) * size_t(frame.size.x()) + size_t(area.x);
        for (size_t x = 0; x < size_t(area.width); ++x) {
            const Vec4 over = pixels[from + x].cast<float>();
            overlay_sum_[to + x] += over;
            open_[to + x] = std::clamp(1 - over.w(), 0.0f, 1.0f);
        }
    });
}

RadianceMean::TileError RadianceMean::error_of(size_t tile, float exposure) const {
    const auto seen = seen_.pixels<Vec4>(), color = color_.pixels<Vec4>();
    const PixelRect area = tiles_.area_of(tile);
    const int frames = tiles_.frames_of(tile, frames_);
    TileError error;
    for (int y = area.y; y < area.y + area.height; ++y)
        for (int x = area.x; x < area.x + area.width; ++x) {
            const size_t i = index_of(x, y);
            const float count = color[i].w();
            if (!(count > 0)) continue;
            const float deviation = std::sqrt(variance_of(seen[i], count)),
                        bright = exposure * luminance(seen[i].head<3>()) / count;
            // A coverage is displayed as it is.
            const float displayed =
                noisy_[i] == Noisy::coverage ? deviation : exposure * deviation * display_slope(bright);
            error.mean += displayed;
            error.quadratic += displayed * displayed;
            error.has_silhouette |= int(count) != frames;
            ++error.pixels;
        }
    const float pixels = float(std::max(error.pixels, 1));
    error.mean /= pixels;
    error.quadratic = std::sqrt(error.quadratic / pixels);
    return error;
}

float RadianceMean::noise(float exposure) const {
    std::vector<float> errors(tiles_.count(), -1.0f);
    parallel_for(errors.size(), 64, [&](size_t tile) {
        const TileError error = error_of(tile, exposure);
        if (error.pixels >= least_pixels) errors[tile] = error.mean;
    });
    std::erase(errors, -1.0f);
    if (errors.empty()) return 0;
    const auto at = errors.begin() + std::ptrdiff_t(double(errors.size() - 1) * 0.95);
    std::ranges::nth_element(errors, at);
    return *at;
}

void RadianceMean::end_tiles(float noise, float exposure) {
    if (!may_end(frames_)) return;
    parallel_for(tiles_.count(), 64, [&](size_t tile) {
        if (tiles_.has_ended(tile)) return;
        const TileError error = error_of(tile, exposure);
        const bool is_edge = error.has_silhouette || error.pixels < least_pixels;
        if (error.pixels == 0 || (is_edge && frames_ < frames_of_silhouettes)) return;
        if (error.quadratic < noise) tiles_.end(tile, frames_);
    });
}

const Target& RadianceMean::mean(Denoising denoising, Transfers& transfers) {
    const bool finds_oidn = denoising == Denoising::best && !OpenImageDenoise::version().empty();
    if (denoising == Denoising::best) denoising = finds_oidn ? Denoising::oidn : Denoising::filter;
    const auto sum = sum_.pixels<Vec4>();
    const auto scale_of = [&](size_t i) {
        if (!weights_.empty()) return weights_[i].x() > least_open ? 1 / weights_[i].x() : 0.0f;
        const size_t tile = tiles_.tile_at(int(i) % sum_.width(), int(i) / sum_.width());
        return 1 / float(tiles_.frames_of(tile, frames_));
    };
    if (denoising == Denoising::off || !notes_surfaces_) {
        light_.write(light_.whole());
        const auto to = light_.pixels<Vec4>();
        parallel_for(to.size(), grain, [&](size_t i) { to[i] = sum[i] * scale_of(i); });
        return light_;
    }
    const std::vector<float> coverage = denoised_coverage(denoising, transfers);
    write_noisy_light();
    const Target& result = denoised(denoising, color_, is_last_, transfers);
    const auto to = result.pixels<Vec4>(), seen = seen_.pixels<Vec4>(), color = color_.pixels<Vec4>();
    parallel_for(to.size(), grain, [&](size_t i) {
        const Vec3 changed = (to[i].head<3>() * color[i].w() - seen[i].head<3>()) *
                             (weights_.empty() ? 1.0f : open_part_of_seen(i));
        to[i] = sum[i];
        if (noisy_[i] == Noisy::radiance) to[i].head<3>() += changed;
        if (noisy_[i] == Noisy::coverage) to[i].w() += luminance(changed);
        if (!coverage.empty()) to[i].w() += coverage[i] * (weights_.empty() ? 1.0f : open_part_of_seen(i));
        to[i] *= scale_of(i);
    });
    return result;
}

const Target& RadianceMean::denoised(Denoising denoising, const Target& color, bool is_last,
                                     Transfers& transfers) {
    const NoisyLight noisy{light_, surface_, color, sample_, is_last};
    return denoising == Denoising::oidn ? oidn_.denoise(noisy) : filter_.smooth(noisy, transfers);
}

std::vector<float> RadianceMean::denoised_coverage(Denoising denoising, Transfers& transfers) {
    if (coverage_.empty()) return {};
    write_noisy_coverage();
    // Nothing of it is reflected.
    const Target white(gl::Format::rgba32f, color_.size());
    white.write(white.whole());
    const auto color = color_.pixels<Vec4>();
    std::ranges::transform(color, white.pixels<Vec4>().begin(),
                           [](const Vec4& sum) { return Vec4(Vec4::Constant(sum.w())); });
    const auto result = denoised(denoising, white, false, transfers).pixels<Vec4>();
    std::vector<float> changes(result.size());
    parallel_for(changes.size(), grain, [&](size_t i) {
        if (noisy_[i] == Noisy::radiance)
            changes[i] = luminance(result[i].head<3>()) * color[i].w() - coverage_[i].x();
    });
    return changes;
}

void RadianceMean::write_noisy_coverage() {
    write_noisy_light();
    const auto to = light_.pixels<Vec4>(), color = color_.pixels<Vec4>();
    parallel_for(to.size(), grain, [&](size_t i) {
        const float count = color[i].w();
        if (noisy_[i] != Noisy::radiance || !(count > 0)) return;
        const float mean = coverage_[i].x() / count, squares = coverage_[i].y() / count;
        const float variance = count > 1 ? std::max(0.0f, squares - mean * mean) / (count - 1) : squares;
        to[i] = Vec4(mean, mean, mean, variance);
    });
}

void RadianceMean::write_noisy_light() {
    light_.write(light_.whole());
    const auto to = light_.pixels<Vec4>(), seen = seen_.pixels<Vec4>(), color = color_.pixels<Vec4>();
    parallel_for(to.size(), grain, [&](size_t i) {
        const float count = color[i].w();
        to[i].setZero();
        if (!(count > 0)) return;
        const Vec3 mean = seen[i].head<3>() / count;
        to[i] = Vec4(mean.x(), mean.y(), mean.z(), variance_of(seen[i], count));
    });
}

const Target* RadianceMean::overlay_mean() {
    if (overlay_sum_.empty()) return nullptr;
    const Vec2i size = sum_.size();
    if (overlay_mean_.size() != size) overlay_mean_ = Target(gl::Format::rgba16f, size);
    overlay_mean_.write(overlay_mean_.whole());
    const auto to = overlay_mean_.pixels<Eigen::Vector4<Eigen::half>>();
    const float scale = 1 / float(frames_);
    parallel_for(to.size(), grain, [&](size_t i) { to[i] = (overlay_sum_[i] * scale).cast<Eigen::half>(); });
    return &overlay_mean_;
}

}  // namespace easypbr::render
