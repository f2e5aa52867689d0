// The first level of bloom's pyramid: light that is spread, a texel for 4 x 4 pixels, by a tent of 8 x 8, which weighs
// every pixel alike wherever it lies in its texel: what moves does not flicker. In two steps, so that every pixel is read
// once: blocks of 4 x 4 pixels, two before each texel to one after it, are summed with the weights that rise or fall along
// each axis; a texel's tent is what rises to it and falls from it in the four blocks around.
#include "common_bloom.glsl"

#ifdef BLOCKS
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
#ifdef SUPPRESS_FIREFLIES
    return vec4(light, 1.0) / (1.0 + largest(light));  // Karis 2013: the mean of what a tone curve would make of the light
#else
    return vec4(light, 1.0);
#endif
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
#else
uniform sampler2D u_rise_rise;
uniform sampler2D u_fall_rise;
uniform sampler2D u_rise_fall;
uniform sampler2D u_fall_fall;

layout(location = 0) out vec4 o_light;

void main() {
    ivec2 block = ivec2(gl_FragCoord.xy);
    vec4 sum = texelFetch(u_rise_rise, block, 0) + texelFetch(u_fall_rise, block + ivec2(1, 0), 0) +
               texelFetch(u_rise_fall, block + ivec2(0, 1), 0) + texelFetch(u_fall_fall, block + 1, 0);
    o_light = vec4(sum.rgb / sum.a, 1.0);
}
#endif
