#include "easypbr/render/primitives/points/point_pass.h"

#include "easypbr/render/primitives/points/point_splats.h"

namespace easypbr::render {

void PointPass::draw(const Frame& frame, std::span<const DrawItem> items, const GBuffer& targets,
                     const SurfaceOutputs& outputs) {
    if (items.empty()) return;
    (outputs.ids ? targets.surface_ids() : targets.surface_emission()).bind();
    draw_items(frame, items, outputs, false);
    draw_items(frame, items, outputs, true);
}

void PointPass::draw_items(const Frame& frame, std::span<const DrawItem> items, const SurfaceOutputs& outputs,
                           bool write) {
    const gl::DrawState largest_at_depth{.depth_test = gl::DepthTest::equal, .blending = gl::maximum};
    const gl::DrawState state = write ? largest_at_depth : geometry_state(outputs);
    const Mat3 world_from_view = frame.camera.T_world_cam.linear().cast<float>();
    for (const DrawItem& item : items) {
        const PointBuffers& buffers = cache_.get(item.mesh());
        const PointSplats splats = splats_of(item, frame, spacings_);
        std::vector<std::string> defines = camera_defines(frame);
        if (buffers.normals) defines.emplace_back("NORMAL");
        if (item.with_colors) defines.emplace_back("VERTEX_COLOR");
        if (splats.round) defines.emplace_back("ROUND");
        if (outputs.ids) defines.emplace_back("OBJECT_ID");
        if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
        if (item.alpha == AlphaMode::blend)
            defines.emplace_back(outputs.peel ? "ALPHA_BLEND" : "ALPHA_STOCHASTIC");
        if (outputs.peel) defines.emplace_back("PEEL");
        const gl::Program& program = programs_.get(defines);
        program.use();
        const Mat4d mesh_matrix = item.object->T_world_mesh.matrix();
        const Mat3d linear = mesh_matrix.topLeftCorner<3, 3>();
        const Material& m = item.material;
        program.set("u_clip_from_mesh", splats.clip_from_mesh);
        program.set("u_view_from_mesh", Mat4((frame.camera.view() * mesh_matrix).cast<float>()));
        program.set("u_world_from_view", world_from_view);
        program.set("u_normal_from_mesh", Mat3(linear.inverse().transpose().cast<float>()));
        program.set("u_size_pixels", Vec3(splats.pixels, splats.world_pixels, splats.least_pixels));
        program.set("u_base_color", Vec4(m.base_color.x(), m.base_color.y(), m.base_color.z(), m.opacity));
        program.set("u_alpha_cutoff", m.alpha_cutoff);
        if (outputs.peel) set_peel_uniforms(program, *outputs.peel, 0);
        program.set("u_towards_viewer", Vec3(world_from_view.col(2)));
        program.set("u_material", Vec4(m.metallic, m.roughness, 1, code_of(kind_of_point(item.kind))));
        program.set("u_object_id", int(item.object - frame.scene->objects.data()) + 1);
        program.set("u_sample_index", float(frame.sample_index));
        set_noise_uniforms(program, frame);
        program.set("u_write", write ? 1.0f : 0.0f);
        gl::draw_points(state, buffers.array, int(item.mesh().V.rows()));
    }
}

}  // namespace easypbr::render
