// The part of the pipeline that draws transparent layers, and overlays between them.
#include <algorithm>
#include <functional>

#include "easypbr/render/pipeline/pipeline.h"

namespace easypbr::render {
namespace {

bool is_shaded(const DrawItem& item) {
    return item.kind == SurfaceKind::eye_dome;
}

/// What eye-dome lighting shades of layers, as far as it can be seen at all.
DrawList shaded_points(const DrawList& layers) {
    DrawList shaded = layers.without(std::not_fn(is_shaded));
    for (auto& [kind, items] : shaded.items)
        for (DrawItem& item : items) {
            item.alpha = AlphaMode::mask;
            item.material.alpha_cutoff = 1e-6f;
        }
    return shaded;
}

/// What layers need to be seen through.
struct SeeThrough {
    bool any = false, rough = false, volumes = false;
    double reach = 0;  ///< of geometry and a ground plane, from the camera

    SeeThrough(const Frame& frame, const DrawList& layers, const Box3d& bounds) {
        const auto meshes = layers.of(DrawMode::mesh);
        any = layers.extensions() & transmission_bit;
        rough = std::ranges::any_of(meshes, &DrawItem::blurs_behind);
        volumes = any && std::ranges::any_of(meshes, &DrawItem::is_volume);
        reach = (bounds.center() - frame.camera.position()).norm() + bounds.diagonal().norm() / 2;
        const ResolvedSettings& resolved = *frame.resolved;
        if (GroundPass::is_on(resolved) && !GroundPass::is_shadow_catcher(resolved))
            reach += double(resolved.settings.ground.radius);
    }
};

}  // namespace

const Target& Pipeline::hiding_depth(const Frame& frame, const DrawList& list, bool native) {
    if (!list.without_layers().has(is_over)) return targets_.depth;
    if (hiding_depth_.size() != frame.size) {
        hiding_depth_ = Target(gl::Format::r32f, frame.size);
        hiding_ = gl::Framebuffer();
    }
    if (native) {
        hiding_depth_.write(frame.whole());
        std::ranges::transform(targets_.depth.pixels<float>(), surfaces_.over(frame).depth.pixels<float>(),
                               hiding_depth_.pixels<float>().begin(),
                               [](float depth, float over) { return over > 0 ? 1.0f : depth; });
        return hiding_depth_;
    }
    surfaces_.over(frame).upload(transfers_);
    if (!hiding_) hiding_ = gl::Framebuffer({&hiding_depth_.attachment()});
    hiding_depth_.drawn();
    const gl::Program& program = hiding_programs_.get({});
    hiding_.bind();
    program.use();
    program.set("u_depth_target", 0);
    program.set("u_over", 1);
    targets_.depth.bind(0);
    surfaces_.over(frame).depth.bind(1);
    gl::draw_screen({});
    return hiding_depth_;
}

void Pipeline::draw_overlay_items(const Frame& frame, const DrawList& list, bool native) {
    if (list.overlays.empty()) return;
    overlays_.begin(frame, list.overlays, targets_, hiding_depth(frame, list, native),
                    native ? &transfers_ : nullptr, !surfaces_.is_native());
    overlays_.draw(frame, list.overlays, targets_, nullptr);
    overlays_.draw_over(frame, list.overlays, targets_);
}

void Pipeline::draw_transparent(const Frame& frame, const DrawList& list, const FrameContents& contents,
                                LayerKinds kinds, LitPicture& lit) {
    if (contents.paths) {
        layer_guides_.begin(targets_, !frame.resolved->settings.background.shows_environment(), transfers_);
        lit.guides = &layer_guides_.surfaces();
    }
    lit.partly_covered |= timer_.run("transparency", [&] {
        return kinds.native ? shade_transparent(frame, list, contents, kinds.overlay)
                            : draw_transparent_by_driver(frame, list, contents, kinds.overlay);
    });
}

bool Pipeline::draw_transparent_by_driver(const Frame& frame, const DrawList& list,
                                          const FrameContents& contents, bool with_overlay) {
    const DrawList layers = list.layers();
    const Target& opaque = hiding_depth(frame, list, false);
    overlays_.begin(frame, list.overlays, targets_, opaque, nullptr, !surfaces_.is_native());
    draw_layers(frame, layers.without(is_over), list.overlays, opaque, contents, with_overlay);
    bool drawn = transparency_.has_layers();
    if (layers.has(is_over)) {
        // Hidden by what is drawn over everything else too, and by nothing but.
        const GBuffer& over = surfaces_.over(frame);
        if (!list.without_layers().has(is_over)) over.clear(false);
        draw_layers(frame, layers.without(std::not_fn(is_over)), {}, over.depth, contents, with_overlay);
        drawn |= transparency_.has_layers();
    }
    overlays_.draw_over(frame, list.overlays, targets_);
    return drawn;
}

bool Pipeline::has_native_layers(const DrawList& list) const {
    return surfaces_.has_native_layers(list.layers());
}

bool Pipeline::shade_transparent(const Frame& frame, const DrawList& list, const FrameContents& contents,
                                 bool with_overlay) {
    const DrawList layers = list.layers();
    const Target& opaque = hiding_depth(frame, list, true);
    overlays_.begin(frame, list.overlays, targets_, opaque, &transfers_, false);
    bool drawn = shade_layers(frame, layers.without(is_over), list.overlays, opaque, contents, with_overlay);
    if (layers.has(is_over)) {
        // Hidden by what is drawn over everything else too, and by nothing but.
        const Target& over = surfaces_.over(frame).depth;
        if (!list.without_layers().has(is_over)) {
            over.write(frame.whole());
            std::ranges::fill(over.pixels<float>(), 0.0f);
        }
        drawn |= shade_layers(frame, layers.without(std::not_fn(is_over)), {}, over, contents, with_overlay);
    }
    overlays_.draw_over(frame, list.overlays, targets_);
    return drawn;
}

bool Pipeline::shade_layers(const Frame& frame, const DrawList& layers, const ItemsByKind& overlays,
                            const Target& opaque, const FrameContents& contents, bool with_overlay) {
    const ExtensionSet extensions = layers.extensions();
    native_layers_.begin(frame, opaque, extensions);
    const GBuffer& layer = native_layers_.layer();
    const SeeThrough through(frame, layers, bounds_of(*frame.scene));
    surfaces_.begin_native_layers(frame, layers, native_layers_.limits().depths);
    const Target* shade = shade_points(frame, layers, opaque);
    while (native_layers_.open_layer(frame)) {
        const bool drawn = surfaces_.peel(frame, layers, layer, extensions, native_layers_.limits());
        if (!native_layers_.close_layer(drawn)) break;
        overlays_.draw(frame, overlays, targets_, &layer);
        // Paths find what is behind by themselves.
        if (through.any && !contents.paths) {
            native_layers_.keep_picture(frame, targets_, with_overlay, through.rough, through.reach,
                                        transfers_);
            if (through.volumes) {
                native_layers_.open_exits(frame);
                surfaces_.peel_backs(frame, layers, native_layers_.exits(), native_layers_.limits());
                native_layers_.close_exits();
            }
        }
        light_layer(
            frame, layer, contents,
            {.native = true, .extensions = extensions, .transmission = native_layers_.transmission()});
        native_layers_.blend(targets_, with_overlay, shade, transfers_);
    }
    overlays_.draw(frame, overlays, targets_, nullptr);
    return native_layers_.has_layers();
}

void Pipeline::light_layer(const Frame& frame, const GBuffer& layer, const FrameContents& contents,
                           const LightInputs& inputs) {
    if (!contents.paths) return light(frame, layer, contents, inputs, false);
    timer_.run("paths", [&] { paths_.draw_layer(frame, layer, ray_scene_, contents.tiles, transfers_); });
    layer_guides_.add(layer);
    if (!inputs.native) layer.radiance.upload(transfers_);
}

const gl::Texture* Pipeline::shade_points(const Frame& frame, const DrawList& layers,
                                          const gl::Texture& opaque) {
    const DrawList shaded = shaded_points(layers);
    if (shaded.empty()) return nullptr;
    // The layer is not in use yet.
    transparency_.layer().clear(false);
    surfaces_.draw_by_driver(frame, shaded, transparency_.layer(), {});
    return &display_.shade(frame, transparency_.layer().depth.texture(), opaque);
}

const Target* Pipeline::shade_points(const Frame& frame, const DrawList& layers, const Target& opaque) {
    const DrawList shaded = shaded_points(layers);
    if (shaded.empty()) return nullptr;
    // The layer is not in use yet.
    const Target& nearest = native_layers_.layer().depth;
    surfaces_.find_nearest(frame, shaded, nearest);
    return &display_.shade(frame, nearest, opaque, transfers_);
}

void Pipeline::draw_layers(const Frame& frame, const DrawList& list, const ItemsByKind& overlays,
                           const Target& opaque, const FrameContents& contents, bool with_overlay) {
    SurfaceOutputs outputs{.extensions = list.extensions()};
    const SeeThrough through(frame, list, bounds_of(*frame.scene));
    transparency_.begin(frame, targets_, opaque.texture(), outputs.extensions, with_overlay);
    const gl::Texture* shade = shade_points(frame, list, opaque.texture());
    surfaces_.begin_layers(frame, list, opaque.texture());
    outputs.peel = &transparency_.peel();
    while (transparency_.open_layer(frame)) {
        surfaces_.draw_layer(frame, list, transparency_.layer(), outputs);
        if (!transparency_.close_layer()) break;
        surfaces_.take_layer(list);
        overlays_.draw(frame, overlays, targets_, &transparency_.layer());
        if (through.any) transparency_.keep_picture(frame, targets_, through.rough, through.reach);
        if (through.volumes) {
            transparency_.open_exits(frame);
            surfaces_.draw_backs(frame, list, transparency_.exits(), outputs);
            transparency_.close_exits();
        }
        light_layer(frame, transparency_.layer(), contents,
                    {.extensions = outputs.extensions, .transmission = transparency_.transmission()});
        transparency_.blend(frame, targets_, shade);
    }
    overlays_.draw(frame, overlays, targets_, nullptr);
}

}  // namespace easypbr::render
