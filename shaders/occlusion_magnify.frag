// From half to full resolution: each pixel takes from the four texels around it what lies on its own surface.
#include "common_lanes.glsl"
#include "occlusion_half.glsl"

uniform sampler2D u_visibility;

layout(location = 0) out float o_visibility;

void main() {
    Surface s;
    vec2 uv = gl_FragCoord.xy / u_size;
    s.pixel = gl_FragCoord.xy;
    s.position = view_position(s.pixel, textureLod(u_depth_target, uv, 0.0).r);
    s.normal = view_normal(textureLod(u_normal, uv, 0.0).rg);
    float tolerance = plane_tolerance(s.position);

    vec2 place = gl_FragCoord.xy * 0.5 - 0.5, corner = floor(place), part = place - corner;
    float sum = 0.0, weights = 0.0;
    bool open = is_open(s.position);
    for (int i = 0; i < 4 && any_lane(!open); ++i) {
        vec2 at = vec2(float(i & 1), float(i >> 1));
        vec2 texel = clamp(corner + at + 0.5, vec2(0.5), u_surface_size - 0.5);
        float found;
        Surface other = half_surface(texel, found);
        vec2 near = mix(1.0 - part, part, at);
        float weight = near.x * near.y * likeness(s, other, tolerance);
        weight = found > 0.0 ? weight : 0.0;
        sum += weight * textureLod(u_visibility, texel / u_surface_size, 0.0).r;
        weights += weight;
    }
    o_visibility = weights > 0.0 && !open ? sum / weights : 1.0;
}
