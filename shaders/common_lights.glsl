// The analytic lights of one block, their falloff and their shadows.
#include "common_encoding.glsl"
#include "common_arriving.glsl"

#feature SHADOWS has_shadows
#feature SHADOW_CUBES has_shadow_cubes

// Grazing light sees planes at most this steep (86.5 degrees): their depths are not to be extrapolated further.
const float least_cosine = 0.06;

#ifdef SHADOWS  // A declared block counts as used. And compiling filters that no one calls takes as long as all else.
#include "common_shadow.glsl"
#else
#include "common_unshadowed.glsl"
#endif

uniform int u_plain_lights;   // lights without shadows, the first ones
uniform int u_single_lights;  // end of those with one shadow map
uniform int u_block_lights;   // end of those with a cube, and of all

// Part of a light of the block that reaches a surface. It is not asked for where there are no shadow maps.
vec3 shadow_of(int index, vec3 position, vec3 normal, bool needed) {
    if (has_shadow_cubes && index >= u_single_lights) return shadow_cube(index - u_plain_lights, position, normal, needed);
    return shadow_single(index - u_plain_lights, position, normal, needed);
}
