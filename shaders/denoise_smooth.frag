// One level of a wavelet transform that stops at edges (a trous; Dammertz et al. 2010): edges of what the surface is,
// and of light, by the variance of its mean.
#feature ESTIMATED has_estimate
#include "common_denoise.glsl"

uniform sampler2D u_estimate;  // of the first level, whose light is too noisy to be compared: see denoise_estimate.frag
uniform sampler2D u_estimated_hue;
uniform int u_step;            // between taps, pixels

layout(location = 0) out vec4 o_light;

// Standard deviations over which the weight falls with the difference of luminance, or of hue: the greater counts, and
// that of hue is known less well.
const float deviations = 4.25;
const float hue_deviations = 8.5;

// The luminance that is compared, compressed(), and its variance; variance of the pixel's own; normals' fall, and how much of its light is
// taken: see packed_fall().
vec4 compared(ivec2 at, vec4 light) {
    if (has_estimate) return texelFetch(u_estimate, at, 0);
    float bright = luminance(light.rgb);
    return vec4(compressed(bright), compressed_noise(bright, light.a), light.a, packed_fall(normal_fall, 1.0));
}

// The hue that is compared, and of an estimate its variance. `bright`: compressed().
vec3 compared_hue(ivec2 at, vec4 light, float bright) {
    if (has_estimate) return texelFetch(u_estimated_hue, at, 0).rgb;
    return vec3(compressed_hue(light.rgb, luminance(light.rgb), bright), 0.0);
}

// Binomial weights: 1 4 6 4 1 of the first level, 1 2 1 of the others, whose taps lie apart.
float kernel(int offset) {
    int distance = abs(offset);
    if (has_estimate) return distance == 0 ? 6.0 : distance == 1 ? 4.0 : 1.0;
    return distance == 0 ? 2.0 : 1.0;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy), last = ivec2(u_size) - 1;
    Guides own = guides_at(here);
    vec4 light_here = texelFetch(u_light, here, 0);
    vec4 compared_here = compared(here, light_here);
    float bright = compared_here.r;
    vec3 hue = compared_hue(here, light_here, bright);
    float of_hue = has_estimate ? hue.b : own.hue_noise * compared_here.g;
    float per_spread = 1.0 / (deviations * deviations * compared_here.g + 1e-10);
    float per_hue_spread = 1.0 / (hue_deviations * hue_deviations * of_hue + 1e-10);
    own.normal_fall = fall_in(compared_here.a);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    int reach = has_estimate ? 2 : 1;
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            ivec2 at = here + ivec2(x * u_step, y * u_step);
            bool inside = is_inside(at);
            at = clamp(at, ivec2(0), last);
            vec4 light = texelFetch(u_light, at, 0), guides = texelFetch(u_guides, at, 0);
            vec4 other = compared(at, light);
            float unlike = other.r - bright;
            float dyed = hue_square(own, compared_hue(at, light, other.r).rg - hue.rg);
            float apart = max(unlike * unlike * per_spread, dyed * per_hue_spread);
            vec2 away = float(u_step) * vec2(float(abs(x)), float(abs(y)));
            float weight = exp(-unlikeness(own, guides, away) - apart);
            weight = inside && guides.a > 0.0 ? weight * kernel(x) * kernel(y) : 0.0;
            sum += weight * vec4(light.rgb * part_in(other.a), weight * other.b);
            weights += weight;
        }
    }
    weights = max(weights, 1e-10);
    o_light = own.hue_noise > 0.0 ? vec4(sum.rgb / weights, sum.a / (weights * weights)) : vec4(0.0);
}
