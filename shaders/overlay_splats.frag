// Splats, which are blended natively, over the overlay.
uniform sampler2D u_splats;  // linear display light, premultiplied

layout(location = 0) out vec4 o_color;

void main() { o_color = texelFetch(u_splats, ivec2(gl_FragCoord.xy), 0); }
