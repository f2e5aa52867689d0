#include "easypbr/render/effects/outline/outline_effect.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Pixels around an edge that its line touches.
int line_reach(const BasicOutlineSettings<Inferred>& outline) {
    return int(std::ceil(outline.width / 2 + 0.5f));
}

PixelRect grown(const PixelRect& r, int by, Vec2i size) {
    if (r.width == 0 || r.height == 0) return r;
    const int x0 = std::max(r.x - by, 0), y0 = std::max(r.y - by, 0);
    return {x0, y0, std::min(r.x + r.width + by, size.x()) - x0,
            std::min(r.y + r.height + by, size.y()) - y0};
}

}  // namespace

bool OutlineEffect::is_on(const Shot& shot) const {
    return shot.resolved->settings.outline.enabled;
}

int OutlineEffect::reach(const Frame& whole, const Box3d& /*bounds*/) const {
    // Edges are found from two pixels on either side.
    return is_on(whole) ? line_reach(whole.resolved->settings.outline) + 2 : 0;
}

void OutlineEffect::make_edges(Vec2i size) {
    if (edges_.size() == size) return;
    edges_ = Target(gl::Format::rg8, size);
    found_ = gl::Framebuffer();
}

void OutlineEffect::draw(const EffectInputs& inputs, LitPicture& lit) {
    const Frame& frame = inputs.frame;
    make_edges(frame.size);
    // Draws surfaces where it is asked for ids.
    const ShaderInputs edges = edge_inputs(inputs);
    edges_.drawn();
    if (!found_) found_ = gl::Framebuffer({&edges_.attachment()});
    const float none[4] = {0, 0, 0, 0};
    found_.clear_color(0, none);
    found_.bind();
    // An edge lies between a pixel and the one after it: the first row before the content has some too.
    finding_.draw(edges, screen_state(grown(frame.covered, 1, frame.size)));
    overlay_.attach({&inputs.targets.overlay.drawn()});
    lit.covered = grown(lit.covered, line_reach(frame.resolved->settings.outline), frame.size);
    overlay_.bind();
    lines_.draw(line_inputs(frame), screen_state(lit.covered, gl::over));
}

void OutlineEffect::shade(const EffectInputs& inputs, LitPicture& lit, Transfers& transfers) {
    const Frame& frame = inputs.frame;
    make_edges(frame.size);
    const ShaderInputs edges = edge_inputs(inputs);
    const PixelRect area = grown(frame.covered, 1, frame.size);
    edges_.write(area);
    finding_.shade(edges, {.target = &edges_, .area = area}, transfers);
    lit.covered = grown(lit.covered, line_reach(frame.resolved->settings.outline), frame.size);
    lines_.shade(line_inputs(frame),
                 {.target = &inputs.targets.overlay, .area = lit.covered, .store = native::Store::over},
                 transfers);
}

ShaderInputs OutlineEffect::line_inputs(const Frame& frame) const {
    const auto& outline = frame.resolved->settings.outline;
    ShaderInputs values;
    values.set("u_edges", edges_);
    values.set("u_size", Vec2(frame.size.cast<float>()));
    values.set("u_reach", line_reach(outline));
    values.set("u_half_width", outline.width / 2);
    values.set("u_color", linear_from_srgb(outline.color));
    return values;
}

ShaderInputs OutlineEffect::edge_inputs(const EffectInputs& inputs) const {
    const Frame& frame = inputs.frame;
    const auto& outline = frame.resolved->settings.outline;
    ShaderInputs values;
    values.define(camera_defines(frame));
    if (outline.silhouettes) values.define("SILHOUETTES");
    if (outline.creases) values.define("CREASES");
    values.set("u_depth_target", inputs.targets.depth);
    values.set("u_normal", inputs.targets.normal);
    values.set("u_material", inputs.targets.material);
    values.set("u_depth", Vec3(float(frame.camera.near), float(frame.camera.far), 0));
    values.set("u_size", Vec2(frame.size.cast<float>()));
    values.set("u_depth_step", outline.depth_step);
    values.set("u_least_cosine", float(std::cos(radians(outline.crease_angle_deg))));
    if (!outline.objects) return values;
    values.define("OBJECTS");
    const GBuffer& ids = inputs.with_ids();
    values.set("u_id", ids.id);
    values.set("u_id_depth", ids.depth);
    return values;
}

}  // namespace easypbr::render
