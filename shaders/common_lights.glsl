// The analytic lights of one block, their falloff and their shadows.
struct Light {
    vec4 position;   // relative to the camera; w: 0 directional, 1 point, 2 spot
    vec4 color;      // intensity times colour; w: 1 / range^2, or 0
    vec4 direction;  // unit, where the light goes; w: unused
    vec4 cone;       // scale and offset of the cosine
};
layout(std140, binding = 0) uniform Lights { Light u_lights[LIGHTS_PER_BLOCK]; };
uniform int u_plain_lights;   // lights without shadows, the first ones
#ifdef SHADOWS
uniform int u_single_lights;  // end of those with one shadow map
uniform int u_cube_lights;    // end of those with a cube
#include "common_shadow.glsl"
#endif

// What arrives on a surface that faces the light, and the direction to it.
vec3 arriving(Light light, vec3 position, out vec3 l) {
    vec3 to_light = light.position.w > 0.5 ? light.position.xyz - position : -light.direction.xyz;
    float d2 = dot(to_light, to_light);
    l = to_light * inversesqrt(max(d2, 1e-30));
    float falloff = 1.0;
    if (light.position.w > 0.5) {
        float window = clamp(1.0 - d2 * d2 * light.color.w * light.color.w, 0.0, 1.0);
        falloff = window * window / max(d2, 1e-30);
    }
    if (light.position.w > 1.5) {
        float cone = clamp(-dot(l, light.direction.xyz) * light.cone.x + light.cone.y, 0.0, 1.0);
        falloff *= cone * cone;
    }
    return light.color.rgb * falloff;
}
