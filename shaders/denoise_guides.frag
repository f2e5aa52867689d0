// What denoisers are guided by, from sums over the frames. Drawn natively alone: bits may stand in a float.
uniform sampler2D u_surface;      // normal; a: log2 of the depth
uniform sampler2D u_reflectance;  // reflectance; a: the number of frames

layout(location = 0) out vec4 o_guides;  // packed normal and reflectance, log2 of the depth, the number of frames

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec4 color = texelFetch(u_reflectance, here, 0);
    float scale = 1.0 / max(color.a, 1.0);
    vec4 surface = texelFetch(u_surface, here, 0) * scale;
    o_guides = vec4(uintBitsToFloat(packUnorm4x8(vec4(surface.xyz * 0.5 + 0.5, 0.0))),
                    uintBitsToFloat(packUnorm4x8(vec4(color.rgb * scale, 0.0))), surface.a, color.a);
}
