// Shaders that shade each pixel of a picture: by the driver, or natively from and to host memory.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "easypbr/gl/buffer.h"
#include "easypbr/gl/draw.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/frame/target.h"

namespace easypbr::render {

/// What a shader reads, by the names of its uniforms. Targets and textures must live until it has run.
class ShaderInputs {
  public:
    /// `NAME`, a feature that is on, or `NAME VALUE`, a macro of the driver's text.
    void define(std::string_view macro) { defines_.emplace_back(macro); }
    void define(const std::vector<std::string>& macros) {
        defines_.insert(defines_.end(), macros.begin(), macros.end());
    }

    using Value = std::variant<int, float, Vec2, Vec3, Vec4, Mat3, const Target*, const gl::Texture*,
                               native::View, native::Cube, native::Panorama, native::Layers, native::Layers4,
                               native::MipPicture, native::Texture>;
    template <class T>
    void set(std::string name, const T& value) {
        add(std::move(name), Value(value));
    }
    void set(std::string name, const Target& target) { add(std::move(name), Value(&target)); }
    void set(std::string name, const gl::Texture& texture) { add(std::move(name), Value(&texture)); }
    /// A uniform block, by its binding and the name of its member.
    void set_block(unsigned binding, std::string member, std::span<const std::byte> bytes) {
        blocks_.push_back({binding, std::move(member), {bytes.begin(), bytes.end()}});
    }

    /// Sets what a program reads, textures on units from 0 on; those of targets must be up to date. Returns
    /// the first unit that is free. The program must be in use.
    unsigned bind(const gl::Program& program) const;
    /// For native shaders; lives as long as this. Targets are downloaded where they are not in host memory.
    native::Inputs native(Transfers& transfers) const;

  private:
    friend class ScreenShader;
    void add(std::string name, Value value);
    struct Block {
        unsigned binding;
        std::string member;
        std::vector<std::byte> bytes;
    };
    std::vector<std::string> defines_;
    std::vector<std::pair<std::string, Value>> values_;
    std::vector<Block> blocks_;
};

/// Where a native shader writes.
struct NativeOutput {
    const Target* target = nullptr;  ///< held in host memory: Target::write() has been called
    PixelRect area = {};             ///< inside of what it holds
    native::Store store = native::Store::replace;
    float kept = 0;  ///< for Store::mix
    native::Where where = native::Where::everywhere;
    const Target* depth = nullptr;  ///< its first channel, of floats; not needed everywhere
    std::array<const Target*, native::most_outputs - 1> further = {};  ///< other outputs; they hold the same
};

class ScreenShader {
  public:
    /// The name of a fragment shader, and its native form, where it has one.
    explicit ScreenShader(std::string fragment, std::optional<native::Shader> shader = {})
        : programs_("screen_triangle.vert", std::move(fragment)), native_(shader) {}

    /// Draws to the framebuffer that is bound. Targets that it reads must be in their textures.
    void draw(const ShaderInputs& inputs, const gl::DrawState& state);
    /// Shades natively. Targets that it reads are downloaded where they are not in host memory.
    void shade(const ShaderInputs& inputs, const NativeOutput& output, Transfers& transfers);

  private:
    ProgramVariants programs_;
    std::optional<native::Shader> native_;
    std::vector<gl::Buffer> blocks_;  ///< by binding
};

/// What a native shader writes; the depth is downloaded where it is not in host memory.
native::Region region_of(const NativeOutput& output, Transfers& transfers);

/// The host memory of a target, for native shaders.
native::View view_of(const Target& target);

}  // namespace easypbr::render
