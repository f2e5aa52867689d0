// Lines over the tone-mapped picture, hidden by the surfaces in the G-buffer. After a layer, before a layer: those only
// that lie before one layer of surfaces that light passes, and behind the next.
#include "common_lanes.glsl"
#include "common_encoding.glsl"
#include "common_camera.glsl"

#feature DEPTH_ONLY is_depth_only
#feature AFTER is_after_layer
#feature BEFORE is_before_layer

uniform sampler2D u_depth_target;
uniform sampler2D u_normal;
uniform sampler2D u_last_depth;  // of the layer behind; 0: all lines have been drawn
uniform sampler2D u_last_normal;
uniform sampler2D u_next_depth;  // of the layer before; 0: there is nothing more before this pixel's lines
uniform sampler2D u_next_normal;
uniform sampler2D u_nearest_line;  // depth that the first pass found
uniform float u_half_width;   // pixels
uniform float u_dash;         // pixels, 0: solid
uniform float u_always;       // 1: whatever is in front
uniform float u_nearer_end;   // 1: each half has the colour of its end
uniform float u_from_table;   // 1: the ends have values, and these their colours in a table
uniform sampler2D u_table;    // 256 wide

noperspective in vec2 v_place;
flat in float v_length;
flat in vec2 v_depths;
flat in vec4 v_start_color, v_end_color;  // of the whole segment
flat in vec2 v_parts;  // of the whole segment, at the ends of what is drawn
flat in vec2 v_w;      // there
flat in vec3 v_table;  // places of the whole segment's values, and the row

layout(location = 0) out vec4 o_color;

// How much the surface's distance changes over a pixel, by its plane: a line on it must not be cut by its slope.
float change_per_pixel(vec2 pixel, float z, vec2 normal) {
    vec3 n = oct_decode(normal * 2.0 - 1.0) * u_world_from_view;
    vec2 scale = u_unproject.xy * 2.0 / u_size;
    float change = abs(n.x) * scale.x + abs(n.y) * scale.y;
    if (is_orthographic) return change / max(abs(n.z), 0.05);
    vec3 ray = vec3((ndc_of_pixel(pixel) + u_unproject.zw) * u_unproject.xy, -1.0);
    return z * change / max(abs(dot(n, ray)), 0.05);
}

bool is_behind(float surface, vec2 normal, vec2 pixel, float depth) {
    float z = axial_distance(surface);
    float tolerance = change_per_pixel(pixel, z, normal) * (u_half_width + 1.0) + 1e-5 * z;
    return surface > 0.0 && axial_distance(depth) > z + tolerance;
}

bool is_hidden(vec2 pixel, float depth) {
    if (u_always > 0.5) return false;
    vec2 uv = pixel / u_size;
    return is_behind(textureLod(u_depth_target, uv, 0.0).r, textureLod(u_normal, uv, 0.0).rg, pixel, depth);
}

// Before the layer behind: what is not is drawn with another one.
bool is_after(vec2 pixel, float depth) {
    if (!is_after_layer) return true;
    vec2 uv = pixel / u_size;
    float last = textureLod(u_last_depth, uv, 0.0).r;
    return last > 0.0 && !is_behind(last, textureLod(u_last_normal, uv, 0.0).rg, pixel, depth);
}

// Behind the layer before.
bool is_before(vec2 pixel, float depth) {
    if (!is_before_layer) return true;
    vec2 uv = pixel / u_size;
    float next = textureLod(u_next_depth, uv, 0.0).r;
    return next <= 0.0 || is_behind(next, textureLod(u_next_normal, uv, 0.0).rg, pixel, depth);
}

// A line is as deep as half its width: what lies no further behind the nearest one is not hidden, so that the
// segments of a curve do not cut notches into each other.
bool is_behind_line(vec2 pixel, float depth) {
    float nearest = textureLod(u_nearest_line, pixel / u_size, 0.0).r;
    float z = axial_distance(nearest), thickness = (u_half_width + 1.0) * 2.0 * u_unproject.y / u_size.y;
    if (!is_orthographic) thickness *= z;
    return nearest > 0.0 && axial_distance(depth) > z + thickness;
}

// What part of the way from the segment's start, in space, lies at a part of its picture.
float part_at(float place) {
    return mix(v_parts.x, v_parts.y, place * v_w.x / mix(v_w.y, v_w.x, place));
}

vec4 color_at(float place) {
    float part = part_at(place);
    if (u_nearer_end > 0.5) part = part < 0.5 ? 0.0 : 1.0;
    if (u_from_table > 0.5) {
        float column = clamp(floor(mix(v_table.x, v_table.y, part) * 256.0), 0.0, 255.0);
        return textureLod(u_table, vec2((column + 0.5) / 256.0, v_table.z), 0.0);
    }
    return mix(v_start_color, v_end_color, part);
}

void main() {
    // Beyond its ends a segment goes on at their depth: where segments meet they agree.
    float place = v_length > 0.0 ? clamp(v_place.x / v_length, 0.0, 1.0) : 0.0;
    float depth = mix(v_depths.x, v_depths.y, place);
    // Round ends: joints of polylines have no gaps.
    float past = max(max(-v_place.x, v_place.x - v_length), 0.0);
    float distance = length(vec2(past, v_place.y));
    // The part of a pixel across the line that it covers.
    float coverage = clamp(min(distance + u_half_width, 0.5) - max(distance - u_half_width, -0.5), 0.0, 1.0);
    if (u_dash > 0.0) {
        float phase = mod(v_place.x, 2.0 * u_dash);
        coverage *= clamp(min(phase, u_dash - phase) + 0.5, 0.0, 1.0) + clamp(phase - 2.0 * u_dash + 0.5, 0.0, 1.0);
    }
#ifdef DEPTH_ONLY  // A shader that assigns gl_FragDepth anywhere has no early depth test.
    gl_FragDepth = depth;
#endif
    bool covered = is_depth_only ? coverage >= 0.5 : coverage > 0.0;
    if (!covered) discard;
    if (is_hidden(gl_FragCoord.xy, depth)) discard;
    if (is_depth_only) {
        o_color = vec4(0.0);
        return;
    }
    if (is_behind_line(gl_FragCoord.xy, depth)) discard;
    bool between = is_after(gl_FragCoord.xy, depth) && is_before(gl_FragCoord.xy, depth);
    if (!between) discard;
    vec4 color = color_at(place);
    float alpha = coverage * color.a;
    o_color = vec4(color.rgb * alpha, alpha);
}
