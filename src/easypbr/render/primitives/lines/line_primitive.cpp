#include "easypbr/render/primitives/lines/line_primitive.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/primitives/lines/screen_lines.h"
#include "easypbr/render/primitives/overlay_depths.h"

namespace easypbr::render {
namespace {

constexpr unsigned table_unit = 4;  ///< after those of surfaces and layers

/// sRGB colours that stand out on most surfaces.
const Vec3 wireframe_color(0.1f, 0.1f, 0.12f), normals_color(0.16f, 0.35f, 0.9f);

/// Segments of an item that are drawn alike.
struct Stroke {
    gpu::LineKind kind;
    std::optional<Vec3> color;  ///< linear; nothing: the data's own
    gpu::NormalLines normals;
    float opacity = 1;  ///< beside that of the segments' ends

    /// As the shader takes it. Lines that are the data's keep its opacity.
    Vec4 color_or_none() const {
        Vec4 c = Vec4::Zero();
        if (color) c << *color, (kind == gpu::LineKind::edges ? -1.0f : 1.0f);
        return c;
    }
};

/// Of lines that are the shape of an item. The default of a material is none.
std::optional<Vec3> color_of_lines(const DrawItem& item) {
    const Vec3& base = item.material.base_color;
    if (item.style.line_color) return linear_from_srgb(*item.style.line_color);
    if (item.has_own_colors()) return {};
    return item.material.has_default_color() ? linear_from_srgb(wireframe_color) : base;
}

std::vector<Stroke> strokes_of(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    const DrawStyle& style = item.style;
    std::vector<Stroke> strokes;
    if (style.mode == DrawMode::lines && !(mesh.E.empty() && mesh.F.empty())) {
        strokes.push_back({mesh.E.empty() ? gpu::LineKind::wireframe : gpu::LineKind::edges,
                           color_of_lines(item),
                           {},
                           item.alpha == AlphaMode::blend ? item.material.opacity : 1.0f});
    }
    const auto given_or = [&](const Vec3& color) {
        return linear_from_srgb(style.line_color.value_or(color));
    };
    if (style.show_wireframe && !mesh.F.empty())
        strokes.push_back({gpu::LineKind::wireframe, given_or(wireframe_color), {}});
    if (style.show_normals && !mesh.V.empty())
        strokes.push_back({gpu::LineKind::normals, given_or(normals_color),
                           gpu::normal_lines(style.normal_length, item.object->T_world_mesh.linear())});
    return strokes;
}

Mat4 clip_from_mesh(const Frame& frame, const DrawItem& item) {
    const Mat4d clip = frame.clip_from_view * frame.camera.view() * item.object->T_world_mesh.matrix();
    return clip.cast<float>();
}

LineView screen_view_of(const Frame& frame, const DrawItem& item, const Vec4& color) {
    return {.clip_from_mesh = clip_from_mesh(frame, item), .size = frame.size.cast<float>(), .color = color};
}

/// What overlay_lines.frag reads of an item, for a program or for native shaders.
template <class To>
void set_style(To& to, const DrawItem& item) {
    to.set("u_half_width", item.style.line_width / 2);
    to.set("u_dash", item.style.line_dash);
    to.set("u_always", is_over(item) ? 1.0f : 0.0f);
}

/// Its colours are those of the item's table of values.
bool reads_table(const DrawItem& item, const Stroke& stroke) {
    return !stroke.color && item.colors.values;
}

/// The same of a stroke; the table of values is set apart.
template <class To>
void set_colors(To& to, const DrawItem& item, const Stroke& stroke) {
    to.set("u_nearer_end", !stroke.color && item.colors.labels ? 1.0f : 0.0f);
    to.set("u_from_table", reads_table(item, stroke) ? 1.0f : 0.0f);
    to.set("u_opacity", stroke.opacity);
}

}  // namespace

void LinePrimitive::draw_overlay(const Frame& frame, DrawItems items, const GBuffer& targets,
                                 const OverlayStep& step) {
    using Part = OverlayStep::Part;
    if (step.part == Part::begin) {
        opaque_ = step.opaque;
        has_last_ = false;
        return step.host ? begin(frame, items, targets, *step.host) : begin(frame, items);
    }
    if (step.part == Part::front) return;
    const Kind kind = step.part == Part::over ? Kind::over : Kind::ordered;
    if (step.host)
        shade_items(frame, items, kind, targets, step.next, *step.host);
    else
        add(frame, items, targets, kind, step.next);
    if (step.next) step.host ? keep_host_last(*step.next) : keep_last(*step.next);
}

void LinePrimitive::begin(const Frame& frame, DrawItems items) {
    if (Vec2i(depth_.width(), depth_.height()) != frame.size) {
        depth_ = gl::Texture(gl::Format::depth32f, frame.size.x(), frame.size.y());
        last_depth_ = gl::Texture();
    }
    if (nearest_.size() != frame.size) nearest_ = Target(gl::Format::r32f, frame.size);
    framebuffer_.attach({&nearest_.drawn()}, &depth_);
    framebuffer_.bind();
    const float none[4] = {0, 0, 0, 0};
    framebuffer_.clear_color(0, none);
    framebuffer_.clear_depth(0);
    draw_items(frame, items, Kind::nearest);
}

void LinePrimitive::keep_last(const GBuffer& layer) {
    if (!last_depth_) {
        const Vec2i size = layer.depth.size();
        last_depth_ = gl::Texture(gl::Format::r32f, size.x(), size.y());
    }
    gl::copy(layer.depth.texture(), last_depth_);
    has_last_ = true;
}

void LinePrimitive::keep_host_last(const GBuffer& layer) {
    if (host_last_depth_.size() != layer.depth.size())
        host_last_depth_ = Target(layer.depth.format(), layer.depth.size());
    host_last_depth_.write(layer.depth.area());
    std::ranges::copy(layer.depth.pixels<float>(), host_last_depth_.pixels<float>().begin());
    has_last_ = true;
}

std::vector<float> LinePrimitive::overlay_depths() const {
    std::vector<float> depths;
    const Vec2i size = nearest_.size();
    if (nearest_.is_ahead()) {
        depths = whole_depths(nearest_);
    } else {
        depths.resize(size_t(size.x()) * size_t(size.y()));
        framebuffer_.read(0, gl::Format::r32f, 0, 0, size.x(), size.y(),
                          std::as_writable_bytes(std::span(depths)));
    }
    widen_by_a_pixel(depths, size);
    return depths;
}

void LinePrimitive::add(const Frame& frame, DrawItems items, const GBuffer& targets, Kind kind,
                        const GBuffer* next) {
    targets.display().bind();
    draw_items(frame, items, kind, next);
}

void LinePrimitive::bind_surfaces(const gl::Program& program, const GBuffer* next) const {
    const auto bind = [&](const gl::Texture& texture, const char* sampler, unsigned unit) {
        texture.bind(unit);
        program.set(sampler, int(unit));
    };
    bind(opaque_->texture(), "u_depth_target", 0);
    if (has_last_) bind(last_depth_, "u_last_depth", 1);
    if (next) bind(next->depth.texture(), "u_next_depth", 3);
}

void LinePrimitive::draw_items(const Frame& frame, DrawItems items, Kind kind, const GBuffer* next) {
    std::vector<std::string> defines = camera_defines(frame);
    if (kind == Kind::nearest) defines.emplace_back("DEPTH_ONLY");
    if (kind == Kind::ordered && has_last_) defines.emplace_back("AFTER");
    if (next) defines.emplace_back("BEFORE");
    const gl::Program& program = programs_.get(defines);
    program.use();
    set_camera_uniforms(program, frame);
    bind_surfaces(program, next);
    if (kind != Kind::nearest) nearest_.bind(2);
    program.set("u_nearest_line", 2);
    program.set("u_table", int(table_unit));
    const gl::DrawState nearest{.depth_test = gl::DepthTest::greater_equal, .write_depth = true};
    const gl::DrawState state = kind == Kind::nearest ? nearest : gl::DrawState{.blending = gl::over};
    for (const DrawItem& item : items) {
        if (kind != Kind::nearest && is_over(item) != (kind == Kind::over)) continue;
        program.set("u_clip_from_mesh", clip_from_mesh(frame, item));
        set_style(program, item);
        for (const Stroke& stroke : strokes_of(item)) {
            const LineBuffers& buffers = cache_.get(item.mesh(), stroke.kind, stroke.normals);
            if (buffers.count == 0) continue;
            if (reads_table(item, stroke))
                textures_.get(item.material.base_color_texture, gpu::TexelKind::color).bind(table_unit);
            program.set("u_color", stroke.color_or_none());
            set_colors(program, item, stroke);
            gl::draw_quads(state, buffers.array, buffers.count);
        }
    }
}

void LinePrimitive::begin(const Frame& frame, DrawItems items, const GBuffer& targets, Transfers& transfers) {
    if (nearest_.size() != frame.size) nearest_ = Target(gl::Format::r32f, frame.size);
    nearest_.write(targets.overlay.area());
    std::ranges::fill(nearest_.pixels<float>(), 0.0f);
    shade_items(frame, items, Kind::nearest, targets, nullptr, transfers);
}

void LinePrimitive::set_layers(ShaderInputs& values, Kind kind, const GBuffer* next) const {
    if (kind == Kind::ordered && has_last_) {
        values.define("AFTER");
        values.set("u_last_depth", host_last_depth_);
    }
    if (!next) return;
    values.define("BEFORE");
    values.set("u_next_depth", next->depth);
}

void LinePrimitive::shade_items(const Frame& frame, DrawItems items, Kind kind, const GBuffer& targets,
                                const GBuffer* next, Transfers& transfers) {
    const Target& to = kind == Kind::nearest ? nearest_ : targets.overlay;
    const PixelRect& area = to.area();
    const native::Region region =
        region_of({.target = &to, .area = area, .store = native::Store::over}, transfers);
    for (const DrawItem& item : items) {
        if (kind != Kind::nearest && is_over(item) != (kind == Kind::over)) continue;
        ShaderInputs of_item;
        of_item.define(camera_defines(frame));
        if (kind == Kind::nearest) of_item.define("DEPTH_ONLY");
        set_camera_uniforms(of_item, frame);
        set_style(of_item, item);
        set_layers(of_item, kind, next);
        of_item.set("u_depth_target", *opaque_);
        if (kind != Kind::nearest) of_item.set("u_nearest_line", nearest_);
        for (const Stroke& stroke : strokes_of(item)) {
            ShaderInputs values = of_item;
            if (reads_table(item, stroke))
                values.set("u_table",
                           textures_.host(item.material.base_color_texture, gpu::TexelKind::color));
            set_colors(values, item, stroke);
            const auto& segments = cache_.segments(item.mesh(), stroke.kind, stroke.normals);
            native::draw_lines(values.native(transfers), region,
                               screen_lines(segments, screen_view_of(frame, item, stroke.color_or_none())),
                               area.y + area.height);
        }
    }
}

}  // namespace easypbr::render
