// Cook-Torrance with the GGX distribution (Walter et al. 2007), alpha = roughness^2.
#feature BRDF_UE4 has_ue4_masking
#feature BRDF_SEPARABLE has_separable_masking
#feature MULTIPLE_SCATTERING has_multiple_scattering

const float pi = 3.14159265358979323846;

// GGX / Trowbridge-Reitz.
float D_ggx(float n_dot_h, float alpha) {
    float a2 = alpha * alpha;
    float f = (n_dot_h * a2 - n_dot_h) * n_dot_h + 1.0;
    return a2 / (pi * f * f);
}

// V = G / (4 NoV NoL).
float V_smith(float n_dot_v, float n_dot_l, float roughness) {
    float alpha = roughness * roughness;
    if (has_ue4_masking) {
        // Schlick's approximation with Karis's remapping for analytic lights (Karis 2013): the paper's form.
        float k = (roughness + 1.0) * (roughness + 1.0) / 8.0;
        return 0.25 / ((n_dot_v * (1.0 - k) + k) * (n_dot_l * (1.0 - k) + k));
    }
    float a2 = alpha * alpha;
    if (has_separable_masking) {
        float v = n_dot_v + sqrt(n_dot_v * n_dot_v * (1.0 - a2) + a2);
        float l = n_dot_l + sqrt(n_dot_l * n_dot_l * (1.0 - a2) + a2);
        return 1.0 / (v * l);
    }
    // Height-correlated Smith (Heitz 2014).
    float v = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - a2) + a2);
    float l = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - a2) + a2);
    return 0.5 / (v + l);
}

// Schlick 1994.
vec3 F_schlick(float v_dot_h, vec3 f0) {
    float c = 1.0 - v_dot_h;
    float c2 = c * c;
    return f0 + (1.0 - f0) * (c2 * c2 * c);
}

// What the split sum (Karis 2013) with multiple scattering (Fdez-Aguera 2019, with kS = F0 because the table already
// integrates Fresnel) makes of a surface seen from one direction.
struct Energy {
    vec3 single;    // reflected after one bounce: F0 A + B
    vec3 multiple;  // reflected after more bounces
    vec3 f0;        // by which single is brought to both: see compensation()
    float e;        // directional albedo at F = 1
};

Energy surface_energy(vec3 f0, vec2 dfg) {
    Energy energy;
    energy.e = dfg.x + dfg.y;
    energy.single = f0 * dfg.x + dfg.y;
    energy.f0 = f0;
    float missing = 1.0 - energy.e;
    vec3 f_average = f0 + (1.0 - f0) / 21.0;
    energy.multiple = vec3(0.0);
    if (has_multiple_scattering)
        energy.multiple = missing * energy.single * f_average / (1.0 - f_average * missing);
    return energy;
}

// A dielectric beside a metal, whose part of the surface `metallic` is: their BRDFs are mixed (glTF 2.0, Appendix B).
Energy mixed_energy(Energy dielectric, Energy metal, float metallic) {
    Energy energy;
    energy.e = metal.e;
    energy.single = mix(dielectric.single, metal.single, metallic);
    energy.multiple = mix(dielectric.multiple, metal.multiple, metallic);
    energy.f0 = mix(dielectric.single * dielectric.f0, metal.single * metal.f0, metallic) / max(energy.single, 1e-6);
    return energy;
}

// Light after one bounce times this is that after all (Turquin 2019).
vec3 compensation(vec3 f0, float e) { return 1.0 + f0 * (1.0 / e - 1.0); }
