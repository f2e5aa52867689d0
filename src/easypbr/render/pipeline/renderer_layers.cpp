// The part of Renderer that draws what light passes, and lines.
#include <epoxy/gl.h>

#include <functional>

#include "easypbr/render/pipeline/renderer.h"

namespace easypbr::render {
namespace {

bool is_shaded_point(const DrawItem& item) {
    return item.kind == SurfaceKind::eye_dome;
}

}  // namespace

const gl::Texture& Renderer::hiding_depth(const Frame& frame, const DrawList& list) {
    if (!list.without_layers().has(is_over)) return targets_.depth;
    if (!hiding_depth_ || Vec2i(hiding_depth_.width(), hiding_depth_.height()) != frame.size) {
        hiding_depth_ = gl::Texture(gl::Format::r32f, frame.size.x(), frame.size.y());
        hiding_ = gl::Framebuffer({&hiding_depth_});
    }
    const gl::Program& program = hiding_programs_.get({});
    hiding_.bind();
    program.use();
    program.set("u_depth_target", 0);
    program.set("u_over", 1);
    targets_.depth.bind(0);
    over_.depth.bind(1);
    glDisable(GL_DEPTH_TEST);
    no_attributes_.bind();
    draw_screen_triangle();
    return hiding_depth_;
}

void Renderer::draw_lines(const Frame& frame, const DrawList& list) {
    if (list.lines.empty()) return;
    lines_.begin(frame, list.lines, targets_, hiding_depth(frame, list));
    lines_.draw_rest(frame, list.lines, targets_);
    lines_.draw_over(frame, list.lines, targets_);
    no_attributes_.bind();
}

void Renderer::draw_transparent(Frame& frame, const DrawList& list) {
    const DrawList layers = list.layers();
    const gl::Texture& opaque = hiding_depth(frame, list);
    if (!list.lines.empty()) lines_.begin(frame, list.lines, targets_, opaque);
    draw_layers(frame, layers.without(is_over), list.lines, opaque);
    if (layers.has(is_over)) {
        // Hidden by what is drawn over everything else too, and by nothing but.
        if (!over_.albedo || over_.size() != frame.size) over_ = GBuffer(frame.size);
        if (!list.without_layers().has(is_over)) over_.clear(false);
        draw_layers(frame, layers.without(std::not_fn(is_over)), {}, over_.depth);
    }
    lines_.draw_over(frame, list.lines, targets_);
    no_attributes_.bind();
}

const gl::Texture* Renderer::shade_points(const Frame& frame, const DrawList& layers,
                                          const gl::Texture& opaque) {
    std::vector<DrawItem> points = layers.without(std::not_fn(is_shaded_point)).points;
    if (points.empty()) return nullptr;
    for (DrawItem& item : points) {
        item.alpha = AlphaMode::mask;
        item.material.alpha_cutoff = 1e-6f;  // whatever can be seen at all
    }
    // The layer is not in use yet.
    transparency_.layer().clear(false);
    points_.draw(frame, points, transparency_.layer());
    no_attributes_.bind();
    return &display_.shade(frame, transparency_.layer().depth, opaque);
}

void Renderer::draw_layers(Frame& frame, const DrawList& list, const std::vector<LineItem>& lines,
                           const gl::Texture& opaque) {
    frame.extensions = list.extensions();
    const bool see_through = frame.extensions & transmission_bit;
    const bool rough = std::ranges::any_of(list.meshes, &DrawItem::blurs_behind);
    DrawList volumes = list;
    std::erase_if(volumes.meshes, [](const DrawItem& item) { return !item.is_volume(); });
    const Box3d& bounds = bounds_of(*frame.scene);
    const double reach = (bounds.center() - frame.camera.position()).norm() + bounds.diagonal().norm() / 2;
    transparency_.begin(frame, targets_, opaque);
    const gl::Texture* shade = shade_points(frame, list, opaque);
    surfel_layers_.begin(frame, list.surfels, opaque);
    while (transparency_.open_layer(frame)) {
        geometry_.draw(frame, list.meshes, transparency_.layer());
        points_.draw(frame, list.points, transparency_.layer());
        surfel_layers_.draw(frame, list.surfels, transparency_.layer());
        if (!transparency_.close_layer(frame)) break;
        surfel_layers_.take(list.surfels);
        lines_.draw_behind(frame, lines, targets_, transparency_.layer());
        no_attributes_.bind();
        if (see_through) transparency_.look_behind(frame, targets_, rough, reach);
        if (!volumes.meshes.empty()) {
            transparency_.open_exits(frame);
            geometry_.draw(frame, volumes.meshes, transparency_.exits());
            transparency_.close_exits(frame);
        }
        draw_lights(frame, transparency_.layer());
        transparency_.blend(frame, targets_, shade);
    }
    transparency_.end(frame);
    lines_.draw_rest(frame, lines, targets_);
    no_attributes_.bind();
}

}  // namespace easypbr::render
