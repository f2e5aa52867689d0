// Passes of a program's own between those of the renderer: they read the G-buffer and draw into the picture.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "easypbr/core/math.h"
#include "easypbr/core/picture.h"
#include "easypbr/scene/camera.h"

namespace easypbr {
struct InferredSettings;
}

namespace easypbr::app {

using easypbr::Blend;
using easypbr::Stage;

/// A fragment shader that is drawn over a whole image, with values for its uniforms. GLSL 4.50 without the
/// line of the version; `#include "file"` finds files beside it and those of the library
/// (docs/extending.md). It is compiled when it is drawn for the first time. Copies are the same shader.
class FragmentShader {
  public:
    /// The path of a file, read again whenever it changes. Throws FileError when it cannot be read.
    explicit FragmentShader(const std::filesystem::path& file);
    /// A text; `name` is what messages call it.
    FragmentShader(const std::string& name, const std::string& text);

    // Moving copies: a handle always has its object.
    FragmentShader(const FragmentShader& other) = default;
    FragmentShader& operator=(const FragmentShader& other) = default;

    /// The value of a uniform from now on. One that the shader does not have is ignored.
    void set(const std::string& uniform, int value);
    void set(const std::string& uniform, float value);
    void set(const std::string& uniform, const Vec2& value);
    void set(const std::string& uniform, const Vec3& value);
    void set(const std::string& uniform, const Vec4& value);
    void set(const std::string& uniform, const Mat3& value);
    void set(const std::string& uniform, const Mat4& value);

    /// Another number whenever the file or the value of a uniform has changed.
    uint64_t revision() const;

  private:
    friend class PassInput;
    struct Parts;
    std::shared_ptr<Parts> parts_;
};

/// What a pass draws with: a frame, or a tile of one. Textures are OpenGL's names of 2D textures, of the
/// size of the frame; row 0 is the top of the picture. Valid while the pass draws.
class PassInput {
  public:
    struct Frame;
    explicit PassInput(const Frame& frame) : frame_(frame) {}

    /// Of this frame: where an accumulated image samples lens or shutter, it moves.
    const Camera& camera() const;
    /// To clip space, of this frame or tile: depth from 1 (near) to 0, y down, offset by the sample's place
    /// within the pixel.
    Mat4d clip_from_view() const;
    /// Of the textures, pixels.
    Vec2i size() const;
    /// The whole picture's size; the textures hold `size()` of its pixels from `origin()` on.
    Vec2i picture_size() const;
    Vec2i origin() const;
    /// Factor on radiance before the tone curve.
    float exposure() const;
    const InferredSettings& settings() const;

    // The G-buffer of the opaque surfaces. In stage `picture` that of the last frame, which was drawn within
    // half a pixel of the pixels' centres.

    /// RGBA16: linear base colour.
    unsigned albedo() const;
    /// RG16: octahedral world normal, towards the viewer's side of a two-sided surface.
    unsigned normal() const;
    /// RGBA8: metallic, roughness, ambient occlusion of the material; a: for the library's own use.
    unsigned material() const;
    /// R32F: reversed depth, near / z for perspective, 0 where there is nothing.
    unsigned depth() const;

    /// What is drawn into; reading it meanwhile is undefined.
    unsigned image() const;
    /// The image as it is before this pass draws: a copy.
    unsigned before() const;

    /// Binds a framebuffer with the image alone for drawing, with the viewport on all of it. It is bound when
    /// the pass is called.
    void bind() const;

    /// Draws the shader over the whole image. Of the uniforms that it has, its own values are set, and these:
    /// those of common_camera.glsl (u_size among them), u_albedo, u_normal, u_material, u_depth_target,
    /// u_image (before()), u_exposure, u_origin and u_picture_size. Throws ShaderError with the line of what
    /// does not compile.
    void draw(const FragmentShader& shader, Blend blend = Blend::over) const;

  private:
    const Frame& frame_;
};

/// A pass of a program's own. It is called with the context current and may use any OpenGL 4.5, by a loader
/// of its own (libepoxy, glad, eglGetProcAddress); whatever state it leaves behind, the renderer sets back
/// what it needs. A pass ends conditional rendering and transform feedback that it begins.
class Pass {
  public:
    virtual ~Pass() = default;
    /// What it throws ends the picture; windows show it and keep the last picture that there was. Other
    /// viewers may draw meanwhile. Another picture of the one that calls it is an ArgumentError; a pass must
    /// not wait for a thread that draws one.
    virtual void draw(const PassInput& input) = 0;
    /// Changes whenever the pass would draw something else: windows draw again then.
    virtual uint64_t revision() const { return 0; }
};

/// A pass of one fragment shader.
class ShaderPass : public Pass {
  public:
    explicit ShaderPass(const FragmentShader& fragment, Blend blend = Blend::over);
    /// As FragmentShader takes them.
    explicit ShaderPass(const std::filesystem::path& file, Blend blend = Blend::over);
    ShaderPass(const std::string& name, const std::string& text, Blend blend = Blend::over);
    void draw(const PassInput& input) override;
    uint64_t revision() const override;

    FragmentShader shader;

  private:
    Blend blend_;
};

}  // namespace easypbr::app
