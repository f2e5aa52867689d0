// Ground-truth ambient occlusion: the part of a surface's hemisphere, weighted by the cosine, that the depth buffer leaves
// open. The hemisphere is cut into slices through the view direction, whose integrals are closed (Jimenez et al. 2016);
// within a slice a bit mask remembers which sectors are covered (Therrien et al. 2023), so that what is seen between
// and behind objects stays open, and each sector counts by the distance of what covers it first.
#include "common_lanes.glsl"
#include "occlusion_sample.glsl"
#include "occlusion_surface.glsl"

uniform float u_power;

layout(location = 0) out float o_visibility;

// What is seen at one place stands for a solid that reaches back, along the view direction, by this many times the
// distance to the place looked at before. Less leaves gaps between samples of one surface.
const float thickness = 6.0;
const int sectors = 32;
// Pixels that u_steps are meant for.
const float reach_of_steps = 64.0;

// One side of a slice: the quarter turn and more from the view direction to the tangent plane.
struct Side {
    float n_dot_v, n_dot_a;    // a: unit vector across the view direction, to this side
    float cos_tilt, sin_tilt;  // of the normal within the slice
    float whole;               // integral over the side
    float inverse_whole;
};

// Integral over a side from the view direction to the one with the cotangent c: (cos t + 2 h sin t - cos(2 h - t)) / 4.
float integral(float cos_tilt, float sin_tilt, float c) {
    float sin_h = inversesqrt(1.0 + c * c), cos_h = c * sin_h;
    // Arccosine to 7e-5 (Abramowitz and Stegun 4.4.45).
    float x = abs(cos_h);
    float h = sqrt(max(1.0 - x, 0.0)) * (((-0.0187293 * x + 0.0742610) * x - 0.2121144) * x + 1.5707288);
    h = c < 0.0 ? 3.14159265359 - h : h;
    return 0.5 * (sin_h * (sin_h * cos_tilt - cos_h * sin_tilt) + h * sin_tilt);
}

Side side_of(float n_dot_v, float n_dot_a) {
    float scale = inversesqrt(n_dot_v * n_dot_v + n_dot_a * n_dot_a);
    Side side;
    side.n_dot_v = n_dot_v;
    side.n_dot_a = n_dot_a;
    side.cos_tilt = n_dot_v * scale;
    side.sin_tilt = n_dot_a * scale;
    side.whole = integral(side.cos_tilt, side.sin_tilt, -n_dot_a / n_dot_v);
    side.inverse_whole = 1.0 / side.whole;
    return side;
}

// Part of the side between the tangent plane and a direction that rises above it by this cotangent.
float part_below(Side side, float rise) {
    float cotangent = (rise - side.n_dot_a) / side.n_dot_v;
    return 1.0 - integral(side.cos_tilt, side.sin_tilt, cotangent) * side.inverse_whole;
}

uint first_sectors(float count) {
    int n = clamp(int(count), 0, sectors);
    return n == sectors ? 0xffffffffu : (1u << uint(n)) - 1u;
}

// Sectors covered by what is seen at a pixel, and how much it counts. The rise is measured from the tangent plane and is 0
// on it wherever the pixel's centre lies beside the slice, so that no plane occludes itself.
uint covered_sectors(Surface s, vec3 view, vec3 normal, Side side, vec2 pixel, float depth_ratio, float dither,
                     out float weight) {
    vec2 centre = floor(pixel) + 0.5;
    vec2 uv = centre / u_size;
    float depth = textureLod(u_depth_target, uv, 0.0).r;
    // Nothing is known beyond the borders, and nothing is where there is no geometry.
    bool known = depth > 0.0 && uv == clamp(uv, 0.0, 1.0);
    vec3 delta = view_position(centre, known ? depth : 1.0) - s.position;
    float distance2 = dot(delta, delta), along = dot(delta, view);
    float rise = dot(delta, normal) * inversesqrt(max(distance2 - along * along, 1e-12 * distance2));
    float front = part_below(side, max(rise, 0.0));
    float back = part_below(side, max(rise - depth_ratio * side.n_dot_v, 0.0));
    weight = known ? distance_weight(distance2) : 0.0;
    uint covered = first_sectors(front * float(sectors) + dither) & ~first_sectors(back * float(sectors) + dither);
    return weight > 0.0 ? covered : 0u;
}

// Pixels from a place to the picture's border.
float pixels_to_border(vec2 pixel, vec2 direction) {
    vec2 place = pixel + u_picture.xy;
    vec2 to_border = mix(place, u_picture.zw - place, step(0.0, direction)) / max(abs(direction), 1e-6);
    return min(to_border.x, to_border.y);
}

// Occluded part of a side, sampled near to far.
float occluded(Surface s, vec3 view, vec3 normal, Side side, vec2 direction, float reach, float offset) {
    uint covered = 0u;
    float sum = 0.0, before = 0.0, dither = fract(offset * 7.31 + 0.37);
    reach = max(min(min(reach, u_reach), pixels_to_border(s.pixel, direction)), 1.0);
    // Places lie the farther apart the farther away they are. Twice as many see four times as far equally well.
    float steps = ceil(float(u_steps) * sqrt(max(reach / reach_of_steps, 1.0)));
    for (float k = offset; any_lane(k < steps); ++k) {
        float t = k / steps;
        float pixels = 1.0 + (reach - 1.0) * t * t;
        float weight;
        uint bits = covered_sectors(s, view, normal, side, s.pixel + direction * pixels,
                                    thickness * (1.0 - before / pixels), dither, weight);
        bits = k < steps ? bits : 0u;
        sum += weight * float(bitCount(bits & ~covered));
        covered |= bits;
        before = pixels;
    }
    return sum / float(sectors);
}

void main() {
    float depth;
    Surface s = surface_at(gl_FragCoord.xy, depth);
    vec3 view = to_viewer(s.position);
    vec3 normal = towards_viewer(s.normal, view);
    bool open = is_open(s.position);

    float occlusion = 0.0;
    for (int i = 0; i < u_directions && any_lane(!open); ++i) {
        vec3 u = sample_point(i);
        // Slices are drawn by the azimuth of cosine-distributed directions. That is each slice's share of the integral,
        // so the mean of their occluded parts is the occlusion.
        vec3 across = cosine_direction(normal, u.xy);
        across -= view * dot(across, view);
        across *= inversesqrt(max(dot(across, across), 1e-20));
        vec2 on_screen = pixels_along(s.position, across);
        float scale = max(length(on_screen), 1e-20);
        vec2 direction = on_screen / scale;
        Side one = side_of(dot(normal, view), dot(normal, across));
        Side other = side_of(dot(normal, view), -dot(normal, across));
        float hidden = occluded(s, view, normal, one, direction, u_radius * scale, u.z) * one.whole +
                       occluded(s, view, normal, other, -direction, u_radius * scale, u.z) * other.whole;
        occlusion += hidden / (one.whole + other.whole);
    }
    o_visibility = open ? 1.0 : pow(clamp(1.0 - occlusion / float(u_directions), 0.0, 1.0), u_power);
}
