// The first level of bloom's pyramid: light that is spread, a texel for 4 x 4 pixels, by a tent of 8 x 8, which weighs
// every pixel alike wherever it lies in its texel: what moves does not flicker. In two steps, so that every pixel is read
// once: bloom_blocks.frag sums blocks of 4 x 4 pixels, two before each texel to one after it; here a texel's tent is what
// rises to it and falls from it in the four blocks around.
uniform sampler2D u_rise_rise;
uniform sampler2D u_fall_rise;
uniform sampler2D u_rise_fall;
uniform sampler2D u_fall_fall;

layout(location = 0) out vec4 o_light;

void main() {
    ivec2 block = ivec2(gl_FragCoord.xy);
    vec4 sum = texelFetch(u_rise_rise, block, 0) + texelFetch(u_fall_rise, block + ivec2(1, 0), 0) +
               texelFetch(u_rise_fall, block + ivec2(0, 1), 0) + texelFetch(u_fall_fall, block + 1, 0);
    o_light = vec4(sum.rgb / sum.a, 1.0);
}
