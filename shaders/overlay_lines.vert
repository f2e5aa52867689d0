// Line segments as strips that face the viewer, one instance each: wide in pixels whatever the driver's own lines can do.
#include "common_encoding.glsl"

layout(location = 0) in vec3 a_start;
layout(location = 1) in vec4 a_start_color;
layout(location = 2) in vec3 a_end;
layout(location = 3) in vec4 a_end_color;
layout(location = 4) in vec3 a_table;  // places of the ends' values, and the row

uniform mat4 u_clip_from_mesh;
uniform vec2 u_size;
uniform float u_half_width;  // pixels
uniform float u_least_w;     // w of the near plane
uniform vec4 u_color;        // linear; w: 0: the ends have their own, -1: their own opacity, 1: none

noperspective out vec2 v_place;    // along and across the segment, pixels from its start
flat out float v_length;           // pixels
flat out vec2 v_depths;            // of its ends
flat out vec4 v_start_color, v_end_color;  // of the whole segment
flat out vec2 v_parts;             // of the whole segment, at the ends of what is drawn
flat out vec2 v_w;                 // there
flat out vec3 v_table;
invariant gl_Position;

void main() {
    vec4 start = u_clip_from_mesh * vec4(a_start, 1.0), end = u_clip_from_mesh * vec4(a_end, 1.0);
    // What lies before the near plane is cut off; a segment all of which does is drawn nowhere.
    float from = start.w < u_least_w ? (u_least_w - start.w) / (end.w - start.w) : 0.0;
    float to = end.w < u_least_w ? (u_least_w - start.w) / (end.w - start.w) : 1.0;
    if (start.w < u_least_w && end.w < u_least_w) {
        gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
        return;
    }
    vec4 a = mix(start, end, from), b = mix(start, end, to);
    vec2 a_pixel = (a.xy / a.w) * 0.5 * u_size, b_pixel = (b.xy / b.w) * 0.5 * u_size;
    vec2 along = b_pixel - a_pixel;
    v_length = length(along);
    along = v_length > 1e-6 ? along / v_length : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    // One pixel more than the line, for its smooth edge.
    float reach = u_half_width + 1.0;
    float side = float(gl_VertexID & 1) * 2.0 - 1.0;
    bool at_end = gl_VertexID > 1;
    float beyond = at_end ? v_length + reach : -reach;
    vec2 pixel = a_pixel + along * beyond + across * (side * reach);
    v_place = vec2(beyond, side * reach);
    v_depths = vec2(a.z / a.w, b.z / b.w);
    gl_Position = vec4(pixel / (0.5 * u_size), at_end ? v_depths.y : v_depths.x, 1.0);
    bool has_own = u_color.w == 0.0;
    v_start_color.rgb = has_own ? srgb_decode(a_start_color.rgb) : u_color.rgb;
    v_end_color.rgb = has_own ? srgb_decode(a_end_color.rgb) : u_color.rgb;
    v_start_color.a = u_color.w > 0.0 ? 1.0 : a_start_color.a;
    v_end_color.a = u_color.w > 0.0 ? 1.0 : a_end_color.a;
    v_parts = vec2(from, to);
    v_w = vec2(a.w, b.w);
    v_table = a_table;
}
