// Shader programs from the embedded GLSL files.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/gl/object.h"

namespace easypbr::gl {

/// Text of an embedded shader file, or of the file of that name in $EASYPBR_SHADER_DIR where that is set.
/// Throws ArgumentError when there is none.
std::string shader_source(std::string_view name);

/// A linked vertex and fragment shader. Uniforms that the linker removed are silently ignored when they are
/// set.
class Program {
  public:
    Program() = default;
    /// Names of shader files and `NAME` or `NAME VALUE` macros. `#include "file"` works, once per file.
    /// Throws ContextError with file:line for every compiler message.
    Program(std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines = {});

    void use() const;

    void set(std::string_view uniform, int value) const;
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
