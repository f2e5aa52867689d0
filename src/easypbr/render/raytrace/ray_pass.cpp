#include "easypbr/render/raytrace/ray_pass.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "easypbr/core/octahedral.h"
#include "easypbr/core/parallel.h"
#include "easypbr/render/frame/half_light.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Rays of a frame whose mean may count: the ratio of few is not the ratio of many.
constexpr int least_rays = 4;
/// Rays that a frame sends into the mirrored lobe at least and at most.
constexpr int most_mirrored = 4;

using Half4 = std::array<Eigen::half, 4>;

Half4 half4(const Vec3& rgb, float a) {
    const auto half = [](float v) { return Eigen::half(std::clamp(v, 0.0f, 65504.0f)); };
    return {half(rgb.x()), half(rgb.y()), half(rgb.z()), half(a)};
}

/// Of what a material's own occlusion says and what rays find the darker counts: the factor that is left.
float recesses(float visibility, uint8_t material) {
    const float own = float(material) / 255;
    return own < visibility ? own / visibility : 1.0f;
}

bool is_lit(uint8_t kind) {
    return kind < uint8_t(SurfaceKind::display) || kind == uint8_t(SurfaceKind::ground_catcher);
}

}  // namespace

/// A rectangle of the G-buffer in host memory, and what becomes of it.
struct RayPass::Pixels {
    Pixels(const Frame& frame_, const GBuffer& targets, const TracedLight& light, Transfers& transfers)
        : frame(frame_), area(frame_.covered) {
        for (const Target* target : {&targets.normal, &targets.material, &targets.depth})
            target->download(area, transfers);
        held = targets.depth.area();
        normal = targets.normal.pixels<uint16_t>();
        material = targets.material.pixels<uint8_t>();
        depth = targets.depth.pixels<float>();
        const auto begin = [&](const Target& target, const Half4& nothing) {
            target.write(area);
            std::ranges::fill(target.pixels<Half4>(), nothing);
            return target.pixels<Half4>();
        };
        sky_visibility = begin(light.sky_visibility, half4(Vec3::Ones(), 1));
        indirect_diffuse = begin(light.indirect_diffuse, half4(Vec3::Zero(), 0));
        indirect_specular = begin(light.indirect_specular, half4(Vec3::Zero(), 0));
        world_from_view = frame.camera.T_world_cam.linear();
    }

    /// Of a pixel of the G-buffer in what it holds in host memory; nothing beyond.
    std::optional<size_t> source(int x, int y) const {
        if (x < held.x || y < held.y || x >= held.x + held.width || y >= held.y + held.height)
            return std::nullopt;
        return size_t(y - held.y) * size_t(held.width) + size_t(x - held.x);
    }
    size_t index(int x, int y) const { return size_t(y - area.y) * size_t(area.width) + size_t(x - area.x); }

    const Frame& frame;
    PixelRect area;  ///< that is traced
    PixelRect held;  ///< of the G-buffer, in host memory
    std::span<const uint16_t> normal;
    std::span<const uint8_t> material;
    std::span<const float> depth;
    std::span<Half4> sky_visibility, indirect_diffuse, indirect_specular;
    Mat3d world_from_view;
};

void RayPass::make_targets(Vec2i size) {
    if (light_.sky_visibility.size() == size) return;
    for (Target* target : {&light_.sky_visibility, &light_.indirect_diffuse, &light_.indirect_specular})
        *target = Target(gl::Format::rgba16f, size);
}

namespace {

/// A surface that is seen, in RayScene's frame.
struct Seen {
    Vec3 from, normal, face, view;
    float alpha = 1;
};

struct Sent {
    Vec3 sky_visibility{1, 1, 1}, indirect_diffuse{0, 0, 0}, indirect_specular{0, 0, 0};
    float covered = 0;     ///< of the reflection
    float visibility = 1;  ///< of all around
};

/// Below this cosine to the face a direction is taken to lie in the surface.
constexpr float grazing = 1e-3f;

/// The sky's light that arrives and that of other surfaces: rays are distributed by the cosine, and those of
/// a part by the sky (Veach and Guibas 1995, balance heuristic). What arrives is a part of what the same rays
/// would bring from an open sky, so that where nothing is in the way there is no noise.
void send_diffuse(const Seen& seen, const RayScene& scene, const RayLight& rays, Vec2d pixel, int first,
                  int count, Sent& sent) {
    const RayFrame frame(seen.normal);
    Vec3 all = Vec3::Zero(), arrives = Vec3::Zero(), bounced = Vec3::Zero();
    float open = 0, around = 0;
    const float bright = rays.bright_part();
    int used = 0;
    for (int i = first; i < first + count; ++i) {
        const Vec2 u = pixel_point(pixel.x(), pixel.y(), i);
        const Vec3 direction = pixel_choice(pixel.x(), pixel.y(), i) < bright ? rays.bright_direction(u)
                                                                              : cosine_direction(frame, u);
        const float cosine = direction.dot(seen.normal);
        // What lies under the face of an interpolated normal says nothing about the sky.
        if (cosine > 0 && direction.dot(seen.face) < grazing) continue;
        ++used;
        if (cosine <= 0) continue;
        const float even = cosine / float(pi);
        const float weight = even / ((1 - bright) * even + bright * rays.bright_density(direction));
        const Vec3 sky = weight * rays.sky(direction).cwiseMax(1e-20f);
        all += sky;
        around += weight;
        if (const auto hit = scene.trace(seen.from, direction)) {
            RayRandom random(uint32_t(pixel.x()), uint32_t(pixel.y()), uint32_t(i), 0);
            bounced += weight * rays.radiance(*hit, direction, true, random);
        } else {
            arrives += sky;
            open += weight;
        }
    }
    if (!(around > 0)) return;
    sent.sky_visibility = arrives.cwiseQuotient(all);
    sent.indirect_diffuse = bounced / float(used);
    sent.visibility = open / around;
}

/// What other surfaces fill of the specular lobe.
void send_mirrored(const Seen& seen, const RayScene& scene, const RayLight& rays, Vec2d pixel, int first,
                   int count, Sent& sent) {
    const RayFrame frame(seen.normal);
    int used = 0;
    for (int i = first; i < first + count; ++i) {
        const Vec2 u = pixel_point(pixel.x() + 113, pixel.y() + 71, i);
        const Vec3 direction = mirrored_direction(frame, seen.view, seen.alpha, u).normalized();
        if (direction.dot(seen.face) < grazing || direction.dot(seen.normal) <= 0) continue;
        ++used;
        const auto hit = scene.trace(seen.from, direction);
        if (!hit) continue;
        sent.covered += 1;
        RayRandom random(uint32_t(pixel.x()), uint32_t(pixel.y()), uint32_t(i), 1);
        sent.indirect_specular += rays.radiance(*hit, direction, false, random);
    }
    if (used == 0) return;
    sent.covered /= float(used);
    sent.indirect_specular /= float(used);
}

}  // namespace

void RayPass::draw(const Frame& frame, const GBuffer& targets, const RayScene& scene, Transfers& transfers) {
    make_targets(frame.size);
    if (frame.covered.width <= 0 || frame.covered.height <= 0) return;
    Pixels pixels(frame, targets, light_, transfers);
    if (scene.empty()) return;
    rays_.prepare(*frame.resolved, scene);
    const int wanted = frame.resolved->settings.rays.count;
    const int diffuse = std::max(least_rays, (wanted + frame.sample_count - 1) / frame.sample_count),
              mirrored = std::clamp(diffuse / 4, 1, most_mirrored);
    const Vec3d eye = frame.camera.position() - scene.centre();
    // At a distance of 1; of an orthographic camera at any.
    const double pixel_width = 2.0 / frame.size.x() / frame.clip_from_view(0, 0) / scene.unit();
    // Layers of transparent surfaces come and go from frame to frame.
    const bool keeps = !targets.from_behind;
    if (keeps && (frame.sample_index == 0 || visible_.size() != size_t(frame.size.prod())))
        visible_.assign(size_t(frame.size.prod()), 0);
    const auto mean_visibility = [&](int x, int y, float visibility) {
        if (!keeps) return visibility;
        float& sum = visible_[size_t(y) * size_t(frame.size.x()) + size_t(x)];
        sum += visibility;
        return sum / float(frame.sample_index + 1);
    };
    const float inverse_scale = 1 / half_light_scale(frame.resolved->exposure);
    const auto send = [&](int x, int y) {
        const std::optional<size_t> seen_at = pixels.source(x, y);
        if (!seen_at || pixels.depth[*seen_at] <= 0) return;
        const size_t from = *seen_at, at = pixels.index(x, y);
        const uint8_t* material = &pixels.material[from * 4];
        if (!is_lit(material[3])) return;
        const Vec3d position = view_position(frame, {x, y}, pixels.depth[from]);
        const Vec3d towards = frame.orthographic() ? Vec3d(0, 0, 1) : Vec3d(-position.normalized());
        Seen seen;
        seen.normal =
            oct_decode(Vec2(pixels.normal[from * 2], pixels.normal[from * 2 + 1]) / 32767.5f - Vec2(1, 1));
        seen.view = (pixels.world_from_view * towards).cast<float>();
        const Vec3 place = ((pixels.world_from_view * position + eye) / scene.unit()).cast<float>();
        const double footprint = pixel_width * (frame.orthographic() ? 1 : -position.z());
        const RayScene::Seen found = scene.seen_at({place, seen.normal, seen.view, float(footprint)});
        seen.normal = found.normal;
        seen.face = found.face;
        seen.from = RayScene::off_surface(found.position, seen.face, seen.face * found.reach);
        const float roughness = float(material[1]) / 255;
        seen.alpha = roughness * roughness;
        const Vec2d pixel = (frame.origin + Vec2i(x, y)).cast<double>();
        Sent sent;
        send_diffuse(seen, scene, rays_, pixel, frame.sample_index * diffuse, diffuse, sent);
        if (material[3] != uint8_t(SurfaceKind::ground_catcher))
            send_mirrored(seen, scene, rays_, pixel, frame.sample_index * mirrored, mirrored, sent);
        pixels.sky_visibility[at] =
            half4(sent.sky_visibility, recesses(mean_visibility(x, y, sent.visibility), material[2]));
        pixels.indirect_diffuse[at] = half4(sent.indirect_diffuse * inverse_scale, 0);
        pixels.indirect_specular[at] = half4(sent.indirect_specular * inverse_scale, sent.covered);
    };
    const PixelRect& area = pixels.area;
    parallel_for(size_t(area.height), 4, [&](size_t row) {
        for (int x = 0; x < area.width; ++x) send(area.x + x, area.y + int(row));
    });
}

}  // namespace easypbr::render
