// Surfaces of half resolution, one for four pixels, as occlusion_select.frag leaves them.
#include "common_occlusion.glsl"

uniform sampler2D u_surface;
uniform vec2 u_surface_size;

// Depth, x and y of the normal, and which of the four pixels it is (plus 4 for a normal with negative z).
vec4 pack_surface(float depth, vec3 normal, float index) {
    return vec4(depth, normal.xy, index + (normal.z < 0.0 ? 4.0 : 0.0));
}

Surface unpack_surface(vec2 texel, vec4 packed_surface) {
    float below = step(3.5, packed_surface.w), index = packed_surface.w - 4.0 * below;
    float row = step(1.5, index);
    vec2 xy = packed_surface.yz;
    Surface s;
    s.pixel = min(floor(texel) * 2.0 + vec2(index - 2.0 * row, row) + 0.5, u_size - 0.5);
    s.position = view_position(s.pixel, packed_surface.x);
    s.normal = vec3(xy, (1.0 - 2.0 * below) * sqrt(max(1.0 - dot(xy, xy), 0.0)));
    return s;
}

// Depth at a texel; 0 where there is nothing.
Surface half_surface(vec2 texel, out float depth) {
    vec4 packed_surface = textureLod(u_surface, texel / u_surface_size, 0.0);
    depth = packed_surface.x;
    return unpack_surface(texel, packed_surface);
}
