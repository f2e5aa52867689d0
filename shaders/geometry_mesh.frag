// Triangles into the G-buffer. What each target holds is defined in render/frame/gbuffer.h.
#include "common_encoding.glsl"
#include "common_peel.glsl"
#include "common_stochastic.glsl"
#include "mesh_surface.glsl"

#feature ALPHA_STOCHASTIC has_stochastic_alpha
#feature PEEL is_peeling
#feature EMISSION has_emission
#feature OBJECT_ID has_ids

layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out float o_depth;
layout(location = 4) out vec4 o_emission;
layout(location = 5) out uvec4 o_first;   // with ids: object; with extensions: half of GBuffer::extension
layout(location = 6) out uvec4 o_second;  // with ids: element; with extensions: the other half

uniform int u_object_id;
uniform int u_first_face;

#ifdef EXTENDED  // Compiling what no material asks for takes half as long as all else.
#include "geometry_extension.glsl"
#else
void write_extension(Normals n, vec3 decoded, out uvec4 first, out uvec4 second) { first = second = uvec4(0u); }
#endif
#include "geometry_shader.glsl"

// Of base_color(), without blur.
float exact_opacity() {
    float opacity = u_base_color.w;
    if (has_vertex_colors) opacity *= v_color.a;
    if (has_base_color_texture) opacity *= textureLod(u_base_color_texture, uv_of(0), 0.0).a;
    if (has_opacity_texture) opacity *= dot(textureLod(u_opacity_texture, uv_of(6), 0.0), u_opacity_channel);
    return opacity;
}

void discard_clear(float alpha) {
    if (has_alpha_mask && alpha < u_surface.w) discard;
    if (!has_alpha_mask && has_stochastic_alpha && alpha <= alpha_threshold()) discard;
    if (is_peeling && (alpha <= 0.0 || is_peeled())) discard;
}

void main() {
    vec4 color = base_color();
    if (has_alpha_mask && u_exact_mask > 0.5) color.a = exact_opacity();
    if (!has_own_shader) discard_clear(color.a);
    vec3 parameters = read_parameters();
    float metallic = parameters.x, roughness = parameters.y, occlusion = parameters.z;
    Normals n = read_normals();
    float kind = u_emissive.w;
    vec3 emission = emission_of(color.rgb);
    if (has_own_shader) {
        shade_own(color, n, metallic, roughness, occlusion, emission, kind);
        discard_clear(color.a);
    }
    o_albedo = albedo_of(color);
    o_normal = oct_encode(n.shading) * 0.5 + 0.5;
    o_material = vec4(metallic, roughness, occlusion, kind);
    o_depth = gl_FragCoord.z;
    if (has_emission || has_own_shader) o_emission = vec4(emission, 1.0);
    if (has_extensions) write_extension(n, oct_decode(round(o_normal * 65535.0) / 65535.0 * 2.0 - 1.0), o_first, o_second);
    if (has_ids) {
        o_first.x = uint(u_object_id);
        o_second.x = uint(u_first_face + gl_PrimitiveID + 1);
    }
}
