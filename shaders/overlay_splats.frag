// Splats over the overlay: as light, or, where the driver has blended them, sRGB-encoded.
#include "common_encoding.glsl"

#feature ENCODED is_encoded

uniform sampler2D u_splats;  // premultiplied

layout(location = 0) out vec4 o_color;

void main() {
    o_color = texelFetch(u_splats, ivec2(gl_FragCoord.xy), 0);
    if (is_encoded && o_color.a > 0.0) o_color.rgb = o_color.a * srgb_decode(o_color.rgb / o_color.a);
}
