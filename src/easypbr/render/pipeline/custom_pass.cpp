#include "easypbr/render/pipeline/custom_pass.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

constexpr unsigned image_unit = 4;

gl::Blending blending_of(Blend blend) {
    return blend == Blend::replace ? gl::replace : blend == Blend::add ? gl::add : gl::over;
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
    const std::array<std::pair<const char*, const Target*>, 4> sources = {
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
    gl::draw_screen({.blending = blending_of(blend)});
}

void draw_custom(const CustomPass& custom, const PassInput& input) {
    const auto named = [&](const std::exception& error) {
        return fmt::format("pass '{}': {}", custom.name, error.what());
    };
    const struct Reset {
        ~Reset() { gl::reset_state(); }
    } at_end;
    try {
        custom.pass->draw(input);
    } catch (const ShaderError& error) {
        throw ShaderError(named(error));
    } catch (const FileError& error) {
        throw FileError(named(error));
    } catch (const std::exception& error) {
        throw Error(named(error));
    }
}

}  // namespace easypbr::render
