// The opaque surfaces' depth, nearest to the eye where something is drawn over everything else: nothing lies before that.
uniform sampler2D u_depth_target;
uniform sampler2D u_over;  // depth of what is drawn over everything else

layout(location = 0) out float o_limit;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    o_limit = texelFetch(u_over, p, 0).r > 0.0 ? 1.0 : texelFetch(u_depth_target, p, 0).r;
}
