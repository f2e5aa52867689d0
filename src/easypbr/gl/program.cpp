#include "easypbr/gl/program.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"

namespace easypbr::gl {
namespace {

struct EmbeddedShader {
    std::string_view name, text;
};

constexpr EmbeddedShader embedded_shaders[] = {
#include "easypbr_shaders.inc"
};

/// Expands includes; `files` collects names so that `#line N index` can be turned back into a file name.
void expand(std::string_view name, std::vector<std::string>& files, std::string& out) {
    for (const std::string& seen : files)
        if (seen == name) return;
    const size_t index = files.size();
    files.emplace_back(name);
    static const std::regex include(R"re(^\s*#include\s+"([^"]+)"\s*$)re");
    std::istringstream lines(shader_source(name));
    std::string line;
    out += fmt::format("#line 1 {}\n", index);
    for (int number = 1; std::getline(lines, line); ++number) {
        std::smatch match;
        if (std::regex_match(line, match, include)) {
            expand(match[1].str(), files, out);
            out += fmt::format("#line {} {}\n", number + 1, index);
        } else {
            out += line + "\n";
        }
    }
}

/// Puts file names in place of the source indices in a compiler log ("0:12(3): error" or "0(12) : error").
std::string readable_log(const std::string& log, const std::vector<std::string>& files) {
    static const std::regex place(R"(^(\d+)[:(](\d+))");
    std::istringstream lines(log);
    std::string line, out;
    while (std::getline(lines, line)) {
        std::smatch match;
        if (std::regex_search(line, match, place) && std::stoul(match[1]) < files.size())
            line = fmt::format("{}:{}{}", files[std::stoul(match[1])], match[2].str(), match.suffix().str());
        out += "\n  " + line;
    }
    return out;
}

GLuint compile(GLenum stage, std::string_view name, const std::vector<std::string>& defines) {
    std::string text = "#version 450 core\n";
    for (const std::string& define : defines) text += "#define " + define + "\n";
    std::vector<std::string> files;
    expand(name, files, text);
    const GLuint shader = glCreateShader(stage);
    const char* source = text.c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint compiled = 0, length = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled) return shader;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(size_t(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    glDeleteShader(shader);
    throw ContextError(fmt::format("shader {} does not compile:{}", name, readable_log(log.c_str(), files)));
}

}  // namespace

std::string shader_source(std::string_view name) {
    if (const char* folder = std::getenv("EASYPBR_SHADER_DIR"); folder && *folder) {
        const fs::path path = fs::path(folder) / name;
        if (fs::exists(path)) return std::string(MappedFile(path).text());
    }
    for (const EmbeddedShader& shader : embedded_shaders)
        if (shader.name == name) return std::string(shader.text);
    throw ArgumentError(fmt::format("there is no shader file '{}'", name));
}

Program::Program(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines)
    : object_(ObjectKind::program) {
    const GLuint program = object_.id();
    const GLuint stages[] = {compile(GL_VERTEX_SHADER, vertex, defines),
                             compile(GL_FRAGMENT_SHADER, fragment, defines)};
    for (const GLuint stage : stages) glAttachShader(program, stage);
    glLinkProgram(program);
    for (const GLuint stage : stages) {
        glDetachShader(program, stage);
        glDeleteShader(stage);
    }
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) {
        char log[4096] = "";
        glGetProgramInfoLog(program, sizeof log, nullptr, log);
        throw ContextError(fmt::format("shaders {} and {} do not link: {}", vertex, fragment, log));
    }
    read_uniforms();
}

void Program::read_uniforms() {
    GLint count = 0;
    glGetProgramiv(object_.id(), GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        char name[256];
        GLint size = 0;
        GLenum type = 0;
        glGetActiveUniform(object_.id(), GLuint(i), sizeof name, nullptr, &size, &type, name);
        // Arrays are reported once, as "name[0]"; their elements are set one by one.
        std::string base = name;
        if (size > 1) base.resize(base.rfind('['));
        for (GLint k = 0; k < size; ++k) {
            const std::string element = size > 1 ? fmt::format("{}[{}]", base, k) : base;
            locations_[element] = glGetUniformLocation(object_.id(), element.c_str());
        }
    }
}

int Program::location(std::string_view uniform) const {
    const auto found = locations_.find(uniform);
    return found == locations_.end() ? -1 : found->second;
}

void Program::use() const {
    glUseProgram(object_.id());
}

void Program::set(std::string_view uniform, int value) const {
    glProgramUniform1i(object_.id(), location(uniform), value);
}

void Program::set(std::string_view uniform, float value) const {
    glProgramUniform1f(object_.id(), location(uniform), value);
}

void Program::set(std::string_view uniform, const Vec2& value) const {
    glProgramUniform2fv(object_.id(), location(uniform), 1, value.data());
}

void Program::set(std::string_view uniform, const Vec3& value) const {
    glProgramUniform3fv(object_.id(), location(uniform), 1, value.data());
}

void Program::set(std::string_view uniform, const Vec4& value) const {
    glProgramUniform4fv(object_.id(), location(uniform), 1, value.data());
}

void Program::set(std::string_view uniform, const Mat3& value) const {
    glProgramUniformMatrix3fv(object_.id(), location(uniform), 1, GL_FALSE, value.data());
}

void Program::set(std::string_view uniform, const Mat4& value) const {
    glProgramUniformMatrix4fv(object_.id(), location(uniform), 1, GL_FALSE, value.data());
}

}  // namespace easypbr::gl
