// Where a layer holds the surface of an item's surfels, the item's next one begins where the band of these ended.
uniform sampler2D u_claim;
uniform float u_owner;

layout(location = 0) out float o_limit;

void main() {
    vec2 claim = texelFetch(u_claim, ivec2(gl_FragCoord.xy), 0).rg;
    if (claim.x != u_owner) discard;
    o_limit = claim.y;
}
