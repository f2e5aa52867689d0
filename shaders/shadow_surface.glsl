// What a point of a mesh leaves in a shadow map.
#include "common_uv.glsl"
#include "shadow_target.glsl"

#feature COVERS is_covering
#feature TRANSMISSION_TEXTURE has_transmission_texture

uniform vec3 u_through;  // part of light that goes through what is covered
uniform float u_root;    // on the colours that vary: light crosses the faces of a closed volume twice
uniform sampler2D u_transmission_texture;
uniform mat3 u_transmission_uv;
uniform vec4 u_transmission_channel;

#ifdef NATIVE  // There derivatives are inputs.
in vec2 v_uv_dx;
in vec2 v_uv_dy;

vec4 shadow_texel(sampler2D source, mat3 transform, vec2 uv) {
    vec2 dx = (transform * vec3(v_uv_dx, 0.0)).xy, dy = (transform * vec3(v_uv_dy, 0.0)).xy;
    return textureGrad(source, image_uv(transform, uv), vec2(dx.x, -dx.y), vec2(dy.x, -dy.y), 0.0);
}
#else
vec4 shadow_texel(sampler2D source, mat3 transform, vec2 uv) { return texture(source, image_uv(transform, uv)); }
#endif

// Part of light that goes through a caster of this colour.
vec3 light_through(vec4 color, vec2 uv) {
    float alpha = is_covering ? 1.0 : color.a, transmission = 1.0;
    if (has_transmission_texture)
        transmission = dot(shadow_texel(u_transmission_texture, u_transmission_uv, uv), u_transmission_channel);
    return 1.0 - alpha + alpha * u_through * pow(max(color.rgb * transmission, 0.0), vec3(u_root));
}

void write_shadow(vec4 color, vec2 uv) {
    if (is_tinting)
        write_tint(light_through(color, uv));
    else
        write_depth();
}
