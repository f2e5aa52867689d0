// Lines around the edges that outline_edges.frag found: what part of the pixel a line of that width covers.
#include "common_lanes.glsl"

uniform sampler2D u_edges;
uniform vec2 u_size;
uniform int u_reach;          // pixels
uniform float u_half_width;   // pixels
uniform vec3 u_color;         // linear

layout(location = 0) out vec4 o_color;

// Distance of a point from a segment that is a pixel long, from `a` along an axis.
float distance_to(vec2 point, vec2 a, vec2 axis) {
    vec2 d = point - a;
    return distance(d, clamp(dot(d, axis), 0.0, 1.0) * axis);
}

// Edges of a pixel; outside of the picture there are none.
vec2 edges_at(ivec2 p) {
    ivec2 size = ivec2(u_size);
    bool inside = p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y;
    return inside ? texelFetch(u_edges, p, 0).rg : vec2(0.0);
}

void main() {
    vec2 point = gl_FragCoord.xy, own = floor(point);
    float nearest = 1e30;
    for (int y = -u_reach; y <= u_reach; ++y)
        for (int x = -u_reach; x <= u_reach; ++x) {
            vec2 corner = own + vec2(float(x), float(y)), edges = edges_at(ivec2(point) + ivec2(x, y));
            bool right = edges.r > 0.5, below = edges.g > 0.5;
            if (any_lane(right))
                nearest = right ? min(nearest, distance_to(point, corner + vec2(1.0, 0.0), vec2(0.0, 1.0))) : nearest;
            if (any_lane(below))
                nearest = below ? min(nearest, distance_to(point, corner + vec2(0.0, 1.0), vec2(1.0, 0.0))) : nearest;
        }
    float covered = clamp(u_half_width + 0.5 - nearest, 0.0, 1.0);
    if (covered <= 0.0) discard;
    o_color = covered * vec4(u_color, 1.0);
}
