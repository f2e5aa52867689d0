#include "easypbr/render/primitives/splats/splat_primitive.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>

#include "easypbr/core/color.h"
#include "easypbr/core/parallel.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/primitives/overlay_depths.h"
#include "easypbr/render/primitives/splats/splat_depth.h"
#include "easypbr/render/primitives/splats/splat_hits.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

using OverlayPixel = Eigen::Vector4<Eigen::half>;

/// Flat splats are this thick to rays, in their longest semi-axis.
constexpr double least_thickness = 1e-3;

/// While surfaces move, the light of splats is found where they are seen, on the CPU; when they rest, that of
/// all.
constexpr int frames_before_all_sides = 16;

std::vector<const DrawItem*> chosen(DrawItems items, bool over) {
    std::vector<const DrawItem*> chosen;
    for (const DrawItem& item : items)
        if (is_over(item) == over) chosen.push_back(&item);
    return chosen;
}

std::vector<const DrawItem*> every(DrawItems items) {
    std::vector<const DrawItem*> every;
    for (const DrawItem& item : items) every.push_back(&item);
    return every;
}

Vec3d towards_camera(const Frame& frame, const DrawItem& item, Eigen::Index i) {
    if (frame.orthographic()) return frame.camera.T_world_cam.linear().col(2);
    return frame.camera.position() -
           item.object->T_world_mesh * Vec3d(item.mesh().V.row(i).transpose().cast<double>());
}

void add_color(const SplatProjector& projector, ProjectedSplat& splat) {
    projector.color(Eigen::Index(splat.index), splat);
}

/// Of a pixel's centre, in the frame of the view.
DepthRay ray_of(const Frame& frame, int x, int y) {
    const Vec3d point = view_position(frame, {x, y}, 0.5);
    if (frame.orthographic()) return {{point.x(), point.y(), 0}, -Vec3d::UnitZ()};
    return {Vec3d::Zero(), point / -point.z()};
}

/// Reversed; what the near plane cuts off is not seen, and nothing has no depth.
float depth_in_pixel(const Frame& frame, const DepthAxis& axis, const DrawItem& item, Eigen::Index vertex,
                     const DepthRay& ray) {
    const Eigen::Affine3d T_view_mesh = Eigen::Affine3d(frame.camera.view()) * item.object->T_world_mesh;
    const double z = std::max(splat_depth(item.mesh(), vertex, T_view_mesh, ray), frame.camera.near);
    return std::max(axis.depth_at(float(-z)), std::numeric_limits<float>::min());
}

/// The surface of a tile's pixel, which has one.
SurfacePixel surface_of(const Frame& frame, const SplatCompositor& compositor, const SplatTile& tile,
                        size_t in_tile, int x, int y) {
    const uint32_t place = tile.median[in_tile];
    const ProjectedSplat& splat = compositor.splat(place);
    const DrawItem& item = compositor.item_of(place);
    SurfacePixel pixel;
    pixel.albedo = linear_from_srgb(Vec3(Vec3(splat.red, splat.green, splat.blue).cwiseMin(1.0f)));
    const auto vertex = Eigen::Index(splat.index);
    pixel.normal = splat_normal(item, vertex, towards_camera(frame, item, vertex)).cast<float>();
    pixel.roughness = 1;
    pixel.kind = item.kind;
    pixel.depth = tile.sums_positions
                      ? tile.axis.depth_at(tile.positions[in_tile] / (1 - tile.through[in_tile]))
                      : depth_in_pixel(frame, tile.axis, item, vertex, ray_of(frame, x, y));
    pixel.object = uint32_t(item.object - frame.scene->objects.data());
    pixel.element = splat.index;
    pixel.is_point = true;
    return pixel;
}

/// Colours that are displayed of radiance.
class LitColors {
  public:
    explicit LitColors(size_t count) : count_(count) {
        constexpr auto step = size_t(native::stream_alignment);
        const size_t room = (count + step - 1) / step * step;
        for (int c = 0; c < 3; ++c) {
            radiance_[size_t(c)].assign(room, 0);
            color_[size_t(c)].assign(room, 0);
        }
    }
    void set_radiance(size_t i, const Vec3& radiance) {
        for (int c = 0; c < 3; ++c) radiance_[size_t(c)][i] = radiance[c];
    }
    void display(const void* uniforms) {
        native::display_color_stream stream;
        for (int c = 0; c < 3; ++c) {
            stream.v_radiance[c] = radiance_[size_t(c)].data();
            stream.o_color[c] = color_[size_t(c)].data();
        }
        native::run(uniforms, stream, int(count_));
    }
    void show(size_t i, ProjectedSplat& splat) const {
        splat.red = color_[0][i];
        splat.green = color_[1][i];
        splat.blue = color_[2][i];
    }

  private:
    size_t count_;
    std::array<std::vector<float>, 3> radiance_, color_;
};

/// Linear display light, premultiplied. Splats are blended as they are encoded, and what they are together is
/// blended with the picture as light.
Vec4 display_light(const SplatTile& tile, size_t pixel) {
    const float alpha = 1 - tile.through[pixel];
    if (alpha <= 0) return Vec4::Zero();
    const Vec3 encoded = Vec3(tile.red[pixel], tile.green[pixel], tile.blue[pixel]) / alpha;
    Vec4 light;
    light << alpha * linear_from_srgb(encoded), alpha;
    return light;
}

/// Calls body(x, y, place in the tile) for the pixels of a tile that are inside a rectangle.
template <class Body>
void for_each_pixel(const SplatTile& tile, const PixelRect& area, Body&& body) {
    const int x0 = std::max(tile.left, area.x),
              x1 = std::min(tile.left + SplatTile::size, area.x + area.width),
              y0 = std::max(tile.top, area.y),
              y1 = std::min(tile.top + SplatTile::size, area.y + area.height);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            body(x, y, size_t(y - tile.top) * SplatTile::size + size_t(x - tile.left));
}

/// Calls put(pixel, light) for those that show something; pixels count row by row in the rectangle.
template <class Put>
void for_each_light(const SplatTile& tile, const PixelRect& area, Put&& put) {
    for_each_pixel(tile, area, [&](int x, int y, size_t place) {
        const Vec4 light = display_light(tile, place);
        if (light.w() > 0) put(size_t(y - area.y) * size_t(area.width) + size_t(x - area.x), light);
    });
}

}  // namespace

void SplatPrimitive::add_mean(const Frame& frame, DrawItems items, std::span<const float> hides,
                              const SurfaceOutputs&, SurfaceWriter& writer) {
    compositor_.begin(frame, every(items),
                      [](const SplatProjector& projector, const DrawItem&, std::span<ProjectedSplat> splats) {
                          for (ProjectedSplat& splat : splats) add_color(projector, splat);
                      });
    // What is written hides nothing of what is still to be blended.
    const std::vector<float> farthest(hides.begin(), hides.end());
    const auto put = [&](const SplatTile& tile) {
        for_each_pixel(tile, frame.whole(), [&](int x, int y, size_t in_tile) {
            if (tile.median[in_tile] == SplatTile::no_splat) return;
            writer.put(writer.index(x, y), surface_of(frame, compositor_, tile, in_tile, x, y));
        });
    };
    if (frame.resolved->settings.splats.depth == SplatDepth::expected)
        compositor_.blend_with_positions({farthest, {}}, put);
    else
        compositor_.blend({farthest, {}}, put);
}

void SplatPrimitive::draw_overlay(const Frame& frame, DrawItems items, const GBuffer& targets,
                                  const OverlayStep& step) {
    using Part = OverlayStep::Part;
    if (step.part == Part::begin) return begin(frame, items, step);
    if (step.part == Part::over) return draw_over(frame, items, targets, step);
    if (by_driver_) {
        if (!step.next && step.others.empty()) {
            if (step.part == Part::behind) driver_.blend(frame, targets, opaque_);
            return;
        }
        by_driver_ = false;
        begin_natively(frame, false);
    }
    if (compositor_.empty()) return;
    step.part == Part::behind ? draw_behind(targets, step) : draw_front(targets, step);
}

void SplatPrimitive::begin(const Frame& frame, DrawItems items, const OverlayStep& step) {
    shown_ = chosen(items, false);
    opaque_ = step.opaque;
    by_driver_ = begin_by_driver(frame, shown_, step);
    if (!by_driver_) begin_natively(frame, step.host != nullptr);
}

void SplatPrimitive::begin_natively(const Frame& frame, bool in_host_memory) {
    compositor_.begin(frame, shown_, colors(frame, shown_));
    farthest_.clear();
    if (!compositor_.empty())
        farthest_ = in_host_memory ? whole_depths(*opaque_) : read_depths(opaque_->texture());
}

void SplatPrimitive::draw_over(const Frame& frame, DrawItems items, const GBuffer& targets,
                               const OverlayStep& step) {
    const std::vector<const DrawItem*> over = chosen(items, true);
    if (over.empty()) return;
    if (begin_by_driver(frame, over, step)) return driver_.blend(frame, targets, nullptr);
    compositor_.begin(frame, over, colors(frame, over));
    blend(targets, {}, step.host != nullptr);
}

bool SplatPrimitive::begin_by_driver(const Frame& frame, const std::vector<const DrawItem*>& items,
                                     const OverlayStep& step) {
    if (!step.by_gpu || step.host || items.empty() || frame.resolved->settings.splats.resort) return false;
    if (SplatLight::relights(*frame.resolved) && light_.light()) return false;
    bool is_new = false;
    for (const DrawItem* item : items)
        if (const auto parts = light_.parts_of(*item, false))
            is_new |= parts->count_frames() <= frames_before_all_sides;
    return !is_new && driver_.begin(frame, items, light_);
}

ShadowShape SplatPrimitive::shadow_shape(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    return {{mesh.V.revision(), mesh.splats.scales.revision(), mesh.splats.rotations.revision(),
             mesh.splats.opacities.revision()},
            {}};
}

SplatSet::Finish SplatPrimitive::colors(const Frame& frame, const std::vector<const DrawItem*>& items) {
    const bool are_lit = SplatLight::relights(*frame.resolved) && light_.light();
    return are_lit ? lit_colors(frame, items) : own_colors(frame, items);
}

SplatSet::Finish SplatPrimitive::lit_colors(const Frame& frame, const std::vector<const DrawItem*>& items) {
    std::map<const DrawItem*, std::shared_ptr<SplatLight::Parts>> parts;
    for (const DrawItem* item : items) parts[item] = light_.parts_of(*item, true);
    const DisplayTone tone = display_tone(*frame.resolved);
    native::Inputs inputs;
    inputs.features.push_back(tone_feature(tone.tone_operator));
    inputs.set("u_exposure", tone.exposure);
    const std::shared_ptr<const void> uniforms =
        native::stream_uniforms(native::Stream::display_color, inputs);
    return [&frame, parts, uniforms, light = light_.light()](const SplatProjector&, const DrawItem& item,
                                                             std::span<ProjectedSplat> splats) {
        SplatLight::Parts& own = *parts.at(&item);
        LitColors colors(splats.size());
        for (size_t k = 0; k < splats.size(); ++k) {
            const auto i = Eigen::Index(splats[k].index);
            colors.set_radiance(k, own.lit(*light, item, i, towards_camera(frame, item, i)));
        }
        colors.display(uniforms.get());
        for (size_t k = 0; k < splats.size(); ++k) colors.show(k, splats[k]);
    };
}

SplatSet::Finish SplatPrimitive::own_colors(const Frame& frame, const std::vector<const DrawItem*>& items) {
    std::map<const DrawItem*, std::shared_ptr<SplatLight::Parts>> parts;
    for (const DrawItem* item : items) parts[item] = light_.parts_of(*item, false);
    return [&frame, parts, light = light_.light()](const SplatProjector& projector, const DrawItem& item,
                                                   std::span<ProjectedSplat> splats) {
        SplatLight::Parts* const own = parts.at(&item).get();
        for (ProjectedSplat& splat : splats) {
            add_color(projector, splat);
            if (!own) continue;
            const auto i = Eigen::Index(splat.index);
            const Vec3 color = own->darkened(*light, item, i, towards_camera(frame, item, i),
                                             {splat.red, splat.green, splat.blue});
            splat.red = color.x();
            splat.green = color.y();
            splat.blue = color.z();
        }
    };
}

ScreenReach SplatPrimitive::screen_reach(const Frame&, const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    const double longest = longest_.get(mesh.splats.scales.revision(), [&] {
        return mesh.splats.scales.empty() ? 0.0 : double(mesh.splats.scales.maxCoeff());
    });
    // Where the opacity of an opaque splat has fallen to the least that is seen.
    const double deviations = std::sqrt(-2 * std::log(double(least_splat_alpha)));
    // A square pixel is more than the variance that all are widened by.
    return {deviations * longest * item.object->T_world_mesh.linear().operatorNorm(), deviations};
}

void SplatPrimitive::add_to(RayGeometry& geometry, const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    geometry.add_gaussians(item, [&](Eigen::Index i) {
        const auto q = mesh.splats.rotations.row(i).cast<double>();
        const Mat3d turn = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix();
        const Vec3d given = mesh.splats.scales.row(i).transpose().cast<double>(),
                    scales = given.cwiseMax(given.maxCoeff() * least_thickness);
        return RayGaussian{mesh.V.row(i).transpose().cast<double>(), turn * scales.asDiagonal(),
                           mesh.splats.opacities(i)};
    });
}

std::unique_ptr<HitSurface> SplatPrimitive::hit_surface(const ResolvedSettings& resolved,
                                                        const DrawItem& item) {
    return std::make_unique<SplatHits>(item, resolved, light_);
}

void SplatPrimitive::find_limits(const OverlayStep& step) {
    constexpr float no_limit = std::numeric_limits<float>::infinity();
    nearest_.clear();
    if (step.next)
        nearest_ = step.host ? whole_depths(step.next->depth) : read_depths(step.next->depth.texture());
    // Where the layer is not there is nothing more before the pixel.
    std::ranges::replace(nearest_, 0.0f, no_limit);
    is_split_ = false;
    split_ = nearest_;
    if (step.others.empty()) return;
    split_.resize(step.others.size(), no_limit);
    std::atomic<bool> is_split = false;
    parallel_for(split_.size(), 1 << 14, [&](size_t i) {
        const float depth = step.others[i];
        if (!(depth > farthest_[i] && depth < split_[i])) return;
        split_[i] = depth;
        if (!is_split.load(std::memory_order_relaxed)) is_split = true;
    });
    is_split_ = is_split;
}

void SplatPrimitive::draw_behind(const GBuffer& targets, const OverlayStep& step) {
    find_limits(step);
    blend(targets, {farthest_, split_}, step.host != nullptr);
}

void SplatPrimitive::draw_front(const GBuffer& targets, const OverlayStep& step) {
    if (is_split_) blend(targets, {split_, nearest_}, step.host != nullptr);
    // Where the layer is, the splats behind it have been drawn.
    parallel_for(nearest_.size(), 1 << 16,
                 [&](size_t i) { farthest_[i] = std::max(farthest_[i], nearest_[i]); });
}

void SplatPrimitive::blend(const GBuffer& targets, const Limits& limits, bool in_host_memory) {
    in_host_memory ? shade(targets, limits) : add(targets, limits);
}

void SplatPrimitive::shade(const GBuffer& targets, const Limits& limits) {
    const std::span<OverlayPixel> overlay = targets.overlay.pixels<OverlayPixel>();
    const PixelRect area = targets.overlay.area();
    compositor_.blend(limits, [&](const SplatTile& tile) {
        for_each_light(tile, area, [&](size_t pixel, const Vec4& light) {
            const Vec4 behind = overlay[pixel].cast<float>();
            overlay[pixel] = Vec4(light + (1 - light.w()) * behind).cast<Eigen::half>();
        });
    });
}

void SplatPrimitive::add(const GBuffer& targets, const Limits& limits) {
    if (compositor_.empty()) return;
    if (picture_.size() != compositor_.size()) picture_ = Target(gl::Format::rgba16f, compositor_.size());
    picture_.write(picture_.whole());
    const std::span<OverlayPixel> pixels = picture_.pixels<OverlayPixel>();
    std::ranges::fill(picture_.pixels<std::byte>(), std::byte{0});
    compositor_.blend(limits, [&](const SplatTile& tile) {
        for_each_light(tile, picture_.whole(),
                       [&](size_t pixel, const Vec4& light) { pixels[pixel] = light.cast<Eigen::half>(); });
    });
    Transfers transfers;
    picture_.upload(transfers);
    targets.display().bind();
    const gl::Program& program = programs_.get({});
    program.use();
    program.set("u_splats", 0);
    picture_.bind(0);
    gl::draw_screen({.blending = gl::over});
}

}  // namespace easypbr::render
