// Line segments as strips that face the viewer, one instance each: wide in pixels whatever the driver's own lines can do.
#include "common_encoding.glsl"

layout(location = 0) in vec3 a_start;
layout(location = 1) in vec4 a_start_color;
layout(location = 2) in vec3 a_end;
layout(location = 3) in vec4 a_end_color;
layout(location = 4) in vec3 a_table;  // places of the ends' values, and the row
layout(location = 5) in vec2 a_dash;   // where dashes are at the start of what is drawn, pixels; their direction

uniform mat4 u_clip_from_mesh;
uniform vec2 u_size;
uniform float u_half_width;  // pixels
uniform float u_chained;     // 1: dashes go on from segment to segment
uniform vec4 u_color;        // linear; w: 0: the ends have their own, -1: their own opacity, 1: none

noperspective out vec2 v_place;    // along and across the segment, pixels from its start
flat out float v_length;           // pixels
flat out vec2 v_depths;            // of its ends
flat out vec4 v_start_color, v_end_color;  // of the whole segment
flat out vec2 v_parts;             // of the whole segment, at the ends of what is drawn
flat out vec2 v_w;                 // there
flat out vec3 v_table;
flat out vec2 v_dash;
invariant gl_Position;

// As in render/primitives/lines/screen_lines.cpp, which has the reasons.
const float least_part_of_w = 1e-5;
const float farthest_pixel = 1e5;

// Leaves, of a part from x to y, what is above 0 of a value that is `a` at the start and `b` at the end.
void cut(inout vec2 part, float a, float b) {
    if (a < 0.0 && b < 0.0) part.y = -1.0;
    if (a < 0.0 && b >= 0.0) part.x = max(part.x, a / (a - b));
    if (a >= 0.0 && b < 0.0) part.y = min(part.y, a / (a - b));
}

// The part of a segment that is drawn, from 0 to 1; nothing where x is above y.
vec2 part_of(vec4 start, vec4 end) {
    float least_w = least_part_of_w * max(abs(start.w), abs(end.w));
    vec2 part = vec2(0.0, 1.0), side = 2.0 * farthest_pixel / u_size;
    cut(part, start.w - least_w, end.w - least_w);
    cut(part, start.w - start.z, end.w - end.z);  // the near plane
    cut(part, start.z, end.z);                    // the far plane of an orthographic camera
    cut(part, side.x * start.w - start.x, side.x * end.w - end.x);
    cut(part, side.x * start.w + start.x, side.x * end.w + end.x);
    cut(part, side.y * start.w - start.y, side.y * end.w - end.y);
    cut(part, side.y * start.w + start.y, side.y * end.w + end.y);
    return part;
}

void main() {
    vec4 start = u_clip_from_mesh * vec4(a_start, 1.0), end = u_clip_from_mesh * vec4(a_end, 1.0);
    vec2 part = part_of(start, end);
    if (part.x > part.y) {
        gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
        return;
    }
    vec4 a = mix(start, end, part.x), b = mix(start, end, part.y);
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
    v_parts = part;
    v_w = vec2(a.w, b.w);
    v_table = a_table;
    v_dash = u_chained > 0.5 ? a_dash : vec2(0.0, 1.0);
}
