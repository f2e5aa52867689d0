// Lights the G-buffer: analytic lights and the environment.
#include "common_encoding.glsl"
#include "common_camera.glsl"
#include "common_environment.glsl"
#include "common_brdf.glsl"
#include "common_surface_kind.glsl"
#ifdef EXTENDED
#include "common_extension.glsl"
#include "common_lobes.glsl"
#endif

uniform sampler2D u_albedo;
uniform sampler2D u_normal;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform sampler2D u_dfg;
uniform float u_dielectric_f0;

#ifdef EXTENDED
layout(location = 0, index = 0) out vec4 o_radiance;
layout(location = 0, index = 1) out vec4 o_keep;  // of the emission that stands in the target
uniform float u_first_block;
#else
layout(location = 0) out vec4 o_radiance;
#endif

uniform float u_tap_offset;  // in [0, 1), another one in each frame
uniform float u_tap_gap;     // between the offsets of all frames
#ifdef ENVIRONMENT
uniform samplerCube u_prefiltered;
uniform samplerCube u_irradiance;
uniform float u_last_level;
uniform float u_env_intensity;
#ifdef AMBIENT_OCCLUSION
uniform sampler2D u_ambient_occlusion;
#endif
#ifdef LOBE_SAMPLES
uniform float u_lobe_slope;  // of the facet that this frame reflects in, in units of alpha
#endif
#endif

#include "common_lights.glsl"

struct Surface {
    vec3 position, normal, view, diffuse, f0;
    float n_dot_v, roughness, alpha;
    Energy energy;
#ifdef EXTENDED
    Extension extension;
    vec3 f90, film, through;
    float keep;  // of what is below all layers
    float sheen_albedo, sheen_keep, coat_albedo, coat_n_dot_v;
#endif
};

vec2 dfg_at(float n_dot_v, float roughness) {
    const float nodes = float(DFG_SIZE);
    return textureLod(u_dfg, (vec2(sqrt(min(n_dot_v, 1.0)), roughness) * (nodes - 1.0) + 0.5) / nodes, 0.0).rg;
}

#ifdef ENVIRONMENT
vec3 prefiltered(vec3 direction, float roughness) {
    return textureLod(u_prefiltered, u_env_from_world * direction, prefiltered_level(roughness, u_last_level)).rgb;
}

// Average radiance in the specular lobe.
vec3 lobe_radiance(vec3 normal, vec3 view, float n_dot_v, float roughness, float alpha) {
    // The lobe leans towards the normal the more the rougher the surface is.
    vec3 dominant = normalize(mix(reflect(-view, normal), normal, alpha * alpha));
#ifdef LOBE_SAMPLES
    // Seen from the side a lobe is NoV times as wide across the plane of incidence as within it, whereas the
    // environment is prefiltered for NoV = 1. The frames of an accumulated picture take it narrower, side by side
    // within the plane.
    float narrowed = mix(min(n_dot_v, 1.0), 1.0, alpha);
    float slope = u_lobe_slope * alpha * sqrt(1.0 - narrowed * narrowed);
    vec3 facet = normalize(view + dominant);
    vec3 within = view - facet * dot(facet, view);
    vec3 h = normalize(facet + within * (slope * inversesqrt(max(dot(within, within), 1e-12))));
    return prefiltered(reflect(-view, h), roughness * sqrt(narrowed));
#else
    return prefiltered(dominant, roughness);
#endif
}

#include "lighting_sky.glsl"
#endif

#ifdef EXTENDED
#include "lighting_extended.glsl"
#ifdef BEHIND
#include "lighting_transmission.glsl"
#endif
#else
// Light from one direction into the view: the BRDF times the cosine. Compensation of multiple scattering as Turquin 2019.
vec3 scattered(vec3 l, Surface s) {
    vec3 h = normalize(l + s.view);
    float n_dot_l = clamp(dot(s.normal, l), 0.0, 1.0);
    float n_dot_h = clamp(dot(s.normal, h), 0.0, 1.0);
    float v_dot_h = clamp(dot(s.view, h), 0.0, 1.0);
    vec3 specular = D_ggx(n_dot_h, s.alpha) * V_smith(s.n_dot_v, max(n_dot_l, 1e-5), s.roughness) * F_schlick(v_dot_h, s.f0);
#ifdef MULTIPLE_SCATTERING
    specular *= 1.0 + s.f0 * (1.0 / s.energy.e - 1.0);
#endif
    return n_dot_l * (s.diffuse / pi + specular);
}
#endif

// Radiance from one light.
vec3 direct(Light light, Surface s) {
    vec3 l;
    vec3 arrives = arriving(light, s.position, l);
    return arrives * scattered(l, s);
}

#if defined(ENVIRONMENT) && !defined(EXTENDED)
// Light of the environment on a surface that sees a part of it.
vec3 indirect(Surface s, float visibility) {
    vec3 lobe = lobe_radiance(s.normal, s.view, s.n_dot_v, s.roughness, s.alpha);
    return s.energy.single * mirrored_light(lobe, s.n_dot_v, s.alpha, visibility, s.f0) +
           (s.energy.multiple + s.diffuse) * diffuse_light(s.normal, visibility, s.diffuse);
}
#endif

#ifdef SHADOWS
// Normal of the surface itself, in view space: from the depths of neighbours, of each two the one that is nearer.
vec3 face_normal(vec2 pixel, vec3 center) {
    float d = textureLod(u_depth_target, pixel / u_size, 0.0).r;
    vec3 along[2];
    for (int axis = 0; axis < 2; ++axis) {
        vec2 step = axis == 0 ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
        float before = textureLod(u_depth_target, (pixel - step) / u_size, 0.0).r;
        float after = textureLod(u_depth_target, (pixel + step) / u_size, 0.0).r;
        // The picture's border has a neighbour on one side only.
        bool first = pixel[axis] < 1.0, last = pixel[axis] > u_size[axis] - 1.0;
        bool forwards = !last && (first || abs(after - d) < abs(before - d));
        vec3 other = view_position(forwards ? pixel + step : pixel - step, forwards ? after : before);
        along[axis] = forwards ? other - center : center - other;
    }
    // Rows run downwards.
    vec3 n = normalize(cross(along[1], along[0]));
    return n;
}
#endif

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
#ifdef EXTENDED
    prepare_extended(s, albedo, metallic, is_extended(material.w), ivec2(gl_FragCoord.xy));
#else
    s.f0 = mix(vec3(u_dielectric_f0), albedo, metallic);
    s.energy = surface_energy(s.f0, dfg_at(s.n_dot_v, s.roughness));
    s.diffuse = albedo * (1.0 - metallic) * (1.0 - s.energy.single - s.energy.multiple);
#endif

    vec3 radiance = vec3(0.0);
#ifdef ENVIRONMENT
    float visibility = material.z;
#ifdef TRACED
    visibility = texelFetch(u_sky_visibility, ivec2(gl_FragCoord.xy), 0).a;
#endif
#ifdef AMBIENT_OCCLUSION
    // What the material's own occlusion says of recesses and what the depth buffer says overlap: the darker counts.
    visibility = min(visibility, textureLod(u_ambient_occlusion, uv, 0.0).r);
#endif
    radiance = indirect(s, visibility);
#endif
    float coverage = 1.0;
#ifdef BEHIND
    if (u_first_block > 0.5 && is_lit(material.w)) {
        vec4 light = transmitted(s);
        radiance += light.rgb;
        coverage = light.a;
    }
#endif
    s.roughness = light_roughness;
    s.alpha = light_roughness * light_roughness;
    for (int i = 0; i < u_plain_lights; ++i) radiance += direct(u_lights[i], s);
#ifdef SHADOWS
    vec3 face = u_world_from_view * face_normal(gl_FragCoord.xy, view_p);
    face = dot(face, s.normal) < 0.3 ? s.normal : face;
    for (int i = u_plain_lights; i < u_single_lights; ++i) {
        vec3 light = direct(u_lights[i], s);
        radiance += light * shadow_single(i - u_plain_lights, s.position, face, any(greaterThan(light, vec3(0.0))));
    }
#ifdef SHADOW_CUBES
    for (int i = u_single_lights; i < u_cube_lights; ++i) {
        vec3 light = direct(u_lights[i], s);
        radiance += light * shadow_cube(i - u_plain_lights, s.position, face, any(greaterThan(light, vec3(0.0))));
    }
#endif
#endif
    o_radiance = vec4(is_lit(material.w) ? radiance : vec3(0.0), coverage);
#ifdef EXTENDED
    o_keep = vec4(is_lit(material.w) && u_first_block > 0.5 ? s.keep : 1.0);
#endif
}
