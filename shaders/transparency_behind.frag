// The picture with its overlay, as light: what glass sees behind it. Colours that are shown past the tone curve become the
// light that a linear curve would show like them.
uniform sampler2D u_radiance;
uniform sampler2D u_overlay;
uniform vec2 u_size;
uniform float u_exposure;

layout(location = 0) out vec4 o_picture;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    vec4 overlay = textureLod(u_overlay, uv, 0.0);
    o_picture = textureLod(u_radiance, uv, 0.0) * (1.0 - overlay.a) + vec4(overlay.rgb / max(u_exposure, 1e-20), overlay.a);
}
