#include "easypbr/render/frame/screen_shader.h"

#include <type_traits>

#include "easypbr/core/error.h"

namespace easypbr::render {
namespace {

native::Pixels pixels_of(gl::Format format) {
    switch (format) {
        case gl::Format::rgba8:
            return native::Pixels::rgba8;
        case gl::Format::rgba16:
            return native::Pixels::rgba16;
        case gl::Format::rgba32f:
            return native::Pixels::rgba32f;
        case gl::Format::rgba16f:
            return native::Pixels::rgba16f;
        case gl::Format::rg8:
            return native::Pixels::rg8;
        case gl::Format::rg16:
            return native::Pixels::rg16;
        case gl::Format::r16:
            return native::Pixels::r16;
        case gl::Format::r16f:
            return native::Pixels::r16f;
        case gl::Format::r32f:
            return native::Pixels::r32f;
        default:
            throw Error("native shaders do not write this format");
    }
}

native::Output output_of(const Target& target) {
    return {target.pixels<std::byte>().data(), pixels_of(target.format())};
}

}  // namespace

native::View view_of(const Target& target) {
    const PixelRect& held = target.area();
    return {.data = target.pixels<std::byte>().data(),
            .width = target.width(),
            .height = target.height(),
            .x = held.x,
            .y = held.y,
            .held_width = held.width,
            .held_height = held.height,
            .pixel_bytes = int(gl::pixel_bytes(target.format()))};
}

void ShaderInputs::add(std::string name, Value value) {
    values_.emplace_back(std::move(name), std::move(value));
}

unsigned ShaderInputs::bind(const gl::Program& program) const {
    unsigned unit = 0;
    const auto bind_texture = [&](const std::string& name, const gl::Texture& texture) {
        texture.bind(unit);
        program.set(name, int(unit++));
    };
    for (const auto& [name, value] : values_) {
        if (!program.has(name)) continue;
        std::visit(
            [&, &name = name](const auto& v) {
                using T = std::remove_cvref_t<decltype(v)>;
                if constexpr (std::is_same_v<T, const Target*>)
                    bind_texture(name, v->texture());
                else if constexpr (std::is_same_v<T, const gl::Texture*>)
                    bind_texture(name, *v);
                else if constexpr (requires { program.set(name, v); })
                    program.set(name, v);
                else
                    throw Error("a picture for native shaders is given to the driver");
            },
            value);
    }
    return unit;
}

native::Inputs ShaderInputs::native(Transfers& transfers) const {
    native::Inputs inputs;
    for (const std::string& macro : defines_)
        if (macro.find(' ') == std::string::npos) inputs.features.emplace_back(macro);
    for (const auto& [name, value] : values_)
        std::visit(
            [&, &name = name](const auto& v) {
                using T = std::remove_cvref_t<decltype(v)>;
                if constexpr (std::is_same_v<T, const Target*>) {
                    v->download(v->whole(), transfers);
                    inputs.set(name, view_of(*v));
                } else if constexpr (std::is_same_v<T, const gl::Texture*>)
                    throw Error("a texture is given to a native shader");
                else
                    inputs.set(name, v);
            },
            value);
    for (const Block& block : blocks_) inputs.set(block.member, native::Inputs::Bytes(block.bytes));
    return inputs;
}

void ScreenShader::draw(const ShaderInputs& inputs, const gl::DrawState& state) {
    const gl::Program& program = programs_.get(inputs.defines_);
    program.use();
    inputs.bind(program);
    for (const ShaderInputs::Block& block : inputs.blocks_) {
        if (blocks_.size() <= block.binding) blocks_.resize(block.binding + 1);
        gl::Buffer& buffer = blocks_[block.binding];
        if (buffer.size() != block.bytes.size()) buffer = gl::Buffer(block.bytes.size());
        buffer.update(0, block.bytes);
        buffer.bind_uniform(block.binding);
    }
    gl::draw_screen(state);
}

native::Region region_of(const NativeOutput& output, Transfers& transfers) {
    const Target& target = *output.target;
    native::Region region{.outputs = {},
                          .x = target.area().x,
                          .y = target.area().y,
                          .width = target.area().width,
                          .store = output.store,
                          .kept = output.kept,
                          .where = output.where,
                          .x0 = output.area.x,
                          .x1 = output.area.x + output.area.width};
    native::Output* next = region.outputs;
    *next++ = output_of(target);
    for (const Target* further : output.further)
        if (further) *next++ = output_of(*further);
    if (output.depth) {
        output.depth->download(output.depth->whole(), transfers);
        static_cast<native::View&>(region.depth) = view_of(*output.depth);
        region.depth_channels = output.depth->format() == gl::Format::rgba32f ? 4 : 1;
    }
    return region;
}

void ScreenShader::shade(const ShaderInputs& inputs, const NativeOutput& output, Transfers& transfers) {
    const native::Inputs values = inputs.native(transfers);
    native::shade(native_.value(), values, region_of(output, transfers), output.area.y,
                  output.area.y + output.area.height);
}

}  // namespace easypbr::render
