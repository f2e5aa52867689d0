// The first of two steps of bloom_gather.frag: blocks of 4 x 4 pixels are summed with the weights that rise or fall along
// each axis.
#include "common_bloom.glsl"

#feature SUPPRESS_FIREFLIES suppresses_fireflies

uniform sampler2D u_radiance;
uniform vec2 u_size;

// rgb: light, a: weights; along x, then y
layout(location = 0) out vec4 o_rise_rise;
layout(location = 1) out vec4 o_fall_rise;
layout(location = 2) out vec4 o_rise_fall;
layout(location = 3) out vec4 o_fall_fall;

// The picture goes on mirrored beyond its borders, so that neither light nor evenness is lost there.
ivec2 mirrored(ivec2 pixel) {
    ivec2 size = ivec2(u_size);
    pixel = max(pixel, -1 - pixel);
    return clamp(min(pixel, 2 * size - 1 - pixel), ivec2(0), size - 1);
}

vec4 light_at(ivec2 pixel) {
    vec3 light = spread_part(contained(texelFetch(u_radiance, mirrored(pixel), 0).rgb));
    // Karis 2013: the mean of what a tone curve would make of the light.
    return suppresses_fireflies ? vec4(light, 1.0) / (1.0 + largest(light)) : vec4(light, 1.0);
}

void main() {
    ivec2 first = 4 * ivec2(gl_FragCoord.xy) - 2;
    o_rise_rise = o_fall_rise = o_rise_fall = o_fall_fall = vec4(0.0);
    for (int y = 0; y < 4; ++y) {
        vec4 a = light_at(first + ivec2(0, y)), b = light_at(first + ivec2(1, y)), c = light_at(first + ivec2(2, y)),
             d = light_at(first + ivec2(3, y));
        vec4 all = a + b + c + d, rise = 0.5 * all + b + 2.0 * c + 3.0 * d, fall = 4.0 * all - rise;
        float up = float(y) + 0.5, down = 4.0 - up;
        o_rise_rise += up * rise;
        o_fall_rise += up * fall;
        o_rise_fall += down * rise;
        o_fall_fall += down * fall;
    }
}
