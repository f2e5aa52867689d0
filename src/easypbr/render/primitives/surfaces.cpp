#include "easypbr/render/primitives/surfaces.h"

#include <functional>
#include <span>

#include "easypbr/gl/context.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {

SurfacePasses::SurfacePasses(DataCaches& caches)
    : meshes_(caches.meshes, caches.textures),
      software_(caches.spacings, caches.closed_meshes),
      points_(caches.spacings, caches.points),
      surfel_splats_(caches.spacings, caches.surfels) {}

bool SurfacePasses::is_native() const {
    return allow_native_ && gl::Context::current().info().software;
}

PixelRect SurfacePasses::draw_kinds(const Frame& frame, const DrawList& list, const GBuffer& targets,
                                    const SurfaceOutputs& outputs) {
    const bool native = is_native();
    std::optional<PixelRect> covered;
    if (native && SoftwareGeometryPass::handles(list))
        covered = software_.draw(frame, list, targets, outputs);
    if (!covered) {
        meshes_.draw(frame, list.meshes, targets, outputs);
        if (native && !list.points.empty() && SoftwareGeometryPass::handles_points(list))
            software_.draw_points_over(frame, list, targets, outputs);
        else
            points_.draw(frame, list.points, targets, outputs);
    }
    surfels_.draw(frame, list.surfels, targets, outputs, native);
    const int fillings = frame.resolved->settings.points.hole_filling;
    if (fillings > 0 && !list.points.empty()) composite_.fill_holes(frame, targets, outputs, fillings);
    return covered.value_or(frame.covered);
}

GBuffer& SurfacePasses::over(const Frame& frame) {
    if (!over_.albedo || over_.size() != frame.size) over_ = GBuffer(frame.size);
    return over_;
}

PixelRect SurfacePasses::draw(const Frame& frame, const DrawList& list, const GBuffer& targets,
                              const SurfaceOutputs& outputs) {
    if (!list.has(is_over)) return draw_kinds(frame, list, targets, outputs);
    draw_kinds(frame, list.without(is_over), targets, outputs);
    GBuffer& over_everything = over(frame);
    if (outputs.ids) over_everything.add_ids();
    if (outputs.extensions) over_everything.add_extensions();
    draw_kinds(frame, list.without(std::not_fn(is_over)), over_everything, outputs);
    composite_.draw_over(frame, over_everything, targets, outputs);
    return frame.covered;
}

std::vector<uint8_t> SurfacePasses::coverage(const Frame& frame, const DrawList& list) {
    const size_t count = size_t(frame.size.x()) * size_t(frame.size.y());
    std::vector<uint8_t> covered(count);
    if (list.empty() || covered.empty()) return covered;
    if (is_native() && software_.cover(frame, list, covered)) return covered;
    if (!coverage_.albedo || coverage_.size() != frame.size) coverage_ = GBuffer(frame.size);
    coverage_.add_ids();
    draw(frame, list, coverage_, {.ids = true});
    std::vector<float> depth(count);
    coverage_.surface.read(3, gl::Format::r32f, 0, 0, frame.size.x(), frame.size.y(),
                           std::as_writable_bytes(std::span(depth)));
    for (size_t i = 0; i < count; ++i) covered[i] = depth[i] > 0;
    return covered;
}

void SurfacePasses::begin_layers(const Frame& frame, const DrawList& list, const gl::Texture& opaque) {
    surfel_layers_.begin(frame, list.surfels, opaque);
}

void SurfacePasses::draw_layer(const Frame& frame, const DrawList& list, const GBuffer& layer,
                               const SurfaceOutputs& outputs) {
    meshes_.draw(frame, list.meshes, layer, outputs);
    points_.draw(frame, list.points, layer, outputs);
    surfel_layers_.draw(frame, list.surfels, layer, outputs);
}

void SurfacePasses::take_layer(const DrawList& list) {
    surfel_layers_.take(list.surfels);
}

void SurfacePasses::draw_backs(const Frame& frame, const std::vector<DrawItem>& meshes,
                               const GBuffer& targets, const SurfaceOutputs& outputs) {
    meshes_.draw(frame, meshes, targets, outputs);
}

void SurfacePasses::draw_points(const Frame& frame, const std::vector<DrawItem>& points,
                                const GBuffer& targets) {
    points_.draw(frame, points, targets, {});
}

}  // namespace easypbr::render
