// Surfaces whose colour is shown as it is, into the overlay; those of points without normals shaded by eye-dome lighting
// (Boucheny 2009), one-sided: a pixel is darkened by what lies before it, never by what lies behind.
#include "common_surface_kind.glsl"

uniform sampler2D u_albedo;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform vec2 u_size;
uniform vec2 u_eye_dome;     // strength, radius in pixels
#ifdef AMBIENT_OCCLUSION
uniform sampler2D u_ambient_occlusion;
#endif
uniform vec2 u_depth_scale;  // ORTHOGRAPHIC: log2 units per unit of depth

layout(location = 0) out vec4 o_color;

// How far, in doublings of the distance, `near` lies before `here`; both reversed depths. A ratio of depths is the same
// at any scale of the scene.
float before(float here, float near) {
    if (near <= here) return 0.0;
#ifdef ORTHOGRAPHIC
    return (near - here) * u_depth_scale.x;
#else
    return log2(near / here);
#endif
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
        for (int i = 0; i < 8; ++i) sum += before(here, textureLod(u_depth_target, uv + ring[i] * radius, 0.0).r);
        shade += exp(-300.0 * u_eye_dome.x * sum / 8.0);
    }
    return shade / 3.0;
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    float code = textureLod(u_material, uv, 0.0).w;
    if (!is_display(code)) discard;
    vec3 color = textureLod(u_albedo, uv, 0.0).rgb;
    if (is_eye_dome(code)) {
        color *= eye_dome(uv, textureLod(u_depth_target, uv, 0.0).r);
#ifdef AMBIENT_OCCLUSION
        color *= textureLod(u_ambient_occlusion, uv, 0.0).r;
#endif
    }
    o_color = vec4(color, 1.0);
}
