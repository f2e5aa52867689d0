#include "easypbr/render/primitives/surfels/software_surfels.h"

#include <array>
#include <atomic>
#include <limits>
#include <span>

#include "easypbr/core/color.h"
#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

constexpr int tile_size = 64;
constexpr size_t tile_pixels = size_t(tile_size) * tile_size;
constexpr size_t surfel_grain = 1 << 13;
/// Sums are whole multiples of this. A pixel holds 2^31 surfels of full weight before one overflows.
constexpr float quantum = 1.0f / (1 << 20);

enum Channel {
    red,
    green,
    blue,
    normal_x,
    normal_y,
    normal_z,
    metallic,
    roughness,
    distance,
    weight,
    channels
};

int64_t quantised(float value) {
    return int64_t(std::lrintf(value * (1 / quantum)));
}

/// Not cut out by its opacity.
bool is_there(const DrawItem& item, Eigen::Index i) {
    if (item.alpha != AlphaMode::mask) return true;
    const ArrayXf& C = item.mesh().C;
    const float own = item.with_colors && C.cols() == 4 ? C(i, 3) : 1.0f;
    return item.material.opacity * own >= item.material.alpha_cutoff;
}

/// First and one past the last pixel of a row or column whose centres lie in [low, high].
std::pair<int, int> pixels_between(float low, float high, int begin, int end) {
    return {std::max(begin, int(std::ceil(low - 0.5f))), std::min(end, int(std::floor(high - 0.5f)) + 1)};
}

float reversed_depth(const Frame& frame, float z) {
    const float near = float(frame.camera.near), far = float(frame.camera.far);
    return frame.orthographic() ? (far - z) / (far - near) : near / z;
}

float axial_distance(const Frame& frame, float depth) {
    if (depth <= 0) return std::numeric_limits<float>::infinity();
    const float near = float(frame.camera.near), far = float(frame.camera.far);
    return frame.orthographic() ? far + (near - far) * depth : near / depth;
}

}  // namespace

/// Sums and limits of a tile's pixels.
struct SoftwareSurfels::Tile {
    std::array<float, tile_pixels> limit;   ///< nearest distance pushed back
    std::array<float, tile_pixels> opaque;  ///< distance of what hides surfels
    std::array<uint64_t, tile_pixels> nearest;
    std::array<std::array<int64_t, channels>, tile_pixels> sums;
};

void SoftwareSurfels::bin(const std::vector<Source>& sources, Vec2i tiles) {
    const size_t tile_count = size_t(tiles.x()) * size_t(tiles.y());
    const auto for_each_tile = [&](const SurfelProjection& s, auto&& body) {
        const auto [x0, x1] = pixels_between(s.x0, s.x1, 0, tiles.x() * tile_size);
        const auto [y0, y1] = pixels_between(s.y0, s.y1, 0, tiles.y() * tile_size);
        if (x0 >= x1 || y0 >= y1) return;
        for (int ty = y0 / tile_size; ty <= (y1 - 1) / tile_size; ++ty)
            for (int tx = x0 / tile_size; tx <= (x1 - 1) / tile_size; ++tx)
                body(size_t(ty) * size_t(tiles.x()) + size_t(tx));
    };
    const auto for_each_surfel = [&](auto&& body) {
        for (size_t k = 0; k < sources.size(); ++k)
            parallel_for(size_t(sources[k].item->mesh().V.rows()), surfel_grain, [&](size_t i) {
                if (!is_there(*sources[k].item, Eigen::Index(i))) return;
                if (const auto s = sources[k].projector.project(Eigen::Index(i)))
                    for_each_tile(*s, [&](size_t tile) { body(tile, uint64_t(k) << 32 | i); });
            });
    };
    std::vector<std::atomic<size_t>> counts(tile_count);
    for_each_surfel([&](size_t tile, uint64_t) { counts[tile].fetch_add(1, std::memory_order_relaxed); });
    first_.assign(tile_count + 1, 0);
    for (size_t i = 0; i < tile_count; ++i) {
        first_[i + 1] = first_[i] + counts[i];
        counts[i] = first_[i];
    }
    entries_.resize(first_.back());
    for_each_surfel([&](size_t tile, uint64_t entry) {
        entries_[counts[tile].fetch_add(1, std::memory_order_relaxed)] = entry;
    });
}

void SoftwareSurfels::draw_tile(const Frame& frame, const std::vector<Source>& sources,
                                std::span<const float> opaque, Vec2i tile, std::span<const uint64_t> surfels,
                                SurfaceWriter& writer) const {
    thread_local Tile t;
    const int left = tile.x() * tile_size, top = tile.y() * tile_size;
    const int right = std::min(left + tile_size, frame.size.x()),
              bottom = std::min(top + tile_size, frame.size.y());
    t.limit.fill(std::numeric_limits<float>::infinity());
    t.nearest.fill(std::numeric_limits<uint64_t>::max());
    for (auto& sum : t.sums) sum.fill(0);
    const auto place = [&](int x, int y) { return size_t(y - top) * tile_size + size_t(x - left); };
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x)
            t.opaque[place(x, y)] =
                axial_distance(frame, opaque[size_t(y) * size_t(frame.size.x()) + size_t(x)]);

    const auto for_each_pixel = [&](const SurfelProjection& s, auto&& body) {
        const auto [x0, x1] = pixels_between(s.x0, s.x1, left, right);
        const auto [y0, y1] = pixels_between(s.y0, s.y1, top, bottom);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const SurfelProjection::Hit hit = s.at(float(x) + 0.5f, float(y) + 0.5f);
                const size_t i = place(x, y);
                if (hit.r2 <= 1 && hit.z <= t.opaque[i]) body(i, hit);
            }
    };
    for (const uint64_t entry : surfels) {
        const auto s = sources[entry >> 32].projector.project(Eigen::Index(entry & 0xffffffffu));
        for_each_pixel(*s, [&](size_t i, const SurfelProjection::Hit& hit) {
            const float pushed = hit.z + s->band;
            if (pushed > t.limit[i] || (pushed == t.limit[i] && entry > t.nearest[i])) return;
            t.limit[i] = pushed;
            t.nearest[i] = entry;
        });
    }
    for (const uint64_t entry : surfels) {
        const Source& source = sources[entry >> 32];
        const auto row = Eigen::Index(entry & 0xffffffffu);
        const auto s = source.projector.project(row);
        const Material& m = source.item->material;
        Vec3 albedo = m.base_color;
        if (source.item->with_colors)
            albedo = albedo.cwiseProduct(linear_from_srgb(Vec3(source.item->mesh().C.row(row).head<3>())));
        const Vec3 n = source.projector.normal(row);
        for_each_pixel(*s, [&](size_t i, const SurfelProjection::Hit& hit) {
            if (hit.z > t.limit[i]) return;
            const float w = surfel_weight(hit.r2);
            // Relative to the limit: the sum of small numbers keeps the distance's precision.
            const float values[channels] = {albedo[0],  albedo[1],   albedo[2],
                                            n[0],       n[1],        n[2],
                                            m.metallic, m.roughness, (t.limit[i] - hit.z) / t.limit[i],
                                            1};
            for (size_t c = 0; c < channels; ++c) t.sums[i][c] += quantised(values[c] * w);
        });
    }
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
            const size_t i = place(x, y), to = writer.index(x, y);
            const auto& sum = t.sums[i];
            if (sum[weight] == 0) continue;
            const double scale = 1.0 / double(sum[weight]);
            const auto mean = [&](Channel c) { return float(double(sum[c]) * scale); };
            const Source& source = sources[t.nearest[i] >> 32];
            SurfacePixel pixel;
            pixel.albedo = Vec3(mean(red), mean(green), mean(blue));
            pixel.normal = Vec3(mean(normal_x), mean(normal_y), mean(normal_z)).normalized();
            pixel.metallic = mean(metallic);
            pixel.roughness = mean(roughness);
            pixel.kind = source.item->kind;
            pixel.depth = reversed_depth(frame, t.limit[i] * (1 - mean(distance)));
            pixel.object = uint32_t(source.item->object - frame.scene->objects.data());
            pixel.element = uint32_t(t.nearest[i]);
            pixel.is_point = true;
            // The mean may lie behind what hides some of the surfels.
            if (pixel.depth > writer.depth(to)) writer.put(to, pixel);
        }
}

void SoftwareSurfels::draw(const Frame& frame, const std::vector<Source>& sources,
                           std::span<const float> opaque, SurfaceWriter& writer) {
    const Vec2i tiles = (frame.size.array() + tile_size - 1) / tile_size;
    bin(sources, tiles);
    parallel_for(size_t(tiles.x()) * size_t(tiles.y()), 1, [&](size_t tile) {
        const std::span<const uint64_t> surfels(entries_.data() + first_[tile],
                                                first_[tile + 1] - first_[tile]);
        draw_tile(frame, sources, opaque, Vec2i(int(tile) % tiles.x(), int(tile) / tiles.x()), surfels,
                  writer);
    });
}

}  // namespace easypbr::render
