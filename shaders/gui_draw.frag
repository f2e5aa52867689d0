// Colours of the GUI are sRGB-encoded and mixed as they are.
uniform sampler2D u_texture;

in vec2 v_uv;
in vec4 v_color;

layout(location = 0) out vec4 o_color;

void main() {
    o_color = v_color * textureLod(u_texture, v_uv, 0.0);
}
