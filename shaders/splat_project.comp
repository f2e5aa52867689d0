// Projects Gaussian splats, as SplatProjector does on the CPU (Zwicker et al. 2002; Kerbl et al. 2023).
#include "common_encoding.glsl"
#include "common_splat.glsl"

#feature ORTHOGRAPHIC is_orthographic
#feature ANTIALIAS is_antialiased
#feature DARKENED is_darkened

layout(local_size_x = 256) in;

layout(std430, binding = 2) readonly buffer Means { float means[]; };
layout(std430, binding = 3) readonly buffer Shapes { float shapes[]; };       // semi-axes, quaternion w x y z, opacity
layout(std430, binding = 4) readonly buffer Harmonics { uint harmonics[]; };  // pairs of halves
layout(std430, binding = 5) writeonly buffer Depths { uint depths[]; };       // keys that splats are sorted by
layout(std430, binding = 6) buffer Quads { uint quads[4]; };                  // for gl::draw_quads(): instances second

layout(std430, binding = 7) readonly buffer Sides { uint sides[]; };          // bytes: SplatLight::Parts::all_sides()

uniform uint u_count;
uniform uint u_first;        // place of the first
uniform vec3 u_centre;       // that means are taken relative to
uniform mat4 u_view;         // from there
uniform mat4 u_clip;         // from view space
uniform vec3 u_eye;          // relative to the centre; orthographic: where the camera looks
uniform vec4 u_picture;      // size of the frame; of the picture
uniform vec2 u_origin;       // of the frame in the picture
uniform float u_least_width; // of clip space at the near plane
uniform uint u_degree;
uniform mat3 u_normal_from_mesh;

// Variance that training adds, square pixels; the derivative beyond so many half pictures is that at the border.
const float low_pass = 0.3, derivative_limit = 1.3;
const float least_deviation = 1e-6;
const uint unseen = 0xffffffffu;

float limited(float ndc, float size, float origin, float picture) {
    float pixel = (ndc + 1.0) / 2.0 * size + origin, middle = picture / 2.0, reach = derivative_limit * middle;
    return (clamp(pixel, middle - reach, middle + reach) - origin) / size * 2.0 - 1.0;
}

mat3 rotation(vec4 q) {  // w x y z
    q = normalize(q);
    float w = q.x, x = q.y, y = q.z, z = q.w;
    return mat3(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y),
                2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x),
                2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y));
}

float harmonic(uint i, uint index) {
    uint stride = (3u * (u_degree + 1u) * (u_degree + 1u) + 1u) / 2u;
    vec2 pair = unpackHalf2x16(harmonics[i * stride + index / 2u]);
    return index % 2u == 0u ? pair.x : pair.y;
}

vec3 coefficient(uint i, uint k) { return vec3(harmonic(i, 3u * k), harmonic(i, 3u * k + 1u), harmonic(i, 3u * k + 2u)); }

// As spherical_harmonics() in scene/splat_basis.h.
vec3 color_of(uint i, vec3 d) {
    vec3 color = vec3(0.5) + 0.28209479177387814 * coefficient(i, 0u);
    if (u_degree >= 1u) {
        const float c1 = 0.4886025119029199;
        color += -c1 * d.y * coefficient(i, 1u) + c1 * d.z * coefficient(i, 2u) - c1 * d.x * coefficient(i, 3u);
    }
    float xx = d.x * d.x, yy = d.y * d.y, zz = d.z * d.z;
    if (u_degree >= 2u) {
        const float c2 = 1.0925484305920792;
        color += c2 * d.x * d.y * coefficient(i, 4u) - c2 * d.y * d.z * coefficient(i, 5u) +
                 0.31539156525252005 * (2.0 * zz - xx - yy) * coefficient(i, 6u) -
                 c2 * d.x * d.z * coefficient(i, 7u) + c2 / 2.0 * (xx - yy) * coefficient(i, 8u);
    }
    if (u_degree >= 3u) {
        const float c33 = 0.5900435899266435, c31 = 0.4570457994644658;
        color += -c33 * d.y * (3.0 * xx - yy) * coefficient(i, 9u) +
                 2.890611442640554 * d.x * d.y * d.z * coefficient(i, 10u) -
                 c31 * d.y * (4.0 * zz - xx - yy) * coefficient(i, 11u) +
                 0.3731763325901154 * d.z * (2.0 * zz - 3.0 * xx - 3.0 * yy) * coefficient(i, 12u) -
                 c31 * d.x * (4.0 * zz - xx - yy) * coefficient(i, 13u) +
                 1.445305721320277 * d.z * (xx - yy) * coefficient(i, 14u) -
                 c33 * d.x * (xx - 3.0 * yy) * coefficient(i, 15u);
    }
    return max(color, 0.0);
}

// The colour where surfaces hide a part of the light from the side that is seen, as SplatLight has it. `axes`: unit.
vec3 darkened(uint i, vec3 color, vec3 semi_axes, mat3 axes, vec3 towards) {
    uint thinnest = semi_axes.y < semi_axes.x ? 1u : 0u;
    if (semi_axes.z < semi_axes[thinnest]) thinnest = 2u;
    vec3 axis = axes[thinnest];
    vec3 normal = u_normal_from_mesh * (dot(axis, towards) < 0.0 ? -axis : axis), size = abs(normal);
    uint largest = size.y > size.x ? 1u : 0u;
    if (size.z > size[largest]) largest = 2u;
    uint side = 2u * i + (normal[largest] < 0.0 ? 1u : 0u);
    uint part = (sides[side / 4u] >> (8u * (side % 4u))) & 255u;
    return part == 255u ? color : srgb_encode(srgb_decode(color) * (float(part - 1u) / 254.0));
}

// False for one that is not seen.
bool project(uint i, out ScreenSplat splat) {
    uint s = 8u * i;
    float opacity = shapes[s + 7u];
    if (!(opacity >= least_alpha)) return false;
    vec3 mean = vec3(means[3u * i], means[3u * i + 1u], means[3u * i + 2u]) - u_centre;
    vec4 clip = u_clip * vec4((u_view * vec4(mean, 1.0)).xyz, 1.0);
    if (!(clip.w >= u_least_width)) return false;
    vec3 ndc = clip.xyz / clip.w;
    if (!(ndc.z > 0.0 && ndc.z <= 1.0)) return false;
    vec2 half_size = u_picture.xy / 2.0;
    vec2 place = vec2(1.0 + ndc.x, 1.0 - ndc.y) * half_size;
    float x = limited(ndc.x, u_picture.x, u_origin.x, u_picture.z), y = -limited(-ndc.y, u_picture.y, u_origin.y, u_picture.w);
    mat4 rows = transpose(u_clip);
    vec3 w = rows[3].xyz;
    mat3 derivative = transpose(mat3(half_size.x / clip.w * (rows[0].xyz - x * w),
                                     -half_size.y / clip.w * (rows[1].xyz - y * w),
                                     (rows[2].xyz - ndc.z * w) / clip.w));
    mat3 scales = mat3(shapes[s], 0.0, 0.0, 0.0, shapes[s + 1u], 0.0, 0.0, 0.0, shapes[s + 2u]);
    vec4 q = vec4(shapes[s + 3u], shapes[s + 4u], shapes[s + 5u], shapes[s + 6u]);
    mat3 turn = rotation(q);
    mat3 axes = transpose(derivative * mat3(u_view) * turn * scales);  // columns: of column, row and depth
    float own_xx = dot(axes[0], axes[0]), own_yy = dot(axes[1], axes[1]), own_xy = dot(axes[0], axes[1]);
    float xx = own_xx + low_pass, yy = own_yy + low_pass, area = xx * yy - own_xy * own_xy;
    if (!(area > 0.0) || isinf(area)) return false;
    if (is_antialiased) opacity *= sqrt(max(0.0, own_xx * own_yy - own_xy * own_xy) / area);
    if (!(opacity >= least_alpha)) return false;
    float x_depth = dot(axes[0], axes[2]), y_depth = dot(axes[1], axes[2]);
    vec2 by_place = vec2(yy * x_depth - own_xy * y_depth, xx * y_depth - own_xy * x_depth) / area;
    float along = dot(axes[2], axes[2]) - by_place.x * x_depth - by_place.y * y_depth;
    float sharpness = 1.0 / max(sqrt(max(0.0, along)), ndc.z * least_deviation);
    float farthest = 2.0 * log(opacity / least_alpha);
    vec2 reach = sqrt(farthest * vec2(xx, yy));
    if (any(lessThanEqual(place + reach, vec2(0.0))) || any(greaterThanEqual(place - reach, u_picture.xy))) return false;
    vec3 direction = normalize(is_orthographic ? u_eye : mean - u_eye);
    vec3 color = color_of(i, direction);
    if (is_darkened) color = darkened(i, color, vec3(shapes[s], shapes[s + 1u], shapes[s + 2u]), turn, -direction);
    splat = ScreenSplat(vec4(place, reach), vec4(yy / area, -own_xy / area, xx / area, opacity),
                        vec4(color, ndc.z), vec4(by_place, sharpness, is_orthographic ? 0.0 : ndc.z));
    return true;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= u_count) return;
    uint at = u_first + i;
    ScreenSplat splat;
    bool is_seen = project(i, splat);
    if (is_seen) {
        splats[at] = splat;
        atomicAdd(quads[1], 1u);
    }
    depths[at] = is_seen ? floatBitsToUint(splat.color.w) : unseen;  // the farthest first, of positive floats
    order[at] = at;
}
