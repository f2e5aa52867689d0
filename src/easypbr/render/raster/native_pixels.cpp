#include "easypbr/render/raster/native_pixels.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "easypbr/core/octahedral.h"

namespace easypbr::render {
namespace {

uint16_t unorm16(float v) {
    return uint16_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 65535.0f));
}
uint8_t unorm8(float v) {
    return uint8_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

}  // namespace

void NativePixels::resize(const PixelRect& area, bool with_ids) {
    area_ = area;
    with_ids_ = with_ids;
    const size_t count = size_t(area.width) * size_t(area.height);
    albedo_.resize(count * 4);
    normal_.resize(count * 2);
    material_.resize(count * 4);
    depth_.resize(count);
    id_.resize(with_ids ? count : 0);
    element_.resize(with_ids ? count : 0);
}

void NativePixels::put(size_t i, const SurfacePixel& p) {
    const Vec2 normal = oct_encode(p.normal) * 0.5f + Vec2(0.5f, 0.5f);
    depth_[i] = p.depth;
    for (size_t c = 0; c < 3; ++c) albedo_[4 * i + c] = unorm16(p.albedo[Eigen::Index(c)]);
    albedo_[4 * i + 3] = 65535;
    normal_[2 * i] = unorm16(normal.x());
    normal_[2 * i + 1] = unorm16(normal.y());
    const uint8_t material[4] = {unorm8(p.metallic), unorm8(p.roughness), 255, uint8_t(p.kind)};
    std::copy_n(material, 4, &material_[4 * i]);
    if (!with_ids_) return;
    id_[i] = p.object + 1;
    element_[i] = (p.element + 1) | (p.is_point ? point_element : 0);
}

void NativePixels::put_nothing(size_t i) {
    depth_[i] = 0;
    if (with_ids_) id_[i] = element_[i] = 0;
}

void NativePixels::upload(const GBuffer& targets) const {
    if (area_.width == 0 || area_.height == 0) return;
    const auto put = [&](const gl::Texture& texture, const auto& values) {
        texture.upload_area(area_.x, area_.y, area_.width, area_.height, std::as_bytes(std::span(values)));
    };
    put(targets.albedo, albedo_);
    put(targets.normal, normal_);
    put(targets.material, material_);
    put(targets.depth, depth_);
    put(targets.depth_test, depth_);
    if (!with_ids_) return;
    put(targets.id, id_);
    put(targets.element, element_);
}

void SurfaceComposite::make_staging(const Frame& frame, const SurfaceOutputs& outputs) {
    if (!staging_.albedo || staging_.size() != frame.size) staging_ = GBuffer(frame.size);
    if (outputs.ids) staging_.add_ids();
}

void SurfaceComposite::draw(const Frame& frame, const NativePixels& pixels, const GBuffer& targets,
                            const SurfaceOutputs& outputs) {
    make_staging(frame, outputs);
    pixels.upload(staging_);
    copy(frame, staging_, pixels.area(), targets, outputs, false);
}

void SurfaceComposite::draw_over(const Frame& frame, const GBuffer& source, const GBuffer& targets,
                                 const SurfaceOutputs& outputs) {
    copy(frame, source, frame.whole(), targets, outputs, true);
}

namespace {

/// Binds what a G-buffer holds to the units and samplers of shaders that read surfaces.
void bind_surface(const gl::Program& program, const Frame& frame, const GBuffer& source, bool ids) {
    program.set("u_size", Vec2(frame.size.cast<float>()));
    const gl::Texture* sources[] = {&source.albedo,   &source.normal, &source.material, &source.depth,
                                    &source.radiance, &source.id,     &source.element};
    const char* samplers[] = {"u_albedo",   "u_normal", "u_material", "u_depth_target",
                              "u_emission", "u_id",     "u_element"};
    for (unsigned unit = 0; unit < (ids ? 7u : 5u); ++unit) {
        sources[unit]->bind(unit);
        program.set(samplers[unit], int(unit));
    }
}

}  // namespace

void SurfaceComposite::copy(const Frame& frame, const GBuffer& source, const PixelRect& r,
                            const GBuffer& targets, const SurfaceOutputs& outputs, bool always) {
    if (r.width == 0 || r.height == 0) return;
    std::vector<std::string> defines;
    if (outputs.ids) defines.emplace_back("OBJECT_ID");
    if (always) defines.emplace_back("WITH_EMISSION");
    // What was found natively has no extensions.
    const bool extended = always && outputs.extensions;
    if (extended) defines.emplace_back("WITH_EXTENSION");
    const gl::Program& program = programs_.get(defines);
    (outputs.ids ? targets.surface_ids
     : extended  ? targets.surface_extended
                 : targets.surface_emission)
        .bind();
    program.use();
    bind_surface(program, frame, source, outputs.ids);
    for (unsigned i = 0; extended && i < 2; ++i) {
        source.extension[i].bind(7 + i);
        program.set(i == 0 ? "u_extension0" : "u_extension1", int(7 + i));
    }
    gl::DrawState state = screen_state(r);
    state.depth_test = always ? gl::DepthTest::always : gl::DepthTest::greater;
    state.write_depth = true;
    gl::draw_screen(state);
}

void SurfaceComposite::fill_holes(const Frame& frame, const GBuffer& targets, const SurfaceOutputs& outputs,
                                  int times) {
    make_staging(frame, outputs);
    std::vector<std::string> defines;
    if (frame.orthographic()) defines.emplace_back("ORTHOGRAPHIC");
    if (outputs.ids) defines.emplace_back("OBJECT_ID");
    for (int i = 0; i < times; ++i) {
        staging_.clear(outputs.ids);
        const gl::Program& program = fill_.get(defines);
        (outputs.ids ? staging_.surface_ids : staging_.surface).bind();
        program.use();
        bind_surface(program, frame, targets, outputs.ids);
        program.set("u_depth", Vec3(float(frame.camera.near), float(frame.camera.far), 0));
        gl::draw_screen({.depth_test = gl::DepthTest::always, .write_depth = true});
        copy(frame, staging_, frame.whole(), targets, outputs, false);
    }
}

}  // namespace easypbr::render
