// Casters into a shadow map.
layout(location = 0) in vec3 a_position;
#ifdef VERTEX_COLOR
layout(location = 2) in vec4 a_color;
out vec4 v_color;
#include "common_encoding.glsl"
#endif
#ifdef UV
layout(location = 3) in vec2 a_uv;
out vec2 v_uv;
#endif

uniform mat4 u_clip_from_mesh;

void main() {
    gl_Position = u_clip_from_mesh * vec4(a_position, 1.0);
#ifdef VERTEX_COLOR
    v_color = vec4(srgb_decode(a_color.rgb), a_color.a);
#endif
#ifdef UV
    v_uv = a_uv;
#endif
}
