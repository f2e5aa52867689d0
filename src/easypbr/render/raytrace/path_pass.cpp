#include "easypbr/render/raytrace/path_pass.h"

#include <algorithm>
#include <limits>

#include "easypbr/core/octahedral.h"
#include "easypbr/core/parallel.h"
#include "easypbr/render/frame/held_pixels.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Pixels whose paths are traced together.
constexpr int block_width = 64, block_height = 16;

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

}  // namespace

float PathPass::Caught::add(const CaughtLight& light) {
    const double before = frames * ratio();
    sum.arrives += light.arrives;
    sum.all += light.all;
    ++frames;
    return float(frames * ratio() - before);
}

/// Places that a frame's pixels show, in RayScene's frame: view_position() with what pixels share taken out.
class PathPass::CameraRays {
  public:
    CameraRays(const Frame& frame, const RayScene& scene)
        : orthographic_(frame.orthographic()), near_(frame.camera.near), far_(frame.camera.far) {
        const Mat4d& p = frame.clip_from_view;
        const Vec2d step(2.0 / frame.size.x(), -2.0 / frame.size.y()),
            shift = orthographic_ ? Vec2d(-p(0, 3), -p(1, 3)) : Vec2d(p(0, 2), p(1, 2));
        const Mat3d unit_from_view = frame.camera.T_world_cam.linear() / scene.unit();
        column_ = unit_from_view.col(0) * (step.x() / p(0, 0));
        row_ = unit_from_view.col(1) * (step.y() / p(1, 1));
        first_ = unit_from_view.col(0) * ((step.x() / 2 - 1 + shift.x()) / p(0, 0)) +
                 unit_from_view.col(1) * ((step.y() / 2 + 1 + shift.y()) / p(1, 1));
        back_ = unit_from_view.col(2);
        towards_ = frame.camera.T_world_cam.linear().col(2).cast<float>();
        eye_ = (frame.camera.position() - scene.centre()) / scene.unit();
        width_ = step.x() / p(0, 0) / scene.unit();
    }

    /// But for its normal; `depth` is that of the G-buffer, above 0.
    RayScene::Place place_at(int x, int y, double depth) const {
        const Vec3d across = first_ + x * column_ + y * row_;
        const double z = orthographic_ ? far_ + (near_ - far_) * depth : near_ / depth;
        const Vec3d away = orthographic_ ? Vec3d(across - z * back_) : Vec3d(z * (across - back_));
        RayScene::Place place;
        place.position = (away + eye_).cast<float>();
        place.view = orthographic_ ? towards_ : Vec3(-away.cast<float>().normalized());
        place.footprint = float(orthographic_ ? width_ : z * width_);
        return place;
    }

  private:
    bool orthographic_;
    double near_, far_, width_;  ///< of a pixel, in perspective at a distance of 1 along the axis
    Vec3d first_, column_, row_, back_, eye_;
    Vec3 towards_;
};

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
          rays(frame, scene) {}

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
    /// A pixel's surface as the G-buffer has it.
    RayScene::Place place_of(int x, int y) const {
        RayScene::Place place = rays.place_at(x, y, *depth.at(x, y));
        place.normal = normal_at(x, y);
        return place;
    }
    /// Of a pixel's path; `index` is that of its radiance.
    PathState state_of(int x, int y, uint32_t index) const;
    /// Adds the path of a pixel to a batch, at what rays find there.
    void add(int x, int y, const PathState& state, const Vec3& view, const RayScene::Seen& at,
             PathBatch& batch) const;
    Vec3 normal_at(int x, int y) const;

    const Frame& frame;
    const RayScene& scene;
    const Starts starts;
    HeldPixels<std::array<uint16_t, 4>> albedo;
    HeldPixels<std::array<uint16_t, 2>> normal;
    HeldPixels<std::array<uint8_t, 4>> material;
    HeldPixels<float> depth;
    HeldPixels<Vec4> emission, radiance;
    HeldPixels<float> caught;  ///< of a shadow catcher
    const CameraRays rays;
};

PathState PathPass::Pixels::state_of(int x, int y, uint32_t index) const {
    const Vec2i pixel = frame.origin + Vec2i(x, y);
    PathState state;
    state.sampler = PathSampler(uint32_t(pixel.x()), uint32_t(pixel.y()), uint32_t(frame.sample_index),
                                uint32_t(frame.sample_count));
    state.index = index;
    return state;
}

Vec3 PathPass::Pixels::normal_at(int x, int y) const {
    const std::array<uint16_t, 2>& n = *normal.at(x, y);
    return oct_decode(Vec2(n[0], n[1]) / 32767.5f - Vec2(1, 1));
}

void PathPass::Pixels::add(int x, int y, const PathState& state, const Vec3& view, const RayScene::Seen& at,
                           PathBatch& batch) const {
    const std::array<uint8_t, 4>& m = *material.at(x, y);
    const std::array<uint16_t, 4>& color = *albedo.at(x, y);
    const size_t i = batch.count++;
    batch.position.set(i, at.position);
    batch.normal.set(i, at.normal);
    batch.face.set(i, at.face);
    batch.view.set(i, view);
    batch.albedo.set(i, Vec3(color[0], color[1], color[2]) / 65535.0f);
    batch.parameters.set(i, Vec2(m[0], m[1]) / 255.0f);
    batch.set_state(i, state);
}

/// Pixels whose paths start at the same kind of surface.
struct PathPass::Block {
    struct Pixel {
        int x = 0, y = 0;
        uint32_t index = 0;  ///< in the block
    };

    void add(int x, int y, uint32_t index, const RayScene::Place& place) {
        pixels.push_back({x, y, index});
        places.push_back(place);
    }
    /// The paths of all, at what rays find in their places.
    PathBatch batch(const Pixels& of, std::span<const RayScene::Seen> seen) const {
        PathBatch batch(pixels.size());
        for (size_t i = 0; i < pixels.size(); ++i) {
            const auto [x, y, index] = pixels[i];
            of.add(x, y, of.state_of(x, y, index), places[i].view, seen[i], batch);
        }
        return batch;
    }

    std::vector<Pixel> pixels;
    std::vector<RayScene::Place> places;
};

PathPass::Caught& PathPass::caught_at(int x, int y) {
    return caught_.make(caught_.grid().tile_at(x, y))[TileGrid::place_of(x, y)];
}

void PathPass::trace_block(const Pixels& pixels, const PixelRect& block) {
    const auto count = size_t(block.width) * size_t(block.height);
    Block lit, caught;
    lit.pixels.reserve(count);
    lit.places.reserve(count);
    std::vector<PathTracer::Hit> hits;  // of surfaces that the G-buffer does not hold all of
    hits.reserve(count);
    std::vector<bool> is_hit(count, false);
    const auto each = [&](auto&& visit) {
        for (int y = block.y; y < block.y + block.height; ++y)
            for (int x = block.x; x < block.x + block.width; ++x)
                if (pixels.is_traced(x, y))
                    visit(x, y, uint32_t((y - block.y) * block.width + x - block.x),
                          (*pixels.material.at(x, y))[3]);
    };
    each([&](int x, int y, uint32_t index, uint8_t kind) {
        const bool catches = is_catcher(kind);
        if (!catches && !is_lit_by_scene(kind)) return;
        if (catches && !(pixels.starts.caught && caught_at(x, y).is_due(pixels.turn_of(x, y)))) return;
        const RayScene::Place place = pixels.place_of(x, y);
        if (kind == uint8_t(SurfaceKind::extended)) {
            if (const auto hit =
                    pixels.scene.hit_at(place.position, place.view, place.footprint, pixels.starts.seen)) {
                const float width = place.footprint * float(pixels.scene.unit());
                hits.push_back(
                    PathTracer::camera_hit(pixels.state_of(x, y, index), *hit, -place.view, width));
                is_hit[index] = true;
                return;
            }
        }
        (catches ? caught : lit).add(x, y, index, place);
    });
    PathRadiance radiance(count);
    PathBatch batch = lit.batch(pixels, pixels.scene.seen_at(lit.places, pixels.starts.seen));
    tracer_.trace(batch, hits, radiance);
    const std::vector<CaughtLight> light = light_of(pixels, caught, count);
    fireflies_.take(block, radiance);
    each([&](int x, int y, uint32_t index, uint8_t kind) {
        Vec4* to = pixels.radiance.at(x, y);
        if (!to) return;
        const Vec4* emission = is_hit[index] ? nullptr : pixels.emission.at(x, y);
        to->head<3>() = radiance.within[index] + (emission ? Vec3(emission->head<3>()) : Vec3(Vec3::Zero()));
        to->w() = 1;
        if (pixels.starts.caught && is_catcher(kind))
            *pixels.caught.at(x, y) = caught_at(x, y).add(light[index]);
    });
}

std::vector<CaughtLight> PathPass::light_of(const Pixels& pixels, const Block& caught, size_t count) {
    std::vector<CaughtLight> light(count);
    if (caught.pixels.empty()) return light;
    std::vector<RayScene::Seen> seen;
    for (size_t i = 0; i < caught.pixels.size(); ++i) {
        const RayScene::Place& place = caught.places[i];
        const auto [x, y, index] = caught.pixels[i];
        caught_at(x, y).period = catcher_period(tracer_.catcher().distance_of(place.position));
        seen.push_back({place.position, place.normal, place.normal});
    }
    PathBatch batch = caught.batch(pixels, seen);
    tracer_.catcher().add_samples(batch, light);
    return light;
}

void PathPass::spread_fireflies(const Pixels& pixels) {
    const auto reflectance = [&](int x, int y) {
        if (!pixels.is_traced(x, y)) return Vec3(Vec3::Zero());
        const auto [metallic, roughness, unused, kind] = *pixels.material.at(x, y);
        if (!is_lit_by_scene(kind) || is_catcher(kind)) return Vec3(Vec3::Zero());
        // Smooth metals scatter little of it widely.
        const float part = 1 - float(metallic) / 255 * (1 - float(roughness) / 255);
        const std::array<uint16_t, 4>& color = *pixels.albedo.at(x, y);
        return Vec3((Vec3(color[0], color[1], color[2]) * (part / 65535)).cwiseMax(black_reflectance));
    };
    fireflies_.spread(reflectance, [&](int x, int y, const Vec3& light) {
        if (Vec4* to = pixels.radiance.at(x, y)) to->head<3>() += light;
    });
}

void PathPass::draw(const Frame& frame, const GBuffer& targets, const RayScene& scene, const Target* caught,
                    const SampledTiles* tiles, Transfers& transfers) {
    if (caught && (frame.sample_index == 0 || caught_.grid().size() != frame.size)) caught_.begin(frame.size);
    if (!caught) caught_.release();
    if (caught) {
        caught->write(frame.whole());
        std::ranges::fill(caught->pixels<float>(), 1.0f);
    }
    tracer_.prepare(*frame.resolved, scene, most_light(*frame.resolved));
    if (frame.sample_index == 0) fireflies_.begin_picture();
    const bool has_blended = frame.resolved->settings.transparency.mode == TransparencyMode::stochastic;
    const Transmissive seen = has_blended ? Transmissive::met : Transmissive::opaque;
    trace(frame, targets, scene, {tiles, seen, caught}, transfers);
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
    parallel_for(radiance.size(), 1 << 14, [&](size_t i) { radiance[i] = Vec4::Zero(); });
    const Pixels pixels(frame, targets, emission, scene, starts);
    const PixelRect& area = frame.covered;
    // Blocks hold whole tiles, and whole cells.
    constexpr int side = SampledTiles::side;
    static_assert(side % FireflyFilter::cell == 0);
    const int left = area.x / side * side, top = area.y / side * side;
    const int right = area.x + area.width, bottom = area.y + area.height;
    const int columns = (right - left + block_width - 1) / block_width,
              rows = (bottom - top + block_height - 1) / block_height;
    fireflies_.begin_frame(frame.size, most_spread(frame));
    parallel_for(size_t(std::max(0, columns * rows)), 1, [&](size_t i) {
        const int x = left + int(i) % columns * block_width, y = top + int(i) / columns * block_height;
        trace_block(pixels, {x, y, std::min(block_width, right - x), std::min(block_height, bottom - y)});
    });
    spread_fireflies(pixels);
}

}  // namespace easypbr::render
