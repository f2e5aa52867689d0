#include "easypbr/render/pipeline/custom_pass.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <utility>

#include "easypbr/core/error.h"

namespace easypbr::render {
namespace {

constexpr unsigned image_unit = 4;

void set_blending(Blend blend) {
    if (blend == Blend::replace) return glDisable(GL_BLEND);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, blend == Blend::add ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
}

/// What the renderer's passes take for granted.
void reset_state() {
    for (const GLenum off : {GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_DEPTH_CLAMP,
                             GL_FRAMEBUFFER_SRGB, GL_POLYGON_OFFSET_FILL, GL_RASTERIZER_DISCARD})
        glDisable(off);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ZERO);
    glDepthRange(0, 1);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glFrontFace(GL_CCW);
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    for (const GLenum target : {GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER}) glBindBuffer(target, 0);
    for (const GLenum parameter : {GL_PACK_ALIGNMENT, GL_UNPACK_ALIGNMENT}) glPixelStorei(parameter, 1);
    for (unsigned unit = 0; unit < 16; ++unit) glBindSampler(unit, 0);
}

}  // namespace

const gl::Texture& PassInput::before() const {
    if (!copy_ || copy_.width() != image.width() || copy_.height() != image.height() ||
        copy_.format() != image.format())
        copy_ = gl::Texture(image.format(), image.width(), image.height());
    gl::copy(image, copy_);
    return copy_;
}

void PassInput::draw(const gl::Program& program, Blend blend) const {
    const std::array<std::pair<const char*, const gl::Texture*>, 4> sources = {
        {{"u_albedo", &gbuffer.albedo},
         {"u_normal", &gbuffer.normal},
         {"u_material", &gbuffer.material},
         {"u_depth_target", &gbuffer.depth}}};
    const gl::Texture* const old = program.has("u_image") ? &before() : nullptr;
    target.bind();
    program.use();
    set_camera_uniforms(program, frame);
    program.set("u_origin", Vec2(frame.origin.cast<float>()));
    program.set("u_picture_size", Vec2(frame.picture_size.cast<float>()));
    program.set("u_exposure", frame.resolved->exposure);
    for (unsigned unit = 0; unit < sources.size(); ++unit) {
        if (!program.has(sources[unit].first)) continue;
        sources[unit].second->bind(unit);
        program.set(sources[unit].first, int(unit));
    }
    if (old) {
        old->bind(image_unit);
        program.set("u_image", int(image_unit));
    }
    glDisable(GL_DEPTH_TEST);
    set_blending(blend);
    draw_screen_triangle();
    glDisable(GL_BLEND);
}

void draw_custom(const CustomPass& custom, const PassInput& input) {
    const auto named = [&](const std::exception& error) {
        reset_state();
        return fmt::format("pass '{}': {}", custom.name, error.what());
    };
    try {
        custom.pass->draw(input);
        reset_state();
    } catch (const ShaderError& error) {
        throw ShaderError(named(error));
    } catch (const FileError& error) {
        throw FileError(named(error));
    } catch (const std::exception& error) {
        throw Error(named(error));
    }
}

}  // namespace easypbr::render
