// Surfaces with glTF's material extensions, as the G-buffer holds them.
#include "common_area_light.glsl"
#include "common_camera.glsl"
#include "common_lanes.glsl"
#include "common_surface.glsl"
#include "common_surface_kind.glsl"
#include "lighting_sky.glsl"
#include "lighting_extended.glsl"

uniform float u_tap_offset;  // in [0, 1), another one in each frame
uniform float u_tap_gap;     // between the offsets of all frames
uniform usampler2D u_extension0;
uniform usampler2D u_extension1;

// As that of lighting_plain.glsl.
void prepare(inout Surface s, vec3 albedo, float metallic, float kind) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    s.extension = plain_extension(s.normal, vec3(u_dielectric_f0));
    if (any_lane(is_extended(kind))) {
        Extension e = unpack_extension(texelFetch(u_extension0, pixel, 0), texelFetch(u_extension1, pixel, 0), s.normal);
        s.extension = chosen_extension(is_extended(kind), e, s.extension);
    }
    prepare_extended(s, albedo, metallic);
}

// Of what is below all layers: the part that they leave.
float kept_below(Surface s) { return s.keep; }

// What comes through of an area light of radiance 1, on the other side: the specular lobe around the way straight through.
vec3 area_transmitted(Light light, Surface s) {
    float roughness = transmitted_roughness(s);
    vec2 dfg = dfg_at(s.n_dot_v, roughness);
    vec3 mirrored = s.view - 2.0 * dot(s.normal, s.view) * s.normal;
    AreaLobe lobe = lobe_around(-s.normal, mirrored, ltc_at(s.n_dot_v, roughness));
    return transmittance_over(s.extension, s.extension.thickness) * s.through * ((dfg.x + dfg.y) * area_form(lobe, light, s.position));
}

// As that of lighting_plain_surface.glsl. Anisotropic lobes are those of their mean roughness, sheen is seen as matt.
vec3 area_scattered(Light light, Surface s) {
    Extension e = s.extension;
    float roughness = s.roughness, matt = area_irradiance(light, s.position, s.normal);
    if (has_anisotropy) {
        vec2 alpha = anisotropic_alpha(s, s.alpha);
        roughness = sqrt(sqrt(dot(alpha, alpha) * 0.5));
    }
    vec3 compensated = s.energy.f0;
    if (has_iridescence) compensated = mix(compensated, s.film, e.iridescence);
    AreaLobe lobe = lobe_around(s.normal, s.view, ltc_at(s.n_dot_v, roughness));
    vec3 result = s.energy.single * area_form(lobe, light, s.position);
    if (has_multiple_scattering) result *= compensation(compensated, s.energy.e);
    result += s.diffuse * matt;
    if (has_transmission) result += area_transmitted(light, s);
    if (has_sheen) result = result * s.sheen_keep + e.sheen_color * (min(s.sheen_albedo, 1.0) * matt);
    if (has_clearcoat) {
        float coat_roughness = max(e.coat_roughness, 0.045);
        AreaLobe coat = lobe_around(e.coat_normal, s.view, ltc_at(s.coat_n_dot_v, coat_roughness));
        result = result * (1.0 - s.coat_albedo) + s.coat_albedo * area_form(coat, light, s.position);
    }
    return result;
}

#include "lighting_extended_sky.glsl"
#ifdef BEHIND  // The driver compiles it for layers alone: only they are seen through.
#include "lighting_transmission.glsl"
#else
vec4 transmitted(Surface s) { return vec4(0.0, 0.0, 0.0, 1.0); }
#endif
