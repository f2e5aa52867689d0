// Values of glTF's material extensions at a point of a mesh.
#include "common_extension.glsl"

layout(location = 5) out uvec4 o_extension0;
layout(location = 6) out uvec4 o_extension1;

uniform vec3 u_coat;         // clearcoat, its roughness, scale of its normal texture
uniform vec4 u_sheen;        // colour, roughness
uniform vec4 u_specular;     // colour times the reflectance that the index of refraction gives; specular
uniform vec4 u_film;         // iridescence, index of refraction, least and greatest thickness
uniform vec3 u_anisotropy;   // strength, cosine and sine of the rotation
uniform vec3 u_volume;       // transmission, thickness in world units, index of refraction
uniform vec3 u_attenuation;  // per thickness: logarithm of what goes through

#ifdef CLEARCOAT_TEXTURE
uniform sampler2D u_clearcoat_texture;
uniform vec4 u_clearcoat_channel;
#endif
#ifdef CLEARCOAT_ROUGHNESS_TEXTURE
uniform sampler2D u_clearcoat_roughness_texture;
uniform vec4 u_clearcoat_roughness_channel;
#endif
#ifdef CLEARCOAT_NORMAL_TEXTURE
uniform sampler2D u_clearcoat_normal_texture;
#endif
#ifdef SHEEN_COLOR_TEXTURE
uniform sampler2D u_sheen_color_texture;
#endif
#ifdef SHEEN_ROUGHNESS_TEXTURE
uniform sampler2D u_sheen_roughness_texture;
uniform vec4 u_sheen_roughness_channel;
#endif
#ifdef SPECULAR_TEXTURE
uniform sampler2D u_specular_texture;
uniform vec4 u_specular_channel;
#endif
#ifdef SPECULAR_COLOR_TEXTURE
uniform sampler2D u_specular_color_texture;
#endif
#ifdef TRANSMISSION_TEXTURE
uniform sampler2D u_transmission_texture;
uniform vec4 u_transmission_channel;
#endif
#ifdef THICKNESS_TEXTURE
uniform sampler2D u_thickness_texture;
uniform vec4 u_thickness_channel;
#endif
#ifdef IRIDESCENCE_TEXTURE
uniform sampler2D u_iridescence_texture;
uniform vec4 u_iridescence_channel;
#endif
#ifdef IRIDESCENCE_THICKNESS_TEXTURE
uniform sampler2D u_iridescence_thickness_texture;
uniform vec4 u_iridescence_thickness_channel;
#endif
#ifdef ANISOTROPY_TEXTURE
uniform sampler2D u_anisotropy_texture;
#endif

// One channel of a data texture.
#define ONE_CHANNEL(name, slot) dot(texture(u_##name##_texture, uv_of(slot), u_lod_bias), u_##name##_channel)

void read_layers(inout Extension e, Normals n) {
    e.clearcoat = u_coat.x;
    e.coat_roughness = u_coat.y;
    e.coat_normal = n.geometric;
#ifdef CLEARCOAT_TEXTURE
    e.clearcoat *= ONE_CHANNEL(clearcoat, 7);
#endif
#ifdef CLEARCOAT_ROUGHNESS_TEXTURE
    e.coat_roughness *= ONE_CHANNEL(clearcoat_roughness, 8);
#endif
#ifdef CLEARCOAT_NORMAL_TEXTURE
    e.coat_normal = mapped_normal(n, texture(u_clearcoat_normal_texture, uv_of(9), u_lod_bias).xyz, u_coat.z);
#endif
    e.sheen_color = u_sheen.rgb;
    e.sheen_roughness = u_sheen.a;
#ifdef SHEEN_COLOR_TEXTURE
    e.sheen_color *= texture(u_sheen_color_texture, uv_of(10), u_lod_bias).rgb;
#endif
#ifdef SHEEN_ROUGHNESS_TEXTURE
    e.sheen_roughness *= ONE_CHANNEL(sheen_roughness, 11);
#endif
    e.iridescence = u_film.x;
    e.film_ior = u_film.y;
    e.film_thickness = u_film.w;
#ifdef IRIDESCENCE_TEXTURE
    e.iridescence *= ONE_CHANNEL(iridescence, 16);
#endif
#ifdef IRIDESCENCE_THICKNESS_TEXTURE
    e.film_thickness = mix(u_film.z, u_film.w, ONE_CHANNEL(iridescence_thickness, 17));
#endif
}

void read_dielectric(inout Extension e) {
    vec3 f0 = u_specular.rgb;
    e.f90 = u_specular.a;
#ifdef SPECULAR_TEXTURE
    e.f90 *= ONE_CHANNEL(specular, 12);
#endif
#ifdef SPECULAR_COLOR_TEXTURE
    f0 *= texture(u_specular_color_texture, uv_of(13), u_lod_bias).rgb;
#endif
    e.f0 = min(f0, 1.0) * e.f90;
    e.transmission = u_volume.x;
    e.thickness = u_volume.y;
    e.ior = u_volume.z;
#ifdef TRANSMISSION_TEXTURE
    e.transmission *= ONE_CHANNEL(transmission, 14);
#endif
#ifdef THICKNESS_TEXTURE
    float part = ONE_CHANNEL(thickness, 15);
    e.thickness *= part;
    e.transmittance = exp(u_attenuation * part);
#else
    e.transmittance = exp(u_attenuation);
#endif
}

void read_anisotropy(inout Extension e, Normals n) {
    e.anisotropy = u_anisotropy.x;
    vec2 direction = vec2(1.0, 0.0);
#ifdef ANISOTROPY_TEXTURE
    vec3 texel = texture(u_anisotropy_texture, uv_of(18), u_lod_bias).rgb;
    direction = texel.rg * 2.0 - 1.0;
    e.anisotropy *= texel.b;
#endif
    direction = mat2(u_anisotropy.y, u_anisotropy.z, -u_anisotropy.z, u_anisotropy.y) * direction;
    e.tangent = n.tangent * direction.x + n.bitangent * direction.y;
}

// Writes the targets; `decoded` is the normal that a reader of the G-buffer will see.
void write_extension(Normals n, vec3 decoded) {
    Extension e = plain_extension(n.geometric, vec3(0.0));
    read_layers(e, n);
    read_dielectric(e);
    read_anisotropy(e, n);
    pack_extension(e, decoded, o_extension0, o_extension1);
}
