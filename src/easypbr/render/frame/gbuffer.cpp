#include "easypbr/render/frame/gbuffer.h"

namespace easypbr::render {

GBuffer::GBuffer(Vec2i size) {
    const int w = size.x(), h = size.y();
    albedo = gl::Texture(gl::Format::rgba16, w, h);
    normal = gl::Texture(gl::Format::rg16, w, h);
    material = gl::Texture(gl::Format::rgba8, w, h);
    depth = gl::Texture(gl::Format::r32f, w, h);
    depth_test = gl::Texture(gl::Format::depth32f, w, h);
    radiance = gl::Texture(gl::Format::rgba32f, w, h);
    surface = gl::Framebuffer({&albedo, &normal, &material, &depth}, &depth_test);
    surface_emission = gl::Framebuffer({&albedo, &normal, &material, &depth, &radiance}, &depth_test);
    lit = gl::Framebuffer({&radiance}, &depth_test);
}

void GBuffer::add_ids() {
    if (id) return;
    id = gl::Texture(gl::Format::r32ui, albedo.width(), albedo.height());
    element = gl::Texture(gl::Format::r32ui, albedo.width(), albedo.height());
    surface_ids =
        gl::Framebuffer({&albedo, &normal, &material, &depth, &radiance, &id, &element}, &depth_test);
}

void GBuffer::add_extensions() {
    if (extension[0]) return;
    for (gl::Texture& texture : extension)
        texture = gl::Texture(gl::Format::rgba32ui, albedo.width(), albedo.height());
    surface_extended = gl::Framebuffer(
        {&albedo, &normal, &material, &depth, &radiance, &extension[0], &extension[1]}, &depth_test);
}

void GBuffer::add_overlay() {
    if (overlay) return;
    overlay = gl::Texture(gl::Format::rgba16f, albedo.width(), albedo.height());
    display = gl::Framebuffer({&overlay}, &depth_test);
}

void GBuffer::clear(bool with_ids) const {
    const float zero[4] = {0, 0, 0, 0};
    if (with_ids) surface_ids.clear_integer(5, 0);
    if (with_ids) surface_ids.clear_integer(6, 0);
    surface.clear_color(3, zero);
    surface.clear_depth(0);
    lit.clear_color(0, zero);
}

void GBuffer::clear_layer() const {
    const float zero[4] = {0, 0, 0, 0};
    surface.clear_color(3, zero);
    surface.clear_depth(from_behind ? 1 : 0);
    lit.clear_color(0, zero);
}

gl::DrawState GBuffer::covered_state(const gl::Blending& blending) const {
    // The screen's triangle lies infinitely far: "less" draws it where there is geometry, and SIMD
    // rasterisers skip the rest before shading.
    if (!from_behind) return {.depth_test = gl::DepthTest::less, .blending = blending};
    return {.depth_test = gl::DepthTest::greater, .least_depth = 1, .blending = blending};
}

void GBuffer::add_ambient_occlusion() {
    if (ambient_occlusion) return;
    ambient_occlusion = gl::Texture(gl::Format::r16, albedo.width(), albedo.height());
    occluded = gl::Framebuffer({&ambient_occlusion}, &depth_test);
}

void GBuffer::remove_ambient_occlusion() {
    ambient_occlusion = gl::Texture();
    occluded = gl::Framebuffer();
}

}  // namespace easypbr::render
