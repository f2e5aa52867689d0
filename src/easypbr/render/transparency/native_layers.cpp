#include "easypbr/render/transparency/native_layers.h"

#include <span>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {

void NativeLayers::begin(const Frame& frame, const GBuffer& targets, ExtensionSet extensions) {
    if (layer_.size() != frame.size) layer_ = GBuffer(frame.size);
    if (extensions) layer_.add_extensions();
    const PixelRect& area = frame.covered;
    limits_.depths.resize(size_t(area.width) * size_t(area.height));
    targets.depth.copy_out(area, std::as_writable_bytes(std::span(limits_.depths)));
    count_ = 0;
}

bool NativeLayers::open_layer(const Frame& frame) {
    const int most = frame.resolved->settings.transparency.max_layers;
    if (count_ > most) return false;
    // Of what is left beyond the last allowed layer the nearest is worth the most.
    limits_.farthest = count_ < most;
    return true;
}

bool NativeLayers::close_layer(bool drawn) {
    if (drawn) ++count_;
    return drawn;
}

void NativeLayers::blend(const GBuffer& targets, bool with_overlay, Transfers& transfers) {
    ShaderInputs values;
    values.set("u_albedo", layer_.albedo);
    values.set("u_material", layer_.material);
    values.set("u_depth_target", layer_.depth);
    values.set("u_light", layer_.radiance);
    values.set("u_radiance", targets.radiance);
    NativeOutput output{.target = &targets.radiance, .area = layer_.depth.area()};
    if (with_overlay) {
        values.define("OVERLAY");
        values.set("u_overlay", targets.overlay);
        output.further = {&targets.overlay};
    }
    blend_.shade(values, output, transfers);
}

}  // namespace easypbr::render
