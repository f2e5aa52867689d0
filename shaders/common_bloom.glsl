// Bloom: what of a pixel's light is spread, and the pixel with the light of others.
uniform vec4 u_bloom;  // intensity, exposure, threshold, half width of the knee (the last two of exposed light)

// Exposed light that is a number and fits in 16 bits: one broken pixel must not become a broken neighbourhood. The bits
// are looked at because compilers may assume that comparisons see no NaN.
vec3 contained(vec3 radiance) {
    uvec3 bits = floatBitsToUint(radiance) & 0x7f800000u;
    vec3 finite = vec3(bits.x == 0x7f800000u ? 0.0 : radiance.x, bits.y == 0x7f800000u ? 0.0 : radiance.y,
                       bits.z == 0x7f800000u ? 0.0 : radiance.z);
    return clamp(finite * u_bloom.y, 0.0, 60000.0);
}

float largest(vec3 c) { return max(c.r, max(c.g, c.b)); }

// What exceeds the threshold, from a knee's width before it on.
vec3 spread_part(vec3 exposed) {
    float peak = largest(exposed), above = peak - u_bloom.z, knee = u_bloom.w;
    float soft = clamp(above + knee, 0.0, 2.0 * knee);
    float part = max(soft * soft / max(4.0 * knee, 1e-6), above);
    return u_bloom.z > 0.0 ? exposed * (max(part, 0.0) / max(peak, 1e-6)) : exposed;
}

uniform sampler2D u_glow;  // exposed light, first texel over the pixels 0 to 4
uniform vec2 u_glow_size;  // of the texture in pixels: 4 times its own

vec4 with_bloom(vec4 radiance, vec2 pixel) {
    vec3 exposed = contained(radiance.rgb);
    vec3 glow = textureLod(u_glow, pixel / u_glow_size, 0.0).rgb;
    return vec4((exposed + u_bloom.x * (glow - spread_part(exposed))) / u_bloom.y, radiance.a);
}
