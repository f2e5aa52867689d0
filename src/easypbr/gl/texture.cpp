#include "easypbr/gl/texture.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/gl/context.h"
#include "easypbr/gl/pace.h"

namespace easypbr::gl {
namespace {

struct FormatInfo {
    GLenum internal, layout, type;
    size_t bytes;
};

FormatInfo info(Format format) {
    switch (format) {
        case Format::r8:
            return {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1};
        case Format::rg8:
            return {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, 2};
        case Format::rgba8:
            return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
        case Format::srgb8_alpha8:
            return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
        case Format::rg16:
            return {GL_RG16, GL_RG, GL_UNSIGNED_SHORT, 4};
        case Format::r16:
            return {GL_R16, GL_RED, GL_UNSIGNED_SHORT, 2};
        case Format::rgba16:
            return {GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT, 8};
        case Format::r32f:
            return {GL_R32F, GL_RED, GL_FLOAT, 4};
        case Format::r16f:
            return {GL_R16F, GL_RED, GL_HALF_FLOAT, 2};
        case Format::rgba16f:
            return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8};
        case Format::rgba32f:
            return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
        case Format::rg16f:
            return {GL_RG16F, GL_RG, GL_HALF_FLOAT, 4};
        case Format::r32ui:
            return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
        case Format::rgba32ui:
            return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16};
        case Format::depth32f:
            return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
    }
    return {};
}

GLenum gl_wrap(Wrapping wrapping) {
    return wrapping == Wrapping::repeat   ? GL_REPEAT
           : wrapping == Wrapping::mirror ? GL_MIRRORED_REPEAT
                                          : GL_CLAMP_TO_EDGE;
}

}  // namespace

size_t pixel_bytes(Format format) {
    return info(format).bytes;
}

int full_levels(int width, int height) {
    return int(std::bit_width(unsigned(std::max(width, height))));
}

Texture::Texture(Format format, int width, int height, int levels, TextureKind kind)
    : format_(format), kind_(kind), width_(width), height_(height) {
    const int limit = Context::with_driver().info().max_texture_size;
    if (width < 1 || height < 1 || width > limit || height > limit)
        throw ContextError(fmt::format("a picture of {}x{} is beyond this driver's limit of {}x{}", width,
                                       height, limit, limit));
    object_ = Object(ObjectKind::texture, kind == TextureKind::cube ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D);
    glTextureStorage2D(id(), levels, info(format).internal, width, height);
    glTextureParameteri(id(), GL_TEXTURE_MAX_LEVEL, levels - 1);
    sampling(Filtering::nearest);
}

Texture Texture::layered(Format format, int width, int height, int layers) {
    const int limit = Context::with_driver().info().max_texture_size;
    GLint most_layers = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most_layers);
    if (std::min({width, height, layers}) < 1 || std::max(width, height) > limit || layers > most_layers)
        throw ContextError(fmt::format("{} layers of {}x{} are beyond this driver's limit of {} of {}x{}",
                                       layers, width, height, most_layers, limit, limit));
    Texture texture;
    texture.format_ = format;
    texture.kind_ = TextureKind::array;
    texture.width_ = width;
    texture.height_ = height;
    texture.layers_ = layers;
    texture.object_ = Object(ObjectKind::texture, GL_TEXTURE_2D_ARRAY);
    glTextureStorage3D(texture.id(), 1, info(format).internal, width, height, layers);
    glTextureParameteri(texture.id(), GL_TEXTURE_MAX_LEVEL, 0);
    texture.sampling(Filtering::nearest);
    return texture;
}

void Texture::upload(std::span<const std::byte> pixels, int level, int face) {
    const FormatInfo f = info(format_);
    const int w = std::max(1, width_ >> level), h = std::max(1, height_ >> level);
    if (pixels.size() != size_t(w) * h * f.bytes)
        throw ArgumentError(
            fmt::format("texture upload: expected {} bytes, got {}", size_t(w) * h * f.bytes, pixels.size()));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (kind_ != TextureKind::flat)
        glTextureSubImage3D(id(), level, 0, 0, face, w, h, 1, f.layout, f.type, pixels.data());
    else
        glTextureSubImage2D(id(), level, 0, 0, w, h, f.layout, f.type, pixels.data());
}

void Texture::upload_u8(std::span<const std::byte> pixels, int channels, int level) {
    const int w = std::max(1, width_ >> level), h = std::max(1, height_ >> level);
    if (pixels.size() != size_t(w) * size_t(h) * size_t(channels))
        throw ArgumentError(fmt::format("texture upload: expected {} bytes, got {}",
                                        size_t(w) * size_t(h) * size_t(channels), pixels.size()));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(id(), level, 0, 0, w, h, channels == 3 ? GL_RGB : GL_RGBA, GL_UNSIGNED_BYTE,
                        pixels.data());
}

void Texture::upload_area(int x, int y, int width, int height, std::span<const std::byte> pixels) const {
    const FormatInfo f = info(format_);
    if (pixels.size() != size_t(width) * size_t(height) * f.bytes)
        throw ArgumentError(fmt::format("texture upload: expected {} bytes, got {}",
                                        size_t(width) * size_t(height) * f.bytes, pixels.size()));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(id(), 0, x, y, width, height, f.layout, f.type, pixels.data());
}

void Texture::sampling(Filtering filtering, Wrapping u, Wrapping v, float anisotropy) const {
    constexpr GLenum min_filters[] = {GL_NEAREST, GL_LINEAR, GL_LINEAR_MIPMAP_NEAREST,
                                      GL_LINEAR_MIPMAP_LINEAR};
    const GLenum min = min_filters[int(filtering)];
    glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, GLint(min));
    glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER,
                        filtering == Filtering::nearest ? GL_NEAREST : GL_LINEAR);
    glTextureParameteri(id(), GL_TEXTURE_WRAP_S, GLint(gl_wrap(u)));
    glTextureParameteri(id(), GL_TEXTURE_WRAP_T, GLint(gl_wrap(v)));
    if (anisotropy > 1 && epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic"))
        glTextureParameterf(id(), GL_TEXTURE_MAX_ANISOTROPY_EXT, anisotropy);
}

void Texture::show_levels(int first, int last) const {
    glTextureParameteri(id(), GL_TEXTURE_BASE_LEVEL, first);
    glTextureParameteri(id(), GL_TEXTURE_MAX_LEVEL, last);
}

void Texture::bind(unsigned unit) const {
    glBindTextureUnit(unit, id());
}

Framebuffer::Framebuffer(std::span<const Texture* const> colors, const Texture* depth)
    : object_(ObjectKind::framebuffer) {
    std::vector<GLenum> targets;
    for (const Texture* color : colors) {
        targets.push_back(GL_COLOR_ATTACHMENT0 + GLenum(targets.size()));
        glNamedFramebufferTexture(object_.id(), targets.back(), color->id(), 0);
    }
    if (depth) glNamedFramebufferTexture(object_.id(), GL_DEPTH_ATTACHMENT, depth->id(), 0);
    glNamedFramebufferDrawBuffers(object_.id(), GLsizei(targets.size()), targets.data());
    const Texture& first = colors.empty() ? *depth : *colors.front();
    width_ = first.width();
    height_ = first.height();
    require_complete();
}

void Framebuffer::attach(std::span<const Texture* const> colors, const Texture* depth) {
    std::vector<uint64_t> serials{depth ? depth->serial() : 0};
    for (const Texture* color : colors) serials.push_back(color->serial());
    if (object_ && attached_ == serials) return;
    *this = Framebuffer(colors, depth);
    attached_ = std::move(serials);
}

Framebuffer::Framebuffer(std::initializer_list<const Texture*> arrays, int layer)
    : object_(ObjectKind::framebuffer),
      width_((*arrays.begin())->width()),
      height_((*arrays.begin())->height()) {
    std::vector<GLenum> targets;
    for (const Texture* array : arrays) {
        targets.push_back(GL_COLOR_ATTACHMENT0 + GLenum(targets.size()));
        glNamedFramebufferTextureLayer(object_.id(), targets.back(), array->id(), 0, layer);
    }
    glNamedFramebufferDrawBuffers(object_.id(), GLsizei(targets.size()), targets.data());
    require_complete();
}

Framebuffer Framebuffer::of_level(const Texture& texture, int level) {
    Framebuffer framebuffer;
    framebuffer.object_ = Object(ObjectKind::framebuffer);
    framebuffer.width_ = std::max(1, texture.width() >> level);
    framebuffer.height_ = std::max(1, texture.height() >> level);
    glNamedFramebufferTexture(framebuffer.object_.id(), GL_COLOR_ATTACHMENT0, texture.id(), level);
    framebuffer.require_complete();
    return framebuffer;
}

void Framebuffer::require_complete() const {
    const GLenum status = glCheckNamedFramebufferStatus(object_.id(), GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw ContextError(fmt::format(
            "this driver cannot draw to the render targets (framebuffer status 0x{:04x})", status));
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, object_.id());
    glViewport(0, 0, width_, height_);
}

namespace {

/// Clears obey what the draw before set.
void write_everything() {
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
}

}  // namespace

void Framebuffer::clear_color(unsigned index, const float (&rgba)[4]) const {
    write_everything();
    glClearNamedFramebufferfv(object_.id(), GL_COLOR, GLint(index), rgba);
}

void Framebuffer::clear_integer(unsigned index, unsigned value) const {
    write_everything();
    const GLuint values[4] = {value, value, value, value};
    glClearNamedFramebufferuiv(object_.id(), GL_COLOR, GLint(index), values);
}

void Framebuffer::clear_depth(float depth) const {
    write_everything();
    glClearNamedFramebufferfv(object_.id(), GL_DEPTH, 0, &depth);
}

void Framebuffer::read_to(unsigned index, Format format, int x, int y, int width, int height,
                          void* to) const {
    const FormatInfo f = info(format);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, object_.id());
    glReadBuffer(GL_COLOR_ATTACHMENT0 + index);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(x, y, width, height, f.layout, f.type, to);
}

void Framebuffer::read(unsigned index, Format format, int x, int y, int width, int height,
                       std::span<std::byte> pixels) const {
    if (pixels.size() < size_t(width) * height * pixel_bytes(format))
        throw ArgumentError("framebuffer read: the buffer is too small");
    wait_for_driver();
    read_to(index, format, x, y, width, height, pixels.data());
}

void Framebuffer::read_to_bound_buffer(unsigned index, Format format, int x, int y, int width,
                                       int height) const {
    read_to(index, format, x, y, width, height, nullptr);
}

void copy_layers(const Texture& from, const Texture& to, int layers) {
    glCopyImageSubData(from.id(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, to.id(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0,
                       from.width(), from.height(), layers);
}

void copy(const Texture& from, const Texture& to) {
    glCopyImageSubData(from.id(), GL_TEXTURE_2D, 0, 0, 0, 0, to.id(), GL_TEXTURE_2D, 0, 0, 0, 0, from.width(),
                       from.height(), 1);
}

}  // namespace easypbr::gl
