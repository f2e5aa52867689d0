// What transparent casters take from the light on its way to a receiver, from the sums that shadow_target.glsl leaves. Exact
// before the first caster of a texel, behind the last one, and between two; between more than two it is what two at the
// same ends with the same mean depth would take.
uniform sampler2DArray u_tint_absorption;
uniform sampler2DArray u_tint_moment;

// Light of a texel: casters that do not reach `least` do not count.
vec3 tint_texel(ivec2 texel, Receiver r, float plane, float least) {
    ivec3 at = ivec3(clamp(texel, ivec2(0), ivec2(int(u_shadow_resolution) - 1)), int(r.at.z));
    vec4 absorption = texelFetch(u_tint_absorption, at, 0);
    bool counts = absorption.a > max(plane, least);
    if (!any_lane(counts)) return vec3(1.0);
    vec4 moment = texelFetch(u_tint_moment, at, 0);
    float last = -moment.a;
    // The casters before the receiver, if there are two: the first one's part of the moment.
    vec3 before = (moment.rgb - last * absorption.rgb) / max(absorption.a - last, 1e-20);
    vec3 light = exp(-(last > plane ? absorption.rgb : clamp(before, vec3(0.0), absorption.rgb)));
    return counts ? light : vec3(1.0);
}

// The surface's depth at the middle of a texel.
float plane_at(Receiver r, ivec2 texel) {
    return r.depth + dot(r.slope, (vec2(texel) + 0.5) / u_shadow_resolution - r.at.xy);
}

vec3 tint_hard(Receiver r, bool needed) {
    ivec2 texel = ivec2(floor(r.at.xy * u_shadow_resolution));
    vec3 part = tint_texel(texel, r, plane_at(r, texel), 0.0);
    return needed ? part : vec3(1.0);
}

// Of a column or row from -1 to 2; `f` is the point's place between the middle ones.
float tint_weight(int i, float f) {
    float outer = i < 0 ? 1.0 - f : f;
    return i < 0 || i > 1 ? outer : 1.0;
}

// The mean of 3x3 texels, interpolated between texels, as lit_filtered().
vec3 tint_filtered(Receiver r) {
    vec2 at = r.at.xy * u_shadow_resolution - 0.5, base = floor(at), f = at - base;
    vec3 lost = vec3(0.0);  // nothing lost is exactly all light, whatever the weights round to
    for (int y = -1; y <= 2; ++y)
        for (int x = -1; x <= 2; ++x) {
            vec2 weight = vec2(tint_weight(x, f.x), tint_weight(y, f.y));
            ivec2 texel = ivec2(base) + ivec2(x, y);
            lost += weight.x * weight.y * (1.0 - tint_texel(texel, r, plane_at(r, texel), 0.0));
        }
    return 1.0 - lost / 9.0;
}

const int tint_taps = 12;

vec3 tint_soft(Receiver r, bool needed) {
    float texel = 1.0 / u_shadow_resolution;
    float turn = 6.28318531 * frame_noise(gl_FragCoord.xy, u_sample_index);
    vec2 first_direction = vec2(cos(turn), sin(turn)), direction = first_direction;
    float reach = min(r.reach, widest / max(r.light.x, r.light.y));
    float sum = 0.0, count = 0.0;
    int searched = any_lane(needed) ? 4 + u_soft_taps : 0;
    for (int i = 0; i < searched; ++i) {
        // The texels around the point, then those of the cone between the point and the light.
        float tap = float(i - 4);
        float rho = max(tap + 0.5, 0.0) / float(u_soft_taps);
        vec2 corner = texel * (vec2(float(i & 1), float(i >> 1)) - 0.5), aside = r.light * reach * (rho * direction);
        if (i >= 4) direction = next_direction(direction);
        vec2 at = r.at.xy + (i < 4 ? corner : aside);
        ivec2 place = clamp(ivec2(floor(at * u_shadow_resolution)), ivec2(0), ivec2(int(u_shadow_resolution) - 1));
        float caster = texelFetch(u_tint_absorption, ivec3(place, int(r.at.z)), 0).a;
        float limit = dot(r.slope, (vec2(place) + 0.5) * texel - r.at.xy);
        float blocked = step(r.depth + (i < 4 ? limit : max(rho * reach, limit)), caster);
        sum += blocked * caster;
        count += blocked;
    }
    bool found = needed && count > 0.0;
    if (!any_lane(found)) return vec3(1.0);
    float height = sum / max(count, 1.0) - r.depth;
    vec2 radius = clamp(r.light * height, vec2(0.5 * texel), vec2(widest));
    vec3 lost = vec3(0.0);
    direction = first_direction;
    for (int i = 0; i < tint_taps; ++i) {
        float rho = sqrt((float(i) + 0.5) / float(tint_taps));
        vec2 at = (r.at.xy + radius * (rho * direction)) * u_shadow_resolution - 0.5;
        direction = next_direction(direction);
        vec2 base = floor(at), f = at - base;
        for (int k = 0; k < 4; ++k) {
            int column = k & 1, row = k >> 1;
            ivec2 place = ivec2(base) + ivec2(column, row);
            vec2 weight = vec2(column == 0 ? 1.0 - f.x : f.x, row == 0 ? 1.0 - f.y : f.y);
            float cone = r.depth + 0.5 * rho * height;
            lost += weight.x * weight.y * (1.0 - tint_texel(place, r, plane_at(r, place), cone));
        }
    }
    vec3 light = 1.0 - lost / float(tint_taps);
    return found ? light : vec3(1.0);
}

vec3 tint_part(Receiver r, bool needed) {
    if (has_hard_shadows) return tint_hard(r, needed);
    return has_filtered_shadows ? tint_filtered(r) : tint_soft(r, needed);
}
