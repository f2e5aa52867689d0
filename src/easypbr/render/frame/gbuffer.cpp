#include "easypbr/render/frame/gbuffer.h"

#include <span>
#include <vector>

namespace easypbr::render {

GBuffer::GBuffer(Vec2i size)
    : albedo(gl::Format::rgba16, size),
      normal(gl::Format::rg16, size),
      material(gl::Format::rgba8, size),
      depth(gl::Format::r32f, size),
      radiance(gl::Format::rgba32f, size),
      emission(gl::Format::rgba32f, size) {}

void GBuffer::add_ids() {
    if (id) return;
    id = Target(gl::Format::r32ui, size());
    element = Target(gl::Format::r32ui, size());
}

void GBuffer::add_extensions() {
    if (extension[0]) return;
    for (Target& target : extension) target = Target(gl::Format::rgba32ui, size());
}

void GBuffer::add_overlay() {
    if (!overlay) overlay = Target(gl::Format::rgba16f, size());
}

void GBuffer::add_ambient_occlusion() {
    if (!ambient_occlusion) ambient_occlusion = Target(gl::Format::r16, size());
}

void GBuffer::remove_ambient_occlusion() {
    ambient_occlusion = Target();
    occluded_ = gl::Framebuffer();
}

const gl::Texture& GBuffer::depth_test() const {
    if (!depth_test_) depth_test_ = gl::Texture(gl::Format::depth32f, size().x(), size().y());
    return depth_test_;
}

const gl::Framebuffer& GBuffer::framebuffer(gl::Framebuffer& made, Attachments attachments) const {
    if (made) return made;
    std::vector<const gl::Texture*> textures;
    for (const Target* target : attachments) textures.push_back(&target->attachment());
    return made = gl::Framebuffer(textures, &depth_test());
}

const gl::Framebuffer& GBuffer::drawn(gl::Framebuffer& made, Attachments attachments) const {
    for (const Target* target : attachments) target->drawn();
    return framebuffer(made, attachments);
}

const gl::Framebuffer& GBuffer::surface() const {
    return drawn(surface_, {&albedo, &normal, &material, &depth});
}

const gl::Framebuffer& GBuffer::surface_emission() const {
    return drawn(surface_emission_, {&albedo, &normal, &material, &depth, &radiance});
}

const gl::Framebuffer& GBuffer::surface_extended() const {
    return drawn(surface_extended_,
                 {&albedo, &normal, &material, &depth, &radiance, &extension[0], &extension[1]});
}

const gl::Framebuffer& GBuffer::surface_ids() const {
    return drawn(surface_ids_, {&albedo, &normal, &material, &depth, &radiance, &id, &element});
}

const gl::Framebuffer& GBuffer::lit() const {
    return drawn(lit_, {&radiance});
}

const gl::Framebuffer& GBuffer::display() const {
    return drawn(display_, {&overlay});
}

const gl::Framebuffer& GBuffer::occluded() const {
    return drawn(occluded_, {&ambient_occlusion});
}

void GBuffer::clear(bool with_ids) const {
    const float zero[4] = {0, 0, 0, 0};
    if (with_ids) surface_ids().clear_integer(5, 0);
    if (with_ids) surface_ids().clear_integer(6, 0);
    surface().clear_color(3, zero);
    surface().clear_depth(0);
    lit().clear_color(0, zero);
}

void GBuffer::clear_layer() const {
    const float zero[4] = {0, 0, 0, 0};
    surface().clear_color(3, zero);
    surface().clear_depth(from_behind ? 1 : 0);
    lit().clear_color(0, zero);
}

void GBuffer::write(const PixelRect& area, SurfaceContents contents) const {
    for (const Target* target : {&albedo, &normal, &material, &depth}) target->write(area);
    radiance.forget();
    emission.forget();
    if (contents.emission) emission.write(area);
    for (const Target& target : extension) {
        target.forget();
        if (contents.extensions) target.write(area);
    }
    for (const Target* target : {&id, &element}) {
        target->forget();
        if (contents.ids) target->write(area);
    }
}

void GBuffer::download(Transfers& transfers) const {
    if (depth.is_ahead()) return;
    for (const Target* target : {&albedo, &normal, &material, &depth})
        target->download(target->whole(), transfers);
    // The driver keeps emission where light is added to it.
    const auto emitted = radiance.read<Vec4>(transfers);
    emission.write(emission.whole());
    std::ranges::copy(emitted, emission.pixels<Vec4>().begin());
}

void GBuffer::upload(Transfers& transfers) const {
    if (!depth.is_ahead()) return;
    const float zero[4] = {0, 0, 0, 0};
    // Beyond the rectangle nothing is drawn, and nowhere is light.
    const gl::Framebuffer& cleared = framebuffer(surface_, {&albedo, &normal, &material, &depth});
    cleared.clear_color(3, zero);
    cleared.clear_depth(0);
    framebuffer(lit_, {&radiance}).clear_color(0, zero);
    if (radiance.is_ahead()) {
        radiance.upload(transfers);
    } else {
        radiance.drawn();
        if (emission.is_ahead()) emission.copy_to(radiance.attachment(), transfers);
        for (const Target& target : extension) target.upload(transfers);
    }
    if (ambient_occlusion && ambient_occlusion.is_ahead()) {
        const float open[4] = {1, 1, 1, 1};
        framebuffer(occluded_, {&ambient_occlusion}).clear_color(0, open);
        ambient_occlusion.upload(transfers);
    }
    if (id && id.is_ahead()) {
        const gl::Framebuffer& ids =
            framebuffer(surface_ids_, {&albedo, &normal, &material, &depth, &radiance, &id, &element});
        ids.clear_integer(5, 0);
        ids.clear_integer(6, 0);
        id.upload(transfers);
        element.upload(transfers);
    }
    for (const Target* target : {&albedo, &normal, &material, &depth}) target->upload(transfers);
    depth.copy_to(depth_test(), transfers);
}

void GBuffer::release() const {
    for (const Target* target : {&albedo, &normal, &material, &depth, &radiance, &emission, &id, &element,
                                 &extension[0], &extension[1], &overlay, &ambient_occlusion})
        target->release();
}

gl::DrawState GBuffer::covered_state(const gl::Blending& blending) const {
    // The screen's triangle lies infinitely far: "less" draws it where there is geometry, and SIMD
    // rasterisers skip the rest before shading.
    if (!from_behind) return {.depth_test = gl::DepthTest::less, .blending = blending};
    return {.depth_test = gl::DepthTest::greater, .least_depth = 1, .blending = blending};
}

}  // namespace easypbr::render
