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

void OutlineEffect::draw(const EffectInputs& inputs, LitPicture& lit) {
    const Frame& frame = inputs.frame;
    const auto& outline = frame.resolved->settings.outline;
    if (!edges_ || Vec2i(edges_.width(), edges_.height()) != frame.size) {
        edges_ = gl::Texture(gl::Format::rg8, frame.size.x(), frame.size.y());
        found_ = gl::Framebuffer({&edges_});
    }
    find_edges(inputs);
    if (overlay_id_ != inputs.targets.overlay.attachment().id()) {
        overlay_ = gl::Framebuffer({&inputs.targets.overlay.drawn()});
        overlay_id_ = inputs.targets.overlay.attachment().id();
    }
    lit.covered = grown(lit.covered, line_reach(outline), frame.size);
    const gl::Program& program = line_programs_.get({});
    overlay_.bind();
    program.use();
    program.set("u_edges", 0);
    edges_.bind(0);
    program.set("u_reach", line_reach(outline));
    program.set("u_half_width", outline.width / 2);
    program.set("u_color", linear_from_srgb(outline.color));
    gl::draw_screen(screen_state(lit.covered, gl::over));
}

void OutlineEffect::find_edges(const EffectInputs& inputs) {
    const Frame& frame = inputs.frame;
    const auto& outline = frame.resolved->settings.outline;
    std::vector<std::string> defines = camera_defines(frame);
    if (outline.silhouettes) defines.emplace_back("SILHOUETTES");
    if (outline.creases) defines.emplace_back("CREASES");
    if (outline.objects) defines.emplace_back("OBJECTS");
    // Drawn first where it is asked for: it binds framebuffers of its own.
    const GBuffer& ids = outline.objects ? inputs.with_ids() : inputs.targets;
    const float none[4] = {0, 0, 0, 0};
    found_.clear_color(0, none);
    found_.bind();
    const gl::Program& program = edge_programs_.get(defines);
    program.use();
    const std::pair<const char*, const Target*> sources[] = {{"u_depth_target", &inputs.targets.depth},
                                                             {"u_normal", &inputs.targets.normal},
                                                             {"u_material", &inputs.targets.material},
                                                             {"u_id", &ids.id},
                                                             {"u_id_depth", &ids.depth}};
    for (unsigned unit = 0; unit < std::size(sources); ++unit) {
        if (!program.has(sources[unit].first)) continue;
        program.set(sources[unit].first, int(unit));
        sources[unit].second->bind(unit);
    }
    program.set("u_depth", Vec3(float(frame.camera.near), float(frame.camera.far), 0));
    program.set("u_size", Vec2(frame.size.cast<float>()));
    program.set("u_depth_step", outline.depth_step);
    program.set("u_least_cosine", float(std::cos(radians(outline.crease_angle_deg))));
    // An edge lies between a pixel and the one after it: the first row before the content has some too.
    gl::draw_screen(screen_state(grown(frame.covered, 1, frame.size)));
}

}  // namespace easypbr::render
