// From pixels back to space. World directions have the world's axes; positions are relative to the camera's centre, so
// that a scene far from the origin loses no precision.
#include "common_projection.glsl"

uniform vec2 u_size;              // of the targets, pixels
uniform vec4 u_picture;           // the targets' first pixel in the picture, and the whole picture's size
uniform float u_reach;            // screen-space effects look no farther than this, pixels: what a tile knows beyond its borders
uniform vec4 u_unproject;         // x, y: 1 / P00, 1 / P11; z, w: P02, P12 (perspective) or -P03, -P13 (orthographic)
uniform mat3 u_world_from_view;

// Row 0 of the targets is the top of the picture.
vec2 ndc_of_pixel(vec2 pixel) { return vec2(2.0, -2.0) * pixel / u_size + vec2(-1.0, 1.0); }

// View space (looking along -z) of a pixel with the reversed depth d in (0, 1].
vec3 view_position(vec2 pixel, float d) {
    vec2 ndc = ndc_of_pixel(pixel);
    float z = axial_distance(d);
    vec2 xy = (ndc + u_unproject.zw) * u_unproject.xy;
    return is_orthographic ? vec3(xy, -z) : vec3(xy * z, -z);
}

// World direction of the ray through a pixel, away from the camera.
vec3 ray_of_any_length(vec2 pixel) {
    if (is_orthographic) return u_world_from_view * vec3(0.0, 0.0, -1.0);
    vec2 ndc = ndc_of_pixel(pixel);
    return u_world_from_view * vec3((ndc + u_unproject.zw) * u_unproject.xy, -1.0);
}

// The same, of unit length.
vec3 ray_direction(vec2 pixel) {
    vec3 ray = ray_of_any_length(pixel);
    return is_orthographic ? ray : normalize(ray);
}
