// A rectangle around what is seen of a Gaussian splat, an instance each.
#include "common_splat.glsl"

uniform vec2 u_size;  // of the frame

flat out uint v_splat;

void main() {
    v_splat = order[gl_InstanceID];
    vec4 place = splats[v_splat].place;
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
    vec2 pixel = place.xy + corner * place.zw;
    gl_Position = vec4(pixel.x / u_size.x * 2.0 - 1.0, 1.0 - pixel.y / u_size.y * 2.0, 0.5, 1.0);
}
