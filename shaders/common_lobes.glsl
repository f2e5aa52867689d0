// Lobes of glTF's material extensions.
#include "common_brdf.glsl"

float max_channel(vec3 v) { return max(v.r, max(v.g, v.b)); }

vec3 F_schlick90(float v_dot_h, vec3 f0, vec3 f90) {
    float c = 1.0 - v_dot_h;
    float c2 = c * c;
    return f0 + (f90 - f0) * (c2 * c2 * c);
}

// As surface_energy() of common_brdf.glsl, with a reflectance at grazing angles other than 1 (KHR_materials_specular).
Energy surface_energy(vec3 f0, vec3 f90, vec2 dfg) {
    Energy energy;
    energy.e = dfg.x + dfg.y;
    energy.single = f0 * dfg.x + f90 * dfg.y;
    energy.f0 = f0;
    float missing = 1.0 - energy.e;
    vec3 f_average = f0 + (f90 - f0) / 21.0;
    energy.multiple = vec3(0.0);
    if (has_multiple_scattering)
        energy.multiple = missing * energy.single * f_average / (1.0 - f_average * missing);
    return energy;
}

// KHR_materials_anisotropy: GGX with two roughnesses, along the tangent and along the bitangent (Burley 2012), with
// height-correlated Smith masking. x, y, z of a direction are its cosines with tangent, bitangent and normal.
float D_ggx_anisotropic(vec3 h, vec2 alpha) {
    float a2 = alpha.x * alpha.y;
    vec3 f = vec3(alpha.y * h.x, alpha.x * h.y, a2 * h.z);
    float w = a2 / dot(f, f);
    return a2 * w * w / pi;
}

float V_smith_anisotropic(vec3 v, vec3 l, vec2 alpha) {
    return 0.5 / (l.z * length(vec3(alpha * v.xy, v.z)) + v.z * length(vec3(alpha * l.xy, l.z)));
}

// KHR_materials_sheen: Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF". The table of its albedo is made
// from the same formulas and the same limit in gpu/tools/generate_dfg.cpp: change both. Below this roughness the fit of its
// shadowing gives back more than it gets by far.
const float least_sheen_roughness = 0.07;

float D_charlie(float n_dot_h, float roughness) {
    float inverse = 1.0 / (roughness * roughness);
    float sine2 = max(1.0 - n_dot_h * n_dot_h, 1e-8);
    return (2.0 + inverse) * pow(sine2, 0.5 * inverse) / (2.0 * pi);
}

float charlie_fit(float x, float smooth2) {
    float a = mix(21.5473, 25.3245, smooth2), b = mix(3.82987, 3.32435, smooth2), c = mix(0.19823, 0.16801, smooth2);
    float d = mix(-1.97760, -1.27393, smooth2), e = mix(-4.32054, -4.85967, smooth2);
    return a / (1.0 + b * pow(x, c)) + d * x + e;
}

float charlie_lambda(float cosine, float roughness) {
    float smooth1 = 1.0 - roughness * roughness, smooth2 = smooth1 * smooth1;
    return cosine < 0.5 ? exp(charlie_fit(cosine, smooth2))
                        : exp(2.0 * charlie_fit(0.5, smooth2) - charlie_fit(1.0 - cosine, smooth2));
}

float V_charlie(float n_dot_v, float n_dot_l, float roughness) {
    return 1.0 / ((1.0 + charlie_lambda(n_dot_v, roughness) + charlie_lambda(n_dot_l, roughness)) * 4.0 * n_dot_v * n_dot_l);
}

// KHR_materials_iridescence: Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of
// Varying Iridescence", with Schlick's Fresnel and real indices, as the extension has it.

vec3 reflectance_between(vec3 n1, vec3 n2) {
    vec3 r = (n1 - n2) / (n1 + n2);
    return r * r;
}

// The spectrum's response to cos(phase), integrated over the eye's sensitivities, which are sums of Gaussians in the
// wave number; linear Rec.709.
vec3 film_response(float path, vec3 shift) {
    const mat3 rec709_from_xyz =
        mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560, 1.0572252);
    const vec3 height = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13), centre = vec3(1.6810e+06, 1.7953e+06, 2.2084e+06),
               variance = vec3(4.3278e+09, 9.3046e+09, 6.6121e+09);
    const float second_height = 9.7470e-14, second_centre = 2.2399e+06, second_variance = 4.5282e+09;
    float phase = 2.0 * pi * path * 1e-9;
    vec3 xyz = height * sqrt(2.0 * pi * variance) * cos(centre * phase + shift) * exp(-phase * phase * variance);
    xyz.x += second_height * sqrt(2.0 * pi * second_variance) * cos(second_centre * phase + shift.x) *
             exp(-phase * phase * second_variance);
    return rec709_from_xyz * (xyz / 1.0685e-7);
}

// Reflectance of a film in air on a base with the reflectance f0.
vec3 F_film(float cosine, float film_ior, float thickness, vec3 f0) {
    // A film thinner than any wave is none.
    float ior = mix(1.0, film_ior, smoothstep(0.0, 0.03, thickness));
    float sine2 = (1.0 - cosine * cosine) / (ior * ior);
    float inner_cosine = sqrt(max(1.0 - sine2, 0.0));
    float outer = F_schlick(cosine, reflectance_between(vec3(ior), vec3(1.0))).x;
    vec3 root = sqrt(clamp(f0, 0.0, 0.9999));
    vec3 base_ior = (1.0 + root) / (1.0 - root);
    vec3 inner = F_schlick(inner_cosine, reflectance_between(base_ior, vec3(ior)));
    // Half a wave is lost where light is reflected by what is denser: seen from within, at the outer interface.
    vec3 shift = vec3(pi) + mix(vec3(0.0), vec3(pi), lessThan(base_ior, vec3(ior)));
    float path = 2.0 * ior * thickness * inner_cosine;
    float through = 1.0 - outer;
    vec3 both = clamp(outer * inner, 1e-5, 0.9999);
    vec3 series = through * through * inner / (1.0 - both);
    vec3 sum = outer + series, amplitude = series - through, root_both = sqrt(both);
    for (int m = 1; m <= 2; ++m) {
        amplitude *= root_both;
        sum += amplitude * 2.0 * film_response(float(m) * path, float(m) * shift);
    }
    // Saturated colours lie outside of Rec.709.
    return clamp(sum, 0.0, 1.0);
}
