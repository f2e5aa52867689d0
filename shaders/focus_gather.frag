// Depth of field of a single frame at half resolution: each pixel gathers from those whose circles of confusion reach it
// (scatter as gather; Jimenez 2014). What is nearer than the pixel hides it by as much of its circle as it covers; the rest
// is the mean of what is as far away. Pixels count by their weights (focus_halve.frag).
#feature OVERLAY has_overlay

uniform sampler2D u_half_light;
uniform sampler2D u_confusion;
uniform sampler2D u_weight;
uniform vec2 u_half_size;
uniform float u_reach;  // largest radius, pixels of half resolution
// Places around a pixel: x, y, their distance, and the area that each stands for. They are denser near the centre, where
// small circles are.
uniform vec4 u_taps[72];

// Of what is no nearer than the pixel: its mean, with the mean coverage, times the pixel's weight.
layout(location = 0) out vec4 o_behind;
layout(location = 1) out vec4 o_before;  // of what is nearer, premultiplied by the part of the pixel that it hides
layout(location = 2) out float o_hidden;

// Part of a circle's light that a place at a distance from its centre gets, with an edge a pixel wide.
float reaching(float radius, float distance) {
    return clamp(radius - distance + 0.5, 0.0, 1.0) / (3.14159265 * max(radius * radius, 0.25));
}

// Half the circle's radius in pixels of full resolution, no more than the taps reach.
float radius_at(vec2 uv) { return clamp(0.5 * textureLod(u_confusion, uv, 0.0).r, -u_reach, u_reach); }

// Unfiltered: the filter of the texture is for the full resolution.
float weight_at(vec2 pixel) {
    if (!has_overlay) return 1.0;
    return texelFetch(u_weight, clamp(ivec2(pixel), ivec2(0), ivec2(u_half_size) - 1), 0).r;
}

void main() {
    vec2 here = gl_FragCoord.xy;
    float own = radius_at(here / u_half_size);
    vec4 behind = vec4(0.0), before = vec4(0.0);
    float behind_weight = 0.0, hidden = 0.0;
    for (int k = 0; k < 72; ++k) {
        vec4 tap = u_taps[k];
        float distance = tap.z, area = tap.w;
        vec2 place = here + tap.xy, uv = place / u_half_size;
        float radius = radius_at(uv);
        vec4 light = textureLod(u_half_light, uv, 0.0);
        float weight = weight_at(place);
        // Nearer than what is here, or before the plane in focus, where the pixel's own surface is one of many that hide
        // what is behind.
        float near = max(step(radius, own - 0.5), step(radius, -0.25));
        float blurred = step(0.25, abs(radius));  // What is sharp stands in the picture itself.
        float spread = near * blurred * reaching(abs(radius), distance) * area;
        before += spread * light;
        hidden += spread * weight;
        // What is behind reaches no farther than the circle of what it is seen beside; where a near object hides it, all
        // that is known stands in for it.
        float far = own < -0.25 ? 1e-4 : reaching(min(max(radius, 0.0), max(own, 0.0)), distance);
        far *= (1.0 - near) * area;
        behind += far * light;
        behind_weight += far * weight;
    }
    vec4 light = textureLod(u_half_light, here / u_half_size, 0.0);
    o_behind = behind_weight > 0.0 ? behind * weight_at(here) / behind_weight : light;
    o_before = hidden > 1.0 ? before / hidden : before;
    o_hidden = min(hidden, 1.0);
}
