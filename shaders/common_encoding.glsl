// Octahedral unit vectors (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors")
// and the sRGB transfer curve (IEC 61966-2-1).

vec2 sign_not_zero(vec2 v) { return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }

// Unit vector to [-1, 1]^2.
vec2 oct_encode(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * sign_not_zero(p);
}

vec3 oct_decode(vec2 p) {
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float fold = max(-n.z, 0.0);
    n.xy -= sign_not_zero(n.xy) * fold;
    return normalize(n);
}

#ifndef NATIVE  // There it is a function of the lanes.
vec3 root_2_4(vec3 c) { return pow(max(c, 0.0), vec3(1.0 / 2.4)); }
#endif

// Of display light, up to 1.
vec3 srgb_encode(vec3 c) {
    return mix(1.055 * root_2_4(c) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

vec3 srgb_decode(vec3 c) {
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }
