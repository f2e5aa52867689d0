// The depth of a caster, larger towards the light, with holes where a surface is cut out; or what a transparent one takes
// from the light.
#ifdef TINT
#include "common_tint.glsl"
uniform vec3 u_through;  // part of light that goes through what is covered
uniform float u_root;    // on the colours that vary: light crosses the faces of a volume twice
#else
layout(location = 0) out float o_depth;
#endif
#ifdef VERTEX_COLOR
in vec4 v_color;
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
#ifdef TRANSMISSION_TEXTURE
uniform sampler2D u_transmission_texture;
uniform mat3 u_transmission_uv;
uniform vec4 u_transmission_channel;
#endif
uniform float u_opacity;
uniform float u_alpha_cutoff;

#ifdef UV
// Images have row 0 on top and texture coordinates have v upwards.
vec2 uv_of(mat3 transform) {
    vec2 uv = (transform * vec3(v_uv, 1.0)).xy;
    return vec2(uv.x, 1.0 - uv.y);
}
#endif

void main() {
    vec4 color = vec4(1.0);
#ifdef VERTEX_COLOR
    color *= v_color;
#endif
#ifdef BASE_COLOR_TEXTURE
    color *= texture(u_base_color_texture, uv_of(u_base_color_uv));
#endif
    float alpha = u_opacity * color.a;
#ifdef OPACITY_TEXTURE
    alpha *= dot(texture(u_opacity_texture, uv_of(u_opacity_uv)), u_opacity_channel);
#endif
#ifdef ALPHA_MASK
    if (alpha < u_alpha_cutoff) discard;
#endif
#ifdef TINT
    float transmission = 1.0;
#ifdef TRANSMISSION_TEXTURE
    transmission = dot(texture(u_transmission_texture, uv_of(u_transmission_uv)), u_transmission_channel);
#endif
#ifdef COVERS
    alpha = 1.0;
#endif
    write_tint(1.0 - alpha + alpha * u_through * pow(color.rgb * transmission, vec3(u_root)));
#else
    o_depth = gl_FragCoord.z;
#endif
}
