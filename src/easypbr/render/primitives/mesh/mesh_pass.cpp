#include "easypbr/render/primitives/mesh/mesh_pass.h"

#include <algorithm>
#include <cmath>

#include "easypbr/gpu/facing.h"
#include "easypbr/render/frame/own_shader.h"
#include "easypbr/render/primitives/mesh/mesh_material.h"
#include "easypbr/render/primitives/mesh/volume_side.h"

namespace easypbr::render {
namespace {

/// Whether back faces are left out.
bool is_one_sided(const Frame& frame, const DrawItem& item, const MeshBuffers& buffers) {
    const Material& m = item.material;
    // Of a volume the back is a part of what happens behind the front.
    if (item.is_volume()) return true;
    const bool opaque = item.alpha == AlphaMode::opaque && !m.transmits();
    return !item.two_sided || (buffers.winding == gpu::Winding::outward && opaque && !item.style.flat &&
                               gpu::beyond_near_plane(frame.camera, item.object->T_world_mesh, buffers.box));
}

void set_view_uniforms(const gl::Program& program, const Frame& frame) {
    const Vec3 eye = frame.camera.position().cast<float>();
    const Vec3 backwards = frame.camera.T_world_cam.linear().col(2).cast<float>();
    program.set("u_eye", eye);
    program.set("u_backwards", Vec4(backwards.x(), backwards.y(), backwards.z(), frame.orthographic()));
}

}  // namespace

const gl::Program& MeshPass::program_of(const DrawItem& item, const std::vector<std::string>& defines) {
    const SurfaceShader& shader = item.material.shader;
    if (!shader) return programs_.get(defines);
    return with_shader(programs_, shader, defines);
}

void MeshPass::draw(const Frame& frame, std::span<const DrawItem> items, const GBuffer& targets,
                    const SurfaceOutputs& outputs) {
    if (items.empty()) return;
    const bool emission =
        outputs.ids || outputs.peel || outputs.extensions || std::ranges::any_of(items, &DrawItem::emits);
    (outputs.ids          ? targets.surface_ids()
     : outputs.extensions ? targets.surface_extended()
     : emission           ? targets.surface_emission()
                          : targets.surface())
        .bind();
    for (size_t first = 0, last; first < items.size(); first = last) {
        // All parts of an object share its buffers.
        const auto same_object = [&](const DrawItem& item) { return item.object == items[first].object; };
        for (last = first; last < items.size() && same_object(items[last]);) ++last;
        const bool tangents = std::any_of(items.begin() + long(first), items.begin() + long(last),
                                          [](const DrawItem& item) { return item.needs_tangents(); });
        const MeshBuffers& buffers = meshes_.get(items[first].mesh(), tangents);
        for (size_t i = first; i < last; ++i) draw_item(frame, items[i], buffers, outputs, emission);
    }
}

void MeshPass::draw_item(const Frame& frame, const DrawItem& item, const MeshBuffers& buffers,
                         const SurfaceOutputs& outputs, bool emission) {
    const Mat4d mesh_matrix = item.object->T_world_mesh.matrix();
    const Mat3d linear = mesh_matrix.topLeftCorner<3, 3>();
    const bool mirrored = linear.determinant() < 0;

    std::vector<std::string> defines;
    add_mesh_defines(item, buffers.normals_agree, defines);
    if (item.material.shader) defines.emplace_back("SURFACE_SHADER");
    if (emission) defines.emplace_back("EMISSION");
    if (outputs.ids) defines.emplace_back("OBJECT_ID");
    if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (item.alpha == AlphaMode::blend)
        defines.emplace_back(outputs.peel ? "ALPHA_BLEND" : "ALPHA_STOCHASTIC");
    if (outputs.peel) defines.emplace_back("PEEL");
    const MaterialContext context{outputs.extensions, frame.sample_count, frame.resolved,
                                  !frame.averages_radiance};
    add_material_defines(context, item, defines);

    const gl::Program& program = program_of(item, defines);
    program.use();
    set_view_uniforms(program, frame);
    const Mat4d view_from_mesh = frame.camera.view() * mesh_matrix;
    program.set("u_clip_from_mesh", Mat4((frame.clip_from_view * view_from_mesh).cast<float>()));
    program.set("u_view_from_mesh", Mat4(view_from_mesh.cast<float>()));
    program.set("u_world_from_view", Mat3(frame.camera.T_world_cam.linear().cast<float>()));
    program.set("u_normal_from_mesh", Mat3(linear.inverse().transpose().cast<float>()));
    program.set("u_tangent_from_mesh", Mat3(linear.cast<float>()));
    program.set("u_first_face", item.part.first_face);
    program.set("u_object_id", int(item.object - frame.scene->objects.data()) + 1);
    program.set("u_sample_index", float(frame.sample_index));
    set_noise_uniforms(program, frame);
    const unsigned free_unit = material_inputs(context, item, textures_).bind(program);
    if (outputs.peel) set_peel_uniforms(program, *outputs.peel, free_unit);

    gl::DrawState state = geometry_state(outputs);
    const bool turned = is_turned(frame, item, buffers.winding), backs = outputs.peel && outputs.peel->backs;
    if (is_one_sided(frame, item, buffers))
        state.culling = backs != turned ? gl::Culling::front : gl::Culling::back;
    state.clockwise_fronts = mirrored;
    gl::draw_triangles(state, buffers.array, int64_t(item.part.first_face) * 3, item.part.face_count * 3);
}

}  // namespace easypbr::render
