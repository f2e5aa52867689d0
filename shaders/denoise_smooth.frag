// One level of a wavelet transform that stops at edges (a trous; Dammertz et al. 2010): edges of what the surface is,
// and of light, by the variance of its mean (SVGF; Schied et al. 2017, section 4.4).
uniform sampler2D u_light;    // divided by the surface's reflectance; a: variance of the mean's luminance
// Sums over the frames that show a surface at the pixel.
uniform sampler2D u_surface;  // normal; a: log2 of the depth
uniform sampler2D u_reflectance;    // reflectance; a: the number of frames
uniform vec2 u_size;
uniform int u_step;  // between taps, pixels

layout(location = 0) out vec4 o_light;

// Falls of the weights: over the square of the normals' difference (that of cos^128), of the reflectances', over the
// logarithm of the depth beyond the surface's own slope, and over deviations of luminance.
const float normal_fall = 64.0;
const float color_fall = 30.0;
const float depth_fall = 80.0;
const float deviations = 3.0;

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

vec4 mean(vec4 sum, float count) { return sum * (1.0 / max(count, 1.0)); }

float depth_at(ivec2 texel) { return texelFetch(u_surface, texel, 0).a / max(texelFetch(u_reflectance, texel, 0).a, 1.0); }

// The lesser of the two differences to the neighbours, for a slope that an edge does not bend.
float slope(float before, float here, float after) { return min(abs(here - before), abs(after - here)); }

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy), last = ivec2(u_size) - 1;
    vec4 own = texelFetch(u_light, here, 0);
    vec4 color = texelFetch(u_reflectance, here, 0);
    vec4 surface = mean(texelFetch(u_surface, here, 0), color.a);
    vec3 reflectance = mean(color, color.a).rgb;
    float bright = luminance(own.rgb);
    float slope_x = slope(depth_at(max(here - ivec2(1, 0), ivec2(0))), surface.a, depth_at(min(here + ivec2(1, 0), last)));
    float slope_y = slope(depth_at(max(here - ivec2(0, 1), ivec2(0))), surface.a, depth_at(min(here + ivec2(0, 1), last)));
    float variance = 0.0, near = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 at = clamp(here + ivec2(x, y), ivec2(0), last);
            float weight = (x == 0 ? 2.0 : 1.0) * (y == 0 ? 2.0 : 1.0);
            weight = texelFetch(u_reflectance, at, 0).a > 0.0 ? weight : 0.0;
            variance += weight * texelFetch(u_light, at, 0).a;
            near += weight;
        }
    }
    float spread = deviations * deviations * variance / max(near, 1.0) + 1e-10;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            ivec2 at = here + ivec2(x * u_step, y * u_step);
            bool inside = at.x >= 0 && at.y >= 0 && at.x <= last.x && at.y <= last.y;
            at = clamp(at, ivec2(0), last);
            vec4 light = texelFetch(u_light, at, 0);
            vec4 other_color = texelFetch(u_reflectance, at, 0);
            vec4 other = mean(texelFetch(u_surface, at, 0), other_color.a);
            vec3 turned = other.xyz - surface.xyz, dyed = mean(other_color, other_color.a).rgb - reflectance;
            float sloped = float(u_step) * (slope_x * float(abs(x)) + slope_y * float(abs(y)));
            float apart = max(abs(other.a - surface.a) - 2.0 * sloped, 0.0);
            float unlike = luminance(light.rgb) - bright;
            float weight = exp(-normal_fall * dot(turned, turned) - color_fall * dot(dyed, dyed) -
                               depth_fall * apart - unlike * unlike / spread);
            // The kernel is that of a cubic B-spline, 1 4 6 4 1.
            float kernel_x = x == 0 ? 6.0 : abs(x) == 1 ? 4.0 : 1.0, kernel_y = y == 0 ? 6.0 : abs(y) == 1 ? 4.0 : 1.0;
            weight = inside && other_color.a > 0.0 ? weight * kernel_x * kernel_y : 0.0;
            sum += weight * vec4(light.rgb, weight * light.a);
            weights += weight;
        }
    }
    weights = max(weights, 1e-10);
    o_light = color.a > 0.0 ? vec4(sum.rgb / weights, sum.a / (weights * weights)) : vec4(0.0);
}
