#include "easypbr/render/primitives/surfels/surfel_pass.h"

#include <epoxy/gl.h>

#include <span>

namespace easypbr::render {

void SurfelPass::draw(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets,
                      bool native) {
    if (items.empty()) return;
    if (native) return draw_natively(frame, items, targets);
    splats_.sum(frame, items, targets.depth);
    (frame.with_ids ? targets.surface_ids : targets.surface_emission).bind();
    glDepthFunc(GL_GREATER);
    splats_.write(frame);
}

void SurfelPass::draw_natively(const Frame& frame, const std::vector<DrawItem>& items,
                               const GBuffer& targets) {
    std::vector<SoftwareSurfels::Source> sources;
    for (const DrawItem& item : items)
        sources.push_back({&item, SurfelProjector(item, frame, splats_.spacing_of(item))});
    std::vector<float> opaque(size_t(frame.size.x()) * size_t(frame.size.y()));
    targets.surface.read(3, gl::Format::r32f, 0, 0, frame.size.x(), frame.size.y(),
                         std::as_writable_bytes(std::span(opaque)));
    software_.draw(frame, sources, opaque, pixels_);
    if (!no_attributes_) no_attributes_ = gl::VertexArray::make();
    no_attributes_.bind();
    composite_.draw(frame, pixels_, targets);
}

}  // namespace easypbr::render
