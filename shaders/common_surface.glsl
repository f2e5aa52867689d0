// A surface as the models of lighting_plain.glsl and lighting_extended.glsl see it.
#include "common_brdf.glsl"
#include "common_extension.glsl"

uniform sampler2D u_dfg;
uniform float u_dielectric_f0;

struct Surface {
    vec3 position, normal, view, diffuse, f0;
    float n_dot_v, roughness, alpha;
    Energy energy;
    // With extensions:
    Extension extension;
    vec3 f90, film, through;
    float keep;  // of what is below all layers
    float sheen_albedo, sheen_keep, coat_albedo, coat_n_dot_v;
};

vec2 dfg_at(float n_dot_v, float roughness) {
    const float nodes = float(DFG_SIZE);
    return textureLod(u_dfg, (vec2(sqrt(min(n_dot_v, 1.0)), roughness) * (nodes - 1.0) + 0.5) / nodes, 0.0).rg;
}
