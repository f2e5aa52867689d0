// Normals that occlusion is seen about: of points that have none, from the depths in a part of the occlusion's radius
// around them; of frames with normal maps those of the surfaces themselves, which would hide a part of what a mapped
// normal faces; others as they are.
#feature MAPPED_NORMALS has_mapped_normals
#include "common_lanes.glsl"
#include "common_occlusion.glsl"
#include "common_surface_kind.glsl"

uniform sampler2D u_material;

layout(location = 0) out vec2 o_normal;

// From a surface to what is seen some pixels beside it, in radii, whose products floats hold at any scale of the scene; and
// how much it counts: not where nothing is seen, hardly where something else lies before or behind.
vec4 neighbor(Surface s, vec2 offset) {
    vec2 pixel = floor(s.pixel + offset) + 0.5, uv = pixel / u_size;
    float depth = textureLod(u_depth_target, uv, 0.0).r;
    vec3 delta = (view_position(pixel, depth) - s.position) / u_radius;
    float far = dot(delta, delta);
    bool seen = depth > 0.0 && uv == clamp(uv, 0.0, 1.0);
    return seen ? vec4(delta, 1.0 / (1.0 + 16.0 * far * far)) : vec4(0.0);
}

vec2 estimated_normal(Surface s) {
    float reach = min(u_radius / pixel_size(s.position), u_reach);
    vec3 sum = vec3(0.0);
    // Of all triangles with two neighbours side by side: on a plane each has its normal.
    for (int ring = 1; ring <= 3; ++ring) {
        float radius = max(reach * 0.12 * float(ring), 2.0 * float(ring));
        vec4 before = neighbor(s, vec2(radius, 0.0));
        for (int i = 1; i <= 8; ++i) {
            float angle = 0.78539816339 * float(i);
            vec4 next = neighbor(s, radius * vec2(cos(angle), sin(angle)));
            sum += before.w * next.w * cross(before.xyz, next.xyz);
            before = next;
        }
    }
    vec3 view = to_viewer(s.position);
    float size = length(sum);
    vec3 normal = size > 0.0 ? sum / size : view;
    normal = dot(normal, view) < 0.0 ? -normal : normal;
    return oct_encode(u_world_from_view * normal) * 0.5 + 0.5;
}

// From a surface to the next pixel of the same surface along an axis: of both neighbours the one nearer in depth.
vec3 along_surface(Surface s, float depth, vec2 axis) {
    vec2 before = s.pixel - axis, after = s.pixel + axis;
    float depth_before = textureLod(u_depth_target, before / u_size, 0.0).r;
    float depth_after = textureLod(u_depth_target, after / u_size, 0.0).r;
    float step_before = depth_before > 0.0 && dot(before, axis) > 0.0 ? abs(depth_before - depth) : 1e30;
    float step_after = depth_after > 0.0 && dot(after, axis) < dot(u_size, axis) ? abs(depth_after - depth) : 1e30;
    return step_after <= step_before ? view_position(after, depth_after) - s.position
                                     : s.position - view_position(before, depth_before);
}

// Of the plane through a pixel and its neighbours.
vec2 surface_normal(Surface s, float depth) {
    vec3 face = cross(along_surface(s, depth, vec2(0.0, 1.0)) / u_radius, along_surface(s, depth, vec2(1.0, 0.0)) / u_radius);
    float size = length(face);
    face = size > 0.0 ? face / size : s.normal;
    face = dot(face, to_viewer(s.position)) < 0.0 ? -face : face;
    return oct_encode(u_world_from_view * face) * 0.5 + 0.5;
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    float depth;
    Surface s = full_surface(gl_FragCoord.xy, depth);
    o_normal = textureLod(u_normal, uv, 0.0).rg;
    if (has_mapped_normals) {
        bool leans = !is_open(s.position);
        if (any_lane(leans)) o_normal = leans ? surface_normal(s, depth) : o_normal;
    }
    bool estimated = is_eye_dome(textureLod(u_material, uv, 0.0).w);
    if (any_lane(estimated)) o_normal = estimated ? estimated_normal(s) : o_normal;
}
