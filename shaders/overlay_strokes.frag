// A stroke, the lines of an item that overlay_lines.frag has gathered, among other strokes.
#include "common_camera.glsl"
#include "overlay_order.glsl"

uniform sampler2D u_stroke;        // premultiplied
uniform sampler2D u_stroke_depth;  // reversed, of the lines that are seen of it
uniform sampler2D u_held_depth;    // of the nearest of the other strokes, 0: there is none
uniform int u_part;                // what is drawn, see below

layout(location = 0) out vec4 o_color;
layout(location = 1) out float o_depth;

const int part_all = 0;     // the stroke
const int part_before = 1;  // where it lies before the others
const int part_behind = 2;  // where it lies behind them
const int part_depth = 3;   // its depth, as a colour
const int part_nothing = 4; // clears

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    o_color = vec4(0.0);
    o_depth = 0.0;
    if (u_part == part_nothing) return;
    vec4 color = texelFetch(u_stroke, pixel, 0);
    float depth = texelFetch(u_stroke_depth, pixel, 0).r;
    if (color.a <= 0.0) discard;
    if (u_part == part_before || u_part == part_behind) {
        bool is_behind = lies_behind(depth, texelFetch(u_held_depth, pixel, 0).r);
        if (is_behind != (u_part == part_behind)) discard;
    }
    o_color = u_part == part_depth ? vec4(depth) : color;
}
