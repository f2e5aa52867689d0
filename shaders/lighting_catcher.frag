// Light on a ground that is not seen itself: what reaches it, and what would reach it if nothing stood there. One block of
// lights after the other adds to both.
#include "common_area_light.glsl"
#include "common_encoding.glsl"
#include "common_camera.glsl"
#include "common_environment.glsl"
#include "common_surface_kind.glsl"
#include "common_lights.glsl"

#feature ENVIRONMENT has_environment
#feature AMBIENT_OCCLUSION has_ambient_occlusion
#feature TRACED has_traced_light

uniform sampler2D u_normal;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform samplerCube u_irradiance;
uniform float u_env_intensity;
uniform sampler2D u_ambient_occlusion;
uniform sampler2D u_sky_visibility;  // see render/raytrace/ray_pass.h

layout(location = 0) out vec4 o_light;  // r: with shadows, g: without

const float inverse_pi = 0.31830988618379067;

// As arriving_on_ground() of lighting_ground.glsl, but the luminance alone, which is all that o_light holds of a light: one number
// is multiplied and summed for each light and pixel in place of three. There the normal is the ground's, and the colour is mirrored.
float arriving_at(Light light, vec3 position, vec3 normal) {
    if (has_area_lights && light.position.w > 2.5) return luminance(light.color.rgb) * area_irradiance(light, position, normal);
    vec3 l;
    vec3 arrives = arriving(light, position, l);
    return luminance(arrives) * max(dot(normal, l), 0.0) * inverse_pi;
}

// The environment's, with and without what hides it.
vec2 sky_light(vec2 uv, vec3 normal) {
    vec3 sky = u_env_intensity * textureLod(u_irradiance, u_env_from_world * normal, 0.0).rgb;
    vec2 light = vec2(luminance(sky));
    if (has_traced_light) light.r = luminance(sky * texelFetch(u_sky_visibility, ivec2(gl_FragCoord.xy), 0).rgb);
    if (has_ambient_occlusion) light.r *= textureLod(u_ambient_occlusion, uv, 0.0).r;
    return light;
}

// The light of those with shadow maps, with and without shadows, is added.
void add_shadowed(inout vec2 light, vec3 position, vec3 normal) {
    for (int i = u_plain_lights; i < u_single_lights; ++i) {
        float arrives = arriving_at(u_lights[i], position, normal);
        light += arrives * vec2(brightness(shadow_single(i - u_plain_lights, position, normal, arrives > 0.0)), 1.0);
    }
    if (!has_shadow_cubes) return;
    for (int i = u_single_lights; i < u_block_lights; ++i) {
        float arrives = arriving_at(u_lights[i], position, normal);
        light += arrives * vec2(brightness(shadow_cube(i - u_plain_lights, position, normal, arrives > 0.0)), 1.0);
    }
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    if (!is_ground_catcher(textureLod(u_material, uv, 0.0).w)) discard;
    vec3 position = u_world_from_view * view_position(gl_FragCoord.xy, textureLod(u_depth_target, uv, 0.0).r);
    vec3 normal = oct_decode(textureLod(u_normal, uv, 0.0).rg * 2.0 - 1.0);
    vec2 light = has_environment ? sky_light(uv, normal) : vec2(0.0);
    for (int i = 0; i < u_plain_lights; ++i) light += arriving_at(u_lights[i], position, normal);
    if (has_shadows) add_shadowed(light, position, normal);
    o_light = vec4(light, 0.0, 0.0);
}
