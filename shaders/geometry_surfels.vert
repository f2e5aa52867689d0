// Surfels as quads around their ellipses, one instance each: the first of three steps of surface splatting. The inverse
// that takes a pixel to a place in the ellipse is explained in render/surfel_projection.h.
#include "common_encoding.glsl"
#include "common_projection.glsl"

#feature VERTEX_COLOR has_vertex_colors
#feature ALPHA_MASK has_alpha_mask
#feature PEEL is_peeling
#feature OBJECT_ID has_ids

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_color;
layout(location = 3) in vec4 a_axes;  // tangent, its length being the first semi-axis; length of the second

uniform mat4 u_clip_from_mesh;
uniform mat4 u_view_from_mesh;
uniform mat3 u_normal_from_mesh;
uniform vec2 u_size;
uniform vec4 u_base_color;  // linear, opacity in w
uniform vec3 u_eye;         // in the mesh's frame; orthographic: direction towards the viewer
uniform vec4 u_surfel;      // factor on the size, radius without a tangent, near, scale of the pose, 0: no band
uniform float u_least_radius;
uniform float u_alpha_cutoff;
uniform float u_pixel;      // its height, at distance 1 or anywhere (orthographic)

flat out vec2 v_centre;     // pixels
flat out vec4 v_axes;       // tx, ty, bx, by
flat out vec4 v_plane;      // t x b; wc
flat out vec4 v_distance;   // axial distance along t and b and of the centre; band
flat out float v_least;     // half the side of the smallest square it covers, pixels
flat out vec3 v_normal;
flat out vec4 v_color;
flat out uint v_element;

vec3 any_perpendicular(vec3 n) {
    return normalize(abs(n.x) > abs(n.z) ? vec3(-n.y, n.x, 0.0) : vec3(0.0, -n.z, n.y));
}

vec2 extent(float t, float b, vec3 w, float q_ww, float least) {
    float q_kw = t * w.x + b * w.y;
    float root = sqrt(max(0.0, q_kw * q_kw - q_ww * (t * t + b * b)));
    return vec2(min((q_kw + root) / q_ww, -least), max((q_kw - root) / q_ww, least));
}

void leave_out() { gl_Position = vec4(2.0, 2.0, 0.0, 1.0); }

void main() {
    v_color = u_base_color;
    if (has_vertex_colors) v_color *= vec4(srgb_decode(a_color.rgb), a_color.a);
    if ((has_alpha_mask && v_color.a < u_alpha_cutoff) || (is_peeling && v_color.a <= 0.0)) {
        leave_out();
        return;
    }
    vec3 to_viewer = is_orthographic ? u_eye : u_eye - a_position;
    vec3 n = dot(a_normal, a_normal) > 0.0 ? normalize(a_normal) : normalize(to_viewer);
    float radius = length(a_axes.xyz);
    vec3 direction = a_axes.xyz - n * dot(n, a_axes.xyz);
    direction = dot(direction, direction) > 1e-12 * radius * radius ? normalize(direction) : any_perpendicular(n);
    float first = u_surfel.y > 0.0 ? u_surfel.y : radius;
    float second = u_surfel.y > 0.0 ? u_surfel.y : a_axes.w;
    vec3 t = direction * (first * u_surfel.x), b = cross(n, direction) * (second * u_surfel.x);

    vec4 c4 = u_clip_from_mesh * vec4(a_position, 1.0);
    vec4 t4 = u_clip_from_mesh * vec4(t, 0.0), b4 = u_clip_from_mesh * vec4(b, 0.0);
    vec3 w = vec3(t4.w, b4.w, c4.w);
    vec3 z = -vec3((u_view_from_mesh * vec4(t, 0.0)).z, (u_view_from_mesh * vec4(b, 0.0)).z,
                   (u_view_from_mesh * vec4(a_position, 1.0)).z);
    float q_ww = w.x * w.x + w.y * w.y - w.z * w.z;
    if (!(w.z > 0.0 && q_ww < 0.0 && z.z - length(z.xy) > u_surfel.z * 0.999)) {
        leave_out();
        return;
    }
    v_centre = (vec2(c4.x, -c4.y) / c4.w + 1.0) * 0.5 * u_size;
    vec2 t2 = 0.5 * u_size * (vec2(t4.x, -t4.y) + w.x) - v_centre * w.x;
    vec2 b2 = 0.5 * u_size * (vec2(b4.x, -b4.y) + w.y) - v_centre * w.y;
    v_axes = vec4(t2, b2);
    v_plane = vec4(cross(vec3(t2, w.x), vec3(b2, w.y)), w.z);
    v_distance = vec4(z, max(length(t), length(b)) * u_surfel.w);
    // As least_radius() in render/surfel_projection.h.
    float facing = dot(a_normal, a_normal) > 0.0 ? dot(n, normalize(to_viewer)) : 1.0;
    if (is_peeling) {
        // Surfels smaller than a pixel lie as far behind each other as the surface falls away within it.
        float slope = sqrt(max(0.0, 1.0 - facing * facing)) / max(abs(facing), 0.1);
        float footprint = is_orthographic ? u_pixel : u_pixel * z.z;
        v_distance.w = max(v_distance.w, footprint * (1.0 + slope));
    }
    v_least = facing < 0.0 ? max(1e-3, -facing * u_least_radius) : u_least_radius;
    vec2 x = extent(t2.x, b2.x, w, q_ww, v_least), y = extent(t2.y, b2.y, w, q_ww, v_least);
    // Half a pixel more: the centres of all pixels that count are inside whatever the driver rounds.
    vec2 corner = v_centre + vec2((gl_VertexID & 1) == 0 ? x.x - 0.5 : x.y + 0.5,
                                  (gl_VertexID & 2) == 0 ? y.x - 0.5 : y.y + 0.5);
    vec2 ndc = corner / u_size * 2.0 - 1.0;
    gl_Position = vec4(ndc.x, -ndc.y, 0.5, 1.0);

    v_normal = normalize(u_normal_from_mesh * (dot(n, to_viewer) < 0.0 ? -n : n));
    if (has_ids) v_element = uint(gl_InstanceID + 1) | 0x80000000u;  // a point: render/frame/gbuffer.h
}
