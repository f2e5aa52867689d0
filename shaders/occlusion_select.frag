// Half resolution: the nearest of four pixels stands for all, never their mean, which would lie on neither surface. With
// nearest and farthest in turn, both sides of an edge would have every other texel, and the edge a comb. Of pixels that
// are equally near, as those of a row of a level plane, the first is taken, whatever the rounding. Accumulated frames take
// the four pixels in turn: in their mean all have a share, and both sides of an edge.
#include "occlusion_half.glsl"

#feature TAKES_TURNS takes_turns

uniform int u_frame;  // index of the accumulated frame

layout(location = 0) out vec4 o_surface;

const float rounding = 1e-5;

vec2 pixel_at(vec2 corner, float index) {
    float row = step(1.5, index);
    return min(corner + vec2(index - 2.0 * row, row) + 0.5, u_size - 0.5);
}

void main() {
    vec2 corner = floor(gl_FragCoord.xy) * 2.0;
    float chosen = 0.0, index = 0.0;
    for (int i = 0; i < 4; ++i) {
        float depth = textureLod(u_depth_target, pixel_at(corner, float(i)) / u_size, 0.0).r;
        bool nearer = depth > chosen * (1.0 + rounding);
        index = nearer ? float(i) : index;
        chosen = nearer ? depth : chosen;
    }
    if (takes_turns) {
        float turn = float(u_frame & 3), depth = textureLod(u_depth_target, pixel_at(corner, turn) / u_size, 0.0).r;
        index = depth > 0.0 ? turn : index;
        chosen = depth > 0.0 ? depth : chosen;
    }
    vec2 pixel = pixel_at(corner, index);
    vec3 normal = view_normal(textureLod(u_normal, pixel / u_size, 0.0).rg);
    o_surface = pack_surface(chosen, normal, index);
    gl_FragDepth = chosen;
}
