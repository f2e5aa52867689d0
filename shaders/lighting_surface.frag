// Lights the G-buffer: analytic lights and the environment.
#include "common_area_light.glsl"
#include "common_brdf.glsl"
#include "common_camera.glsl"
#include "common_encoding.glsl"
#include "common_extension.glsl"
#include "common_lights.glsl"
#include "common_surface_kind.glsl"

#feature BEHIND sees_behind
#feature AMBIENT_OCCLUSION has_ambient_occlusion
#feature EMISSION has_emission  // natively; the driver adds light to the emission that stands in the target

uniform sampler2D u_albedo;
uniform sampler2D u_normal;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform sampler2D u_emission;
uniform sampler2D u_ambient_occlusion;
uniform float u_first_block;  // 1: of the first block of lights, which adds what lies behind and below all layers
uniform float u_tap_offset;   // in [0, 1), another one in each frame
uniform float u_tap_gap;      // between the offsets of all frames

#ifdef EXTENDED  // A second source is an error where there are several targets.
layout(location = 0, index = 0) out vec4 o_radiance;
layout(location = 0, index = 1) out vec4 o_keep;  // of the emission that stands in the target
#else
layout(location = 0) out vec4 o_radiance;
#endif

#include "common_surface.glsl"
#include "common_face_normal.glsl"
#include "lighting_sky.glsl"

// Each model has prepare(), scattered(), area_scattered() and indirect().
#ifdef EXTENDED  // Compiling the model that no one asks for takes as long as all else.
#include "lighting_extended_surface.glsl"
#else
#include "lighting_plain_surface.glsl"
#endif
#ifdef BEHIND  // As above.
#include "lighting_transmission.glsl"
#else
vec4 transmitted(Surface s) { return vec4(0.0, 0.0, 0.0, 1.0); }
#endif

// Radiance from one light.
vec3 direct(Light light, Surface s) {
    if (has_area_lights && light.position.w > 2.5) return light.color.rgb * area_scattered(light, s);
    vec3 l;
    vec3 arrives = arriving(light, s.position, l);
    return arrives * scattered(l, s);
}

// Radiance from the lights with shadow maps; `view_p` is the surface's position in view space.
void add_shadowed(inout vec3 radiance, Surface s, vec3 view_p) {
    vec3 face = u_world_from_view * face_normal(gl_FragCoord.xy, view_p);
    face = dot(face, s.normal) < 0.3 ? s.normal : face;
    for (int i = u_plain_lights; i < u_single_lights; ++i) {
        vec3 light = direct(u_lights[i], s);
        radiance += light * shadow_single(i - u_plain_lights, s.position, face, any(greaterThan(light, vec3(0.0))));
    }
    if (!has_shadow_cubes) return;
    for (int i = u_single_lights; i < u_cube_lights; ++i) {
        vec3 light = direct(u_lights[i], s);
        radiance += light * shadow_cube(i - u_plain_lights, s.position, face, any(greaterThan(light, vec3(0.0))));
    }
}

// Light of the environment; `material_occlusion` is the material's own.
vec3 environment_light(Surface s, vec2 uv, float material_occlusion) {
    float visibility = material_occlusion;
    if (has_traced_light) visibility = texelFetch(u_sky_visibility, ivec2(gl_FragCoord.xy), 0).a;
    // What the material's own occlusion says of recesses and what the depth buffer says overlap: the darker counts.
    if (has_ambient_occlusion) visibility = min(visibility, textureLod(u_ambient_occlusion, uv, 0.0).r);
    return indirect(s, visibility);
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    vec3 albedo = textureLod(u_albedo, uv, 0.0).rgb;
    vec4 material = textureLod(u_material, uv, 0.0);
    vec3 view_p = view_position(gl_FragCoord.xy, textureLod(u_depth_target, uv, 0.0).r);

    Surface s;
    s.position = u_world_from_view * view_p;
    s.normal = oct_decode(textureLod(u_normal, uv, 0.0).rg * 2.0 - 1.0);
    s.view = -ray_direction(gl_FragCoord.xy);
    // Interpolated normals may face away at silhouettes; 1e-5 keeps the divisions finite.
    s.n_dot_v = abs(dot(s.normal, s.view)) + 1e-5;
    float metallic = material.x;
    s.roughness = material.y;
    // Below 0.045 the peak of D leaves the range where 32-bit floats resolve NoH (Lagarde and de Rousiers 2014).
    float light_roughness = max(s.roughness, 0.045);
    s.alpha = s.roughness * s.roughness;
    prepare(s, albedo, metallic, material.w);

    vec3 radiance = has_environment ? environment_light(s, uv, material.z) : vec3(0.0);
    float coverage = 1.0;
    if (sees_behind && u_first_block > 0.5) {
        vec4 light = is_lit(material.w) ? transmitted(s) : vec4(0.0, 0.0, 0.0, 1.0);
        radiance += light.rgb;
        coverage = light.a;
    }
    s.roughness = light_roughness;
    s.alpha = light_roughness * light_roughness;
    for (int i = 0; i < u_plain_lights; ++i) radiance += direct(u_lights[i], s);
    if (has_shadows) add_shadowed(radiance, s, view_p);
    vec3 emission = has_emission ? texelFetch(u_emission, ivec2(gl_FragCoord.xy), 0).rgb : vec3(0.0);
    o_radiance = vec4((is_lit(material.w) ? radiance : vec3(0.0)) + emission, coverage);
#ifdef EXTENDED  // As above.
    o_keep = vec4(is_lit(material.w) && u_first_block > 0.5 ? s.keep : 1.0);
#endif
}
