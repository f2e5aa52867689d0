// Triangles into the G-buffer.
#include "common_encoding.glsl"

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec2 a_normal;
#ifdef VERTEX_COLOR
layout(location = 2) in vec4 a_color;
out vec4 v_color;
#endif
#ifdef UV
layout(location = 3) in vec2 a_uv;
out vec2 v_uv;
#endif
#ifdef TANGENT
layout(location = 4) in vec4 a_tangent;
out vec4 v_tangent;
#endif
#if defined(FACE_NORMAL) || defined(SURFACE_SHADER)
#define POSITION
out vec3 v_position;
uniform mat4 u_view_from_mesh;
uniform mat3 u_world_from_view;
#endif
#ifndef FLAT
out vec3 v_normal;
#endif
#ifdef SURFACE_SHADER
out vec3 v_own_position;
#endif

uniform mat4 u_clip_from_mesh;
uniform mat3 u_normal_from_mesh;   // inverse transpose, to world
uniform mat3 u_tangent_from_mesh;  // to world

void main() {
    gl_Position = u_clip_from_mesh * vec4(a_position, 1.0);
#ifndef FLAT
    v_normal = u_normal_from_mesh * oct_decode(a_normal);
#endif
#ifdef SURFACE_SHADER
    v_own_position = a_position;
#endif
#ifdef POSITION
    v_position = u_world_from_view * (u_view_from_mesh * vec4(a_position, 1.0)).xyz;
#endif
#ifdef VERTEX_COLOR
    v_color = vec4(srgb_decode(a_color.rgb), a_color.a);
#endif
#ifdef UV
    v_uv = a_uv;
#endif
#ifdef TANGENT
    v_tangent = vec4(u_tangent_from_mesh * a_tangent.xyz, a_tangent.w);
#endif
}
