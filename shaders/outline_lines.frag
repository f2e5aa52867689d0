// Lines around the edges that outline_edges.frag found: what part of the pixel a line of that width covers.
uniform sampler2D u_edges;
uniform int u_reach;          // pixels
uniform float u_half_width;   // pixels
uniform vec3 u_color;         // linear

layout(location = 0) out vec4 o_color;

// Distance of a point from a segment that is a pixel long, from `a` along an axis.
float distance_to(vec2 point, vec2 a, vec2 axis) {
    vec2 d = point - a;
    return distance(d, clamp(dot(d, axis), 0.0, 1.0) * axis);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), last = textureSize(u_edges, 0) - 1;
    vec2 point = gl_FragCoord.xy;
    float nearest = 1e30;
    for (int y = max(p.y - u_reach, 0); y <= min(p.y + u_reach, last.y); ++y)
        for (int x = max(p.x - u_reach, 0); x <= min(p.x + u_reach, last.x); ++x) {
            vec2 edges = texelFetch(u_edges, ivec2(x, y), 0).rg;
            if (edges.r > 0.5) nearest = min(nearest, distance_to(point, vec2(x + 1, y), vec2(0.0, 1.0)));
            if (edges.g > 0.5) nearest = min(nearest, distance_to(point, vec2(x, y + 1), vec2(1.0, 0.0)));
        }
    float covered = clamp(u_half_width + 0.5 - nearest, 0.0, 1.0);
    if (covered <= 0.0) discard;
    o_color = covered * vec4(u_color, 1.0);
}
