#include "easypbr/gl/program.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <set>
#include <span>
#include <sstream>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/suggest.h"
#include "easypbr/gl/context.h"

namespace easypbr::gl {
namespace {

struct EmbeddedShader {
    std::string_view name, text;
};

constexpr EmbeddedShader embedded_shaders[] = {
#include "easypbr_shaders.inc"
};

bool is_path(std::string_view name) {
    return name.find('/') != name.npos;
}

/// A file that `includer` includes: beside it when it is one on disk, else embedded.
std::string resolve_include(std::string_view includer, const std::string& name) {
    if (!is_path(includer)) return name;
    const fs::path beside = fs::path(includer).parent_path() / name;
    std::error_code unusable;  // A name may be too long for the system.
    return fs::exists(beside, unusable) ? beside.string() : name;
}

constexpr std::string_view blanks = " \t\r\v\f";

std::string_view without_blanks(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    text.remove_suffix(text.size() - 1 - text.find_last_not_of(blanks));
    return text;
}

/// The file that a line `#include "FILE"` names; nothing for another line. A scan, because std::regex
/// recurses once per character and a long line overflows the stack.
std::optional<std::string_view> included_file(std::string_view line) {
    constexpr std::string_view directive = "#include";
    line = without_blanks(line);
    if (!line.starts_with(directive)) return std::nullopt;
    line.remove_prefix(directive.size());
    const std::string_view quoted = without_blanks(line);
    const bool is_quoted =
        quoted.size() > 2 && quoted.front() == '"' && quoted.find('"', 1) == quoted.size() - 1;
    if (!is_quoted || quoted.size() == line.size()) return std::nullopt;
    return quoted.substr(1, quoted.size() - 2);
}

/// Files are told apart by their lines' numbers: Mesa forgets the source's own number in many messages.
constexpr int lines_of_a_file = 100000;

std::string line_directive(size_t file, int line) {
    return fmt::format("#line {}\n", int(file) * lines_of_a_file + line);
}

/// Files of one shader, and how deep they may include each other. A file that includes itself by way of a
/// folder, "a/../self.glsl" or a link, has another name each time.
constexpr size_t most_files = 1000;
constexpr int deepest_include = 64;

/// A line `#feature MACRO constant`; empty names: another line.
struct Feature {
    std::string macro, constant;
};

Feature feature_of(const std::string& line) {
    Feature feature;
    constexpr std::string_view directive = "#feature ";
    if (line.starts_with(directive))
        std::istringstream(line.substr(directive.size())) >> feature.macro >> feature.constant;
    return feature;
}

/// A shader with all that it includes.
struct Expanded {
    const ShaderTexts& texts;
    const std::vector<std::string>& defines;
    std::string text = {};
    std::vector<std::string> files = {}, shown = {}, features = {};
    std::set<std::string, std::less<>> in_conditions = {};  ///< of the files, those first included within #if
    int conditions = 0;                                     ///< #if that are open
    int depth = 0;                                          ///< of the file that is read
    bool is_own = false;                                    ///< something of it is not of the library

    /// A file that is included already is left out: each is part of a stage once.
    void add(std::string_view name) {
        if (std::ranges::find(files, name) != files.end()) return check_again(name);
        if (depth == deepest_include || files.size() == most_files)
            throw ArgumentError(fmt::format(
                "shader file '{}' includes more than {} files, or more than {} deep, the last '{}'",
                shown.front(), most_files, deepest_include, name.substr(0, 200)));
        if (conditions > 0) in_conditions.emplace(name);
        const size_t index = files.size();
        const auto given = texts.find(name);
        files.emplace_back(name);
        shown.emplace_back(given == texts.end() ? name : given->second.name);
        is_own |= given != texts.end() || is_path(name);
        std::istringstream lines(given == texts.end() ? shader_source(name) : given->second.text);
        std::string line;
        text += line_directive(index, 1);
        for (int number = 1; std::getline(lines, line); ++number) {
            if (const auto file = included_file(line)) {
                ++depth;
                add(resolve_include(name, std::string(*file)));
                --depth;
                text += line_directive(index, number + 1);
            } else if (const Feature feature = feature_of(line); !feature.macro.empty()) {
                features.push_back(feature.macro);
                const bool given = std::ranges::find(defines, feature.macro) != defines.end();
                text += fmt::format("const bool {} = {};\n", feature.constant, given);
            } else {
                if (line.starts_with("#if")) ++conditions;
                if (line.starts_with("#endif")) --conditions;
                text += line + "\n";
            }
        }
    }

    /// Where the condition is false, a file that is left out the second time would be missing.
    void check_again(std::string_view name) const {
        if (is_own || !in_conditions.contains(name)) return;
        throw ArgumentError(fmt::format(
            "shader file '{}' is included within #if, and again: expected its include before the #if", name));
    }
};

/// Removes the whole number that the text begins with; nothing where there is none.
std::optional<size_t> take_number(std::string_view& text) {
    size_t number = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    if (result.ec != std::errc()) return std::nullopt;
    text.remove_prefix(size_t(result.ptr - text.data()));
    return number;
}

/// Puts file names in place of the numbers in a line of a compiler log ("0:12(3): error" or "0(12) : error").
std::string readable_line(const std::string& line, const std::vector<std::string>& files) {
    std::string_view rest = line;
    if (!take_number(rest) || rest.empty() || (rest.front() != ':' && rest.front() != '(')) return line;
    rest.remove_prefix(1);
    const auto number = take_number(rest);
    if (!number || *number / lines_of_a_file >= files.size()) return line;
    return fmt::format("{}:{}{}", files[*number / lines_of_a_file], *number % lines_of_a_file, rest);
}

std::string readable_log(const std::string& log, const std::vector<std::string>& files) {
    std::istringstream lines(log);
    std::string line, out;
    while (std::getline(lines, line)) out += "\n  " + readable_line(line, files);
    return out;
}

[[noreturn]] void fail(bool is_own, const std::string& message) {
    if (is_own) throw ShaderError(message);
    throw ContextError(message);
}

/// The features of all embedded shaders.
std::vector<std::string> embedded_features() {
    std::vector<std::string> names;
    for (const EmbeddedShader& shader : embedded_shaders) {
        std::istringstream lines{std::string(shader.text)};
        for (std::string line; std::getline(lines, line);)
            if (Feature feature = feature_of(line); !feature.macro.empty())
                names.push_back(std::move(feature.macro));
    }
    return names;
}

/// Passes give all their shaders the same macros, so a feature of another shader is none of this one's
/// mistakes.
void check_features(std::span<const Expanded> sources, const std::vector<std::string>& defines) {
    if (std::ranges::any_of(sources, &Expanded::is_own)) return;
    static const std::vector<std::string> embedded = embedded_features();
    std::vector<std::string> known = embedded;
    for (const Expanded& source : sources)
        known.insert(known.end(), source.features.begin(), source.features.end());
    for (const std::string& define : defines) {
        if (define.find(' ') != define.npos || std::ranges::find(known, define) != known.end()) continue;
        throw ArgumentError(
            fmt::format("no shader has a line '#feature {}'{}", define, did_you_mean(define, known)));
    }
}

std::string complete_text(const Expanded& source) {
    std::string text = "#version 450 core\n";
    for (const std::string& define : source.defines) text += "#define " + define + "\n";
    return text + source.text;
}

GLuint compile(GLenum stage, const Expanded& source) {
    const std::string text = complete_text(source);
    Context::with_driver();
    const GLuint shader = glCreateShader(stage);
    const char* pointer = text.c_str();
    glShaderSource(shader, 1, &pointer, nullptr);
    glCompileShader(shader);
    GLint compiled = 0, length = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled) return shader;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(size_t(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    glDeleteShader(shader);
    fail(source.is_own, fmt::format("shader {} does not compile:{}", source.shown.front(),
                                    readable_log(log.c_str(), source.shown)));
}

struct Stage {
    GLenum kind;
    const Expanded* source;
};

void link(GLuint program, std::initializer_list<Stage> stages) {
    std::vector<GLuint> shaders;
    const auto drop = [&] {
        for (const GLuint shader : shaders) {
            glDetachShader(program, shader);
            glDeleteShader(shader);
        }
    };
    std::string names;
    bool is_own = false;
    for (const Stage& stage : stages) {
        try {
            shaders.push_back(compile(stage.kind, *stage.source));
        } catch (...) {
            drop();
            throw;
        }
        glAttachShader(program, shaders.back());
        names += (names.empty() ? "" : " and ") + stage.source->shown.front();
        is_own |= stage.source->is_own;
    }
    glLinkProgram(program);
    drop();
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked) return;
    char log[4096] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    fail(is_own, fmt::format("{} {} not link: {}", stages.size() > 1 ? "shaders" : "shader",
                             stages.size() > 1 ? names + " do" : names + " does", log));
}

Expanded expanded(std::string_view name, const ShaderTexts& texts, const std::vector<std::string>& defines) {
    Expanded source{texts, defines};
    source.add(name);
    return source;
}

}  // namespace

std::string shader_source(std::string_view name) {
    if (is_path(name)) return std::string(FileBytes(fs::path(name)).text());
    if (const char* folder = std::getenv("EASYPBR_SHADER_DIR"); folder && *folder) {
        const fs::path path = fs::path(folder) / name;
        std::error_code unusable;
        if (fs::exists(path, unusable)) return std::string(FileBytes(path).text());
    }
    for (const EmbeddedShader& shader : embedded_shaders)
        if (shader.name == name) return std::string(shader.text);
    throw ArgumentError(fmt::format("there is no shader file '{}'", name.substr(0, 200)));
}

std::vector<std::string> shader_names() {
    std::vector<std::string> names;
    for (const EmbeddedShader& shader : embedded_shaders) names.emplace_back(shader.name);
    return names;
}

ShaderStage shader_stage(std::string_view name, const std::vector<std::string>& defines) {
    const ShaderTexts none;
    const Expanded source = expanded(name, none, defines);
    return {complete_text(source), source.features};
}

std::vector<fs::path> shader_files(std::string_view name) {
    const ShaderTexts none;
    const std::vector<std::string> plain;
    std::vector<fs::path> paths;
    for (const std::string& file : expanded(name, none, plain).files)
        if (is_path(file)) paths.emplace_back(file);
    return paths;
}

Program::Program(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines,
                 const ShaderTexts& texts)
    : object_(ObjectKind::program) {
    const Expanded sources[] = {expanded(vertex, texts, defines), expanded(fragment, texts, defines)};
    check_features(sources, defines);
    link(object_.id(), {{GL_VERTEX_SHADER, &sources[0]}, {GL_FRAGMENT_SHADER, &sources[1]}});
    read_uniforms();
}

Program Program::compute(std::string_view shader, const std::vector<std::string>& defines) {
    const ShaderTexts none;
    const Expanded source = expanded(shader, none, defines);
    check_features({&source, 1}, defines);
    Context::with_driver();
    Program program;
    program.object_ = Object(ObjectKind::program);
    link(program.object_.id(), {{GL_COMPUTE_SHADER, &source}});
    program.read_uniforms();
    return program;
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

void Program::set(std::string_view uniform, uint32_t value) const {
    glProgramUniform1ui(object_.id(), location(uniform), value);
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
