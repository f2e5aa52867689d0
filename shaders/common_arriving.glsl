// The analytic lights of one block, and what arrives from them.
#include "light_blocks.glsl"

layout(std140, binding = 0) uniform Lights { Light u_lights[LIGHTS_PER_BLOCK]; };

// What arrives on a surface that faces the light, and the direction to it.
vec3 arriving(Light light, vec3 position, out vec3 l) {
    vec3 to_light = light.position.w > 0.5 ? light.position.xyz - position : -light.direction.xyz;
    float d2 = dot(to_light, to_light);
    l = to_light * inversesqrt(max(d2, 1e-30));
    float falloff = 1.0;
    if (light.position.w > 0.5) {
        float reached = d2 * light.color.w;  // Squared alone, d2 leaves single precision.
        falloff = clamp(1.0 - reached * reached, 0.0, 1.0) / max(d2, 1e-30);
    }
    if (light.position.w > 1.5) {
        float cone = clamp(-dot(l, light.direction.xyz) * light.cone.x + light.cone.y, 0.0, 1.0);
        falloff *= cone * cone;
    }
    return light.color.rgb * falloff;
}
