// Lines into the overlay: unlit, wide in pixels, smooth, hidden by surfaces and by nearer lines.
#pragma once

#include <optional>

#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/render/primitives/lines/line_buffers.h"
#include "easypbr/render/primitives/primitive.h"

namespace easypbr::render {

/// Segments of an item that are drawn alike.
struct LineStroke {
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
    /// Dashes go on from segment to segment.
    bool is_chained(const DrawItem& item) const {
        return kind == gpu::LineKind::edges && item.style.line_dash > 0;
    }
};

/// The edges, the wireframe and the normals of an item: each a stroke, that covers a pixel once, however many
/// of its segments do. Strokes lie over each other by their depths; of more than two in a pixel, of which the
/// nearest is not opaque, those behind it may be in the order of the scene. A line on a surface, as wide as
/// it is, counts as before it. A line is drawn wherever it covers a pixel, however far from its middle, so
/// that tiles need to see no farther for it.
class LinePrimitive final : public Primitive {
  public:
    /// The textures are shared with others, must outlive this one, and are emptied by their owner.
    explicit LinePrimitive(gpu::TextureCache& textures) : textures_(textures) {}

    DrawMode mode() const override { return DrawMode::lines; }
    void draw_overlay(const Frame& frame, DrawItems items, const GBuffer& targets,
                      const OverlayStep& step) override;
    /// As far as lines reach at all: a pixel farther than those that they cover half of. Of lines thinner
    /// than a pixel some are missed.
    std::vector<float> overlay_depths() const override;
    const Target* nearest_lines() const override { return &nearest_; }
    void evict_unused() override { cache_.evict_unused(); }

  private:
    enum class Kind { nearest, ordered, over };
    /// Finds the nearest line of each pixel.
    void begin(const Frame& frame, DrawItems items);
    void begin(const Frame& frame, DrawItems items, const GBuffer& targets, Transfers& transfers);
    void keep_last(const GBuffer& layer);
    /// The program that draws lines, in use.
    const gl::Program& use_lines(const Frame& frame, Kind kind, const GBuffer* next);
    void draw_stroke(const gl::Program& program, const Frame& frame, const DrawItem& item,
                     const LineStroke& stroke, const gl::DrawState& state);
    /// Gathers the lines of each stroke, puts these before and behind each other, and the whole over the
    /// overlay.
    void add(const Frame& frame, DrawItems items, const GBuffer& targets, Kind kind, const GBuffer* next);
    void bind_surfaces(const gl::Program& program, const GBuffer* next) const;
    void keep_host_last(const GBuffer& layer);
    void shade_items(const Frame& frame, DrawItems items, Kind kind, const GBuffer& targets,
                     const GBuffer* next, Transfers& transfers);
    /// What tells which lines lie between the last layer and the next one.
    void set_layers(ShaderInputs& values, Kind kind, const GBuffer* next) const;

    /// What is seen of lines.
    struct Gathered {
        gl::Texture color, depth;  ///< premultiplied; reversed
        gl::Framebuffer gathering, colors, depths;

        /// Unless it is made; `ranks` is a depth texture, of the depth test.
        void make(Vec2i size, const gl::Texture& ranks);
        void bind(unsigned unit) const {
            color.bind(unit);
            depth.bind(unit + 1);
        }
    };

    gpu::TextureCache& textures_;
    LineCache cache_;
    ProgramVariants programs_{"overlay_lines.vert", "overlay_lines.frag"};
    Target nearest_;     ///< R32F: reversed depth of the nearest line
    gl::Texture depth_;  ///< by the driver, to find it, and for ranks
    ProgramVariants strokes_{"screen_triangle.vert", "overlay_strokes.frag"};
    Gathered drawn_, stroke_;  ///< by the driver: the strokes that have been drawn, and one more
    gl::Framebuffer framebuffer_;
    const Target* opaque_ = nullptr;  ///< since begin()
    bool has_last_ = false;
    gl::Texture last_depth_;  ///< of the layer that was drawn last
    Target host_last_depth_;  ///< the same natively
};

}  // namespace easypbr::render
