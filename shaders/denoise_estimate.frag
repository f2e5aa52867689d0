// What few frames tell badly, from the same surface around: a pixel's luminance and hue, and how far they vary. The variance
// of a single pixel is zero where all its paths were dark.
#include "common_denoise.glsl"

// Luminance, compressed(), and its variance; variance of the pixel's own light; see packed_fall().
layout(location = 0) out vec4 o_estimate;
// compressed_hue(), and its variance.
layout(location = 1) out vec4 o_estimated_hue;

const int reach = 2;
// The variance of few frames may be as much too small.
const float doubt = 2.0;
// Of hues more: it is detail where either says so, and two may err.
const float hue_doubt = 6.0;
// A pixel alone that is brighter than those around by more of their deviations, by so many of its own, and so many times as
// bright as each of them, is limited: it would show as a spot.
const float spot_deviations = 12.0;
const float own_deviations = 4.0;
const float least_ratio = 4.0;

// Normals' fall where it is looked for how light changes with them.
const float wide_fall = 8.0;
// It changes with their squared difference by this part of its own square at least.
const float least_change = 0.25;

// What is left of a luminance with the sums of it, of squares and of weights over the pixels around, and the brightest of them.
float limited(float bright, float variance, float sum, float squares, float weights, float brightest) {
    float mean = sum / max(weights, 1e-10), around = max(squares / max(weights, 1e-10) - mean * mean, 0.0);
    float most = max(mean + spot_deviations * sqrt(around), bright - own_deviations * sqrt(variance));
    most = max(most, least_ratio * brightest);
    return weights > 3.0 && bright > most ? most / bright : 1.0;
}

// Normals' fall for light of that noise: pixels add the least error whose light differs by less than noise does. Surfaces may
// turn so fast that hardly a pixel around is alike.
float fall_around(ivec2 here, Guides own) {
    ivec2 last = ivec2(u_size) - 1;
    own.normal_fall = wide_fall;
    float sum = 0.0, squares = 0.0, noise = 0.0, turned = 0.0, weights = 0.0;
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            ivec2 at = here + ivec2(x, y);
            bool inside = is_inside(at);
            at = clamp(at, ivec2(0), last);
            vec4 guides = texelFetch(u_guides, at, 0), light = texelFetch(u_light, at, 0);
            vec3 turn = unpacked(guides.r) - own.normal;
            float weight = exp(-unlikeness(own, guides, vec2(float(abs(x)), float(abs(y)))));
            float linear = luminance(light.rgb), bright = compressed(linear);
            weight = inside && guides.a > 0.0 ? weight : 0.0;
            sum += weight * bright;
            squares += weight * bright * bright;
            noise += weight * compressed_noise(linear, light.a);
            turned += weight * dot(turn, turn);
            weights += weight;
        }
    }
    float scale = 1.0 / max(weights, 1e-10), bright = sum * scale;
    noise *= scale;
    float detail = max(squares * scale - bright * bright - noise, 0.0);
    float change = max(detail / max(turned * scale, 1e-6), least_change * bright * bright);
    return min(normal_fall, change / max(noise, 1e-20));
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy), last = ivec2(u_size) - 1;
    Guides own = guides_at(here);
    own.normal_fall = fall_around(here, own);
    vec4 light_here = texelFetch(u_light, here, 0);
    float sum = 0.0, squares = 0.0, noise = 0.0, noise_of_sum = 0.0, weights = 0.0, weights2 = 0.0;
    vec2 hue = vec2(0.0);
    float hue_squares = 0.0, hue_noise = 0.0;
    vec3 linear = vec3(0.0);  // sums of luminances, of their squares, and of their variances
    float brightest = 0.0;
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            ivec2 at = here + ivec2(x, y);
            bool inside = is_inside(at);
            at = clamp(at, ivec2(0), last);
            vec4 guides = texelFetch(u_guides, at, 0), light = texelFetch(u_light, at, 0);
            float weight = exp(-unlikeness(own, guides, vec2(float(abs(x)), float(abs(y)))));
            float shining = luminance(light.rgb);
            float bright = compressed(shining), of_bright = compressed_noise(shining, light.a);
            weight = inside && guides.a > 0.0 ? weight : 0.0;
            vec2 hued = compressed_hue(light.rgb, shining, bright);
            sum += weight * bright;
            squares += weight * bright * bright;
            noise += weight * of_bright;
            hue += weight * hued;
            hue_squares += weight * hue_square(own, hued);
            hue_noise += weight * guides.a * of_bright;
            noise_of_sum += weight * weight * of_bright;
            weights += weight;
            weights2 += weight * weight;
            linear += weight * vec3(shining, shining * shining, light.a);
            brightest = max(brightest, x == 0 && y == 0 ? 0.0 : weight * shining);
        }
    }
    float bright_here = luminance(light_here.rgb);
    float part = limited(bright_here, light_here.a, linear.x - bright_here, linear.y - bright_here * bright_here,
                         weights - 1.0, brightest);
    float scale = 1.0 / max(weights, 1e-10);
    float bright = sum * scale;
    noise *= scale;
    noise_of_sum *= scale * scale;
    // The sample variance around, of as many pixels as equal weights would stand for.
    float pixels = weights * weights / max(weights2, 1e-10);
    float around = max(squares * scale - bright * bright, 0.0) * pixels / max(pixels - 1.0, 1.0);
    hue = hue * scale;
    hue_noise *= scale;
    float hue_around = max(hue_squares * scale - hue_square(own, hue), 0.0) * pixels / max(pixels - 1.0, 1.0);
    // What noise does not explain is detail, which the pixel itself tells (Lee 1980).
    float explained = min(doubt * noise / max(around, 1e-20), hue_doubt * hue_noise / max(hue_around, 1e-20));
    float detail = noise > 0.0 ? clamp(1.0 - explained, 0.0, 1.0) : 1.0;
    float left = part * bright_here, own_variance = part * part * light_here.a;
    float variance = max(compressed_noise(left, own_variance), noise);
    // The noise around as that of light as bright as the pixel's.
    float as_bright = min(noise * (1.0 + left) * (1.0 + left), linear.z * scale);
    float of_estimate = max(detail * detail * variance + (1.0 - detail) * (1.0 - detail) * noise_of_sum, noise_of_sum);
    o_estimate = vec4(mix(bright, compressed(left), detail), of_estimate,
                      max(own_variance, as_bright), packed_fall(own.normal_fall, part));
    o_estimated_hue = vec4(mix(hue, compressed_hue(part * light_here.rgb, left, compressed(left)), detail),
                           of_estimate * (noise > 0.0 ? hue_noise / noise : own.hue_noise), 0.0);
}
