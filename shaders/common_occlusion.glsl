// What the passes of ambient occlusion share: surfaces of the G-buffer in view space.
#feature BOUNDED has_bounds

#include "common_encoding.glsl"
#include "common_camera.glsl"

uniform sampler2D u_depth_target;  // full resolution, see render/gbuffer.h
uniform float u_radius;            // world units
uniform float u_inverse_falloff;   // occlusion fades from full to none over this part of the radius, inverted
uniform sampler2D u_normal;
uniform vec3 u_occluders_center;   // of the box that holds all but the ground: world axes, from the camera
uniform vec3 u_occluders_half;     // half its size

struct Surface {
    vec2 pixel;     // centre, full resolution
    vec3 position;  // view space
    vec3 normal;    // view space
};

vec3 view_normal(vec2 encoded) { return oct_decode(encoded * 2.0 - 1.0) * u_world_from_view; }

// The surface of a pixel, and its depth; 0 where there is nothing.
Surface full_surface(vec2 pixel, out float depth) {
    depth = textureLod(u_depth_target, pixel / u_size, 0.0).r;
    Surface s;
    s.pixel = pixel;
    s.position = view_position(pixel, depth);
    s.normal = view_normal(textureLod(u_normal, pixel / u_size, 0.0).rg);
    return s;
}

// Unit vector from a point to the viewer.
vec3 to_viewer(vec3 position) {
    return is_orthographic ? vec3(0.0, 0.0, 1.0) : -normalize(position);
}

// Pixels per world length at a point, for a displacement that is perpendicular to the view direction.
vec2 pixels_along(vec3 position, vec3 direction) {
    vec2 ndc = is_orthographic ? direction.xy
                               : (direction.xy - position.xy * (direction.z / position.z)) / -position.z;
    return vec2(0.5, -0.5) * u_size * ndc / u_unproject.xy;
}

// World size of a pixel at a point.
float pixel_size(vec3 position) {
    return (is_orthographic ? 2.0 : -2.0 * position.z) * u_unproject.y / u_size.y;
}

// Occluders count less towards the radius and not at all beyond it.
float distance_weight(float distance2) {
    return clamp((1.0 - sqrt(distance2) / u_radius) * u_inverse_falloff, 0.0, 1.0);
}

// Nothing is within the radius of a place on the ground.
bool is_open(vec3 position) {
    vec3 off = abs(u_world_from_view * position - u_occluders_center) - u_occluders_half;
    return has_bounds && max(max(off.x, off.y), off.z) > 1.001 * u_radius;
}

// How far a surface continues another: near 1 on the same plane, falling with the fourth power of the distance from it
// and with the angle between the normals. Never 0, so that a pixel without a like neighbour takes the likest.
float likeness(Surface s, Surface other, float tolerance) {
    float off_plane = dot(s.normal, other.position - s.position) / tolerance;
    float off2 = off_plane * off_plane;
    float facing = clamp(dot(s.normal, other.normal), 0.0, 1.0);
    facing *= facing;
    facing *= facing;
    return (facing + 1e-3) / (1.0 + off2 * off2);
}

// Distance from a plane at which likeness has fallen to a half: a part of the radius, but no less than what a curved
// surface or a rounded normal may leave the plane by within some pixels.
float plane_tolerance(vec3 position) { return 0.05 * u_radius + 0.5 * pixel_size(position); }
