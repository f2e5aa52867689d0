// What denoisers are guided by: edges of what the surfaces are (SVGF; Schied et al. 2017, section 4.4).
uniform sampler2D u_light;   // divided by the surface's reflectance; a: variance of the mean's luminance
uniform sampler2D u_guides;  // packed normal and reflectance, log2 of the depth, the hue's noise; see Guides
uniform vec2 u_size;

// Falls of the weights: over the square of the normals' difference (that of cos^128), of the reflectances', and over the
// logarithm of the depth beyond the surface's own slope.
const float normal_fall = 64.0 * 4.0;  // of normals that are brought to 0 to 1
const float color_fall = 30.0;
const float depth_fall = 80.0;

// Light is compared as displays show it, more or less: what is far brighter than white differs little, and the noise of a
// highlight is not that of what lies around it.
float compressed(float bright) { return log(1.0 + bright); }

// The variance of that. Of light that noise may be all of, all of it.
float compressed_noise(float bright, float variance) {
    float deviation = compressed(bright) - compressed(max(bright - sqrt(max(variance, 0.0)), 0.0));
    return deviation * deviation;
}

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

// Red and blue likewise, of light whose luminance and compressed() are known: with them green is known too.
vec2 compressed_hue(vec3 light, float bright, float shown) { return light.rb * (shown / max(bright, 1e-20)); }

vec3 unpacked(float bits) { return unpackUnorm4x8(floatBitsToUint(bits)).rgb; }

vec2 depth_and_noise_at(ivec2 texel) { return texelFetch(u_guides, texel, 0).ba; }

// The lesser of the two differences to the neighbours, for a slope that an edge does not bend.
float slope(float before, float here, float after) { return min(abs(here - before), abs(after - here)); }

struct Guides {
    vec3 normal, reflectance;  // 0 to 1 each
    float depth;               // log2
    vec2 slope;                // of the depth, per pixel
    vec2 shares;               // of red and blue in what the surface sends back, of length 1
    float hue_noise;           // variance of red and blue in parts of that of luminance; 0: no frame shows a surface
    float normal_fall;
};

Guides guides_at(ivec2 here) {
    ivec2 last = ivec2(u_size) - 1;
    vec4 guides = texelFetch(u_guides, here, 0);
    Guides g;
    g.normal = unpacked(guides.r);
    g.reflectance = unpacked(guides.g);
    g.depth = guides.b;
    vec2 sent_back = max(g.reflectance.rb, vec2(0.001));
    g.shares = sent_back / sqrt(dot(sent_back, sent_back));
    g.normal_fall = normal_fall;
    vec2 left = depth_and_noise_at(max(here - ivec2(1, 0), ivec2(0))), right = depth_and_noise_at(min(here + ivec2(1, 0), last));
    vec2 below = depth_and_noise_at(max(here - ivec2(0, 1), ivec2(0))), above = depth_and_noise_at(min(here + ivec2(0, 1), last));
    g.slope = vec2(slope(left.x, g.depth, right.x), slope(below.x, g.depth, above.x));
    float around = max(max(left.y, right.y), max(below.y, above.y));
    g.hue_noise = guides.a > 0.0 ? max(guides.a, around) : 0.0;
    return g;
}

// The square of a difference of red and blue, as that of the luminance of light without a hue.
float hue_square(Guides own, vec2 difference) {
    vec2 seen = own.shares * difference;
    return dot(seen, seen);
}

// A whole number and a part, 0 to 1, in one.
float packed_fall(float fall, float part) { return floor(fall) + 0.5 * part; }
float fall_in(float both) { return floor(both); }
float part_in(float both) { return 2.0 * fract(both); }

// The exponent of the weight of a place of the picture, `away` pixels to the sides.
float unlikeness(Guides own, vec4 guides, vec2 away) {
    vec3 turned = unpacked(guides.r) - own.normal, dyed = unpacked(guides.g) - own.reflectance;
    float sloped = dot(own.slope, away);
    float apart = max(abs(guides.b - own.depth) - 2.0 * sloped, 0.0);
    return own.normal_fall * dot(turned, turned) + color_fall * dot(dyed, dyed) + depth_fall * apart;
}

bool is_inside(ivec2 at) { return at.x >= 0 && at.y >= 0 && at.x < int(u_size.x) && at.y < int(u_size.y); }
