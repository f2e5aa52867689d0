// Edges between a pixel and its neighbours to the right (r) and below (g), from the G-buffer.
#include "common_encoding.glsl"
#include "common_projection.glsl"
#include "common_surface_kind.glsl"

#feature SILHOUETTES has_silhouettes
#feature CREASES has_creases
#feature OBJECTS has_objects

uniform sampler2D u_depth_target;
uniform sampler2D u_normal;
uniform sampler2D u_material;
uniform usampler2D u_id;
uniform sampler2D u_id_depth;
uniform vec2 u_size;
uniform float u_depth_step;    // world units
uniform float u_least_cosine;  // of the normals of neighbours that no crease lies between

layout(location = 0) out vec2 o_edges;

bool is_inside(ivec2 p) {
    ivec2 size = ivec2(u_size);
    return p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y;
}

// Reversed depth of the content; 0 where there is nothing, or the ground.
float content_depth(ivec2 p) {
    float depth = texelFetch(u_depth_target, p, 0).r, kind = texelFetch(u_material, p, 0).w;
    return depth > 0.0 && !is_ground_plane(kind) && !is_ground_catcher(kind) ? depth : 0.0;
}

// How far `there` is from where the surface through `before` and `here` would be, in world units: reversed depth is linear
// over planes. Infinite without a surface that could go on.
float step_from(float before, float here, float there) {
    float expected = 2.0 * here - before;
    return before > 0.0 && expected > 0.0 ? abs(axial_distance(expected) - axial_distance(there)) : 1e30;
}

bool is_silhouette(ivec2 p, ivec2 q) {
    float here = content_depth(p), there = content_depth(q);
    // A surface that is continued by either side has no step.
    ivec2 before = p + p - q, after = q + q - p;
    float forwards = is_inside(before) ? step_from(content_depth(before), here, there) : 1e30,
          backwards = is_inside(after) ? step_from(content_depth(after), there, here) : 1e30;
    float direct = abs(axial_distance(here) - axial_distance(there));
    bool both = here > 0.0 && there > 0.0, either = here > 0.0 || there > 0.0;
    return both ? min(direct, min(forwards, backwards)) > u_depth_step : either;
}

vec3 normal_at(ivec2 p) { return oct_decode(texelFetch(u_normal, p, 0).rg * 2.0 - 1.0); }

// Surfaces with a normal: points and tables of colours without one stand in the display kinds.
bool has_normal(ivec2 p) { return content_depth(p) > 0.0 && !is_display(texelFetch(u_material, p, 0).w); }

bool is_crease(ivec2 p, ivec2 q) {
    return has_normal(p) && has_normal(q) && dot(normal_at(p), normal_at(q)) < u_least_cosine;
}

uint object_at(ivec2 p) { return texelFetch(u_id_depth, p, 0).r > 0.0 ? texelFetch(u_id, p, 0).r : 0u; }

float edge(ivec2 p, ivec2 q) {
    bool silhouette = has_silhouettes ? is_silhouette(p, q) : false;
    bool crease = has_creases ? is_crease(p, q) : false;
    bool border = has_objects ? object_at(p) != object_at(q) : false;
    return is_inside(q) && (silhouette || crease || border) ? 1.0 : 0.0;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    o_edges = vec2(edge(p, p + ivec2(1, 0)), edge(p, p + ivec2(0, 1)));
}
