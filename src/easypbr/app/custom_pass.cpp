#include "easypbr/app/custom_pass.h"

#include <map>
#include <utility>
#include <variant>

#include "easypbr/app/pass_adapter.h"
#include "easypbr/core/hash.h"
#include "easypbr/gl/watched_program.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

constexpr const char* vertex = "screen_triangle.vert";
constexpr uint64_t odd = 0x9e3779b97f4a7c15;  ///< spreads small numbers over all bits

}  // namespace

struct FragmentShader::Parts {
    using Uniform = std::variant<int, float, Vec2, Vec3, Vec4, Mat3, Mat4>;

    gl::WatchedProgram program;
    std::map<std::string, Uniform> uniforms = {};
    uint64_t changes = 0;  ///< of uniforms

    void set(const std::string& name, const Uniform& value) {
        const auto [at, is_new] = uniforms.try_emplace(name, value);
        if (!is_new && at->second == value) return;
        at->second = value;
        ++changes;
    }
};

FragmentShader::FragmentShader(const std::filesystem::path& file)
    // Absolute, so that it is a path and not an embedded file's name.
    : parts_(new Parts{gl::WatchedProgram(vertex, std::filesystem::absolute(file).string())}) {}

FragmentShader::FragmentShader(const std::string& name, const std::string& text)
    : parts_(new Parts{gl::WatchedProgram(vertex, "pass.frag", {{"pass.frag", {name, text}}})}) {}

void FragmentShader::set(const std::string& uniform, int value) {
    parts_->set(uniform, value);
}
void FragmentShader::set(const std::string& uniform, float value) {
    parts_->set(uniform, value);
}
void FragmentShader::set(const std::string& uniform, const Vec2& value) {
    parts_->set(uniform, value);
}
void FragmentShader::set(const std::string& uniform, const Vec3& value) {
    parts_->set(uniform, value);
}
void FragmentShader::set(const std::string& uniform, const Vec4& value) {
    parts_->set(uniform, value);
}
void FragmentShader::set(const std::string& uniform, const Mat3& value) {
    parts_->set(uniform, value);
}
void FragmentShader::set(const std::string& uniform, const Mat4& value) {
    parts_->set(uniform, value);
}

uint64_t FragmentShader::revision() const {
    return parts_->program.revision() ^ (parts_->changes * odd);
}

struct PassInput::Frame {
    const render::PassInput& input;
};

const Camera& PassInput::camera() const {
    return frame_.input.frame.camera;
}

Mat4d PassInput::clip_from_view() const {
    return frame_.input.frame.clip_from_view;
}

Vec2i PassInput::size() const {
    return frame_.input.frame.size;
}

Vec2i PassInput::picture_size() const {
    return frame_.input.frame.picture_size;
}

Vec2i PassInput::origin() const {
    return frame_.input.frame.origin;
}

float PassInput::exposure() const {
    return frame_.input.frame.resolved->exposure;
}

const InferredSettings& PassInput::settings() const {
    return frame_.input.frame.resolved->settings;
}

unsigned PassInput::albedo() const {
    return frame_.input.gbuffer.albedo.texture().id();
}

unsigned PassInput::normal() const {
    return frame_.input.gbuffer.normal.texture().id();
}

unsigned PassInput::material() const {
    return frame_.input.gbuffer.material.texture().id();
}

unsigned PassInput::depth() const {
    return frame_.input.gbuffer.depth.texture().id();
}

unsigned PassInput::image() const {
    return frame_.input.image.id();
}

unsigned PassInput::before() const {
    return frame_.input.before().id();
}

void PassInput::bind() const {
    frame_.input.target.bind();
}

void PassInput::draw(const FragmentShader& shader, Blend blend) const {
    FragmentShader::Parts& parts = *shader.parts_;
    const gl::Program& program = parts.program.get(frame_.input.defines());
    for (const auto& [name, value] : parts.uniforms)
        std::visit([&, &name = name](const auto& given) { program.set(name, given); }, value);
    frame_.input.draw(program, blend);
}

ShaderPass::ShaderPass(const FragmentShader& fragment, Blend blend) : shader(fragment), blend_(blend) {}

ShaderPass::ShaderPass(const std::filesystem::path& file, Blend blend)
    : ShaderPass(FragmentShader(file), blend) {}

ShaderPass::ShaderPass(const std::string& name, const std::string& text, Blend blend)
    : ShaderPass(FragmentShader(name, text), blend) {}

void ShaderPass::draw(const PassInput& input) {
    input.draw(shader, blend_);
}

uint64_t ShaderPass::revision() const {
    return shader.revision();
}

namespace {

class RendererPass : public render::Pass {
  public:
    explicit RendererPass(std::shared_ptr<app::Pass> pass) : pass_(std::move(pass)) {}

    void draw(const render::PassInput& input) override {
        input.target.bind();
        const PassInput::Frame frame{input};
        pass_->draw(PassInput(frame));
    }
    // Passes may follow each other at one address: the number tells them apart.
    uint64_t revision() const override { return pass_->revision() ^ (number_ * odd); }

  private:
    std::shared_ptr<app::Pass> pass_;
    uint64_t number_ = next_revision();
};

}  // namespace

std::shared_ptr<render::Pass> renderer_pass(std::shared_ptr<Pass> pass) {
    return std::make_shared<RendererPass>(std::move(pass));
}

}  // namespace easypbr::app
