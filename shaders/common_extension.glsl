// What glTF's material extensions add to a pixel of the G-buffer, in 2 x 128 bits (GBuffer::extension).
#include "common_encoding.glsl"
#include "common_frame.glsl"

struct Extension {
    vec3 f0;         // of the dielectric: KHR_materials_ior and _specular
    float f90;
    vec3 coat_normal;  // world
    float clearcoat, coat_roughness;
    vec3 sheen_color;
    float sheen_roughness;
    float iridescence, film_ior, film_thickness;  // thickness in nanometres
    float anisotropy;
    vec3 tangent;                        // world: where reflections are drawn out; at a right angle to the normal
    float transmission, ior, thickness;  // thickness in world units, 0: thin-walled
    float dispersion;                    // of the volume: 20 / Abbe number
    vec3 absorption;                     // of the volume below the surface, per world unit: -ln(transmittance)
};

// Square roots keep the relative steps of a few bits below what is seen.
uint pack_reflectance(vec3 f0) {
    uvec3 steps = uvec3(round(sqrt(clamp(f0, 0.0, 1.0)) * vec3(2047.0, 2047.0, 1023.0)));
    return steps.r | steps.g << 11u | steps.b << 22u;
}

vec3 unpack_reflectance(uint bits) {
    vec3 root = vec3(uvec3(bits & 2047u, bits >> 11u & 2047u, bits >> 22u)) / vec3(2047.0, 2047.0, 1023.0);
    return root * root;
}

const float greatest_dispersion = 40.0;
const float full_turn = 6.28318530717958648;

// Indices of refraction from 1 to 16 in 8 bits, in steps of 0.0035 at 1.3, 0.0066 at 1.5 and 0.03 at 2.4.
float pack_ior(float ior) { return min(1.0 - 1.0 / (ior * ior), 254.0 / 255.0); }
float unpack_ior(float code) { return inversesqrt(max(1.0 - code, 1.0 / 255.0)); }

// Lengths from 2^-64 to 2^64 in 16 bits, in steps of 0.14 %; 0 is 0.
vec2 pack_lengths(vec2 lengths) {
    vec2 code = log(clamp(lengths, 1e-19, 1e19)) / 88.722839 + 0.5;
    return vec2(lengths.x > 0.0 ? code.x : 0.0, lengths.y > 0.0 ? code.y : 0.0);
}

vec2 unpack_lengths(vec2 code) {
    vec2 lengths = exp((code - 0.5) * 88.722839);
    return vec2(code.x > 0.0 ? lengths.x : 0.0, code.y > 0.0 ? lengths.y : 0.0);
}

// What a volume leaves of light along a path, world units.
vec3 transmittance_over(Extension e, float path) { return exp(-e.absorption * path); }

// `normal` is the one that a reader of the G-buffer decodes.
void pack_extension(Extension e, vec3 normal, out uvec4 first, out uvec4 second) {
    vec3 b1, b2;
    frame_around(normal, b1, b2);
    float angle = atan(dot(e.tangent, b2), dot(e.tangent, b1)) / full_turn + 0.5;
    first.x = packUnorm2x16(oct_encode(e.coat_normal) * 0.5 + 0.5);
    first.y = packUnorm4x8(vec4(e.clearcoat, e.coat_roughness, e.sheen_roughness, e.iridescence));
    first.z = packUnorm4x8(vec4(sqrt(e.sheen_color), e.anisotropy));
    first.w = packUnorm2x16(vec2(angle, 0.0)) | packUnorm4x8(vec4(0.0, 0.0, sqrt(e.dispersion / greatest_dispersion), e.f90));
    second.x = pack_reflectance(e.f0);
    second.y = packHalf2x16(vec2(e.film_thickness, 0.0)) |
               packUnorm4x8(vec4(0.0, 0.0, pack_ior(e.film_ior), pack_ior(e.ior)));
    // The length after which 1/e is left of the colour that is absorbed most, and the absorptions as parts of that one:
    // fourth roots tell small ones from each other.
    float most = max(e.absorption.r, max(e.absorption.g, e.absorption.b));
    second.z = packUnorm2x16(pack_lengths(vec2(e.thickness, most > 0.0 ? 1.0 / most : 0.0)));
    second.w = packUnorm4x8(vec4(sqrt(sqrt(e.absorption / max(most, 1e-30))), e.transmission));
}

Extension unpack_extension(uvec4 first, uvec4 second, vec3 normal) {
    Extension e;
    vec4 v = unpackUnorm4x8(first.y);
    e.clearcoat = v.x;
    e.coat_roughness = v.y;
    e.sheen_roughness = v.z;
    e.iridescence = v.w;
    e.coat_normal = oct_decode(unpackUnorm2x16(first.x) * 2.0 - 1.0);
    v = unpackUnorm4x8(first.z);
    e.sheen_color = v.rgb * v.rgb;
    e.anisotropy = v.a;
    float angle = (unpackUnorm2x16(first.w).x - 0.5) * full_turn;
    vec3 b1, b2;
    frame_around(normal, b1, b2);
    e.tangent = b1 * cos(angle) + b2 * sin(angle);
    v = unpackUnorm4x8(first.w);
    e.f90 = v.w;
    e.dispersion = greatest_dispersion * v.z * v.z;
    e.f0 = unpack_reflectance(second.x);
    e.film_thickness = unpackHalf2x16(second.y).x;
    v = unpackUnorm4x8(second.y);
    e.film_ior = unpack_ior(v.z);
    e.ior = unpack_ior(v.w);
    vec2 lengths = unpack_lengths(unpackUnorm2x16(second.z));
    e.thickness = lengths.x;
    v = unpackUnorm4x8(second.w);
    vec3 root = v.rgb * v.rgb;
    e.absorption = lengths.y > 0.0 ? root * root / lengths.y : vec3(0.0);
    e.transmission = v.a;
    return e;
}

Extension chosen_extension(bool first, Extension a, Extension b) {
    a.f0 = first ? a.f0 : b.f0;
    a.f90 = first ? a.f90 : b.f90;
    a.coat_normal = first ? a.coat_normal : b.coat_normal;
    a.clearcoat = first ? a.clearcoat : b.clearcoat;
    a.coat_roughness = first ? a.coat_roughness : b.coat_roughness;
    a.sheen_color = first ? a.sheen_color : b.sheen_color;
    a.sheen_roughness = first ? a.sheen_roughness : b.sheen_roughness;
    a.iridescence = first ? a.iridescence : b.iridescence;
    a.film_ior = first ? a.film_ior : b.film_ior;
    a.film_thickness = first ? a.film_thickness : b.film_thickness;
    a.anisotropy = first ? a.anisotropy : b.anisotropy;
    a.tangent = first ? a.tangent : b.tangent;
    a.transmission = first ? a.transmission : b.transmission;
    a.ior = first ? a.ior : b.ior;
    a.thickness = first ? a.thickness : b.thickness;
    a.dispersion = first ? a.dispersion : b.dispersion;
    a.absorption = first ? a.absorption : b.absorption;
    return a;
}

// Of a surface without extensions.
Extension plain_extension(vec3 normal, vec3 f0) {
    Extension e;
    e.f0 = f0;
    e.f90 = 1.0;
    e.coat_normal = normal;
    e.clearcoat = e.coat_roughness = 0.0;
    e.sheen_color = vec3(0.0);
    e.sheen_roughness = 1.0;
    e.iridescence = e.film_thickness = 0.0;
    e.film_ior = 1.3;
    e.anisotropy = 0.0;
    vec3 bitangent;
    frame_around(normal, e.tangent, bitangent);
    e.transmission = e.thickness = e.dispersion = 0.0;
    e.ior = 1.5;
    e.absorption = vec3(0.0);
    return e;
}
