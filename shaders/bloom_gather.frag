// The first level of bloom's pyramid: light that is spread, a texel for 4 x 4 pixels, by a tent of 8 x 8, which weighs
// every pixel alike wherever it lies in its texel: what moves does not flicker.
#include "common_bloom.glsl"

uniform sampler2D u_radiance;
uniform vec2 u_size;

layout(location = 0) out vec4 o_light;

// The picture goes on mirrored beyond its borders, so that neither light nor evenness is lost there.
vec2 mirrored(vec2 pixel) {
    pixel = abs(pixel);
    return clamp(u_size - abs(u_size - pixel), vec2(0.5), u_size - 0.5);
}

void main() {
    vec2 first = floor(gl_FragCoord.xy) * 4.0 - 1.5;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            vec2 tent = 4.0 - abs(vec2(x, y) - 3.5);
            vec3 light = textureLod(u_radiance, mirrored(first + vec2(x, y)) / u_size, 0.0).rgb;
            light = spread_part(contained(light));
            float weight = tent.x * tent.y;
#ifdef SUPPRESS_FIREFLIES
            weight /= 1.0 + largest(light);  // Karis 2013: the mean of what a tone curve would make of the light
#endif
            sum += light * weight;
            weights += weight;
        }
    }
    o_light = vec4(sum / weights, 1.0);
}
