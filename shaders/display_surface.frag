// Surfaces whose colour is shown as it is, into the overlay; those of points without normals shaded by eye-dome lighting.
#include "common_lanes.glsl"
#include "common_surface_kind.glsl"

#feature AMBIENT_OCCLUSION has_ambient_occlusion

uniform sampler2D u_albedo;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform vec2 u_size;
uniform sampler2D u_ambient_occlusion;

layout(location = 0) out vec4 o_color;

float depth_at(vec2 uv) { return textureLod(u_depth_target, uv, 0.0).r; }
#include "common_eye_dome.glsl"

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    float code = textureLod(u_material, uv, 0.0).w;
    if (!is_display(code)) discard;
    vec3 color = textureLod(u_albedo, uv, 0.0).rgb;
    bool shaded = is_eye_dome(code);
    if (any_lane(shaded)) {
        float light = eye_dome(uv, textureLod(u_depth_target, uv, 0.0).r);
        if (has_ambient_occlusion) light *= textureLod(u_ambient_occlusion, uv, 0.0).r;
        color *= shaded ? light : 1.0;
    }
    o_color = vec4(color, 1.0);
}
