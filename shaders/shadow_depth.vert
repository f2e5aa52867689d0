// Casters into a shadow map.
#include "common_encoding.glsl"

#feature VERTEX_COLOR has_vertex_colors
#feature UV has_uv

layout(location = 0) in vec3 a_position;
layout(location = 2) in vec4 a_color;
layout(location = 3) in vec2 a_uv;

out vec4 v_color;
out vec2 v_uv;

uniform mat4 u_clip_from_mesh;

void main() {
    gl_Position = u_clip_from_mesh * vec4(a_position, 1.0);
    if (has_vertex_colors) v_color = vec4(srgb_decode(a_color.rgb), a_color.a);
    if (has_uv) v_uv = a_uv;
}
