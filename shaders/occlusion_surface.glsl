// Surfaces of the resolution that occlusion is computed in.
#include "occlusion_half.glsl"

#feature HALF has_half_resolution

// The surface of a pixel of that resolution, and its depth; 0 where there is nothing.
Surface surface_at(vec2 pixel, out float depth) {
    return has_half_resolution ? half_surface(pixel, depth) : full_surface(pixel, depth);
}
