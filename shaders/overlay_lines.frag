// Lines over the tone-mapped picture, hidden by the surfaces in the G-buffer. After a layer, before a layer: those only
// that lie before one layer of surfaces that light passes, and behind the next. The segments of a stroke are not blended:
// of each pixel one is kept, that of the highest rank, which the depth test finds.
#include "common_lanes.glsl"
#include "common_camera.glsl"
#include "overlay_order.glsl"

#feature DEPTH_ONLY is_depth_only
#feature AFTER is_after_layer
#feature BEFORE is_before_layer

uniform sampler2D u_depth_target;
uniform sampler2D u_last_depth;  // of the layer behind; 0: all lines have been drawn
uniform sampler2D u_next_depth;  // of the layer before; 0: there is nothing more before this pixel's lines
uniform sampler2D u_nearest_line;  // depth that the first pass found
uniform float u_dash;         // pixels, 0: solid
uniform float u_always;       // 1: whatever is in front
uniform float u_nearer_end;   // 1: each half has the colour of its end
uniform float u_from_table;   // 1: the ends have values, and these their colours in a table
uniform sampler2D u_table;    // 256 wide
uniform float u_opacity;      // of the material

noperspective in vec2 v_place;
flat in float v_length;
flat in vec2 v_depths;
flat in vec4 v_start_color, v_end_color;  // of the whole segment
flat in vec2 v_parts;  // of the whole segment, at the ends of what is drawn
flat in vec2 v_w;      // there
flat in vec3 v_table;  // places of the whole segment's values, and the row
flat in vec2 v_dash;   // where dashes are at the start of what is drawn, pixels; 1, or -1 where they run against the segment

layout(location = 0) out vec4 o_color;  // premultiplied
layout(location = 1) out float o_depth;

// How much the reversed depth of a surface changes per pixel towards one side. Over a plane each step is the same. Past the
// surface's edge one of two is large, which says nothing of its slope.
float change_towards(sampler2D target, vec2 pixel, float surface, vec2 way) {
    float next = textureLod(target, (pixel + way) / u_size, 0.0).r;
    float second = textureLod(target, (pixel + 2.0 * way) / u_size, 0.0).r;
    return min(abs(next - surface), abs(second - next));
}

// The same along both axes. One side at least is that of the pixel's own face: the other may be across a crease, where a
// step is small if the faces slope in opposite ways.
float change_per_pixel(sampler2D target, vec2 pixel, float surface) {
    float right = change_towards(target, pixel, surface, vec2(1.0, 0.0));
    float left = change_towards(target, pixel, surface, vec2(-1.0, 0.0));
    float below = change_towards(target, pixel, surface, vec2(0.0, 1.0));
    float above = change_towards(target, pixel, surface, vec2(0.0, -1.0));
    return max(right, left) + max(below, above);
}

// A line on the surface must not be cut by its slope: shading normals do not tell it, neighbours do.
bool is_behind(sampler2D target, float surface, vec2 pixel, float depth) {
    bool is_deeper = surface > 0.0 && depth < surface;
    if (!any_lane(is_deeper)) return is_deeper;
    float limit = surface - change_per_pixel(target, pixel, surface) * (u_half_width + 1.0);
    float z = axial_distance(limit);
    return is_deeper && limit > 0.0 && axial_distance(depth) > z + 1e-5 * abs(z);
}

bool is_hidden(vec2 pixel, float depth) {
    if (u_always > 0.5) return false;
    float surface = textureLod(u_depth_target, pixel / u_size, 0.0).r;
    return is_behind(u_depth_target, surface, pixel, depth);
}

// Before the layer behind: what is not is drawn with another one.
bool is_after(vec2 pixel, float depth) {
    if (!is_after_layer) return true;
    float last = textureLod(u_last_depth, pixel / u_size, 0.0).r;
    return last > 0.0 && !is_behind(u_last_depth, last, pixel, depth);
}

// Behind the layer before.
bool is_before(vec2 pixel, float depth) {
    if (!is_before_layer) return true;
    float next = textureLod(u_next_depth, pixel / u_size, 0.0).r;
    return next <= 0.0 || is_behind(u_next_depth, next, pixel, depth);
}

// Whether a nearer line hides it. Where a line runs into the depth, its segments reach over each other by half the width:
// those before it by so much are none that hide it.
bool is_behind_line(vec2 pixel, float depth) {
    float change = abs(v_depths.y - v_depths.x) / max(v_length, 1e-3);
    return lies_behind(depth + change * (u_half_width + 1.0), textureLod(u_nearest_line, pixel / u_size, 0.0).r);
}

// The segment with the highest rank is seen. One that covers the whole pixel is before one that does not, so that what a
// stroke covers is the most that any of its segments does; of those that do, one that no nearer line hides; then the one
// whose middle is nearest: beyond their ends segments have the colour of the end.
float rank_of(vec2 pixel, float depth, float coverage, float distance) {
    bool is_whole = coverage >= 1.0, is_behind_another = is_behind_line(pixel, depth);
    float part = 0.999 * coverage + 0.001 * (1.0 - distance / (u_half_width + 0.5));
    return (part + (is_whole ? (is_behind_another ? 1.0 : 2.0) : 0.0)) / 3.0;
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
        float phase = mod(v_dash.x + v_dash.y * v_place.x, 2.0 * u_dash);
        coverage *= clamp(min(phase, u_dash - phase) + 0.5, 0.0, 1.0) + clamp(phase - 2.0 * u_dash + 0.5, 0.0, 1.0);
    }
    bool covered = is_depth_only ? coverage >= 0.5 : coverage > 0.0;
    gl_FragDepth = depth;
    if (!covered) discard;
    if (is_hidden(gl_FragCoord.xy, depth)) discard;
    if (is_depth_only) {
        o_color = vec4(depth);
        return;
    }
    bool between = is_after(gl_FragCoord.xy, depth) && is_before(gl_FragCoord.xy, depth);
    if (!between) discard;
    vec4 color = color_at(place);
    float alpha = coverage * color.a * u_opacity;
    gl_FragDepth = rank_of(gl_FragCoord.xy, depth, coverage, distance);
    o_color = vec4(color.rgb * alpha, alpha);
    o_depth = depth;
}
