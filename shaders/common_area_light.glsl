// Area lights in the raster frame. Linearly transformed cosines (Heitz et al. 2016, "Real-Time Polygonal-Light Shading with
// Linearly Transformed Cosines"): a lobe is a matrix applied to a clamped cosine, and what arrives from a polygon is what
// arrives from the polygon that the inverse matrix makes of it. Discs and spheres are polygons of the same area, of a
// sphere that of the disc that is seen of it. gpu/ltc.h has the matrices.
#include "common_arriving.glsl"
#include "common_brdf.glsl"
#include "common_frame.glsl"

#feature AREA_LIGHTS has_area_lights

uniform sampler2D u_ltc;

const float ltc_nodes = 32.0;
const int disc_corners = 12;
const vec2 disc_corner[12] =
    vec2[](vec2(1.0, 0.0), vec2(0.8660254, 0.5), vec2(0.5, 0.8660254), vec2(0.0, 1.0), vec2(-0.5, 0.8660254),
           vec2(-0.8660254, 0.5), vec2(-1.0, 0.0), vec2(-0.8660254, -0.5), vec2(-0.5, -0.8660254), vec2(0.0, -1.0),
           vec2(0.5, -0.8660254), vec2(0.8660254, -0.5));
const vec2 rectangle_corner[4] = vec2[](vec2(1.0, 1.0), vec2(-1.0, 1.0), vec2(-1.0, -1.0), vec2(1.0, -1.0));
// The radius of the circle around a polygon with the area of a disc of radius 1: sqrt(2 pi / (n sin(2 pi / n))).
const float disc_scale = 1.0233267;

// The frame of a lobe, and the inverse of its matrix there: (x, y, z) to (a x + b z, y, c x + d z).
struct AreaLobe {
    vec3 x, y, z;
    vec4 inverse;
};

// x along the projection of the view.
AreaLobe lobe_around(vec3 normal, vec3 view, vec4 inverse) {
    vec3 along = view - normal * dot(normal, view), b1, b2;
    frame_around(normal, b1, b2);
    AreaLobe lobe;
    lobe.x = dot(along, along) > 1e-8 ? along * inversesqrt(max(dot(along, along), 1e-8)) : b1;
    lobe.y = cross(normal, lobe.x);
    lobe.z = normal;
    lobe.inverse = inverse;
    return lobe;
}

// That of GGX, by roughness.
vec4 ltc_at(float n_dot_v, float roughness) {
    vec2 at = vec2(sqrt(clamp(n_dot_v, 0.0, 1.0)), clamp(roughness, 0.0, 1.0)) * (ltc_nodes - 1.0);
    vec2 low = min(floor(at), ltc_nodes - 2.0), part = at - low;
    ivec2 node = ivec2(low);
    vec4 above = mix(texelFetch(u_ltc, node, 0), texelFetch(u_ltc, node + ivec2(1, 0), 0), part.x);
    vec4 below = mix(texelFetch(u_ltc, node + ivec2(0, 1), 0), texelFetch(u_ltc, node + ivec2(1, 1), 0), part.x);
    return mix(above, below, part.y);
}

// A corner in the frame of the lobe.
vec3 corner_in(AreaLobe lobe, vec3 corner) {
    vec3 p = vec3(dot(lobe.x, corner), dot(lobe.y, corner), dot(lobe.z, corner));
    return vec3(lobe.inverse.x * p.x + lobe.inverse.y * p.z, p.y, lobe.inverse.z * p.x + lobe.inverse.w * p.z);
}

// What an edge adds: the angle that is seen of it times the z of the normal of its plane (Lambert).
float edge_form(vec3 a, vec3 b) {
    vec3 normal = cross(b, a);
    float sine = length(normal);
    return sine > 0.0 ? atan(sine, dot(a, b)) * normal.z / max(sine, 1e-37) : 0.0;
}

// The centre of the polygon that a light is seen as, and its half axes.
struct AreaShape {
    vec3 centre, x, y;
};

AreaShape shape_of(Light light, vec3 position) {
    AreaShape shape;
    shape.centre = light.position.xyz - position;
    shape.x = light.cone.xyz;
    shape.y = cross(light.direction.xyz, normalize(light.cone.xyz)) * light.cone.w;
    if (light.position.w > 4.5) {
        // The circle in which a cone touches the sphere.
        float d2 = dot(shape.centre, shape.centre), radius = light.cone.w;
        float part = max(1.0 - radius * radius / max(d2, 1e-30), 1e-6);
        vec3 b1, b2;
        frame_around(shape.centre * inversesqrt(max(d2, 1e-30)), b1, b2);
        shape.x = -b1 * (radius * sqrt(part));
        shape.y = b2 * (radius * sqrt(part));
        shape.centre = shape.centre * part;
    }
    if (light.position.w > 3.5) {
        shape.x = shape.x * disc_scale;
        shape.y = shape.y * disc_scale;
    }
    return shape;
}

// Counterclockwise as the lit side sees them.
vec2 corner_of(Light light, int i) {
    if (light.position.w < 3.5) return rectangle_corner[i];
    return disc_corner[i];
}

// Part of a lobe that a light covers: the integral of the transformed cosine over it. What lies below the horizon is cut off
// edge by edge; the cut itself is an edge too.
float area_form(AreaLobe lobe, Light light, vec3 position) {
    AreaShape shape = shape_of(light, position);
    int corners = 4;
    if (light.position.w > 3.5) corners = disc_corners;
    vec2 last = corner_of(light, corners - 1);
    vec3 before = corner_in(lobe, shape.centre + shape.x * last.x + shape.y * last.y);
    vec3 leaves = vec3(0.0), enters = vec3(0.0);
    float sum = 0.0;
    for (int i = 0; i < corners; ++i) {
        vec2 at = corner_of(light, i);
        vec3 next = corner_in(lobe, shape.centre + shape.x * at.x + shape.y * at.y);
        bool first_above = before.z > 0.0, second_above = next.z > 0.0;
        float rise = before.z - next.z;
        vec3 crossing = before + (next - before) * (before.z / (abs(rise) > 1e-30 ? rise : 1e-30));
        crossing.z = 0.0;
        sum += first_above || second_above ? edge_form(first_above ? before : crossing, second_above ? next : crossing) : 0.0;
        leaves = first_above && !second_above ? crossing : leaves;
        enters = !first_above && second_above ? crossing : enters;
        before = next;
    }
    sum += edge_form(leaves, enters);
    return max(sum, 0.0) / (2.0 * pi);
}

// Irradiance over pi of a surface, for radiance 1.
float area_irradiance(Light light, vec3 position, vec3 normal) {
    return area_form(lobe_around(normal, vec3(0.0), vec4(1.0, 0.0, 0.0, 1.0)), light, position);
}
