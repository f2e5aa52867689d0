// Depth peeling from behind: fragments that are not nearer than the limit are left out. The depth test keeps the farthest
// of the others.
uniform sampler2D u_peel_limit;  // reversed depth: of the opaque surfaces, then of the layer before
uniform float u_peel_first;      // 1: of the opaque surfaces, where 0 is infinitely far; else 0 is a finished pixel

bool is_peeled() {
    float limit = texelFetch(u_peel_limit, ivec2(gl_FragCoord.xy), 0).r;
    return gl_FragCoord.z <= limit || (u_peel_first < 0.5 && limit == 0.0);
}
