#include "easypbr/render/gbuffer.h"

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

void GBuffer::add_overlay() {
    if (overlay) return;
    overlay = gl::Texture(gl::Format::rgba16f, albedo.width(), albedo.height());
    display = gl::Framebuffer({&overlay}, &depth_test);
}

void GBuffer::clear_ids() const {
    surface_ids.clear_integer(5, 0);
    surface_ids.clear_integer(6, 0);
}

}  // namespace easypbr::render
