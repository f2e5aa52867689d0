// What the ground shows once it is lit: the part of its light that is missing, as black over whatever lies behind; or itself,
// fading into the background.
#include "common_camera.glsl"
#include "common_surface_kind.glsl"

#feature CATCHER is_catcher
#feature PART has_part

uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform vec4 u_middle;      // under the content, relative to the camera; w: radius at which nothing is left
// Of the catcher:
uniform sampler2D u_light;  // of lighting_catcher.frag
uniform sampler2D u_part;   // in its place: the part of the light that arrives
uniform float u_strength;

layout(location = 0) out vec4 o_color;  // the catcher's radiance; else a factor on radiance

// The part of a catcher's light that is missing, as black.
vec4 missing_light(vec2 uv) {
    float lit;
    if (has_part) {
        lit = textureLod(u_part, uv, 0.0).r;  // Of one frame of noisy light it may be more than 1.
    } else {
        vec2 light = textureLod(u_light, uv, 0.0).rg;
        lit = light.g > 0.0 ? light.r / light.g : 1.0;
    }
    return vec4(0.0, 0.0, 0.0, u_strength * (1.0 - lit));
}

// What is left of a plane, far from the content.
vec4 faded(vec2 uv) {
    vec3 p = u_world_from_view * view_position(gl_FragCoord.xy, textureLod(u_depth_target, uv, 0.0).r);
    return vec4(1.0 - smoothstep(0.4, 1.0, distance(p, u_middle.xyz) / u_middle.w));
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    float kind = textureLod(u_material, uv, 0.0).w;
    if (is_catcher ? !is_ground_catcher(kind) : !is_ground_plane(kind)) discard;
    o_color = is_catcher ? missing_light(uv) : faded(uv);
}
