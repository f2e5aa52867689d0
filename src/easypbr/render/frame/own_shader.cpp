#include "easypbr/render/frame/own_shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"

namespace easypbr::render {
namespace {

/// How many variants with shaders of materials are kept.
constexpr size_t most_shaders = 256;

bool is_word(char c) {
    return c == '_' || ascii::is_alnum(c);
}

/// Whether `text` has "void surface(", with any space between the words. A scan, because std::regex recurses
/// once per character of a long run of blanks.
bool defines_surface(std::string_view text) {
    constexpr std::string_view name = "surface", type = "void";
    for (size_t at = 0; (at = text.find(name, at)) != text.npos; at += name.size()) {
        const std::string_view behind = text.substr(at + name.size());
        const auto parenthesis = std::ranges::find_if_not(behind, ascii::is_space);
        std::string_view before = text.substr(0, at);
        while (!before.empty() && ascii::is_space(before.back())) before.remove_suffix(1);
        const bool is_function = parenthesis != behind.end() && *parenthesis == '(' && before.size() < at;
        if (!is_function || !before.ends_with(type)) continue;
        before.remove_suffix(type.size());
        if (before.empty() || !is_word(before.back())) return true;
    }
    return false;
}

}  // namespace

const gl::Program& with_shader(ProgramVariants& programs, const SurfaceShader& shader,
                               const std::vector<std::string>& defines) {
    const std::string name = shader.path.empty() ? "material.shader" : shader.path;
    if (!defines_surface(shader.text))
        throw ShaderError(
            fmt::format("{}: expected GLSL with the function 'void surface(inout Surface s)'", name));
    programs.limit_texts(most_shaders);
    return programs.get(defines, name + '\n' + shader.text,
                        {{"geometry_shader_own.glsl", {name, shader.text}}});
}

}  // namespace easypbr::render
