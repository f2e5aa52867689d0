// Where paths go on from a surface, and what it reflects of the light that arrives from another direction, of the sky or of
// an emissive surface. Both are ways to find such light, and are combined by multiple importance sampling (Veach and
// Guibas 1995, balance heuristic).
#include "path_plain.glsl"

in vec3 v_random;  // in [0, 1)
in vec3 v_light_direction;
in vec3 v_light;           // radiance
in float v_light_density;  // of such directions, per steradian; 0: none was chosen

out vec3 o_light;      // of this direction, unless it is hidden
out vec3 o_direction;
out vec3 o_weight;     // what the path's throughput is multiplied by
out float o_density;   // of the direction, per steradian

void main() {
    Surface s = path_surface();
    float part = specular_part(s);
    float found = v_light_density + density_of(v_light_direction, s, part);
    o_light = v_light_density > 0.0 ? v_light * reflected(v_light_direction, s) / found : vec3(0.0);
    o_direction = sampled(s, part, v_random);
    o_density = density_of(o_direction, s, part);
    o_weight = o_density > 0.0 ? reflected(o_direction, s) / o_density : vec3(0.0);
}
