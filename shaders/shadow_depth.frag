// The depth of a caster, larger towards the light, with holes where a surface is cut out; or what a transparent one takes
// from the light.
#include "shadow_surface.glsl"

#feature VERTEX_COLOR has_vertex_colors
#feature UV has_uv
#feature BASE_COLOR_TEXTURE has_base_color_texture
#feature OPACITY_TEXTURE has_opacity_texture
#feature ALPHA_MASK has_alpha_mask

in vec4 v_color;
in vec2 v_uv;

uniform sampler2D u_base_color_texture;
uniform mat3 u_base_color_uv;
uniform sampler2D u_opacity_texture;
uniform mat3 u_opacity_uv;
uniform vec4 u_opacity_channel;
uniform float u_opacity;
uniform float u_alpha_cutoff;

// What varies over the caster, and its opacity.
vec4 caster_color() {
    vec4 color = vec4(1.0);
    if (has_vertex_colors) color *= v_color;
    if (has_base_color_texture) color *= shadow_texel(u_base_color_texture, u_base_color_uv, v_uv);
    float alpha = u_opacity * color.a;
    if (has_opacity_texture) alpha *= dot(shadow_texel(u_opacity_texture, u_opacity_uv, v_uv), u_opacity_channel);
    return vec4(color.rgb, alpha);
}

void main() {
    vec4 color = caster_color();
    if (has_alpha_mask && color.a < u_alpha_cutoff) discard;
    write_shadow(color, v_uv);
}
