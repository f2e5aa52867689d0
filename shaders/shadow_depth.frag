// The depth of a caster, larger towards the light; holes where a surface is cut out or, in this frame, seen through.
#ifdef ALPHA_BLEND
#include "common_stochastic.glsl"
#endif
#ifdef VERTEX_COLOR
in float v_alpha;
#endif
#ifdef UV
in vec2 v_uv;
#endif
#ifdef BASE_COLOR_TEXTURE
uniform sampler2D u_base_color_texture;
uniform mat3 u_base_color_uv;
#endif
#ifdef OPACITY_TEXTURE
uniform sampler2D u_opacity_texture;
uniform mat3 u_opacity_uv;
uniform vec4 u_opacity_channel;
#endif
uniform float u_opacity;
uniform float u_alpha_cutoff;

layout(location = 0) out float o_depth;

#ifdef UV
// Images have row 0 on top and texture coordinates have v upwards.
vec2 uv_of(mat3 transform) {
    vec2 uv = (transform * vec3(v_uv, 1.0)).xy;
    return vec2(uv.x, 1.0 - uv.y);
}
#endif

void main() {
    float alpha = u_opacity;
#ifdef VERTEX_COLOR
    alpha *= v_alpha;
#endif
#ifdef BASE_COLOR_TEXTURE
    alpha *= texture(u_base_color_texture, uv_of(u_base_color_uv)).a;
#endif
#ifdef OPACITY_TEXTURE
    alpha *= dot(texture(u_opacity_texture, uv_of(u_opacity_uv)), u_opacity_channel);
#endif
#if defined(ALPHA_MASK)
    if (alpha < u_alpha_cutoff) discard;
#elif defined(ALPHA_BLEND)
    if (alpha <= alpha_threshold()) discard;
#endif
    o_depth = gl_FragCoord.z;
}
