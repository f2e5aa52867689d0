// The ground that the content stands on, in the specular lobes of surfaces above it: a plane, or the background of one colour
// before which a catcher shows its shadows. Included by lighting_sky.glsl.
#include "common_area_light.glsl"
#include "common_brdf.glsl"
#include "common_lanes.glsl"
#include "common_lights.glsl"
#include "ground_fade.glsl"

#feature GROUND has_ground
#feature GROUND_PLANE is_ground_lit  // else it catches shadows

uniform vec4 u_ground;            // its up axis; its height above the camera
uniform vec3 u_ground_color;      // of a plane; of a catcher: the background's radiance
uniform vec3 u_ground_sky;        // the environment's light on it, divided by pi
uniform vec3 u_ground_hidden;     // mean radiance of the environment below
uniform float u_ground_strength;  // of a catcher's shadow
uniform float u_ground_roughness;  // of a plane
uniform vec4 u_ground_middle;     // as u_middle of ground_finish.frag

// Wider lobes blur the shadows on the ground: from the first alpha on they fade, from the second on none is looked up.
const vec2 shadow_fades = vec2(0.04, 0.25);

float lobe_width(float alpha) { return 2.0 * alpha / (1.0 + alpha); }

// Part of a lobe that points below the horizon; `height` is the sine of its elevation. Of GGX seen along its normal, within 0.01:
// slopes in one direction are distributed as 1 / (1 + x^2)^(3/2), and the cosine makes wide lobes narrower.
float part_below(float height, float alpha) {
    float width = lobe_width(alpha), h2 = height * height;
    return 0.5 - 0.5 * height * inversesqrt(max(h2 + width * width * (1.0 - h2), 1e-12));
}

// Of what a surface sees of a lobe around a direction above it.
float part_below(vec3 direction, vec3 normal, float alpha) {
    // A facing horizon hides what a surface hides itself; an underside sees nothing else.
    float faces = dot(normal, u_ground.xyz), own = part_below(dot(direction, normal), alpha);
    float below = part_below(dot(direction, u_ground.xyz), alpha) - max(faces, 0.0) * own;
    return clamp(below / (1.0 - abs(faces) * own), 0.0, 1.0);
}

// Light of the block's on the ground, divided by pi. A catcher in the picture itself takes its luminance alone: arriving_at() of
// lighting_catcher.frag.
vec3 arriving_on_ground(Light light, vec3 place) {
    if (has_area_lights && light.position.w > 2.5) return light.color.rgb * area_irradiance(light, place, u_ground.xyz);
    vec3 l;
    vec3 arrives = arriving(light, place, l);
    return arrives * (max(dot(u_ground.xyz, l), 0.0) / pi);
}

// Light at a place on the ground, divided by pi, of the environment and of the block's lights, with `shadows` as far as they
// count; `open` is what would arrive if nothing stood there.
vec3 light_on_ground(vec3 place, float shadows, out vec3 open) {
    open = u_ground_sky;
    vec3 lit = open;
    for (int i = 0; i < u_block_lights; ++i) {
        vec3 arrives = arriving_on_ground(u_lights[i], place);
        open += arrives;
        if (has_shadows && i >= u_plain_lights) {
            bool needed = shadows > 0.0 && any(greaterThan(arrives, vec3(0.0)));
            if (any_lane(needed)) arrives *= mix(vec3(1.0), shadow_of(i, place, u_ground.xyz, needed), shadows);
        }
        lit += arrives;
    }
    return lit;
}

// Radiance of the ground at a place, seen along a direction.
vec3 ground_radiance(vec3 place, vec3 direction, float shadows) {
    vec3 open, lit = light_on_ground(place, shadows, open);
    if (is_ground_lit) {
        vec3 up = u_ground.xyz;
        vec2 dfg = dfg_at(abs(dot(direction, up)) + 1e-5, u_ground_roughness);
        float gloss = u_dielectric_f0 * dfg.x + dfg.y;
        return u_ground_color * lit * (1.0 - gloss) + gloss * prefiltered(reflect(direction, up), u_ground_roughness);
    }
    float most = luminance(open);
    float hidden = most > 0.0 ? 1.0 - luminance(lit) / most : 0.0;
    return u_ground_color * (1.0 - u_ground_strength * hidden);
}

// Above the horizon, where the environment is looked up for what is left of a lobe: a narrow one has little below it there.
vec3 above_horizon(vec3 direction, float alpha) {
    if (!has_ground) return direction;
    vec3 up = u_ground.xyz;
    float height = dot(direction, up), least = 0.6 * lobe_width(alpha) * (1.0 - alpha);
    vec3 along = direction - up * height;
    vec3 lifted = up * least + along * sqrt((1.0 - least * least) / max(dot(along, along), 1e-12));
    return height < least ? lifted : direction;
}

// Average radiance in a lobe around a direction that a surface reflects; `sky` is the environment's around above_horizon().
vec3 with_ground(vec3 sky, vec3 position, vec3 normal, vec3 direction, float alpha) {
    if (!has_ground) return sky;
    float below = part_below(direction, normal, alpha);
    bool meets = below > 0.002;
    if (!any_lane(meets)) return sky;
    // The mean of the environment's lower half is no more than a lobe sees of it.
    vec3 up = u_ground.xyz;
    float lower = part_below(dot(above_horizon(direction, alpha), up), alpha);
    vec3 left = (sky - lower * min(u_ground_hidden, sky)) / (1.0 - lower);
    // Of a lobe around the horizon, the middle of what is below.
    float height = dot(direction, up), above = max(dot(position, up) - u_ground.w, 0.0);
    float steep = max(-height, 0.5 * alpha + 1e-3);
    vec3 place = position - up * above + (direction - up * height) * (above / steep);
    if (is_ground_lit) below *= 1.0 - ground_fade(distance(place, u_ground_middle.xyz) / u_ground_middle.w);
    float shadows = meets ? 1.0 - smoothstep(shadow_fades.x, shadow_fades.y, alpha) : 0.0;
    return meets ? mix(left, ground_radiance(place, direction, shadows), below) : sky;
}

// The same of the lobe that a matt surface has, without what hides light from the ground.
vec3 with_even_ground(vec3 sky, vec3 normal) {
    vec3 ground = is_ground_lit ? u_ground_color * u_ground_sky : u_ground_color;
    float below = 0.5 - 0.5 * dot(normal, u_ground.xyz);
    return sky + below * (ground - min(u_ground_hidden, sky));
}
