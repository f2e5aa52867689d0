// Eye-dome lighting (Boucheny 2009), one-sided: a pixel is darkened by what lies before it, never by what lies behind.
// Whoever includes this says what reversed depth there is: float depth_at(vec2 uv).
#include "common_projection.glsl"

uniform vec2 u_eye_dome;     // strength, radius in pixels
uniform vec2 u_depth_scale;  // orthographic: log2 units per unit of depth

// How far, in doublings of the distance, `near` lies before `here`; both reversed depths. A ratio of depths is the same
// at any scale of the scene.
float before(float here, float near) {
    if (near <= here) return 0.0;
    return is_orthographic ? (near - here) * u_depth_scale.x : log2(near / here);
}

float eye_dome(vec2 uv, float here) {
    const vec2 ring[8] = vec2[](vec2(1.0, 0.0), vec2(0.70710678, 0.70710678), vec2(0.0, 1.0), vec2(-0.70710678, 0.70710678),
                                vec2(-1.0, 0.0), vec2(-0.70710678, -0.70710678), vec2(0.0, -1.0),
                                vec2(0.70710678, -0.70710678));
    // Three scales: the small one draws edges, the large ones give round shapes their shade.
    float shade = 0.0;
    for (int k = 0; k < 3; ++k) {
        vec2 radius = u_eye_dome.y * exp2(float(k)) / u_size;
        float sum = 0.0;
        for (int i = 0; i < 8; ++i) sum += before(here, depth_at(uv + ring[i] * radius));
        shade += exp(-300.0 * u_eye_dome.x * sum / 8.0);
    }
    return shade / 3.0;
}
