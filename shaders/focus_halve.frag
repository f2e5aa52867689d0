// Light and circle of confusion at half resolution: the mean of four pixels, and of their circles the nearest surface's. What
// has no light has no part in either, unless there is nothing else.
#include "common_focus.glsl"

uniform sampler2D u_radiance;
uniform sampler2D u_depth_target;
uniform vec2 u_size;
uniform float u_light_scale;  // see render/frame/half_light.h

layout(location = 0) out vec4 o_light;      // as GBuffer::radiance, divided by u_light_scale, times o_weight
layout(location = 1) out float o_confusion;  // pixels of full resolution
layout(location = 2) out float o_weight;     // part of the four pixels that has light

void main() {
    vec2 corner = floor(gl_FragCoord.xy) * 2.0 + 0.5;
    vec4 sum = vec4(0.0), part = vec4(vec3(1.0 / u_light_scale), 1.0);
    float weight = 0.0, lit_depth = 0.0, nearest = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 uv = min(corner + vec2(float(i & 1), float(i >> 1)), u_size - 0.5) / u_size;
        float depth = textureLod(u_depth_target, uv, 0.0).r;
        float lit = has_light(uv, depth);
        sum += lit * min(textureLod(u_radiance, uv, 0.0) * part, 60000.0);
        weight += lit;
        lit_depth = max(lit_depth, lit * depth);
        nearest = max(nearest, depth);
    }
    o_light = sum * 0.25;
    o_confusion = confusion(weight > 0.0 ? lit_depth : nearest);
    o_weight = weight * 0.25;
}
