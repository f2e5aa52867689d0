// Normal-oriented hemisphere (Bavoil and Sainz 2008, the paper's method): points in the hemisphere above a surface, and
// the part of them that lies behind what the depth buffer holds.
#include "common_lanes.glsl"
#include "occlusion_sample.glsl"
#include "occlusion_surface.glsl"

uniform float u_power;

layout(location = 0) out float o_visibility;

vec2 pixel_of(vec3 position) {
    vec2 scale = is_orthographic ? u_unproject.xy : u_unproject.xy * max(-position.z, 1e-20);
    vec2 ndc = position.xy / scale - u_unproject.zw;
    return (ndc * vec2(0.5, -0.5) + 0.5) * u_size;
}

float occluded(Surface s, vec3 normal, vec3 point) {
    vec2 centre = floor(pixel_of(point)) + 0.5;
    vec2 uv = centre / u_size;
    float depth = textureLod(u_depth_target, uv, 0.0).r;
    bool known = depth > 0.0 && uv == clamp(uv, 0.0, 1.0) && distance(centre, s.pixel) <= u_reach;
    vec3 found = view_position(centre, known ? depth : 1.0);
    vec3 delta = found - s.position;
    float distance2 = dot(delta, delta);
    // What rises above the tangent plane, so that no plane occludes itself however a pixel's centre is rounded.
    bool above = dot(delta, normal) > 0.02 * sqrt(distance2);
    return known && above && found.z > point.z ? distance_weight(distance2) : 0.0;
}

void main() {
    float depth;
    Surface s = surface_at(gl_FragCoord.xy, depth);
    vec3 normal = towards_viewer(s.normal, to_viewer(s.position));
    bool open = is_open(s.position);
    float sum = 0.0;
    int count = 2 * u_directions * u_steps;
    for (int i = 0; i < u_directions && any_lane(!open); ++i) {
        vec3 u = sample_point(i);
        for (int k = 0; k < 2 * u_steps; ++k) {
            // Each direction turns on by the golden angle, at growing distances.
            vec2 v = fract(u.xy + float(k) * vec2(0.75487767, 0.61803399));
            float part = (float(k) + u.z) / float(2 * u_steps);
            sum += occluded(s, normal, s.position + cosine_direction(normal, v) * (u_radius * part));
        }
    }
    o_visibility = open ? 1.0 : pow(clamp(1.0 - sum / float(count), 0.0, 1.0), u_power);
}
