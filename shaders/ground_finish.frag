// What the ground shows once it is lit: the part of its light that is missing, as black over whatever lies behind; or itself,
// fading into the background.
#include "common_camera.glsl"
#include "common_surface_kind.glsl"

uniform sampler2D u_material;
#ifdef CATCHER
uniform sampler2D u_light;  // of lighting_catcher.frag
uniform float u_strength;
#else
uniform sampler2D u_depth_target;
uniform vec4 u_middle;      // under the content, relative to the camera; w: radius at which nothing is left
#endif

layout(location = 0) out vec4 o_color;  // CATCHER: radiance; else a factor on it

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    float kind = textureLod(u_material, uv, 0.0).w;
#ifdef CATCHER
    if (!is_ground_catcher(kind)) discard;
    vec2 light = textureLod(u_light, uv, 0.0).rg;
    float lit = light.g > 0.0 ? clamp(light.r / light.g, 0.0, 1.0) : 1.0;
    o_color = vec4(0.0, 0.0, 0.0, u_strength * (1.0 - lit));
#else
    if (!is_ground_plane(kind)) discard;
    vec3 p = u_world_from_view * view_position(gl_FragCoord.xy, textureLod(u_depth_target, uv, 0.0).r);
    o_color = vec4(1.0 - smoothstep(0.4, 1.0, distance(p, u_middle.xyz) / u_middle.w));
#endif
}
