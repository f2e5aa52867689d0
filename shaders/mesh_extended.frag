// Surfaces of triangles with glTF's material extensions that were found natively, for the G-buffer or where rays have met
// them.
#include "common_encoding.glsl"
#include "mesh_surface.glsl"
#include "geometry_extension.glsl"

layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec3 o_normal;
layout(location = 2) out vec3 o_parameters;
layout(location = 3) out vec3 o_emission;
layout(location = 4) out vec4 o_dielectric;  // See path_extended.glsl.
layout(location = 5) out vec4 o_coat;
layout(location = 6) out vec4 o_sheen;
layout(location = 7) out vec4 o_film;
layout(location = 8) out vec4 o_tangent;
layout(location = 9) out vec3 o_volume;
layout(location = 10) out vec3 o_absorption;
layout(location = 11) out uvec4 o_first;  // of GBuffer::extension
layout(location = 12) out uvec4 o_second;

// For a reader of the G-buffer.
void pack_surface(Normals n, Extension e) {
    vec2 encoded = round((oct_encode(n.shading) * 0.5 + 0.5) * 65535.0) / 65535.0;
    pack_extension(e, oct_decode(encoded * 2.0 - 1.0), o_first, o_second);
}

void main() {
    Normals n = read_normals();
    Extension e = read_extension(n);
    o_albedo = albedo_of(base_color());
    o_normal = n.shading;
    o_parameters = read_parameters();
    o_emission = emission_of(o_albedo.rgb);
    o_dielectric = vec4(e.f0, e.f90);
    o_coat = vec4(e.coat_normal, e.clearcoat);
    o_sheen = vec4(e.sheen_color, e.sheen_roughness);
    o_film = vec4(e.iridescence, e.film_ior, e.film_thickness, e.coat_roughness);
    o_tangent = vec4(e.tangent, e.anisotropy);
    o_volume = vec3(e.transmission, e.ior, e.thickness);
    o_absorption = e.absorption;
    pack_surface(n, e);
}
