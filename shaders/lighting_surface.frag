// Lights surfaces of glTF's core model.
#include "lighting_plain_surface.glsl"

layout(location = 0) out vec4 o_radiance;

void write_light(vec3 light, float coverage, float keep) { o_radiance = vec4(light, coverage); }

#include "lighting_surface.glsl"
