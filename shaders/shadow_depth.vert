// Casters into a shadow map.
layout(location = 0) in vec3 a_position;
#ifdef VERTEX_COLOR
layout(location = 2) in vec4 a_color;
out float v_alpha;
#endif
#ifdef UV
layout(location = 3) in vec2 a_uv;
out vec2 v_uv;
#endif

uniform mat4 u_clip_from_mesh;

void main() {
    gl_Position = u_clip_from_mesh * vec4(a_position, 1.0);
#ifdef VERTEX_COLOR
    v_alpha = a_color.a;
#endif
#ifdef UV
    v_uv = a_uv;
#endif
}
