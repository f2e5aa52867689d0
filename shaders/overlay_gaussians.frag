// What a Gaussian splat adds to a pixel, sRGB-encoded and premultiplied: blended from the farthest on.
#include "common_splat.glsl"

#feature SOFT is_soft
#feature LIMITED is_limited

uniform sampler2D u_depth_target;  // reversed depth of the surface, 0 where there is none

flat in uint v_splat;

layout(location = 0) out vec4 o_color;

const float reach = 3.5;  // standard deviations along the ray, beyond which a splat has nothing
const float farthest_part = 0.1, farthest_straight_part = 1e-3, flat_deviations = 100.0;  // as native/kernels.h

// Abramowitz and Stegun 1964, 26.2.17.
float normal_cdf(float deviations) {
    float x = min(abs(deviations), 10.0), t = 1.0 / (1.0 + 0.2316419 * x);
    float tail = 0.39894228 * exp(-0.5 * x * x) * t *
                 (0.319381530 + t * (-0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))));
    return deviations < 0.0 ? tail : 1.0 - tail;
}

// Where a splat is densest along the pixel's ray, reversed depth, and what deviations are multiplied with (see
// native/kernels.h).
vec2 densest(ScreenSplat s, vec2 d, float power) {
    float first_order = dot(s.depths.xy, d) + s.color.w;
    if (!(s.depths.w > 0.0)) return vec2(first_order, 1.0);
    if (s.depths.w * s.depths.z >= flat_deviations)
        return vec2(clamp(first_order, farthest_part * s.depths.w, 1.0), 1.0);
    float straight = max(first_order, farthest_straight_part * s.depths.w);
    float depth = straight + 2.0 / (s.depths.z * s.depths.z) * max(power, 0.0) / straight;
    return vec2(min(depth, 1.0), sqrt(straight / depth));
}

void main() {
    ScreenSplat s = splats[v_splat];
    vec2 d = gl_FragCoord.xy - s.place.xy;
    float power = (0.5 * s.shape.x * d.x + s.shape.y * d.y) * d.x + 0.5 * s.shape.z * d.y * d.y;
    if (any(greaterThan(abs(d), s.place.zw)) || power > log(s.shape.w / least_alpha)) discard;
    float alpha = min(s.shape.w * exp(-power), most_alpha);
    float surface = is_limited ? texelFetch(u_depth_target, ivec2(gl_FragCoord.xy), 0).r : 0.0;
    if (surface > 0.0) {
        // In deviations of distances, as native/simd/blend_splats.h has them.
        float scale = s.depths.w > 0.0 ? s.depths.w / surface : 1.0, margin = is_soft ? reach : 0.0;
        vec2 at = densest(s, d, power);
        float before = (at.x - surface) * s.depths.z * at.y * scale;
        if (before < -margin) discard;
        // The part before the surface of a medium with this density.
        if (before < margin) alpha = 1.0 - exp(normal_cdf(before) * log(1.0 - alpha));
    }
    o_color = vec4(s.color.rgb, 1.0) * alpha;
}
