// What a point of a mesh leaves in a shadow map.
#include "common_uv.glsl"
#include "shadow_target.glsl"

#feature COVERS is_covering
#feature TRANSMISSION_TEXTURE has_transmission_texture

uniform vec3 u_through;  // part of light that goes through what is covered
uniform float u_root;    // on the colours that vary: light crosses the faces of a volume twice
uniform sampler2D u_transmission_texture;
uniform mat3 u_transmission_uv;
uniform vec4 u_transmission_channel;

void write_shadow(vec4 color, vec2 uv) {
    if (!is_tinting) {
        write_depth();
        return;
    }
    float alpha = is_covering ? 1.0 : color.a, transmission = 1.0;
    if (has_transmission_texture)
        transmission = dot(texture(u_transmission_texture, image_uv(u_transmission_uv, uv)), u_transmission_channel);
    write_tint(1.0 - alpha + alpha * u_through * pow(max(color.rgb * transmission, 0.0), vec3(u_root)));
}
