// Eye-dome lighting (Boucheny 2009), one-sided: a pixel is darkened by what lies before it, never by what lies behind.
// Whoever includes this says what reversed depth there is: float depth_at(vec2 uv).
#include "common_projection.glsl"

uniform vec2 u_eye_dome;     // strength, radius in pixels
uniform vec2 u_depth_scale;  // orthographic: log2 units per unit of depth

const vec2 eye_dome_ring[8] = vec2[](vec2(1.0, 0.0), vec2(0.70710678, 0.70710678), vec2(0.0, 1.0), vec2(-0.70710678, 0.70710678),
                                     vec2(-1.0, 0.0), vec2(-0.70710678, -0.70710678), vec2(0.0, -1.0),
                                     vec2(0.70710678, -0.70710678));

// How much nearer the reversed depth at a place is than `here`: as a ratio of distances, or orthographic, a difference.
float nearer_at(vec2 uv, float here) {
    float near = depth_at(uv);
    return is_orthographic ? max(near - here, 0.0) : clamp(near / here, 1.0, 1e4);
}

// How far, in doublings of the distance, the places of a ring lie before `here` together. A ratio of depths is the same at
// any scale of the scene; the logarithm of a product is the sum.
float before(vec2 uv, vec2 radius, float here) {
    float sum = 0.0, product = 1.0;
    for (int i = 0; i < 8; ++i) {
        float near = nearer_at(uv + eye_dome_ring[i] * radius, here);
        sum += near;
        product *= near;
    }
    return is_orthographic ? sum * u_depth_scale.x : log2(product);
}

float eye_dome(vec2 uv, float here) {
    // Three scales: the small one draws edges, the large ones give round shapes their shade.
    float shade = 0.0;
    for (int k = 0; k < 3; ++k) {
        vec2 radius = u_eye_dome.y * exp2(float(k)) / u_size;
        shade += exp(-300.0 * u_eye_dome.x * before(uv, radius, here) / 8.0);
    }
    return shade / 3.0;
}
