// How a ground that is a plane fades into the background. C++ includes this file too, in render/raytrace/ray_callbacks.h: the
// ground is the same to rays.

const float ground_fades_from = 0.4;  // as a part of the radius at which nothing is left

// The part of the ground that is gone at a distance from its middle, as a part of that radius.
float ground_fade(float part) { return smoothstep(ground_fades_from, 1.0, part); }
