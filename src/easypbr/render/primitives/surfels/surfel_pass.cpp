#include "easypbr/render/primitives/surfels/surfel_pass.h"

#include <span>

namespace easypbr::render {

void SurfelPass::draw(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets,
                      const SurfaceOutputs& outputs, bool native) {
    if (items.empty()) return;
    if (native) return draw_natively(frame, items, targets, outputs);
    splats_.sum(frame, items, targets.depth, outputs);
    (outputs.ids ? targets.surface_ids : targets.surface_emission).bind();
    splats_.write(frame, outputs);
}

void SurfelPass::draw_natively(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets,
                               const SurfaceOutputs& outputs) {
    std::vector<SoftwareSurfels::Source> sources;
    for (const DrawItem& item : items)
        sources.push_back({&item, SurfelProjector(item, frame, splats_.spacing_of(item))});
    std::vector<float> opaque(size_t(frame.size.x()) * size_t(frame.size.y()));
    targets.surface.read(3, gl::Format::r32f, 0, 0, frame.size.x(), frame.size.y(),
                         std::as_writable_bytes(std::span(opaque)));
    software_.draw(frame, sources, opaque, outputs.ids, pixels_);
    composite_.draw(frame, pixels_, targets, outputs);
}

}  // namespace easypbr::render
