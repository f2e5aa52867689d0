#include "easypbr/render/primitives/lines/line_primitive.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/primitives/lines/screen_lines.h"
#include "easypbr/render/primitives/overlay_depths.h"

namespace easypbr::render {
namespace {

constexpr unsigned table_unit = 4;   ///< after those of surfaces and layers
constexpr unsigned stroke_unit = 5;  ///< and of what the other program reads

/// u_part of shaders/overlay_strokes.frag.
enum class StrokePart { all, before, behind, depth, nothing };

/// Premultiplied colours behind what is there.
constexpr gl::Blending under{.source = gl::Factor::one_minus_target_alpha, .target = gl::Factor::one};

/// sRGB colours that stand out on most surfaces.
const Vec3 wireframe_color(0.1f, 0.1f, 0.12f), normals_color(0.16f, 0.35f, 0.9f);

/// Of lines that are the shape of an item. The default of a material is none.
std::optional<Vec3> color_of_lines(const DrawItem& item) {
    const Vec3& base = item.material.base_color;
    if (item.style.line_color) return linear_from_srgb(*item.style.line_color);
    if (item.has_own_colors()) return {};
    return item.material.has_default_color() ? linear_from_srgb(wireframe_color) : base;
}

std::vector<LineStroke> strokes_of(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    const DrawStyle& style = item.style;
    std::vector<LineStroke> strokes;
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

LineView screen_view_of(const Frame& frame, const DrawItem& item, const LineStroke& stroke,
                        LineCache& cache) {
    LineView view{.clip_from_mesh = clip_from_mesh(frame, item),
                  .size = frame.size.cast<float>(),
                  .color = stroke.color_or_none(),
                  .dash = item.style.line_dash};
    if (stroke.is_chained(item)) view.chains = cache.chains(item.mesh());
    return view;
}

/// The rectangle that lines of so many pixels to either side may cover: the whole picture where a part of
/// their box is behind the camera.
PixelRect area_of(const Frame& frame, const DrawItem& item, const Box3& box) {
    const Mat4 clip = clip_from_mesh(frame, item);
    const Vec2 size = frame.size.cast<float>();
    Eigen::AlignedBox2f area;
    for (int i = 0; i < 8; ++i) {
        const Vec4 corner = clip * box.corner(Box3::CornerType(i)).homogeneous();
        const Vec2 ndc = corner.head<2>() / corner.w();
        if (!(corner.w() > 0) || !ndc.allFinite()) return frame.whole();
        area.extend(Vec2((0.5f + 0.5f * ndc.x()) * size.x(), (0.5f - 0.5f * ndc.y()) * size.y()));
    }
    const float reach = item.style.line_width / 2 + 2;
    const Vec2 low = (area.min().array() - reach).max(0.0f).min(size.array()),
               high = (area.max().array() + reach).max(0.0f).min(size.array());
    const int x = int(low.x()), y = int(low.y());
    return {x, y, int(std::ceil(high.x())) - x, int(std::ceil(high.y())) - y};
}

bool is_empty(const PixelRect& area) {
    return area.width <= 0 || area.height <= 0;
}

/// The rectangle around both; none is empty.
PixelRect around_both(const PixelRect& a, const PixelRect& b) {
    const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

/// What overlay_lines.frag reads of an item, for a program or for native shaders.
template <class To>
void set_style(To& to, const DrawItem& item) {
    to.set("u_half_width", item.style.line_width / 2);
    to.set("u_dash", item.style.line_dash);
    to.set("u_always", is_over(item) ? 1.0f : 0.0f);
}

/// Its colours are those of the item's table of values.
bool reads_table(const DrawItem& item, const LineStroke& stroke) {
    return !stroke.color && item.colors.values;
}

/// The same of a stroke; the table of values is set apart.
template <class To>
void set_colors(To& to, const DrawItem& item, const LineStroke& stroke) {
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
        drawn_ = Gathered();
        stroke_ = Gathered();
    }
    if (nearest_.size() != frame.size) nearest_ = Target(gl::Format::r32f, frame.size);
    framebuffer_.attach({&nearest_.drawn()}, &depth_);
    framebuffer_.bind();
    const float none[4] = {0, 0, 0, 0};
    framebuffer_.clear_color(0, none);
    framebuffer_.clear_depth(0);
    const gl::DrawState nearest{.depth_test = gl::DepthTest::greater_equal, .write_depth = true};
    const gl::Program& program = use_lines(frame, Kind::nearest, nullptr);
    for (const DrawItem& item : items)
        for (const LineStroke& stroke : strokes_of(item)) draw_stroke(program, frame, item, stroke, nearest);
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

void LinePrimitive::bind_surfaces(const gl::Program& program, const GBuffer* next) const {
    const auto bind = [&](const gl::Texture& texture, const char* sampler, unsigned unit) {
        texture.bind(unit);
        program.set(sampler, int(unit));
    };
    bind(opaque_->texture(), "u_depth_target", 0);
    if (has_last_) bind(last_depth_, "u_last_depth", 1);
    if (next) bind(next->depth.texture(), "u_next_depth", 3);
}

const gl::Program& LinePrimitive::use_lines(const Frame& frame, Kind kind, const GBuffer* next) {
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
    return program;
}

void LinePrimitive::draw_stroke(const gl::Program& program, const Frame& frame, const DrawItem& item,
                                const LineStroke& stroke, const gl::DrawState& state) {
    LineBuffers& buffers = cache_.get(item.mesh(), stroke.kind, stroke.normals);
    if (buffers.count == 0) return;
    if (stroke.is_chained(item))
        buffers.set_dashes(dashes_of(cache_.segments(item.mesh(), stroke.kind, stroke.normals),
                                     screen_view_of(frame, item, stroke, cache_)));
    if (reads_table(item, stroke))
        textures_.get(item.material.base_color_texture, gpu::TexelKind::color).bind(table_unit);
    program.use();
    program.set("u_clip_from_mesh", clip_from_mesh(frame, item));
    set_style(program, item);
    program.set("u_chained", stroke.is_chained(item) ? 1.0f : 0.0f);
    program.set("u_color", stroke.color_or_none());
    set_colors(program, item, stroke);
    gl::draw_quads(state, buffers.array, buffers.count);
}

void LinePrimitive::Gathered::make(Vec2i size, const gl::Texture& ranks) {
    if (color) return;
    color = gl::Texture(gl::Format::rgba16f, size.x(), size.y());
    depth = gl::Texture(gl::Format::r32f, size.x(), size.y());
    gathering = gl::Framebuffer({&color, &depth}, &ranks);
    colors = gl::Framebuffer({&color});
    depths = gl::Framebuffer({&depth});
}

void LinePrimitive::add(const Frame& frame, DrawItems items, const GBuffer& targets, Kind kind,
                        const GBuffer* next) {
    struct Drawn {
        const DrawItem* item;
        LineStroke stroke;
        PixelRect area;
    };
    std::vector<Drawn> strokes;
    PixelRect whole;
    for (const DrawItem& item : items) {
        if (is_over(item) != (kind == Kind::over)) continue;
        for (const LineStroke& stroke : strokes_of(item)) {
            const LineBuffers& buffers = cache_.get(item.mesh(), stroke.kind, stroke.normals);
            if (buffers.count == 0) continue;
            const PixelRect area = area_of(frame, item, buffers.box);
            if (is_empty(area)) continue;
            whole = strokes.empty() ? area : around_both(whole, area);
            strokes.push_back({&item, stroke, area});
        }
    }
    if (strokes.empty()) return;
    const gl::Program& lines = use_lines(frame, kind, next);
    const gl::Program& joining = strokes_.get(camera_defines(frame));
    joining.use();
    set_camera_uniforms(joining, frame);
    joining.set("u_stroke", int(stroke_unit));
    joining.set("u_stroke_depth", int(stroke_unit + 1));
    joining.set("u_held_depth", int(stroke_unit + 2));
    const auto draw_part = [&](const gl::Framebuffer& to, StrokePart part, const PixelRect& area,
                               const gl::DrawState& state) {
        to.bind();
        joining.use();
        joining.set("u_part", int(part));
        gl::DrawState scissored = state;
        scissored.scissor = area;
        gl::draw_screen(scissored);
    };
    const gl::DrawState clear{.depth_test = gl::DepthTest::always, .write_depth = true};
    const gl::DrawState highest{.depth_test = gl::DepthTest::greater, .write_depth = true};
    for (const Drawn& drawn : strokes) {
        const bool is_first = &drawn == &strokes.front();
        Gathered& to = is_first ? drawn_ : stroke_;
        to.make(frame.size, depth_);
        // No texture may be drawn to while a program could read it.
        for (unsigned k = 0; k < 3; ++k) nearest_.bind(stroke_unit + k);
        draw_part(to.gathering, StrokePart::nothing, is_first ? whole : drawn.area, clear);
        draw_stroke(lines, frame, *drawn.item, drawn.stroke, highest);
        if (is_first) continue;
        stroke_.bind(stroke_unit);
        drawn_.depth.bind(stroke_unit + 2);
        joining.use();
        joining.set("u_half_width", drawn.item->style.line_width / 2);
        draw_part(drawn_.colors, StrokePart::before, drawn.area, {.blending = gl::over});
        draw_part(drawn_.colors, StrokePart::behind, drawn.area, {.blending = under});
        stroke_.depth.bind(stroke_unit + 2);
        draw_part(drawn_.depths, StrokePart::depth, drawn.area, {.blending = gl::maximum});
    }
    drawn_.bind(stroke_unit);
    draw_part(targets.display(), StrokePart::all, whole, {.blending = gl::over});
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
    std::deque<ShaderInputs> inputs;  // which the strokes refer to
    std::vector<native::Stroke> strokes;
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
        for (const LineStroke& stroke : strokes_of(item)) {
            ShaderInputs& values = inputs.emplace_back(of_item);
            if (reads_table(item, stroke))
                values.set("u_table",
                           textures_.host(item.material.base_color_texture, gpu::TexelKind::color));
            set_colors(values, item, stroke);
            const auto& segments = cache_.segments(item.mesh(), stroke.kind, stroke.normals);
            strokes.push_back({values.native(transfers),
                               screen_lines(segments, screen_view_of(frame, item, stroke, cache_))});
            if (kind != Kind::nearest) continue;
            // One at a time: they are not put over each other.
            native::draw_lines(strokes, region, area.y + area.height);
            strokes.clear();
            inputs.clear();
        }
    }
    native::draw_lines(strokes, region, area.y + area.height);
}

}  // namespace easypbr::render
