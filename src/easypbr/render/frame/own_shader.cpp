#include "easypbr/render/frame/own_shader.h"

#include <fmt/format.h>

#include <regex>

#include "easypbr/core/error.h"

namespace easypbr::render {
namespace {

/// How many variants with shaders of materials are kept.
constexpr size_t most_shaders = 256;

}  // namespace

const gl::Program& with_shader(ProgramVariants& programs, const SurfaceShader& shader,
                               const std::vector<std::string>& defines) {
    const std::string name = shader.path.empty() ? "material.shader" : shader.path;
    static const std::regex definition(R"(\bvoid\s+surface\s*\()");
    if (!std::regex_search(shader.text, definition))
        throw ShaderError(
            fmt::format("{}: expected GLSL with the function 'void surface(inout Surface s)'", name));
    programs.limit_texts(most_shaders);
    return programs.get(defines, name + '\n' + shader.text,
                        {{"geometry_shader_own.glsl", {name, shader.text}}});
}

}  // namespace easypbr::render
