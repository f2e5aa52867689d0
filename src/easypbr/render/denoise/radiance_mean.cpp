#include "easypbr/render/denoise/radiance_mean.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "easypbr/core/luminance.h"
#include "easypbr/core/parallel.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/frame/half_light.h"
#include "easypbr/render/frame/held_pixels.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Less than this of a frame is as good as nothing.
constexpr float least_open = 1e-4f;

/// What is added to what the coverage differs by, -1 to 1, so that denoisers are given no negative light.
constexpr float least_coverage = 1;

/// What a coverage of half precision may be rounded by.
constexpr float rounded_coverage = 1e-3f;

/// Light of the scene falls on the pixel: its radiance is an estimate.
bool is_noisy(uint8_t kind) {
    return is_lit_by_scene(kind) || kind == uint8_t(SurfaceKind::ground_catcher);
}

/// Of a mean's luminance, by the sample variance; of one frame its own square.
float variance_of(const NoisyPixel& pixel) {
    const auto count = float(pixel.frames);
    const float bright = luminance(pixel.light) / count, squares = pixel.squares / count;
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

/// A silhouette is smooth with so many, and so is what a lens or motion blurs.
constexpr int frames_of_silhouettes = 16;

/// Of fewer pixels of a tile the noise is not known: they are of a silhouette.
constexpr int least_pixels = 32;

PixelRect common(const PixelRect& a, const PixelRect& b) {
    const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
    return {x, y, std::min(a.x + a.width, b.x + b.width) - x, std::min(a.y + a.height, b.y + b.height) - y};
}

}  // namespace

class RadianceMean::FrameSurfaces {
  public:
    FrameSurfaces(const Frame& frame, const GBuffer& surfaces, bool layered)
        : albedo_(surfaces.albedo),
          normal_(surfaces.normal),
          material_(surfaces.material),
          depth_(surfaces.depth) {
        row_.end_of_lit = int(SurfaceKind::display);
        row_.catcher = int(SurfaceKind::ground_catcher);
        row_.orthographic = frame.orthographic();
        row_.layered = layered;
        row_.over_nothing = !frame.resolved->settings.background.shows_environment();
    }

    bool is_seen(int x, int y) const {
        const float* depth = depth_.at(x, y);
        return depth && *depth > 0;
    }
    bool is_noisy(int x, int y) const {
        return is_seen(x, y) && render::is_noisy(uint8_t(*material_.at(x, y) >> 24));
    }

    /// That which is certain; see LayerGuides.
    float coverage(int x, int y) const { return float(*albedo_.at(x, y) >> 48) / 65535; }

  private:
    friend RowOfFrame;
    HeldPixels<uint64_t> albedo_;
    HeldPixels<uint32_t> normal_, material_;
    HeldPixels<float> depth_;
    native::NoisyRow row_;
};

/// A row of a tile. What is not held, or lies outside of an area, shows no surface and no light.
class RadianceMean::RowOfFrame {
  public:
    RowOfFrame(const FrameSurfaces& of, const HeldPixels<Vec4>& sample, std::span<const float> open)
        : of_(of), sample_(sample), open_(open), row_(of.row_) {}

    /// Pixels [x, x + width) of it; `left`: the tile's first.
    const native::NoisyRow& at(int left, const PixelRect& area, size_t index) {
        constexpr int last = native::NoisyRow::pixels - 1;
        const int y = area.y;
        const bool is_whole = area.width > last && of_.depth_.at(left, y) && of_.depth_.at(left + last, y);
        row_.open = open_.empty() ? nullptr : &open_[index];
        if (is_whole) {
            row_.sample = sample_.at(left, y)->data();
            row_.normal = of_.normal_.at(left, y);
            row_.material = of_.material_.at(left, y);
            row_.albedo = of_.albedo_.at(left, y);
            row_.depth = of_.depth_.at(left, y);
        } else {
            copy(left, area, index);
        }
        return row_;
    }

  private:
    void copy(int left, const PixelRect& area, size_t index) {
        samples_.fill(Vec4::Zero());
        depths_.fill(0);
        opens_.fill(1);
        for (int x = area.x; x < area.x + area.width; ++x) {
            const auto i = size_t(x - left);
            samples_[i] = *sample_.at(x, area.y);
            if (!open_.empty()) opens_[i] = open_[index + size_t(x - area.x)];
            const float* depth = of_.depth_.at(x, area.y);
            if (!depth) continue;
            depths_[i] = *depth;
            normals_[i] = *of_.normal_.at(x, area.y);
            materials_[i] = *of_.material_.at(x, area.y);
            albedos_[i] = *of_.albedo_.at(x, area.y);
        }
        row_.sample = samples_.data()->data();
        row_.normal = normals_.data();
        row_.material = materials_.data();
        row_.albedo = albedos_.data();
        row_.depth = depths_.data();
        if (row_.open) row_.open = opens_.data();
    }

    template <class T>
    using Row = std::array<T, native::NoisyRow::pixels>;

    const FrameSurfaces& of_;
    const HeldPixels<Vec4>& sample_;
    std::span<const float> open_;
    native::NoisyRow row_;
    Row<Vec4> samples_;
    Row<uint32_t> normals_{}, materials_{};
    Row<uint64_t> albedos_{};
    Row<float> depths_, opens_;
};

void RadianceMean::begin(Vec2i size, bool with_surfaces) {
    frames_ = 0;
    tiles_.begin(size);
    overlay_sum_.clear();
    coverage_.clear();
    open_.clear();
    weights_.clear();
    notes_surfaces_ = with_surfaces;
    varies_ = false;
    beside_.begin(size);
    noisy_.begin(size);
    for (Target* target : {&sample_, &light_})
        if (target->size() != size) *target = Target(gl::Format::rgba32f, size);
}

void RadianceMean::begin_frame(const Frame& frame, bool see_through) {
    begin_weights();
    if (frame.motion || frame.through_lens || !open_.empty()) varies_ = true;
    ++frames_;
    light_.release();
    if (notes_surfaces_ && see_through && !frame.resolved->settings.background.shows_environment())
        coverage_.resize(size_t(frame.size.prod()), Vec2::Zero());
}

void RadianceMean::end_frame() {
    open_.clear();
    sample_.release();
}

void RadianceMean::add(const Frame& frame, const PixelRect& area, const GBuffer& surfaces,
                       Transfers& transfers) {
    sample_.download(area, transfers);
    if (notes_surfaces_)
        for (const Target* target : {&surfaces.albedo, &surfaces.normal, &surfaces.material, &surfaces.depth})
            target->download(area, transfers);
    std::optional<FrameSurfaces> of_frame;
    if (notes_surfaces_) of_frame.emplace(frame, surfaces, !coverage_.empty());
    const std::vector<size_t> tiles = tiles_.tiles_in(area);
    parallel_for(tiles.size(), 16, [&](size_t i) {
        if (!tiles_.has_ended(tiles[i]))
            add_to_tile(tiles[i], common(tiles_.area_of(tiles[i]), area), of_frame ? &*of_frame : nullptr);
    });
}

void RadianceMean::begin_weights() {
    if (open_.empty() || !weights_.empty()) return;
    // Nothing was over the frames before.
    weights_.assign(open_.size(), Vec2(float(frames_), 0));
    each({0, 0, tiles_.size().x(), tiles_.size().y()}, [&](size_t i, int x, int y) {
        const native::NoisyTile* tile = noisy_.of(tiles_.tile_at(x, y));
        weights_[i].y() = tile ? float(tile->frames[TileGrid::place_of(x, y)]) : 0.0f;
    });
}

void RadianceMean::add_to_tile(size_t tile, const PixelRect& area, const FrameSurfaces* surfaces) {
    bool is_noisy = surfaces && noisy_.of(tile);
    if (surfaces && !is_noisy) {
        bool is_seen = false;
        each(area, [&](size_t, int x, int y) {
            is_seen = is_seen || surfaces->is_seen(x, y);
            is_noisy = is_noisy || surfaces->is_noisy(x, y);
        });
        if (is_seen && !is_noisy) varies_ = true;
    }
    if (!is_noisy) return add_beside(tile, area);
    native::NoisyTile& noisy = noisy_.make(tile);
    const HeldPixels<Vec4> sample(sample_);
    RowOfFrame rows(*surfaces, sample, open_);
    const int left = tiles_.area_of(tile).x;
    native::BesideNoisy beside;
    for (int y = area.y; y < area.y + area.height; ++y) {
        const PixelRect row{area.x, y, area.width, 1};
        const bool has_beside =
            native::add_noisy_row(rows.at(left, row, index_of(area.x, y)), y % TileGrid::side, noisy, beside);
        add_row(tile, row, *surfaces, beside, has_beside);
    }
}

void RadianceMean::add_row(size_t tile, const PixelRect& row, const FrameSurfaces& surfaces,
                           const native::BesideNoisy& of_row, bool has_beside) {
    if (!has_beside && weights_.empty() && coverage_.empty()) return;
    const HeldPixels<Vec4> sample(sample_);
    each(row, [&](size_t i, int x, int y) {
        const size_t place = TileGrid::place_of(x, y);
        const auto at = size_t(x % TileGrid::side);
        const auto taken = Noisy(of_row.taken[at]);
        if (!weights_.empty())
            weights_[i] += Vec2(open_part(i), taken != Noisy::nothing ? open_part(i) : 0.0f);
        if (!coverage_.empty() && taken == Noisy::radiance) {
            const float by_chance = sample.at(x, y)->w() - surfaces.coverage(x, y);
            coverage_[i] += Vec2(by_chance, by_chance * by_chance);
        }
        if (!has_beside) return;
        const Vec4 beside(of_row.radiance[0][at], of_row.radiance[1][at], of_row.radiance[2][at],
                          of_row.radiance[3][at]);
        if ((beside.array() != 0).any()) beside_.make(tile)[place].radiance += beside;
    });
}

void RadianceMean::add_beside(size_t tile, const PixelRect& area) {
    const HeldPixels<Vec4> sample(sample_);
    each(area, [&](size_t i, int x, int y) {
        if (!weights_.empty()) weights_[i].x() += open_part(i);
        const Vec4 beside = open_part(i) * *sample.at(x, y);
        if ((beside.array() != 0).any()) beside_.make(tile)[TileGrid::place_of(x, y)].radiance += beside;
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
    TileError error;
    const native::NoisyTile* noisy = noisy_.of(tile);
    if (!noisy) return error;
    const int frames = tiles_.frames_of(tile, frames_);
    each(tiles_.area_of(tile), [&](size_t /*index*/, int x, int y) {
        const NoisyPixel pixel = noisy_pixel_at(*noisy, TileGrid::place_of(x, y));
        const uint32_t count = pixel.frames;
        if (count == 0) return;
        const float deviation = std::sqrt(variance_of(pixel)),
                    bright = exposure * luminance(pixel.light) / float(count);
        // A coverage is displayed as it is.
        const float displayed =
            pixel.noisy == Noisy::coverage ? deviation : exposure * deviation * display_slope(bright);
        error.mean += displayed;
        error.quadratic += displayed * displayed;
        error.has_silhouette |= int(count) != frames;
        ++error.pixels;
    });
    const float pixels = float(std::max(error.pixels, 1));
    error.mean /= pixels;
    error.quadratic = std::sqrt(error.quadratic / pixels);
    return error;
}

bool RadianceMean::is_edge(const TileError& error) {
    return error.pixels > 0 && (error.has_silhouette || error.pixels < least_pixels);
}

std::vector<float> RadianceMean::mean_errors(const std::vector<TileError>& tiles) {
    std::vector<float> means;
    float small_sum = 0;
    int small_pixels = 0;
    bool has_small = false;
    for (const TileError& tile : tiles) {
        if (tile.pixels >= least_pixels) {
            means.push_back(tile.mean);
            continue;
        }
        small_sum += tile.mean * float(tile.pixels);
        small_pixels += tile.pixels;
        if (small_pixels < least_pixels) continue;
        means.push_back(small_sum / float(small_pixels));
        has_small = true;
        small_sum = 0;
        small_pixels = 0;
    }
    // Fewer are left than tell the noise: they count where they are all there is of their kind.
    if (small_pixels > 0 && !has_small) means.push_back(small_sum / float(small_pixels));
    return means;
}

bool RadianceMean::is_good(float noise, float exposure) const {
    std::vector<TileError> tiles(tiles_.count());
    parallel_for(tiles.size(), 64, [&](size_t tile) { tiles[tile] = error_of(tile, exposure); });
    if (frames_ < frames_of_silhouettes && (varies_ || std::ranges::any_of(tiles, is_edge))) return false;
    std::vector<float> errors = mean_errors(tiles);
    if (errors.empty()) return true;
    // 95 of 100 of them, rounded up: of fewer than 20 all.
    const auto at = errors.begin() + std::ptrdiff_t((errors.size() * 19 + 19) / 20 - 1);
    std::ranges::nth_element(errors, at);
    return *at < noise;
}

void RadianceMean::end_tiles(float noise, float exposure) {
    if (!may_end(frames_)) return;
    parallel_for(tiles_.count(), 64, [&](size_t tile) {
        if (tiles_.has_ended(tile)) return;
        const TileError error = error_of(tile, exposure);
        if (error.pixels == 0 || (is_edge(error) && frames_ < frames_of_silhouettes)) return;
        if (error.quadratic < noise) tiles_.end(tile, frames_);
    });
}

const Target& RadianceMean::mean(Denoising denoising, float exposure, Transfers& transfers) {
    const bool finds_oidn = denoising == Denoising::best && !OpenImageDenoise::version().empty();
    if (denoising == Denoising::best) denoising = finds_oidn ? Denoising::oidn : Denoising::filter;
    if (denoising == Denoising::off || !notes_surfaces_) {
        light_.write(light_.whole());
        write_mean(light_, nullptr, {});
        return light_;
    }
    const std::vector<float> coverage = denoised_coverage(denoising, transfers);
    write_noisy_light();
    const Target& result = denoised(denoising, false, half_light_scale(exposure), transfers);
    write_mean(result, &result, coverage);
    return result;
}

void RadianceMean::write_mean(const Target& to, const Target* light, const std::vector<float>& coverage) {
    const auto pixels = to.pixels<Vec4>();
    parallel_for(tiles_.count(), 64, [&](size_t tile) {
        const native::NoisyTile* noisy = noisy_.of(tile);
        const PixelsOfTile<Sum>* beside = beside_.of(tile);
        const auto frames = float(tiles_.frames_of(tile, frames_));
        each(tiles_.area_of(tile), [&](size_t i, int x, int y) {
            const size_t place = TileGrid::place_of(x, y);
            Vec4 sum = beside ? (*beside)[place].radiance : Vec4(Vec4::Zero());
            if (noisy && noisy->frames[place] > 0) {
                const NoisyPixel pixel = noisy_pixel_at(*noisy, place);
                const auto count = float(pixel.frames);
                const float open = weights_.empty() ? 1.0f : weights_[i].y() / count;
                Vec3 seen = pixel.light;
                if (light) {
                    seen = light->pixels<Vec4>()[i].head<3>() * count;
                    if (open != 1) seen = pixel.light + (seen - pixel.light) * open;
                }
                if (pixel.noisy == Noisy::coverage) {
                    sum.w() += luminance(seen);
                } else {
                    sum.head<3>() += seen;
                    sum.w() += pixel.alpha;
                    if (!coverage.empty()) sum.w() += coverage[i] * open;
                }
            }
            const float weight = weights_.empty() ? frames : weights_[i].x();
            pixels[i] = weight > least_open ? Vec4(sum / weight) : Vec4(Vec4::Zero());
            // A shadow found by few samples, or denoised, may take more light than there is.
            pixels[i].w() = std::clamp(pixels[i].w(), 0.0f, 1.0f);
        });
    });
}

const Target& RadianceMean::denoised(Denoising denoising, bool is_white, float white, Transfers& transfers) {
    const NoisyLight noisy{light_, noisy_, sample_, is_white, white};
    return denoising == Denoising::oidn ? oidn_.denoise(noisy) : filter_.smooth(noisy, transfers);
}

std::vector<float> RadianceMean::denoised_coverage(Denoising denoising, Transfers& transfers) {
    if (!has_noisy_coverage()) return {};
    write_noisy_coverage();
    const auto result = denoised(denoising, true, 1, transfers).pixels<Vec4>();
    std::vector<float> changes(result.size());
    parallel_for(tiles_.count(), 64, [&](size_t tile) {
        const native::NoisyTile* noisy = noisy_.of(tile);
        if (!noisy) return;
        each(tiles_.area_of(tile), [&](size_t i, int x, int y) {
            const NoisyPixel pixel = noisy_pixel_at(*noisy, TileGrid::place_of(x, y));
            if (pixel.noisy == Noisy::radiance)
                changes[i] = (luminance(result[i].head<3>()) - least_coverage) * float(pixel.frames) -
                             coverage_[i].x();
        });
    });
    return changes;
}

bool RadianceMean::has_noisy_coverage() const {
    return std::ranges::any_of(coverage_, [&](const Vec2& sums) {
        return sums.y() > rounded_coverage * rounded_coverage * float(frames_);
    });
}

void RadianceMean::write_noisy_coverage() {
    write_noisy_light();
    const auto to = light_.pixels<Vec4>();
    parallel_for(tiles_.count(), 64, [&](size_t tile) {
        const native::NoisyTile* noisy = noisy_.of(tile);
        if (!noisy) return;
        each(tiles_.area_of(tile), [&](size_t i, int x, int y) {
            const NoisyPixel pixel = noisy_pixel_at(*noisy, TileGrid::place_of(x, y));
            if (pixel.noisy == Noisy::coverage) to[i].head<3>() += Vec3::Constant(least_coverage);
            if (pixel.noisy != Noisy::radiance) return;
            const auto count = float(pixel.frames);
            const float mean = coverage_[i].x() / count, squares = coverage_[i].y() / count;
            const float variance = count > 1 ? std::max(0.0f, squares - mean * mean) / (count - 1) : squares;
            to[i] << Vec3::Constant(mean + least_coverage), variance;
        });
    });
}

void RadianceMean::write_noisy_light() {
    light_.write(light_.whole());
    const auto to = light_.pixels<Vec4>();
    parallel_for(tiles_.count(), 64, [&](size_t tile) {
        const native::NoisyTile* noisy = noisy_.of(tile);
        each(tiles_.area_of(tile), [&](size_t i, int x, int y) {
            to[i].setZero();
            const size_t place = TileGrid::place_of(x, y);
            if (!noisy || noisy->frames[place] == 0) return;
            const NoisyPixel pixel = noisy_pixel_at(*noisy, place);
            to[i].head<3>() = pixel.light / float(pixel.frames);
            to[i].w() = variance_of(pixel);
        });
    });
}

const Target* RadianceMean::overlay_mean() {
    if (overlay_sum_.empty()) return nullptr;
    const Vec2i size = tiles_.size();
    if (overlay_mean_.size() != size) overlay_mean_ = Target(gl::Format::rgba16f, size);
    overlay_mean_.write(overlay_mean_.whole());
    const auto to = overlay_mean_.pixels<Eigen::Vector4<Eigen::half>>();
    const float scale = 1 / float(frames_);
    parallel_for(to.size(), size_t(1) << 14,
                 [&](size_t i) { to[i] = (overlay_sum_[i] * scale).cast<Eigen::half>(); });
    return &overlay_mean_;
}

}  // namespace easypbr::render
