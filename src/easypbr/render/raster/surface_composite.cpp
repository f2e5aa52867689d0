#include "easypbr/render/raster/surface_composite.h"

namespace easypbr::render {

const GBuffer& SurfaceComposite::staging(const Frame& frame, const SurfaceOutputs& outputs) {
    if (staging_.size() != frame.size) staging_ = GBuffer(frame.size);
    if (outputs.ids) staging_.add_ids();
    if (outputs.extensions) staging_.add_extensions();
    return staging_;
}

void SurfaceComposite::draw(const Frame& frame, const GBuffer& targets, const SurfaceOutputs& outputs,
                            Transfers& transfers) {
    const PixelRect area = staging_.depth.area();
    const bool emission = staging_.emission.is_ahead(), extensions = staging_.extension[0].is_ahead();
    staging_.upload(transfers);
    copy(frame, staging_, area, targets, outputs, {.emission = emission, .extensions = extensions});
}

void SurfaceComposite::draw_over(const Frame& frame, const GBuffer& source, const GBuffer& targets,
                                 const SurfaceOutputs& outputs) {
    copy(frame, source, frame.whole(), targets, outputs,
         {.always = true, .emission = true, .extensions = outputs.extensions != 0});
}

namespace {

/// Binds what a G-buffer holds to the units and samplers of shaders that read surfaces.
void bind_surface(const gl::Program& program, const Frame& frame, const GBuffer& source, bool ids) {
    program.set("u_size", Vec2(frame.size.cast<float>()));
    const Target* sources[] = {&source.albedo,   &source.normal, &source.material, &source.depth,
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
                            const GBuffer& targets, const SurfaceOutputs& outputs, How how) {
    if (r.width == 0 || r.height == 0) return;
    std::vector<std::string> defines;
    if (outputs.ids) defines.emplace_back("OBJECT_ID");
    if (how.emission) defines.emplace_back("WITH_EMISSION");
    if (how.extensions) defines.emplace_back("WITH_EXTENSION");
    const gl::Program& program = programs_.get(defines);
    (outputs.ids      ? targets.surface_ids()
     : how.extensions ? targets.surface_extended()
                      : targets.surface_emission())
        .bind();
    program.use();
    bind_surface(program, frame, source, outputs.ids);
    for (unsigned i = 0; how.extensions && i < 2; ++i) {
        source.extension[i].bind(7 + i);
        program.set(i == 0 ? "u_extension0" : "u_extension1", int(7 + i));
    }
    gl::DrawState state = screen_state(r);
    state.depth_test = how.always ? gl::DepthTest::always : gl::DepthTest::greater;
    state.write_depth = true;
    gl::draw_screen(state);
}

void SurfaceComposite::fill_holes(const Frame& frame, const GBuffer& targets, const SurfaceOutputs& outputs,
                                  int times) {
    staging(frame, outputs);
    std::vector<std::string> defines;
    if (frame.orthographic()) defines.emplace_back("ORTHOGRAPHIC");
    if (outputs.ids) defines.emplace_back("OBJECT_ID");
    for (int i = 0; i < times; ++i) {
        staging_.clear(outputs.ids);
        const gl::Program& program = fill_.get(defines);
        (outputs.ids ? staging_.surface_ids() : staging_.surface()).bind();
        program.use();
        bind_surface(program, frame, targets, outputs.ids);
        program.set("u_depth", Vec3(float(frame.camera.near), float(frame.camera.far), 0));
        gl::draw_screen({.depth_test = gl::DepthTest::always, .write_depth = true});
        copy(frame, staging_, frame.whole(), targets, outputs, {});
    }
}

}  // namespace easypbr::render
