// Draws what Dear ImGui lays out, through the thin GL layer: in any context, with or without a window.
#pragma once

#include "easypbr/gl/buffer.h"
#include "easypbr/gl/program.h"
#include "easypbr/gl/texture.h"

struct ImDrawData;
struct ImFontAtlas;

namespace easypbr::gui {

/// All members need the context current.
class ImGuiRenderer {
  public:
    /// What was made is gone with its context.
    void forget_device() { *this = {}; }

    /// Uploads the font's picture and tells the atlas its texture.
    void make_font_texture(ImFontAtlas& atlas);

    /// Draws over the framebuffer, whose row 0 is the top.
    void draw(const ImDrawData& data, const gl::Framebuffer& target);

  private:
    void upload(const ImDrawData& data);

    gl::Program program_;
    gl::Texture font_;
    gl::Buffer vertices_, indices_;
    gl::VertexArray attributes_;
};

}  // namespace easypbr::gui
