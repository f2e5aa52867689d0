// Directions for the occlusion of one pixel.
#include "common_camera.glsl"
#include "occlusion_surface.glsl"

#feature BLURRED is_blurred

uniform int u_directions;  // per pixel and frame
uniform int u_steps;       // per direction and side
uniform int u_frame;       // index of the accumulated frame

// Point i of this pixel in the unit cube: an additive recurrence, so that any run of points is spread evenly. The second
// coordinate, on which the azimuth depends most, has the golden ratio; with the generalised one for all three (Roberts
// 2018) the noise of 16 frames is half as large again.
vec3 sample_point(int i) {
    vec3 golden = vec3(0.54970048, 0.61803399, 0.75487767);
    if (is_blurred) {
        // The 4x4 pixels that are blurred together share one run of points, neighbours far apart in it.
        ivec2 p = ivec2(gl_FragCoord.xy) & 3;
        int place = ((p.x & 1) * 8) + (((p.x ^ p.y) & 1) * 4) + ((p.x >> 1) * 2) + (((p.x ^ p.y) >> 1) & 1);
        int k = (u_frame * 16 + place) * u_directions + i;
        return fract(vec3(0.5) + float(k & 0xffff) * golden);
    }
    // Every pixel starts elsewhere: interleaved gradient noise (Jimenez 2014) at three places.
    int k = u_frame * u_directions + i;
    vec2 f = vec2(0.06711056, 0.00583715), p = gl_FragCoord.xy + (has_half_resolution ? 0.5 : 1.0) * u_picture.xy;
    vec3 start = fract(52.9829189 * fract(vec3(dot(p, f), dot(p + vec2(47.0, 17.0), f.yx), dot(p + 113.0, f + f.yx))));
    return fract(start + float(k & 0xffff) * golden);
}

// Unit vector distributed by its cosine to the normal.
vec3 cosine_direction(vec3 normal, vec2 u) {
    float radius = sqrt(u.x), angle = 6.28318530718 * u.y;
    // A frame around the normal without a branch (Duff et al. 2017).
    float side = normal.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + normal.z), b = normal.x * normal.y * a;
    vec3 t = vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
    vec3 s = vec3(b, side + normal.y * normal.y * a, -normal.y);
    return radius * cos(angle) * t + radius * sin(angle) * s + sqrt(max(1.0 - u.x, 0.0)) * normal;
}

// A shading normal that faces away from the viewer has no hemisphere that is seen: the nearest one that has.
vec3 towards_viewer(vec3 normal, vec3 view) {
    const float least = 0.05;
    return normalize(normal + view * max(least - dot(normal, view), 0.0));
}
