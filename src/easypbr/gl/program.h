// Shader programs from the embedded GLSL files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/gl/object.h"

namespace easypbr::gl {

/// Text of an embedded shader file, or of the file of that name in $EASYPBR_SHADER_DIR where that is set; a
/// name with a folder in it is the path of a file. Throws ArgumentError when there is none, FileError.
std::string shader_source(std::string_view name);

/// The names of the embedded shader files.
std::vector<std::string> shader_names();

/// The files on disk, and not the embedded ones, that a shader is read from, those it includes too. An
/// included file is looked for beside the one that includes it, then among the embedded ones.
std::vector<std::filesystem::path> shader_files(std::string_view name);

/// GLSL of a program's own, and what messages call it.
struct ShaderText {
    std::string name, text;
};
/// They stand in for the shader files of these names.
using ShaderTexts = std::map<std::string, ShaderText, std::less<>>;

/// What a driver compiles of a shader file with these macros, see Program: all that it includes, complete.
struct ShaderStage {
    std::string text;
    std::vector<std::string> features;  ///< the macros of its lines #feature
};
/// Throws as shader_source() does.
ShaderStage shader_stage(std::string_view name, const std::vector<std::string>& defines = {});

/// A linked vertex and fragment shader, or a compute shader. Uniforms that the linker removed are silently
/// ignored when they are set.
class Program {
  public:
    Program() = default;
    /// Names of shader files and `NAME` or `NAME VALUE` macros.
    /// - `#include "file"` puts a file's text in place of the line where a stage includes it first, and
    /// nothing
    ///   later: a file needs no guard. One that is included within #if must not be included again.
    /// - `#feature NAME constant` declares `const bool constant`, true where the macro NAME is given: the
    ///   compiler removes what stands in an `if (constant)` that is false.
    /// Throws ArgumentError for a macro without a value that no shader of the library declares as a feature,
    /// unless the program has texts or files of its own; ContextError with file:line for every compiler
    /// message; ShaderError when texts or files of a program's own are among what does not compile.
    Program(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines = {},
            const ShaderTexts& texts = {});

    /// A compute shader; the same macros and errors.
    static Program compute(std::string_view shader, const std::vector<std::string>& defines = {});

    void use() const;
    /// Whether the linker left a uniform of this name.
    bool has(std::string_view uniform) const { return location(uniform) >= 0; }

    void set(std::string_view uniform, int value) const;
    void set(std::string_view uniform, uint32_t value) const;
    void set(std::string_view uniform, float value) const;
    void set(std::string_view uniform, const Vec2& value) const;
    void set(std::string_view uniform, const Vec3& value) const;
    void set(std::string_view uniform, const Vec4& value) const;
    void set(std::string_view uniform, const Mat3& value) const;
    void set(std::string_view uniform, const Mat4& value) const;

    explicit operator bool() const { return bool(object_); }

  private:
    int location(std::string_view uniform) const;
    void read_uniforms();

    Object object_;
    std::map<std::string, int, std::less<>> locations_;
};

}  // namespace easypbr::gl
