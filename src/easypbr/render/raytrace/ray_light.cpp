#include "easypbr/render/raytrace/ray_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/render/raytrace/ray_surface.h"
#include "easypbr/scene/light_falloff.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// What rays see of a sky: its light is summed over many of them, so that details only make noise.
constexpr int widest_sky = 128;

Vec3 fresnel(const RaySurface& s, float n_dot_v) {
    const Vec3 grazing = s.f0.cwiseMax(s.f0.isZero() ? 0.0f : 1 - s.roughness);
    return s.f0 + (grazing - s.f0) * std::pow(1 - std::clamp(n_dot_v, 0.0f, 1.0f), 5.0f);
}

RaySurface ground_surface(const RayGround& ground, float dielectric_f0) {
    RaySurface s;
    s.diffuse = ground.color;
    s.f0.setConstant(dielectric_f0);
    s.normal = ground.up.cast<float>();
    s.roughness = ground.roughness;
    return s;
}

}  // namespace

void RayLight::prepare(const ResolvedSettings& resolved, const RayScene& scene) {
    resolved_ = &resolved;
    scene_ = &scene;
    if (hash_ == resolved.environment.hash()) return;
    hash_.clear();  // until all is there: it can be interrupted
    sky_ = resolved.environment.image();
    while (sky_.width() > widest_sky) sky_ = half_size(sky_);
    find_bright_parts();
    hash_ = resolved.environment.hash();
}

void RayLight::find_bright_parts() {
    const int w = sky_.width(), h = sky_.height();
    const auto light_of = [&](int x, int y) {
        const float* p = sky_.at<float>(x, y);
        return double(p[0]) + p[1] + p[2];
    };
    // Of a pixel, as it is seen.
    const auto angle_of = [&](int y) {
        return 2 * pi / w * (std::cos(pi * y / h) - std::cos(pi * (y + 1) / h));
    };
    double all = 0, bright = 0;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) all += light_of(x, y) * angle_of(y);
    const double mean = all / (4 * pi);
    density_.assign(size_t(w) * size_t(h), 0);
    row_ends_.assign(size_t(h), 0);
    pixel_ends_.assign(density_.size(), 0);
    for (int y = 0; y < h; ++y) {
        double row = 0;
        for (int x = 0; x < w; ++x) {
            const size_t i = size_t(y) * size_t(w) + size_t(x);
            density_[i] = float(std::max(light_of(x, y) - mean, 0.0));
            row += density_[i] * angle_of(y);
            pixel_ends_[i] = float(row);
        }
        bright += row;
        row_ends_[size_t(y)] = float(bright);
        for (int x = 0; x < w && row > 0; ++x) pixel_ends_[size_t(y) * size_t(w) + size_t(x)] /= float(row);
    }
    bright_part_ = all > 0 ? float(bright / all) : 0;
    // A sky that is even but for roundings has no bright part.
    if (bright_part_ < 1e-3f) bright_part_ = 0;
    for (float& value : density_) value /= float(std::max(bright, 1e-30));
    for (float& value : row_ends_) value /= float(std::max(bright, 1e-30));
}

Vec2i RayLight::pixel_of(const Vec3& direction) const {
    const Vec2 uv = equirect_uv(resolved_->R_env_world * direction);
    const auto pixel = [](float at, int size) { return std::clamp(int(at * float(size)), 0, size - 1); };
    return {pixel(uv.x(), sky_.width()), pixel(uv.y(), sky_.height())};
}

Vec3 RayLight::sky(const Vec3& direction) const {
    const Vec2i at = pixel_of(direction);
    const float* p = sky_.at<float>(at.x(), at.y());
    return resolved_->settings.environment.intensity * Vec3(p[0], p[1], p[2]);
}

Vec3 RayLight::even_sky(const Vec3& normal) const {
    return resolved_->settings.environment.intensity *
           resolved_->environment.irradiance_over_pi(resolved_->R_env_world * normal);
}

float RayLight::bright_density(const Vec3& direction) const {
    const Vec2i at = pixel_of(direction);
    return density_[size_t(at.y()) * size_t(sky_.width()) + size_t(at.x())];
}

Vec3 RayLight::bright_direction(const Vec2& u) const {
    // The place within a step of the distribution function is that within the row or pixel.
    const auto find = [](std::span<const float> ends, float at, float& within) {
        const auto found = std::min(std::upper_bound(ends.begin(), ends.end(), at), ends.end() - 1);
        const float begin = found == ends.begin() ? 0 : *(found - 1);
        within = std::clamp((at - begin) / std::max(*found - begin, 1e-20f), 0.0f, 1.0f);
        return int(found - ends.begin());
    };
    float within_row = 0, within_pixel = 0;
    const auto w = size_t(sky_.width());
    const int y = find(row_ends_, u.y(), within_row);
    const int x = find(std::span(pixel_ends_).subspan(size_t(y) * w, w), u.x(), within_pixel);
    // Even over the sphere within a row.
    const double step = pi / sky_.height(), top = std::cos(step * y), bottom = std::cos(step * (y + 1));
    const double v = std::acos(std::clamp(top + (bottom - top) * within_row, -1.0, 1.0)) / pi;
    return resolved_->R_env_world.transpose() *
           equirect_direction((float(x) + within_pixel) / float(w), float(v));
}

Vec3 RayLight::from_lights(const Vec3& at, const Vec3& normal) const {
    Vec3 sum = Vec3::Zero();
    const auto unit = float(scene_->unit());
    for (const ResolvedLight& light : resolved_->lights) {
        const bool parallel = light.type == LightType::directional;
        const Vec3 towards =
            parallel ? Vec3(-light.direction.normalized())
                     : Vec3((light.position.cast<double>() - scene_->centre()).cast<float>() / unit - at);
        const float distance = towards.norm();
        if (!(distance > 0)) continue;
        const Vec3 l = towards / distance;
        const float cosine = normal.dot(l), world = distance * unit;
        if (cosine <= 0) continue;
        const float falls = parallel ? 1.0f : float(falloff(light, -l.cast<double>(), double(world)));
        if (falls <= 0) continue;
        const float reach = parallel ? std::numeric_limits<float>::infinity() : distance;
        if (light.casts_shadows && resolved_->settings.shadows.enabled &&
            scene_->blocked(RayScene::off_surface(at, normal, scene_->reach()), l, reach))
            continue;
        sum += light.color * (light.intensity * falls * cosine / float(pi));
    }
    return sum;
}

Vec3 RayLight::caught(const RayHit& hit, const Vec3& direction, RayRandom& random) const {
    const Vec3 up = cosine_direction(RayFrame(hit.normal), random.next().tail<2>());
    const bool open = !scene_->blocked(RayScene::off_surface(hit.position, hit.normal), up,
                                       std::numeric_limits<float>::infinity());
    return open ? sky(direction) : Vec3(Vec3::Zero());
}

Vec3 RayLight::radiance(const RayHit& first, const Vec3& along, bool scattered, RayRandom& random) const {
    Vec3 sum = Vec3::Zero(), weight = Vec3::Ones(), direction = along;
    RayHit hit = first;
    for (int bounce = 0; bounce < bounces; ++bounce) {
        if (!hit.item && scene_->ground()->shadow_catcher)
            return sum + weight.cwiseProduct(caught(hit, direction, random));
        const float dielectric = resolved_->settings.shading.dielectric_f0;
        const RaySurface s =
            hit.item ? surface_at(hit, dielectric) : ground_surface(*scene_->ground(), dielectric);
        const Vec3 reflects = fresnel(s, -direction.dot(s.normal));
        const Vec3 diffuse = s.diffuse.cwiseProduct(Vec3::Ones() - reflects);
        sum += weight.cwiseProduct(s.emission + diffuse.cwiseProduct(from_lights(hit.position, s.normal)));
        const float mirrors = reflects.mean(), scatters = diffuse.mean();
        if (!(mirrors + scatters > 0)) break;
        // One way goes on, as likely as it brings light.
        const float likely = mirrors / (mirrors + scatters);
        const RayFrame frame(s.normal);
        const Vec3 chosen = random.next();
        const Vec2 u = chosen.tail<2>();
        const bool mirrored = chosen.x() < likely;
        const Vec3 next =
            mirrored ? mirrored_direction(frame, -direction, s.roughness * s.roughness, u).normalized()
                     : cosine_direction(frame, u);
        if (next.dot(hit.normal) <= 0) break;
        weight = weight.cwiseProduct(mirrored ? Vec3(reflects / likely) : Vec3(diffuse / (1 - likely)));
        const auto found =
            scene_->trace(RayScene::off_surface(hit.position, hit.normal, scene_->reach()), next);
        // What is seen past a matt surface is blurred, so that few paths do: the sky's mean around a
        // direction.
        const bool blurred = scattered || !mirrored;
        if (!found)
            return sum + weight.cwiseProduct(blurred ? even_sky(mirrored ? next : s.normal) : sky(next));
        scattered = blurred;
        hit = *found;
        direction = next;
    }
    return sum;
}

}  // namespace easypbr::render
