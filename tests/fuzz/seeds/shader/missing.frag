#include "nowhere.glsl"
#include ""
#include "common_brdf.glsl" 
