// Lights the G-buffer: analytic lights and the environment. Included after the model of its surfaces, which has prepare(),
// scattered(), area_scattered(), indirect(), transmitted() and kept_below(), and write_light().
#include "common_area_light.glsl"
#include "common_brdf.glsl"
#include "common_camera.glsl"
#include "common_encoding.glsl"
#include "common_extension.glsl"
#include "common_lanes.glsl"
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

#include "common_face_normal.glsl"

// Radiance from one light, and the direction to it; none to an area.
vec3 direct(Light light, Surface s, out vec3 l) {
    l = vec3(0.0);
    if (has_area_lights && light.position.w > 2.5) return light.color.rgb * area_scattered(light, s);
    vec3 arrives = arriving(light, s.position, l);
    return arrives * scattered(l, s);
}

// 1 where `face` is the normal of a plane around the pixel, view space. The depths of a point do not tell its own.
float plane_around(vec3 view_p, vec3 face, bool is_point) {
    float planar = planarity(gl_FragCoord.xy, view_p, face);
    return is_point ? 0.0 : planar;
}

// The lights of the block; `view_p` is the surface's position in view space.
vec3 light_of_block(Surface s, vec3 view_p, bool lit, bool is_point) {
    vec3 face = s.normal, flat_normal = s.normal, radiance = vec3(0.0);
    float planar = 0.0;
    bool is_known = false;
    if (has_shadows) {
        flat_normal = face_normal(gl_FragCoord.xy, view_p);
        face = u_world_from_view * flat_normal;
        // At edges the depths around a pixel tell of no plane, and of one without neighbours it is no number.
        bool agrees = dot(face, s.normal) >= 0.3;
        if (any_lane(lit && !agrees)) {
            planar = plane_around(view_p, flat_normal, is_point);
            is_known = true;
        }
        face = agrees || planar > 0.5 ? face : s.normal;
    }
    for (int i = 0; i < u_block_lights; ++i) {
        vec3 l;
        vec3 light = direct(u_lights[i], s, l);
        if (has_shadows && i >= u_plain_lights) {
            bool needed = lit && any(greaterThan(light, vec3(0.0)));
            light *= shadow_of(i, s.position, face, needed);
            // Normals that are bent or interpolated may face a light behind the surface, which the map does not tell: the
            // surface itself is what hides it.
            float cosine = dot(face, l);
            bool behind = needed && cosine < 0.0 && dot(s.normal, l) > 0.0;
            if (any_lane(behind && !is_known)) {
                planar = plane_around(view_p, flat_normal, is_point);
                is_known = true;
            }
            light *= behind && planar > 0.5 ? max(1.0 + cosine / least_cosine, 0.0) : 1.0;
        }
        radiance += light;
    }
    return radiance;
}

// Light of the environment and of the ground; `material_occlusion` is the material's own.
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
    bool lit = is_lit(material.w);
    vec3 emission = has_emission ? texelFetch(u_emission, ivec2(gl_FragCoord.xy), 0).rgb : vec3(0.0);
    if (!any_lane(lit)) {
        write_light(emission, 1.0, 1.0);
        return;
    }
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

    vec3 radiance = has_environment || has_ground ? environment_light(s, uv, material.z) : vec3(0.0);
    float coverage = 1.0;
    if (sees_behind && u_first_block > 0.5) {
        vec4 light = lit ? transmitted(s) : vec4(0.0, 0.0, 0.0, 1.0);
        radiance += light.rgb;
        coverage = light.a;
    }
    s.roughness = light_roughness;
    s.alpha = light_roughness * light_roughness;
    radiance += light_of_block(s, view_p, lit, is_lit_point(material.w));
    float keep = lit && u_first_block > 0.5 ? kept_below(s) : 1.0;
    write_light((lit ? radiance : vec3(0.0)) + keep * emission, coverage, keep);
}
