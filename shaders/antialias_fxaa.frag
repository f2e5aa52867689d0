// Fast approximate anti-aliasing of a single frame (Lottes 2009, the four-tap form): blurs along edges of luma.
#include "common_lanes.glsl"
#include "common_surface_kind.glsl"

#feature EXACT has_exact_colors

uniform sampler2D u_color;  // sRGB-encoded, linear filtering
uniform vec2 u_size;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;

layout(location = 0) out vec4 o_color;

const vec3 luma_weights = vec3(0.299, 0.587, 0.114);
const float span = 8.0;

// Texels by their indices: on CPU rasterisers less than half the cost of a filtered fetch.
vec4 texel_at(ivec2 p) { return texelFetch(u_color, clamp(p, ivec2(0), ivec2(u_size) - 1), 0); }

float luma_of(vec4 c) { return dot(c.rgb, luma_weights) * c.a; }

vec4 premultiplied(vec4 c) { return vec4(c.rgb * c.a, c.a); }

bool touches_exact(vec2 uv) {
    vec4 kinds = textureGather(u_material, uv, 3), depths = textureGather(u_depth_target, uv, 0);
    return (is_exact(kinds.x) && depths.x > 0.0) || (is_exact(kinds.y) && depths.y > 0.0) ||
           (is_exact(kinds.z) && depths.z > 0.0) || (is_exact(kinds.w) && depths.w > 0.0);
}

/// What is blurred: the pixel itself in place of a table's colours, which nothing may mix with.
vec4 sample_at(vec2 uv, vec4 centre) {
    vec4 color = textureLod(u_color, uv, 0.0);
    if (has_exact_colors) color = touches_exact(uv) ? centre : color;
    return premultiplied(color);
}

void main() {
    vec2 texel = 1.0 / u_size;
    vec2 uv = gl_FragCoord.xy * texel;
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 centre = texel_at(p);
    float m = luma_of(centre);
    float nw = luma_of(texel_at(p - 1)), ne = luma_of(texel_at(p + ivec2(1, -1)));
    float sw = luma_of(texel_at(p + ivec2(-1, 1))), se = luma_of(texel_at(p + 1));
    float low = min(m, min(min(nw, ne), min(sw, se))), high = max(m, max(max(nw, ne), max(sw, se)));
    bool edge = high - low > max(1.0 / 16.0, high * 0.125);
    o_color = centre;
    if (!any_lane(edge)) return;

    vec2 along = vec2(sw + se - nw - ne, nw + sw - ne - se);
    float reduce = max((nw + ne + sw + se) * 0.03125, 1.0 / 128.0);
    along = clamp(along / (min(abs(along.x), abs(along.y)) + reduce), -span, span) * texel;

    vec4 near = 0.5 * (sample_at(uv - along / 6.0, centre) + sample_at(uv + along / 6.0, centre));
    vec4 wide = 0.5 * near + 0.25 * (sample_at(uv - along * 0.5, centre) + sample_at(uv + along * 0.5, centre));
    float wide_luma = dot(wide.rgb, luma_weights);
    vec4 blurred = wide_luma < low || wide_luma > high ? near : wide;
    o_color = edge ? vec4(blurred.rgb / max(blurred.a, 1e-4), blurred.a) : centre;
}
