// Points into the G-buffer. What each target holds is defined in render/gbuffer.h.
#include "common_encoding.glsl"
#include "common_peel.glsl"
#include "common_stochastic.glsl"

#feature ROUND is_round
#feature ALPHA_MASK has_alpha_mask
#feature ALPHA_BLEND has_alpha_blend
#feature ALPHA_STOCHASTIC has_stochastic_alpha
#feature PEEL is_peeling
#feature OBJECT_ID has_ids

flat in vec3 v_normal;
flat in vec4 v_color;
flat in float v_diameter;
flat in uint v_element;

layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out float o_depth;
layout(location = 4) out vec4 o_emission;
layout(location = 5) out uint o_id;
layout(location = 6) out uint o_element;

uniform int u_object_id;
uniform vec4 u_material;  // metallic, roughness, 1, code of the kind
uniform float u_alpha_cutoff;
uniform float u_write;    // 0: the pixel is made empty, 1: it is filled

void main() {
    // The smallest discs would miss the pixel that they lie in.
    if (is_round && v_diameter >= 1.5 && length(gl_PointCoord - 0.5) > 0.5) discard;
    if (has_alpha_mask && v_color.a < u_alpha_cutoff) discard;
    if (has_stochastic_alpha && v_color.a <= alpha_threshold()) discard;
    if (is_peeling && (v_color.a <= 0.0 || is_peeled())) discard;
    o_albedo = (has_alpha_blend ? v_color : vec4(v_color.rgb, 1.0)) * u_write;
    o_normal = (oct_encode(v_normal) * 0.5 + 0.5) * u_write;
    o_material = u_material * u_write;
    o_depth = gl_FragCoord.z * u_write;
    o_emission = vec4(0.0, 0.0, 0.0, u_write);
    if (has_ids) {
        o_id = uint(u_object_id);
        o_element = v_element;
    }
}
