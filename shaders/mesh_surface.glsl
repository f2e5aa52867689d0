// A point of a mesh: what its vertices, its material and its textures make of it.
#include "common_uv.glsl"
#include "mesh_features.glsl"

#feature TWO_SIDED is_two_sided
#feature EXTENDED has_extensions
#feature BASE_COLOR_TEXTURE has_base_color_texture
#feature METALLIC_TEXTURE has_metallic_texture
#feature ROUGHNESS_TEXTURE has_roughness_texture
#feature ROUGHNESS_IN_METALLIC has_roughness_in_metallic
#feature NORMAL_TEXTURE has_normal_texture
#feature OCCLUSION_TEXTURE has_occlusion_texture
#feature EMISSIVE_TEXTURE has_emissive_texture
#feature OPACITY_TEXTURE has_opacity_texture
#feature ALPHA_MASK has_alpha_mask
#feature ALPHA_BLEND has_alpha_blend

in vec4 v_color;
in vec2 v_uv;
in vec4 v_tangent;
in vec3 v_normal;
in vec3 v_position;

uniform vec4 u_base_color;  // linear, opacity in w
uniform vec4 u_surface;     // metallic, roughness, occlusion strength, alpha cutoff
uniform vec4 u_emissive;    // radiance; w: code of the surface's kind
uniform float u_normal_scale;
uniform float u_lod_bias;
uniform float u_exact_mask;  // 1: the mask is tested on the texels of the largest level
uniform vec3 u_up;  // world

uniform mat3 u_uv_transform[UV_TRANSFORMS];
uniform sampler2D u_base_color_texture;
uniform sampler2D u_metallic_texture;
uniform vec4 u_metallic_channel;
uniform sampler2D u_roughness_texture;
uniform vec4 u_roughness_channel;
uniform sampler2D u_normal_texture;
uniform sampler2D u_occlusion_texture;
uniform vec4 u_occlusion_channel;
uniform sampler2D u_emissive_texture;
uniform sampler2D u_opacity_texture;
uniform vec4 u_opacity_channel;

vec2 uv_of(int slot) { return image_uv(u_uv_transform[slot], v_uv); }

#ifdef NATIVE  // There derivatives are inputs; the driver computes them between neighbours.
in vec2 v_uv_dx;  // what v_uv changes by to the next pixel
in vec2 v_uv_dy;
in vec3 v_face;  // normal of the face on the side that is seen

// What the transformed coordinates change by; rows of images run downwards.
vec2 uv_change(int slot, vec2 change) {
    vec2 to = (u_uv_transform[slot] * vec3(change, 0.0)).xy;
    return vec2(to.x, -to.y);
}
vec4 texel_of(sampler2D source, int slot) {
    return textureGrad(source, uv_of(slot), uv_change(slot, v_uv_dx), uv_change(slot, v_uv_dy), u_lod_bias);
}
vec3 seen_face() { return v_face; }
#else
// Places of values may be 1e18 tables of 256 texels away; drivers that make texels whole numbers before they
// clamp them reach 2^31. Coordinates of images have hardly a digit behind the point there.
vec4 texel_of(sampler2D source, int slot) { return texture(source, clamp(uv_of(slot), -4e6, 4e6), u_lod_bias); }

uniform vec4 u_backwards;  // world, against the direction of view; w: 1 for an orthographic camera

// Derivatives know which side is seen whatever the winding says. Rows run downwards, so dFdy points down.
vec3 seen_face() {
    vec3 face = normalize(cross(dFdy(v_position), dFdx(v_position)));
    vec3 view = u_backwards.w > 0.5 ? u_backwards.xyz : -v_position;
    return dot(face, view) < 0.0 ? -face : face;
}
#endif

vec4 base_color() {
    vec4 color = u_base_color;
    if (has_vertex_colors) color *= v_color;
    if (has_base_color_texture) color *= texel_of(u_base_color_texture, 0);
    if (has_opacity_texture) color.a *= dot(texel_of(u_opacity_texture, 6), u_opacity_channel);
    return color;
}

// As the G-buffer holds it.
vec4 albedo_of(vec4 color) { return has_alpha_blend ? color : vec4(color.rgb, 1.0); }

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
    vec3 face = vec3(0.0);
    if (sees_by_faces) face = seen_face();
    // Seen from behind, the frame is that of the front turned over, whatever the normals are.
    if (is_flat) side = gl_FrontFacing ? 1.0 : -1.0;
    n.geometric = is_flat ? face * side : normalize(v_normal);
    if (!is_flat && sees_by_faces) side = dot(n.geometric, face) < 0.0 ? -1.0 : 1.0;
    if (!is_flat && !sees_by_faces && is_two_sided) side = gl_FrontFacing ? 1.0 : -1.0;
    if (has_tangents) {
        vec3 t = v_tangent.xyz - n.geometric * dot(n.geometric, v_tangent.xyz);
        n.tangent = t * inversesqrt(max(dot(t, t), 1e-20));
        n.bitangent = cross(n.geometric, n.tangent) * (v_tangent.w < 0.0 ? -1.0 : 1.0);
    } else if (has_extensions) {
        // Without texture coordinates the tangent runs around the upright axis, as on a lathe.
        vec3 around = cross(u_up, n.geometric);
        n.tangent = dot(around, around) > 1e-6 ? normalize(around) : normalize(cross(u_up.yzx, n.geometric));
        n.bitangent = cross(n.geometric, n.tangent);
    }
    n.geometric *= side;
    n.tangent *= side;
    n.bitangent *= side;
    n.shading = n.geometric;
    if (has_normal_texture)
        n.shading = mapped_normal(n, texel_of(u_normal_texture, 4).xyz, u_normal_scale);
    return n;
}

vec3 emission_of(vec3 color) {
    vec3 emission = u_emissive.rgb;
    if (has_emissive_texture) emission *= texel_of(u_emissive_texture, 5).rgb;
    return u_emissive.w > 0.9 ? color : emission;
}

// Metallic, roughness, occlusion.
vec3 read_parameters() {
    vec3 p = vec3(u_surface.xy, 1.0);
    if (has_metallic_texture) {
        vec4 texel = texel_of(u_metallic_texture, 1);
        p.x *= dot(texel, u_metallic_channel);
        if (has_roughness_in_metallic) p.y *= dot(texel, u_roughness_channel);
    }
    if (has_roughness_texture && !has_roughness_in_metallic)
        p.y *= dot(texel_of(u_roughness_texture, 2), u_roughness_channel);
    if (has_occlusion_texture)
        p.z = mix(1.0, dot(texel_of(u_occlusion_texture, 3), u_occlusion_channel), u_surface.z);
    return p;
}
