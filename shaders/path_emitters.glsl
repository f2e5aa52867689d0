// Points of area lights for next-event estimation. PathLights::for_each_met() in render/raytrace/path_lights.h has the same
// densities.
#include "common_arriving.glsl"
#include "common_brdf.glsl"
#include "common_frame.glsl"

// The way from a place to a point of a rectangle or a disc, by two numbers in [0, 1), and the density of such directions per
// steradian; 0 behind the light.
vec3 way_to_plane(Light light, vec3 position, vec2 u, out float density) {
    vec3 x = light.cone.xyz, y = cross(light.direction.xyz, normalize(light.cone.xyz)) * light.cone.w;
    vec2 at = 2.0 * u - 1.0;
    if (light.position.w > 3.5) {
        float radius = sqrt(u.x), phi = 2.0 * pi * u.y;
        at = vec2(radius * cos(phi), radius * sin(phi));
    }
    vec3 way = light.position.xyz - position + x * at.x + y * at.y;
    float d2 = dot(way, way), cosine = -dot(light.direction.xyz, way) * inversesqrt(max(d2, 1e-30));
    density = cosine > 0.0 ? d2 / max(light.direction.w * cosine, 1e-30) : 0.0;
    return way;
}

// The way to a point of the disc that a light is seen as which is no area light; of parallel light at a distance of 1.
vec3 way_to_disc(vec4 place, vec4 direction, vec3 position, vec2 u) {
    vec3 middle = place.w > 0.5 ? place.xyz - position : -direction.xyz, b1, b2;
    frame_around(middle * inversesqrt(max(dot(middle, middle), 1e-30)), b1, b2);
    float radius = direction.w * sqrt(u.x), phi = 2.0 * pi * u.y;
    return middle + b1 * (radius * cos(phi)) + b2 * (radius * sin(phi));
}

// The same for a sphere, by the cone in which it is seen.
vec3 way_to_sphere(Light light, vec3 position, vec2 u, out float density) {
    vec3 centre = light.position.xyz - position, b1, b2;
    float d2 = dot(centre, centre), r2 = light.cone.w * light.cone.w, sine2 = r2 / max(d2, 1e-30);
    vec3 axis = centre * inversesqrt(max(d2, 1e-30));
    frame_around(axis, b1, b2);
    // 1 - cos of the cone's half angle.
    float open = sine2 / (1.0 + sqrt(max(1.0 - sine2, 0.0)));
    float cosine = 1.0 - u.x * open, phi = 2.0 * pi * u.y;
    float s2 = max(1.0 - cosine * cosine, 0.0), sine = sqrt(s2);
    float reach = sqrt(d2) * cosine - sqrt(max(r2 - d2 * s2, 0.0));
    density = sine2 < 1.0 && open > 0.0 ? 1.0 / (2.0 * pi * open) : 0.0;
    return (b1 * (sine * cos(phi)) + b2 * (sine * sin(phi)) + axis * cosine) * reach;
}
