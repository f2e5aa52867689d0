// Whoever includes this has the depth of surfaces: uniform sampler2D u_depth_target.
#include "common_camera.glsl"

// Normal of the surface itself, in view space: from the depths of neighbours, of each two the one that is nearer.
vec3 face_normal(vec2 pixel, vec3 center) {
    float d = textureLod(u_depth_target, pixel / u_size, 0.0).r;
    vec3 along[2];
    for (int axis = 0; axis < 2; ++axis) {
        vec2 step = axis == 0 ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
        float before = textureLod(u_depth_target, (pixel - step) / u_size, 0.0).r;
        float after = textureLod(u_depth_target, (pixel + step) / u_size, 0.0).r;
        // The picture's border has a neighbour on one side only.
        bool first = pixel[axis] < 1.0, last = pixel[axis] > u_size[axis] - 1.0;
        bool forwards = !last && (first || abs(after - d) < abs(before - d));
        vec3 other = view_position(forwards ? pixel + step : pixel - step, forwards ? after : before);
        along[axis] = forwards ? other - center : center - other;
    }
    // Rows run downwards.
    vec3 n = normalize(cross(along[1], along[0]));
    return n;
}

// 1 where a normal is that of a plane which goes on to all neighbours, up to 8 degrees; 0 at edges.
float planarity(vec2 pixel, vec3 center, vec3 normal) {
    float planar = 1.0;
    for (int i = 0; i < 4; ++i) {
        float side = float(i & 1) * 2.0 - 1.0;
        vec2 at = pixel + (i < 2 ? vec2(side, 0.0) : vec2(0.0, side));
        bool outside = at.x < 0.0 || at.y < 0.0 || at.x > u_size.x || at.y > u_size.y;
        float d = textureLod(u_depth_target, at / u_size, 0.0).r;
        vec3 way = view_position(at, d) - center;
        planar = outside || (d > 0.0 && abs(dot(way, normal)) <= 0.14 * length(way)) ? planar : 0.0;
    }
    return planar;
}
