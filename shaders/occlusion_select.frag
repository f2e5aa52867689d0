// Half resolution: the nearest of four pixels stands for all, never their mean, which would lie on neither surface. With
// nearest and farthest in turn, both sides of an edge would have every other texel, and the edge a comb. Of pixels that
// are equally near, as those of a row of a level plane, the first is taken, whatever the rounding.
#include "occlusion_half.glsl"

layout(location = 0) out vec4 o_surface;

const float rounding = 1e-5;

void main() {
    vec2 corner = floor(gl_FragCoord.xy) * 2.0;
    float chosen = 0.0, index = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 pixel = min(corner + vec2(float(i & 1), float(i >> 1)) + 0.5, u_size - 0.5);
        float depth = textureLod(u_depth_target, pixel / u_size, 0.0).r;
        bool nearer = depth > chosen * (1.0 + rounding);
        index = nearer ? float(i) : index;
        chosen = nearer ? depth : chosen;
    }
    vec2 pixel = min(corner + vec2(mod(index, 2.0), floor(index * 0.5)) + 0.5, u_size - 0.5);
    vec3 normal = view_normal(textureLod(u_normal, pixel / u_size, 0.0).rg);
    o_surface = pack_surface(chosen, normal, index);
    gl_FragDepth = chosen;
}
