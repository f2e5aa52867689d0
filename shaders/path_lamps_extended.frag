// Lights of surfaces with glTF's material extensions.
#include "path_extended.glsl"
#include "path_lamps.glsl"
