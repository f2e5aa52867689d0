// Reversed depths and distances along the optical axis.
#feature ORTHOGRAPHIC is_orthographic

uniform vec3 u_depth;  // perspective: near, 0, 0; orthographic: near, far, 1

float reversed_depth(float distance) {
    return is_orthographic ? (u_depth.y - distance) / (u_depth.y - u_depth.x) : u_depth.x / distance;
}

float axial_distance(float depth) {
    return is_orthographic ? mix(u_depth.y, u_depth.x, depth) : u_depth.x / depth;
}
