// Surfaces with glTF's material extensions, as the G-buffer holds them.
#include "lighting_extended.glsl"

uniform usampler2D u_extension0;
uniform usampler2D u_extension1;

// As that of lighting_plain.glsl.
void prepare(inout Surface s, vec3 albedo, float metallic, float kind) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (is_extended(kind))
        s.extension = unpack_extension(texelFetch(u_extension0, pixel, 0), texelFetch(u_extension1, pixel, 0), s.normal);
    else
        s.extension = plain_extension(s.normal, vec3(u_dielectric_f0));
    prepare_extended(s, albedo, metallic);
}

#include "lighting_extended_sky.glsl"
