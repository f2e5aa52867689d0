// Fast approximate anti-aliasing of a single frame (Lottes 2009, the four-tap form): blurs along edges of luma.
#include "common_lanes.glsl"
#include "common_surface_kind.glsl"

#feature EXACT has_exact_colors
#feature ALPHA has_alpha  // the picture's background is transparent
#feature LINES has_lines

uniform sampler2D u_color;  // sRGB-encoded, straight alpha, linear filtering
uniform vec2 u_size;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform sampler2D u_nearest_line;  // reversed depth; 0: no line covers half of the pixel

layout(location = 0) out vec4 o_color;

const vec3 luma_weights = vec3(0.299, 0.587, 0.114);
const float span = 8.0;

// Texels by their indices: on CPU rasterisers less than half the cost of a filtered fetch.
vec4 texel_at(ivec2 p) { return texelFetch(u_color, clamp(p, ivec2(0), ivec2(u_size) - 1), 0); }

float luma_of(vec4 c) { return dot(c.rgb, luma_weights) * c.a; }

vec4 premultiplied(vec4 c) { return vec4(c.rgb * c.a, c.a); }

/// Linearly filtered and premultiplied. The colour of a transparent texel has no weight.
vec4 filtered(vec2 uv) {
    if (!has_alpha) return premultiplied(textureLod(u_color, uv, 0.0));
    vec2 at = uv * u_size - 0.5, corner = floor(at), part = at - corner;
    ivec2 p = ivec2(corner);
    vec4 top = mix(premultiplied(texel_at(p)), premultiplied(texel_at(p + ivec2(1, 0))), part.x);
    vec4 bottom = mix(premultiplied(texel_at(p + ivec2(0, 1))), premultiplied(texel_at(p + 1)), part.x);
    return mix(top, bottom, part.y);
}

bool touches_exact(vec2 uv) {
    vec4 kinds = textureGather(u_material, uv, 3), depths = textureGather(u_depth_target, uv, 0);
    return (is_exact(kinds.x) && depths.x > 0.0) || (is_exact(kinds.y) && depths.y > 0.0) ||
           (is_exact(kinds.z) && depths.z > 0.0) || (is_exact(kinds.w) && depths.w > 0.0);
}

/// What is blurred: the pixel itself in place of a table's colours, which nothing may mix with.
vec4 sample_at(vec2 uv, vec4 centre) {
    vec4 color = filtered(uv);
    if (has_exact_colors) color = touches_exact(uv) ? premultiplied(centre) : color;
    return color;
}

float lowest(vec4 corners, float middle) {
    return min(middle, min(min(corners.x, corners.y), min(corners.z, corners.w)));
}

float highest(vec4 corners, float middle) {
    return max(middle, max(max(corners.x, corners.y), max(corners.z, corners.w)));
}

/// Whether a line covers a part of the pixel. Lines are drawn smooth: what FXAA takes for their edges would break them where
/// they cross.
bool is_on_line(vec2 uv, vec2 texel) {
    float nearest = 0.0;
    nearest = highest(textureGather(u_nearest_line, uv + texel * vec2(-0.5, -0.5), 0), nearest);
    nearest = highest(textureGather(u_nearest_line, uv + texel * vec2(0.5, -0.5), 0), nearest);
    nearest = highest(textureGather(u_nearest_line, uv + texel * vec2(-0.5, 0.5), 0), nearest);
    nearest = highest(textureGather(u_nearest_line, uv + texel * vec2(0.5, 0.5), 0), nearest);
    return nearest > 0.0;
}

void main() {
    vec2 texel = 1.0 / u_size;
    vec2 uv = gl_FragCoord.xy * texel;
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 centre = texel_at(p);
    vec4 nw = texel_at(p - 1), ne = texel_at(p + ivec2(1, -1)), sw = texel_at(p + ivec2(-1, 1)), se = texel_at(p + 1);
    // Edges are those of luma, or of alpha where it changes more: black on a transparent background has no luma.
    vec4 weights = vec4(luma_weights, 0.0);
    vec4 corners = vec4(luma_of(nw), luma_of(ne), luma_of(sw), luma_of(se));
    float middle = luma_of(centre);
    if (has_alpha) {
        vec4 alphas = vec4(nw.a, ne.a, sw.a, se.a);
        bool by_alpha = highest(alphas, centre.a) - lowest(alphas, centre.a) >
                        highest(corners, middle) - lowest(corners, middle);
        weights = by_alpha ? vec4(0.0, 0.0, 0.0, 1.0) : weights;
        corners = by_alpha ? alphas : corners;
        middle = by_alpha ? centre.a : middle;
    }
    float low = lowest(corners, middle), high = highest(corners, middle);
    bool edge = high - low > max(1.0 / 16.0, high * 0.125);
    o_color = centre;
    if (!any_lane(edge)) return;
    if (has_lines) {
        bool on_line = is_on_line(uv, texel);
        edge = edge && !on_line;
        if (!any_lane(edge)) return;
    }

    // corners: x y at the top, z w at the bottom
    vec2 along = vec2(corners.z + corners.w - corners.x - corners.y, corners.x + corners.z - corners.y - corners.w);
    float reduce = max((corners.x + corners.y + corners.z + corners.w) * 0.03125, 1.0 / 128.0);
    along = clamp(along / (min(abs(along.x), abs(along.y)) + reduce), -span, span) * texel;

    vec4 near = 0.5 * (sample_at(uv - along / 6.0, centre) + sample_at(uv + along / 6.0, centre));
    vec4 wide = 0.5 * near + 0.25 * (sample_at(uv - along * 0.5, centre) + sample_at(uv + along * 0.5, centre));
    float measure = dot(wide, weights);
    vec4 blurred = measure < low || measure > high ? near : wide;
    o_color = edge ? vec4(blurred.rgb / max(blurred.a, 1e-6), blurred.a) : centre;
}
