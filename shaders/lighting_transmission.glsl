// The environment's and the scene's light that goes through a surface: KHR_materials_transmission and _volume. The lit
// picture of all that lies behind is looked up where the refracted ray meets it, blurred by the roughness; where the picture
// ends or is empty the environment is seen. Thin surfaces do not bend the ray. Volumes bend it where it enters, and where it leaves through the
// back faces that lie behind the pixel (Wyman 2005, "An Approximate Image-Space Approach for Interactive Refraction").

uniform sampler2D u_behind;        // premultiplied radiance, with mip levels
uniform sampler2D u_behind_depth;  // of the opaque surfaces
uniform sampler2D u_exit_depth;    // of the nearest back faces of volumes behind each pixel; 0: none
uniform sampler2D u_exit_normal;
uniform float u_behind_levels;
uniform float u_behind_reach;      // beyond this distance from the camera there is no geometry
uniform vec2 u_lobe_sample;        // in a still: this frame's facet, in units of alpha; else 0
uniform float u_lobe_share;        // part of the lobe's width that one frame blurs by

// Pixel and distance along the optical axis of a point relative to the camera.
vec3 projected(vec3 p) {
    vec3 v = p * u_world_from_view;  // the inverse of a rotation
    vec2 scale = is_orthographic ? u_unproject.xy : max(-v.z, 1e-20) * u_unproject.xy;
    vec2 ndc = v.xy / scale - u_unproject.zw;
    return vec3((ndc + vec2(1.0, -1.0)) * vec2(0.5, -0.5) * u_size, -v.z);
}

// Whether a pixel is known here: on the screen, and no farther away than tiles reach.
bool on_screen(vec2 pixel) {
    return all(greaterThanEqual(pixel, vec2(0.0))) && all(lessThan(pixel, u_size)) &&
           all(lessThan(abs(pixel - gl_FragCoord.xy), vec2(u_reach)));
}

// Distance along the optical axis of a reversed depth above 0.
float distance_of(float d) { return -view_position(vec2(0.0), d).z; }

// Pixels that a length of 1 has at a distance.
float pixels_per_unit(float distance) {
    return 0.5 * u_size.y / (is_orthographic ? u_unproject.y : u_unproject.y * distance);
}

struct Exit {
    vec3 position, direction;  // where the ray goes on, relative to the camera
    float path;                // length within the volume
};

// From a volume's front into it and out of its back.
Exit through_volume(Surface s, vec3 normal, float ior) {
    Extension e = s.extension;
    Exit x;
    vec3 inside = refract(-s.view, normal, 1.0 / ior);
    x.path = e.thickness;
    x.position = s.position + inside * x.path;
    x.direction = -s.view;  // a slab's other side, unless the true one is known
    vec2 start = gl_FragCoord.xy / u_size;
    float exit_depth = textureLod(u_exit_depth, start, 0.0).r;
    if (exit_depth <= 0.0) return x;
    // The ray meets the back where its point lies on it: a few steps of a secant from the straight way through.
    float axis = dot(inside, u_world_from_view * vec3(0.0, 0.0, -1.0));
    float path = (distance_of(exit_depth) - projected(s.position).z) / max(dot(-s.view, u_world_from_view * vec3(0.0, 0.0, -1.0)), 1e-3);
    vec2 uv = start;
    for (int i = 0; i < 4; ++i) {
        vec3 p = projected(s.position + inside * path);
        vec2 next = clamp(clamp(p.xy, gl_FragCoord.xy - u_reach, gl_FragCoord.xy + u_reach) / u_size, 0.0, 1.0);
        float depth = textureLod(u_exit_depth, next, 0.0).r;
        if (depth <= 0.0) break;  // beside the back: keep the last point on it
        uv = next;
        path = max(path + (distance_of(depth) - p.z) / max(axis, 0.1), 0.0);
    }
    x.path = path;
    x.position = s.position + inside * path;
    vec3 back = oct_decode(textureLod(u_exit_normal, uv, 0.0).rg * 2.0 - 1.0);
    if (dot(back, inside) > 0.0) back = -back;
    vec3 outside = refract(inside, back, ior);
    // What is reflected within comes out somewhere, most likely after one more reflection.
    x.direction = dot(outside, outside) > 0.0 ? outside : reflect(inside, back);
    return x;
}

// How far a projected point is in front of the opaque surface of its pixel, along the optical axis.
float gap_at(vec3 p) {
    float d = textureLod(u_behind_depth, p.xy / u_size, 0.0).r;
    return (d > 0.0 ? distance_of(d) : 1e30) - p.z;
}

// The opaque surface that a ray meets, as pixel and distance; z is 0 when it meets none.
vec3 march(vec3 origin, vec3 direction) {
    const int steps = 24;
    float reach = u_behind_reach;
    vec3 before = projected(origin);
    float gap_before = gap_at(before);
    for (int i = 1; i <= steps; ++i) {
        // Steps grow with the distance, so that what is near is not stepped over.
        float t = reach * pow((float(i) - 1.0 + u_tap_offset) / float(steps), 2.0);
        vec3 p = projected(origin + direction * t);
        if (p.z <= 0.0 || !on_screen(p.xy)) {
            // What the ray was in front of at the picture's border is taken to go on beyond it.
            vec2 border = clamp(before.xy, vec2(0.5), u_size - 0.5);
            float d = textureLod(u_behind_depth, border / u_size, 0.0).r;
            return d > 0.0 ? vec3(border, distance_of(d)) : vec3(0.0);
        }
        float gap = gap_at(p);
        // A thousandth of the distance, so that what stands on a floor sees it; but not when the ray goes away from it.
        if (gap <= 0.001 * p.z && gap < gap_before) {
            // Between the last two points, by the distances to the surface.
            vec3 low = before, high = p;
            for (int k = 0; k < 5; ++k) {
                vec3 middle = 0.5 * (low + high);
                if (gap_at(middle) <= 0.001 * middle.z) high = middle;
                else low = middle;
            }
            // Far in front of the ray: it passes behind that surface, which is none of its own.
            return gap_at(high) > -0.25 * abs(p.z - before.z) - 0.02 * high.z ? high : vec3(0.0);
        }
        before = p;
        gap_before = gap;
    }
    return vec3(0.0);
}

vec4 picture_at(vec2 pixel, float radius) {
    float level = clamp(log2(max(radius, 1.0)), 0.0, u_behind_levels - 1.0);
    return textureLod(u_behind, pixel / u_size, level);
}

// A direction of the lobe around this one: facets of slope alpha turn a ray by twice as much.
vec3 scattered_direction(vec3 direction, float alpha) {
    vec3 side = abs(direction.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 a = normalize(cross(direction, side)), b = cross(direction, a);
    return normalize(direction + 2.0 * alpha * (u_lobe_sample.x * a + u_lobe_sample.y * b));
}

// Radiance and coverage of what is seen along a ray that has left the surface.
vec4 seen(vec3 origin, vec3 direction, bool straight, float alpha) {
    direction = scattered_direction(direction, alpha);
    float own = projected(origin).z;
    vec3 hit;
    vec2 turned = vec2(0.0);
    if (straight) {
        float d = textureLod(u_behind_depth, gl_FragCoord.xy / u_size, 0.0).r;
        hit = vec3(gl_FragCoord.xy, d > 0.0 ? distance_of(d) : 1e20 * own);
        turned = u_lobe_sample;
    } else {
        hit = march(origin, direction);
    }
    vec4 picture = vec4(0.0);
    if (hit.z > 0.0) {
        float width = min(2.0 * alpha * max(hit.z - own, 0.0) * pixels_per_unit(hit.z), min(u_picture.w, 0.25 * u_reach));
        picture = picture_at(hit.xy + turned * width, width * u_lobe_share);
    }
    if (!has_environment) return picture;
    vec3 environment = u_env_intensity * prefiltered(direction, sqrt(alpha * u_lobe_share));
    return vec4(picture.rgb + (1.0 - picture.a) * environment, 1.0);
}

struct Through {
    vec3 part;   // of the light that comes through
    vec4 light;  // radiance and coverage of what is seen
};

// With one index of refraction for all colours.
Through through_surface(Surface s, float ior) {
    Extension e = s.extension;
    float rough = s.roughness * clamp(2.0 * ior - 2.0, 0.0, 1.0);  // without refraction facets turn nothing
    Through t;
    t.part = s.through * s.keep;
    Exit x = Exit(s.position, -s.view, 0.0);
    bool straight = e.thickness <= 0.0 || ior == 1.0;
    vec3 normal = dot(s.normal, s.view) > 0.0 ? s.normal : -s.normal;
    if (e.thickness > 0.0) {
        x = through_volume(s, normal, ior);
        t.part *= pow(max(e.transmittance, 1e-6), vec3(x.path / e.thickness));
    }
    t.light = seen(x.position, x.direction, straight, rough * rough);
    return t;
}

// KHR_materials_dispersion: red and blue have indices of their own, which the Abbe number sets apart.
Through dispersed(Surface s) {
    Extension e = s.extension;
    float spread = 0.025 * e.dispersion * (e.ior - 1.0);
    Through red = through_surface(s, e.ior - spread), green = through_surface(s, e.ior), blue = through_surface(s, e.ior + spread);
    vec3 seen_part = vec3(0.2126 * red.light.a, 0.7152 * green.light.a, 0.0722 * blue.light.a);
    Through t;
    t.part = vec3(red.part.r, green.part.g, blue.part.b);
    t.light = vec4(red.light.r, green.light.g, blue.light.b, dot(seen_part, vec3(1.0)));
    return t;
}

// What comes through the surface, and how much of what is behind it covers: light to be added, coverage.
vec4 transmitted(Surface s) {
    if (max_channel(s.through) <= 0.0) return vec4(0.0, 0.0, 0.0, 1.0);
    bool disperses = s.extension.dispersion > 0.0 && s.extension.thickness > 0.0;
    Through t;
    if (disperses) t = dispersed(s);
    else t = through_surface(s, s.extension.ior);
    // Where nothing is seen, the background beyond the picture shines through.
    float coverage = 1.0 - dot(t.part, vec3(0.2126, 0.7152, 0.0722)) * (1.0 - t.light.a);
    return vec4(t.part * t.light.rgb, coverage);
}
