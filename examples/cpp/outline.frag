// Lines where neighbouring pixels lie on other surfaces: a step in depth, or an edge between two directions.
#include "common_camera.glsl"
#include "common_encoding.glsl"

uniform sampler2D u_depth_target;  // reversed depth, 0 where there is nothing
uniform sampler2D u_normal;
uniform vec3 u_color;
uniform float u_width;

layout(location = 0) out vec4 o_color;  // premultiplied

struct Place {
    bool is_surface;
    vec3 position, normal;  // view space; world
};

Place place_at(vec2 pixel) {
    vec2 uv = clamp(pixel / u_size, vec2(0.0), vec2(1.0));
    float depth = textureLod(u_depth_target, uv, 0.0).r;
    return Place(depth > 0.0, view_position(pixel, max(depth, 1e-9)),
                 oct_decode(textureLod(u_normal, uv, 0.0).rg * 2.0 - 1.0));
}

bool is_edge(Place a, Place b) {
    if (a.is_surface != b.is_surface) return true;
    if (!a.is_surface) return false;
    if (dot(a.normal, b.normal) < 0.8) return true;
    // How far b lies off a's plane, compared with how far the two are from the camera.
    vec3 normal = transpose(u_world_from_view) * a.normal;
    return abs(dot(normal, b.position - a.position)) > 0.01 * abs(a.position.z);
}

void main() {
    Place here = place_at(gl_FragCoord.xy);
    bool edge = false;
    for (int i = 0; i < 4; ++i) {
        vec2 step = vec2(i & 1, i >> 1) * 2.0 - 1.0;
        edge = edge || is_edge(here, place_at(gl_FragCoord.xy + 0.5 * u_width * step));
    }
    o_color = vec4(u_color, 1.0) * float(edge);
}
