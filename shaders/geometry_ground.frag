// An endless plane, seen from above, into the G-buffer.
#include "common_encoding.glsl"
#include "common_camera.glsl"

uniform vec4 u_plane;     // world normal, which is up; signed distance from the camera along it
uniform vec3 u_color;     // linear
uniform float u_roughness;
uniform float u_kind;

layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out float o_depth;
layout(location = 4) out vec4 o_radiance;

void main() {
    vec3 direction = ray_direction(gl_FragCoord.xy), forward = u_world_from_view * vec3(0.0, 0.0, -1.0);
    vec3 origin = vec3(0.0);
    if (is_orthographic)
        origin = u_world_from_view * vec3((ndc_of_pixel(gl_FragCoord.xy) + u_unproject.zw) * u_unproject.xy, 0.0);
    float falls = dot(u_plane.xyz, direction);
    if (falls > -1e-6) discard;
    float z = (u_plane.w - dot(u_plane.xyz, origin)) / falls * dot(direction, forward);
    float depth = reversed_depth(z);
    if (!(depth > 0.0 && depth <= 1.0)) discard;
    o_albedo = vec4(u_color, 1.0);
    o_normal = oct_encode(u_plane.xyz) * 0.5 + 0.5;
    o_material = vec4(0.0, u_roughness, 1.0, u_kind);
    o_depth = depth;
    o_radiance = vec4(0.0);
    gl_FragDepth = depth;
}
