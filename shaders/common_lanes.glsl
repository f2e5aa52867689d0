// Native shaders shade several pixels at once: `if` and loops need conditions that are the same for all of them.
#define any_lane(condition) (condition)
// Bounds of what square textures hold within a distance of a place, for the places of all lanes that need it at once; wide
// ones where they are not known.
#define layer_bounds(layers, place, distance, needed) vec2(-1e38, 1e38)
