// The shadow on a ground that catches shadows.
#feature PART has_part

uniform sampler2D u_light;  // of lighting_catcher.frag
uniform sampler2D u_part;   // in its place: the part of the light that arrives
uniform float u_strength;

// The part of its light that is missing.
float missing_light(vec2 uv) {
    float lit;
    if (has_part) {
        lit = textureLod(u_part, uv, 0.0).r;  // Of one frame of noisy light it may be more than 1.
    } else {
        vec2 light = textureLod(u_light, uv, 0.0).rg;
        lit = light.g > 0.0 ? light.r / light.g : 1.0;
    }
    return u_strength * (1.0 - lit);
}
