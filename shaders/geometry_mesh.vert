// Triangles into the G-buffer.
#include "common_encoding.glsl"
#include "mesh_features.glsl"

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec2 a_normal;
layout(location = 2) in vec4 a_color;
layout(location = 3) in vec2 a_uv;
layout(location = 4) in vec4 a_tangent;

out vec4 v_color;
out vec2 v_uv;
out vec4 v_tangent;
out vec3 v_position;
out vec3 v_normal;
out vec3 v_own_position;

uniform mat4 u_clip_from_mesh;
uniform mat4 u_view_from_mesh;
uniform mat3 u_world_from_view;
uniform mat3 u_normal_from_mesh;   // inverse transpose, to world
uniform mat3 u_tangent_from_mesh;  // to world

void main() {
    gl_Position = u_clip_from_mesh * vec4(a_position, 1.0);
    if (!is_flat) v_normal = u_normal_from_mesh * oct_decode(a_normal);
    if (has_own_shader) v_own_position = a_position;
    if (needs_position()) v_position = u_world_from_view * (u_view_from_mesh * vec4(a_position, 1.0)).xyz;
    if (has_vertex_colors) v_color = vec4(srgb_decode(a_color.rgb), a_color.a);
    if (has_uv) v_uv = a_uv;
    // A mirrored mesh has mirrored textures.
    float handedness = determinant(u_tangent_from_mesh) < 0.0 ? -1.0 : 1.0;
    if (has_tangents) v_tangent = vec4(u_tangent_from_mesh * a_tangent.xyz, handedness * a_tangent.w);
}
