// Surfaces of triangles that were found natively: the core model, without what only the driver does.
#include "common_encoding.glsl"
#include "mesh_surface.glsl"

layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out vec3 o_emission;

void main() {
    o_albedo = albedo_of(base_color());
    vec3 parameters = read_parameters();
    Normals n = read_normals();
    o_normal = oct_encode(n.shading) * 0.5 + 0.5;
    o_material = vec4(parameters, u_emissive.w);
    o_emission = emission_of(o_albedo.rgb);
}
