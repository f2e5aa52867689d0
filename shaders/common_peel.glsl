// Depth peeling from behind: fragments that are not nearer than the limit are left out. The depth test keeps the farthest
// of the others. Or, for what lies behind a layer, fragments that are not farther, of which the nearest is kept.
uniform sampler2D u_peel_limit;  // reversed depth: of the opaque surfaces, then of the layer before
uniform float u_peel_mode;       // 1: of the opaque surfaces, where 0 is infinitely far; else 0 is a finished pixel. -1: behind

bool is_peeled() {
    float limit = texelFetch(u_peel_limit, ivec2(gl_FragCoord.xy), 0).r;
    if (u_peel_mode < 0.0) return gl_FragCoord.z >= limit;
    return gl_FragCoord.z <= limit || (u_peel_mode < 0.5 && limit == 0.0);
}
