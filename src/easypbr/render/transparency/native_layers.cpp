#include "easypbr/render/transparency/native_layers.h"

#include <algorithm>
#include <span>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {

void NativeLayers::begin(const Frame& frame, const Target& opaque, ExtensionSet extensions) {
    if (layer_.size() != frame.size) {
        layer_ = GBuffer(frame.size);
        layer_.from_behind = true;
    }
    limits_.backs = false;
    if (extensions) layer_.add_extensions();
    const PixelRect& area = frame.covered;
    limits_.depths.resize(size_t(area.width) * size_t(area.height));
    opaque.copy_out(area, std::as_writable_bytes(std::span(limits_.depths)));
    count_ = 0;
}

bool NativeLayers::open_layer(const Frame& frame) {
    kept_ = false;
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

const Target& NativeLayers::seen_picture(const GBuffer& targets, bool with_overlay, float exposure,
                                         Transfers& transfers) {
    // Nothing is written to the picture until the layer is lit.
    if (!with_overlay) return targets.radiance;
    const Target& merged = levels_.front();
    merged.write(merged.whole());
    ShaderInputs values;
    values.set("u_size", Vec2(merged.size().cast<float>()));
    values.set("u_exposure", exposure);
    values.set("u_radiance", targets.radiance);
    values.set("u_overlay", targets.overlay);
    merge_.shade(values, {.target = &merged, .area = merged.whole()}, transfers);
    return merged;
}

void NativeLayers::keep_picture(const Frame& frame, const GBuffer& targets, bool with_overlay, bool rough,
                                double reach, Transfers& transfers) {
    if (levels_.empty() || levels_.front().size() != frame.size) {
        levels_.clear();
        const int count = std::max(1, gl::full_levels(frame.size.x(), frame.size.y()) - 3);
        for (int level = 0; level < count; ++level)
            levels_.emplace_back(gl::Format::rgba32f, Vec2i(std::max(frame.size.x() >> level, 1),
                                                            std::max(frame.size.y() >> level, 1)));
    }
    const Target* finer = &seen_picture(targets, with_overlay, frame.resolved->exposure, transfers);
    native::MipPicture picture{.data = {finer->pixels<float>().data()},
                               .width = frame.size.x(),
                               .height = frame.size.y(),
                               .levels = rough ? int(levels_.size()) : 1};
    for (int level = 1; level < picture.levels; ++level) {
        const Target& target = levels_[size_t(level)];
        target.write(target.whole());
        ShaderInputs values;
        values.set("u_finer", *finer);
        values.set("u_size", Vec2(target.size().cast<float>()));
        downsample_.shade(values, {.target = &target, .area = target.whole()}, transfers);
        picture.data[level] = target.pixels<float>().data();
        finer = &target;
    }
    transmission_ = {nullptr, picture, picture.levels, &targets.depth, nullptr, nullptr, reach};
    kept_ = true;
}

void NativeLayers::open_exits(const Frame& frame) {
    if (exits_.size() != frame.size) exits_ = GBuffer(frame.size);
    limits_.backs = true;
}

void NativeLayers::close_exits() {
    limits_.backs = false;
    transmission_.exit_depth = &exits_.depth;
    transmission_.exit_normal = &exits_.normal;
}

void NativeLayers::blend(const GBuffer& targets, bool with_overlay, const Target* eye_dome,
                         Transfers& transfers) {
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
    if (eye_dome) {
        values.define("EYE_DOME");
        values.set("u_shade", *eye_dome);
    }
    blend_.shade(values, output, transfers);
}

}  // namespace easypbr::render
