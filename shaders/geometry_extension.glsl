// Values of glTF's material extensions at a point of a mesh.
#include "common_extension.glsl"

#feature CLEARCOAT_TEXTURE has_clearcoat_texture
#feature CLEARCOAT_ROUGHNESS_TEXTURE has_clearcoat_roughness_texture
#feature CLEARCOAT_NORMAL_TEXTURE has_clearcoat_normal_texture
#feature SHEEN_COLOR_TEXTURE has_sheen_color_texture
#feature SHEEN_ROUGHNESS_TEXTURE has_sheen_roughness_texture
#feature SPECULAR_TEXTURE has_specular_texture
#feature SPECULAR_COLOR_TEXTURE has_specular_color_texture
#feature TRANSMISSION_TEXTURE has_transmission_texture
#feature THICKNESS_TEXTURE has_thickness_texture
#feature IRIDESCENCE_TEXTURE has_iridescence_texture
#feature IRIDESCENCE_THICKNESS_TEXTURE has_iridescence_thickness_texture
#feature ANISOTROPY_TEXTURE has_anisotropy_texture

uniform vec3 u_coat;         // clearcoat, its roughness, scale of its normal texture
uniform vec4 u_sheen;        // colour, roughness
uniform vec4 u_specular;     // colour times the reflectance that the index of refraction gives; specular
uniform vec4 u_film;         // iridescence, index of refraction, least and greatest thickness
uniform vec3 u_anisotropy;   // strength, cosine and sine of the rotation
uniform vec4 u_volume;       // transmission, thickness in world units, index of refraction, dispersion
uniform vec3 u_absorption;   // per world unit: -ln(transmittance)

uniform sampler2D u_clearcoat_texture;
uniform vec4 u_clearcoat_channel;
uniform sampler2D u_clearcoat_roughness_texture;
uniform vec4 u_clearcoat_roughness_channel;
uniform sampler2D u_clearcoat_normal_texture;
uniform sampler2D u_sheen_color_texture;
uniform sampler2D u_sheen_roughness_texture;
uniform vec4 u_sheen_roughness_channel;
uniform sampler2D u_specular_texture;
uniform vec4 u_specular_channel;
uniform sampler2D u_specular_color_texture;
uniform sampler2D u_transmission_texture;
uniform vec4 u_transmission_channel;
uniform sampler2D u_thickness_texture;
uniform vec4 u_thickness_channel;
uniform sampler2D u_iridescence_texture;
uniform vec4 u_iridescence_channel;
uniform sampler2D u_iridescence_thickness_texture;
uniform vec4 u_iridescence_thickness_channel;
uniform sampler2D u_anisotropy_texture;

// One channel of a data texture.
float channel_of(sampler2D source, int slot, vec4 channel) { return dot(texel_of(source, slot), channel); }

void read_layers(inout Extension e, Normals n) {
    e.clearcoat = u_coat.x;
    e.coat_roughness = u_coat.y;
    e.coat_normal = n.geometric;
    if (has_clearcoat_texture) e.clearcoat *= channel_of(u_clearcoat_texture, 7, u_clearcoat_channel);
    if (has_clearcoat_roughness_texture) e.coat_roughness *= channel_of(u_clearcoat_roughness_texture, 8, u_clearcoat_roughness_channel);
    if (has_clearcoat_normal_texture)
        e.coat_normal = mapped_normal(n, texel_of(u_clearcoat_normal_texture, 9).xyz, u_coat.z);
    e.sheen_color = u_sheen.rgb;
    e.sheen_roughness = u_sheen.a;
    if (has_sheen_color_texture) e.sheen_color *= texel_of(u_sheen_color_texture, 10).rgb;
    if (has_sheen_roughness_texture) e.sheen_roughness *= channel_of(u_sheen_roughness_texture, 11, u_sheen_roughness_channel);
    e.iridescence = u_film.x;
    e.film_ior = u_film.y;
    e.film_thickness = u_film.w;
    if (has_iridescence_texture) e.iridescence *= channel_of(u_iridescence_texture, 16, u_iridescence_channel);
    if (has_iridescence_thickness_texture)
        e.film_thickness = mix(u_film.z, u_film.w, channel_of(u_iridescence_thickness_texture, 17, u_iridescence_thickness_channel));
}

void read_dielectric(inout Extension e) {
    vec3 f0 = u_specular.rgb;
    e.f90 = u_specular.a;
    if (has_specular_texture) e.f90 *= channel_of(u_specular_texture, 12, u_specular_channel);
    if (has_specular_color_texture) f0 *= texel_of(u_specular_color_texture, 13).rgb;
    e.f0 = min(f0, 1.0) * e.f90;
    e.transmission = u_volume.x;
    e.thickness = u_volume.y;
    e.ior = u_volume.z;
    e.dispersion = u_volume.w;
    if (has_transmission_texture) e.transmission *= channel_of(u_transmission_texture, 14, u_transmission_channel);
    if (has_thickness_texture) e.thickness *= channel_of(u_thickness_texture, 15, u_thickness_channel);
    e.absorption = u_absorption;
}

void read_anisotropy(inout Extension e, Normals n) {
    e.anisotropy = u_anisotropy.x;
    vec2 direction = vec2(1.0, 0.0);
    if (has_anisotropy_texture) {
        vec3 texel = texel_of(u_anisotropy_texture, 18).rgb;
        direction = texel.rg * 2.0 - 1.0;
        e.anisotropy *= texel.b;
    }
    e.tangent = n.tangent * (u_anisotropy.y * direction.x - u_anisotropy.z * direction.y) +
                n.bitangent * (u_anisotropy.z * direction.x + u_anisotropy.y * direction.y);
}

Extension read_extension(Normals n) {
    Extension e = plain_extension(n.geometric, vec3(0.0));
    read_layers(e, n);
    read_dielectric(e);
    read_anisotropy(e, n);
    return e;
}

// Both halves of GBuffer::extension; `decoded` is the normal that a reader of the G-buffer will see.
void write_extension(Normals n, vec3 decoded, out uvec4 first, out uvec4 second) {
    pack_extension(read_extension(n), decoded, first, second);
}
