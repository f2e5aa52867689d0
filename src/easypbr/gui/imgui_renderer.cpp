#include "easypbr/gui/imgui_renderer.h"

#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>

namespace easypbr::gui {
namespace {

/// Room for twice as much, so that a GUI that grows is not reallocated each frame.
bool grow(gl::Buffer& buffer, size_t bytes) {
    if (buffer && buffer.size() >= bytes) return false;
    buffer = gl::Buffer(std::max<size_t>(2 * bytes, 1 << 16));
    return true;
}

}  // namespace

void ImGuiRenderer::make_font_texture(ImFontAtlas& atlas) {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
    font_ = gl::Texture(gl::Format::rgba8, width, height);
    font_.upload(std::as_bytes(std::span(pixels, size_t(width) * size_t(height) * 4)));
    font_.sampling(gl::Filtering::linear);
    atlas.SetTexID(ImTextureID(intptr_t(font_.id())));
}

void ImGuiRenderer::upload(const ImDrawData& data) {
    const bool new_vertices = grow(vertices_, size_t(data.TotalVtxCount) * sizeof(ImDrawVert));
    const bool new_indices = grow(indices_, size_t(data.TotalIdxCount) * sizeof(ImDrawIdx));
    if (new_vertices || new_indices) {
        constexpr int stride = sizeof(ImDrawVert);
        attributes_ = gl::VertexArray::make();
        attributes_.attribute(0, vertices_, 2, gl::AttributeType::f32, stride, offsetof(ImDrawVert, pos));
        attributes_.attribute(1, vertices_, 2, gl::AttributeType::f32, stride, offsetof(ImDrawVert, uv));
        attributes_.attribute(2, vertices_, 4, gl::AttributeType::unorm8, stride, offsetof(ImDrawVert, col));
        attributes_.indices(indices_);
    }
    size_t vertex = 0, index = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        vertices_.update(vertex, std::as_bytes(std::span(list.VtxBuffer.Data, size_t(list.VtxBuffer.Size))));
        indices_.update(index, std::as_bytes(std::span(list.IdxBuffer.Data, size_t(list.IdxBuffer.Size))));
        vertex += size_t(list.VtxBuffer.Size) * sizeof(ImDrawVert);
        index += size_t(list.IdxBuffer.Size) * sizeof(ImDrawIdx);
    }
}

void ImGuiRenderer::draw(const ImDrawData& data, const gl::Framebuffer& target) {
    if (!program_) program_ = gl::Program("gui_draw.vert", "gui_draw.frag");
    upload(data);
    target.bind();
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    program_.use();
    program_.set("u_size", Vec2(float(target.width()), float(target.height())));
    program_.set("u_texture", 0);
    attributes_.bind();
    size_t first_vertex = 0, first_index = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const ImVec4& clip = command.ClipRect;
            const int x0 = std::max(int(clip.x), 0), y0 = std::max(int(clip.y), 0);
            const int width = int(clip.z) - x0, height = int(clip.w) - y0;
            if (width <= 0 || height <= 0) continue;
            glScissor(x0, y0, width, height);
            glBindTextureUnit(0, GLuint(intptr_t(command.TextureId)));
            const size_t at = (first_index + command.IdxOffset) * sizeof(ImDrawIdx);
            glDrawElementsBaseVertex(GL_TRIANGLES, GLsizei(command.ElemCount), GL_UNSIGNED_SHORT,
                                     reinterpret_cast<const void*>(at),
                                     GLint(first_vertex + command.VtxOffset));
        }
        first_vertex += size_t(list.VtxBuffer.Size);
        first_index += size_t(list.IdxBuffer.Size);
    }
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
}

}  // namespace easypbr::gui
