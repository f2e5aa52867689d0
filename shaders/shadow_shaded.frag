// A caster with a shader of its own into a shadow map, as in shadow_depth.frag.
#include "mesh_surface.glsl"
#include "shadow_surface.glsl"

#include "geometry_shader.glsl"

void discard_clear(float alpha) {
    if (has_alpha_mask && alpha < u_surface.w) discard;
}

void main() {
    vec4 color = base_color();
    vec3 parameters = read_parameters();
    float metallic = parameters.x, roughness = parameters.y, occlusion = parameters.z;
    Normals n = read_normals();
    float kind = u_emissive.w;
    vec3 emission = emission_of(color.rgb);
    shade_own(color, n, metallic, roughness, occlusion, emission, kind);
    discard_clear(color.a);
    write_shadow(color, v_uv);
}
