// The environment's and the scene's light that goes through a surface: KHR_materials_transmission and _volume. The lit
// picture of all that lies behind is looked up where the refracted ray meets it, blurred by the roughness; where the picture
// ends or is empty the environment is seen, or a background of one colour. Thin surfaces do not bend the ray. Volumes bend it
// where it enters, and where it leaves through the back faces that lie behind the pixel (Wyman 2005, "An Approximate
// Image-Space Approach for Interactive Refraction").

#feature BEFORE_COLOR is_before_color  // the background is one colour

uniform vec3 u_background;           // its radiance
uniform sampler2D u_behind_picture;  // premultiplied radiance, with mip levels
uniform sampler2D u_behind_depth;    // of the opaque surfaces
uniform sampler2D u_exit_depth;      // of the nearest back faces of volumes behind each pixel; 0: none
uniform sampler2D u_exit_normal;
uniform float u_behind_levels;
uniform float u_behind_reach;      // beyond this distance from the camera there is no surface
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

// A plane in view space that a ray stays on one side of: dot(xyz, p) + w is above 0 there.
vec4 no_face() { return vec4(0.0, 0.0, 0.0, 1e30); }

struct Exit {
    vec3 position, direction;  // where the ray goes on, relative to the camera
    vec3 inside;               // its direction within the volume
    float path;                // length within the volume
    vec4 back;                 // the face that it meets from within
    vec4 kept;                 // the same if it is reflected there, else no_face()
};

// The plane of the back face at a place in the picture; `normal` looks into the volume.
vec4 face_at(vec2 uv, vec3 normal) {
    vec3 v = view_position(floor(uv * u_size) + 0.5, max(textureLod(u_exit_depth, uv, 0.0).r, 1e-30));
    vec3 n = normal * u_world_from_view;
    return vec4(n, -dot(n, v));
}

// From a volume's front into it and out of its back.
Exit through_volume(Surface s, vec3 normal, float ior) {
    Extension e = s.extension;
    Exit x;
    vec3 inside = refract(-s.view, normal, 1.0 / ior);
    x.inside = inside;
    x.path = e.thickness;
    x.position = s.position + inside * x.path;
    x.direction = -s.view;  // a slab's other side, unless the true one is known
    x.back = no_face();
    x.kept = no_face();
    vec2 uv = gl_FragCoord.xy / u_size;
    float exit_depth = textureLod(u_exit_depth, uv, 0.0).r;
    bool has_back = exit_depth > 0.0;
    if (!any_lane(has_back)) return x;
    // The ray meets the back where its point lies on it: a few steps of a secant from the straight way through.
    vec3 forward = u_world_from_view * vec3(0.0, 0.0, -1.0);
    float axis = dot(inside, forward);
    float path = (distance_of(exit_depth) - projected(s.position).z) / max(dot(-s.view, forward), 1e-3);
    bool on_back = has_back;
    for (int i = 0; i < 4; ++i) {
        vec3 p = projected(s.position + inside * path);
        vec2 next = clamp(clamp(p.xy, gl_FragCoord.xy - u_reach, gl_FragCoord.xy + u_reach) / u_size, 0.0, 1.0);
        float depth = textureLod(u_exit_depth, next, 0.0).r;
        on_back = on_back && depth > 0.0;  // beside the back: the last point on it is kept
        uv = on_back ? next : uv;
        path = on_back ? max(path + (distance_of(depth) - p.z) / max(axis, 0.1), 0.0) : path;
    }
    x.path = has_back ? path : x.path;
    x.position = has_back ? s.position + inside * path : x.position;
    vec3 back = oct_decode(textureLod(u_exit_normal, uv, 0.0).rg * 2.0 - 1.0);
    back = dot(back, inside) > 0.0 ? -back : back;
    vec3 outside = refract(inside, back, ior);
    // What is reflected within comes out somewhere, most likely after one more reflection.
    bool passes = dot(outside, outside) > 0.0;
    outside = passes ? outside : reflect(inside, back);
    x.direction = has_back ? outside : x.direction;
    x.back = has_back ? face_at(uv, back) : x.back;
    x.kept = passes ? x.kept : x.back;
    return x;
}

// How far a projected point is in front of the opaque surface of its pixel, along the optical axis. A surface that touches the
// face, or lies beyond it, is none: a thousandth of the distance is in contact.
float gap_at(vec3 p, vec4 face) {
    float d = textureLod(u_behind_depth, p.xy / u_size, 0.0).r;
    vec3 v = view_position(floor(p.xy) + 0.5, max(d, 1e-30));
    bool is_in_front = d > 0.0 && dot(face.xyz, v) + face.w > 0.001 * p.z;
    return (is_in_front ? -v.z : 1e30) - p.z;
}

// Whether a projected point is behind the opaque surface of its pixel: a thousandth of the distance in front of it counts, so
// that what stands on a floor sees it.
bool is_met(vec3 p, float gap) { return gap <= 0.001 * p.z; }

const float far_away = 1e20;

// What a ray that meets nothing goes to: the pixel where it ends, or the nearest to it that is known.
vec4 vanishing(vec3 origin, vec3 direction, float reach) {
    vec3 p = projected(origin + direction * (1e3 * reach));
    vec2 pixel = p.z > 0.0 ? p.xy : gl_FragCoord.xy;
    pixel = clamp(clamp(pixel, gl_FragCoord.xy - u_reach, gl_FragCoord.xy + u_reach), vec2(0.5), u_size - 0.5);
    return vec4(pixel, far_away, 0.0);
}

// The opaque surface that a ray meets within a length, as pixel and distance, and 1. Beyond the picture's border the surface
// that was last passed is taken to go on: w is 0.5. w is 0 when it meets none, and where it is not `needed`. The ray stays on
// one side of a face.
vec4 march(vec3 origin, vec3 direction, float reach, vec4 face, bool needed) {
    const int steps = 24;
    vec3 before = projected(origin), low = before, high = before;
    vec4 hit = vanishing(origin, direction, reach);
    float gap_before = gap_at(before, face);
    bool going = needed, unmet = needed;
    for (int i = 1; i <= steps; ++i) {
        if (!any_lane(going)) break;
        // Steps grow with the distance, so that what is near is not stepped over.
        float part = (float(i) - 1.0 + u_tap_offset) / float(steps);
        vec3 p = projected(origin + direction * (reach * part * part));
        bool leaves = going && (p.z <= 0.0 || !on_screen(p.xy));
        if (any_lane(leaves)) {
            // What the ray was in front of at the picture's border is taken to go on beyond it.
            vec2 border = clamp(before.xy, vec2(0.5), u_size - 0.5);
            float d = textureLod(u_behind_depth, border / u_size, 0.0).r;
            hit = leaves && d > 0.0 ? vec4(border, distance_of(d), 0.5) : hit;
            going = going && !leaves;
        }
        float gap = gap_at(p, face);
        // Not when the ray goes away from the surface.
        bool meets = going && is_met(p, gap) && gap < gap_before;
        low = meets ? before : low;
        high = meets ? p : high;
        unmet = unmet && !meets;
        going = going && !meets;
        before = p;
        gap_before = gap;
    }
    bool has_met = needed && !unmet;
    if (!any_lane(has_met)) return hit;
    // Between the last two points, by the distances to the surface.
    float span = abs(high.z - low.z);
    for (int k = 0; k < 5; ++k) {
        vec3 middle = 0.5 * (low + high);
        bool meets = is_met(middle, gap_at(middle, face));
        high = meets ? middle : high;
        low = meets ? low : middle;
    }
    // Far in front of the ray: it passes behind that surface, which is none of its own.
    bool is_own = gap_at(high, face) > -0.25 * span - 0.02 * high.z;
    return has_met && is_own ? vec4(high, 1.0) : hit;
}

vec4 picture_at(vec2 pixel, float radius) {
    float level = clamp(log2(max(radius, 1.0)), 0.0, u_behind_levels - 1.0);
    return textureLod(u_behind_picture, pixel / u_size, level);
}

// A direction of the lobe around this one: facets of slope alpha turn a ray by twice as much.
vec3 scattered_direction(vec3 direction, float alpha) {
    vec3 side = abs(direction.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 a = normalize(cross(direction, side)), b = cross(direction, a);
    return normalize(direction + 2.0 * alpha * (u_lobe_sample.x * a + u_lobe_sample.y * b));
}

// Radiance and coverage of what is seen along a ray that has left the surface, unless it has met something `within` it.
vec4 seen(vec3 origin, vec3 direction, vec4 face, bool straight, float alpha, vec4 within) {
    direction = scattered_direction(direction, alpha);
    float own = projected(origin).z;
    float d = textureLod(u_behind_depth, gl_FragCoord.xy / u_size, 0.0).r;
    vec4 hit = vec4(gl_FragCoord.xy, d > 0.0 ? distance_of(d) : far_away, 1.0);
    vec2 turned = straight ? u_lobe_sample : vec2(0.0);
    bool marches = !straight && within.w < 0.5;
    if (any_lane(marches)) {
        vec4 beyond = march(origin, direction, u_behind_reach, face, marches);
        hit = marches ? beyond : hit;
    }
    hit = within.w > 0.5 ? within : hit;
    float width = min(2.0 * alpha * max(hit.z - own, 0.0) * pixels_per_unit(max(hit.z, 1e-20)), min(u_picture.w, 0.25 * u_reach));
    vec4 picture = picture_at(hit.xy + turned * width, width * u_lobe_share);
    // A lobe around a ray that meets nothing sees what is beside it.
    picture *= hit.w > 0.0 ? 1.0 : clamp(width * u_lobe_share - 1.0, 0.0, 1.0);
    if (is_before_color) return vec4(picture.rgb + (1.0 - picture.a) * u_background, 1.0);
    if (!has_environment) return picture;
    vec3 environment = prefiltered(direction, sqrt(alpha * u_lobe_share));
    return vec4(picture.rgb + (1.0 - picture.a) * environment, 1.0);
}

// Length of a ray within a volume as far as this distance along the optical axis.
float length_to(float distance, vec3 from, Exit x) {
    float axis = dot(x.inside, u_world_from_view * vec3(0.0, 0.0, -1.0));
    return clamp((distance - projected(from).z) / max(axis, 0.1), 0.0, x.path);
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
    vec3 position = s.position, direction = -s.view;
    bool is_volume = e.thickness > 0.0;
    vec4 within = vec4(0.0), face = no_face();
    if (any_lane(is_volume)) {
        vec3 normal = dot(s.normal, s.view) > 0.0 ? s.normal : -s.normal;
        Exit x = through_volume(s, normal, ior);
        within = march(s.position, x.inside, x.path, x.back, is_volume);
        x.path = within.w > 0.5 ? length_to(within.z, s.position, x) : x.path;
        vec3 left = transmittance_over(e, x.path);
        t.part = is_volume ? t.part * left : t.part;
        position = is_volume ? x.position : position;
        direction = is_volume ? x.direction : direction;
        face = is_volume ? x.kept : face;
    }
    t.light = seen(position, direction, face, !is_volume || ior == 1.0, rough * rough, within);
    return t;
}

// KHR_materials_dispersion: red and blue have indices of their own, which the Abbe number sets apart; `green` is what comes
// through with the material's.
Through dispersed(Surface s, Through green) {
    Extension e = s.extension;
    float spread = 0.025 * e.dispersion * (e.ior - 1.0);
    Through red = through_surface(s, e.ior - spread), blue = through_surface(s, e.ior + spread);
    vec3 seen_part = vec3(0.2126 * red.light.a, 0.7152 * green.light.a, 0.0722 * blue.light.a);
    Through t;
    t.part = vec3(red.part.r, green.part.g, blue.part.b);
    t.light = vec4(red.light.r, green.light.g, blue.light.b, dot(seen_part, vec3(1.0)));
    return t;
}

// What comes through the surface, and how much of what is behind it covers: light to be added, coverage.
vec4 transmitted(Surface s) {
    bool passes = max_channel(s.through) > 0.0;
    if (!any_lane(passes)) return vec4(0.0, 0.0, 0.0, 1.0);
    Through t = through_surface(s, s.extension.ior);
    bool disperses = passes && s.extension.dispersion > 0.0 && s.extension.thickness > 0.0;
    if (any_lane(disperses)) {
        Through apart = dispersed(s, t);
        t.part = disperses ? apart.part : t.part;
        t.light = disperses ? apart.light : t.light;
    }
    // Where nothing is seen, the background beyond the picture shines through.
    float coverage = 1.0 - dot(t.part, vec3(0.2126, 0.7152, 0.0722)) * (1.0 - t.light.a);
    return passes ? vec4(t.part * t.light.rgb, coverage) : vec4(0.0, 0.0, 0.0, 1.0);
}
