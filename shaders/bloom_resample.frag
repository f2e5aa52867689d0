// From one level of bloom's pyramid to the next (Jimenez 2014). Positions are counted in texels of the level that is read:
// the sides of levels are rounded up, so parts of the texture's size would drift.
#feature DOWN is_downwards
#feature UP is_upwards

uniform sampler2D u_level;
uniform vec2 u_level_size;  // of the level that is read, texels
uniform vec2 u_extent;       // of the picture, texels of that level

layout(location = 0) out vec4 o_light;

vec3 light_at(vec2 texel) {
    texel = abs(texel);
    texel = clamp(u_extent - abs(u_extent - texel), vec2(0.0), u_extent);
    return textureLod(u_level, texel / u_level_size, 0.0).rgb;
}

// 13 taps between texels: boxes of 4 x 4, one of 1/2 in the middle, four of 1/8 around it.
vec3 boxes(vec2 at) {
    vec3 inner = light_at(at + vec2(-1.0, -1.0)) + light_at(at + vec2(1.0, -1.0)) + light_at(at + vec2(-1.0, 1.0)) +
                 light_at(at + vec2(1.0, 1.0));
    vec3 sides = light_at(at + vec2(-2.0, 0.0)) + light_at(at + vec2(2.0, 0.0)) + light_at(at + vec2(0.0, -2.0)) +
                 light_at(at + vec2(0.0, 2.0));
    vec3 corners = light_at(at + vec2(-2.0, -2.0)) + light_at(at + vec2(2.0, -2.0)) + light_at(at + vec2(-2.0, 2.0)) +
                   light_at(at + vec2(2.0, 2.0));
    return 0.125 * (light_at(at) + inner) + 0.0625 * sides + 0.03125 * corners;
}
// A tent of 3 x 3 taps between texels: of the four texels along an axis that it reaches, each two are one tap.
vec3 tent(vec2 at) {
    vec2 base = floor(at - 0.5), f = at - 0.5 - base;
    vec2 low = base - 0.5 + (2.0 - f) / (3.0 - 2.0 * f), high = base + 1.5 + f / (1.0 + 2.0 * f);
    vec2 of_low = (3.0 - 2.0 * f) / 4.0, of_high = 1.0 - of_low;
    return of_low.y * (of_low.x * light_at(low) + of_high.x * light_at(vec2(high.x, low.y))) +
           of_high.y * (of_low.x * light_at(vec2(low.x, high.y)) + of_high.x * light_at(high));
}

void main() {
    vec2 at = gl_FragCoord.xy;
    o_light = vec4(is_downwards ? boxes(at * 2.0) : tent(is_upwards ? at * 0.5 : at), 1.0);
}
