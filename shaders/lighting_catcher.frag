// Light on a ground that is not seen itself: what reaches it, and what would reach it if nothing stood there. One block of
// lights after the other adds to both.
#include "common_encoding.glsl"
#include "common_camera.glsl"
#include "common_environment.glsl"
#include "common_surface_kind.glsl"
#include "common_lights.glsl"

uniform sampler2D u_normal;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
#ifdef ENVIRONMENT
uniform samplerCube u_irradiance;
uniform float u_env_intensity;
#ifdef AMBIENT_OCCLUSION
uniform sampler2D u_ambient_occlusion;
#endif
#ifdef TRACED
uniform sampler2D u_sky_visibility;  // see render/ray_pass.h
#endif
#endif

layout(location = 0) out vec4 o_light;  // r: with shadows, g: without

const float inverse_pi = 0.31830988618379067;

float arriving_at(Light light, vec3 position, vec3 normal) {
    vec3 l;
    vec3 arrives = arriving(light, position, l);
    return luminance(arrives) * max(dot(normal, l), 0.0) * inverse_pi;
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    if (!is_ground_catcher(textureLod(u_material, uv, 0.0).w)) discard;
    vec3 position = u_world_from_view * view_position(gl_FragCoord.xy, textureLod(u_depth_target, uv, 0.0).r);
    vec3 normal = oct_decode(textureLod(u_normal, uv, 0.0).rg * 2.0 - 1.0);
    vec2 light = vec2(0.0);
#ifdef ENVIRONMENT
    vec3 sky = u_env_intensity * textureLod(u_irradiance, u_env_from_world * normal, 0.0).rgb;
    light = vec2(luminance(sky));
#ifdef TRACED
    light.r = luminance(sky * texelFetch(u_sky_visibility, ivec2(gl_FragCoord.xy), 0).rgb);
#endif
#ifdef AMBIENT_OCCLUSION
    light.r *= textureLod(u_ambient_occlusion, uv, 0.0).r;
#endif
#endif
    for (int i = 0; i < u_plain_lights; ++i) light += arriving_at(u_lights[i], position, normal);
#ifdef SHADOWS
    for (int i = u_plain_lights; i < u_single_lights; ++i) {
        float arrives = arriving_at(u_lights[i], position, normal);
        light += arrives * vec2(brightness(shadow_single(i - u_plain_lights, position, normal, arrives > 0.0)), 1.0);
    }
#ifdef SHADOW_CUBES
    for (int i = u_single_lights; i < u_cube_lights; ++i) {
        float arrives = arriving_at(u_lights[i], position, normal);
        light += arrives * vec2(brightness(shadow_cube(i - u_plain_lights, position, normal, arrives > 0.0)), 1.0);
    }
#endif
#endif
    o_light = vec4(light, 0.0, 0.0);
}
