// What denoisers are guided by: edges of what the surfaces are (SVGF; Schied et al. 2017, section 4.4).
uniform sampler2D u_light;  // divided by the surface's reflectance; a: variance of the mean's luminance
// Sums over the frames that show a surface at the pixel.
uniform sampler2D u_surface;      // normal; a: log2 of the depth
uniform sampler2D u_reflectance;  // reflectance; a: the number of frames
uniform vec2 u_size;

// Falls of the weights: over the square of the normals' difference (that of cos^128), of the reflectances', and over the
// logarithm of the depth beyond the surface's own slope.
const float normal_fall = 64.0;
const float color_fall = 30.0;
const float depth_fall = 80.0;

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

vec4 mean(vec4 sum, float count) { return sum * (1.0 / max(count, 1.0)); }

float depth_at(ivec2 texel) { return texelFetch(u_surface, texel, 0).a / max(texelFetch(u_reflectance, texel, 0).a, 1.0); }

// The lesser of the two differences to the neighbours, for a slope that an edge does not bend.
float slope(float before, float here, float after) { return min(abs(here - before), abs(after - here)); }

struct Guides {
    vec4 surface;
    vec3 reflectance;
    vec2 slope;  // of the depth, per pixel
    float frames;
};

Guides guides_at(ivec2 here) {
    ivec2 last = ivec2(u_size) - 1;
    vec4 color = texelFetch(u_reflectance, here, 0);
    Guides g;
    g.frames = color.a;
    g.surface = mean(texelFetch(u_surface, here, 0), color.a);
    g.reflectance = mean(color, color.a).rgb;
    g.slope = vec2(slope(depth_at(max(here - ivec2(1, 0), ivec2(0))), g.surface.a, depth_at(min(here + ivec2(1, 0), last))),
                   slope(depth_at(max(here - ivec2(0, 1), ivec2(0))), g.surface.a, depth_at(min(here + ivec2(0, 1), last))));
    return g;
}

// The exponent of the weight of a place of the picture, `away` pixels to the sides.
float unlikeness(Guides own, ivec2 at, vec4 color, vec2 away) {
    vec4 other = mean(texelFetch(u_surface, at, 0), color.a);
    vec3 turned = other.xyz - own.surface.xyz, dyed = mean(color, color.a).rgb - own.reflectance;
    float sloped = dot(own.slope, away);
    float apart = max(abs(other.a - own.surface.a) - 2.0 * sloped, 0.0);
    return normal_fall * dot(turned, turned) + color_fall * dot(dyed, dyed) + depth_fall * apart;
}

bool is_inside(ivec2 at) { return at.x >= 0 && at.y >= 0 && at.x < int(u_size.x) && at.y < int(u_size.y); }
