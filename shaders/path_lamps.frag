// Lights of surfaces of the core model.
#include "path_plain.glsl"
#include "path_lamps.glsl"
