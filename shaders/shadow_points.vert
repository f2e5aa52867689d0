// Points into a shadow map, as discs that face the light. See render/splat_shadows.h.
#include "common_encoding.glsl"

#feature PUSHED is_pushed
#feature VERTEX_COLOR has_vertex_colors

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec2 a_normal;
layout(location = 2) in vec4 a_color;

uniform vec4 u_light;  // in the mesh's frame; w 0: direction towards it
uniform vec3 u_push;   // radius of a disc in the mesh's frame, steepest tangent, radii more
uniform mat4 u_clip_from_mesh;
uniform vec2 u_diameter;  // texels times w
uniform float u_opacity;

flat out float v_alpha;
flat out vec2 v_extent;   // half the diameter, in parts of the point's square; 0: all of the square

void main() {
    vec3 p = a_position;
    if (is_pushed) {
        vec3 l = normalize(u_light.xyz - u_light.w * p);
        float c = abs(dot(oct_decode(a_normal), l));
        float tangent = sqrt(max(0.0, 1.0 - c * c)) / max(c, 1e-3);
        p -= l * (u_push.x * (min(tangent, u_push.y) + u_push.z));
    }
    gl_Position = u_clip_from_mesh * vec4(p, 1.0);
    vec2 diameter = u_diameter / gl_Position.w;
    gl_PointSize = max(max(diameter.x, diameter.y), 1.0);
    // The smallest discs would miss the texel that they lie in.
    v_extent = min(diameter.x, diameter.y) < 1.5 ? vec2(0.0) : 0.5 * diameter / gl_PointSize;
    v_alpha = u_opacity;
    if (has_vertex_colors) v_alpha *= a_color.a;
}
