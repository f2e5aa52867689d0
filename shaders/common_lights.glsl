// The analytic lights of one block, their falloff and their shadows.
#include "common_encoding.glsl"
#include "common_arriving.glsl"

#feature SHADOWS has_shadows
#feature SHADOW_CUBES has_shadow_cubes

#ifdef SHADOWS  // A declared block counts as used. And compiling filters that no one calls takes as long as all else.
#include "common_shadow.glsl"
#else
#include "common_unshadowed.glsl"
#endif

uniform int u_plain_lights;   // lights without shadows, the first ones
uniform int u_single_lights;  // end of those with one shadow map
uniform int u_block_lights;   // end of those with a cube, and of all
