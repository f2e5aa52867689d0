// Points of a cloud as splats that face the viewer.
#include "common_encoding.glsl"
#include "common_projection.glsl"

#feature NORMAL has_normals
#feature VERTEX_COLOR has_vertex_colors
#feature OBJECT_ID has_ids

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec2 a_normal;
layout(location = 2) in vec4 a_color;

flat out vec3 v_normal;
flat out vec4 v_color;
flat out float v_diameter;
flat out uint v_element;

uniform mat3 u_normal_from_mesh;
uniform mat3 u_world_from_view;
uniform mat4 u_view_from_mesh;
uniform mat4 u_clip_from_mesh;
uniform vec3 u_size_pixels;  // diameter; diameter times w, or 0; least diameter
uniform vec4 u_base_color;  // linear, opacity in w
uniform vec3 u_towards_viewer;  // world, of a point without a normal: orthographic direction
invariant gl_Position;

void main() {
    gl_Position = u_clip_from_mesh * vec4(a_position, 1.0);
    v_diameter = u_size_pixels.y > 0.0 ? max(u_size_pixels.z, u_size_pixels.y / gl_Position.w) : u_size_pixels.x;
    gl_PointSize = max(v_diameter, 1.0);
    v_color = u_base_color;
    if (has_vertex_colors) v_color *= vec4(srgb_decode(a_color.rgb), a_color.a);
    v_normal = u_towards_viewer;
    if (has_normals) {
        vec3 n = u_normal_from_mesh * oct_decode(a_normal);
        vec3 view_p = (u_view_from_mesh * vec4(a_position, 1.0)).xyz;
        vec3 to_viewer = is_orthographic ? vec3(0.0, 0.0, 1.0) : -view_p;
        v_normal = normalize(dot(n, u_world_from_view * to_viewer) < 0.0 ? -n : n);
    }
    if (has_ids) v_element = uint(gl_VertexID + 1) | 0x80000000u;  // a point: render/frame/gbuffer.h
}
