#include "easypbr/render/raytrace/path_pass.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "easypbr/core/parallel.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/frame/held_pixels.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Pixels whose paths are traced together. Small pictures have lower blocks, for many threads to share.
constexpr int block_width = 64, block_height = 64, low_block_height = 16;
constexpr int small_picture = 512 * 512;
static_assert(block_height % SampledTiles::side == 0 && low_block_height % SampledTiles::side == 0);

bool is_catcher(uint8_t kind) {
    return kind == uint8_t(SurfaceKind::ground_catcher);
}

/// Every how many frames a place of a shadow catcher gets samples, by its distance from the middle of the
/// casters in radii: far away they remove little light. By the place alone, so that the ratio stays
/// consistent.
uint32_t catcher_period(float distance) {
    return distance < 2.2f ? 1 : distance < 4 ? 2 : 4;
}

/// So much of the light that is spread goes to black surfaces too, which reflect light in other ways.
constexpr float black_reflectance = 0.05f;

/// Luminance of a path's light that stays at its pixel, however rare such paths are.
float most_light(const ResolvedSettings& resolved) {
    const float clamp = resolved.settings.path.clamp;
    return clamp > 0 ? clamp / resolved.exposure : std::numeric_limits<float>::infinity();
}

/// Luminance of a path's light that is spread: about a hundred pixels get it, and in the mean of all frames
/// so far it is a twentieth of the limit to each of them at most.
float most_spread(const Frame& frame) {
    constexpr float pixels = 100, visible = 0.05f;
    return most_light(*frame.resolved) * pixels * visible * float(frame.sample_index + 1);
}

/// Writes one value to all channels of a target of floats.
void fill_frame(const Frame& frame, const Target& target, float value) {
    target.write(frame.whole());
    std::ranges::fill(target.pixels<float>(), value);
}

}  // namespace

float PathPass::Caught::add(const CaughtLight& light) {
    if (light.all == 0 && light.arrives == 0) {
        ++frames;
        return float(ratio());
    }
    const double before = frames * ratio();
    sum.arrives += light.arrives;
    sum.all += light.all;
    ++frames;
    return float(frames * ratio() - before);
}

namespace {

/// Places are in RayScene's frame: view_position() with what pixels share taken out.
native::CameraRays camera_rays(const Frame& frame, const RayScene& scene) {
    native::CameraRays rays;
    rays.orthographic = frame.orthographic();
    rays.near = frame.camera.near;
    rays.far = frame.camera.far;
    const Mat4d& p = frame.clip_from_view;
    const Vec2d step(2.0 / frame.size.x(), -2.0 / frame.size.y()),
        shift = rays.orthographic ? Vec2d(-p(0, 3), -p(1, 3)) : Vec2d(p(0, 2), p(1, 2));
    const Mat3d unit_from_view = frame.camera.T_world_cam.linear() / scene.unit();
    const auto set = [](double(&to)[3], const Vec3d& v) { std::copy_n(v.data(), 3, to); };
    set(rays.column, unit_from_view.col(0) * (step.x() / p(0, 0)));
    set(rays.row, unit_from_view.col(1) * (step.y() / p(1, 1)));
    set(rays.first, unit_from_view.col(0) * ((step.x() / 2 - 1 + shift.x()) / p(0, 0)) +
                        unit_from_view.col(1) * ((step.y() / 2 + 1 + shift.y()) / p(1, 1)));
    set(rays.back, unit_from_view.col(2));
    set(rays.eye, (frame.camera.position() - scene.centre()) / scene.unit());
    const Vec3 towards = frame.camera.T_world_cam.linear().col(2).cast<float>();
    std::copy_n(towards.data(), 3, rays.towards);
    rays.width = step.x() / p(0, 0) / scene.unit();
    return rays;
}

}  // namespace

/// The targets in host memory, and how pixels become places.
struct PathPass::Pixels {
    Pixels(const Frame& frame_, const GBuffer& targets, const Target& emission_, const RayScene& scene_,
           const Starts& starts_)
        : frame(frame_),
          scene(scene_),
          starts(starts_),
          albedo(targets.albedo),
          normal(targets.normal),
          material(targets.material),
          depth(targets.depth),
          emission(emission_),
          radiance(targets.radiance),
          caught(starts.caught ? *starts.caught : targets.depth),
          rays(camera_rays(frame, scene)) {
        const PathSampler::Order order(uint32_t(frame.sample_count));
        for (int x = 0; x < frame.size.x(); ++x)
            columns.push_back(order.column(uint32_t(frame.origin.x() + x)));
        for (int y = 0; y < frame.size.y(); ++y) rows.push_back(order.row(uint32_t(frame.origin.y() + y)));
    }

    /// Neighbours take turns, by their place in the whole image.
    int turn_of(int x, int y) const {
        const Vec2i pixel = frame.origin + Vec2i(x, y);
        return frame.sample_index + pixel.x() + 2 * pixel.y();
    }
    /// Whether a surface is there that gets a sample.
    bool is_traced(int x, int y) const {
        const float* d = depth.at(x, y);
        return d && *d > 0 && !(starts.tiles && starts.tiles->has_ended(starts.tiles->tile_at(x, y)));
    }
    /// Of a pixel's path; `index` is that of its radiance.
    PathState state_of(int x, int y, uint32_t index) const {
        PathState state;
        state.sampler = PathSampler(columns[size_t(x)], rows[size_t(y)], uint32_t(frame.sample_index));
        state.index = index;
        return state;
    }

    const Frame& frame;
    const RayScene& scene;
    const Starts starts;
    HeldPixels<std::array<uint16_t, 4>> albedo;
    HeldPixels<uint32_t> normal;
    HeldPixels<std::array<uint8_t, 4>> material;
    HeldPixels<float> depth;
    HeldPixels<Vec4> emission, radiance;
    HeldPixels<float> caught;  ///< of a shadow catcher
    const native::CameraRays rays;
    std::vector<PathSampler::Axis> columns, rows;
};

/// Pixels whose paths start at the same kind of surface, and what the G-buffer holds there.
struct PathPass::Block {
    static constexpr size_t room = size_t(block_width) * block_height + native::stream_alignment;

    void add(const Pixels& pixels, int x_, int y_, uint32_t index_) {
        const size_t i = count++;
        x[i] = x_;
        y[i] = y_;
        index[i] = index_;
        depth[i] = *pixels.depth.at(x_, y_);
        normal[i] = *pixels.normal.at(x_, y_);
        material[i] = std::bit_cast<uint32_t>(*pixels.material.at(x_, y_));
        const std::array<uint16_t, 4>& color = *pixels.albedo.at(x_, y_);
        red_green[i] = uint32_t(color[0]) | uint32_t(color[1]) << 16;
        blue[i] = color[2];
    }
    void add(const Block& from, size_t i) {
        for (auto numbers :
             {&Block::normal, &Block::material, &Block::red_green, &Block::blue, &Block::index})
            (this->*numbers)[count] = (from.*numbers)[i];
        x[count] = from.x[i];
        y[count] = from.y[i];
        depth[count++] = from.depth[i];
    }
    /// Finds the places of all, and their surfaces for a batch. Behind the last place the arrays repeat it.
    void find(const Pixels& pixels, RayScene::Places& places, PathBatch& batch) {
        places.count = batch.count = count;
        if (count == 0) return;
        const size_t last = count - 1;
        while (count < whole_streams(last + 1)) add(*this, last);
        count = last + 1;
        native::CameraPlaces to;
        places.position.written_by(to.position);
        places.view.written_by(to.view);
        places.normal.written_by(to.normal);
        to.footprint = places.footprint.data();
        batch.albedo.written_by(to.albedo);
        batch.parameters.written_by(to.parameters);
        native::find_places(
            pixels.rays,
            {x.data(), y.data(), depth.data(), normal.data(), material.data(), red_green.data(), blue.data()},
            int(count), to);
    }
    /// Starts the paths of a batch at what is seen.
    void start(const Pixels& pixels, RayScene::Places& seen, PathBatch& batch) const {
        batch.position = std::move(seen.position);
        batch.normal = std::move(seen.normal);
        batch.face = std::move(seen.face);
        batch.view = std::move(seen.view);
        batch.reach = std::move(seen.reach);
        batch.on = std::move(seen.on);
        for (size_t i = 0; i < count; ++i) batch.set_state(i, pixels.state_of(x[i], y[i], index[i]));
    }

    size_t count = 0;
    std::array<int32_t, room> x, y;
    std::array<float, room> depth;
    std::array<uint32_t, room> normal, material, red_green, blue;
    std::array<uint32_t, room> index;  ///< of the pixel in the block
};

/// What shadow catchers have caught in a tile, found once it is asked for.
class PathPass::CaughtTile {
  public:
    CaughtTile(PathPass& pass, int x, int y) : pass_(pass), x_(x), y_(y) {}

    Caught& at(int x, int y) {
        TilePixels<Caught>& all = pass_.caught_;
        if (!values_) values_ = &all.make(all.grid().tile_at(x_, y_));
        return (*values_)[TileGrid::place_of(x, y)];
    }

  private:
    PathPass& pass_;
    int x_, y_;  ///< one of its pixels
    PixelsOfTile<Caught>* values_ = nullptr;
};

template <class Read, class Visit>
void PathPass::each_traced(const Pixels& pixels, const PixelRect& block, Read&& read, Visit&& visit) {
    constexpr int rows_ahead = 2;
    const int right = block.x + block.width, bottom = block.y + block.height;
    const SampledTiles* const tiles = pixels.starts.tiles;
    const auto each_of_tile = [&](int left, int top) {
        CaughtTile caught(*this, left, top);
        for (int y = top; y < std::min(top + SampledTiles::side, bottom); ++y) {
            for (const void* pixel : read(left, y + rows_ahead)) __builtin_prefetch(pixel);
            for (int x = left; x < std::min(left + SampledTiles::side, right); ++x) {
                const float* depth = pixels.depth.at(x, y);
                if (!depth || !(*depth > 0)) continue;
                const auto index = uint32_t((y - block.y) * block.width + x - block.x);
                visit(x, y, index, (*pixels.material.at(x, y))[3], caught);
            }
        }
    };
    for (int top = block.y; top < bottom; top += SampledTiles::side)
        for (int left = block.x; left < right; left += SampledTiles::side)
            if (!tiles || !tiles->has_ended(tiles->tile_at(left, top))) each_of_tile(left, top);
}

void PathPass::trace_block(const Pixels& pixels, const PixelRect& block) {
    const auto count = size_t(block.width) * size_t(block.height);
    const auto blocks = std::make_unique_for_overwrite<std::array<Block, 3>>();  // too large for stacks
    Block &lit = (*blocks)[0], &caught = (*blocks)[1], &extended = (*blocks)[2];
    const auto sort = [&](int x, int y, uint32_t index, uint8_t kind, CaughtTile& of_tile) {
        if (kind == uint8_t(SurfaceKind::extended))
            extended.add(pixels, x, y, index);
        else if (is_lit_by_scene(kind))
            lit.add(pixels, x, y, index);
        else if (is_catcher(kind) && pixels.starts.caught && of_tile.at(x, y).is_due(pixels.turn_of(x, y)))
            caught.add(pixels, x, y, index);
    };
    // What is read of a tile's row: the caches do not foresee rows that are so short.
    constexpr int half = SampledTiles::side / 2, quarter = half / 2;
    const auto surfaces = [&](int x, int y) {
        return std::array<const void*, 5>{pixels.depth.at(x, y), pixels.material.at(x, y),
                                          pixels.normal.at(x, y), pixels.albedo.at(x, y),
                                          pixels.albedo.at(x + half, y)};
    };
    each_traced(pixels, block, surfaces, sort);
    std::vector<bool> is_hit(count, false);
    std::vector<PathTracer::Hit> hits = hits_of(pixels, extended, is_hit, lit);
    PathRadiance radiance(count);
    RayScene::Places places(lit.count);
    PathBatch batch(lit.count);
    lit.find(pixels, places, batch);
    pixels.scene.see(places, pixels.starts.seen);
    lit.start(pixels, places, batch);
    tracer_.trace(batch, hits, radiance);
    const std::vector<CaughtLight> light = light_of(pixels, caught, count);
    fireflies_.take(block, radiance);
    for (int y = block.y; y < block.y + block.height; ++y)
        if (Vec4* row = pixels.radiance.at(block.x, y)) std::fill_n(row, block.width, Vec4::Zero());
    const auto write = [&](int x, int y, uint32_t index, uint8_t kind, CaughtTile& of_tile) {
        Vec4* to = pixels.radiance.at(x, y);
        if (!to) return;
        const Vec4* emission = is_hit[index] ? nullptr : pixels.emission.at(x, y);
        to->head<3>() = radiance.within[index];
        if (emission) to->head<3>() += emission->head<3>();
        to->w() = 1;
        if (pixels.starts.caught && is_catcher(kind))
            *pixels.caught.at(x, y) = of_tile.at(x, y).add(light[index]);
    };
    const auto colors = [&](int x, int y) {
        std::array<const void*, 8> read;
        for (size_t i = 0; i < 4; ++i) {
            const int column = x + int(i) * quarter;
            read[i] = pixels.radiance.at(column, y);
            read[4 + i] = pixels.emission.at(column, y);
        }
        return read;
    };
    each_traced(pixels, block, colors, write);
}

std::vector<PathTracer::Hit> PathPass::hits_of(const Pixels& pixels, Block& extended,
                                               std::vector<bool>& is_hit, Block& others) const {
    std::vector<PathTracer::Hit> hits;
    if (extended.count == 0) return hits;
    hits.reserve(extended.count);
    RayScene::Places places(extended.count);
    PathBatch surfaces(extended.count);
    extended.find(pixels, places, surfaces);
    for (size_t i = 0; i < extended.count; ++i) {
        const RayScene::Place at = places.at(i);
        const auto hit = pixels.scene.hit_at(at, pixels.starts.seen);
        if (!hit) {
            others.add(extended, i);
            continue;
        }
        const uint32_t index = extended.index[i];
        hits.push_back(PathTracer::camera_hit(pixels.state_of(extended.x[i], extended.y[i], index), *hit,
                                              -at.view, at.footprint * float(pixels.scene.unit())));
        is_hit[index] = true;
    }
    return hits;
}

std::vector<CaughtLight> PathPass::light_of(const Pixels& pixels, Block& caught, size_t count) {
    std::vector<CaughtLight> light(count);
    if (caught.count == 0) return light;
    RayScene::Places places(caught.count);
    PathBatch batch(caught.count);
    caught.find(pixels, places, batch);
    const std::vector<float> distances = tracer_.catcher().distances(places.position);
    for (size_t i = 0; i < caught.count; ++i)
        CaughtTile(*this, caught.x[i], caught.y[i]).at(caught.x[i], caught.y[i]).period =
            catcher_period(distances[i]);
    places.face = places.normal;
    caught.start(pixels, places, batch);
    tracer_.catcher().add_samples(batch, distances, 0, light);
    return light;
}

void PathPass::spread_fireflies(const Pixels& pixels) {
    const auto reflectance = [&](int y, std::span<Vec3> row) {
        for (int x = 0; x < int(row.size()); ++x) {
            Vec3& to = row[size_t(x)];
            to.setZero();
            if (!pixels.is_traced(x, y)) continue;
            const auto [metallic, roughness, unused, kind] = *pixels.material.at(x, y);
            if (!is_lit_by_scene(kind)) continue;
            // Smooth metals scatter little of it widely.
            const float part = 1 - float(metallic) / 255 * (1 - float(roughness) / 255);
            const std::array<uint16_t, 4>& color = *pixels.albedo.at(x, y);
            to = (Vec3(color[0], color[1], color[2]) * (part / 65535)).cwiseMax(black_reflectance);
        }
    };
    fireflies_.spread(reflectance, [&](int y, std::span<const Vec3> light) {
        for (int x = 0; x < int(light.size()); ++x)
            if (Vec4* to = pixels.radiance.at(x, y)) to->head<3>() += light[size_t(x)];
    });
}

void PathPass::draw(const Frame& frame, const GBuffer& targets, const RayScene& scene, const Target* caught,
                    const SampledTiles* tiles, Transfers& transfers) {
    if (caught && (frame.sample_index == 0 || caught_.grid().size() != frame.size)) caught_.begin(frame.size);
    if (!caught) caught_.release();
    if (caught) fill_frame(frame, *caught, 1.0f);
    tracer_.prepare(*frame.resolved, scene, most_light(*frame.resolved));
    if (frame.sample_index == 0) fireflies_.begin_picture();
    const bool has_blended = frame.resolved->settings.transparency.mode == TransparencyMode::stochastic;
    const Transmissive seen = has_blended ? Transmissive::met : Transmissive::opaque;
    trace(frame, targets, scene, {tiles, seen, caught}, transfers);
}

void PathPass::begin_layers(const Frame& frame, const GBuffer& targets, const RayScene& scene,
                            const Target* caught) {
    if (caught) fill_frame(frame, *caught, 1.0f);
    fill_frame(frame, targets.radiance, 0.0f);
    tracer_.prepare(*frame.resolved, scene, most_light(*frame.resolved));
}

void PathPass::draw_layer(const Frame& frame, const GBuffer& layer, const RayScene& scene,
                          const SampledTiles* tiles, Transfers& transfers) {
    trace(frame, layer, scene, {tiles, Transmissive::layers, nullptr}, transfers);
}

void PathPass::trace(const Frame& frame, const GBuffer& targets, const RayScene& scene, const Starts& starts,
                     Transfers& transfers) {
    targets.download(transfers);
    const Target nothing(gl::Format::rgba32f, frame.size);
    const Target& emission = targets.emission.is_ahead() ? targets.emission : nothing;
    targets.radiance.write(frame.whole());
    const auto radiance = targets.radiance.pixels<Vec4>();
    // Blocks write all their pixels.
    if (frame.covered.width < frame.size.x() || frame.covered.height < frame.size.y())
        parallel_for(radiance.size(), 1 << 14, [&](size_t i) { radiance[i] = Vec4::Zero(); });
    const Pixels pixels(frame, targets, emission, scene, starts);
    const PixelRect& area = frame.covered;
    // Blocks hold whole tiles, and whole cells.
    constexpr int side = SampledTiles::side;
    static_assert(side % FireflyFilter::cell == 0);
    const int left = area.x / side * side, top = area.y / side * side;
    const int right = area.x + area.width, bottom = area.y + area.height;
    const int height =
        frame.size.x() * int64_t(frame.size.y()) < small_picture ? low_block_height : block_height;
    const int columns = (right - left + block_width - 1) / block_width,
              rows = (bottom - top + height - 1) / height;
    fireflies_.begin_frame(frame.size, most_spread(frame));
    parallel_for(size_t(std::max(0, columns * rows)), 1, [&](size_t i) {
        const int x = left + int(i) % columns * block_width, y = top + int(i) / columns * height;
        trace_block(pixels, {x, y, std::min(block_width, right - x), std::min(height, bottom - y)});
    });
    spread_fireflies(pixels);
}

}  // namespace easypbr::render
