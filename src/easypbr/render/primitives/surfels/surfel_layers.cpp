#include "easypbr/render/primitives/surfels/surfel_layers.h"

namespace easypbr::render {

void SurfelLayers::begin(const Frame& frame, std::span<const DrawItem> items, const gl::Texture& opaque) {
    if (items.empty()) return;
    const int w = frame.size.x(), h = frame.size.y();
    if (!claim_ || claim_.width() != w || claim_.height() != h) {
        claim_ = gl::Texture(gl::Format::rgba32f, w, h);
        limits_.clear();
    }
    // Of another picture's items none is needed any more.
    if (limits_.size() != items.size()) limits_ = std::vector<Limit>(items.size());
    for (Limit& limit : limits_) {
        if (!limit.depth) {
            limit.depth = gl::Texture(gl::Format::r32f, w, h);
            limit.framebuffer = gl::Framebuffer({&limit.depth});
        }
        gl::copy(opaque, limit.depth);
    }
}

void SurfelLayers::draw(const Frame& frame, std::span<const DrawItem> items, const GBuffer& layer,
                        const SurfaceOutputs& outputs) {
    if (items.empty()) return;
    layer_.attach({&layer.albedo.drawn(), &layer.normal.drawn(), &layer.material.drawn(),
                   &layer.depth.drawn(), &layer.radiance.drawn(), &claim_},
                  &layer.depth_test());
    const float nobody[4] = {0, 0, 0, 0};
    layer_.clear_color(5, nobody);
    for (size_t i = 0; i < items.size(); ++i) {
        splats_.sum(frame, {&items[i], 1}, limits_[i].depth, outputs);
        layer_.bind();
        splats_.write(frame, outputs, int(i) + 1);
    }
}

void SurfelLayers::take(std::span<const DrawItem> items) {
    if (items.empty()) return;
    const gl::Program& program = take_.get({});
    program.use();
    program.set("u_claim", 0);
    claim_.bind(0);
    for (size_t i = 0; i < items.size(); ++i) {
        limits_[i].framebuffer.bind();
        program.set("u_owner", float(i + 1));
        gl::draw_screen({});
    }
}

}  // namespace easypbr::render
