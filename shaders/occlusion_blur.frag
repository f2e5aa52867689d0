// One axis of a blur within a surface. The weights 1/2 1 1 1 1/2 hold every place of the 4x4 pattern of directions
// equally often, so that on an even surface the pattern disappears exactly.
#include "common_lanes.glsl"
#include "occlusion_surface.glsl"

uniform sampler2D u_visibility;
uniform vec2 u_axis;

layout(location = 0) out float o_visibility;

void main() {
    vec2 size = has_half_resolution ? u_surface_size : u_size;
    float depth;
    Surface s = surface_at(gl_FragCoord.xy, depth);
    float tolerance = plane_tolerance(s.position);
    float sum = 0.0, weights = 0.0;
    bool open = is_open(s.position);
    for (int i = -2; i <= 2 && any_lane(!open); ++i) {
        vec2 texel = gl_FragCoord.xy + float(i) * u_axis;
        float found;
        Surface other = surface_at(clamp(texel, vec2(0.5), size - 0.5), found);
        float weight = (abs(i) == 2 ? 0.5 : 1.0) * likeness(s, other, tolerance);
        weight = found > 0.0 ? weight : 0.0;
        sum += weight * textureLod(u_visibility, texel / size, 0.0).r;
        weights += weight;
    }
    o_visibility = open ? 1.0 : sum / max(weights, 1e-20);
}
