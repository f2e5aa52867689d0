// Lights surfaces of which some have glTF's material extensions: compiling their model takes as long as all else.
#include "lighting_extended_surface.glsl"

// A second source is an error where there are several targets.
layout(location = 0, index = 0) out vec4 o_radiance;
layout(location = 0, index = 1) out vec4 o_keep;  // of the emission that stands in the target

void write_light(vec3 light, float coverage, float keep) {
    o_radiance = vec4(light, coverage);
    o_keep = vec4(keep);
}

#include "lighting_surface.glsl"
