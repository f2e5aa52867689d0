// The ground that the content stands on, in the specular lobes of surfaces above it: a plane, or the background of one colour
// before which a catcher shows its shadows. Included by lighting_sky.glsl.
#include "common_area_light.glsl"
#include "common_brdf.glsl"
#include "common_lanes.glsl"
#include "common_lights.glsl"

#feature GROUND has_ground
#feature GROUND_PLANE is_ground_lit  // else it catches shadows

uniform vec4 u_ground;            // its up axis; its height above the camera
uniform vec3 u_ground_color;      // of a plane; of a catcher: the background's radiance
uniform vec3 u_ground_sky;        // the environment's light on it, divided by pi
uniform vec3 u_ground_hidden;     // mean radiance of the environment below
uniform float u_ground_strength;  // of a catcher's shadow
uniform vec4 u_ground_middle;     // as u_middle of ground_finish.frag

// Part of a lobe that points below the horizon; `height` is the sine of its elevation. Of GGX seen along its normal, within 0.01:
// slopes in one direction are distributed as 1 / (1 + x^2)^(3/2), and the cosine makes wide lobes narrower.
float part_below(float height, float alpha) {
    float width = 2.0 * alpha / (1.0 + alpha);
    float h2 = height * height;
    return 0.5 - 0.5 * height * inversesqrt(max(h2 + width * width * (1.0 - h2), 1e-12));
}

vec3 arriving_on_ground(Light light, vec3 place) {
    if (has_area_lights && light.position.w > 2.5) return light.color.rgb * area_irradiance(light, place, u_ground.xyz);
    vec3 l;
    vec3 arrives = arriving(light, place, l);
    return arrives * (max(dot(u_ground.xyz, l), 0.0) / pi);
}

// Light at a place on the ground, divided by pi, of the environment and of the block's lights; `open` is what would arrive if
// nothing stood there.
vec3 light_on_ground(vec3 place, bool needed, out vec3 open) {
    vec3 up = u_ground.xyz;
    open = u_ground_sky;
    vec3 lit = open;
    for (int i = 0; i < u_block_lights; ++i) {
        vec3 arrives = arriving_on_ground(u_lights[i], place);
        open += arrives;
        if (has_shadows && i >= u_plain_lights)
            arrives *= shadow_of(i, place, up, needed && any(greaterThan(arrives, vec3(0.0))));
        lit += arrives;
    }
    return lit;
}

// Radiance of the ground at a place.
vec3 ground_radiance(vec3 place, bool needed) {
    vec3 open, lit = light_on_ground(place, needed, open);
    if (is_ground_lit) return u_ground_color * lit;
    float most = luminance(open);
    float hidden = most > 0.0 ? 1.0 - luminance(lit) / most : 0.0;
    return u_ground_color * (1.0 - u_ground_strength * hidden);
}

// Of what a surface sees of a lobe around a direction above it.
float part_below(vec3 direction, vec3 normal, float alpha) {
    // A facing horizon hides what a surface hides itself; an underside sees nothing else.
    float faces = dot(normal, u_ground.xyz), own = part_below(dot(direction, normal), alpha);
    float below = part_below(dot(direction, u_ground.xyz), alpha) - max(faces, 0.0) * own;
    return clamp(below / (1.0 - abs(faces) * own), 0.0, 1.0);
}

// Average radiance in a lobe around a direction that a surface reflects, of which `sky` is the environment's.
vec3 with_ground(vec3 sky, vec3 position, vec3 normal, vec3 direction, float alpha) {
    if (!has_ground) return sky;
    float below = part_below(direction, normal, alpha);
    bool meets = below > 0.002;
    if (!any_lane(meets)) return sky;
    // Of a lobe around the horizon, the middle of what is below.
    vec3 up = u_ground.xyz;
    float height = dot(direction, up), above = max(dot(position, up) - u_ground.w, 0.0);
    float steep = max(-height, 0.5 * alpha + 1e-3);
    vec3 place = position - up * above + (direction - up * height) * (above / steep);
    if (is_ground_lit) below *= 1.0 - smoothstep(0.4, 1.0, distance(place, u_ground_middle.xyz) / u_ground_middle.w);
    vec3 ground = ground_radiance(place, meets);
    // The environment's lower half is hidden. Its mean is not what narrow lobes see of it: little is left of those.
    float b2 = below * below, b4 = b2 * b2;
    vec3 left = max(sky - below * u_ground_hidden, 0.0) * (1.0 - b4 * b4);
    return meets ? left + below * ground : sky;
}

// The same of the lobe that a matt surface has, without what hides light from the ground.
vec3 with_even_ground(vec3 sky, vec3 normal) {
    vec3 ground = is_ground_lit ? u_ground_color * u_ground_sky : u_ground_color;
    return max(sky + (0.5 - 0.5 * dot(normal, u_ground.xyz)) * (ground - u_ground_hidden), 0.0);
}
