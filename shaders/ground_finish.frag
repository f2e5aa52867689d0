// What the ground shows once it is lit: the part of its light that is missing, as black over whatever lies behind; or itself,
// fading into the background.
#include "common_camera.glsl"
#include "common_caught.glsl"
#include "common_surface_kind.glsl"
#include "ground_fade.glsl"

#feature CATCHER is_catcher

uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform vec4 u_middle;      // under the content, relative to the camera; w: radius at which nothing is left

layout(location = 0) out vec4 o_color;  // the catcher's radiance; else a factor on radiance

// What is left of a plane, far from the content.
vec4 faded(vec2 uv) {
    vec3 p = u_world_from_view * view_position(gl_FragCoord.xy, textureLod(u_depth_target, uv, 0.0).r);
    return vec4(1.0 - ground_fade(distance(p, u_middle.xyz) / u_middle.w));
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    float kind = textureLod(u_material, uv, 0.0).w;
    if (is_catcher ? !is_ground_catcher(kind) : !is_ground_plane(kind)) discard;
    o_color = is_catcher ? vec4(0.0, 0.0, 0.0, missing_light(uv)) : faded(uv);
}
