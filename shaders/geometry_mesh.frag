// Triangles into the G-buffer. What each target holds is defined in render/gbuffer.h.
#include "common_encoding.glsl"
#ifdef PEEL
#include "common_peel.glsl"
#endif
#ifdef ALPHA_STOCHASTIC
#include "common_stochastic.glsl"
#endif

#ifdef VERTEX_COLOR
in vec4 v_color;
#endif
#ifdef UV
in vec2 v_uv;
#endif
#ifdef TANGENT
in vec4 v_tangent;
#endif
#ifndef FLAT
in vec3 v_normal;
#endif
#if defined(FACE_NORMAL) || defined(SURFACE_SHADER)
in vec3 v_position;
#endif

#ifdef SHADOW
#include "shadow_shaded.glsl"
#else
layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out float o_depth;
#ifdef EMISSION
layout(location = 4) out vec4 o_emission;
#endif
#ifdef OBJECT_ID
layout(location = 5) out uint o_id;
layout(location = 6) out uint o_element;
uniform int u_object_id;
uniform int u_first_face;
#endif
#endif

uniform vec4 u_base_color;  // linear, opacity in w
uniform vec4 u_surface;     // metallic, roughness, occlusion strength, alpha cutoff
uniform vec4 u_emissive;    // radiance; w: code of the surface's kind
uniform float u_normal_scale;
uniform float u_lod_bias;
#ifdef EXTENDED
uniform vec3 u_up;  // world
#endif

#ifdef UV
uniform mat3 u_uv_transform[UV_TRANSFORMS];
// Images have row 0 on top and texture coordinates have v upwards.
vec2 uv_of(int slot) {
    vec2 uv = (u_uv_transform[slot] * vec3(v_uv, 1.0)).xy;
    return vec2(uv.x, 1.0 - uv.y);
}
#endif
#ifdef BASE_COLOR_TEXTURE
uniform sampler2D u_base_color_texture;
#endif
#ifdef METALLIC_TEXTURE
uniform sampler2D u_metallic_texture;
uniform vec4 u_metallic_channel;
#endif
#ifdef ROUGHNESS_TEXTURE
uniform vec4 u_roughness_channel;
#ifndef ROUGHNESS_IN_METALLIC
uniform sampler2D u_roughness_texture;
#endif
#endif
#ifdef NORMAL_TEXTURE
uniform sampler2D u_normal_texture;
#endif
#ifdef OCCLUSION_TEXTURE
uniform sampler2D u_occlusion_texture;
uniform vec4 u_occlusion_channel;
#endif
#ifdef EMISSIVE_TEXTURE
uniform sampler2D u_emissive_texture;
#endif
#ifdef OPACITY_TEXTURE
uniform sampler2D u_opacity_texture;
uniform vec4 u_opacity_channel;
#endif

vec4 base_color() {
    vec4 color = u_base_color;
#ifdef VERTEX_COLOR
    color *= v_color;
#endif
#ifdef BASE_COLOR_TEXTURE
    color *= texture(u_base_color_texture, uv_of(0), u_lod_bias);
#endif
#ifdef OPACITY_TEXTURE
    color.a *= dot(texture(u_opacity_texture, uv_of(6), u_lod_bias), u_opacity_channel);
#endif
    return color;
}

struct Normals {
    vec3 shading, geometric;  // with and without the normal texture, towards the viewer's side
    vec3 tangent, bitangent;  // of the texture coordinates; right-angled with the geometric normal
};

// A texel of a normal texture, in [0, 1].
vec3 mapped_normal(Normals n, vec3 texel, float scale) {
    vec3 m = texel * 2.0 - 1.0;
    vec3 mapped = n.tangent * (m.x * scale) + n.bitangent * (m.y * scale) + n.geometric * max(m.z, 0.0);
    return dot(mapped, mapped) > 1e-12 ? normalize(mapped) : n.geometric;
}

Normals read_normals() {
    Normals n;
    float side = 1.0;
#ifdef FACE_NORMAL
    // Derivatives know which side is seen whatever the winding says. Rows run downwards, so dFdy points down.
    vec3 face = normalize(cross(dFdy(v_position), dFdx(v_position)));
    if (dot(face, v_position) > 0.0) face = -face;
#endif
#ifdef FLAT
    n.geometric = face;
#else
    n.geometric = normalize(v_normal);
#ifdef FACE_NORMAL
    if (dot(n.geometric, face) < 0.0) side = -1.0;
#elif defined(TWO_SIDED)
    if (!gl_FrontFacing) side = -1.0;
#endif
#endif
#ifdef TANGENT
    vec3 t = v_tangent.xyz - n.geometric * dot(n.geometric, v_tangent.xyz);
    n.tangent = t * inversesqrt(max(dot(t, t), 1e-20));
    n.bitangent = cross(n.geometric, n.tangent) * (v_tangent.w < 0.0 ? -1.0 : 1.0);
#elif defined(EXTENDED)
    // Without texture coordinates the tangent runs around the upright axis, as on a lathe.
    vec3 around = cross(u_up, n.geometric);
    n.tangent = dot(around, around) > 1e-6 ? normalize(around) : normalize(cross(u_up.yzx, n.geometric));
    n.bitangent = cross(n.geometric, n.tangent);
#endif
    n.geometric *= side;
    n.tangent *= side;
    n.bitangent *= side;
    n.shading = n.geometric;
#ifdef NORMAL_TEXTURE
    n.shading = mapped_normal(n, texture(u_normal_texture, uv_of(4), u_lod_bias).xyz, u_normal_scale);
#endif
    return n;
}

#ifdef EXTENDED
#include "geometry_extension.glsl"
#endif
#ifdef SURFACE_SHADER
#include "geometry_shader.glsl"
#endif

void discard_clear(float alpha) {
#if defined(ALPHA_MASK)
    if (alpha < u_surface.w) discard;
#elif defined(ALPHA_STOCHASTIC)
    if (alpha <= alpha_threshold()) discard;
#endif
#ifdef PEEL
    if (alpha <= 0.0 || is_peeled()) discard;
#endif
}

vec3 emission_of(vec3 color) {
    vec3 emission = u_emissive.rgb;
#ifdef EMISSIVE_TEXTURE
    emission *= texture(u_emissive_texture, uv_of(5), u_lod_bias).rgb;
#endif
    return u_emissive.w > 0.9 ? color : emission;
}

void main() {
    vec4 color = base_color();
#ifndef SURFACE_SHADER
    discard_clear(color.a);
#endif

    float metallic = u_surface.x, roughness = u_surface.y, occlusion = 1.0;
#ifdef METALLIC_TEXTURE
    vec4 metallic_texel = texture(u_metallic_texture, uv_of(1), u_lod_bias);
    metallic *= dot(metallic_texel, u_metallic_channel);
#endif
#ifdef ROUGHNESS_TEXTURE
#ifdef ROUGHNESS_IN_METALLIC
    roughness *= dot(metallic_texel, u_roughness_channel);
#else
    roughness *= dot(texture(u_roughness_texture, uv_of(2), u_lod_bias), u_roughness_channel);
#endif
#endif
#ifdef OCCLUSION_TEXTURE
    occlusion = mix(1.0, dot(texture(u_occlusion_texture, uv_of(3), u_lod_bias), u_occlusion_channel), u_surface.z);
#endif

    Normals n = read_normals();
    float kind = u_emissive.w;
#ifdef SURFACE_SHADER
    vec3 emission = emission_of(color.rgb);
    shade_own(color, n, metallic, roughness, occlusion, emission, kind);
    discard_clear(color.a);
#endif
#ifdef SHADOW
    write_shadow(color);
#else
#ifdef ALPHA_BLEND
    o_albedo = color;
#else
    o_albedo = vec4(color.rgb, 1.0);
#endif
    o_normal = oct_encode(n.shading) * 0.5 + 0.5;
#ifdef EXTENDED
    write_extension(n, oct_decode(round(o_normal * 65535.0) / 65535.0 * 2.0 - 1.0));
#endif
    o_material = vec4(metallic, roughness, occlusion, kind);
    o_depth = gl_FragCoord.z;
#ifdef OBJECT_ID
    o_id = uint(u_object_id);
    o_element = uint(u_first_face + gl_PrimitiveID + 1);
#endif
#if defined(SURFACE_SHADER)
    o_emission = vec4(emission, 1.0);
#elif defined(EMISSION)
    o_emission = vec4(emission_of(color.rgb), 1.0);
#endif
#endif
}
